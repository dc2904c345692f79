#!/usr/bin/env python3
"""Click a phase diagram as a hand would, without a window: plots_view.py FILE.h5 (from plots/)."""
import sys
from types import SimpleNamespace

from matplotlib.backend_bases import MouseEvent

import view

options = SimpleNamespace(unit=None, frequency=False, boundary=True, size=None)
looked = view.open_view(sys.argv[1], options)
canvas = looked.figure.canvas
canvas.draw()
before = len(looked.orbits.lines)


def click(axes, omega, damping):
    place = axes.transData.transform((omega, damping))
    canvas.callbacks.process("button_press_event", MouseEvent("button_press_event", canvas,
                                                              *place, button=1))


click(looked.orbits, 0.5, 0.5)
assert len(looked.orbits.lines) == before, "a click beside the diagram did something"
click(looked.map, 0.8, 0.13)
labels = [text.get_text() for text in looked.orbits.get_legend().get_texts()]
# The amplitudes there, by deck f09: SA below pi/4, LA above 1.5.
assert [label[:2] for label in labels] == ["SA", "LA"], labels
amplitude = [float(label.split()[1]) for label in labels]
assert amplitude[0] < 0.785 < 1.5 < amplitude[1], amplitude
assert len(looked.branches.lines) >= 3 and looked.basins.collections, "nothing was drawn"
click(looked.map, 0.75, 0.15)
assert "0.15" in looked.figure._suptitle.get_text()
