"""Resonance of driven, damped and noisy pendulums, computed by libpendres.

    import pendres
    p = pendres.pendulum(damping=0.24, drive_amplitude=0.2)
    r = pendres.resonance(p, 0.5, 1.2)
    print(r.frequency, r.frequency_error)

All quantities are dimensionless: times in units of 1/omega_0 of small oscillations, angles in rad,
energies, torques and loop areas in units of m g l; a position x is the pendulum's angle plus pi/2.
Results have the fields of the library's structures, errors included, as numpy records. Failures are
exceptions (pendres.Error) with the library's sentence. While the library computes, other threads
run: a function without `context=` uses one of its thread's own.

Scenes of the program `resonance`, each a function whose keywords are the keys of decks, return
xarray Datasets: pendres.hysteresis(damping=0.12, drive_amplitude=0.2, start="sa",
drive_frequency_range=(0.4, 1, 241)), pendres.lyapunov_map(...) and so on; pendres.run("f02.nml")
computes a deck, pendres.kinds() lists them, help(pendres.lyapunov_map) has their keys.

`pendres.c` has every public function of the library as C has it, with its documentation:
`help(pendres.c.strobe_advance)`, `dir(pendres.c)`; pendres.dtype(NAME) its structures for numpy.
"""
from . import _curves, _noise, _scenes, _states
from ._curves import (Boundary, Branch, Curve, Hysteresis, backbone, boundary, curves, cusp, fold,
                      saddle)
from ._files import open, pint_units, plot, si, words  # pylint: disable=redefined-builtin
from ._handles import Context, ensemble, pendulum
from ._library import (Error, Status, array, c, declared as _declared, dtype,
                       enumerations as _enumerations, errors as _errors, ffi, lib)
from ._motion import (free_frequency, free_frequency_integrate, orbit_sample, orbits,
                      strobe_advance, strobe_record)
from ._noise import (activation, cloud, cloud_request, cloud_steps, langevin_advance, linear_noise,
                     rate)
from ._scenes import explain, kinds, ramp, run
from ._states import Attractors, Basins, attractors, phase_line, resonance, settle

__version__ = _declared.constants["PENDRES_VERSION"]

SWITCHING_WELL = lib.PENDRES_SWITCHING_WELL

# Enumerations (pendres.Label.SA, pendres.Peak.EDGE, ...) and exceptions, as the headers list them.
for _kind in (*_enumerations.values(), *_errors.values()):
    globals()[_kind.__name__] = _kind


# The library's functions that have the name of a kind of scene: a pendulum, or what they find, goes
# before all else; keywords alone are a scene's.
_beside = {function.__name__: function for function in (
    _curves.branches, _curves.hysteresis, _noise.switching, _states.basins, _states.response)}


def __getattr__(name):
    """Kinds of scenes are the program's, which is not asked before one is wanted."""
    if name not in _beside:
        try:
            known = not name.startswith("_") and name in kinds()
        except (OSError, ImportError, Error) as why:
            raise AttributeError(f"pendres has no '{name}', and knows no scenes: {why}") from None
        if not known:
            raise AttributeError(f"pendres has no '{name}', and no scene is called so: "
                                 "dir(pendres) lists what there is")
    globals()[name] = _scenes.scene(name, _beside.get(name))
    return globals()[name]


def __dir__():
    try:
        scenes = kinds()
    except (OSError, ImportError, Error):
        scenes = ()
    return sorted({*globals(), *_beside, *scenes})
