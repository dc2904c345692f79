/* resonance.c -- searches for the largest mean loop area; see resonance.h. */
#include <pendres/resonance.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/resonance/numbers.h"
#include "engine/context_internal.h"
#include "engine/door.h"
#include "engine/strobe_run.h"
#include "analysis/resonance/search.h"
#include "analysis/resonance/response_parts.h"
#include "model/equation.h"

/* A resonance that is not known: its numbers are NaN. */
static void clear(pendres_resonance *out)
{
  memset(out, 0, sizeof *out);
  pendres_response_average(&out->response);
  out->frequency = out->frequency_error = out->loop_area = out->loop_area_error = NAN;
  out->fold_frequency = out->fold_frequency_error = NAN;
}

/*
 * A search takes the ensemble's members as they are. If they are a sample of a continuous set of
 * starts, they are settled once more at the resonance, and sampling errors are added to the errors
 * of shares and means there.
 */
static pendres_status add_sampling(pendres_context *ctx, const pendres_ensemble *e,
                                   pendres_resonance *out)
{
  pendres_response there;
  if (e->shape == PENDRES_ENSEMBLE_LINE || !isfinite(out->frequency)) return PENDRES_OK;
  const pendres_status status =
    pendres_response_find(ctx, 1, &out->response.pendulum, e, &there);
  if (status != PENDRES_OK) return status;
  pendres_response_widen(&out->response, there.sampling);
  out->loop_area_error = fmax(out->loop_area_error, out->response.mean_loop_area_error);
  return PENDRES_OK;
}

/* NULL, or why no resonance can be looked for with these parameters. */
static const char *refuses(const pendres_pendulum *p, double lowest, double highest,
                           const pendres_ensemble *ensemble)
{
  const char *why = NULL;
  if (!(lowest > 0.0 && highest > lowest && isfinite(highest)))
    return "the range of frequencies must be positive and ascending";
  (void)pendres_ensemble_check(ensemble, &why);
  for (int i = 0; i < 2 && why == NULL; i++) {
    pendres_pendulum at = *p;
    at.drive_frequency = i == 0 ? lowest : highest;
    if (pendres_pendulum_check(&at, &why) == PENDRES_OK)
      why = pendres_response_refuses(&at, ensemble);
  }
  return why;
}

/* Without a drive there is nothing to scan, and a pendulum at the upright position stays there. */
static int is_at_rest(const pendres_pendulum *p)
{
  return p->drive_amplitude == 0.0 && pendres_equation_undamped(p) == NULL;
}

pendres_status pendres_resonance_find_within(pendres_context *ctx, const pendres_pendulum *p,
                                             const double range[2],
                                             const pendres_ensemble *ensemble, double most_work,
                                             pendres_resonance *out)
{
  if (p == NULL || ensemble == NULL || out == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "pendulum, ensemble and out");
  clear(out);
  const char *why = refuses(p, range[0], range[1], ensemble);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", why);
  if (is_at_rest(p)) return pendres_resonance_no_area(ctx, p);
  pendres_search search, *s = &search;
  pendres_search_budget budget = pendres_search_budget_of(ctx, most_work);
  pendres_status status = pendres_search_create(&budget, p, ensemble, s);
  s->lowest = range[0];
  s->highest = range[1];
  while (status == PENDRES_OK) {
    status = pendres_search_next(s, out);
    if (status != PENDRES_OK || s->requests == 0) break;
    status = pendres_search_add(1, &s);
  }
  if (status == PENDRES_OK) status = add_sampling(ctx, ensemble, out);
  if (status != PENDRES_OK) clear(out);
  pendres_search_free(s);
  return status;
}

pendres_status pendres_resonance_find_ensemble(pendres_context *ctx, const pendres_pendulum *p,
                                               double lowest, double highest,
                                               const pendres_ensemble *ensemble,
                                               pendres_resonance *out)
{
  pendres_door d = pendres_door_open(ctx, p);
  const double unit = pendres_units_factor(&d.scales, 0, -1);
  const double range[2] = {lowest / unit, highest / unit};
  PENDRES_DOOR_IN(&d, pendulum, 1, p);
  PENDRES_DOOR_IN(&d, ensemble, 1, ensemble);
  PENDRES_DOOR_OUT(&d, resonance, 1, out);
  return PENDRES_DOOR_END(&d,
                          pendres_resonance_find_within(ctx, p, range, ensemble, search_most_work,
                                                            out));
}

/* ---- side by side ---- */

/* Some searches that share a budget. */
typedef struct party {
  const pendres_ensemble *ensemble;
  pendres_search_budget budget;
  size_t n;
  struct seeker {
    enum { SEEKER_ALONE, SEEKER_TOGETHER, SEEKER_ENDED } state;
    pendres_search search;
    pendres_resonance_search *of;
  } seeker[SEARCH_TOGETHER];
} party;

/* Note how a search has ended. A failure that does not concern this search alone is returned. */
static pendres_status end(pendres_context *ctx, pendres_status status, struct seeker *k)
{
  pendres_resonance_search *of = k->of;
  k->state = SEEKER_ENDED;
  of->outcome = status;
  of->message[0] = '\0';
  if (status == PENDRES_OK) return status;
  clear(&of->resonance);
  snprintf(of->message, sizeof of->message, "%s", pendres_context_message(ctx));
  return status == PENDRES_INTERRUPTED || status == PENDRES_OUT_OF_MEMORY ? status : PENDRES_OK;
}

