"""What the knobs show, as pictures of plain arrays; all of it is computed by the library.

A view is a function of the settings, of what is seen of it and of a context, and yields pictures,
each better than the one before. Layers are named after what they show; `figures` and `pictures`
know how each is drawn.
"""
import dataclasses

import numpy as np

from .. import _curves, _handles, _motion, _noise, _states
from .._library import enumerations
from .._shown import told, word

LABELS = enumerations["pendres_label"]
SPECIAL = enumerations["pendres_special"]
JUMPS = enumerations["pendres_jump_kind"]
LANGEVIN = enumerations["pendres_langevin_statistic"]
TURN = 2 * np.pi
SAMPLES = 128     # points of an orbit a drive period: smooth at any size of a window
TRACE = 40        # drive periods of a trace, as many as can be told apart
STROBES = 600     # points of what does not close
VALUES = 361      # of a parameter in a diagram
SETTLING = 240    # drive periods before its strobe points
KEPT = 48         # strobe points of each value
GRIDS = (64, 128, 256, 512)  # basins, finer and finer
CLOUD = 64, 40    # trajectories, strobes of each
TORQUES = 91


@dataclasses.dataclass
class Picture:
    """What is drawn: layers (name: its x and y), an image or None, and rows of words and numbers:
    (what, value, error), with one sentence below."""

    layers: dict
    image: tuple = None   # values[v, x], names of its values, (x low, high), (v low, high)
    rows: list = dataclasses.field(default_factory=list)
    note: str = ""


def name_of(label):
    """A label in words of files."""
    return word(LABELS, label)


def _joined(pieces):
    """Curves one after another, with gaps between them."""
    gap = np.array([np.nan])
    several = [np.concatenate([np.asarray(p, dtype=float), gap]) for p in pieces]
    return np.concatenate(several) if several else np.zeros(0)


def _add(layers, name, x, y):
    layers.setdefault(name, ([], []))
    layers[name][0].append(x)
    layers[name][1].append(y)


def _closed(layers):
    return {name: (_joined(x), _joined(y)) for name, (x, y) in layers.items()}


def _turned(settings, x):
    """A coordinate within the turn that is drawn, if it has turns."""
    return x if settings.force() else np.remainder(x + np.pi / 2, TURN) - np.pi / 2


def _without_wraps(x, v):
    """No line across the picture where a turn is taken out."""
    x, v = np.array(x, dtype=float), np.array(v, dtype=float)
    jumps = np.flatnonzero(np.abs(np.diff(x)) > np.pi) + 1
    return np.insert(x, jumps, np.nan), np.insert(v, jumps, np.nan)


# ---- Motion: trace, portrait, loop ---------------------------------------------------------------


def motion(settings, _seen, context):
    """The motion from the start: three pictures (trace, portrait, loop), and what it settles on."""
    p = settings.pendulum(temperature=0.0)
    x, v = _motion.strobe_record(p, settings.x, settings.v, TRACE, SAMPLES, context=context)
    t = np.arange(x.size) / SAMPLES
    drive = settings.drive_amplitude * np.cos(TURN * t)
    trace, portrait, loop = Picture({"motion": (t, x)}), Picture({}), Picture({})
    portrait.layers["motion"] = _without_wraps(_turned(settings, x), v)
    portrait.layers["start"] = np.array([settings.x]), np.array([settings.v])
    yield trace, portrait, loop
    known = _states.attractors(p, context=context)
    found, table = known.settle(settings.x, settings.v, context=context), known.table
    if found.attractor < 0:  # it may be one that the built-in starts do not find
        outcome, table = _states.settle(p, [settings.x], [settings.v], context=context)
        found = outcome[0]
    closed = {}
    for row, attractor in enumerate(table):
        _orbit_layers(settings, attractor, portrait, closed, context)
        trace.rows += _measures(attractor, row == found.attractor)
    loop.layers.update(_closed(closed))
    if found.attractor < 0 or not table[found.attractor].orbit.period:
        _open_layers(settings, p, name_of(found.label), portrait, context)
        loop.layers["motion"] = (_turned(settings, x), drive)
    trace.note = (f"From here: {name_of(found.label).replace('_', ' ')}" + (
        f", after {found.settling_periods} drive periods" if found.settling_periods >= 0 else "")
        + ("" if found.certain else " (not certain)"))
    yield trace, portrait, loop


