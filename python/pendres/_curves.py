"""Branches of orbits, their bifurcations, curves of these, and boundaries of basins."""
import warnings

import numpy as np

from ._handles import as_numbers, as_pendulums, default_context, filled, one, one_pendulum, record
from ._library import (Handle, array, c, enumerations, errors, ffi, kept, lib, make, member, stacked,
                       structures, viewed)
from ._shown import Shown, told, word

SPECIAL, JUMP, END = (enumerations[name] for name in (
    "pendres_special", "pendres_jump_kind", "pendres_branch_end"))


class Branch(Shown):
    """A branch of orbits in order: points (orbit, kind, arclength, ... see pendres_branch_point),
    its bifurcations (kind, value, value_error, orbit, ...), and how it ends at both ends
    (pendres.BranchEnd)."""

    def __init__(self, pointer, owner):
        self.pointer, self._owner = pointer, owner
        self.points = stacked("pendres_branch_point", [
            c.branch_get(pointer, i) for i in range(c.branch_count(pointer))])
        self.bifurcations = stacked("pendres_bifurcation", [
            c.branch_bifurcation_get(pointer, i) for i in range(c.branch_bifurcation_count(pointer))])
        self.ends = c.branch_end_get(pointer, 0), c.branch_end_get(pointer, 1)

    def __reduce__(self):
        return kept(self)

    def _sentence(self):
        first, last = (word(END, end) for end in self.ends)
        return f"branch of {self.points.size} points, ends: {first}, {last}"

    def _rows(self):
        return [("", "kind", "value", "amplitude")] + [
            (i, word(SPECIAL, b.kind), told(b.value, b.value_error), f"{b.orbit.amplitude:.6g}")
            for i, b in enumerate(self.bifurcations)] if self.bifurcations.size else []

    def at(self, value, *, context=None):
        """All orbits of the branch at a value of its parameter."""
        return _crossed("pendres_orbit", c.branch_cross, context, self.pointer, value)


class Branches(Handle):
    """A set of branches."""

    ctype = "pendres_branches"

    def list(self):
        """Its branches, which keep it."""
        return [Branch(c.branches_get(self, i), self) for i in range(c.branches_count(self))]


class Curve:
    """A curve of bifurcations in two parameters, in order: points (value[2], value_error[2],
    curvature, orbit, ...) and cusps (value[2], value_error[2], orbit)."""

    def __init__(self, pointer, owner):
        self.pointer, self._owner = pointer, owner
        self.points = stacked("pendres_curve_point", [
            c.curve_get(pointer, i) for i in range(c.curve_count(pointer))])
        self.cusps = stacked("pendres_cusp", [
            c.curve_cusp_get(pointer, i) for i in range(c.curve_cusp_count(pointer))])

    def __reduce__(self):
        return kept(self)

    def at(self, value, *, context=None):
        """The bifurcations of the curve at a value of its second parameter."""
        return _crossed("pendres_bifurcation", c.curve_cross, context, self.pointer, value)


class Curves(Handle):
    """A set of curves."""

    ctype = "pendres_curves"

    def list(self):
        """Its curves, which keep it."""
        return [Curve(c.curves_get(self, i), self) for i in range(c.curves_count(self))]


def _crossed(name, function, context, pointer, value):
    room, found = 16, ffi.new("size_t *")
    while True:
        out = array(name, room)
        function(default_context(context), pointer, value, room, out, found)
        if found[0] <= room:
            return out[:found[0]]
        room = found[0]


def _several(name, values):
    return np.ascontiguousarray(np.atleast_1d(structures(name, values)))


def _located(name, function, context, *arguments):
    """What a function finds and locates: with a warning, where its error exceeds the tolerance."""
    out = array(name)
    try:
        function(default_context(context), *arguments, out)
    except errors[lib.PENDRES_TOLERANCE_UNREACHABLE] as why:
        if not out["orbit"]["period"]:  # not found at all
            raise
        warnings.warn(str(why), RuntimeWarning, stacklevel=3)
    return record(out)


def branches(orbits, low, high, *, parameter="drive_frequency", context=None, **more):
    """The branches that orbits lie on, each once, stable and unstable parts, while `parameter`
    ("drive_frequency", "damping", "drive_amplitude", ...) is between low and high: a list of
    Branch. Further choices: spacing, wildest, most_points."""
    several = _several("pendres_orbit", orbits)
    choice = filled("pendres_branch_options", dict(parameter=parameter, low=low, high=high, **more))
    return make(Branches, c.branches_find, default_context(context), several.size, several,
                choice).list()


def fold(orbit, *, context=None):
    """The fold in drive frequency at the end of the branch that an orbit lies on: value,
    value_error, curvature, orbit. A RuntimeWarning tells if value_error exceeds the tolerance."""
    return _located("pendres_bifurcation", c.fold_find, context, one("pendres_orbit", orbit),
                    lib.PENDRES_DRIVE_FREQUENCY)


