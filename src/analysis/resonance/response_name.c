/* response_name.c -- names of states that are alone; see response_parts.h. */
#include "analysis/resonance/numbers.h"
#include "analysis/resonance/response_parts.h"

#include <math.h>
#include <stdlib.h>

#include "engine/context_internal.h"
#include "model/model.h"

static int waits(const pendres_attractor *a)
{
  return a->label == PENDRES_LABEL_PERIODIC && pendres_label_named(&a->orbit);
}

int pendres_response_nameless(const pendres_response *r)
{
  for (size_t i = 0; i < r->states; i++)
    if (waits(&r->state[i])) return 1;
  return 0;
}

/* The orbit of SA where it coexists with LA; states that are alone have no name yet. */
static const pendres_orbit *small_of(const pendres_response *r)
{
  for (size_t i = 0; i < r->states; i++)
    if (r->state[i].label == PENDRES_LABEL_SA) return &r->state[i].orbit;
  return NULL;
}

/* The SA of the highest value of the line's parameter below *limit, which becomes that value. */
static const pendres_orbit *highest_below(size_t n, const pendres_response *const *line,
                                          pendres_parameter parameter, double *limit)
{
  const pendres_orbit *best = NULL;
  double highest = -INFINITY;
  for (size_t i = 0; i < n; i++) {
    const pendres_orbit *o = small_of(line[i]);
    const double value = o != NULL ? pendres_parameter_get(parameter, &o->pendulum) : NAN;
    if (!(value < *limit && value > highest)) continue;
    highest = value;
    best = o;
  }
  *limit = highest;
  return best;
}

pendres_status pendres_response_small_end(pendres_context *ctx, size_t n,
                                          const pendres_response *const *line,
                                          pendres_parameter parameter, pendres_small_end *end)
{
  *end = (pendres_small_end){.known = 0};
  double limit = INFINITY;
  for (int k = 0; k < EDGE_ORBITS && !end->known; k++) {
    const pendres_orbit *o = highest_below(n, line, parameter, &limit);
    pendres_fold fold;
    if (o == NULL) break;
    const pendres_status status = pendres_fold_find(ctx, o, parameter, &fold);
    if (status == PENDRES_NOT_FOUND || status == PENDRES_NOT_CONVERGED) continue;
    if (status != PENDRES_OK && status != PENDRES_TOLERANCE_UNREACHABLE) return status;
    if (!(fold.curvature < 0.0 && fold.value >= limit && fold.orbit.amplitude >= o->amplitude))
      continue;
    *end = (pendres_small_end){.known = 1,
                               .parameter = fold.parameter,
                               .value = fold.value,
                               .amplitude = fold.orbit.amplitude};
  }
  return PENDRES_OK;
}

void pendres_response_name_by(const pendres_small_end *end, pendres_response *r)
{
  static const pendres_label_states alone = {.count = 0};
  size_t sa = 0, la = 0, all = r->unresolved + r->escaped + r->unlisted;
  if (!end->known || !pendres_response_nameless(r)) return;
  const pendres_label_border border = pendres_small_end_from(end, &r->pendulum);
  for (size_t i = 0; i < r->states; i++) {
    pendres_attractor *a = &r->state[i];
    if (waits(a)) a->label = pendres_label_of(&alone, &border, &a->orbit);
    if (a->label == PENDRES_LABEL_SA) sa += r->state_members[i];
    if (a->label == PENDRES_LABEL_LA) la += r->state_members[i];
    all += r->state_members[i];
  }
  const double members = (double)all;
  const int several = r->states > 1 || r->escaped > 0;
  const size_t uncertain = r->unresolved + r->unlisted + (several ? r->uncertain : 0);
  r->sa_fraction = (double)sa / members;
  r->la_fraction = (double)la / members;
  r->sa_fraction_error = r->la_fraction_error = (double)uncertain / members + r->sampling;
}

static pendres_status name_line(pendres_context *ctx, size_t n, pendres_response *responses)
{
  pendres_small_end end;
  size_t nameless = 0, drives = 0, amplitudes = 0, others = 0;
  if (n > 0 && responses == NULL) return PENDRES_CONTEXT_NULL(ctx, "responses");
  for (size_t i = 0; i < n; i++) {
    const pendres_pendulum *p = &responses[i].pendulum, *first = &responses[0].pendulum;
    const char *why = NULL;
    if (pendres_pendulum_check(p, &why) == PENDRES_OK &&
        responses[i].states > PENDRES_RESPONSE_STATES)
      why = "it lists more states than there is room for";
    if (why != NULL)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "response %zu: %s", i, why);
    drives += p->drive_frequency != first->drive_frequency;
    amplitudes += p->drive_amplitude != first->drive_amplitude;
    if (p->damping != first->damping || (drives > 0 && amplitudes > 0))
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                  "names need responses of one damping, and of one drive amplitude "
                                  "or one drive frequency");
    nameless += pendres_response_nameless(&responses[i]) != 0;
    others += pendres_model_kind(p) != PENDRES_MODEL_PLAIN;
  }
  const pendres_parameter parameter =
    amplitudes > 0 ? PENDRES_DRIVE_AMPLITUDE : PENDRES_DRIVE_FREQUENCY;
  /* Names come from branches of the plain pendulum alone. */
  if (nameless == 0 || others > 0) return PENDRES_OK;
  const pendres_response **line = malloc(n * sizeof *line);
  if (line == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu responses", n);
  for (size_t i = 0; i < n; i++) line[i] = &responses[i];
  const pendres_status status = pendres_response_small_end(ctx, n, line, parameter, &end);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    pendres_response_name_by(&end, &responses[i]);
  free(line);
  return status;
}

pendres_status pendres_response_label(pendres_context *ctx, size_t n, pendres_response *responses)
{
  return PENDRES_CONTEXT_CALL(ctx, name_line(ctx, n, responses));
}
