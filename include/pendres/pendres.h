/**
 * @file pendres.h
 * @brief Umbrella header of libpendres: everything public.
 *
 * How the interface grows. What a program keeps in its own memory (pendres_orbit,
 * pendres_resonance and all other structs that are not opaque) has a size that was compiled into
 * it. Within one soname (libpendres.so.N) these structs therefore keep their size, and their
 * fields their places; only functions come, and values at the ends of enums, before the one that
 * counts them. A release in which a struct has to grow gets a new soname, and a new node in
 * pendres.map, so that a program which was linked before goes on with the library that it knows,
 * beside the new one. Fields are then appended, so that a program's source stays as it is:
 * compiled anew, it finds zero in fields that it does not set, which means what was so before.
 * Until the first release nothing of this binds. abidiff compares two versions, see
 * CONTRIBUTING.md.
 */
#ifndef PENDRES_PENDRES_H
#define PENDRES_PENDRES_H

#include <pendres/version.h>
#include <pendres/status.h>
#include <pendres/names.h>
#include <pendres/pendulum.h>
#include <pendres/parameter.h>
#include <pendres/sweep.h>
#include <pendres/context.h>
#include <pendres/parts.h>
#include <pendres/strobe.h>
#include <pendres/orbit.h>
#include <pendres/attractor.h>
#include <pendres/free.h>
#include <pendres/response.h>
#include <pendres/resonance.h>
#include <pendres/continuation.h>
#include <pendres/rotation.h>
#include <pendres/cascade.h>
#include <pendres/hysteresis.h>
#include <pendres/lyapunov.h>
#include <pendres/dimension.h>
#include <pendres/spectrum.h>
#include <pendres/phase_diagram.h>
#include <pendres/boundary.h>
#include <pendres/cloud.h>
#include <pendres/basin.h>
#include <pendres/langevin.h>
#include <pendres/switching.h>
#include <pendres/ramp.h>
#include <pendres/reference.h>
#include <pendres/store.h>

#endif
