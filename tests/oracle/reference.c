/*
 * reference.c -- the strobe map of the independent reference; see reference.h.
 */
#include "oracle/reference.h"

#include <math.h>
#include <stddef.h>

#include "oracle/taylor.h"

static pendres_status check_start(const pendres_pendulum *p, long double y, long double v,
                                  long periods, reference_model *model)
{
  if (!(fabsl(y) <= 1e9L) || !isfinite(v) || periods < 0) return PENDRES_INVALID_ARGUMENT;
  return reference_model_of(p, model);
}

pendres_status reference_advance(const pendres_pendulum *p, long double *y,
                                         long double *v, long *turns, long periods)
{
  if (y == NULL || v == NULL) return PENDRES_INVALID_ARGUMENT;
  reference_model model;
  pendres_status status = check_start(p, *y, *v, periods, &model);
  if (status != PENDRES_OK) return status;
  reference_run run;
  const long start = reference_taylor_init(&run, &model, *y, *v);
  status = reference_taylor_advance(&run, periods);
  if (status != PENDRES_OK) return status;
  *y = run.y.hi;
  *v = run.v.hi;
  if (turns != NULL) *turns += start + run.turns;
  return PENDRES_OK;
}

pendres_status reference_map(const pendres_pendulum *p, long double y, long double v,
                                     long periods, reference_image *out)
{
  if (out == NULL) return PENDRES_INVALID_ARGUMENT;
  reference_model model;
  pendres_status status = check_start(p, y, v, periods, &model);
  if (status != PENDRES_OK) return status;
  reference_run run;
  const long start = reference_taylor_init(&run, &model, y, v);
  run.columns = REFERENCE_COLUMNS;
  status = reference_taylor_advance(&run, periods);
  if (status != PENDRES_OK) return status;
  out->y = run.y.hi;
  out->v = run.v.hi;
  out->turns = start + run.turns;
  for (int i = 0; i < 2; i++) {
    const reference_pair *row = i == 0 ? run.u : run.w;
    out->monodromy[i][0] = row[REFERENCE_BY_Y].hi;
    out->monodromy[i][1] = row[REFERENCE_BY_V].hi;
    out->by_frequency[i] = row[REFERENCE_BY_FREQUENCY].hi;
    out->by_damping[i] = row[REFERENCE_BY_DAMPING].hi;
    out->by_amplitude[i] = row[REFERENCE_BY_AMPLITUDE].hi;
  }
  return PENDRES_OK;
}
