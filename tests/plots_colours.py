"""Colours of states that stand beside each other, as those see them who lack one of the cones.

Simulation: G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, IEEE Trans. Vis. Comput. Graph. 15
(2009) 1291, severity 1. Difference: CIE 1976 (L*, a*, b*); one can be seen from about 2.3, and
areas in a printed picture are told apart at a glance from about 10 on.
"""
import itertools
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "python", "pendres"))
from plots import style

SEEN = {
    "all cones": np.eye(3),
    "no red": np.array([[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216],
                        [-0.003882, -0.048116, 1.051998]]),
    "no green": np.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
                          [-0.011820, 0.042940, 0.968881]]),
    "no blue": np.array([[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602],
                         [0.004733, 0.691367, 0.303900]]),
}
LEAST = 10.0


def lab(colour, seen):
    rgb = np.array([int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)])
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    linear = np.clip(seen @ linear, 0, 1)
    xyz = np.array([[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750],
                    [0.0193339, 0.1191920, 0.9503041]]) @ linear
    f = xyz / [0.95047, 1.0, 1.08883]
    f = np.where(f > 216 / 24389, np.cbrt(f), (24389 / 27 * f + 16) / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


states = {"SA": style.SA, "LA": style.LA, "coexistence": style.COEXISTENCE,
          "single": style.SINGLE, "other": style.OTHER}
close = [(name, a, b, d) for name, seen in SEEN.items()
         for a, b in itertools.combinations(states, 2)
         if (d := np.linalg.norm(lab(states[a], seen) - lab(states[b], seen))) < LEAST]
for name, a, b, difference in close:
    print(f"{name}: {a} and {b} differ by {difference:.1f}, less than {LEAST}")
sys.exit(bool(close))
