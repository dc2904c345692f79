/*
 * pendres.h -- umbrella header of libpendres: everything public.
 */
#ifndef PENDRES_PENDRES_H
#define PENDRES_PENDRES_H

#include <pendres/version.h>
#include <pendres/status.h>
#include <pendres/pendulum.h>
#include <pendres/sweep.h>
#include <pendres/context.h>
#include <pendres/strobe.h>
#include <pendres/orbit.h>
#include <pendres/attractor.h>
#include <pendres/free.h>
#include <pendres/response.h>
#include <pendres/resonance.h>
#include <pendres/continuation.h>
#include <pendres/cascade.h>
#include <pendres/hysteresis.h>
#include <pendres/lyapunov.h>
#include <pendres/phase_diagram.h>
#include <pendres/boundary.h>
#include <pendres/cloud.h>
#include <pendres/basin.h>
#include <pendres/langevin.h>
#include <pendres/switching.h>
#include <pendres/reference.h>
#include <pendres/store.h>

#endif
