"""Pictures in the browser, by Bokeh. How a layer is drawn follows from its name, here and, for
files, in `pictures`. Colours are those of Okabe and Ito, which the colour-blind tell apart."""
import numpy as np
from bokeh.events import RangesUpdate, Tap
from bokeh.models import ColorBar, ColumnDataSource, FixedTicker, LinearColorMapper, Range1d
from bokeh.plotting import figure

SA, LA, GREEN, PURPLE, SKY, ORANGE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9",
                                      "#E69F00")
GREY = "#8A8A8A"
# name: (colour, dash of a line or None, marker or None, size)
STYLE = {
    "motion": (GREY, "solid", None, 1), "start": (PURPLE, None, "x", 11),
    "sa": (SA, "solid", None, 2.5), "la": (LA, "solid", None, 2.5),
    "periodic": (GREEN, "solid", None, 2.5), "running": (PURPLE, "solid", None, 2.5),
    "strobe": (ORANGE, None, "circle", 6), "stable": (SA, "solid", None, 2.5),
    "unstable": (LA, "dashed", None, 2), "bifurcation": (GREY, None, "square", 7),
    "here": (PURPLE, None, "circle", 9), "up": (SA, "solid", None, 2),
    "down": (LA, "dashed", None, 2), "result": (SA, "solid", "circle", 4),
    "sa strobes": (SA, None, "circle", 2), "la strobes": (LA, None, "circle", 2),
    "periodic strobes": (GREEN, None, "circle", 2), "running strobes": (PURPLE, None, "circle", 2),
    "chaotic strobes": (SKY, None, "circle", 2), "quasi_periodic strobes": (GREEN, None, "circle", 2),
    "unresolved strobes": (GREY, None, "circle", 2), "points": (SA, None, "circle", 1.5),
}
# Areas of basins: a colour a label, and others for more of the same label.
AREAS = {"sa": SA, "la": LA, "chaotic": SKY, "running": PURPLE, "escape": "#F2F2F2",
         "unresolved": GREY, "unstable": "#444444", "quasi_periodic": "#F0E442"}
MORE = (GREEN, "#F0E442", PURPLE, SKY, ORANGE, "#332288", "#117733", "#AA4499")


def area_colours(names):
    """A colour for each name, no two alike as long as there are enough."""
    chosen, spare = [], 0
    for name in names:
        colour = AREAS.get(name)
        if colour is None or colour in chosen:
            colour = MORE[spare % len(MORE)]
            spare += 1
        chosen.append(colour)
    return chosen


class Plot:
    """One figure: `draw` replaces what it shows."""

    def __init__(self, words, x, y, clicked=None, ranged=None):
        self.words, self.shown = (words, x, y), None
        ranges = {} if ranged is None else {"x_range": Range1d(0, 1), "y_range": Range1d(0, 1)}
        self.figure = figure(title=words, x_axis_label=x, y_axis_label=y, height=300,
                             min_width=280, **ranges, sizing_mode="stretch_width", output_backend="canvas",
                             tools="pan,wheel_zoom,box_zoom,reset,save", toolbar_location="above")
        self.figure.toolbar.logo = None
        self.figure.xaxis.axis_label_text_font_style = "normal"
        self.figure.yaxis.axis_label_text_font_style = "normal"
        self._sources, self._image, self._bar, self._names = {}, None, None, None
        if clicked is not None:
            self.figure.on_event(Tap, lambda event: clicked(event.x, event.y))
        if ranged is not None:
            self.figure.on_event(RangesUpdate, lambda e: ranged((e.x0, e.x1, e.y0, e.y1)))

    def draw(self, picture):
        """Show a picture in place of the one before."""
        self.shown = picture
        if picture.image is not None:
            self._draw_image(*picture.image)
            for its, ends in zip((self.figure.x_range, self.figure.y_range), picture.image[2:]):
                if isinstance(its, Range1d) and (its.start, its.end) != ends:
                    its.update(start=ends[0], end=ends[1])
        elif self._image is not None:
            self._image.data = {name: [] for name in self._image.data}
        for name, source in self._sources.items():
            if name not in picture.layers and len(source.data["x"]):
                source.data = {"x": [], "y": []}
            for item in self.figure.legend[0].items:
                if item.label.value == name:
                    item.visible = name in picture.layers
        for name, layer in picture.layers.items():
            x, y = layer if len(layer) else ((), ())
            data = {"x": np.asarray(x, dtype=float), "y": np.asarray(y, dtype=float)}
            if name in self._sources:
                self._sources[name].data = data
            else:
                self._sources[name] = ColumnDataSource(data)
                self._new_layer(name)

    def move(self, name, x, y):
        """Move a layer of one point; all else stays as it is."""
        self.shown.layers[name] = np.array([x]), np.array([y])
        if name in self._sources:
            self._sources[name].data = {"x": [x], "y": [y]}

    def _new_layer(self, name):
        colour, dash, marker, size = STYLE[name]
        source, words = self._sources[name], {"legend_label": name}
        if dash is not None:
            self.figure.line("x", "y", source=source, color=colour, line_dash=dash,
                             line_width=min(size, 3), **words)
        if marker is not None:
            self.figure.scatter("x", "y", source=source, marker=marker, size=size,
                                fill_color=colour, line_color="white" if size > 5 and marker != "x"
                                else colour, line_width=2 if marker == "x" else 0.7, **words)
        self.figure.legend.label_text_font_size = "9px"
        self.figure.legend.spacing, self.figure.legend.padding = 0, 4
        self.figure.legend.background_fill_alpha = 0.6
        self.figure.legend.click_policy = "hide"

    def _draw_image(self, value, names, x, y):
        value = np.asarray(value)
        data = {"image": [value], "x": [x[0]], "y": [y[0]], "dw": [x[1] - x[0]],
                "dh": [y[1] - y[0]]}
        labelled = names is not None
        palette = area_colours(names) if labelled else "Cividis256"
        if self._image is None:
            mapper = LinearColorMapper(palette=palette, nan_color="white")
            self._image = ColumnDataSource(data)
            self.figure.image("image", "x", "y", "dw", "dh", source=self._image,
                              color_mapper=mapper, level="image")
            self._bar = ColorBar(color_mapper=mapper, width=10, padding=4)
            self.figure.add_layout(self._bar, "right")
            self.figure.grid.visible = False
            for its in (self.figure.x_range, self.figure.y_range):
                if not isinstance(its, Range1d):
                    its.range_padding = 0
            if labelled:
                self._bar.ticker = FixedTicker()
        mapper = self._bar.color_mapper
        if labelled and names != self._names:
            # Not another ticker: Bokeh would look through the whole page for models that are gone.
            mapper.update(palette=palette, low=-0.5, high=len(names) - 0.5)
            self._bar.ticker.ticks = list(range(len(names)))
            self._bar.major_label_overrides = dict(enumerate(names))
            self._names = names
        elif not labelled:
            finite = value[np.isfinite(value)]
            low, high = (finite.min(), finite.max()) if finite.size else (0, 1)
            mapper.update(low=float(low), high=float(high if high > low else low + 1))
        self._image.data = data
