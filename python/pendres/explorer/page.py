"""The page: knobs, linked figures, numbers with their errors, and what leaves the page."""
import html

import panel as pn
from bokeh.io import curdoc

from .._shown import told
from . import pictures, views
from .figures import Plot
from .newest import Newest
from .settings import KNOBS, MODELS, Settings

PLOTS = {  # figure: its title and axes
    "trace": ("motion from the start", "drive periods", "x"),
    "portrait": ("phase portrait", "x", "v"),
    "loop": ("loop: drive over position", "x", "F₀ cos ωt"),
    "response": ("response", "drive frequency ω", "amplitude"),
    "basins": ("basins of attraction", "start x", "start v"),
    "diagram": ("bifurcation diagram", "parameter", "x at drive phase 0"),
    "current": ("current and voltage", "torque I", "mean velocity"),
    "noise": ("cloud of noise", "x", "v"),
}
# Views whose figure is computed while its tab is open; the others always.
TABS = ("basins", "diagram", "current", "noise")
SLOW = ("current", "noise")  # told that it is on its way
# Seconds for which they leave the processor to what is quick.
PATIENCE = {"basins": {"rest": 0.2}, "diagram": {"wait": 0.2}, "current": {"wait": 0.2},
            "noise": {"wait": 0.2}}
DEPENDS = {  # beside what all depend on: the oscillator
    "motion": {"x", "v"}, "response": {"lowest", "highest"}, "basins": set(),
    "diagram": {"x", "v", "along", "first", "last"}, "current": {"x", "v"}, "noise": set(),
}
OSCILLATOR = {"model", "coefficients", *KNOBS}
INDEPENDENT = {"response": {"temperature"}, "current": {"torque", "temperature"},
               "motion": {"temperature"}, "basins": {"temperature"}, "diagram": {"temperature"}}
CSS = """
.bk-root, body { font-family: system-ui, sans-serif; }
table.numbers { border-collapse: collapse; font-size: 12px; font-variant-numeric: tabular-nums; }
table.numbers td { padding: 0 10px 0 0; white-space: nowrap; }
p.note { margin: 2px 0; font-size: 12px; }
"""
DARK_TAB = ".bk-tab.bk-active { color: #e0e0e0 !important; background: #2a3137 !important; }"
DARK = "body { background: #15191c; color: #e0e0e0; }"
COPY = "navigator.clipboard.writeText(text.value)"