def _orbit_layers(settings, attractor, portrait, loops, context):
    orbit = attractor.orbit
    if not orbit.period:
        return
    x, v = _motion.orbit_sample(orbit, SAMPLES, context=context)
    name = name_of(attractor.label)
    shown = _without_wraps(*(np.append(a, a[:1]) for a in (_turned(settings, x), v)))
    _add_line(portrait, name, *shown)
    _add_line(portrait, "strobe", _turned(settings, x[::SAMPLES]), v[::SAMPLES])
    force = settings.drive_amplitude * np.cos(TURN * np.arange(x.size) / SAMPLES)
    shown = _without_wraps(*(np.append(a, a[:1]) for a in (_turned(settings, x), force)))
    _add(loops, name, *shown)


def _add_line(picture, name, x, y):
    old = picture.layers.get(name, (np.zeros(0), np.zeros(0)))
    picture.layers[name] = tuple(_joined([a, b]) if a.size else np.asarray(b, dtype=float)
                                 for a, b in zip(old, (x, y)))


def _open_layers(settings, p, name, portrait, context):
    """Strobe points of what does not close."""
    if name in ("chaotic", "quasi_periodic", "unresolved"):
        x, v = _motion.strobe_record(p, settings.x, settings.v, STROBES, 1, context=context)
        half = x.size // 4
        _add_line(portrait, name + " strobes", _turned(settings, x[half:]), v[half:])


def _measures(attractor, here):
    """Its numbers, with their errors."""
    orbit, label = attractor.orbit, name_of(attractor.label)
    head = (("→ " if here else "") + label + (f", period {orbit.period}" if orbit.period > 1 else ""))
    rows = [(head, "", "")]
    for words, name in (("amplitude", "amplitude"), ("loop area", "loop_area"),
                        ("phase lag", "phase_lag"), ("power", "mean_power")):
        value, error = getattr(orbit, name), getattr(orbit, name + "_error")
        if np.isfinite(value):
            rows.append((words, value, error))
    if not orbit.period and np.isfinite(attractor.lyapunov):
        rows.append(("Lyapunov exponent", attractor.lyapunov, attractor.lyapunov_error))
    return rows


# ---- Response: branches over the drive frequency ---------------------------------------------------


def response(settings, _seen, context):
    """Amplitude over drive frequency: stable and unstable states, where they end, and the present
    point."""
    low, high = sorted((settings.lowest, settings.highest))
    here = np.clip(settings.drive_frequency, low, high)
    orbits = [_states.attractors(settings.pendulum(temperature=0.0, drive_frequency=w),
                                 context=context).table
              for w in dict.fromkeys((here, low, high, 0.5 * (low + high)))]
    orbits = np.concatenate([np.asarray(t["orbit"])[t["orbit"]["period"] > 0] for t in orbits])
    picture, layers = Picture({}), {}
    if orbits.size and high > low:
        for branch in _curves.branches(orbits, low, high, context=context):
            _branch_layers(branch, layers)
            picture.rows += [(word(SPECIAL, b.kind).replace("_", " "), b.value, b.value_error)
                             for b in branch.bifurcations]
    picture.layers = _closed(layers)
    table = _states.attractors(settings.pendulum(temperature=0.0), context=context).table
    shown = table[table.orbit.period > 0]
    picture.layers["here"] = (np.full(shown.size, settings.drive_frequency),
                              shown.orbit.amplitude)
    picture.note = "" if picture.layers else "no state that closes was found"
    yield picture


def _branch_layers(branch, layers):
    orbit = branch.points.orbit
    frequency, amplitude = orbit.pendulum.drive_frequency, orbit.amplitude
    stable = orbit.stable != 0
    turns = np.flatnonzero(np.diff(stable)) + 1
    edges = np.concatenate([[0], turns, [stable.size]])
    for first, last in zip(edges[:-1], edges[1:]):
        part = slice(max(0, first - 1), last)  # joined to what goes before
        _add(layers, "stable" if stable[first] else "unstable", frequency[part], amplitude[part])
    if branch.bifurcations.size:
        _add(layers, "bifurcation", branch.bifurcations.value,
             branch.bifurcations.orbit.amplitude)


# ---- Basins --------------------------------------------------------------------------------------


