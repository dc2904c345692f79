"""The explorer: numbers beside scenes, decks that the program takes, and a page in a browser:
knob to picture, click to basin, an error shown, two tabs, a killed server, a narrow window."""
import re
import subprocess
import sys
import time
import urllib.error
import urllib.request

import numpy as np
import pendres
from pendres.explorer import results, settings, views
from pendres.explorer.figures import STYLE, area_colours
from pendres.explorer.pictures import saved
from playwright.sync_api import sync_playwright

BROWSER, FILE, SHOTS = sys.argv[1:]


def last(view, chosen, seen=None):
    """The best picture that a view yields."""
    for picture in views.VIEWS[view](chosen, seen, pendres.Context()):
        found = picture
    return found


def check_numbers():
    """What is shown is what scenes compute."""
    chosen = settings.Settings()
    scene = pendres.basins(damping=0.13, drive_amplitude=0.2, drive_frequency=0.8,
                           x_range=(-1.5, 4.5, 9), v_range=(-2.0, 2.0, 9))
    seen = np.linspace(-1.5, 4.5, 9), np.linspace(-2, 2, 9)
    views.GRIDS = (9,)
    edges = [(a[0] - 0.5 * (a[1] - a[0]), a[-1] + 0.5 * (a[1] - a[0])) for a in seen]
    picture = last("basins", chosen, (*edges[0], *edges[1]))
    value, names, _x, _v = picture.image
    words = pendres.words(scene.label).transpose("v", "x").values
    assert np.array_equal(np.array(names, dtype=object)[value], words)

    trace, portrait, loop = last("motion", chosen)
    told = {what: (value, error) for what, value, error in trace.rows[1:5]}
    orbit = pendres.orbit(damping=0.13, drive_amplitude=0.2, drive_frequency=0.8,
                          x=chosen.x, v=0.0)
    assert abs(told["amplitude"][0] - orbit.amplitude.item()) <= 2 * orbit.amplitude_error.item()
    assert {"sa", "la", "motion", "start", "strobe"} <= set(portrait.layers)
    x, drive = (a[~np.isnan(a)] for a in loop.layers["sa"])
    area = 0.5 * abs(np.sum(x[:-1] * drive[1:] - x[1:] * drive[:-1]))
    assert abs(area / told["loop area"][0] - 1) < 1e-3  # a polygon of 128 corners: 4e-4

    folds = sorted(value for _what, value, _error in last("response", chosen).rows)
    assert np.allclose(folds, [0.753512459, 0.844925198], atol=1e-8)
    steps = last("current", settings.Settings(damping=0.2, drive_amplitude=0, drive_frequency=1))
    assert steps.layers["up"][1][-1] > 1 > abs(steps.layers["up"][1][0])
    warm = last("noise", settings.Settings(temperature=0.002))
    assert {"sa strobes", "la strobes"} <= set(warm.layers)
    assert views.told(0.123456, 1e-3) == "0.1235 ± 1e-03" and views.told(np.nan, 1) == "–"
    assert "unknown" in views.told(1.0, np.nan)
    assert views.told(1e-14, 1e-18) == "1.00000e-14 ± 1e-18"  # of a weak drive


def check_scenes():
    """Each deck is one that the program takes, and so is each call."""
    for more in ({}, {"model": "two wells", "temperature": 0.01, "torque": 0.1},
                 {"model": "own polynomial", "coefficients": "1 0 0.5", "along": "torque"}):
        chosen = settings.Settings(**more)
        again = settings.Settings.of_address({
            name: [value[0].encode()] for name, value in
            __import__("urllib.parse").parse.parse_qs(chosen.address()[1:]).items()})
        assert again.values() == chosen.values()
        for view in views.VIEWS:
            answer = subprocess.run(
                [pendres._scenes.program(), "--dump-namelist", "-"], input=chosen.deck(view),
                capture_output=True, text=True, check=False)
            assert answer.returncode == 0, (view, more, answer.stderr)
            compile(chosen.python(view), view, "exec")
    try:
        settings.Settings(model="own polynomial", coefficients="1, x").pendulum()
        raise AssertionError("coefficients that are none were taken")
    except ValueError as why:
        assert "1 to 5 numbers" in str(why)
    assert settings.Settings.of_address({"damping": [b"x"], "v": [b"2"]}).v == 2
    ranges = settings.Settings().scene("basins", (0.0, 2.56, -1.0, 1.56))[1]  # of what is seen
    assert np.allclose((*ranges["x_range"], *ranges["v_range"]),
                       (0.005, 2.555, 256, -0.995, 1.555, 256))


def check_files():
    """Every variable of a file has a picture, in the browser's form and in files."""
    found = results.Results(FILE)
    for name in found.names:
        picture = found.picture(name)
        assert set(picture.layers) <= set(STYLE)
        for form, head in (("svg", b"<?xml"), ("pdf", b"%PDF")):
            assert saved(found.words(name), picture, form).startswith(head)
    assert "regime" in found.names and found.at("regime", 0.7, 0.15) == {
        "drive_frequency": 0.7, "damping": 0.15, "drive_amplitude": 0.2, "torque": 0.0,
        "parametric_amplitude": 0.0, "temperature": 0.0, "model": "pendulum"}
    wells = results.Results(pendres.basins(
        force=[-1.0, 0.0, 1.0], damping=0.2, drive_amplitude=0.1, drive_frequency=1.1, torque=0.05,
        x_range=(-1.0, 1.0, 3), v_range=(-1.0, 1.0, 3))).at("label", 0.5, -0.25)
    chosen = settings.Settings(**wells)
    assert chosen.force() == (-1, 0, 1) and (chosen.torque, chosen.x, chosen.v) == (0.05, 0.5, -0.25)
    colours = area_colours(["sa", "la", "periodic", "periodic", "escape"])
    assert len(set(colours)) == len(colours)


