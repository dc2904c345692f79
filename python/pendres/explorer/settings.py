"""The knobs: one oscillator, its start, and what is looked at; as a pendulum of the library, as
keywords of a scene, and as the text of a deck."""
import re
import urllib.parse

import numpy as np
import param

from .. import _handles, _scenes

MODELS = {
    "pendulum": None,
    "hardening spring": (1.0, 0.0, 1.0),
    "softening spring": (1.0, 0.0, -0.2),
    "two wells": (-1.0, 0.0, 1.0),
    "one-sided well": (1.0, -1.0),
    "own polynomial": (1.0, 0.0, 1.0),
}
KNOBS = {  # name: lowest, highest, step
    "damping": (0.005, 1.0, 0.005), "drive_amplitude": (0.0, 3.0, 0.005),
    "drive_frequency": (0.05, 3.0, 0.005), "torque": (-1.5, 1.5, 0.01),
    "parametric_amplitude": (0.0, 1.0, 0.01), "temperature": (0.0, 0.2, 0.001),
}
ABSENT = "torque", "parametric_amplitude", "temperature"  # from files where they are 0
LONGEST = 1e6  # of anything typed; the library says what it cannot take


class Settings(param.Parameterized):
    """All that a page shows follows from these, which stand in its address."""

    model = param.Selector(default="pendulum", objects=list(MODELS))
    coefficients = param.String(default="1, 0, 1", doc="a1, a2, ... of a1 x + a2 x^2 + ...")
    damping = param.Number(default=0.13, bounds=(1e-6, LONGEST), label="damping γ")
    drive_amplitude = param.Number(default=0.2, bounds=(0, LONGEST), label="drive amplitude F₀")
    drive_frequency = param.Number(default=0.8, bounds=(1e-3, LONGEST), label="drive frequency ω")
    torque = param.Number(default=0.0, bounds=(-LONGEST, LONGEST), label="torque I")
    parametric_amplitude = param.Number(default=0.0, bounds=(-LONGEST, LONGEST),
                                        label="parametric drive b")
    temperature = param.Number(default=0.0, bounds=(0, LONGEST), label="temperature T")
    x = param.Number(default=round(np.pi / 2, 9), label="start x")
    v = param.Number(default=0.0, label="start v")
    lowest = param.Number(default=0.3, bounds=(1e-3, LONGEST), label="frequencies from")
    highest = param.Number(default=1.6, bounds=(1e-3, LONGEST), label="to")
    along = param.Selector(default="drive_frequency",
                           objects=["drive_frequency", "drive_amplitude", "damping", "torque"])
    first = param.Number(default=0.3, label="from")
    last = param.Number(default=1.6, label="to")

    @classmethod
    def names(cls):
        """Those of all settings."""
        return [name for name in cls.param if name != "name"]

    def values(self):
        """All of them; numbers without the rounding of a slider's steps."""
        return {n: float(f"{v:.12g}") if isinstance(v, float) else v
                for n, v in ((n, getattr(self, n)) for n in self.names())}

    def copy(self):
        """As it is now, whatever is turned meanwhile."""
        return Settings(**self.values())

    def address(self, theme=None):
        """What differs from the beginning, as the query of an address."""
        changed = {n: v for n, v in self.values().items() if v != self.param[n].default}
        return "?" + urllib.parse.urlencode(changed | ({"theme": theme} if theme else {}))

    @classmethod
    def of_address(cls, arguments):
        """The settings that an address names; what it cannot mean is left out."""
        found = cls()
        for name, (*_before, value) in arguments.items():
            if name == "name" or name not in found.param:
                continue
            text = value.decode(errors="replace")
            try:
                setattr(found, name, float(text) if isinstance(found.param[name], param.Number)
                        else text)
            except ValueError:
                continue
        return found

    @staticmethod
    def model_of(coefficients):
        """The settings for a force with these coefficients; all 0: the pendulum's."""
        if not any(coefficients):
            return {"model": "pendulum"}
        most = max(k for k, a in enumerate(coefficients) if a) + 1
        return {"model": "own polynomial",
                "coefficients": ", ".join(f"{a:.12g}" for a in coefficients[:most])}

    def force(self):
        """The polynomial's coefficients, or None for the pendulum."""
        if self.model != "own polynomial":
            return MODELS[self.model]
        words = [w for w in re.split(r"[\s,;]+", self.coefficients) if w]
        try:
            given = tuple(float(w) for w in words)
        except ValueError:
            given = ()
        most = _handles.lib.PENDRES_FORCE_COEFFICIENTS
        if not 0 < len(given) <= most or not np.all(np.isfinite(given)) or not any(given):
            raise ValueError(f"own polynomial: 1 to {most} numbers are wanted, as in 1, 0, -0.5, "
                             f"not '{self.coefficients}'")
        return given

    def keywords(self):
        """The oscillator in words that a pendulum, a scene and a deck share, without what is 0."""
        values = self.values()
        chosen = {name: values[name] for name in KNOBS
                  if values[name] or name in ("damping", "drive_amplitude",
                                                     "drive_frequency")}
        return ({"force": list(self.force())} if self.force() else {}) | chosen

    def pendulum(self, **other):
        """The library's."""
        return _handles.pendulum(**(self.keywords() | other))

    def window(self, seen=None):
        """The starts that a picture of basins has: what is seen of it, or the turn, or the wells
        and what moves in them."""
        if seen and all(np.isfinite(seen)) and seen[1] > seen[0] and seen[3] > seen[2]:
            return tuple(seen)
        if not self.force():
            return -np.pi / 2, 3 * np.pi / 2, -2.5, 2.5
        a = self.force()
        third = abs(a[2]) if len(a) > 2 and a[2] else abs(a[1]) if len(a) > 1 and a[1] else 1.0
        reach = 2.2 * max(np.sqrt(abs(a[0]) / third), np.cbrt(self.drive_amplitude / third), 0.5)
        return -reach, reach, -1.5 * reach, 1.5 * reach

    def scene(self, view, seen=None):
        """The kind of scene and the keywords that compute what a view shows, and is seen of it."""
        own, start = self.keywords(), {"x": self.x, "v": self.v}
        still = {k: own[k] for k in own if k != "temperature"}  # scenes without noise refuse it
        span = ["drive_frequency", self.lowest, self.highest, 101]
        if view == "basins":
            x0, x1, v0, v1 = map(float, self.window(seen))
            x, v = (x1 - x0) / 512, (v1 - v0) / 512  # half a cell: starts are in their middles
            return "basins", still | {"x_range": (x0 + x, x1 - x, 256),
                                      "v_range": (v0 + v, v1 - v, 256)}
        if view == "diagram":
            return self._along("bifurcation_diagram", still | start,
                               [self.along, self.first, self.last, 301])
        if view == "current":
            return self._along("hysteresis", still | start, ["torque", 0.0, 1.5, 151])
        if view == "noise" and "temperature" in own:
            return "basins", own | {"x_range": (self.x - 3, self.x + 3, 64),
                                    "v_range": (-2.5, 2.5, 64), "strobes": 2000}
        if view == "response":
            still["damping"] = [still["damping"]]
            return self._along("branches", still, span)
        return "orbit", still | start

    @staticmethod
    def _along(kind, keywords, span):
        name, first, last, count = span
        keywords = {k: v for k, v in keywords.items() if k != name}
        return kind, keywords | {f"{name}_range": (float(first), float(last), count)}

    def python(self, view, seen=None):
        """A call that computes what a view shows."""
        kind, keywords = self.scene(view, seen)
        given = ",\n    ".join(f"{name}={value!r}" for name, value in keywords.items())
        return f"import pendres\n\nfound = pendres.{kind}(\n    {given})\nprint(found)\n"

    def deck(self, view, seen=None):
        """The deck of the same scene."""
        return _scenes.deck_of(*self.scene(view, seen))
