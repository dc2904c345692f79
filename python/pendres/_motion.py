"""Pendulums that move: strobes, trajectories, orbits, free oscillations."""
import numpy as np

from ._handles import (as_numbers, default_context, filled, one, one_pendulum, record, spread,
                       whole)
from ._library import array, c


def strobe_advance(p, x, v, periods, *, error=False, out=None, context=None):
    """Advance pendulums by whole drive periods: the new (x, v), or (x, v, error).

    p: pendulums; x, v: positions (rad) and velocities (rad per unit time) at drive phase 0. All are
    broadcast. x keeps its whole turns. error=True gives an estimate of the larger of the errors of
    x and v beside them, for four to five times the work. out=(x, v), two contiguous arrays of
    doubles, which may be those given, takes the results without a copy.
    """
    shape, (pendulums, xs, vs) = spread(p, x, v)
    if out is None:
        out = np.array(xs), np.array(vs)
    elif not isinstance(out, (tuple, list)) or out[0] is not xs or out[1] is not vs:
        if not (isinstance(out, (tuple, list)) and len(out) == 2 and all(
                isinstance(a, np.ndarray) and a.dtype == float and a.shape == xs.shape and
                a.flags.c_contiguous for a in out)):
            raise ValueError(f"out must be two contiguous arrays of doubles, of shape {xs.shape}")
        out[0][...], out[1][...] = xs, vs
    errors = np.empty(xs.shape) if error else None
    c.strobe_advance(default_context(context), xs.size, pendulums, *out,
                     whole("periods", periods), errors)
    found = (*out, errors) if error else out
    return tuple(found) if shape == xs.shape else tuple(a.reshape(shape)[()] for a in found)


def strobe_record(p, x0, v0, periods, samples, *, error=False, context=None):
    """One pendulum from (x0, v0) at drive phase 0 on, `samples` points per drive period: (x, v), or
    (x, v, x_error, v_error), of periods * samples + 1 points, at drive phases 2 pi k / samples."""
    count = whole("periods", periods) * whole("samples", samples, 1) + 1
    arrays = [np.empty(count) for _ in range(4 if error else 2)]
    start = filled("pendres_state", {"x": x0, "v": v0})
    out = filled("pendres_record", {name: values.ctypes.data for name, values in
                                    zip(("x", "v", "x_error", "v_error"), arrays)})
    c.strobe_record(default_context(context), one_pendulum(p), start, periods, samples, out)
    return tuple(arrays)


def orbits(p, x, v, *, period=1, winding=0, slopes=False, context=None):
    """Refine guesses to periodic orbits, stable or not: (orbits, outcome).

    p, x, v, period (in drive periods) and winding (whole turns in that time) are broadcast. Each
    orbit has its measures, a drive cycle, with errors: loop_area (of m g l), amplitude (rad),
    phase_lag (rad), multipliers, ... (see pendres_orbit in orbit.h). outcome is a pendres.Status
    for each: OK, NOT_CONVERGED (the orbit is then undefined), or TOLERANCE_UNREACHABLE.
    slopes=True computes derivatives by the drive frequency, too.
    """
    shape, (pendulums, xs, vs, periods, turns) = spread(p, x, v, period, winding)
    guess = filled("pendres_orbit_guess", {"pendulum": pendulums, "x": xs, "v": vs,
                                           "period": periods, "winding": turns},
                   array("pendres_orbit_guess", xs.shape))
    found, outcome = array("pendres_orbit", xs.shape), array("pendres_status", xs.shape)
    c.orbit_find(default_context(context), xs.size, guess, 1 if slopes else 0, found, outcome)
    return record(found.reshape(shape)), outcome.reshape(shape)[()]


def orbit_sample(orbit, count, *, error=False, context=None):
    """Points of an orbit, `count` a drive period, from drive phase 0 on: (x, v); error=True adds
    estimates of the largest error of any x and of any v."""
    given = one("pendres_orbit", orbit)
    size = whole("count", count, 1) * max(0, int(given["period"][0]))
    x, v = (np.empty(size) for _ in range(2))
    errors = np.empty(2) if error else None
    c.orbit_sample(default_context(context), given, count, x, v, errors)
    return (x, v, *errors) if error else (x, v)


def free_frequency(amplitude):
    """Exact frequency of the free, undamped pendulum of an amplitude (rad, from 0 to pi), in units
    of that of small oscillations; NaN outside."""
    return np.vectorize(c.free_frequency, otypes=[float])(as_numbers(amplitude))[()]


def free_frequency_integrate(amplitude, *, context=None):
    """The same by integration: (frequency, error)."""
    given = as_numbers(amplitude)
    values = np.ascontiguousarray(given)
    frequency, error = np.empty(values.shape), np.empty(values.shape)
    c.free_find(default_context(context), values.size, values, frequency, error)
    return frequency.reshape(given.shape)[()], error.reshape(given.shape)[()]