class Page:
    """One page of one tab of a browser, with its own knobs and threads."""

    def __init__(self, results=None):
        self.settings, self.results = Settings.of_address(pn.state.session_args), results
        self.location = pn.state.location
        self.document = curdoc()
        self.dark = pn.state.session_args.get("theme", [b""])[0] == b"dark"
        self.seen = {}
        self.plots = {name: Plot(*words, **self._events(name)) for name, words in PLOTS.items()}
        if self.dark:
            self.document.theme = "dark_minimal"
        self.numbers = {name: pn.pane.HTML("", sizing_mode="stretch_width", min_width=280)
                        for name in views.VIEWS}
        self.workers = {name: Newest(self._deliver, lambda found, name=name: self._show(name, found),
                                     lambda why, name=name: self._failed(name, why),
                                     **PATIENCE.get(name, {}))
                        for name in views.VIEWS}
        self.tabs = pn.Tabs(*((name, self._panel(name)) for name in TABS),
                            sizing_mode="stretch_width",
                            stylesheets=[DARK_TAB] if self.dark else [])
        self.tabs.param.watch(lambda _event: self._ask(self._open_tab()), "active")
        self.settings.param.watch(self._changed, self.settings.names())
        self.deck = pn.widgets.TextAreaInput(name="as it leaves the page", rows=9, disabled=True,
                                             sizing_mode="stretch_width", min_width=280)
        pn.state.on_session_destroyed(lambda _context: self.end())
        pn.state.onload(self._tell_address)  # the browser has told its own before
        for name in ("motion", "response", self._open_tab()):
            self._ask(name)

    def end(self):
        """The tab was closed."""
        for worker in self.workers.values():
            worker.end()

    def _deliver(self, show, found):
        self.document.add_next_tick_callback(lambda: show(found))

    def _tell_address(self):
        """All settings in the address; the token is not among them."""
        if self.location is not None:
            self.location.search = self.settings.address("dark" if self.dark else None)

    # ---- What is asked for --------------------------------------------------------------------

    def _events(self, name):
        if name in ("basins", "portrait", "noise"):
            events = {"clicked": lambda x, v: self._pick(x=x, v=v)}
        elif name == "response":
            events = {"clicked": lambda x, _y: self._pick(drive_frequency=x)}
        elif name == "current":
            events = {"clicked": lambda x, _y: self._pick(torque=x)}
        elif name == "diagram":
            events = {"clicked": lambda x, _y: self._pick(**{self.settings.along: x})}
        else:
            events = {}
        if name == "basins":
            events["ranged"] = self._zoomed
        return events

    def _pick(self, **found):
        """Set knobs to what was clicked, as far as they go."""
        for name, value in found.items():
            if isinstance(value, float):
                low, high = self.settings.param[name].bounds or (value, value)
                found[name] = min(max(round(value, 6), low), high)
        self.settings.param.update(**found)

    def _zoomed(self, seen):
        if None in seen or self.seen.get("basins") == seen:
            return
        drawn = self.plots["basins"].shown
        if drawn is not None and drawn.image is not None:
            whole = (*drawn.image[2], *drawn.image[3])
            if all(abs(a - b) < 1e-3 * abs(whole[1] - whole[0]) for a, b in zip(seen, whole)):
                return  # it is what is there already
            self.seen["basins"] = seen
            self._ask("basins")
            self._text()  # the window is in it

    def _open_tab(self):
        return TABS[self.tabs.active]

    def _changed(self, *events):
        names = {event.name for event in events}
        if names & {"model", "coefficients"}:
            self.seen.clear()
        if names & {"x", "v"} and self.plots["basins"].shown is not None:
            self.plots["basins"].move("start", self.settings.x, self.settings.v)
        for view in ("motion", "response", self._open_tab()):
            matters = (OSCILLATOR | DEPENDS[view]) - INDEPENDENT.get(view, set())
            if names & matters:
                self._ask(view)
        self._tell_address()
        self._text()

    def _ask(self, view):
        chosen = self.settings.copy()
        seen = self.seen.get(view)
        function = views.VIEWS[view]
        if view in SLOW:
            self.numbers[view].object = _table([], "computing ...")
        self.workers[view].ask(lambda context: function(chosen, seen, context))

    # ---- What is shown ------------------------------------------------------------------------

    def _show(self, view, found):
        """All at once: each change by itself would be a message, and a redrawing, of its own."""
        with pn.io.unlocked():
            self._show_now(view, found)

    def _show_now(self, view, found):
        several = zip(("trace", "portrait", "loop"), found) if view == "motion" else [(view, found)]
        for name, picture in several:
            self.plots[name].draw(picture)
        if view == "diagram":
            self.plots[view].figure.xaxis.axis_label = self.settings.param[self.settings.along].label
        told = found[0] if view == "motion" else found
        self.numbers[view].object = _table(told.rows, told.note)

    def _failed(self, view, why):
        for name in ("trace", "portrait", "loop") if view == "motion" else (view,):
            self.plots[name].draw(views.Picture({}))  # what is there is of other knobs
        self.numbers[view].object = _table([], why)

    def _panel(self, view):
        s, above = self.settings.param, ()
        if view == "diagram":
            above = (pn.FlexBox(pn.widgets.Select.from_param(s.along, width=150),
                                *(pn.widgets.FloatInput.from_param(s[n], width=95, step=0.1)
                                  for n in ("first", "last"))),)
        return pn.Column(*above, pn.pane.Bokeh(self.plots[view].figure, sizing_mode="stretch_width"),
                         self.numbers[view], sizing_mode="stretch_width")

    # ---- The page -----------------------------------------------------------------------------

    def _knobs(self):
        s = self.settings
        sliders = [pn.widgets.EditableFloatSlider.from_param(
            s.param[name], start=low, end=high, step=step, format="0.000[00]", fixed_start=None,
            fixed_end=None, sizing_mode="stretch_width")
            for name, (low, high, step) in KNOBS.items()]
        numbers = [pn.widgets.FloatInput.from_param(s.param[name], width=95, step=0.1)
                   for name in ("x", "v", "lowest", "highest")]
        own = pn.Column(sizing_mode="stretch_width")
        field = pn.widgets.TextInput.from_param(s.param.coefficients, sizing_mode="stretch_width")

        def offer(_event=None):
            own[:] = [field] if s.model == "own polynomial" else []

        s.param.watch(offer, "model")
        offer()
        model = pn.widgets.Select.from_param(s.param.model, options=list(MODELS),
                                             sizing_mode="stretch_width")
        return pn.Column(model, own, *sliders, pn.Row(*numbers[:2]), pn.Row(*numbers[2:]),
                         sizing_mode="stretch_width", min_width=280)

    def _leaving(self):
        """Copy as deck or Python, save a picture, light or dark."""
        self.which = pn.widgets.Select(name="of", options=["motion", "response", *TABS], width=110)
        self.form = pn.widgets.RadioButtonGroup(options=["deck", "Python"], value="deck")
        copy = pn.widgets.Button(name="copy", button_type="primary", width=70)
        copy.js_on_click(args={"text": self.deck}, code=COPY)
        self.which.param.watch(lambda _e: self._text(), "value")
        self.form.param.watch(lambda _e: self._text(), "value")
        saves = [pn.widgets.FileDownload(callback=lambda form=form: self._saved(form), width=110,
                                         filename=f"picture.{form}", label=f"save {form.upper()}")
                 for form in ("svg", "pdf")]
        theme = pn.widgets.Button(name="light" if self.dark else "dark", width=70)
        theme.js_on_click(code="const u = new URL(window.location); u.searchParams.set('theme', '"
                          + ("default" if self.dark else "dark") + "'); window.location = u")
        self._text()
        return pn.Column(pn.Row(self.which, self.form), self.deck, pn.FlexBox(copy, *saves, theme),
                         sizing_mode="stretch_width")

    def _text(self):
        if not hasattr(self, "which"):
            return
        try:
            write = self.settings.deck if self.form.value == "deck" else self.settings.python
            self.deck.value = write(self.which.value, self.seen.get(self.which.value))
        except (ValueError, TypeError, OSError) as why:
            self.deck.value = f"! {why}"

    def _saved(self, form):
        import io
        name = {"motion": "portrait"}.get(self.which.value, self.which.value)
        plot = self.plots[name]
        if plot.shown is None:
            raise ValueError("that tab was not opened yet")
        return io.BytesIO(pictures.saved(plot.words, plot.shown, form))

    def _file(self):
        """A file of results: a variable is chosen, a click in it sets the knobs."""
        choice = pn.widgets.Select(name="result", options=self.results.names,
                                   sizing_mode="stretch_width")
        below, room = pn.pane.HTML("", sizing_mode="stretch_width"), pn.Column(
            sizing_mode="stretch_width")

        def draw(_event=None):
            name = choice.value
            plot = Plot(*self.results.words(name),
                        clicked=lambda x, y: self._pick(**self.results.at(name, x, y)))
            picture = self.results.picture(name)
            plot.draw(picture)
            room[:] = [pn.pane.Bokeh(plot.figure, sizing_mode="stretch_width")]
            below.object = _table(picture.rows, picture.note)

        choice.param.watch(draw, "value")
        draw()
        return pn.Column(choice, room, below, sizing_mode="stretch_width")

    def view(self):
        """Everything, in as many columns as there is room for."""
        file = () if self.results is None else (self._file(),)
        parts = [pn.Column(self._knobs(), self._leaving(), *file, sizing_mode="stretch_width"),
                 pn.Column(*(pn.pane.Bokeh(self.plots[n].figure, sizing_mode="stretch_width")
                             for n in ("trace", "portrait", "loop")), self.numbers["motion"],
                           sizing_mode="stretch_width"),
                 pn.Column(self._panel("response"), self.tabs, sizing_mode="stretch_width")]
        return pn.Column(*parts, sizing_mode="stretch_width", stylesheets=[
            ":host { display: grid !important; gap: 12px;"
            " grid-template-columns: repeat(auto-fit, minmax(min(100%, 330px), 1fr)); }"])


def _table(rows, note):
    """Numbers with their errors, as a table."""
    lines = []
    for what, value, error in rows:
        if value == "":
            lines.append(f"<tr><td colspan=2><b>{html.escape(what)}</b></td></tr>")
        else:
            lines.append(f"<tr><td>{html.escape(what)}</td><td>{told(value, error)}</td></tr>")
    return (f"<table class='numbers'>{''.join(lines)}</table>"
            f"<p class='note'>{html.escape(note)}</p>")
