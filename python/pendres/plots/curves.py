"""Pictures of curves: free oscillation, resonance, response, orbits, branches, sweeps, switching."""
import os

import h5py
import numpy as np

from .style import (EXACT, FREE, LA, SA, Run, amplitude_axis, around, colours_of, drive_axis, figure,
                   free_frequency, frequency, legend, parameter_axis, parameter_text, plt)


def draw_free_oscillation(h, path):
    fig, ax = figure(h, 3.3)
    if "frequency" in h:  # of any force
        factor, across = amplitude_axis(h, "amplitude", "amplitude")
        omega, label = frequency(h, h["frequency"])
        ax.plot(factor * h["amplitude"], omega, color=EXACT)
        ax.set(xlabel=across, ylabel=label.replace("drive ", ""))
        return fig
    a = h["amplitude"]
    ax.axhline(1, color=FREE, ls="-.", label="harmonic oscillator")
    ax.plot(a, h["frequency_exact"], color=EXACT, label="exact (elliptic integral)")
    ax.plot(a, h["frequency_kittel"], "--", color=SA, label="Kittel")
    ax.plot(a, h["frequency_belendez"], ":", color=LA, label="Beléndez")
    step = max(1, len(a) // 25)
    ax.plot(a[::step], h["frequency_integrated"][::step], "o", ms=4, mfc="none", color=EXACT,
            label="integrated")
    ax.set(xlabel="amplitude $x_0$ (rad)", ylabel=r"frequency $\omega_1/\omega_0$")
    legend(ax)
    return fig


def draw_escape(h, path):
    """The path over the boundary, with its noise; along one or two parameters the action."""
    if "path_x" in h:
        fig, axes = figure(h, 5.2, 2, 1)
        factor, across = amplitude_axis(h, "path_x", "position $x$")
        axes[0].plot(factor * h["path_x"], h["path_v"], color=EXACT, lw=0.8)
        axes[0].plot(factor * h["path_x"][0], h["path_v"][0], "o", color=SA, label="state")
        axes[0].plot(factor * h["saddle_x"][0], h["saddle_v"][0], "x", color=LA, label="saddle")
        axes[0].set(xlabel=across, ylabel="velocity $v$")
        legend(axes[0])
        axes[1].plot(h["path_phase"] / (2 * np.pi), h["path_noise"], color=EXACT, lw=0.8)
        axes[1].set(xlabel="drive periods", ylabel="noise along the path")
        return fig
    fig, ax = figure(h, 3.3)
    name = h.axis_of("action", 0)
    if h["action"].ndim == 1:
        across, below = parameter_axis(h, h[name], name)
        ax.plot(across, h["action"], ".-", color=EXACT)
        ax.set(xlabel=below, ylabel="least action $S$", ylim=(0, None))
        return fig
    other = h.axis_of("action", 1)
    across, below = parameter_axis(h, h[other], other)
    up, beside = parameter_axis(h, h[name], name)
    shown = ax.pcolormesh(across, up, h["action"], shading="nearest", rasterized=True)
    fig.colorbar(shown, ax=ax, label="least action $S$")
    ax.set(xlabel=below, ylabel=beside)
    return fig


def resonance_axes(ax, h, labels):
    """Resonance frequency against amplitude; values of the axis are written beside their points:
    `labels` of dampings, some of the others."""
    name = h.axis_of("mean_loop_amplitude", 0)
    factor, across = amplitude_axis(h, "mean_loop_amplitude",
                                    r"mean loop amplitude $\overline{x_0}$")
    amplitude, peak, values = h["mean_loop_amplitude"] * factor, h["peak"], h[name]
    if name != "damping" or not np.isin(labels, values).all():
        labels = values[::-(-len(values) // 8)]
    omega, label = frequency(h, h["resonance_frequency"])
    plain = "free_frequency" in h  # of another force no file has the free oscillation
    right = np.nanmax(amplitude, initial=0) * 1.12 or 1
    if plain:
        x = np.linspace(0, min(max(0.5, right), np.pi), 400)[:-1]
        right = x[-1]
        ax.plot(x, frequency(h, free_frequency(x))[0], "--", color=FREE, label="free oscillation")
        ax.axhline(frequency(h, 1.0)[0], color=FREE, ls="-.", label="harmonic oscillator")
    edge = "edge: SA ends" if plain else "edge: a state ends"
    for kind, style, colour, name in ((0, "o", SA, "smooth peak"), (1, "s", LA, edge),
                                      (2, "x", "black", "ragged")):
        if np.any(peak == kind):
            ax.plot(amplitude[peak == kind], omega[peak == kind], style, ms=3, color=colour,
                    label=name)
    # Numbers keep off the lines: they stand within the arch below the free pendulum's line, and to
    # the right of what is beyond that line.
    top = amplitude[np.nanargmax(omega)] if np.any(np.isfinite(omega)) else 0
    free = frequency(h, free_frequency(amplitude))[0] if plain else omega
    apart = 0.14 * right, 0.08 * (np.nanmax(omega, initial=0) - np.nanmin(omega, initial=1))
    numbered = np.empty((0, 2))
    for value in labels:
        i = np.argmin(abs(values - value))
        here = np.array([amplitude[i], omega[i]])
        if abs(values[i] - value) > 1e-9 or not np.isfinite(amplitude[i]) \
                or np.any(np.all(abs(numbered - here) < apart, axis=1)):
            continue
        numbered = np.vstack([numbered, here])
        within = omega[i] < free[i]
        left = within and amplitude[i] >= top
        ax.annotate(f"{value:g}", (amplitude[i], omega[i]), textcoords="offset points",
                    xytext=(-4 if left else 4, -6 if within else 1),
                    ha="right" if left else "left", va="top" if within else "bottom",
                    fontsize=plt.rcParams["legend.fontsize"] - 0.5)
    seen = np.append(omega, frequency(h, 1.0)[0]) if plain else omega
    ax.set(xlim=(0, right), ylim=around(seen, 0.12))
    return across, label


def draw_resonance_curve(h, path):
    fig, ax = figure(h, 3.6)
    across, label = resonance_axes(ax, h, [0.06, 0.1, 0.14, 0.2, 0.24, 0.32, 0.7, 1.0])
    ax.set(xlabel=across, ylabel="resonance: " + label)
    beside = path[:-3] + "_inset.h5"
    inset = os.path.exists(beside)
    if inset:  # the free space is at the lower left, below the curve
        low, high = ax.get_ylim()
        ax.set_ylim(low - 0.75 * (high - low), high)
        with h5py.File(beside, "r") as other:
            small = ax.inset_axes([0.14, 0.13, 0.5, 0.36])
            resonance_axes(small, Run(other, h.options), [0.099, 0.28])
        small.set_title("$F_0 = 0.1$", fontsize=plt.rcParams["legend.fontsize"], pad=2)
        small.tick_params(labelsize=plt.rcParams["legend.fontsize"] - 0.5)
    axis = h.axis_of("mean_loop_amplitude", 0).replace("_", " ")
    legend(ax, loc="lower right" if inset else "best", title="numbers: " + axis,
           title_fontsize=plt.rcParams["legend.fontsize"], framealpha=1)
    return fig


def draw_response(h, path):
    """Amplitude above, phase lag below; with temperatures a curve each, without the resonance."""
    name, lines = h.axis_of("mean_loop_amplitude", -1), h.axis_of("mean_loop_amplitude", -2)
    drive, label = parameter_axis(h, h[name], name)
    fig, (top, below) = figure(h, 4.2, 2, 1, sharex=True)
    factor, height = amplitude_axis(h, "mean_loop_amplitude", r"amplitude $\langle x_0\rangle$")
    amplitude, lag = h["mean_loop_amplitude"] * factor, h["phase_lag"]
    noisy = amplitude.ndim == 3
    if not noisy:
        amplitude, lag = amplitude[None], lag[None]
    styles = ["-", "--", ":", "-."]
    marks = dict(marker=".", ms=4) if len(drive) < 30 else {}
    for t in range(len(amplitude)):
        for i, g in enumerate(h[lines]):
            text = parameter_text(h, g, lines)
            if noisy:
                text += ", " + parameter_text(h, h["temperature"][t], "temperature")
            top.plot(drive, amplitude[t, i], styles[t % 4], color=f"C{i % 6}", label=text, **marks)
            below.plot(drive, lag[t, i] / np.pi, styles[t % 4], color=f"C{i % 6}", **marks)
    resonances = h["resonance_period"] if not noisy and "resonance_period" in h else []
    for i, tau in enumerate(resonances):
        if not np.isfinite(tau):
            continue
        at = drive_axis(h, 2 * np.pi / tau if name == "drive_frequency" else tau, name)[0]
        top.plot(at, factor * h["resonance_amplitude"][i], "o", ms=5, mfc="none", color=f"C{i % 6}")
        below.plot(at, h["resonance_phase_lag"][i] / np.pi, "o", ms=5, mfc="none",
                   color=f"C{i % 6}", label=f"resonance, {at:.6g}")
    most = np.nanmax(amplitude, initial=0)
    top.set(ylabel=height, ylim=(0, 1.05 * most if most > 0 else 1))
    below.set(xlabel=label, ylabel=r"phase lag $\phi/\pi$", ylim=(0, 1))
    top.legend(handlelength=1.2)
    if below.get_legend_handles_labels()[0]:
        below.legend(handletextpad=0.2)
    return fig


def arrow_along(ax, x, y, colour):
    """An arrow in the direction that a loop is gone through, half way between its ends."""
    k = np.argmin(np.abs(x[:len(x) - max(1, len(x) // 100)] - (np.max(x) + np.min(x)) / 2))
    ax.annotate("", (x[k + max(1, len(x) // 100)], y[k + max(1, len(x) // 100)]), (x[k], y[k]),
                arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.2, "mutation_scale": 14})


def orbit_title(h):
    if np.isfinite(h["period"]):
        return (rf"area {h['loop_area']:.5f}, amplitude {h['amplitude']:.4f}, "
                rf"lag {h['phase_lag'] / np.pi:.4f}$\pi$")
    if np.isfinite(h["lyapunov_exponent"]):
        return f"chaotic, Lyapunov exponent {h['lyapunov_exponent']:.4f}"
    return "no closed orbit"


def draw_spectrum(h, ax):
    """Power spectrum of the velocity; what is at the drive's harmonics are lines, the rest chaos."""
    omega, power = h["frequency"], h["power_spectrum"]
    ax.plot(omega[1:] / h["drive_frequency"], power[1:], lw=0.6, color=EXACT)
    ax.set(xlabel="frequency (drive frequencies)", ylabel="power of $v$", yscale="log",
           xlim=(0, omega[-1] / h["drive_frequency"]))


def unit_of_x(h, name="x(0)", of="x"):
    """What positions are divided by, and the label of their axis: in SI where the file tells it of
    the variable `of`; else only a pendulum's are angles, in units of pi."""
    factor, unit = h.scale(of) if of in h else (1.0, "")
    if unit and unit not in ("rad", "1"):
        return 1 / factor, f"${name}$ ({unit})"
    return (1.0, f"${name}$") if "a1" in h else (np.pi, rf"${name}/\pi$")


def within_turn(h, x):
    """Positions of a pendulum within one turn; others as they are."""
    return x if "a1" in h else np.remainder(x + np.pi / 2, 2 * np.pi) - np.pi / 2


def draw_section(h, samples):
    """Chaos once a drive period: its Poincaré section, angles within one turn; its spectrum if
    there."""
    spectrum = "power_spectrum" in h
    fig, axes = figure(h, 4.6 if spectrum else 3.2, 1 + spectrum, 1,
                       **({"height_ratios": (2, 1)} if spectrum else {}))
    ax = np.atleast_1d(axes)[0]
    x, v = within_turn(h, h["x"][::samples]), h["v"][::samples]
    unit, label = unit_of_x(h, "x")
    ax.plot(x / unit, v, ".", ms=max(0.6, 4 - 0.7 * np.log10(len(x) + 1)), mew=0,
            color=EXACT, rasterized=True)
    ax.set(xlabel=label, ylabel="$v$")
    title = "Poincaré points; " + orbit_title(h)
    if "correlation_dimension" in h and np.isfinite(h["correlation_dimension"]):
        title += f"\ndimensions: correlation {h['correlation_dimension']:.3f}" \
            f"$\\pm${h['correlation_dimension_error']:.3f}, Lyapunov {h['lyapunov_dimension']:.3f}"
    ax.set_title(title)
    if spectrum:
        draw_spectrum(h, axes[1])
    return fig


MOST_PERIODS = 20  # beside which the drive can be seen


def draw_orbit(h, path):
    periods, drive = h["drive_phase"] / (2 * np.pi), h["drive"]
    factor, label = amplitude_axis(h, "x", "$x$")
    x = h["x"] * factor
    closed = np.isfinite(h["period"])
    samples = round(1 / (periods[1] - periods[0])) if len(periods) > 1 else 1  # a period
    if not closed and len(periods) > (1 if samples == 1 else 200 * samples):
        return draw_section(h, samples)
    colour = {0: SA, 1: LA}.get(int(h["label"]), "#009E73")
    fig, (top, bottom) = figure(h, 4.2, 2, 1)
    scale = 0.5 * np.ptp(x) / np.ptp(drive) if np.ptp(drive) > 0 and np.ptp(x) > 0 else 1.0
    marks = dict(marker="o", ms=3) if len(x) < 16 else {}
    top.plot(periods, x, color=colour, label="$x$", **marks)
    if np.ptp(periods) <= MOST_PERIODS:
        top.plot(periods, np.mean(x) + scale * drive, "--", color=FREE,
                 label=f"drive, magnified {scale:.1f} times", **marks)
    top.set(xlabel="drive periods", ylabel=label, ylim=around(x))
    top.legend(loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0, ncol=2, frameon=False)
    if closed and h["winding"] != 0:  # the mean rotation encloses no area
        x = x - 2 * np.pi * h["winding"] / h["period"] * periods
        label = label.replace("$x$", "$x$ without rotation")
    bottom.plot(drive, x, color=colour, **marks)
    if len(x) >= 16:
        arrow_along(bottom, drive, x, colour)
    bottom.set(xlabel="drive $F$", ylabel=label, ylim=around(x))
    bottom.set_title(orbit_title(h))
    return fig


def column_of(name):
    """What an axis is called in the columns branch_..., fold_..., flip_..."""
    return "frequency" if name in ("drive_frequency", "drive_period") else name


def bifurcation_curves(h, what, x, y):
    """Curves of folds or flips, one after the other: is it an end of SA or LA, x, y."""
    if f"{what}_curve" not in h:
        return
    number = h[f"{what}_curve"]
    for k in np.unique(number):
        here = number == k
        named = f"{what}_branch" in h and np.any(h[f"{what}_branch"][here] < 2)
        yield named, h[f"{what}_{x}"][here], h[f"{what}_{y}"][here]


def smooth(x, y, pieces=12):
    """A curve through points in order, smooth in both coordinates: cubic in each interval, with the
    slopes of the parabolas through neighbours along the chord. Each interval becomes `pieces`."""
    points = np.column_stack([x, y]).astype(float)
    size = np.ptp(points, axis=0)
    chord = np.sqrt(np.sum((np.diff(points, axis=0) / np.where(size > 0, size, 1)) ** 2, axis=1))
    points = points[np.append(True, chord > 0)]
    chord = chord[chord > 0][:, None]
    if len(points) < 3:
        return points
    rise = np.diff(points, axis=0) / chord
    inner = (chord[1:] * rise[:-1] + chord[:-1] * rise[1:]) / (chord[1:] + chord[:-1])
    slope = np.vstack([2 * rise[:1] - inner[:1], inner, 2 * rise[-1:] - inner[-1:]])
    t = (np.arange(pieces) / pieces)[:, None, None]
    curve = points[:-1] + t * chord * (slope[:-1] + t * (
        3 * rise - 2 * slope[:-1] - slope[1:] + t * (slope[:-1] + slope[1:] - 2 * rise)))
    return np.vstack([curve.transpose(1, 0, 2).reshape(-1, 2), points[-1:]])


UNSTABLE = (0, (3.5, 1.5))
BIFURCATION_MARKS = ((1, "o", "fold"), (2, "D", "period doubling"), (3, "s", "symmetry breaking"),
                     (4, "^", "branch point"))


def draw_branch(ax, x, y, stable, kind, colour):
    """A branch as one smooth line, dashed where it is unstable. Stability changes at bifurcations,
    which are points of the branch (kind > 0), so that the parts meet there."""
    some = np.isfinite(x) & np.isfinite(y)
    x, y, stable, kind = x[some], y[some], stable[some], kind[some]
    if len(x) < 2:
        return
    apart = np.append(True, (np.diff(x) != 0) | (np.diff(y) != 0))
    x, y, stable, kind = x[apart], y[apart], stable[apart], kind[apart]
    holds = np.where(kind > 0, True, stable)
    holds = holds[:-1] & holds[1:] & ((kind[:-1] == 0) | (kind[1:] == 0))  # of each interval
    pieces = 12
    curve = smooth(x, y, pieces)
    turns = np.flatnonzero(np.diff(holds)) + 1
    for first, last in zip(np.append(0, turns), np.append(turns, len(holds))):
        part = curve[first * pieces:last * pieces + 1] if len(x) > 2 else curve
        ax.plot(*part.T, ls="-" if holds[first] else UNSTABLE, color=colour,
                lw=1.4 if holds[first] else 1.1)


def draw_backbone(ax, h, rows, factor):
    """Orbits that lag behind the drive by a quarter turn: over damping a curve through the lines
    and beyond them, over anything else a mark on each line, and a curve through many. And free
    oscillations."""
    if "free_amplitude" in h:
        ax.plot(frequency(h, h["free_frequency"])[0], factor * h["free_amplitude"], "-.", color=FREE,
                lw=0.8, zorder=1, label="free oscillation")
    if "backbone_frequency" not in h:
        return
    omega, at = frequency(h, h["backbone_frequency"])[0], factor * h["backbone_amplitude"]
    some = np.isfinite(omega) & np.isfinite(at)
    curve = rows == "damping" or np.sum(some) >= 12
    if np.any(some):
        ax.plot(omega[some], at[some], "-" if curve else "+", color=EXACT, lw=0.6, ms=6, mew=0.6,
                zorder=3.5, label="lag of a quarter turn")


def draw_branches(h, path):
    """Amplitude against the frequency, or against whatever the branches are followed along."""
    fig, ax = figure(h, 3.3)
    name = h.axis_of("mean_loop_amplitude", -1)
    rows = h.axis_of("mean_loop_amplitude", 0)
    axis, label = parameter_axis(h, h[name], name)
    factor, height = amplitude_axis(h, "branch_amplitude", "amplitude $x_0$")
    amplitude = h["branch_amplitude"] * factor
    number, stable, kind = h["branch_number"], h["branch_stable"] == 1, h["branch_kind"]
    value, row = h[f"branch_{column_of(name)}"], h[f"branch_{column_of(rows)}"]
    along = parameter_axis(h, value if name != "drive_period" else 2 * np.pi / value, name)[0]
    few = len(h[rows]) <= 6
    for i, (g, shade) in enumerate(zip(h[rows], colours_of(h[rows]))):
        colour = f"C{i}" if few else shade
        for k in np.unique(number[abs(row - g) <= 1e-9 * max(1, abs(g))]):
            here = number == k
            draw_branch(ax, along[here], amplitude[here], stable[here], kind[here], colour)
        ax.plot([], [], color=colour, label=parameter_text(h, g, rows))
        if h.options.ensemble:
            ax.plot(axis, factor * h["mean_loop_amplitude"][i], ".", ms=3, color=colour)
    ax.plot([], [], ls=UNSTABLE, color="black", lw=1.1, label="unstable")
    if h.options.ensemble:
        ax.plot([], [], ".", ms=3, color="black", label="mean of the ensemble")
    low, high = around(axis, 0.0)
    for k, mark, text in BIFURCATION_MARKS:
        here = (kind == k) & (along >= low) & (along <= high)
        if np.any(here):
            ax.plot(along[here], amplitude[here], mark, ms=3.5, mfc="white", mew=0.8,
                    color="black", label=text, zorder=3)
    if name == "drive_frequency" and h.options.boundary:
        draw_backbone(ax, h, rows, factor)
        symbol = parameter_axis(h, [], rows)[1].partition(" (")[0].split()[-1]
        for named, omega, at in bifurcation_curves(h, "fold", "frequency", "amplitude"):
            if named:
                line = smooth(frequency(h, omega)[0], factor * at)
                ax.plot(*line.T, color="0.75", lw=0.8, zorder=1, label=f"folds, all {symbol}")
    inside = (along >= low) & (along <= high)
    shown = amplitude[inside] if np.any(inside) else factor * h["mean_loop_amplitude"].ravel()
    ax.set(xlabel=label, ylabel=height, xlim=(low, high), ylim=(0, around(shown)[1]))
    legend(ax)
    return fig


TRANSITIONS = {"sa_la": "SA to LA", "la_sa": "LA to SA",
               "well_sa": "SA to another well", "well_la": "LA to another well"}


def transitions(h):
    """Each transition that was counted at least once: its name in the file, and in words."""
    for events in h.file:
        what = events[len("events_"):]
        if events.startswith("events_") and f"rate_{what}" in h and np.any(h[events] > 0):
            words = h.file[f"rate_{what}"].attrs["long_name"]
            words = words.decode() if isinstance(words, bytes) else str(words)
            yield what, TRANSITIONS.get(what, words.partition(" from ")[2].partition(",")[0] or what)


def activation_text(h, what):
    """The activation energy with its error, in SI where the file tells."""
    factor, unit = h.scale(f"activation_energy_{what}")
    energy, error = (factor * h[f"activation_energy_{what}{end}"] for end in ("", "_error"))
    digits = max(0, 1 - int(np.floor(np.log10(error)))) if error > 0 else 4
    return f", $E = {energy:.{min(digits, 12)}f} \\pm {error:.{min(digits, 12)}f}$ {unit}".rstrip()


def draw_switching(h, path):
    """Rates with confidence intervals, the fits, and the activation energies that they mean."""
    fig, ax = figure(h, 3.4)
    t, (kelvin, warmth) = h["temperature"], h.scale("temperature")
    inverse, second = np.linspace(0.95 / t.max(), 1.05 / t.min(), 60), ""
    for i, (what, text) in enumerate(transitions(h)):
        factor, second = h.scale(f"rate_{what}")
        rate, low, high = (factor * h[f"rate_{what}{end}"] for end in ("", "_lower", "_upper"))
        colour = LA if what in ("la_sa", "well_la") else SA if what in TRANSITIONS else f"C{i % 6}"
        if f"activation_energy_{what}" in h and np.isfinite(h[f"activation_energy_{what}_error"]):
            text += activation_text(h, what)
            at = h[f"fit_temperature_{what}"]
            power = h[f"prefactor_exponent_{what}"]
            fit = np.exp(h[f"log_prefactor_{what}"] - h[f"activation_energy_{what}"] * inverse) * \
                (1 / (inverse * at)) ** power
            ax.plot(inverse / kelvin, factor * fit, color=colour, lw=0.8,
                    ls=":" if what.startswith("well") else "-")
        some = h[f"events_{what}"] > 0
        ax.errorbar(1 / (kelvin * t[some]), rate[some], yerr=[(rate - low)[some], (high - rate)[some]],
                    fmt="osDX^v"[i % 6], ms=4, mfc="none", color=colour, label=text, capsize=2)
    ax.set(xlabel="$1/T$" + (f" ({warmth}$^{{-1}}$)" if warmth else ""), yscale="log",
           ylabel="switching rate (" + (second or "per unit of time") + ")")
    if not ax.has_data():
        ax.text(0.5, 0.5, "nothing switched", transform=ax.transAxes, ha="center")
    legend(ax)
    return fig


def draw_ramp(h, name):
    """Strobe points while the parameter moves, the ends of states and when they are left, and how
    noise scatters that."""
    noisy = "jump_noisy_parameter" in h
    fig, axes = figure(h, 4.0 if noisy else 3.0, 2 if noisy else 1, 1, sharex=True,
                       **({"height_ratios": (2, 1)} if noisy else {}))
    top = axes[0] if noisy else axes
    factor, height = amplitude_axis(h, "ramp_x", "$x$ at drive phase 0")
    for way in range(2):
        x, label = parameter_axis(h, h["ramp_parameter"][way], name)
        top.plot(x, factor * within_turn(h, h["ramp_x"][way]), lw=0.9, color=f"C{way}",
                 label=f"{('up', 'down')[way]}wards")
    for k, way in enumerate(h["jump_direction"]):
        lines = [("jump_parameter", "-", "quasi-static"), ("jump_ramp_parameter", "--", "real time")]
        for what, style, text in lines:
            at = parameter_axis(h, h[what][k], name)[0]
            for ax in np.atleast_1d(axes):
                if np.isfinite(at):
                    ax.axvline(at, color=f"C{way}", lw=0.8, ls=style,
                               label=text if ax is top and k == 0 else None)
        values = h["jump_noisy_parameter"][k] if noisy else np.array([])
        values = values[np.isfinite(values)]
        if len(values) > 1:
            axes[1].hist(parameter_axis(h, values, name)[0], bins="auto", color=f"C{way}", alpha=0.5)
    top.set_ylabel(height)
    legend(top, under=np.atleast_1d(axes)[-1])
    if noisy:
        axes[1].set_ylabel("jumps at\n" + parameter_text(h, h["temperature"], "temperature"))
    np.atleast_1d(axes)[-1].set_xlabel(label)
    return fig


def jumped(x, y, ends, held):
    """A curve with a gap at each end of a state, and the gaps: from the last point of the one state
    to the first of the next. What is held constant up to its end, as a voltage on a step, is drawn
    up to there; of other curves nobody has computed what lies between."""
    at = np.searchsorted(x, ends)
    xs, ys, gaps = [x[:1]], [y[:1]], []
    for i in range(1, len(x)):
        here = ends[at == i]
        if len(here):
            before = (here.min(), y[i - 1]) if held[i - 1] else (x[i - 1], y[i - 1])
            after = (here.max(), y[i]) if held[i] else (x[i], y[i])
            xs.append([before[0], np.nan, after[0]])
            ys.append([before[1], np.nan, after[1]])
            gaps.append((before, after))
        xs.append(x[i:i + 1])
        ys.append(y[i:i + 1])
    return np.concatenate(xs), np.concatenate(ys), gaps


def draw_jumps(ax, gaps, back, colour):
    """Dotted lines with an arrow at the large jumps."""
    span = np.ptp([y for gap in gaps for _, y in gap if np.isfinite(y)] or [0])
    for gap in gaps:
        start, end = gap[::-1] if back else gap
        if span > 0 and abs(end[1] - start[1]) > 0.25 * span:
            ax.plot(*np.transpose(gap), color=colour, lw=0.8, ls=":")
            middle = np.add(start, end) / 2
            ax.annotate("", middle + 0.1 * np.subtract(end, start), middle,
                        arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 0.6,
                                    "mutation_scale": 8})


def write_steps(ax, h, x, unit):
    """Above each wide step of a junction its number, the voltage in drive frequencies, and its width
    if the sweep has left it at both ends. unit: of velocities in the picture."""
    names = ("winding", "period", "mean_velocity", "lower", "upper", "width")
    factor, label = parameter_axis(h, 1.0, "torque")
    units = " " + label.split(" (")[1].rstrip(")") if " (" in label else ""
    for p, q, turns, first, last, width in zip(*(h["step_" + name] for name in names)):
        if (last - first) * factor < 0.04 * np.ptp(x):
            continue
        text = f"{p / q:g}" if p % q == 0 else f"{p}/{q}"
        if np.isfinite(width):
            text += f" ({width * factor:.4g}{units})"
        wide = (last - first) * factor > 0.15 * np.ptp(x)
        at = first + (0.55 * (last - first) if wide else last - first)
        ax.annotate(text, (at * factor, turns * unit), ha="right", va="bottom",
                    xytext=(0 if wide else -5, 2),
                    textcoords="offset points", fontsize=plt.rcParams["legend.fontsize"])
    low, high = ax.get_ylim()
    ax.set_ylim(low, high + 0.06 * (high - low))  # for a number above the highest


def exponent_axis(h, label="Lyapunov\nexponent"):
    """Lyapunov exponents as they are drawn, and the label of their axis."""
    factor, unit = h.scale("lyapunov")
    return factor * h["lyapunov"], label + (f" ({unit})" if unit else "")


def velocity_axis(h):
    """What mean velocities are multiplied by to be drawn, and the label: of a junction in a
    laboratory's units volts, else drive frequencies, if that does not change."""
    factor, unit = h.scale("mean_velocity")
    if unit.endswith("V"):
        return factor, f"voltage ({unit})"
    if np.ndim(h["drive_frequency"]) == 0:
        return 1 / h["drive_frequency"], "mean velocity /\ndrive frequency"
    return factor, "mean velocity" + (f" ({unit})" if unit else "")


def draw_hysteresis(h, path):
    """Amplitudes both ways; of a torque, the current of a junction, the mean velocity, its
    voltage."""
    name = h.axis_of("amplitude", 1)
    if "ramp_parameter" in h:
        return draw_ramp(h, name)
    x, label = parameter_axis(h, h[name], name)
    turning = velocity_axis(h)
    runs = np.nanmax(np.abs(h["mean_velocity"]), initial=0) > 0
    steps = runs and name == "torque"
    factor, height = turning if steps else amplitude_axis(h, "amplitude", "amplitude $x_0$")
    shown = factor * h["mean_velocity" if steps else "amplitude"]
    exponents = exponent_axis(h)
    fig, (top, below) = figure(h, 3.6, 2, 1, sharex=True, height_ratios=(2.4, 1))
    gradual = h["jump_gradual"] if "jump_gradual" in h else np.zeros(len(h["jump_parameter"]))
    ends = parameter_axis(h, h["jump_parameter"], name)[0]
    falling = len(x) > 1 and x[-1] < x[0]
    order = slice(None, None, -1) if falling else slice(None)
    for way in range(2):
        # Where both ways agree, the narrow line of the way down lies on the wide one of the way up.
        stops = ends[(h["jump_direction"] == way) & (gradual == 0)]
        held = np.isfinite(h["period"][way]) & steps
        for ax, values in (top, shown[way]), (below, exponents[0][way]):
            a, b, gaps = jumped(x[order], values[order], stops, held[order])
            ax.plot(a, b, lw=(2.6, 0.9)[way], color=f"C{way}", marker="." if len(x) < 3 else None,
                    label=f"{('up', 'down')[way]}wards")
            if ax is top and not steps:
                draw_jumps(ax, gaps, (way == 1) != falling, f"C{way}")
    if runs and not steps:
        right = top.twinx()
        right.plot(x, turning[0] * h["mean_velocity"].T, lw=0.8, ls=":")
        right.set_ylabel(turning[1] + " (dotted)")
    title = None
    if steps and "step_width" in h:
        write_steps(top, h, x, factor)
        title = "numbers: step (its width)"
    top.set_ylabel(height)
    for end, way, slow in zip(ends, h["jump_direction"], gradual):
        if slow:  # nothing jumps: a tick at the axis
            top.axvline(end, ymax=0.04, color=f"C{way}", lw=0.8)
    top.legend(title=title, title_fontsize=plt.rcParams["legend.fontsize"])
    below.axhline(0, color="0.7", lw=0.8)
    below.set(ylabel=exponents[1], xlabel=label)
    return fig


def draw_bifurcation_diagram(h, path):
    name = h.axis_of("strobe_x", 0)
    x, label = parameter_axis(h, h[name], name)
    if "lyapunov" in h:
        fig, (top, below) = figure(h, 3.6, 2, 1, sharex=True, height_ratios=(3, 1))
        exponents, text = exponent_axis(h)
        below.plot(x, exponents, ".-", ms=3, lw=0.6)
        below.axhline(0, color="0.7", lw=0.8)
        below.set_ylabel(text)
    else:
        fig, top = figure(h, 2.7)
        below = top
    strobes = h["strobe_x"]
    factor, height = amplitude_axis(h, "strobe_x", "$x$ at drive phase 0")
    top.plot(np.repeat(x, strobes.shape[1]), factor * strobes.ravel(), ",", color="black", rasterized=True)
    for value in h["cascade_parameter"] if "cascade_parameter" in h else ():
        top.axvline(parameter_axis(h, value, name)[0], color=SA, lw=0.6)
    if "cascade_limit" in h and np.isfinite(h["cascade_limit"]):
        top.axvline(parameter_axis(h, h["cascade_limit"], name)[0], color=LA, lw=0.9, ls="--",
                    label="doublings accumulate")
        top.legend()
    top.set_ylabel(height)
    below.set_xlabel(label)
    return fig
