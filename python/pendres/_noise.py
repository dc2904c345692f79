"""Pendulums with thermal noise: trajectories, clouds, linear theory, switching. The seed of all
random numbers is the context's: Context(seed=7). Equal seeds, ids and periods have equal noise."""
import numpy as np

from ._handles import default_context, one_pendulum, spread
from ._library import array, c, ffi, lib


def _filled(name, **fields):
    """One structure with these fields; arrays and handles by their addresses."""
    made = array(name, 1)
    for key, value in fields.items():
        if made.dtype[key] == np.uintp and isinstance(value, np.ndarray):
            value = value.ctypes.data
        made[key] = value
    return made


def langevin_advance(p, x, v, periods, *, first_period=0, ids=None, steps_per_period=0,
                     context=None):
    """Advance noisy trajectories by drive periods, which are first_period and the next ones of
    their lives: the new (x, v). p (with temperature), x (rad), v at drive phase 0 are broadcast;
    ids are 0, 1, ... unless given."""
    shape, (pendulums, xs, vs) = spread(p, x, v)
    names = np.arange(xs.size, dtype=np.uint64) if ids is None else np.ascontiguousarray(
        np.broadcast_to(np.asarray(ids, np.uint64), shape))
    out = np.array(xs), np.array(vs)
    run = _filled("pendres_langevin_run", n=xs.size, pendulums=pendulums, ids=names,
                  first_period=first_period, periods=periods, steps_per_period=steps_per_period)
    c.langevin_advance(default_context(context), run, *out)
    return tuple(a.reshape(shape)[()] for a in out)


def cloud_request(p, x, v, *, trajectories=200, settle=20, record=50, **more):
    """What to make a cloud of: independent trajectories from (x, v), the strobe point of the
    attractor, with `record` strobes of each after `settle` drive periods."""
    return _filled("pendres_langevin_request", pendulum=one_pendulum(p), x=x, v=v, settle=settle,
                   trajectories=trajectories, record=record, **more)


def cloud_steps(request, *, tolerance=0.05, context=None):
    """The steps a period with which a cloud's biases stay below `tolerance` of its widths, with
    these biases: a pendres_langevin_bias."""
    bias = array("pendres_langevin_bias")
    c.langevin_choose_steps(default_context(context), request, lib.PENDRES_LANGEVIN_CLOUD,
                            tolerance, bias)
    return bias[()]


def cloud(request, *, points=False, context=None):
    """The cloud that trajectories make at their strobes: its statistics (value, error; indexed by
    pendres.LangevinStatistic), phase_lag, ... With points=True also the points: (cloud, x, v), of
    shape (trajectories, record)."""
    found, shape = array("pendres_langevin_cloud"), (int(request.trajectories[0]),
                                                     int(request.record[0]))
    xs, vs = (np.empty(shape) for _ in range(2)) if points else (None, None)
    c.langevin_measure(default_context(context), request, found, xs, vs)
    return (found[()], xs, vs) if points else found[()]


def switching(p, attractors, start, *, trajectories, periods, context=None, **more):
    """Count how noisy trajectories that start on attractor number `start` go to others, in
    `periods` drive periods each: a pendres_switching_tally for rate()."""
    request = _filled("pendres_switching_request", pendulum=one_pendulum(p),
                      set=int(ffi.cast("uintptr_t", attractors.pointer)), trajectories=trajectories,
                      periods=periods, **{"from": start}, **more)
    tally = array("pendres_switching_tally")
    c.switching_count(default_context(context), request, tally)
    return tally


def linear_noise(p, x, v, *, cycle=1):
    """Covariance of the small cloud around the orbit through (x, v) that closes after `cycle`
    drive periods, exact to first order in the temperature: covariance (xx, xv, vv), monodromy,
    closure, error."""
    out = array("pendres_langevin_linear")
    c.langevin_linear_theory(one_pendulum(p), x, v, cycle, out)
    return out[()]


def rate(tally, start, end, *, level=0.95):
    """The rate, a unit time, of switching from one attractor to another (end =
    pendres.SWITCHING_WELL: any other well): value, error, lower, upper, events, exposure, ..."""
    out = array("pendres_switching_rate")
    c.switching_rate_of(tally, start, end, level, out)
    return out[()]


def activation(temperature, rates, *, fewest=0.0):
    """Activation energy from rates at several temperatures: energy, energy_error (of m g l),
    log_prefactor, ... (see pendres_switching_activation)."""
    temperatures = np.ascontiguousarray(temperature, float)
    several = array("pendres_switching_rate", temperatures.shape)
    for i, one in enumerate(rates):
        several[i] = one
    out = array("pendres_switching_activation")
    c.switching_fit(temperatures.size, temperatures, several, fewest, out)
    return out[()]
