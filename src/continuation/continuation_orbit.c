/* continuation_orbit.c -- measures of orbits found by continuation; see continuation_orbit.h. */
#include "continuation/continuation_orbit.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/passage.h"
#include "orbits/orbit_error.h"
#include "orbits/orbit_newton.h"

/* Of an entry of M, at random in every step: see strobe_noise.c. */
static const double matrix_rounding = 7e-16;

/* What one computation of an orbit found. */
typedef struct reading {
  double u[PENDRES_U_COUNT];
  double m[2][2], m_by[2][2][2];
  pendres_orbit_measures measures;
} reading;

double pendres_continuation_orbit_error(double coarse, double fine, double rounding)
{
  /* An order-8 method's error falls to a fifteenth with 1.4 times the steps; a quarter of the
     difference is claimed, for where the order has not set in yet. */
  return 0.25 * fabs(fine - coarse) + rounding;
}

void pendres_continuation_orbit_set_critical(pendres_special kind, int parameters,
                                             const pendres_parameter *parameter,
                                             const double *error, pendres_orbit *o)
{
  const double damping = o->pendulum.damping, omega = o->pendulum.drive_frequency;
  const double time = two_pi * o->period / omega, product = exp(-damping * time);
  const double critical = kind == PENDRES_PERIOD_DOUBLING ? -1.0 : 1.0;
  double off = DBL_EPSILON * (1.0 + damping * time); /* of the product, relative */
  for (int k = 0; k < parameters; k++) {
    if (parameter[k] == PENDRES_DAMPING) off += time * error[k];
    if (parameter[k] == PENDRES_DRIVE_FREQUENCY) off += damping * time * error[k] / omega;
  }
  o->multiplier_re[0] = critical;
  o->multiplier_re[1] = critical * product;
  o->multiplier_im[0] = o->multiplier_im[1] = 0.0;
  o->multiplier_error = product * off;
  o->stable = 0;
}

static int winding_of(const pendres_continuation_map *map)
{
  return map->mirror ? 0 : map->winding;
}

/* Read one candidate off the tape. */
static pendres_status read_candidate(const pendres_newton_candidate *c,
                                     const pendres_newton_tape *tape, pendres_orbit_tables *tables,
                                     double *work, reading *out)
{
  const size_t n = tape->samples;
  double *y = work, *w = work + n;
  memcpy(out->m, c->m, sizeof out->m);
  memcpy(out->m_by, c->m_by, sizeof out->m_by);
  for (size_t k = 0; k < n; k++) {
    const double *row = pendres_newton_sample(tape, k, c->lane);
    y[k] = row[0];
    w[k] = row[1];
  }
  const pendres_orbit_samples samples = {
    .n = n, .period = c->guess->period, .winding = c->guess->winding, .y = y, .w = w,
    .tables = tables};
  return pendres_orbit_measure(&c->guess->pendulum, &samples, work + 2 * n, &out->measures);
}

/* Equal steps and periods side by side, so that they share blocks. */
static int in_order(const void *a, const void *b)
{
  const pendres_newton_candidate *p = a, *q = b;
  if (p->steps != q->steps) return p->steps < q->steps ? -1 : 1;
  if (p->guess->period != q->guess->period) return p->guess->period < q->guess->period ? -1 : 1;
  return p->index < q->index ? -1 : p->index > q->index;
}

/* Integrate all pairs at their coarse or their fine steps. */
static pendres_status read_all(pendres_context *ctx, size_t n,
                               const pendres_continuation_pair *pairs, int fine, reading *out)
{
  pendres_newton_tape tape = {.bends = !fine};
  pendres_orbit_tables tables = {0};
  double *work = NULL;
  size_t work_size = 0;
  pendres_status status = PENDRES_OK;
  pendres_newton_candidate *c = calloc(n + 1, sizeof *c);
  pendres_orbit_guess *guess = calloc(n + 1, sizeof *guess);
  if (c == NULL || guess == NULL) goto no_memory;
  for (size_t i = 0; i < n; i++) {
    const pendres_continuation_pair *p = &pairs[i];
    const double *u = fine ? p->fine : p->coarse;
    memcpy(out[i].u, u, sizeof out[i].u);
    guess[i] = (pendres_orbit_guess){.pendulum = pendres_continuation_map_pendulum(p->map.force, u),
                                     .period = p->map.period,
                                     .winding = winding_of(&p->map)};
    c[i] = (pendres_newton_candidate){.guess = &guess[i],
                                      .index = i,
                                      .y = u[PENDRES_U_Y],
                                      .w = u[PENDRES_U_W],
                                      .steps = fine ? p->fine_steps : p->coarse_steps};
  }
  qsort(c, n, sizeof *c, in_order);
  for (size_t first = 0, last; first < n; first = last) {
    status = pendres_newton_pass(ctx, n, c, first, PENDRES_ORBIT_PLAIN, &tape, &last);
    if (status != PENDRES_OK) goto done;
    const size_t need = 2 * tape.samples + pendres_orbit_measure_work(tape.samples);
    if (need > work_size) {
      work_size = need;
      double *grown = realloc(work, work_size * sizeof *work);
      if (grown == NULL) goto no_memory;
      work = grown;
    }
    for (size_t i = first; i < last && status == PENDRES_OK; i++)
      status = read_candidate(&c[i], &tape, &tables, work, &out[c[i].index]);
    if (status != PENDRES_OK) {
      status = pendres_context_fail(ctx, status, "the samples of an orbit could not be measured");
      goto done;
    }
  }
  goto done;
no_memory:
  status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu orbits", n);
done:
  pendres_newton_tape_free(&tape);
  pendres_orbit_tables_free(&tables);
  free(work);
  free(c);
  free(guess);
  return status;
}

