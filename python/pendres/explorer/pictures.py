"""Pictures in files, SVG or PDF, of what a figure in the browser shows."""
import io

from .figures import STYLE, area_colours

DASH = {"solid": "-", "dashed": "--"}
MARKER = {"circle": "o", "square": "s", "x": "x"}


def saved(words, picture, form):
    """The bytes of a file of a form ("svg", "pdf") with a picture; words are its title and what its
    axes are called."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.colors import ListedColormap
    from matplotlib.figure import Figure
    fig = Figure(figsize=(4.6, 3.6), layout="constrained")
    FigureCanvasAgg(fig)
    ax = fig.add_subplot()
    if picture.image is not None:
        value, names, x, y = picture.image
        colours = {} if names is None else {
            "cmap": ListedColormap(area_colours(names)), "vmin": -0.5, "vmax": len(names) - 0.5}
        shown = ax.imshow(value, origin="lower", extent=(*x, *y), aspect="auto",
                          interpolation="nearest", **colours)
        bar = fig.colorbar(shown, ax=ax)
        if names is not None:
            bar.set_ticks(range(len(names)), labels=names)
    for name, layer in picture.layers.items():
        if not len(layer):
            continue
        colour, dash, marker, size = STYLE[name]
        ax.plot(*layer, color=colour, ls=DASH.get(dash, "none"), marker=MARKER.get(marker, ""),
                ms=0.6 * size, lw=0.6 * min(size, 3), mew=0 if marker != "x" else 1.5, label=name,
                rasterized=len(layer[0]) > 5000)
    if picture.layers:
        ax.legend(fontsize=7)
    ax.set(title=words[0], xlabel=words[1], ylabel=words[2])
    out = io.BytesIO()
    fig.savefig(out, format=form)
    return out.getvalue()
