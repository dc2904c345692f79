"""Pictures of runs with an outer axis: a curve for each of its values, shares of basins against it,
or a picture of each value."""
import numpy as np

from . import curves, maps
from .style import (MORE, NAMED, LA, SA, Run, amplitude_axis, around, colours_of, figure, frequency,
                   legend, parameter_axis, parameter_text)

MOST_PICTURES = 20
NUMBERS = 1000000  # more than there are branches at a value


def dimensions(run, name):
    data = run.file[name]
    return [d[0].name.rsplit("/", 1)[-1] if len(d) else name for d in data.dims] if data.ndim else []


class Slice(Run):
    """One value of an outer axis, as a run without it: arrays are as long as they are there."""

    def __init__(self, run, k):
        super().__init__(run.file, run.options)
        self.outer, self.k = run.text("outer_axis"), k

    def length(self, dimension):
        name = dimension + "_length"
        return int(self.file[name][self.k]) if name in self.file else None

    def __contains__(self, name):
        if name not in self.file:
            return False
        own = dimensions(self, name)[1:] if dimensions(self, name)[:1] == [self.outer] else []
        return all(self.length(d) != 0 for d in own)

    def __getitem__(self, name):
        if name + "_values" in self.file and name != self.outer:
            return self[name + "_values"]
        own = dimensions(self, name)
        value = self.file[name][()]
        if own[:1] == [self.outer]:
            value, own = value[self.k], own[1:]
        return value[tuple(slice(self.length(d)) for d in own)] if own else value

    def axis_of(self, name, dimension):
        own = [d for d in dimensions(self, name) if d != self.outer]
        return own[dimension % len(own)]


class Lines(Run):
    """A run in which the outer axis stands where the scene has an axis of a single value."""

    def __init__(self, run, single):
        super().__init__(run.file, run.options)
        self.outer, self.single = run.text("outer_axis"), single
        self.slices = [Slice(run, k) for k in range(len(run[self.outer]))]

    def __contains__(self, name):
        # Curves over all values of that axis are not of these.
        return name in self.file and name not in ("fold_curve", "flip_curve")

    def __getitem__(self, name):
        column = name[len("branch_"):] if name.startswith("branch_") else None
        if name.startswith("free_"):  # of the last value, whose amplitudes are mostly the largest
            return self.slices[-1][name]
        if column == self.outer:
            lengths = [len(s["branch_number"]) for s in self.slices]
            return np.repeat(self.file[self.outer][()], lengths)
        own = dimensions(self, name)
        if own[:1] != [self.outer] or name == self.outer:
            return self.file[name][()]
        if own[1:2] == ["backbone_damping"]:  # each value's at the damping that all share
            here = float(self[self.single][0])
            return np.array([np.interp(np.log(here), np.log(s["backbone_damping"]), s[name])
                             for s in self.slices])
        if column is not None:  # numbers of branches are each value's own
            apart = NUMBERS if column == "number" else 0
            return np.concatenate([s[name] + apart * s.k for s in self.slices])
        return self.file[name][:, 0] if own[1:2] == [self.single] else self.file[name][()]

    def axis_of(self, name, dimension):
        own = [d for d in dimensions(self, name) if d != self.single]
        return own[dimension % len(own)]


def slices_of(run):
    """The values that have results, as runs."""
    failed = run["outer_failed"] if "outer_failed" in run else np.zeros(len(run[run.text("outer_axis")]))
    return [Slice(run, k) for k in np.flatnonzero(failed == 0)]


def text_of(run, s):
    return parameter_text(run, run[s.outer][s.k], s.outer)


def draw_lines(run, path, drawer):
    """Where the scene has lines of one value, those of the outer axis; None: it has several."""
    name = "mean_loop_amplitude"
    single = dimensions(run, name)[1]
    return drawer(Lines(run, single), path) if len(run[single]) == 1 else None


def draw_resonance_curves(run, path):
    """Resonances against amplitude, a curve for each value."""
    alone = draw_lines(run, path, curves.draw_resonance_curve)
    if alone is not None:
        return alone
    fig, ax = figure(run, 3.3)
    shown = slices_of(run)
    factor, across = amplitude_axis(run, "mean_loop_amplitude", r"mean loop amplitude $\overline{x_0}$")
    for s, colour in zip(shown, colours_of(shown)):
        omega, label = frequency(run, s["resonance_frequency"])
        ax.plot(factor * s["mean_loop_amplitude"], omega, "o-", ms=3, color=colour, label=text_of(run, s))
    ax.set(xlabel=across, ylabel="resonance: " + label)
    legend(ax)
    return fig


