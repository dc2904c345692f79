/*
 * accuracy_ensembles.c -- means over ensembles where states coexist and basins are fractal: each
 * member's state is found once more by the extended-precision reference, and the mean over what
 * the members are truly on is compared with the mean that was claimed.
 */
#include "accuracy.h"

#include <math.h>
#include <stdio.h>

#include "states_fixture.h"

static const double two_pi = 6.28318530717958647693;
static const double half_pi = 1.57079632679489661923;

/* A stretch is no multiple of an orbit's period: so it meets all its strobe points in turn. */
enum { MEMBERS = 20, HOW = 240, STRETCHES = 40, STRETCH = 11 };

typedef struct item {
  pendres_pendulum pendulum;
  pendres_ensemble ensemble;
  double tolerance;
  int known; /* every member's true state is one of the response's */
  pendres_response found;
  long double area;
  double sa, la;
} item;

static void draw(accuracy_random *r, item *t)
{
  t->pendulum = (pendres_pendulum){.damping = accuracy_uniform(r, 0.05, 0.13),
                                   .drive_amplitude = accuracy_uniform(r, 0.2, 0.4),
                                   .drive_frequency = accuracy_uniform(r, 0.62, 0.85)};
  t->ensemble = pendres_ensemble_default();
  t->ensemble.members = MEMBERS;
  /* Another line of starts for every item. */
  t->ensemble.v = accuracy_uniform(r, -1.0, 1.0);
  t->tolerance = accuracy_tolerance(r);
}

/* The state whose strobe point is next to (y, v); -1: none is near. */
static int state_at(const pendres_response *r, double y, double v)
{
  for (size_t s = 0; s < r->states; s++) {
    const pendres_orbit *o = &r->state[s].orbit;
    if (hypot(remainder(y - (o->x - half_pi), two_pi), v - o->v) < 1e-3) return (int)s;
  }
  return -1;
}

/* Where a start truly goes. */
static int true_state(const item *t, double x)
{
  long double y = (long double)x - 1.57079632679489661923132169163975144L, v = t->ensemble.v;
  for (int k = 0; k < STRETCHES; k++) {
    if (reference_advance(&t->pendulum, &y, &v, NULL, STRETCH) != PENDRES_OK) return -1;
    const int s = state_at(&t->found, (double)y, (double)v);
    if (s >= 0) return s;
  }
  return -1;
}

static void compute(accuracy_random *r, void *of, long number)
{
  item *t = of;
  pendres_context *ctx = NULL;
  (void)number;
  draw(r, t);
  const pendres_options options = {.tolerance = t->tolerance};
  pendres_status status = pendres_context_create(&options, &ctx);
  if (status == PENDRES_OK)
    status = pendres_response_find(ctx, 1, &t->pendulum, &t->ensemble, &t->found);
  pendres_context_free(ctx);
  t->known = status == PENDRES_OK && t->found.states > 0;
  for (size_t k = 1; k <= MEMBERS && t->known; k++) {
    const int s = true_state(t, member_x(&t->ensemble, k));
    if (s < 0) {
      t->known = 0;
      break;
    }
    t->area += (long double)t->found.state[s].orbit.loop_area / MEMBERS;
    t->sa += (t->found.state[s].label == PENDRES_LABEL_SA) / (double)MEMBERS;
    t->la += (t->found.state[s].label == PENDRES_LABEL_LA) / (double)MEMBERS;
  }
}

/* Items beside the reference, and what they are. */
typedef struct tally {
  long known, mixed, uncertain;
} tally;

static void note(accuracy *a, const void *of, long number, void *counts)
{
  const item *t = of;
  tally *c = counts;
  const pendres_response *r = &t->found;
  char how[HOW];
  if (!t->known) return;
  c->known++;
  c->mixed += r->states > 1;
  c->uncertain += r->uncertain > 0;
  snprintf(how, sizeof how,
           "item %ld: F0 %.17g, damping %.17g, frequency %.17g, v %.17g, %d members, "
           "tolerance %.17g", number, t->pendulum.drive_amplitude, t->pendulum.damping,
           t->pendulum.drive_frequency, t->ensemble.v, MEMBERS, t->tolerance);
  /* Members on their true states leave the areas' errors, which other sections look at: what
     counts here is a member too many or too few, at least a twentieth of the areas' distance. */
  double least = INFINITY, most = -INFINITY;
  for (size_t s = 0; s < r->states; s++) {
    least = fmin(least, r->state[s].orbit.loop_area);
    most = fmax(most, r->state[s].orbit.loop_area);
  }
  const double error = fabs(r->mean_loop_area - (double)t->area);
  if (error > r->mean_loop_area_error + 1e-3 * (most - least))
    accuracy_complain(a, "a mean over members that are not where they are said to be", how);
  if (!isnan(r->sa_fraction) && (fabs(r->sa_fraction - t->sa) > r->sa_fraction_error + 1e-9 ||
                                 fabs(r->la_fraction - t->la) > r->la_fraction_error + 1e-9))
    accuracy_complain(a, "shares of members that are not where they are said to be", how);
}

void accuracy_ensembles(accuracy *a)
{
  tally c = {0};
  const long all =
    accuracy_each(a, &(accuracy_work){.items = 2 * accuracy_get_options(a)->points, .at_once = 64,
                                      .size = sizeof(item), .compute = compute, .note = note,
                                      .tally = &c});
  printf("\nensembles: %ld of %ld beside the reference, %ld of them on several states, %ld with "
         "uncertain members\n", c.known, all, c.mixed, c.uncertain);
}