class Server:
    """An explorer that serves a file."""

    def __enter__(self):
        self.process = subprocess.Popen(
            [sys.executable, "-u", "-m", "pendres.explorer", "--no-browser", FILE],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.url = re.search(r"http\S+", self.process.stdout.readline()).group()
        return self

    def __exit__(self, *_what):
        self.process.kill()
        self.process.wait()


def refused(url):
    try:
        with urllib.request.urlopen(url):
            return False
    except urllib.error.HTTPError as why:
        return why.code == 403


def wait(page, what, seconds=60):
    """Until a function of the page is true; how long that took."""
    start = time.monotonic()
    while not what():
        assert time.monotonic() - start < seconds, "nothing came in time"
        page.wait_for_timeout(20)
    return time.monotonic() - start


def numbers(page):
    return " ".join(page.locator("table.numbers").all_inner_texts())


# How many points and images figures show.
SHOWN = """() => [...Bokeh.documents[0].all_models].filter(m => m.type == "ColumnDataSource").map(
  m => (m.get_column("x") || []).length).reduce((a, b) => a + b, 0)"""


def frame(page, title):
    """Where on the screen the frame of a figure is."""
    return page.evaluate("""title => {
      const all = [], look = view => { all.push(view); for (const c of view.children()) look(c) }
      for (const root of Bokeh.index.roots) look(root)
      const plot = all.find(v => v.model.title && v.model.title.text == title)
      plot.el.scrollIntoView()
      const inner = plot.frame.bbox, outer = plot.el.getBoundingClientRect()
      return [outer.x + inner.x, outer.y + inner.y, inner.width, inner.height] }""", title)


def check_browser(server, browser):
    outside, complaints = [], []
    context = browser.new_context(viewport={"width": 1280, "height": 1000})
    context.grant_permissions(["clipboard-read", "clipboard-write"])
    page = context.new_page()
    page.on("request", lambda r: outside.append(r.url) if not re.match(
        r"(https?|ws)://127\.0\.0\.1:|data:|blob:", r.url) else None)
    page.on("console", lambda m: complaints.append(m.text) if m.type == "error" else None)
    page.goto(server.url)
    wait(page, lambda: "0.600218069" in numbers(page) and "fold" in numbers(page))
    assert not outside, outside
    wait(page, lambda: "token" not in page.url)

    # A knob, by the keyboard.
    page.locator(".noUi-handle").nth(2).focus()
    page.keyboard.press("ArrowRight")
    seconds = wait(page, lambda: "0.600218069" not in numbers(page))
    print(f"a step of the drive frequency: its numbers after {1e3 * seconds:.0f} ms")
    wait(page, lambda: "drive_frequency=0.805" in page.url)

    # A click in the picture of basins is a start; one into the file's map is a point.
    wait(page, lambda: page.get_by_text("128 × 128 starts").count() + page.get_by_text("256 × 256 starts").count() + page.get_by_text("512 × 512 starts").count() == 1)
    left, top, width, height = frame(page, "basins of attraction")
    page.mouse.click(left + 0.37 * width, top + 0.7 * height)
    wait(page, lambda: re.search(r"[?&]x=", page.url) and re.search(r"[?&]v=-", page.url))

    # What cannot be is said, and the page goes on.
    page.locator("select").filter(has_text="own polynomial").first.select_option("own polynomial")
    box = page.get_by_label(re.compile("Coefficients", re.I))
    box.fill("1, nonsense")
    box.press("Enter")
    wait(page, lambda: page.get_by_text("1 to 5 numbers are wanted").count() > 0)
    wait(page, lambda: page.evaluate(SHOWN) == 1)  # the file's map
    page.locator("select").filter(has_text="own polynomial").first.select_option("pendulum")
    wait(page, lambda: "amplitude" in numbers(page))

    # Copy, save.
    page.get_by_role("button", name="copy").click()
    wait(page, lambda: "kind = 'orbit'" in page.evaluate("navigator.clipboard.readText()"))
    for form in ("SVG", "PDF"):
        with page.expect_download() as download:
            page.get_by_text(f"save {form}").click()
        assert open(download.value.path(), "rb").read(1000).startswith(
            b"<?xml" if form == "SVG" else b"%PDF")
    page.screenshot(path=f"{SHOTS}/wide.png", full_page=True)

    # A second tab has knobs of its own; who comes without the token does not get in.
    other = context.new_page()
    other.goto(server.url.split("?")[0] + "?damping=0.3&theme=dark")
    wait(other, lambda: "amplitude" in numbers(other))
    assert "damping=0.3" in other.url and "damping" not in page.url
    other.set_viewport_size({"width": 400, "height": 800})
    other.wait_for_timeout(500)
    other.screenshot(path=f"{SHOTS}/narrow.png", full_page=True)
    across = other.evaluate("document.documentElement.scrollWidth")
    assert across <= 400, across
    for url in (server.url.split("?")[0], server.url[:-1] + "?", server.url.split("?")[0] + "ws"):
        assert refused(url), url
    assert not complaints, complaints

    server.process.terminate()
    wait(page, lambda: page.get_by_text("The explorer has ended").count() > 0)
    page.screenshot(path=f"{SHOTS}/ended.png")


check_numbers()
check_scenes()
check_files()
with Server() as running, sync_playwright() as playwright:
    chromium = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox"])
    check_browser(running, chromium)
    chromium.close()