def draw_sweeps(run, path):
    """Amplitudes both ways, a colour for each value: wide on the way up, narrow on the way down."""
    shown = slices_of(run)
    name = shown[0].axis_of("amplitude", 1)
    if "ramp_parameter" in run:
        return None
    x, label = parameter_axis(run, run[name], name)
    runs = np.nanmax(np.abs(run["mean_velocity"]), initial=0) > 0 and name == "torque"
    what = "mean_velocity" if runs else "amplitude"
    factor, height = curves.velocity_axis(shown[0]) if runs else amplitude_axis(run, what, "amplitude $x_0$")
    fig, ax = figure(run, 3.3)
    for s, colour in zip(shown, colours_of(shown)):
        ends = parameter_axis(run, s["jump_parameter"], name)[0] if "jump_parameter" in s else np.array([])
        ways = s["jump_direction"] if "jump_direction" in s else np.array([])
        for way in range(2):
            held = np.isfinite(s["period"][way]) & runs
            a, b, gaps = curves.jumped(x, factor * s[what][way], ends[ways == way], held)
            ax.plot(a, b, lw=(2.4, 0.9)[way], color=colour, alpha=(0.5, 1)[way],
                    label=text_of(run, s) if way == 1 else None)
            if not runs:
                curves.draw_jumps(ax, gaps, way == 1, colour)
    ax.set(xlabel=label, ylabel=height)
    legend(ax, title="wide: upwards" if run.options.title else None)
    return fig


SMALL, LARGE, PERIODIC = range(3)  # labels of attractors


def named_by_branch(label, period, amplitude):
    """Labels of [value, attractor] with one name along a branch: a lone orbit, which has no other
    name than periodic, has that of the one before it, or of the one among two whose amplitude is
    nearer. Where the names from both sides differ it stays periodic."""
    lone = (np.sum(label >= 0, axis=1) == 1) & np.any((label == PERIODIC) & (period == 1), axis=1)
    found = []
    for order in (range(len(label)), range(len(label) - 1, -1, -1)):
        names, known = np.full(len(label), -1), {}
        for k in order:
            if lone[k]:
                mine = amplitude[k][label[k] == PERIODIC][0]
                names[k] = min(known, key=lambda n: abs(np.log(known[n] / mine)), default=-1)
                known = {names[k]: mine} if names[k] >= 0 else {}
            else:
                known = {n: amplitude[k][label[k] == n][0] for n in (SMALL, LARGE)
                         if np.any(label[k] == n)}
        found.append(names)
    one, other = found
    names = np.where(one < 0, other, np.where((other < 0) | (other == one), one, -1))
    return np.where((label == PERIODIC) & (names >= 0)[:, None], names[:, None], label)


def draw_shares(run, path):
    """Shares of the basins by label, and how mixed they are, against the outer axis."""
    name = run.text("outer_axis")
    x, label = parameter_axis(run, run[name], name)
    if len(x) < 2:
        return None
    fig, (top, below) = figure(run, 4.0, 2, 1, sharex=True)
    labels, share = named_by_branch(run["attractor_label"], run["attractor_period"],
                                    run["attractor_amplitude"]), run["basin_fraction"]
    marks = dict(marker="o", ms=3) if len(x) < 30 else {}
    colours = {0: SA, 1: LA}
    for kind in np.unique(labels[labels >= 0]):
        total = np.nansum(np.where(labels == kind, share, 0), axis=1)
        error = np.sqrt(np.nansum(np.where(labels == kind, run["basin_fraction_error"], 0) ** 2, axis=1))
        top.errorbar(x, total, yerr=error, color=colours.get(kind, MORE[(kind - 2) % len(MORE)]),
                     label=NAMED[kind], elinewidth=0.7, **marks)
    if "escape_fraction" in run and np.nanmax(run["escape_fraction"], initial=0) > 0:
        top.plot(x, run["escape_fraction"], color="0.5", label="escape", **marks)
    top.set(ylabel="share of the window", ylim=(-0.03, 1.03))
    if "basin_entropy" in run:
        for what, colour, text in (("basin_entropy", "black", "of all boxes"),
                                   ("boundary_basin_entropy", MORE[0], "of boxes at a boundary")):
            some = np.isfinite(run[what])
            error = np.nan_to_num(run[what + "_error"][some])
            below.errorbar(x[some], run[what][some], yerr=error, color=colour, elinewidth=0.7,
                           label=text, **marks)
        below.axhline(np.log(2), color="0.7", lw=0.8, ls="--", label="log 2")
    below.set(xlabel=label, ylabel="basin entropy", xlim=around(x, 0.03))
    below.set_ylim(bottom=0)
    top.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=4, frameon=False)
    legend(below)
    return fig


TOGETHER = {  # a picture of all values, or None where there is no such picture
    "response": lambda run, path: draw_lines(run, path, maps.draw_response),
    "branches": lambda run, path: draw_lines(run, path, curves.draw_branches),
    "resonance_curve": draw_resonance_curves,
    "hysteresis": draw_sweeps,
    "basins": draw_shares,
}


def draw(run, path, drawer):
    """Pictures with what is added to their names and titles: one of all values, or one of each."""
    together = TOGETHER.get(run.text("scene"))
    fig = together(run, path) if together else None
    if fig is not None:
        return [("", "", fig)]
    shown = slices_of(run)
    if len(shown) > MOST_PICTURES:
        raise ValueError(f"{len(shown)} values of {run.text('outer_axis')} are a picture each, which is "
                         f"more than {MOST_PICTURES}")
    return [(f"-{s.k + 1}", text_of(run, s), drawer(s, path)) for s in shown]
