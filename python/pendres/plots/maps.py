"""Pictures of planes: basins of attraction, phase diagrams, the loop area as a surface."""
import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke

from .curves import bifurcation_curves, column_of, exponent_axis, unit_of_x
from .curves import draw_response as curve_response
from .style import (COEXISTENCE, ESCAPE, LA, MORE, NAMED, OTHER, SA, SINGLE, UNRESOLVED, around,
                   WIDE, WIDTH, amplitude_axis, colours_of, figure, frequency, legend,
                   page, parameter_axis, parameter_text, plt)

OUTLINE = [withStroke(linewidth=2, foreground="black")]
MOST_PIXELS = 1500  # a side; finer grids are thinned
MOST_NAMES = 20     # beside a bar of colours
MOST_PLANES = 6     # of a volume


def attractor_styles(h):
    """A name and a colour for each attractor: SA and LA always the same, others in their order."""
    labels, names, colours = h["attractor_label"], [], []
    for i, label in enumerate(labels):
        name = NAMED[label]
        if name == "running" and h["attractor_period"][i] > 0:
            name += f" {h['attractor_winding'][i]:+d}/{h['attractor_period'][i]}"
        elif np.count_nonzero(labels == label) > 1:
            name += f" {i}"  # its number in the file and in the table on the terminal
        names.append(name)
        others = sum(c not in (SA, LA) for c in colours)
        colours.append((SA, LA)[label] if label < 2 and (SA, LA)[label] not in colours
                       else MORE[others % len(MORE)])
    return names, colours


