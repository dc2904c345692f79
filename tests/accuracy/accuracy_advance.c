/*
 * accuracy_advance.c -- pendulums advanced from random starts, and trajectories recorded, against
 * the extended-precision reference.
 *
 * Where errors have grown until nothing is known the claim is infinite: those are counted as
 * marked. x and v have one claim, the larger of both errors.
 */
#include "accuracy.h"

#include <math.h>
#include <stdio.h>

static const long double two_pi = 6.28318530717958647692528676655900577L;
static const long double half_pi = 1.57079632679489661923132169163975144L;

enum { HOW = 300, SAMPLES = 4 };

typedef struct item {
  pendres_pendulum pendulum;
  pendres_method method;
  double x, v, tolerance;
  long periods;
  int there;
  double error, claim;                 /* of a pendulum that is advanced */
  double recorded_error, recorded_claim; /* of the end of its trajectory */
} item;

static void draw(accuracy_random *r, item *t)
{
  static const pendres_method methods[] = {PENDRES_BLOCK_ADAPTIVE, PENDRES_SINGLE,
                                           PENDRES_CVODE_ADAMS, PENDRES_CVODE_BDF};
  t->pendulum = accuracy_pendulum(r);
  t->x = accuracy_uniform(r, -3.0, 3.0);
  t->v = accuracy_uniform(r, -2.0, 2.0);
  t->tolerance = accuracy_tolerance(r);
  t->periods = (long)accuracy_logarithmic(r, 1.0, 41.0);
  /* The default method is what nearly all results come from. */
  const int which = accuracy_choice(r, 20);
  t->method = which < 4 ? methods[which] : PENDRES_BLOCK_FIXED;
}

/* How far a state is from where the start truly goes. */
static double off_by(const item *t, double x, double v, int *there)
{
  long double y = t->x - half_pi, w = t->v;
  long turns = 0;
  *there = reference_advance(&t->pendulum, &y, &w, &turns, t->periods) == PENDRES_OK;
  const long double angle = y + half_pi + two_pi * (long double)turns;
  return (double)fmaxl(fabsl((long double)x - angle), fabsl((long double)v - w));
}

static void compute(accuracy_random *r, void *of, long number)
{
  enum { MOST = 41 * SAMPLES + 1 };
  item *t = of;
  pendres_context *ctx = NULL;
  (void)number;
  draw(r, t);
  const pendres_options options = {.tolerance = t->tolerance, .method = t->method,
                                   .block_lanes = 8};
  double x = t->x, v = t->v, xs[MOST], vs[MOST], x_error[MOST], v_error[MOST];
  const size_t last = (size_t)t->periods * SAMPLES;
  pendres_status status = pendres_context_create(&options, &ctx);
  if (status == PENDRES_OK)
    status = pendres_strobe_advance(ctx, 1, &t->pendulum, &x, &v, t->periods, &t->claim);
  if (status == PENDRES_OK)
    status = pendres_strobe_record(ctx, &t->pendulum, &(pendres_state){t->x, t->v}, t->periods,
                                   SAMPLES, &(pendres_record){xs, vs, x_error, v_error});
  pendres_context_free(ctx);
  if (status != PENDRES_OK) return;
  t->error = off_by(t, x, v, &t->there);
  t->recorded_error = off_by(t, xs[last], vs[last], &t->there);
  t->recorded_claim = fmax(x_error[last], v_error[last]);
}

static void note(accuracy *a, const void *of, long number, void *tally)
{
  const item *t = of;
  const pendres_pendulum *p = &t->pendulum;
  char how[HOW], kind[64];
  (void)tally;
  if (!t->there) return;
  snprintf(how, sizeof how,
           "item %ld: F0 %.17g, damping %.17g, frequency %.17g, x %.17g, v %.17g, %ld periods, "
           "tolerance %.17g", number, p->drive_amplitude, p->damping, p->drive_frequency, t->x,
           t->v, t->periods, t->tolerance);
  snprintf(kind, sizeof kind, "%s", pendres_name_get(PENDRES_NAMES_METHOD, t->method));
  accuracy_note_error(a, kind, t->error, t->claim, how);
  accuracy_note_error(a, "end of a record", t->recorded_error, t->recorded_claim, how);
}

void accuracy_advance(accuracy *a)
{
  accuracy_each(a, &(accuracy_work){.items = accuracy_get_options(a)->orbits, .at_once = 256,
                                    .size = sizeof(item), .compute = compute, .note = note});
}
