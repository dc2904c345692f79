#!/usr/bin/env python3
"""Look into a phase diagram: click a point to see its orbits, basins and branches.

    python3 plots/view.py f08.h5
    python3 plots/view.py f08.h5 --at 0.8,0.13 -o look.png     one look as a picture, no window

What a click shows is computed at once by the library, through its Python package (`python/`), at
the point clicked and the drive amplitude of the run. Needs h5py, matplotlib with a window toolkit
(Debian: python3-h5py python3-matplotlib python3-tk) and cffi.
"""
import argparse
import os
import sys

import h5py
import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap

from curves import draw_branch
from maps import REGIMES, add_bifurcations
from style import LA, MORE, SA, Run, plt

TOOLKITS = ["qtagg", "gtk3agg", "tkagg", "wxagg", "macosx"]
WINDOW = (193, 144)  # starts of the picture of basins, in x and v


class View:
    """A window: the diagram, and of the point that was clicked last its states."""

    def __init__(self, run):
        import pendres
        self.library, self.run = pendres, run
        self.amplitude = float(run["drive_amplitude"])
        self.figure, axes = plt.subplots(2, 2, figsize=(10, 8))
        (self.map, self.orbits), (self.branches, self.basins) = axes
        self.draw_map()
        self.marker, = self.map.plot([], [], "x", color="black", ms=9, mew=2)
        self.figure.canvas.mpl_connect("button_press_event", self.clicked)

    def draw_map(self):
        omega, damping = self.run["drive_frequency"], self.run["damping"]
        self.map.pcolormesh(omega, damping, self.run["regime"], shading="nearest",
                            cmap=ListedColormap(REGIMES[1]),
                            norm=BoundaryNorm(np.arange(-0.5, 5), 5))
        add_bifurcations(self.map, self.run)
        self.map.set(xlabel=r"drive frequency $\omega$", ylabel=r"damping $\gamma$",
                     title="regimes",
                     xlim=(omega[0], omega[-1]),
                     ylim=(damping[0], damping[-1]))

    def clicked(self, event):
        if event.inaxes is self.map and event.xdata > 0 and event.ydata > 0:
            self.look(event.xdata, event.ydata)

    def look(self, omega, damping):
        """Show the states of a point."""
        p = self.library.pendulum(drive_amplitude=self.amplitude, damping=damping,
                                  drive_frequency=omega)
        self.marker.set_data([omega], [damping])
        x = np.linspace(-np.pi / 2, 3 * np.pi / 2, WINDOW[0])[1:]
        v = np.linspace(-2, 2, WINDOW[1])
        grid = self.library.basins(p, x, v)
        table = grid.attractors.table
        names = [self.library.Label(label).name for label in table.label]
        colours = [{"SA": SA, "LA": LA}.get(name, MORE[i % len(MORE)])
                   for i, name in enumerate(names)]
        self.draw_orbits(table, names, colours)
        self.draw_basins(grid, x, v, colours)
        self.draw_branches(table, damping, omega)
        self.figure.suptitle(rf"$\gamma$ = {damping:.4g}, $\omega$ = {omega:.4g}, "
                             rf"$F_0$ = {self.amplitude:g}", fontsize=10)
        self.figure.canvas.draw_idle()

    def draw_orbits(self, table, names, colours):
        self.orbits.clear()
        for attractor, name, colour in zip(table, names, colours):
            orbit = attractor.orbit
            if orbit.period < 1 or not np.isfinite(orbit.amplitude):
                continue  # chaotic: no orbit to draw
            x, v = self.library.orbit_sample(orbit, 256)
            y = x - np.pi / 2
            y = y - 2 * np.pi * np.round(np.mean(y) / (2 * np.pi))
            self.orbits.plot(np.append(y, y[0]), np.append(v, v[0]), color=colour,
                             label=f"{name}: {orbit.amplitude:.4f} rad, lag {orbit.phase_lag:.4f}")
        self.orbits.set(xlabel="angle (rad)", ylabel="velocity", title="orbits")
        self.orbits.legend(loc="upper right")

    def draw_basins(self, grid, x, v, colours):
        self.basins.clear()
        n = len(colours)
        self.basins.pcolormesh(x / np.pi, v, grid.state.attractor.T, shading="nearest",
                               cmap=ListedColormap(["0.6", *colours]),
                               norm=BoundaryNorm(np.arange(-1.5, n), n + 1))
        self.basins.set(xlabel=r"$x(0)/\pi$", ylabel="$v(0)$", title="basins (grey: unresolved)")

    def draw_branches(self, table, damping, omega):
        self.branches.clear()
        low, high = self.run["drive_frequency"][[0, -1]]
        closed = table.orbit[np.isfinite(table.orbit.amplitude)]
        for branch in self.library.branches(closed, low, high) if len(closed) else []:
            orbit = branch.points.orbit
            draw_branch(self.branches, orbit.pendulum.drive_frequency, orbit.amplitude,
                        orbit.stable != 0, branch.points.kind, "black")
        self.branches.axvline(omega, color="0.8", zorder=0)
        self.branches.set(xlabel=r"drive frequency $\omega$", ylabel="amplitude (rad)",
                          title=rf"branches at $\gamma$ = {damping:.4g}; dashed: unstable")


def window():
    """A toolkit that can open one."""
    for name in [os.environ.get("MPLBACKEND"), *TOOLKITS]:
        try:
            if name:
                plt.switch_backend(name)
                return
        except ImportError:
            pass
    raise ValueError("matplotlib has no way to open a window (Debian: python3-tk), or there is no "
                     "display; --at OMEGA,DAMPING -o FILE draws without one")


def parse():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("file", metavar="FILE.h5", help="a phase diagram, such as f08.h5")
    parser.add_argument("--at", metavar="OMEGA,DAMPING", help="look there first")
    parser.add_argument("-o", "--output", help="write the picture to a file instead of a window")
    parser.add_argument("--dpi", type=float, default=100, help="of that, dots an inch (100)")
    options = parser.parse_args()
    options.unit, options.frequency, options.boundary, options.size = None, False, True, None
    return options


def open_view(path, options):
    try:
        file = h5py.File(path, "r")
    except OSError:
        raise ValueError("there is no such file, or it is no HDF5 file") from None
    run = Run(file, options)
    missing = [n for n in ("regime", "drive_frequency", "drive_amplitude") if n not in run]
    if missing or run["regime"].ndim != 2 or min(run["regime"].shape) < 2:
        raise ValueError("this is no phase diagram over damping and drive frequency")
    try:
        return View(run)
    except ImportError as why:
        raise ValueError(f"the Python package pendres is needed: {why}") from None


def main():
    options = parse()
    try:
        if not options.output:
            window()
        view = open_view(options.file, options)
        if options.at:
            view.look(*map(float, options.at.split(",")))
    except ValueError as why:
        print(f"{options.file}: {why}", file=sys.stderr)
        return 1
    if options.output:
        view.figure.savefig(options.output, dpi=options.dpi)
    else:
        view.map.set_title("regimes: click a point")
        plt.show()
    return 0


if __name__ == "__main__":
    sys.exit(main())