/* Make a search's next step: it then either requests frequencies or has ended. */
static pendres_status step(pendres_context *ctx, const party *p, struct seeker *k)
{
  pendres_resonance *out = &k->of->resonance;
  pendres_status status = PENDRES_CONTEXT_CALL(ctx, pendres_search_next(&k->search, out));
  /* With a budget of its own it might have continued. */
  if (p->budget.exhausted && status != PENDRES_INTERRUPTED) return PENDRES_OK;
  if (status == PENDRES_OK && k->search.requests > 0) return status;
  if (status == PENDRES_OK)
    status = PENDRES_CONTEXT_CALL(ctx, add_sampling(ctx, p->ensemble, out));
  return end(ctx, status, k);
}

/* Go on until all searches have ended, or the budget is spent, or an evaluation fails. That is due
   to one of them, which shows when it is started again alone. */
static pendres_status go_together(pendres_context *ctx, party *p)
{
  for (;;) {
    pendres_search *requesting[SEARCH_TOGETHER];
    size_t count = 0;
    for (size_t i = 0; i < p->n; i++) {
      if (p->seeker[i].state != SEEKER_TOGETHER) continue;
      const pendres_status status = step(ctx, p, &p->seeker[i]);
      if (status != PENDRES_OK || p->budget.exhausted) return status;
      if (p->seeker[i].state == SEEKER_TOGETHER) requesting[count++] = &p->seeker[i].search;
    }
    if (count == 0) return PENDRES_OK;
    const pendres_status status = PENDRES_CONTEXT_CALL(ctx, pendres_search_add(count, requesting));
    if (status == PENDRES_INTERRUPTED) return status;
    if (status != PENDRES_OK || p->budget.exhausted) return PENDRES_OK;
  }
}

/* Begin searches side by side where they can be: with adaptive steps they would depend on each
   other. */
static pendres_status begin(pendres_context *ctx, party *p, double most_together)
{
  pendres_status status = PENDRES_OK;
  if (p->n < 2 || !pendres_method_of(ctx)->fixed_steps) return status;
  p->budget = pendres_search_budget_of(ctx, most_together);
  for (size_t i = 0; i < p->n && status == PENDRES_OK; i++) {
    struct seeker *k = &p->seeker[i];
    const pendres_resonance_search *of = k->of;
    if (is_at_rest(&of->pendulum) ||
        refuses(&of->pendulum, of->lowest, of->highest, p->ensemble) != NULL)
      continue;
    status = pendres_search_create(&p->budget, &of->pendulum, p->ensemble, &k->search);
    k->state = SEEKER_TOGETHER;
    k->search.lowest = of->lowest;
    k->search.highest = of->highest;
  }
  return status == PENDRES_OK ? go_together(ctx, p) : status;
}

static pendres_status find_some(pendres_context *ctx, party *p, double most_together)
{
  pendres_status status = begin(ctx, p, most_together);
  for (size_t i = 0; i < p->n; i++) pendres_search_free(&p->seeker[i].search);
  for (size_t i = 0; i < p->n && status == PENDRES_OK; i++) {
    pendres_resonance_search *of = p->seeker[i].of;
    if (p->seeker[i].state == SEEKER_ENDED) continue;
    const pendres_status alone = pendres_resonance_find_ensemble(
      ctx, &of->pendulum, of->lowest, of->highest, p->ensemble, &of->resonance);
    status = end(ctx, alone, &p->seeker[i]);
  }
  return status;
}

pendres_status pendres_resonance_find_together(pendres_context *ctx, size_t n,
                                               pendres_resonance_search *searches,
                                               const pendres_ensemble *ensemble,
                                               double most_together)
{
  pendres_status status = PENDRES_OK;
  if (ensemble == NULL || (n > 0 && searches == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "searches and ensemble");
  party *p = malloc(sizeof *p);
  if (p == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu resonances", n);
  for (size_t first = 0; first < n && status == PENDRES_OK; first += SEARCH_TOGETHER) {
    memset(p, 0, sizeof *p);
    p->ensemble = ensemble;
    p->n = n - first < SEARCH_TOGETHER ? n - first : SEARCH_TOGETHER;
    for (size_t i = 0; i < p->n; i++) p->seeker[i].of = &searches[first + i];
    status = find_some(ctx, p, most_together);
  }
  free(p);
  return status;
}

pendres_status pendres_resonance_find_many(pendres_context *ctx, size_t n,
                                           pendres_resonance_search *searches,
                                           const pendres_ensemble *ensemble)
{
  pendres_door d = pendres_door_open_many(ctx, n, searches, sizeof *searches);
  while (pendres_door_next(&d)) {
    const pendres_ensemble *e = pendres_door_in(&d, &pendres_dim_ensemble, 1, ensemble);
    pendres_resonance_search *s = pendres_door_out_run(&d, &pendres_dim_search, searches);
    PENDRES_DOOR_CALL(&d, pendres_resonance_find_together(ctx, d.count, s, e, search_most_work));
  }
  return pendres_door_close(&d);
}

pendres_status pendres_resonance_find(pendres_context *ctx, const pendres_pendulum *p,
                                      double lowest, double highest, pendres_resonance *out)
{
  const pendres_ensemble e = pendres_ensemble_of(p);
  return pendres_resonance_find_ensemble(ctx, p, lowest, highest, &e, out);
}