def curves(bifurcations, second, low, high, *, context=None, **more):
    """The curves that bifurcations lie on, each once, as the parameter in which they were found
    and a second one ("damping", ...) change between low[2] and high[2]: a list of Curve."""
    several = _several("pendres_bifurcation", bifurcations)
    choice = filled("pendres_curve_options", dict(second=second, low=low, high=high, **more))
    return make(Curves, c.curves_find, default_context(context), several.size, several,
                choice).list()


def cusp(near, second="damping", *, context=None):
    """The cusp that the curve of folds through `near` leads to, as its parameter and a second one
    change: value[2], value_error[2], orbit. A RuntimeWarning tells where an error exceeds the
    tolerance."""
    if isinstance(second, str):
        second = member(enumerations["pendres_parameter"], "second", second)
    return _located("pendres_cusp", c.cusp_find, context, one("pendres_bifurcation", near), second)


def backbone(p, *, context=None):
    """The drive frequency at which orbits lag pi/2 behind the drive: (orbits, frequency_error,
    outcome), one for each pendulum, whose own frequency is not read. A RuntimeWarning tells that
    some have none, with outcome NOT_FOUND and NaN, and NotFound that none has."""
    pendulums = np.ascontiguousarray(as_pendulums(p))
    found, outcome = (array(name, pendulums.shape) for name in ("pendres_orbit", "pendres_status"))
    error = np.empty(pendulums.shape)
    c.backbone_find(default_context(context), pendulums.size, pendulums, found, error, outcome)
    none = np.count_nonzero(outcome == lib.PENDRES_NOT_FOUND)
    if none:
        why = (f"{none} of {outcome.size} pendulums have no orbit that lags pi/2 behind the drive: "
               "no well, or too weak a damping for the drive")
        if none == outcome.size:
            raise errors[lib.PENDRES_NOT_FOUND](why)
        warnings.warn(why, RuntimeWarning, stacklevel=2)
    return record(found), error, outcome


class Boundary(Handle):
    """A basin boundary as a curve in pieces: x (rad), v, piece (0, 1, ...) and error of each point,
    without copies; bound, the largest error; complete, whether that is all of it."""

    ctype = "pendres_boundary"

    def __init__(self, pointer):
        super().__init__(pointer)
        b = self.pointer
        self.x, self.v, self.error = (viewed("double", ffi.cast("double *", a), b.count, b)
                                      for a in (b.x, b.v, b.error))
        self.piece = viewed("int", ffi.cast("int *", b.piece), b.count, b)
        self.bound, self.complete = b.bound, bool(b.complete)


class Hysteresis(Shown, Handle):
    """What was met on a path of a parameter: points (value, attractor, mean_velocity, ...), jumps
    (value, value_error, direction, kind, from, to, ...) and steps (winding, period, lower, upper,
    width, ...), see hysteresis.h."""

    ctype = "pendres_hysteresis"

    def __init__(self, pointer):
        super().__init__(pointer)
        self.points = stacked("pendres_hysteresis_point", [
            c.hysteresis_get(self, i) for i in range(c.hysteresis_count(self))])
        self.jumps = stacked("pendres_jump", [
            c.hysteresis_jump_get(self, i) for i in range(c.hysteresis_jump_count(self))])
        self.steps = stacked("pendres_step", [
            c.hysteresis_step_get(self, i) for i in range(c.hysteresis_step_count(self))])


    def _sentence(self):
        return (f"a path: {self.points.size} values; jumps: {self.jumps.size}; steps: "
                f"{self.steps.size}")

    def _rows(self):
        return [("", "direction", "kind", "value")] + [
            (i, "up" if jump.direction > 0 else "down", word(JUMP, jump.kind),
             told(jump.value, jump.value_error))
            for i, jump in enumerate(self.jumps)] if self.jumps.size else []


def hysteresis(p, values, x=np.pi / 2, v=0.0, *, parameter="drive_frequency", context=None):
    """The state that a pendulum from (x, v) settles on, followed along the values of a parameter,
    slowly and in their order: a Hysteresis. A sweep up and down is a list that ascends and then
    descends."""
    along = np.ascontiguousarray(as_numbers(values))
    start = filled("pendres_state", {"x": x, "v": v})
    path = filled("pendres_hysteresis_path", {"parameter": parameter, "n": along.size,
                                              "value": along.ctypes.data})
    return make(Hysteresis, c.hysteresis_find, default_context(context), one_pendulum(p), start,
                path)


def saddle(attractor, *, context=None):
    """The unstable orbit that separates the basin of an orbit (period one, stable) from its
    neighbour's."""
    out = array("pendres_orbit")
    c.saddle_find(default_context(context), one("pendres_orbit", attractor), out)
    return record(out)


def boundary(saddle_orbit, *, context=None, **more):
    """The boundary between two basins: the stable manifold of the saddle between them, in a window
    of initial states. Choices: x_low, x_high (rad), v_low, v_high, spacing, deviation,
    most_points."""
    return make(Boundary, c.boundary_find, default_context(context),
                one("pendres_orbit", saddle_orbit), filled("pendres_boundary_options", more))
