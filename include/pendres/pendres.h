/**
 * @file pendres.h
 * @brief Umbrella header of libpendres: everything public.
 *
 * How the interface lasts. Within one soname (libpendres.so.1) a program that was linked goes on
 * with every later library. Functions keep their names, arguments and meaning; values of enums keep
 * their numbers. What a program keeps in its own memory (pendres_orbit, pendres_resonance and all
 * other structs that are not opaque) has a size that was compiled into it, and keeps it. Three
 * things come: functions; values at the ends of enums, before the one that counts them; and fields
 * at the ends of options. Structs called options begin with their size for that: a program that
 * sets it to sizeof the struct may use all fields that its headers have, and one that leaves it 0
 * those of version 1.0. Fields are zero by default, and zero means what was so before. Structs that
 * the library itself makes and hands out by pointers may grow at their ends, too.
 *
 * docs/interface.md lists all functions by what one asks, and tells how one is replaced by another.
 */
#ifndef PENDRES_PENDRES_H
#define PENDRES_PENDRES_H

#include <pendres/version.h>
#include <pendres/status.h>
#include <pendres/names.h>
#include <pendres/pendulum.h>
#include <pendres/formula.h>
#include <pendres/quantity.h>
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
#include <pendres/escape.h>
#include <pendres/spectrum.h>
#include <pendres/phase_diagram.h>
#include <pendres/boundary.h>
#include <pendres/cloud.h>
#include <pendres/basin.h>
#include <pendres/langevin.h>
#include <pendres/switching.h>
#include <pendres/ramp.h>
#include <pendres/fit.h>
#include <pendres/store.h>

#endif
