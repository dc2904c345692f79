"""The figures of a file of results."""
import re
import textwrap
import types

import h5py

from . import curves, fits, maps, outer, validation
from .style import SETTINGS, Run, plt

DRAWERS = {  # by the root attribute `scene`
    "free_oscillation": curves.draw_free_oscillation,
    "resonance_curve": curves.draw_resonance_curve,
    "response": maps.draw_response,
    "orbit": curves.draw_orbit,
    "hysteresis": curves.draw_hysteresis,
    "bifurcation_diagram": curves.draw_bifurcation_diagram,
    "lyapunov_map": maps.draw_lyapunov_map,
    "basins": maps.draw_basins,
    "branches": curves.draw_branches,
    "phase_diagram": maps.draw_phase_diagram,
    "work_precision": validation.draw_work_precision,
    "hard_cases": validation.draw_hard_cases,
    "switching": curves.draw_switching,
    "escape": curves.draw_escape,
    "fit": fits.draw_fit,
}


# What a picture may be asked for; plots/plot.py has the words for each.
OPTIONS = {"size": None, "title": True, "frequency": False, "unit": None, "boundary": True,
           "ensemble": False, "surface": False}


def balanced(text, most):
    """Text in as few lines as it takes, and these about alike in length."""
    lines = textwrap.wrap(text, most)
    shorter = most
    while shorter > 1 and len(textwrap.wrap(text, shorter - 1)) == len(lines):
        shorter -= 1
    return textwrap.fill(text, shorter)


def title(run):
    """The deck's title, and behind it the parameters that were set on the command line, of which
    the title does not know."""
    settings = re.split(r" (?=[a-z_]+\.\w+=)", run.settings())
    found = [s.split(".", 1)[1] for s in settings if s.startswith("pendulum.")]
    if not found or any(s.startswith("scene.title=") for s in settings):
        return run.text("title")
    return f"{run.text('title')} (set: {'; '.join(found)})"


def draw(path, options):
    """The figures of a file, mostly one, with what is added to their names; ValueError says why
    there is none."""
    try:
        file = h5py.File(path, "r")
    except FileNotFoundError:
        raise ValueError("there is no such file") from None
    except OSError:
        raise ValueError("this is not an HDF5 file, or not a whole one") from None
    with file:
        run = Run(file, options)
        drawer = DRAWERS.get(run.text("scene"))
        if drawer is None:
            raise ValueError("this is not a run of resonance that can be drawn")
        try:
            if "outer_axis" in file.attrs:
                figures = outer.draw(run, path, drawer)
            else:
                figures = [("", "", drawer(run, path))]
        except KeyError as missing:
            raise ValueError(f"something is missing from it: {missing}") from None
        for _, more, figure in figures:
            most = max(20, int(120 * figure.get_size_inches()[0] / plt.rcParams["font.size"]))
            if options.title:
                figure.suptitle(balanced(title(run) + (f", {more}" if more else ""), most),
                                fontsize=plt.rcParams["font.size"])
        return [(suffix, figure) for suffix, _, figure in figures]


def figures(path, **chosen):
    """The same with the settings of pictures for their time alone: a figure, or a list of them."""
    wrong = [name for name in chosen if name not in OPTIONS]
    if wrong:
        raise TypeError(f"plot() has no '{wrong[0]}', only {', '.join(OPTIONS)}")
    with plt.rc_context(SETTINGS):
        found = [figure for _, figure in draw(path, types.SimpleNamespace(**{**OPTIONS, **chosen}))]
        for figure in found:
            figure.canvas.draw()  # ticks get their sizes now
            plt.close(figure)     # so that a notebook shows it once
    return found[0] if len(found) == 1 else found