def label_plane(fig, ax, index, extent, names, colours):
    """Numbers of attractors as coloured areas, with a bar of their names; negative ones are on
    none."""
    first, ends = 0, index
    for end, name, colour in ((-1, "unresolved", UNRESOLVED), (-2, "escape", ESCAPE),
                              (-3, "unstable", "black")):
        if np.any(ends == end):
            names, colours, first = [name] + names, [colour] + colours, first - 1
            index = np.where(ends == end, first, index)
    n = max(len(names), 1)
    mesh = ax.imshow(index.T, origin="lower", aspect="auto", interpolation="nearest",
                     extent=extent, cmap=ListedColormap(colours or [UNRESOLVED]),
                     norm=BoundaryNorm(np.arange(n + 1) + first - 0.5, n))
    step = -(-n // MOST_NAMES)
    bar = fig.colorbar(mesh, ax=ax, ticks=np.arange(0, len(names), step) + first)
    bar.ax.set_yticklabels(names[::step])


def write_wells(ax, h, thin):
    """The number of the well in the middle of each large area of one well, as in print."""
    well, index = h["well"][:: thin[0], :: thin[1]], h["attractor_index"][:: thin[0], :: thin[1]]
    x, v = h["x"][:: thin[0]] / unit_of_x(h)[0], h["v"][:: thin[1]] * v_axis(h)[0]
    stays = (h["attractor_period"] > 0) & (h["attractor_winding"] == 0)  # what rotates is in none
    inside = (index >= 0) & np.append(stays, False)[np.maximum(index, -1)]
    for number in np.unique(well[inside]):
        here = (well == number) & inside
        if np.count_nonzero(here) < 0.01 * here.size:
            continue
        # The longest run along x, in the row where it is longest, is inside of the area.
        best = (0, 0, 0)
        for j in range(len(v) // 25, len(v) - len(v) // 25, max(1, len(v) // 64)):
            edges = np.flatnonzero(np.diff(np.concatenate(([0], here[:, j].astype(int), [0]))))
            for a, b in zip(edges[::2], edges[1::2]):
                best = max(best, (b - a, (a + b) // 2, j))
        if best[0] > 0.03 * len(x):
            ax.text(x[min(best[1], len(x) - 1)], v[best[2]], f"{number:d}", color="white",
                    fontsize=8, ha="center", va="center", path_effects=OUTLINE)


def v_axis(h):
    """What velocities are multiplied by to be drawn, and the label of their axis."""
    factor, unit = h.scale("v")
    return factor, f"$v(0)$ ({unit})" if unit else "$v(0)$"


def draw_clouds(ax, h):
    """Noisy Poincaré points: a marker and a grey each, which colours of basins do not hide."""
    temperatures, handles = h["temperature"], []
    greys = ["white", "black", "0.6"]
    for t in reversed(range(len(temperatures))):  # the cold clouds on top
        x, v = h["strobe_x"][t].ravel(), h["strobe_v"][t].ravel()
        some = np.flatnonzero(np.isfinite(x))
        some = some[:: max(1, len(some) // 3000)]
        style = {"marker": "o+x"[t % 3], "color": greys[t % 3], "ls": ""}
        ax.plot(x[some] / unit_of_x(h)[0], v[some] * v_axis(h)[0], mew=0.4, rasterized=True,
                ms=1.2 if t % 3 == 0 else 2.2, **style)
        handles.insert(0, Line2D([], [], ms=5, mec="black" if t % 3 == 0 else None, **style,
                                 label=f"$T = {temperatures[t]:g}$"))
    ax.legend(handles=handles, loc="lower right", facecolor="0.85")


def wells_apart(h, index, thin):
    """Numbers of ends for numbers of attractors; a name and a colour for each well of each."""
    names, _ = attractor_styles(h)
    if "basin_well_fraction" in h:
        attractor, well = h["basin_well_attractor"], h["basin_well_number"]
    else:
        well = np.unique(h["well"][h["attractor_index"] >= 0])
        attractor = np.zeros_like(well)
    span = int(np.max(np.abs(well), initial=0)) + 1
    keys = attractor.astype(np.int64) * 2 * span + well  # ascending, as the wells are
    here = index.astype(np.int64) * 2 * span + h["well"][:: thin[0], :: thin[1]]
    ends = np.where(index >= 0, np.searchsorted(keys, here), index)
    several = len(names) > 1
    return (ends, [f"{names[a]}, {w}" if several else f"well {w}" for a, w in zip(attractor, well)],
            [plt.get_cmap("tab20")(i * 7 % 20) for i in range(len(well))])


def draw_basins(h, path):
    (unit, label), (speed, beside) = unit_of_x(h), v_axis(h)
    x, v = h["x"] / unit, h["v"] * speed
    fig, ax = figure(h, 2.8)
    thin = tuple(max(1, -(-len(axis) // MOST_PIXELS)) for axis in (x, v))
    index = h["attractor_index"][:: thin[0], :: thin[1]]
    names, colours = attractor_styles(h)
    extent = (x[0], x[-1], v[0], v[-1])
    # Where all starts end on one attractor, the well is what they differ in.
    if "basin_well_fraction" in h or (len(names) == 1 and np.ptp(h["well"]) > 0):
        ends, well_names, well_colours = wells_apart(h, index, thin)
        label_plane(fig, ax, ends, extent, well_names, well_colours)
    else:
        label_plane(fig, ax, index, extent, names, colours)
    if "boundary_x" in h and h.options.boundary:
        gaps = np.flatnonzero(np.diff(h["boundary_piece"])) + 1
        ax.plot(np.insert(h["boundary_x"] / unit, gaps, np.nan),
                np.insert(h["boundary_v"] * speed, gaps, np.nan), color="black", lw=0.5)
    if "strobe_x" in h:
        draw_clouds(ax, h)
    elif "well" in h and "a1" not in h:  # other forces have no numbered wells
        write_wells(ax, h, thin)
    for i, name in enumerate(names):
        at = h["attractor_x"][i] / unit, h["attractor_v"][i] * speed
        if np.all(np.isfinite(at)) and x[0] <= at[0] <= x[-1]:
            ax.plot(*at, "X", ms=6, mew=0.8, color="white", mec="black")
            # At the right the name is below the mark, and ends inside of the picture.
            share = (at[0] - x[0]) / (x[-1] - x[0])
            right = share > 0.6
            ax.annotate(name, at, color="white", fontsize=8, textcoords="offset points",
                        xytext=(0, -6) if right else (6, 6), path_effects=OUTLINE,
                        ha="left" if not right else "center" if share < 0.85 else "right",
                        va="top" if right else "bottom")
    ax.set(xlabel=label, ylabel=beside, xlim=(x[0], x[-1]), ylim=(v[0], v[-1]))
    return fig


REGIMES = (["SA", "LA", "coexistence", "single", "other"], [SA, LA, COEXISTENCE, SINGLE, OTHER])


def draw_one_damping(h):
    """A phase diagram of a single damping is a line: shares and mean loop area."""
    name = h.axis_of("mean_loop_area", 1)
    drive, label = parameter_axis(h, h[name], name)
    fig, (top, below) = figure(h, 3.6, 2, 1, sharex=True)
    top.plot(drive, h["sa_fraction"][0], color=SA, label="SA")
    top.plot(drive, h["la_fraction"][0], color=LA, label="LA")
    top.set(ylabel="share of the members", ylim=(-0.03, 1.03))
    top.legend()
    below.plot(drive, h["mean_loop_area"][0], color="black")
    below.set(xlabel=label, ylabel="mean loop area", xlim=around(drive, 0.0))
    below.set_ylim(bottom=0)
    return fig


def add_bifurcations(ax, h):
    for named, omega, damping in bifurcation_curves(h, "fold", "frequency", "damping"):
        ax.plot(frequency(h, omega)[0], damping, color="black", lw=1.4 if named else 0.4)
    for _, omega, damping in bifurcation_curves(h, "flip", "frequency", "damping"):
        ax.plot(frequency(h, omega)[0], damping, ":", color="black", lw=0.8)
    if "cusp_frequency" in h:
        ax.plot(frequency(h, np.atleast_1d(h["cusp_frequency"]))[0],
                np.atleast_1d(h["cusp_damping"]), "*", color="black", ms=8)


# What members do where the names SA and LA do not tell, and the bits of `other` that say so.
ELSEWHERE = (["one state", "asymmetric", "longer periods", "running", "chaotic", "unresolved"],
             [SINGLE, MORE[3], MORE[0], MORE[4], "black", UNRESOLVED])


def draw_plane(h, rows):
    """A phase diagram over other axes than the damping: what members do, and the curves."""
    name = h.axis_of("regime", 1)
    (across, below), (up, beside) = (parameter_axis(h, h[n], n) for n in (name, rows))
    fig, ax = figure(h, 3.9)
    kind, regime, other = h["regime"], h["regime"], h["other"]
    for bit in range(5):  # what comes last is the most telling
        kind = np.where((regime == 4) & (other & (1 << bit) != 0), 4 + bit, kind)
    names, colours = REGIMES[0][:3] + ELSEWHERE[0], REGIMES[1][:3] + ELSEWHERE[1]
    ax.pcolormesh(across, up, kind, shading="nearest", rasterized=True,
                  cmap=ListedColormap(colours), norm=BoundaryNorm(np.arange(-0.5, 9), 9))
    handles = [Patch(color=colours[k], label=names[k]) for k in np.unique(kind)]
    if h.options.boundary:
        columns = column_of(name), column_of(rows)
        for what, style, text in (("fold", "-", "folds"),
                                  ("flip", ":", "doubling, symmetry breaking")):
            curves = list(bifurcation_curves(h, what, *columns))
            for _, x, y in curves:
                ax.plot(parameter_axis(h, x, name)[0], parameter_axis(h, y, rows)[0], style,
                        color="black", lw=0.9)
            if curves:
                handles.append(Line2D([], [], ls=style, color="black", lw=0.9, label=text))
    ax.set(xlabel=below, ylabel=beside, xlim=around(across, 0.0), ylim=around(up, 0.0))
    legend(ax, handles, loc="upper left", bbox_to_anchor=(1.02, 1))
    return fig


def draw_phase_diagram(h, path):
    rows = h.axis_of("regime", 0)
    if rows != "damping" and min(h["regime"].shape) > 1:
        return draw_plane(h, rows)
    if len(h["damping"]) < 2 or len(h[h.axis_of("regime", 1)]) < 2:
        return draw_one_damping(h)
    if h.options.surface:
        return draw_surface(h)
    name = h.axis_of("regime", 1)
    drive, label = parameter_axis(h, h[name], name)
    damping = h["damping"]
    fig, axes = figure(h, 5.4, 2, 1, sharex=True)
    mesh = axes[0].pcolormesh(drive, damping, h["regime"], shading="nearest", rasterized=True,
                              cmap=ListedColormap(REGIMES[1]),
                              norm=BoundaryNorm(np.arange(-0.5, 5), 5))
    bar = fig.colorbar(mesh, ax=axes[0], ticks=range(5))
    bar.ax.set_yticklabels(REGIMES[0])
    area = axes[1].pcolormesh(drive, damping, h["mean_loop_area"], shading="nearest",
                              cmap="viridis", rasterized=True)
    fig.colorbar(area, ax=axes[1], label="mean loop area")
    for ax in axes:
        if name in ("drive_frequency", "drive_period") and h.options.boundary:
            add_bifurcations(ax, h)
        ax.set(ylabel=r"damping $\gamma$", xlim=around(drive, 0.0), ylim=around(damping, 0.0))
        ax.yaxis.set_major_locator(plt.MaxNLocator(5))
    axes[1].set_xlabel(label)
    if h.options.boundary:
        handles = [Line2D([], [], color="black", lw=w, ls=s, label=t) for w, s, t in (
            (1.4, "-", "folds: SA or LA ends"), (0.4, "-", "folds of others"),
            (0.8, ":", "doubling, symmetry breaking"))]
        handles.append(Line2D([], [], marker="*", color="black", ms=8, ls="", label="cusp"))
        legend(axes[0], handles, under=axes[1], loc="upper left", framealpha=0.9)
    return fig


def draw_lyapunov_curve(h, along):
    """The exponent over one parameter, where the other one has a single value."""
    x, below = parameter_axis(h, h[along], along)
    exponent, text = exponent_axis(h, "largest Lyapunov exponent")
    fig, ax = figure(h, 2.7)
    ax.axhline(0, color="0.7", lw=0.8)
    ax.plot(x, np.ravel(exponent), ".-", ms=3, lw=0.6)
    ax.set(xlabel=below, ylabel=text, xlim=around(x, 0.02))
    return fig


def draw_lyapunov_map(h, path):
    rows, columns = h.axis_of("lyapunov", 0), h.axis_of("lyapunov", 1)
    if 1 in h["lyapunov"].shape:
        return draw_lyapunov_curve(h, columns if len(h[rows]) == 1 else rows)
    across, below = parameter_axis(h, h[columns], columns)
    up, beside = parameter_axis(h, h[rows], rows)
    (exponent, text), period = exponent_axis(h, "largest Lyapunov exponent"), h["period"]
    wide = h.options.size is not None and h.options.size[0] > WIDE - 1
    fig, axes = figure(h, 5.6, *((1, 2) if wide else (2, 1)), sharex=True, sharey=True)
    most = np.nanpercentile(np.abs(exponent), 99)
    shown = axes[0].pcolormesh(across, up, exponent, cmap="RdBu_r", vmin=-most, vmax=most,
                               shading="nearest", rasterized=True)
    fig.colorbar(shown, ax=axes[0], label=text)
    closed = np.isfinite(period)
    kind = np.where(closed, 1 + (h["winding"] != 0) + 2 * (period > 1), 0)
    kind = np.where(h["label"] == NAMED.index("unresolved"), 5, kind)
    rotates = h["label"] == NAMED.index("quasi_periodic")
    kind = np.where(rotates, 6, kind)
    count = 7 if rotates.any() else 6
    names = ["chaotic", "period 1", "period 1, running", "longer period", "longer, running",
             "unresolved", "quasi-periodic"][:count]
    colours = ListedColormap(["black", SINGLE, MORE[4], SA, LA, UNRESOLVED, MORE[0]][:count])
    shown = axes[1].pcolormesh(across, up, kind, cmap=colours, vmin=-0.5, vmax=count - 0.5,
                               shading="nearest", rasterized=True)
    fig.colorbar(shown, ax=axes[1], ticks=range(count)).ax.set_yticklabels(names)
    for ax in axes:
        ax.set(xlabel=below, ylabel=beside)
        ax.label_outer()
    return fig


def draw_atlas(h):
    """A response over three parameters: planes of amplitude, with the resonances as a curve."""
    quantity = "mean_loop_amplitude"
    slow, up, along = (h.axis_of(quantity, i) for i in range(3))
    across, below = parameter_axis(h, h[along], along)
    height, beside = parameter_axis(h, h[up], up)
    planes = np.unique(np.linspace(0, len(h[slow]) - 1, MOST_PLANES).round().astype(int))
    columns = min(len(planes), 2)
    rows = -(-len(planes) // columns)
    fig, axes = figure(h, 1.5 * rows + 0.7, rows, columns, sharex=True, sharey=True,
                       squeeze=False)
    factor, amplitude = amplitude_axis(h, quantity, r"amplitude $\langle x_0\rangle$")
    most = np.nanmax(factor * h[quantity])
    for ax, i in zip(axes.flat, planes):
        shown = ax.pcolormesh(across, height, factor * h[quantity][i], cmap="viridis", vmin=0, vmax=most,
                              shading="nearest", rasterized=True)
        if "resonance_period" in h:
            at = 2 * np.pi / h["resonance_period"][i] if along == "drive_frequency" else (
                h["resonance_period"][i])
            ax.plot(parameter_axis(h, at, along)[0], height, "w.-", lw=1, ms=4)
        ax.set_title(parameter_text(h, h[slow][i], slow))
        ax.set(xlim=around(across, 0.0))
    for ax in axes.flat[len(planes):]:
        ax.axis("off")
    for k in range(columns):
        axes[(len(planes) - 1 - k) // columns, k].tick_params(labelbottom=True)
        axes[(len(planes) - 1 - k) // columns, k].set_xlabel(below)
    for row in axes:
        row[0].set_ylabel(beside)
    fig.colorbar(shown, ax=axes, label=amplitude, shrink=0.9, location="top")
    return fig


def draw_response(h, path):
    volume = h["mean_loop_amplitude"].ndim == 3 and "temperature" not in h
    return draw_atlas(h) if volume else curve_response(h, path)


def draw_surface(h):
    """The mean loop area as a surface over frequency and damping, with sections beside it."""
    name = h.axis_of("mean_loop_area", 1)
    drive, label = parameter_axis(h, h[name], name)
    damping, area = h["damping"], h["mean_loop_area"]
    fig = plt.figure(figsize=page(h, WIDTH, 5.4))
    grid = fig.add_gridspec(2, 1, height_ratios=(4, 3))
    top = fig.add_subplot(grid[0], projection="3d")
    thin = max(1, len(damping) // 90), max(1, len(drive) // 120)
    w, g = np.meshgrid(drive[:: thin[1]], damping[:: thin[0]])
    top.plot_surface(w, g, area[:: thin[0], :: thin[1]], cmap="viridis", rstride=1, cstride=1,
                     linewidth=0, antialiased=False, rasterized=True)
    top.set(xlabel=label, ylabel=r"damping $\gamma$", zlabel="mean loop area")
    top.view_init(elev=32, azim=-58)
    top.set_box_aspect((4, 4, 2.8), zoom=0.8)
    top.tick_params(labelsize=plt.rcParams["legend.fontsize"], pad=0)
    top.locator_params(nbins=5)
    below = fig.add_subplot(grid[1])
    chosen = np.unique(np.linspace(0, len(damping) - 1, 8).round().astype(int))
    for colour, i in zip(colours_of(chosen), chosen):
        below.plot(drive, area[i], color=colour, label=rf"$\gamma = {damping[i]:.4g}$")
    below.set(xlabel=label, ylabel="mean loop area", xlim=around(drive, 0.0))
    below.set_ylim(bottom=0)
    legend(below)
    return fig
