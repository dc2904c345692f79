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

`pendres.c` has every public function of the library as C has it, with its documentation:
`help(pendres.c.strobe_advance)`, `dir(pendres.c)`; pendres.dtype(NAME) its structures for numpy.
"""
from ._curves import (Boundary, Branch, Curve, Hysteresis, backbone, boundary, branches, curves,
                      cusp, fold, hysteresis, saddle)
from ._files import open, words  # pylint: disable=redefined-builtin
from ._handles import Context, ensemble, pendulum
from ._library import (Error, Status, array, c, declared as _declared, dtype,
                       enumerations as _enumerations, errors as _errors, ffi, lib)
from ._motion import (free_frequency, free_frequency_integrate, orbit_sample, orbits,
                      strobe_advance, strobe_record)
from ._noise import (activation, cloud, cloud_request, cloud_steps, langevin_advance, linear_noise,
                     rate, switching)
from ._states import (Attractors, Basins, attractors, basins, phase_line, resonance, response,
                      settle)

__version__ = _declared.constants["PENDRES_VERSION"]

SWITCHING_WELL = lib.PENDRES_SWITCHING_WELL

# Enumerations (pendres.Label.SA, pendres.Peak.EDGE, ...) and exceptions, as the headers list them.
for _kind in (*_enumerations.values(), *_errors.values()):
    globals()[_kind.__name__] = _kind
