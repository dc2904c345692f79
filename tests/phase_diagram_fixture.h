/* phase_diagram_fixture.h -- what the tests of phase diagrams share. */
#ifndef PHASE_DIAGRAM_FIXTURE_H
#define PHASE_DIAGRAM_FIXTURE_H

#include <stdlib.h>
#include <string.h>

#include <pendres/phase_diagram.h>
#include "oracle/reference.h"

#include "check.h"

/* Damping 0.13, drive amplitude 0.2. */
static const double sa_fold = 0.844925197542337284, la_fold = 0.753512458983320393;
static const double cusp_damping = 0.163656902031172567, cusp_frequency = 0.862157913509009358;

static inline pendres_context *context_of(double tolerance)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = tolerance}, &ctx));
  return ctx;
}

/* Lines along the drive frequency, with these members. */
static inline const pendres_phase_options *with(const pendres_ensemble *e)
{
  static pendres_phase_options o;
  o = (pendres_phase_options){.ensemble = *e};
  return &o;
}

enum { DRIVES = 7 };

typedef struct line {
  pendres_phase_point points[DRIVES];
  pendres_branches *branches;
} line;

static inline const pendres_ensemble *members(void)
{
  static pendres_ensemble e;
  e = pendres_ensemble_default();
  return &e;
}

#endif
