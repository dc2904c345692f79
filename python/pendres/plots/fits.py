"""Pictures of fits: the data and the model's curve, and what lies between them."""
import re

import numpy as np

from .style import UNRESOLVED, around, figure, legend, plt, words

MARKS = "^v"        # of data measured while the axis grew, and while it fell
MOST_PANELS = 3     # of observables; residuals are below them


def in_units(h, name, label):
    """A variable as it is drawn, with the label of its axis: in SI where the file tells."""
    factor, unit = h.scale(name)
    return h[name] * factor, label + (f" ({unit})" if unit else "")


def axis_name(h):
    """What was swept, by the deck as the program has understood it."""
    deck = h["provenance/deck_resolved"].decode() if "provenance/deck_resolved" in h else ""
    found = re.search(r"^ *axis = '(\w+)'", deck, re.MULTILINE)
    return found[1] if found else "axis"


def other_text(h, value):
    """The value of the parameter that differs between sweeps, for a legend: by its column's name,
    or if that is a number by its own."""
    deck = h["provenance/deck_resolved"].decode() if "provenance/deck_resolved" in h else ""
    found = re.search(r"'(a[1-5]|d[a-z]+_(?:amplitude|frequency)|damping|torque|parametric_amplitude)"
                      r"=([^']+)'", deck)
    names = [name for name in found.groups() if not name.isdigit()] if found else ["sweep"]
    factor, unit = h.scale("datum_other")
    return f"{names[-1].replace('_', ' ')} = {value * factor:.6g} {unit}".rstrip()


def sweeps_of(h, along="datum_axis"):
    """The data of each sweep, in the order of their axis: an index, a colour, a direction. Along the
    parameter that differs between sweeps they are one."""
    other = np.zeros(len(h["datum_axis"]))
    if "datum_other" in h and along != "datum_other":
        other = h["datum_other"]
    for i, value in enumerate(np.unique(other)):
        for direction in (1, -1):
            here = np.flatnonzero((other == value) & (h["datum_direction"] == direction))
            if len(here):
                yield here[np.argsort(h[along][here], kind="stable")], i, value, direction


def smooth(x, y):
    """A curve through points by cubics that rise and fall only where the points do (F. N. Fritsch
    and J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300): it shows no folds that these have not."""
    x, first = np.unique(x, return_index=True)
    y = y[first]
    if len(x) < 3:
        return x, y
    h, chord = np.diff(x), np.diff(y) / np.diff(x)
    a, b = chord[:-1], chord[1:]
    weight = (h[:-1] + 2 * h[1:]) / (3 * (h[:-1] + h[1:]))
    mean = np.where(a * b > 0, weight * b + (1 - weight) * a, 1)
    slope = np.r_[chord[0], np.where(a * b > 0, a * b / mean, 0), chord[-1]]
    t = np.linspace(0, 1, 9)[:-1, None]
    at = y[:-1] + t * h * (slope[:-1] + t * (3 * chord - 2 * slope[:-1] - slope[1:] +
                                             t * (slope[:-1] + slope[1:] - 2 * chord)))
    return np.r_[(x[:-1] + t * h).T.ravel(), x[-1]], np.r_[at.T.ravel(), y[-1]]


def draw_model(ax, h, x, modelled, here, colour):
    """A line for each state of a sweep, through the model's values at the data, and dotted ones
    where it jumps."""
    parts = np.array_split(here, np.flatnonzero(np.diff(h["datum_part"][here])) + 1)
    for part in parts:
        ax.plot(*smooth(x[part], modelled[part]), color=colour, lw=1.0)
    for before, after in zip(parts, parts[1:]):
        ends = [before[-1], after[0]]
        ax.plot(x[ends], modelled[ends], ":", color=colour, lw=0.7)


def draw_fit(h, path):
    """Data with the model's curve for each observable; below, residuals in standard errors."""
    x, label = in_units(h, "datum_axis", words(axis_name(h)))
    observed, _ = in_units(h, "observed", "")
    names = h.file["datum_observable"].attrs["flag_meanings"]
    names = (names.decode() if isinstance(names, bytes) else names).split()
    kinds = np.unique(h["datum_observable"])
    places = [kind for kind in kinds if names[kind] in ("jump", "resonance")]
    along = "datum_axis"
    if len(places) == len(kinds) and "datum_other" in h:  # their places are values of the axis
        along = "datum_other"
        x, label = in_units(h, "datum_other", words(other_text(h, 0.0).split(" =")[0]))
    elif len(places) < len(kinds):
        kinds = [kind for kind in kinds if kind not in places]
    kinds = kinds[:MOST_PANELS]
    fig, axes = figure(h, 1.1 + 1.7 * len(kinds) + 0.8, len(kinds) + 1, 1, sharex=True,
                       height_ratios=[2.2] * len(kinds) + [1])
    factor, unit = h.scale("observed")
    unit_of_axis = h.scale("datum_axis")[1]
    error = h["observed_error"]
    several = "datum_other" in h and along == "datum_axis"
    for ax, kind in zip(axes, kinds):
        for here, i, value, direction in sweeps_of(h, along):
            here = here[h["datum_observable"][here] == kind]
            if not len(here):
                continue
            mark = MARKS[direction < 0]
            ax.errorbar(x[here], observed[here], factor * error[here], fmt=mark, ms=2.0, mew=0,
                        elinewidth=0.4, color=f"C{i % 6}", alpha=0.6, zorder=1)
            draw_model(ax, h, x, factor * h["modelled"], here, f"C{i % 6}")
            if several:
                ax.plot([], [], color=f"C{i % 6}", label=other_text(h, value))
        ax.set_ylabel(words(names[kind]) + (f" ({unit})" if unit else ""))
    below = axes[-1]
    for here, i, _, direction in sweeps_of(h, along):
        below.plot(x[here], (h["residual"] / error)[here], MARKS[direction < 0], ms=1.8, mew=0,
                   color=f"C{i % 6}", alpha=0.6)
    for height in (-1, 1):
        below.axhline(height, color=UNRESOLVED, lw=0.5, ls="--")
    below.axhline(0, color=UNRESOLVED, lw=0.8)
    if unit_of_axis == "":  # large numbers, such as hertz, take room
        below.xaxis.set_major_locator(plt.MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]))
    below.set(ylabel="residual /\nerror", xlabel=label, xlim=around(x, 0.02))
    decays = axis_name(h) == "time"
    axes[0].plot([], [], MARKS[0], ms=3, color="0.3",
                 label="measured" if decays else "measured, upwards")
    if np.any(h["datum_direction"] < 0):
        axes[0].plot([], [], MARKS[1], ms=3, color="0.3", label="measured, downwards")
    axes[0].plot([], [], color="0.3", label="fit")
    legend(axes[0], under=below)
    return fig
