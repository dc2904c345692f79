"""Pendulums with thermal noise: trajectories, clouds, linear theory, switching. The seed of all
random numbers is the context's: Context(seed=7). Equal seeds, ids and periods have equal noise."""
import numpy as np

from ._handles import as_numbers, default_context, filled, one, one_pendulum, spread
from ._library import array, c, ffi, lib, structures
from ._states import Attractors


def _ids(given):
    ids = np.asarray(given)
    if ids.dtype.kind not in "iu" or (ids.size and ids.min() < 0):
        raise TypeError(f"ids: whole numbers that are not negative are wanted, not {given!r:.40}")
    return ids.astype(np.uint64)


def langevin_advance(p, x, v, periods, *, first_period=0, ids=None, steps_per_period=0,
                     context=None):
    """Advance noisy trajectories by drive periods, which are first_period and the next ones of
    their lives: the new (x, v). p (with temperature), x (rad), v at drive phase 0 are broadcast;
    ids are 0, 1, ... unless given."""
    shape, (pendulums, xs, vs) = spread(p, x, v)
    names = np.arange(xs.size, dtype=np.uint64) if ids is None else np.ascontiguousarray(
        np.broadcast_to(_ids(ids), shape))
    out = np.array(xs), np.array(vs)
    run = filled("pendres_langevin_run", {
        "n": xs.size, "pendulums": pendulums.ctypes.data, "ids": names.ctypes.data,
        "first_period": first_period, "periods": periods, "steps_per_period": steps_per_period})
    c.langevin_advance(default_context(context), run, *out)
    return tuple(a.reshape(shape)[()] for a in out)


def cloud_request(p, x, v, *, trajectories=200, settle=20, record=50, **more):
    """What to make a cloud of: independent trajectories from (x, v), the strobe point of the
    attractor, with `record` strobes of each after `settle` drive periods."""
    return filled("pendres_langevin_request", dict(
        pendulum=one_pendulum(p)[0], x=x, v=v, settle=settle, trajectories=trajectories,
        record=record, **more), array("pendres_langevin_request", 1))


def cloud_steps(request, *, tolerance=0.05, context=None):
    """The steps per period with which a cloud's biases stay below `tolerance` of its widths, with
    these biases: a pendres_langevin_bias."""
    request = one("pendres_langevin_request", request)
    bias = array("pendres_langevin_bias")
    c.langevin_choose_steps(default_context(context), request, lib.PENDRES_LANGEVIN_CLOUD,
                            tolerance, bias)
    return bias[()]


def cloud(request, *, points=False, context=None):
    """The cloud that trajectories make at their strobes: its statistics (value, error; indexed by
    pendres.LangevinStatistic), phase_lag, ... With points=True also the points: (cloud, x, v), of
    shape (trajectories, record)."""
    request = one("pendres_langevin_request", request)
    found, shape = array("pendres_langevin_cloud"), (int(request["trajectories"][0]),
                                                     int(request["record"][0]))
    xs, vs = (np.empty(shape) for _ in range(2)) if points else (None, None)
    c.langevin_cloud_find(default_context(context), request, found, xs, vs)
    return (found[()], xs, vs) if points else found[()]


def switching(p, attractors, start, *, trajectories, periods, context=None, **more):
    """Count how noisy trajectories that start on attractor number `start` go to others, in
    `periods` drive periods each: a pendres_switching_tally for rate()."""
    if not isinstance(attractors, Attractors):
        raise TypeError(f"attractors() of the pendulum are wanted, not {attractors!r:.40}")
    request = filled("pendres_switching_request", dict(
        pendulum=one_pendulum(p)[0], set=int(ffi.cast("uintptr_t", attractors.pointer)),
        trajectories=trajectories, periods=periods, **{"from": start}, **more))
    tally = array("pendres_switching_tally")
    c.switching_count(default_context(context), request, tally)
    return tally


def linear_noise(p, x, v, *, cycle=1):
    """Covariance of the small cloud around the orbit through (x, v) that closes after `cycle`
    drive periods, exact to first order in the temperature: covariance (xx, xv, vv), monodromy,
    closure, error."""
    out = array("pendres_langevin_linear")
    c.langevin_linear_find(one_pendulum(p), x, v, cycle, out)
    return out[()]


def rate(tally, start, end, *, level=0.95):
    """The rate, per unit time, of switching from one attractor to another (end =
    pendres.SWITCHING_WELL: any other well): value, error, lower, upper, events, exposure, ..."""
    out = array("pendres_switching_rate")
    c.switching_rate_of(one("pendres_switching_tally", tally), start, end, level, out)
    return out[()]


def activation(temperature, rates, *, fewest=0.0):
    """Activation energy from rates at several temperatures: energy, energy_error (of m g l),
    log_prefactor, ... (see pendres_switching_activation)."""
    temperatures = np.ascontiguousarray(as_numbers(temperature))
    several = np.ascontiguousarray(structures("pendres_switching_rate", rates))
    if several.size != temperatures.size:
        raise ValueError(f"a rate at each of {temperatures.size} temperatures is wanted, not "
                         f"{several.size}")
    out = array("pendres_switching_activation")
    c.switching_fit(temperatures.size, temperatures, several, fewest, out)
    return out[()]
