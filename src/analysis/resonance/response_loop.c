/* response_loop.c -- averaged loops of many harmonics; see response_parts.h. */
#include "analysis/resonance/response_parts.h"

#include <math.h>
#include <stdlib.h>

#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "orbits/orbit_series.h"

int pendres_response_has_loop(const pendres_attractor *a)
{
  return pendres_attractor_closes(a) && a->orbit.winding == 0;
}

/* The number of harmonics that a trace of the attractors' orbits determines, and the mean. */
static size_t modes_of(size_t n, const pendres_attractor *attractor, const size_t *members)
{
  int steps = 1;
  for (size_t i = 0; i < n; i++)
    if (members[i] > 0 && pendres_response_has_loop(&attractor[i]) &&
        attractor[i].orbit.steps > steps)
      steps = attractor[i].orbit.steps;
  return 3 * (size_t)steps / 2 + 1;
}

pendres_status pendres_response_refine_loop(pendres_context *ctx, size_t n,
                                            const pendres_attractor *attractor,
                                            const size_t *members, pendres_response *r)
{
  double rest = 0.0, share = 0.0, highest = NAN, lowest = NAN;
  size_t loops = 0;
  for (size_t i = 0; i < n; i++) {
    if (members[i] == 0 || !pendres_response_has_loop(&attractor[i])) continue;
    rest += (double)members[i] * attractor[i].orbit.harmonics_rest;
    share += (double)members[i];
    loops += 1 + (attractor[i].orbit.period > 1);
  }
  /* One loop that closes in a cycle is the orbit itself, and has its amplitude. */
  if (loops <= 1 || !(rest > share * pendres_accuracy_negligible(ctx))) return PENDRES_OK;

  const size_t modes = modes_of(n, attractor, members);
  pendres_orbit_series all = {.samples = (2 * modes + 2) / 3, .modes = modes};
  double *memory = calloc(2 * modes + 3 * all.samples, sizeof *memory);
  if (memory == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu harmonics",
                                modes);
  all.re = memory;
  all.im = memory + modes;
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    if (members[i] > 0 && pendres_response_has_loop(&attractor[i]))
      status = pendres_orbit_add_harmonics(ctx, &attractor[i].orbit, (double)members[i] / share,
                                           &all);
  if (status == PENDRES_OK) {
    pendres_orbit_tables tables = {0};
    status = pendres_orbit_series_extremes(&tables, &all, &highest, &lowest);
    pendres_orbit_tables_free(&tables);
    if (status != PENDRES_OK)
      (void)pendres_context_fail(ctx, status, "an averaged loop could not be transformed");
  }
  if (status == PENDRES_OK) {
    r->mean_loop_amplitude = 0.5 * (highest - lowest);
    r->mean_loop_amplitude_error -= rest / share;
  }
  free(memory);
  return status;
}

pendres_status pendres_response_renew(pendres_context *ctx, pendres_response *r)
{
  pendres_response_average(r);
  return pendres_response_refine_loop(ctx, r->states, r->state, r->state_members, r);
}