def basins(settings, seen, context):
    """Which start ends where, on finer and finer grids."""
    x0, x1, v0, v1 = settings.window(seen)
    p = settings.pendulum(temperature=0.0)
    for n in GRIDS:
        cells = (np.arange(n) + 0.5) / n
        found = _states.basins(p, x0 + (x1 - x0) * cells, v0 + (v1 - v0) * cells, context=context)
        table = found.attractors.table
        names = [name_of(label) for label in table.label]
        others = sorted(set(found.state.label[found.state.attractor < 0].tolist()))
        value = np.where(found.state.attractor >= 0, found.state.attractor, 0)
        for k, label in enumerate(others):
            value[(found.state.attractor < 0) & (found.state.label == label)] = len(names) + k
        rows = [(name, share, error) for name, share, error in
                zip(names, found.fraction, found.fraction_error)]
        for k, label in enumerate(others):
            rows.append((name_of(label), float(np.mean(value == len(names) + k)), np.nan))
        strobes = table[table.orbit.period > 0].orbit
        yield Picture({"strobe": (_turned(settings, strobes.x), strobes.v),
                       "start": (np.array([settings.x]), np.array([settings.v]))},
                      (value.T, names + [name_of(l) for l in others], (x0, x1), (v0, v1)), rows,
                      f"{n} × {n} starts")


# ---- A parameter that moves ----------------------------------------------------------------------


def diagram(settings, _seen, context):
    """Strobe points after a time of settling, from the start, at many values of a parameter."""
    values = np.linspace(settings.first, settings.last, VALUES)
    if settings.along != "torque":
        values = values[values > 0]
    p = settings.pendulum(temperature=0.0, **{settings.along: values})
    x, v = _motion.strobe_advance(p, settings.x, settings.v, SETTLING, context=context)
    seen = []
    for _ in range(KEPT):
        x, v = _motion.strobe_advance(p, x, v, 1, context=context)
        seen.append(_turned(settings, x))
    yield Picture({"strobe": (np.tile(values, KEPT), np.concatenate(seen)) if seen else ()}, note=(
        f"{KEPT} strobe points each after {SETTLING} drive periods from the start; whether it has "
        "settled then, bifurcation_diagram tells"))


def current(settings, _seen, context):
    """Mean velocity over the torque, up and down: a junction's voltage over its current."""
    up = np.linspace(0, 1.5, TORQUES)
    found = _curves.hysteresis(settings.pendulum(temperature=0.0), np.concatenate([up, up[::-1]]),
                               settings.x, settings.v, parameter="torque", context=context)
    points, picture = found.points, Picture({})
    for name, part in (("up", slice(0, TORQUES)), ("down", slice(TORQUES, None))):
        picture.layers[name] = points.value[part], points.mean_velocity[part]
    known = np.flatnonzero(np.isfinite(points.mean_velocity))
    if known.size:
        nearest = known[np.argmin(np.abs(points.value[known] - settings.torque))]
        picture.rows.append((f"mean velocity at {points.value[nearest]:.4g}",
                             points.mean_velocity[nearest], points.mean_velocity_error[nearest]))
    picture.rows += [(f"jump {'up' if j.direction > 0 else 'down'}, "
                      f"{word(JUMPS, j.kind)}", j.value, j.value_error)
                     for j in found.jumps]
    left = points.value.size - known.size
    picture.note = f"{left} values have no mean velocity" if left else ""
    yield picture


# ---- Noise ---------------------------------------------------------------------------------------


def noise(settings, _seen, context):
    """The cloud of strobe points that noise makes around each state, and its widths."""
    if not settings.temperature:
        yield Picture({}, note="no noise at temperature 0")
        return
    table = _states.attractors(settings.pendulum(temperature=0.0), context=context).table
    picture = Picture({})
    for attractor in table[table.orbit.period > 0]:
        orbit, name = attractor.orbit, name_of(attractor.label)
        request = _noise.cloud_request(settings.pendulum(), orbit.x, orbit.v,
                                       trajectories=CLOUD[0], record=CLOUD[1])
        statistics, x, v = _noise.cloud(request, points=True, context=context)
        _add_line(picture, name + " strobes", _turned(settings, x.ravel()), v.ravel())
        _add_line(picture, "strobe", _turned(settings, orbit.x[None]), orbit.v[None])
        for statistic in LANGEVIN:
            if statistic < statistics["statistics"]["value"].size:
                picture.rows.append((f"{name}: {statistic.name.lower().replace('_', ' ')}",
                                     statistics["statistics"]["value"][statistic],
                                     statistics["statistics"]["error"][statistic]))
        yield picture
    if not picture.layers:
        yield Picture({}, note="no state that closes was found")


VIEWS = {"motion": motion, "response": response, "basins": basins, "diagram": diagram,
         "current": current, "noise": noise}
