"""What pendulums settle on: attractors, responses, resonances, phase diagrams, basins."""
import numpy as np

from ._handles import (as_ensemble, as_numbers, as_pendulums, default_context, filled, one_pendulum,
                       record, spread)
from ._library import Handle, array, c, dtype, enumerations, ffi, make, stacked
from ._shown import Shown, told, word


LABEL = enumerations["pendres_label"]


class Attractors(Shown, Handle):
    """Attractors of a parameter set, as attractors() finds them. `table` has a row for each: label
    (pendres.Label), orbit, trap, lyapunov, ... (see pendres_attractor in attractor.h)."""

    ctype = "pendres_attractors"

    def __len__(self):
        return int(c.attractors_count(self))

    def _sentence(self):
        return f"attractors: {len(self)}"

    def _rows(self):
        orbits = self.table.orbit
        return [("", "label", "period", "amplitude", "loop area", "phase lag")] + [
            (i, word(LABEL, label), orbit.period or "–",
             *(told(orbit[name], orbit[name + "_error"])
               for name in ("amplitude", "loop_area", "phase_lag")))
            for i, (label, orbit) in enumerate(zip(self.table.label, orbits))] if len(self) else []

    @property
    def table(self):
        """All of them, numbered by amplitude; a copy."""
        return stacked("pendres_attractor", [c.attractors_get(self, i) for i in range(len(self))])

    def settle(self, x, v, *, context=None):
        """What pendulums at x (rad), v settle on, of these attractors alone: an array of
        label, attractor (its row, -1: unresolved), well, settling_periods, certain, period,
        winding, exponent and rotation with their errors."""
        xs, vs = np.broadcast_arrays(as_numbers(x), as_numbers(v))
        outcome = array("pendres_settled", xs.shape)
        c.attractors_settle(default_context(context), self, xs.size, np.ascontiguousarray(xs),
                            np.ascontiguousarray(vs), outcome)
        return record(outcome)


def attractors(p, x=None, v=None, *, context=None):
    """The attractors of one pendulum's parameters that initial guesses x (rad), v at drive phase 0
    lead to; without these, those that a built-in set of guesses finds."""
    xs, vs = (None, None) if x is None else (np.ascontiguousarray(a) for a in np.broadcast_arrays(
        as_numbers(x), as_numbers(0.0 if v is None else v)))
    return make(Attractors, c.attractors_find, default_context(context), one_pendulum(p),
                0 if xs is None else xs.size, xs, vs)


def settle(p, x, v, *, context=None):
    """What each of many pendulums settles on, whatever their parameters: (outcome, attractors).

    outcome has label (pendres.Label), attractor (row of the second result, -1: unresolved), well,
    settling_periods (drive periods), certain, period and winding of an orbit, exponent (a time unit)
    and rotation (turns a drive period) with their errors. Pendulums of equal parameters should be
    neighbours: they share what is found out.
    """
    shape, (pendulums, xs, vs) = spread(p, x, v)
    outcome = array("pendres_settled", xs.shape)
    found = make(Attractors, c.settle, default_context(context), xs.size, pendulums, xs, vs,
                 outcome)
    return record(outcome.reshape(shape)), found.table


def response(p, ensemble=None, *, context=None):
    """The mean response of an ensemble at each parameter set: mean_loop_area (of m g l),
    mean_loop_amplitude, mean_amplitude (rad), phase_lag (rad), mean_power, sa_fraction,
    la_fraction, each with its error, unresolved, uncertain, state[...] (see pendres_response)."""
    pendulums = as_pendulums(p)
    out = array("pendres_response", pendulums.shape)
    c.response_find(default_context(context), pendulums.size, np.ascontiguousarray(pendulums),
                    as_ensemble(ensemble, pendulums), out)
    return record(out)


def resonance(p, lowest=0.5, highest=1.2, ensemble=None, *, context=None):
    """The drive frequency between two at which an ensemble of pendulums, of p's damping and drive
    amplitude, dissipates most in a cycle: frequency, frequency_error, loop_area, loop_area_error,
    peak (pendres.Peak), response (everything else there), complete, ...

    Frequencies are in units of that of small oscillations. pendres.NotFound: the area is largest
    at an end of the range.
    """
    out, pendulum = array("pendres_resonance"), one_pendulum(p)
    c.resonance_find_ensemble(default_context(context), pendulum, lowest, highest,
                              as_ensemble(ensemble, pendulum), out)
    return record(out)


