#!/usr/bin/env python3
"""plots_axes.py -- what axes say: units with their prefixes, from the file or the command line; and
lines of sweeps, which end where states do."""
import os
import sys
import types

import h5py
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "python", "pendres"))
from plots import curves, drawn, maps, style  # noqa: E402

style.plt.switch_backend("Agg")
style.plt.rcParams.update(style.SETTINGS)


def options(unit=None, frequency=False):
    return types.SimpleNamespace(unit=unit, frequency=frequency, size=None)


def check(what, got, expected):
    if got != expected:
        sys.exit(f"{what}: {got!r} instead of {expected!r}")


for value, expected in ((1.2e6, (1e6, "M")), (999.0, (1.0, "")), (6.9e-10, (1e-12, "p")),
                        (1e-3, (1e-3, "m")), (3e20, (1e12, "T"))):
    check(f"prefix of {value}", style.prefix_of(value), expected)

with h5py.File("axes.h5", "w", driver="core", backing_store=False) as file:
    file["a1"] = 1.0  # of an oscillator, whose x is no angle
    file["drive_frequency"] = np.array([0.999, 1.005])
    file["amplitude"] = np.array([0.01, 0.08, np.nan])
    file["damping"] = 2e-4
    run = style.Run(file, options())
    check("label without units", style.amplitude_axis(run, "amplitude", "A"), (1.0, "A"))
    check("label", style.drive_axis(run, 1.0, "drive_frequency")[1], r"drive frequency $\omega$")
    for name, factor, units in (("drive_frequency", 1.2e6, "Hz"), ("amplitude", 7.5e-7, "m"),
                                ("damping", 7.5e6, "s-1")):
        file[name].attrs["si_factor"], file[name].attrs["si_units"] = factor, units
    check("frequency", style.drive_axis(run, 1.0, "drive_frequency"), (1.2, "drive frequency (MHz)"))
    factor, label = style.amplitude_axis(run, "amplitude", "A")
    check("amplitude", (round(0.08 * factor, 9), label), (60.0, "A (nm)"))
    check("parameter", style.parameter_text(run, 2e-4, "damping"), r"$\gamma$ = 1500 s$^{-1}$")
    file["damping"].attrs["si_factor"] = 7.5e14
    check("fast", style.parameter_text(run, 2e-4, "damping"), r"$\gamma$ = 150 ns$^{-1}$")
    hertz = style.Run(file, options(unit=0.83))
    check("hertz", style.drive_axis(hertz, 1.0, "drive_frequency"), (0.83, "drive frequency (Hz)"))
    # A drive of the natural frequency has the period 2 pi, which is 1/f0.
    asked = style.Run(file, options(unit=0.5))
    check("period", style.drive_axis(asked, 2 * np.pi, "drive_period"), (2.0, "drive period (s)"))

# A step is drawn as far as its end, another curve as far as it was computed; neither goes across.
x, y = np.arange(5.0), np.array([0.0, 0.0, 1.0, 1.0, 1.0])
held = np.array([True, True, False, False, False])
a, b, gaps = curves.jumped(x, y, np.array([1.5]), held)
check("line", (a[:3].tolist(), np.isnan(b).tolist()), ([0.0, 1.0, 1.5], [k == 3 for k in range(8)]))
check("gap", gaps, [((1.5, 0.0), (2.0, 1.0))])


def labels(name):
    """The labels of the axes of a picture, and of its legend's entries."""
    options = types.SimpleNamespace(unit=None, frequency=False, size=None, boundary=True, title=True)
    (_, figure), = drawn.draw(name, options)
    found = [text for ax in figure.axes for text in (ax.get_xlabel(), ax.get_ylabel())]
    return found, [text for ax in figure.axes for text in ax.get_legend_handles_labels()[1]]


# Runs in a laboratory's units are drawn in them; what noise does is drawn whatever its names are.
check("basins in SI", labels("metres.h5")[0][:2], ["$x(0)$ (nm)", "$v(0)$ (m s$^{-1}$)"])
check("rates in SI", labels("kelvin.h5")[0], ["$1/T$ (K$^{-1}$)", "switching rate (s$^{-1}$)"])
check("escape", [text.partition(",")[0] for text in labels("escape.h5")[1]],
      ["attractor 1 to infinity"])
check("fit", labels("fit.h5")[1][-1], "fit")

# Several attractors of one kind have their numbers in the file and on the terminal.
names = maps.attractor_styles({"attractor_label": np.array([2, 2, 4])})[0]
check("names", names, ["periodic 0", "periodic 1", "chaotic"])

# A lone orbit has the name of its branch: beside two states that of the nearer amplitude, beside a
# lone one the same, and none where the two sides disagree.
from plots.outer import named_by_branch  # noqa: E402

none = float("nan")
for labels, amplitudes, expected in (
        ([[2, -1], [2, -1], [0, 1], [2, -1]], [[1, none], [1.1, none], [0.4, 1.2], [0.13, none]],
         [[1, -1], [1, -1], [0, 1], [0, -1]]),
        ([[0, 1], [2, -1], [0, 1]], [[0.5, 1.2], [1, none], [0.2, 0.9]],
         [[0, 1], [1, -1], [0, 1]]),
        ([[0, 1], [2, -1], [0, 1]], [[0.9, 3.0], [1, none], [0.2, 1.1]],
         [[0, 1], [2, -1], [0, 1]]),
        ([[2, -1], [2, -1]], [[1, none], [2, none]], [[2, -1], [2, -1]])):
    got = named_by_branch(np.array(labels), np.ones_like(labels), np.array(amplitudes))
    check(f"names of {labels}", got.tolist(), expected)
