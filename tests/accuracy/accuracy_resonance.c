/*
 * accuracy_resonance.c -- resonances against the extended-precision reference.
 *
 * Where all members of the ensemble are on one orbit of period one a smooth peak is the largest
 * loop area on that orbit's branch, which the reference has too; and at an edge that a fold makes,
 * the reference has the fold. That no larger area was overlooked is not seen here.
 */
#include "accuracy.h"

#include <math.h>
#include <stdio.h>

static const double half_pi = 1.57079632679489661923;

enum { HOW = 240 };

typedef struct item {
  pendres_pendulum pendulum;
  double lowest, highest, tolerance;
  pendres_status status;
  pendres_resonance found;
  int peak, fold; /* the reference has it too */
  reference_cycle top, end;
} item;

static void draw(accuracy_random *r, item *t)
{
  t->pendulum = (pendres_pendulum){.damping = accuracy_logarithmic(r, 0.05, 1.0),
                                   .drive_amplitude = accuracy_logarithmic(r, 0.02, 0.5),
                                   .drive_frequency = 1.0};
  t->lowest = accuracy_uniform(r, 0.3, 0.6);
  t->highest = accuracy_uniform(r, 1.0, 1.3);
  t->tolerance = accuracy_tolerance(r);
}

/* All members on one orbit that closes after a period. */
static int is_alone(const pendres_response *r)
{
  return r->states == 1 && r->unresolved == 0 && r->state[0].orbit.period == 1 &&
         r->state[0].orbit.winding == 0;
}

static void compute(accuracy_random *r, void *of, long number)
{
  item *t = of;
  pendres_context *ctx = NULL;
  (void)number;
  draw(r, t);
  const pendres_options options = {.tolerance = t->tolerance};
  t->status = pendres_context_create(&options, &ctx);
  if (t->status == PENDRES_OK)
    t->status = pendres_resonance_find(ctx, &t->pendulum, t->lowest, t->highest, &t->found);
  pendres_context_free(ctx);
  if (t->status != PENDRES_OK) return;
  const pendres_resonance *f = &t->found;
  const pendres_orbit *o = &f->response.state[0].orbit;
  if (f->peak == PENDRES_PEAK_SMOOTH && is_alone(&f->response))
    t->peak = reference_find(REFERENCE_RESONANCE, &t->pendulum,
                                     &(reference_guess){f->frequency, o->x - half_pi, o->v,
                                                                0.0L},
                                     &t->top) == PENDRES_OK;
  if (f->peak == PENDRES_PEAK_EDGE && isfinite(f->fold_frequency))
    for (size_t k = 0; k < f->response.states && !t->fold; k++) {
      const pendres_orbit *s = &f->response.state[k].orbit;
      t->fold = s->period == 1 && s->winding == 0 &&
                reference_find(REFERENCE_FOLD, &t->pendulum,
                                       &(reference_guess){f->fold_frequency, s->x - half_pi,
                                                                  s->v, 0.0L},
                                       &t->end) == PENDRES_OK &&
                fabsl(t->end.drive_frequency - (long double)f->fold_frequency) < 1e-3L;
    }
}

static void note(accuracy *a, const void *of, long number, void *tally)
{
  const item *t = of;
  const pendres_resonance *f = &t->found;
  char how[HOW];
  (void)tally;
  snprintf(how, sizeof how, "item %ld: F0 %.17g, damping %.17g, range %.17g to %.17g, tolerance "
           "%.17g", number, t->pendulum.drive_amplitude, t->pendulum.damping, t->lowest, t->highest,
           t->tolerance);
  if (t->peak) {
    accuracy_note(a, "frequency of a peak", f->frequency, f->frequency_error,
                  t->top.drive_frequency, how);
    accuracy_note(a, "largest loop area", f->loop_area, f->loop_area_error, t->top.loop_area, how);
    accuracy_note(a, "phase lag at a peak", f->response.phase_lag, f->response.phase_lag_error,
                  t->top.phase_lag, how);
    accuracy_note(a, "amplitude at a peak", f->response.mean_amplitude,
                  f->response.mean_amplitude_error, t->top.amplitude, how);
    accuracy_note(a, "loop amplitude at a peak", f->response.mean_loop_amplitude,
                  f->response.mean_loop_amplitude_error, t->top.amplitude, how);
  }
  if (t->fold)
    accuracy_note(a, "fold at an edge", f->fold_frequency, f->fold_frequency_error,
                  t->end.drive_frequency, how);
}

void accuracy_resonance(accuracy *a)
{
  accuracy_each(a, &(accuracy_work){.items = accuracy_get_options(a)->points, .at_once = 64,
                                    .size = sizeof(item), .compute = compute, .note = note});
}
