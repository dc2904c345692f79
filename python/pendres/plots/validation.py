"""Pictures of what the program is measured against: speed beside error, hard cases."""
import numpy as np

from .style import EXACT, FREE, LA, SA, plt, strings

LOST = 0.1  # an error beyond which a pendulum is somewhere else: speed says nothing then
MARKERS = "osD^v<>Ph*Xd"


def draw_work_precision(h, path):
    fig, axes = plt.subplot_mosaic([["speed"], ["honest"], ["legend"]],
                                   figsize=h.options.size or (5.4, 8.0), height_ratios=(6, 5, 2))
    ax, honest = axes["speed"], axes["honest"]
    names, error = strings(h["method_name"]), h["error_100"]
    # Fixed and adaptive steps of one table share a colour.
    table = [n.replace("block_adaptive", "block_fixed") if len(names) > 10 else n for n in names]
    tables = list(dict.fromkeys(table))
    colours = dict(zip(tables, plt.cm.tab20(np.arange(len(tables)) % 20)))
    for i, name in enumerate(names):
        adaptive = "adaptive" in name
        style = {"color": colours[table[i]], "ms": 4, "mfc": "none" if adaptive else None,
                 "ls": "--" if adaptive else "-",
                 "marker": MARKERS[tables.index(table[i]) % len(MARKERS)]}
        good = (error[i] > 0) & (error[i] < LOST) & np.isfinite(h["throughput"][i])
        ax.loglog(error[i][good], h["throughput"][i][good] / 1e6, label=name, **style)
        estimate = h["estimated_error"][i]
        good &= np.isfinite(estimate) & (estimate > 0)
        honest.loglog(error[i][good], estimate[good], **{**style, "ls": ""})
    if strings(h["unit"])[0] == "ensemble":  # what the others' figures are of
        for i, name in enumerate(strings(h["others/method"])):
            ax.loglog(h["others/error"], h["others/throughput"][i] / 1e6, marker="x", ls=":",
                      color=f"{0.1 + 0.14 * i:.2f}", label=f"{name}, elsewhere")
    line = np.array([1e-15, LOST])
    for factor, label, style in ((1, "the error", "-"), (0.1, "a tenth: promised at least", "--")):
        honest.loglog(line, factor * line, color=FREE, lw=0.8, ls=style, label=label)
    honest.legend()
    ax.set(ylabel="million pendulum-periods a second")
    honest.set(xlabel="largest error after 100 periods", ylabel="largest estimate of it")
    for panel in (ax, honest):
        panel.invert_xaxis()
        panel.grid(True, alpha=0.3)
    axes["legend"].axis("off")
    axes["legend"].legend(*ax.get_legend_handles_labels(), loc="center", ncol=3)
    return fig


def draw_hard_cases(h, path):
    """Figures of this program and of a naive one, over their bounds; several columns of cases side by side."""
    names, bound = strings(h["case_name"]), h["bound"]
    figures, naive = h["figure"], h["naive_figure"]
    unit = np.where(bound > 0, bound, 1)
    least, most, rows = 1e-8, 1e8, min(60, len(names))
    columns = -(-len(names) // rows)
    fig, axes = plt.subplots(1, columns, squeeze=False,
                             figsize=h.options.size or (3.6 * columns, 1 + 0.117 * rows))
    for k, ax in enumerate(axes[0]):
        part = slice(k * rows, (k + 1) * rows)
        y = np.arange(len(names[part]))
        ax.axvline(1, color=EXACT, lw=0.8)
        ax.plot(np.clip(naive[part] / unit[part], least, most), y, "x", ms=3, color=LA,
                label="plain adaptive ARKODE")
        ax.plot(np.clip(figures[part] / unit[part], least, most), y, "o", ms=2.5, color=SA,
                label="libpendres")
        ax.set_yticks(y, [n if b > 0 else n + " (count)"
                          for n, b in zip(names[part], bound[part])], fontsize=5)
        ax.set(xscale="log", ylim=(rows, -1), xlim=(least / 3, most * 3))
        ax.tick_params(axis="x", labelsize=6)
        ax.grid(axis="y", lw=0.3)
    fig.supxlabel("figure over its bound; at either end: that or beyond", fontsize=8)
    axes[0][0].legend(loc="best", fontsize=6)
    return fig