static void fill(const pendres_continuation_pair *pair, const reading *a, const reading *b,
                 pendres_orbit *o)
{
  const pendres_pendulum p = pendres_continuation_map_pendulum(pair->map.force, pair->fine);
  const double omega = p.drive_frequency;
  const double from[2] = {pair->fine[PENDRES_U_Y] - pair->coarse[PENDRES_U_Y],
                          pair->fine[PENDRES_U_W] - pair->coarse[PENDRES_U_W]};
  const double along =
    pendres_orbit_measures_apart(&a->measures, &b->measures, pair->map.period);
  /* The equations of a bifurcation do not multiply errors by the inverse of I - M, which is
     singular there, but by their own: a difference that is less than a third of what its parts make
     together is taken for chance. */
  const double beside =
    pair->critical
      ? pair->apart / 3.0
      : pendres_orbit_apart_beside(a->m, b->m, a->m_by, from, b->measures.amplitude);
  const pendres_orbit_doubt doubt = {.apart = fmax(fmax(hypot(from[0], from[1]), along), beside),
                                     .rounding = pair->rounding};

  memset(o, 0, sizeof *o);
  o->pendulum = p;
  o->period = pair->map.period;
  o->winding = winding_of(&pair->map);
  o->steps = pair->fine_steps;
  const long turns = pendres_orbit_set_measures(&a->measures, &b->measures, &doubt, o);
  const pendres_place s = {
    .y = pair->fine[PENDRES_U_Y], .w = pair->fine[PENDRES_U_W], .turns = -turns};
  pendres_passage_out(&o->pendulum, &s, &o->x, &o->v);
  o->x_error =
    pendres_orbit_error(pair->coarse[PENDRES_U_Y], pair->fine[PENDRES_U_Y], 1.0, &doubt) +
    0.5 * DBL_EPSILON * (fabs(o->x) + half_pi);
  o->v_error =
    pendres_orbit_error(pair->coarse[PENDRES_U_OMEGA] * pair->coarse[PENDRES_U_W], o->v, omega,
                        &doubt) +
    fmax(0.0, 1.0 - omega) * doubt.rounding;
  pendres_orbit_spectrum spectrum = {.left = matrix_rounding * sqrt(o->steps * o->period)};
  memcpy(spectrum.by_point, a->m_by, sizeof spectrum.by_point);
  memcpy(spectrum.coarse, a->m, sizeof spectrum.coarse);
  memcpy(spectrum.fine, b->m, sizeof spectrum.fine);
  pendres_orbit_set_spectrum(&spectrum, &doubt, o);
  o->frequency_derivative[0] = o->frequency_derivative[1] = NAN;
  o->loop_area_slope = o->loop_area_slope_error = NAN;
}

pendres_status pendres_continuation_orbit_measure(pendres_context *ctx, size_t n,
                                                  const pendres_continuation_pair *pairs,
                                                  pendres_orbit *out)
{
  reading *coarse = malloc((n + 1) * sizeof *coarse), *fine = malloc((n + 1) * sizeof *fine);
  pendres_status status = PENDRES_OK;
  if (coarse == NULL || fine == NULL)
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu orbits", n);
  if (status == PENDRES_OK) status = read_all(ctx, n, pairs, 0, coarse);
  if (status == PENDRES_OK) status = read_all(ctx, n, pairs, 1, fine);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++)
    fill(&pairs[i], &coarse[i], &fine[i], &out[i]);
  free(coarse);
  free(fine);
  return status;
}