def phase_line(p, ensemble=None, *, parameter="drive_frequency", spacing=0.0, context=None):
    """Which states exist along a line of pendulums that differ in one parameter, "drive_frequency"
    or "drive_amplitude", ascending: (points, branches). points have regime (pendres.Regime, by the
    ensemble), exact (by the branches), sa_fraction, ...; branches as of branches()."""
    from ._curves import Branch
    pendulums = np.ascontiguousarray(as_pendulums(p)).ravel()
    if isinstance(parameter, str) and parameter not in ("drive_frequency", "drive_amplitude"):
        raise ValueError(f"parameter is drive_frequency or drive_amplitude, not '{parameter}'")
    values, dampings = (np.ascontiguousarray(pendulums[name]) for name in (parameter, "damping"))
    for name in pendulums.dtype.names:
        if name != parameter and np.any(pendulums[name] != pendulums[name][:1]):
            raise ValueError(f"the pendulums of a line differ in {parameter} alone, not in {name}")
    grid = array("pendres_phase_grid", 1)
    filled("pendres_phase_options", {"parameter": parameter, "spacing": spacing,
                                     "ensemble": as_ensemble(ensemble, pendulums)[()]}, grid["options"][0])
    filled("pendres_phase_grid", {
        "pendulum": pendulums[0], "values": values.size, "value": values.ctypes.data,
        "across": "damping", "lines": 1, "line_value": dampings.ctypes.data}, grid)
    ctx = default_context(context)
    found = make(PhaseDiagram, c.phase_diagram_find, ctx, grid)
    for i in range(values.size):
        failed = c.phase_diagram_outcome_get(found, i, None)
        if failed:
            raise failed
    points = stacked("pendres_phase_point", [
        c.phase_diagram_point_get(found, i) for i in range(values.size)])
    all_branches = c.phase_diagram_branches_get(found, 0)
    return points, [Branch(c.branches_get(all_branches, i), found)
                    for i in range(c.branches_count(all_branches))]


class PhaseDiagram(Handle):
    """A phase diagram, as the library has it."""

    ctype = "pendres_phase_diagram"


class Basins(Shown):
    """Basins of attraction over a grid. state[i, j] began at x[i], v[j], with label
    (pendres.Label), attractor (row of `attractors.table`), well, settling_periods and how;
    fraction and fraction_error are shares of the area; statistics is pendres_basin_statistics."""

    def __init__(self, x, v, found, state):
        self.x, self.v, self.attractors, self.state = x, v, found, state
        self.fraction, self.fraction_error = np.empty(len(found)), np.empty(len(found))
        self.statistics = array("pendres_basin_statistics")
        sums = ffi.new("pendres_basin_sums **")
        c.basin_sums_create(_grid(x, v), len(found), sums)
        kept = ffi.gc(sums[0], c.basin_sums_free)
        c.basin_sums_add(kept, x.size, state)
        c.basin_sums_result(kept, self.statistics, self.fraction, self.fraction_error)

    def _sentence(self):
        return (f"basins, attractors: {len(self.attractors)}, on {self.x.size} x {self.v.size} "
                "starts")

    def _rows(self):
        return [("", "label", "share")] + [
            (i, word(LABEL, label), told(share, error)) for i, (label, share, error) in enumerate(
                zip(self.attractors.table.label, self.fraction, self.fraction_error))]


def _grid(x, v):
    """A grid on arrays of the caller's, which it keeps alive."""
    grid = np.zeros(1, dtype("pendres_basin_grid"))
    grid["nx"], grid["nv"], grid["x"], grid["v"] = x.size, v.size, x.ctypes.data, v.ctypes.data
    return grid


def basins(p, x, v, *, context=None):
    """What each state (x[i], v[j]) of a grid settles on, x in rad, both ascending: a Basins."""
    ctx, one = default_context(context), one_pendulum(p)
    xs, vs = (np.ascontiguousarray(as_numbers(a)) for a in (x, v))
    grid = _grid(xs, vs)
    found = make(Attractors, c.basin_attractors, ctx, one, grid)
    state = array("pendres_basin_state", (xs.size, vs.size))
    c.basin_find(ctx, found, grid, state)
    return Basins(xs, vs, found, state)
