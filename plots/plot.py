#!/usr/bin/env python3
"""Draw the runs of `resonance` as figures.

    python3 plots/plot.py FILE.h5 ... [-o FOLDER] [-f png|pdf|svg]

Each file becomes one picture of the same name. What a file holds is recognised by its variables.
A file NAME_inset.h5 beside NAME.h5 is drawn into it as an inset. Needs h5py and matplotlib
(Debian: python3-h5py python3-matplotlib).
"""
import argparse
import os
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patheffects import withStroke

plt.rcParams["figure.constrained_layout.use"] = True

SA, LA, FREE, EXACT = "tab:blue", "tab:red", "0.45", "black"


class Run:
    """The variables of a file as arrays, read when they are asked for."""

    def __init__(self, file):
        self.file, self.attrs = file, file.attrs

    def __contains__(self, name):
        return name in self.file

    def __getitem__(self, name):
        return self.file[name][()]


def free_frequency(amplitude):
    """Exact frequency of the free undamped pendulum, by the arithmetic-geometric mean."""
    a, b = np.ones_like(amplitude), np.cos(amplitude / 2)
    for _ in range(20):
        a, b = (a + b) / 2, np.sqrt(a * b)
    return a


def draw_free_oscillation(h, path):
    fig, ax = plt.subplots(figsize=(6, 4.5))
    a = h["amplitude"]
    ax.axhline(1, color=FREE, ls="-.", label="harmonic oscillator")
    ax.plot(a, h["frequency_exact"], color=EXACT, label="exact (elliptic integral)")
    ax.plot(a, h["frequency_kittel"], "--", color=SA, label="Kittel")
    ax.plot(a, h["frequency_belendez"], ":", color=LA, label="Beléndez")
    step = max(1, len(a) // 25)
    ax.plot(a[::step], h["frequency_integrated"][::step], "o", ms=4, mfc="none", color=EXACT,
            label="integrated")
    ax.set(xlabel="amplitude $x_0$ (rad)", ylabel=r"frequency $\omega_1/\omega_0$")
    ax.legend()
    return fig


def resonance_axes(ax, h, labels):
    amplitude, frequency = h["mean_loop_amplitude"], h["resonance_frequency"]
    edge, ragged, damping = h["peak"] == 1, h["peak"] == 2, h["damping"]
    smooth = h["peak"] == 0
    x = np.linspace(0, max(2.4, np.nanmax(amplitude) * 1.1), 400)
    x = x[x < np.pi]
    ax.plot(x, free_frequency(x), "--", color=FREE, label="free oscillation, exact")
    ax.axhline(1, color=FREE, ls="-.", label="harmonic oscillator")
    ax.plot(amplitude[smooth], frequency[smooth], "o", ms=3, color=SA, label="smooth peak")
    ax.plot(amplitude[edge], frequency[edge], "s", ms=3, color=LA, label="edge: SA ends")
    if ragged.any():
        ax.plot(amplitude[ragged], frequency[ragged], "x", ms=3, color=LA, label="ragged")
    for value in labels:
        i = np.argmin(abs(damping - value))
        if abs(damping[i] - value) < 1e-9 and np.isfinite(amplitude[i]):
            ax.annotate(f"{value:g}", (amplitude[i], frequency[i]), textcoords="offset points",
                        xytext=(5, 4), fontsize=7)


def draw_resonance_curve(h, path):
    fig, ax = plt.subplots(figsize=(7.5, 5.5))
    resonance_axes(ax, h, [0.06, 0.1, 0.15, 0.165, 0.2, 0.24, 0.32, 0.38, 0.5, 0.8, 0.9, 1.0])
    ax.set(xlabel=r"mean loop amplitude $\overline{x_0}$ (rad)",
           ylabel=r"resonance frequency $\overline{\omega_0}$", ylim=(0.72, 1.06), xlim=(0, 2.2))
    ax.legend(loc="upper right", fontsize=8, title="numbers: damping", title_fontsize=8)
    beside = path[:-3] + "_inset.h5"
    if os.path.exists(beside):
        with h5py.File(beside, "r") as other:
            inset = ax.inset_axes([0.06, 0.07, 0.44, 0.36])
            resonance_axes(inset, Run(other), [0.099, 0.28])
            inset.set(xlim=(0, 1.9), ylim=(0.8, 1.02), title="$F_0 = 0.1$")
            inset.title.set_size(8)
            inset.tick_params(labelsize=7)
    return fig


def draw_response(h, path):
    name = "drive_period" if "drive_period" in h else "drive_frequency"
    drive, damping = h[name][:], h["damping"]
    fig, ax = plt.subplots(figsize=(7.5, 5))
    phase = ax.twinx()
    shortest = np.nanmin(h["resonance_period"]) if np.any(np.isfinite(h["resonance_period"])) else 0
    for i, g in enumerate(damping):
        colour = f"C{i}"
        ax.plot(drive, h["mean_loop_amplitude"][i], color=colour, label=rf"$\gamma = {g:g}$")
        phase.plot(drive, h["phase_lag"][i] / np.pi, "--", color=colour)
        tau = h["resonance_period"][i]
        at = tau if name == "drive_period" else 2 * np.pi / tau
        if np.isfinite(at):
            ax.vlines(at, 0, h["resonance_amplitude"][i], color=colour, lw=0.8)
            left = (tau == shortest) == (name == "drive_period")  # outside of the lines
            ax.annotate(rf"$\tau_0 = {tau:.4f}$", (at, 0), fontsize=8, rotation=90, color=colour,
                        textcoords="offset points", xytext=(-4 if left else 4, 6), va="bottom",
                        ha="right" if left else "left")
    ax.set(xlabel=r"drive period $\tau$" if name == "drive_period" else r"drive frequency $\omega$",
           ylabel=r"amplitude $\langle x_0\rangle$ (rad, full lines)")
    ax.set_ylim(bottom=0)
    phase.set(ylabel=r"phase lag $\phi/\pi$ (broken lines)", ylim=(0, 1))
    ax.legend(loc="center right")
    return fig


def draw_orbit(h, path):
    fig, (top, bottom) = plt.subplots(2, 1, figsize=(6.5, 7))
    periods, x, closed = h["drive_phase"] / (2 * np.pi), h["x"], np.isfinite(h["period"])
    scale = 0.5 * np.ptp(x) / max(np.ptp(h["drive"]), 1e-300)
    top.plot(periods, x, color=LA, label="$x$")
    top.plot(periods, np.mean(x) + scale * h["drive"], "--", color=FREE,
             label=f"drive, magnified {scale:.1f} times")
    top.set(xlabel="drive periods", ylabel="$x$ (rad)")
    top.legend(loc="lower right", bbox_to_anchor=(1, 1), ncol=2, fontsize=8, frameon=False)
    label = "$x$ (rad)"
    if closed and h["winding"] != 0:  # the mean rotation encloses no area
        x, label = x - 2 * np.pi * h["winding"] / h["period"] * periods, "$x$ without rotation (rad)"
    bottom.plot(h["drive"], x, color=LA)
    if closed:
        title = (rf"area {h['loop_area']:.6f}, amplitude {h['amplitude']:.4f}, "
                 rf"phase lag {h['phase_lag'] / np.pi:.4f}$\pi$")
    elif np.isfinite(h["lyapunov_exponent"]):
        title = f"chaotic, Lyapunov exponent {h['lyapunov_exponent']:.4f}"
    else:
        title = "no closed orbit"
    bottom.set(xlabel="$F$", ylabel=label)
    bottom.set_title(title, fontsize=10)
    return fig


LABEL_NAMES = ["SA", "LA", "periodic", "running", "chaotic", "unresolved"]
NAMED_COLOURS = ["#4477aa", "#ee6677"]
OTHER_COLOURS = ["#228833", "#ccbb44", "#aa3377", "#66ccee", "#ee7733", "#004488", "#99ddaa"]
UNRESOLVED_COLOUR = "#bbbbbb"
OUTLINE = [withStroke(linewidth=2, foreground="black")]


def attractor_styles(h):
    """A name and a colour for each attractor: SA and LA always the same, others in their order."""
    labels, names, colours = h["attractor_label"], [], []
    others = 0
    for i, label in enumerate(labels):
        name = LABEL_NAMES[label]
        if name == "running":
            name += f" {h['attractor_winding'][i]:+d}/{h['attractor_period'][i]}"
        elif np.count_nonzero(labels == label) > 1:
            name += f" {np.count_nonzero(labels[: i + 1] == label)}"
        names.append(name)
        if label < 2:
            colours.append(NAMED_COLOURS[label])
        else:
            colours.append(OTHER_COLOURS[others % len(OTHER_COLOURS)])
            others += 1
    return names, colours


def draw_basins(h, path):
    x, v, index = h["x"], h["v"], h["attractor_index"]
    fig, ax = plt.subplots(figsize=(9, 5.5))
    step = max(1, len(x) // 1500), max(1, len(v) // 1500)
    names, colours = attractor_styles(h)
    bar_names, bar_colours, first = names, colours, 0
    if np.any(index < 0):
        bar_names, bar_colours, first = ["unresolved"] + names, [UNRESOLVED_COLOUR] + colours, -1
    n = len(bar_names)
    mesh = ax.imshow(index[:: step[0], :: step[1]].T, origin="lower", aspect="auto",
                     interpolation="nearest", extent=(x[0] / np.pi, x[-1] / np.pi, v[0], v[-1]),
                     cmap=ListedColormap(bar_colours),
                     norm=BoundaryNorm(np.arange(n + 1) + first - 0.5, max(n, 1)))
    bar = fig.colorbar(mesh, ax=ax, ticks=np.arange(n) + first)
    bar.ax.set_yticklabels(bar_names)
    if "boundary_x" in h:
        gaps = np.flatnonzero(np.diff(h["boundary_piece"])) + 1
        ax.plot(np.insert(h["boundary_x"] / np.pi, gaps, np.nan),
                np.insert(h["boundary_v"], gaps, np.nan), color="black", lw=0.5)
    if "strobe_x" in h:
        for t, name in reversed(list(enumerate(h["temperature"]))):  # the cold clouds on top
            sx, sv = h["strobe_x"][t].ravel(), h["strobe_v"][t].ravel()
            ax.plot(sx / np.pi, sv, ",", color=["lime", "orange", "yellow"][t % 3])
            ax.plot([], [], "s", color=["lime", "orange", "yellow"][t % 3], label=f"T = {name:g}")
        ax.legend(loc="lower right")
    for i, name in enumerate(names):
        if not np.isfinite(h["attractor_x"][i]):
            continue
        ax.plot(h["attractor_x"][i] / np.pi, h["attractor_v"][i], "x", ms=7, mew=1.5, color="black")
        ax.annotate(name, (h["attractor_x"][i] / np.pi, h["attractor_v"][i]), color="white",
                    textcoords="offset points", xytext=(6, 6), path_effects=OUTLINE)
    ax.axhline(0, color="white", lw=0.6)
    ax.set(xlabel=r"$x(0)/\pi$", ylabel="$v(0)$", xlim=(x[0] / np.pi, x[-1] / np.pi),
           ylim=(v[0], v[-1]))
    return fig


def curves(h, what, x, y):
    """Curves of folds or flips, one after the other: is it an end of SA or LA, x, y."""
    if f"{what}_curve" not in h:
        return
    number = h[f"{what}_curve"]
    for k in np.unique(number):
        here = number == k
        named = f"{what}_branch" in h and np.any(h[f"{what}_branch"][here] < 2)
        yield named, h[f"{what}_{x}"][here], h[f"{what}_{y}"][here]


def draw_phase_diagram(h, path):
    damping, omega = h["damping"], h["drive_frequency"]
    fig, (left, right, cuts) = plt.subplots(1, 3, figsize=(16, 5), width_ratios=[1.15, 1.15, 1])
    names = ["SA", "LA", "coexistence", "single", "other"]
    colours = ListedColormap(["#4477aa", "#ee6677", "#ccbb44", "#dddddd", "#228833"])
    mesh = left.pcolormesh(omega, damping, h["regime"], shading="nearest", rasterized=True,
                           cmap=colours, norm=BoundaryNorm(np.arange(-0.5, 5), 5))
    bar = fig.colorbar(mesh, ax=left, ticks=range(5))
    bar.ax.set_yticklabels(names)
    area = right.pcolormesh(omega, damping, h["mean_loop_area"], shading="nearest", cmap="viridis",
                            rasterized=True)
    fig.colorbar(area, ax=right, label="mean loop area")
    for ax in (left, right):
        for named, omega_of, gamma_of in curves(h, "fold", "frequency", "damping"):
            ax.plot(omega_of, gamma_of, color="black", lw=1.4 if named else 0.4)
        for _, omega_of, gamma_of in curves(h, "flip", "frequency", "damping"):
            ax.plot(omega_of, gamma_of, ":", color="black", lw=0.8)
        if "cusp_frequency" in h:
            ax.plot(np.atleast_1d(h["cusp_frequency"]), np.atleast_1d(h["cusp_damping"]),
                    "*", color="black", ms=9)
        ax.set(xlabel=r"drive frequency $\omega$", ylabel=r"damping $\gamma$",
               xlim=(omega[0], omega[-1]), ylim=(damping[0], damping[-1]))
    for width, style, label in ((1.4, "-", "folds: SA or LA ends"), (0.4, "-", "folds of others"),
                                (0.8, ":", "period doubling,\nsymmetry breaking")):
        left.plot([], [], style, color="black", lw=width, label=label)
    left.plot([], [], "*", color="black", ms=9, ls="", label="cusp")
    left.legend(loc="upper left", fontsize=7, framealpha=0.9)
    # Sections through the surface: smooth above the cusp, a jump at SA's end below it.
    chosen = np.unique(np.linspace(0, len(damping) - 1, 9).round().astype(int))
    for colour, i in zip(plt.cm.plasma(np.linspace(0, 0.85, len(chosen))), chosen):
        cuts.plot(omega, h["mean_loop_area"][i], color=colour, lw=1,
                  label=rf"$\gamma = {damping[i]:.4g}$")
    cuts.set(xlabel=r"drive frequency $\omega$", ylabel="mean loop area",
             xlim=(omega[0], omega[-1]))
    cuts.set_ylim(bottom=0)
    cuts.legend(fontsize=7)
    return fig


def draw_branches(h, path):
    fig, ax = plt.subplots(figsize=(7, 6))
    omega = h["drive_frequency"]
    number, damping, stable = h["branch_number"], h["branch_damping"], h["branch_stable"] == 1
    for i, g in enumerate(h["damping"]):
        colour = f"C{i}"
        ax.plot(h["mean_loop_amplitude"][i], omega, ".", ms=3, color=colour,
                label=rf"$\gamma = {g:g}$, ensemble")
        for k in np.unique(number[abs(damping - g) < 1e-9]):
            here = number == k
            a, w = h["branch_amplitude"][here], h["branch_frequency"][here]
            for mask, style in ((stable[here], "-"), (~stable[here], ":")):
                ax.plot(np.where(mask, a, np.nan), w, style, color=colour, lw=1)
    for style, label in (("-", "stable"), (":", "unstable")):
        ax.plot([], [], style, color="black", lw=1, label="branches, " + label)
    for named, amplitude, frequency in curves(h, "fold", "amplitude", "frequency"):
        if named:
            ax.plot(amplitude, frequency, color="black", lw=2, alpha=0.5,
                    label="folds, all dampings")
    ax.plot(h["free_amplitude"], h["free_frequency"], "--", color=FREE, lw=0.8,
            label="free pendulum")
    ax.set(xlabel=r"amplitude $\langle x_0\rangle$ (rad)", ylabel=r"drive frequency $\omega$",
           ylim=(omega[0], omega[-1]), xlim=(0, 2.6))
    ax.legend(fontsize=8)
    return fig


def text(names):
    return [n.decode() if isinstance(n, bytes) else str(n) for n in names]


LOST = 0.1  # an error beyond which a pendulum is somewhere else: speed says nothing then


def draw_work_precision(h, path):
    fig, axes = plt.subplot_mosaic([["speed", "honest"], ["legend", "legend"]], figsize=(13, 7.5),
                                   width_ratios=(3, 2), height_ratios=(7, 1))
    ax, honest = axes["speed"], axes["honest"]
    names, error = text(h["method_name"]), h["error_100"]
    # Fixed and adaptive steps of one table share a colour.
    table = [n.replace("block_adaptive", "block_fixed") if len(names) > 10 else n for n in names]
    colours = {t: f"C{i}" for i, t in enumerate(dict.fromkeys(table))}
    for i, name in enumerate(names):
        style = {"color": colours[table[i]], "ms": 4, "mfc": "none" if "adaptive" in name else None,
                 "ls": "--" if "adaptive" in name else "-", "marker": "s" if "adaptive" in name else "o"}
        good = (error[i] > 0) & (error[i] < LOST) & np.isfinite(h["throughput"][i])
        ax.loglog(error[i][good], h["throughput"][i][good] / 1e6, label=name, **style)
        estimate = h["estimated_error"][i]
        good &= np.isfinite(estimate) & (estimate > 0)
        honest.loglog(error[i][good], estimate[good], **{**style, "ls": ""})
    if text([h["unit"]])[0] == "ensemble":  # what the others' figures are of
        for i, name in enumerate(text(h["others/method"])):
            ax.loglog(h["others/error"], h["others/throughput"][i] / 1e6, marker="x", ls=":",
                      color=f"{0.1 + 0.14 * i:.2f}", label=f"{name}, elsewhere")
    line = np.array([1e-15, LOST])
    for factor, label, style in ((1, "the error", "-"), (0.1, "a tenth: promised at least", "--")):
        honest.loglog(line, factor * line, color=FREE, lw=0.8, ls=style, label=label)
    honest.legend(fontsize=8)
    ax.set(xlabel="largest error after 100 periods", ylabel="million pendulum-periods a second")
    honest.set(xlabel="largest error after 100 periods", ylabel="largest estimate of it")
    for panel in (ax, honest):
        panel.invert_xaxis()
        panel.grid(True, alpha=0.3)
    axes["legend"].axis("off")
    axes["legend"].legend(*ax.get_legend_handles_labels(), loc="center", fontsize=8, ncol=6)
    return fig


def draw_hard_cases(h, path):
    """Figures and the naive way's over their bounds; where nothing at all is allowed, as counts."""
    names, bound = text(h["case_name"]), h["bound"]
    figure, naive = h["figure"], h["naive_figure"]
    unit = np.where(bound > 0, bound, 1)
    least, most = 1e-8, 1e8
    fig, ax = plt.subplots(figsize=(7, 0.16 * len(names) + 1.5))
    y = np.arange(len(names))
    ax.axvline(1, color=EXACT, lw=1)
    ax.plot(np.clip(naive / unit, least, most), y, "x", ms=4, color=LA, label="plain adaptive ARKODE")
    ax.plot(np.clip(figure / unit, least, most), y, "o", ms=3.5, color=SA, label="libpendres")
    ax.set_yticks(y, [n if b > 0 else n + " (count)" for n, b in zip(names, bound)], fontsize=6)
    ax.set(xscale="log", ylim=(len(names), -1), xlim=(least / 3, most * 3),
           xlabel="figure over its bound; at either end: that or beyond")
    ax.grid(axis="y", lw=0.3)
    ax.legend(loc="lower right", fontsize=8)
    return fig


def draw_switching(h, path):
    fig, ax = plt.subplots(figsize=(6.5, 5))
    t = h["temperature"]
    for name, colour in (("rate_sa_la", SA), ("rate_la_sa", LA)):
        if name in h:
            ax.errorbar(1 / t, h[name], yerr=h[name + "_error"], fmt="o", color=colour, label=name)
    ax.set(xlabel="1/T", ylabel="switching rate", yscale="log")
    ax.legend()
    return fig


def draw_hysteresis(h, path):
    name = h.file["amplitude"].dims[1][0].name.rsplit("/", 1)[-1]
    x, amplitude, velocity, lyapunov = (h[n] for n in
                                        (name, "amplitude", "mean_velocity", "lyapunov"))
    figure, (top, below) = plt.subplots(2, 1, sharex=True, figsize=(7, 6), height_ratios=(2, 1))
    for way, marker in enumerate("^v"):
        words = f"{name.replace('_', ' ')} goes {('up', 'down')[way]}"
        top.plot(x, amplitude[way], marker, ms=4, mfc="none", label=words, color=f"C{way}")
        below.plot(x, lyapunov[way], marker, ms=4, mfc="none", color=f"C{way}")
    for value, way, gradual in zip(h["jump_parameter"], h["jump_direction"], h["jump_gradual"]):
        for ax in (top, below):
            ax.axvline(value, color=f"C{way}", lw=0.8, ls=":" if gradual else "-")
    if np.nanmax(np.abs(velocity)) > 0:
        right = top.twinx()
        right.plot(x, velocity.T, lw=0.8)
        right.set_ylabel("mean velocity")
    top.set_ylabel("amplitude")
    top.legend(frameon=False)
    below.axhline(0, color="0.7", lw=0.8)
    below.set_ylabel("Lyapunov exponent")
    below.set_xlabel(name.replace("_", " "))
    return figure


DRAWERS = [  # the first whose variable is there draws the file
    ("frequency_kittel", draw_free_oscillation),
    ("peak", draw_resonance_curve),
    ("resonance_period", draw_response),
    ("drive_phase", draw_orbit),
    ("jump_parameter", draw_hysteresis),
    ("label", draw_basins),
    ("branch_frequency", draw_branches),
    ("regime", draw_phase_diagram),
    ("throughput", draw_work_precision),
    ("naive_figure", draw_hard_cases),
    ("rate_sa_la", draw_switching),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("files", nargs="+", metavar="FILE.h5")
    parser.add_argument("-o", "--output", default=".", help="folder for the pictures")
    parser.add_argument("-f", "--format", default="png", choices=["png", "pdf", "svg"])
    arguments = parser.parse_args()
    failed = 0
    os.makedirs(arguments.output, exist_ok=True)
    for path in arguments.files:
        name = os.path.splitext(os.path.basename(path))[0]
        with h5py.File(path, "r") as file:
            h = Run(file)
            draw = next((d for variable, d in DRAWERS if variable in h), None)
            if draw is None:
                print(f"{path}: nothing here that can be drawn", file=sys.stderr)
                failed = 1
                continue
            figure = draw(h, path)
            title = h.attrs.get("title", "")
            title = title.decode() if isinstance(title, bytes) else title
        figure.suptitle(title, fontsize=10)
        target = os.path.join(arguments.output, f"{name}.{arguments.format}")
        figure.savefig(target, dpi=130)
        plt.close(figure)
        print(target)
    return failed


if __name__ == "__main__":
    sys.exit(main())
