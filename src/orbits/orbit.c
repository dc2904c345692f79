/* orbit.c -- periodic orbits by Newton's method on the stroboscopic map; see orbit.h. */
#include <pendres/orbit.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/door.h"
#include "engine/kernels/coordinates.h"
#include "model/model.h"
#include "orbits/orbit_error.h"
#include "orbits/orbit_pair.h"
#include "orbits/orbit_reading.h"
#include "engine/steps.h"
#include "orbits/numbers.h"

/* Derivatives by the frequency, in one computation of an orbit. */
typedef struct slopes {
  double dy, dw; /* of y and w */
  double slope;  /* dA/domega */
  double apart;  /* how far it is from the same integral by parts */
  double derivative; /* root mean square of dw/domega along the orbit, for its rounding */
  double rounded[2]; /* what rounding makes of angles along the finer one, and of the slope */
} slopes;

/* What is computed with n and with 1.4 n steps, for each guess. */
typedef struct two_runs {
  pendres_orbit_want want;
  int points; /* and multipliers alone */
  pendres_orbit_computed *coarse, *fine;
  slopes *coarse_slopes, *fine_slopes; /* where these are wanted */
} two_runs;

/* Take the loop area's slope, and the same from an integral by parts. Returns 0 at a fold, where
   there is none. */
static int take_slope(const pendres_newton_candidate *c, const pendres_newton_samples *taken,
                      slopes *out)
{
  const size_t n = taken->count;
  double sum = 0.0, parts = 0.0, squares = 0.0, cancelled = 0.0, by_omega[2];
  if (!pendres_newton_solve(c->m, c->by_omega, by_omega, NULL)) return 0;
  for (size_t k = 0; k < n; k++) {
    const double *row = pendres_newton_sample(taken, k, c->lane);
    const double theta = two_pi * c->guess->period * (double)k / (double)n;
    const double derivative = row[7] + row[3] * by_omega[0] + row[5] * by_omega[1];
    sum += cos(theta) * derivative;
    parts += sin(theta) * (row[6] + row[2] * by_omega[0] + row[4] * by_omega[1]);
    squares += derivative * derivative;
    const double start = hypot(row[3] * by_omega[0], row[5] * by_omega[1]);
    cancelled += row[7] * row[7] + start * start;
  }
  const double cycle = c->guess->pendulum.drive_amplitude * two_pi;
  out->dy = by_omega[0];
  out->dw = by_omega[1];
  out->derivative = sqrt(fmax(squares, orbit_cancels * orbit_cancels * cancelled) / (double)n);
  out->slope = cycle * sum / (double)n;
  /* Harmonics next to the number of samples are taken for the first one. They add to the integral
     of the slopes by their number, to that of the angles only once: the difference tells. */
  out->apart = cycle * (sum - parts) / (double)n;
  return 1;
}

/* The samples of one candidate, moved to the corrected point by the linearised flow. */
static int take(void *arg, const pendres_newton_candidate *c,
                const pendres_newton_samples *taken, double *y, double *w,
                pendres_orbit_computed *out)
{
  const two_runs *r = arg;
  slopes *own = taken->bends ? r->coarse_slopes : r->fine_slopes;
  if (!pendres_newton_closed(c, taken, y, w, out->off)) return 0;
  out->y = c->y + out->off[0];
  out->w = c->w + out->off[1];
  /* Without samples an orbit is taken to be as large as it is at phase 0. */
  if (r->points) out->measures.amplitude = hypot(out->y, out->w);
  return r->want != PENDRES_ORBIT_FREQUENCY_SLOPE || take_slope(c, taken, &own[c->index]);
}

/* The slopes of an orbit whose finer computation is `at`. */
static void set_slope(const slopes *coarse, slopes *fine, const pendres_orbit_computed *at,
                      const pendres_orbit_twice *two, pendres_orbit *o)
{
  const double omega = o->pendulum.drive_frequency, drive = fabs(o->pendulum.drive_amplitude);
  const pendres_orbit_uncertainty *uncertainty = &two->along;
  double unit[2] = {1.0, 1.0}, z[2], stretch = 1.0;

  (void)pendres_newton_solve(at->m, unit, z, &stretch);
  o->frequency_derivative[0] = fine->dy;
  o->frequency_derivative[1] = at->w + omega * fine->dw;
  o->loop_area_slope = fine->slope;
  /* The slope depends on the derivative of the point as the other measures do on the point. */
  const double derivative = hypot(fine->dy - coarse->dy, fine->dw - coarse->dw);
  const pendres_orbit_uncertainty slope_uncertainty = {
    .apart = orbit_left_over * (derivative + uncertainty->apart),
    .rounding = 2.0 * uncertainty->rounding * (stretch / pi + hypot(fine->dy, fine->dw)) +
                12.0 * two->rounding * fine->derivative};
  o->loop_area_slope_error =
    pendres_orbit_error(coarse->slope, fine->slope, pi * drive, &slope_uncertainty) +
    orbit_left_over * fabs(fine->apart);
  fine->rounded[0] = uncertainty->rounding;
  fine->rounded[1] = pi * drive * slope_uncertainty.rounding;
}

/* Whether an orbit moves by no more than rounding: what steps leave of it, all together. */
static int rests(const pendres_newton_candidate *c, const pendres_orbit_computed *fine,
                 double last_place)
{
  return c->guess->winding == 0 &&
         !(fine->measures.amplitude > orbit_worst_rounding * last_place * fine->noise.along);
}

/*
 * How much more the steps of an orbit leave than those of one that swings. At rest each rounds a
 * number of the full size, twice what it is in the mean of a swing, and the same pattern of
 * rounding comes in every period, be it the worst. Or all steps round alike: with A the rate of the
 * linear motion, a step of length h then leaves (1 - exp(A h))^-1 of what it rounds, some
 * 1/(h |A|), in place of the root of their number. A linear force has all of a pattern's
 * response at one frequency: half of the worst is seen where that is the drive's. noise: the root
 * of the number of steps.
 */
static double excess_of_rounding(const pendres_newton_candidate *c,
                                 const pendres_orbit_computed *fine, double last_place,
                                 double noise)
{
  const pendres_pendulum *p = &c->guess->pendulum;
  double force, slope;
  if (!rests(c, fine, last_place))
    return pendres_model_is_linear(p) ? 0.5 * orbit_worst_rounding : 1.0;
  pendres_model_force(p, fine->y, &force, &slope);
  const double steps = c->steps * p->drive_frequency / (two_pi * sqrt(fabs(slope)));
  return fmax(fmin(steps / noise, noise), orbit_worst_rounding);
}

/* rounding: what one step leaves of an angle of order one. */
static void fill(const pendres_newton_candidate *c, const two_runs *runs, double rounding,
                 pendres_orbit *o)
{
  const size_t k = c->index;
  const pendres_orbit_computed *coarse = &runs->coarse[k], *fine = &runs->fine[k];
  const double noise = sqrt(c->steps * (double)c->guess->period); /* steps round at random */
  const double size = fmax(fine->measures.amplitude, fmax(fabs(fine->y), fabs(fine->w)));
  double last_place = fmax(rounding * size, DBL_TRUE_MIN);
  const int still = rests(c, fine, last_place);
  last_place *= excess_of_rounding(c, fine, last_place, noise);
  const double there = hypot(fine->y - coarse->y, fine->w - coarse->w);
  const double along = pendres_orbit_measures_apart(&coarse->measures, &fine->measures,
                                                    c->guess->period);
  const double from[2] = {fine->y - fine->off[0] - coarse->y + coarse->off[0],
                          fine->w - fine->off[1] - coarse->w + coarse->off[1]};
  const double apart = fmax(fmax(there, along), pendres_orbit_apart_beside(coarse, fine, from));
  const pendres_orbit_twice two = {.pendulum = c->guess->pendulum,
                                   .period = c->guess->period,
                                   .winding = c->guess->winding,
                                   .steps = c->steps,
                                   .coarse = coarse,
                                   .fine = fine,
                                   .at_start = {apart, last_place * fine->noise.start},
                                   .along = {apart, last_place * fine->noise.along},
                                   .rounding = rounding * noise,
                                   .rests = still};
  pendres_orbit_set(&two, o);
  if (runs->want == PENDRES_ORBIT_FREQUENCY_SLOPE)
    set_slope(&runs->coarse_slopes[k], &runs->fine_slopes[k], fine, &two, o);
}

static int accurate(const pendres_orbit *o, double tolerance)
{
  /* An error of the phase counts by what it moves the first harmonic. */
  return o->x_error <= tolerance && o->v_error <= tolerance && o->loop_area_error <= tolerance &&
         o->amplitude_error <= tolerance &&
         !(o->phase_lag_error * fmin(1.0, o->first_harmonic_amplitude) > tolerance);
}

/* Measure all converged candidates with their present steps. */
static pendres_status measure_all(pendres_context *ctx, size_t n, pendres_newton_candidate *c,
                                  const two_runs *runs, int bends)
{
  const pendres_orbit_reader reader = {
    .want = runs->want, .bends = bends, .points = runs->points, .take = take,
    .arg = (void *)runs, .out = bends ? runs->coarse : runs->fine};
  return pendres_orbit_read(ctx, &reader, n, c);
}

static double singularity(const double m[2][2])
{
  return (1.0 - m[0][0]) * (1.0 - m[1][1]) - m[0][1] * m[1][0];
}

/*
 * Whether there is an orbit where Newton's method has come to rest, told by det (I - M) before and
 * after one more step. Beyond a fold the method wanders about the ghost of the orbit that is gone:
 * the map moves a point z by something like z^2 + s^2 there, and a step takes det (I - M), which is
 * like 2 z, to less than half, or past zero. Near an orbit the map moves z by z^2 - s^2, and a step
 * leaves the determinant as it is. It must also be nearly the same with n steps and with 1.4 n, or
 * the two maps have their folds at places too different to tell.
 */
static int is_there(double before, double after)
{
  const double ratio = after / before;
  return ratio > 1.0 / newton_there && ratio < newton_there;
}

/*
 * Take one Newton step with the finer map. The linearised flow moves samples to the finer map's
 * point well enough, but not their derivatives: slopes taken at the coarser map's point would be no
 * better than those of the coarser map, and the two would agree on a wrong value.
 */
static pendres_status move_to_finer_point(pendres_context *ctx, size_t n,
                                          pendres_newton_candidate *c,
                                          const pendres_orbit_computed *coarse)
{
  for (size_t first = 0, count; first < n; first += count) {
    const pendres_status status =
      pendres_newton_pass(ctx, n - first, c + first, PENDRES_ORBIT_PLAIN, NULL, &count);
    if (status != PENDRES_OK) return status;
    for (size_t i = first; i < first + count; i++) {
      const pendres_newton_candidate *at = &c[i];
      const pendres_orbit_computed *before = &coarse[at->index];
      double shift[2];
      if (at->state == PENDRES_NEWTON_CONVERGED &&
          is_there(singularity(before->m), singularity(at->m)) &&
          pendres_newton_solve(at->m, at->residual, shift, NULL)) {
        c[i].y += shift[0];
        c[i].w += shift[1];
      }
    }
  }
  return PENDRES_OK;
}

/* Where results go, as many of each as there are guesses; coarser may be NULL. */
typedef struct outputs {
  pendres_orbit *orbit;
  pendres_status *outcome;
  pendres_orbit_coarser *coarser;
  int once; /* an orbit that several guesses of a pendulum lead to goes to the first of them */
} outputs;

static int by_index(const void *a, const void *b)
{
  const pendres_newton_candidate *p = a, *q = b;
  return p->index < q->index ? -1 : p->index > q->index;
}

/* Whether two candidates have converged to one orbit; not where errors might make two of it. */
static int repeats(const pendres_newton_candidate *p, const pendres_newton_candidate *q)
{
  const pendres_orbit_guess *a = p->guess, *b = q->guess;
  if (p->state != PENDRES_NEWTON_CONVERGED || q->state != PENDRES_NEWTON_CONVERGED) return 0;
  if (a->period != b->period || a->winding != b->winding) return 0;
  const double dy = pendres_less_turns(p->y - q->y, pendres_model_turn(&a->pendulum));
  return hypot(dy, a->pendulum.drive_frequency * (p->w - q->w)) < orbit_repeated;
}

/* Put the candidates that repeat an earlier one of their pendulum, all of which lie one after
   another, behind the others, as failed; returns how many are left. */
static size_t drop_repetitions(size_t n, pendres_newton_candidate *c, pendres_status *outcome)
{
  size_t kept = 0;
  qsort(c, n, sizeof *c, by_index);
  for (size_t i = 0; i < n; i++) {
    const pendres_pendulum *p = &c[i].guess->pendulum;
    for (size_t j = i; j-- > 0 && pendres_model_same(p, &c[j].guess->pendulum);)
      if (repeats(&c[i], &c[j])) {
        c[i].state = PENDRES_NEWTON_FAILED;
        break;
      }
  }
  for (size_t i = 0; i < n; i++) {
    const pendres_newton_candidate at = c[i];
    outcome[at.index] = PENDRES_NOT_CONVERGED; /* until it is measured */
    if (at.state == PENDRES_NEWTON_FAILED) continue;
    c[i] = c[kept];
    c[kept++] = at;
  }
  return kept;
}

/*
 * Converge, and measure with n and with 1.4 n steps; candidates are sorted in place. A ghost, or
 * what is too close to one to tell, has the outcome PENDRES_NOT_CONVERGED, but a state that is
 * converged.
 */
static pendres_status refine_once(pendres_context *ctx, size_t n, pendres_newton_candidate *c,
                                  const two_runs *runs, const outputs *to)
{
  const double rounding = pendres_newton_rounding(ctx->options.table);
  const pendres_orbit_want want = runs->want;
  const pendres_orbit_computed *coarse = runs->coarse, *fine = runs->fine;
  pendres_status *outcome = to->outcome;
  pendres_status status = pendres_newton_converge(ctx, n, c);
  if (to->once && status == PENDRES_OK) n = drop_repetitions(n, c, outcome);
  if (status == PENDRES_OK) status = measure_all(ctx, n, c, runs, 1);
  if (status != PENDRES_OK) return status;
  for (size_t i = 0; i < n; i++) {
    if (c[i].state != PENDRES_NEWTON_CONVERGED) continue;
    c[i].y = coarse[c[i].index].y;
    c[i].w = coarse[c[i].index].w;
    c[i].steps = pendres_steps_finer(&c[i].guess->pendulum, c[i].steps);
  }
  if (want == PENDRES_ORBIT_FREQUENCY_SLOPE) status = move_to_finer_point(ctx, n, c, coarse);
  if (status == PENDRES_OK) status = measure_all(ctx, n, c, runs, 0);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    const size_t k = c[i].index;
    if (c[i].state != PENDRES_NEWTON_CONVERGED ||
        !is_there(singularity(coarse[k].m), singularity(fine[k].m))) {
      outcome[k] = PENDRES_NOT_CONVERGED;
      continue;
    }
    fill(&c[i], runs, rounding, &to->orbit[k]);
    outcome[k] =
      accurate(&to->orbit[k], ctx->options.tolerance) ? PENDRES_OK : PENDRES_TOLERANCE_UNREACHABLE;
  }
  return status;
}

static pendres_status start(pendres_context *ctx, size_t n, const pendres_orbit_guess *guess,
                            pendres_newton_candidate *c)
{
  for (size_t i = 0; i < n; i++) {
    const pendres_orbit_guess *g = &guess[i];
    const pendres_orbit wanted = {.pendulum = g->pendulum, .x = g->x, .v = g->v,
                                  .period = g->period, .winding = g->winding};
    const char *why = pendres_orbit_refuses(&wanted);
    if (why == NULL && g->winding != 0 && pendres_model_of(g->pendulum.force)->period == 0.0)
      why = "a coordinate without a period has no winding orbits";
    if (why != NULL)
      return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "guess %zu: %s", i, why);
    const double speed = pendres_steps_speed(&g->pendulum, g->x, g->v);
    const pendres_coordinates s = pendres_coordinates_in(&g->pendulum, g->x, g->v);
    c[i] = (pendres_newton_candidate){.guess = g, .index = i, .y = s.y, .w = s.w};
    /* The pendulums that steps are chosen by are harder than an orbit. This is where to start: the
       orbit's own two runs tell whether it was enough. */
    const pendres_status status = pendres_steps_choose(ctx, &g->pendulum, speed,
                                                       pendres_accuracy_first(ctx), &c[i].steps);
    if (status != PENDRES_OK) return status;
  }
  return PENDRES_OK;
}

static void set_coarser(size_t n, const two_runs *runs, const outputs *to)
{
  for (size_t i = 0; i < n && to->coarser != NULL; i++)
    to->coarser[i] = to->outcome[i] == PENDRES_NOT_CONVERGED
                       ? (pendres_orbit_coarser){NAN, NAN, NAN, NAN, NAN}
                       : (pendres_orbit_coarser){.cosine = runs->coarse[i].measures.cosine[0],
                                                 .sine = runs->coarse[i].measures.sine[0],
                                                 .loop_area_slope = runs->coarse_slopes[i].slope,
                                                 .rounding = runs->fine_slopes[i].rounded[0],
                                                 .slope_rounding = runs->fine_slopes[i].rounded[1]};
}

static pendres_status orbit_refine(pendres_context *ctx, size_t n, const pendres_orbit_guess *guess,
                                   pendres_orbit_want want, int points, const outputs *to)
{
  pendres_status *outcome = to->outcome;
  if (n > 0 && (guess == NULL || to->orbit == NULL || outcome == NULL))
    return PENDRES_CONTEXT_NULL(ctx, "guess, out and outcome");
  if (want != PENDRES_ORBIT_PLAIN && want != PENDRES_ORBIT_FREQUENCY_SLOPE)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "what is wanted of orbits is no value of pendres_orbit_want");
  if (n == 0) return PENDRES_OK;

  pendres_room room = pendres_room_open(ctx, "orbits");
  pendres_newton_candidate *c = pendres_room_take(&room, n, sizeof *c);
  const two_runs runs = {.want = want, .points = points,
                         .coarse = pendres_room_take(&room, n, sizeof *runs.coarse),
                         .fine = pendres_room_take(&room, n, sizeof *runs.fine),
                         .coarse_slopes = pendres_room_take(&room, n, sizeof *runs.coarse_slopes),
                         .fine_slopes = pendres_room_take(&room, n, sizeof *runs.fine_slopes)};
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  pendres_status status = start(ctx, n, guess, c);
  size_t left = n;
  for (int attempt = 0; attempt < TRIES && left > 0 && status == PENDRES_OK; attempt++) {
    status = refine_once(ctx, left, c, &runs, to);
    /* What missed the tolerance, or could not be told from a ghost, goes on from where it is, with
       more steps. */
    size_t again = 0;
    for (size_t i = 0; i < left && status == PENDRES_OK; i++)
      if (outcome[c[i].index] != PENDRES_OK && c[i].state == PENDRES_NEWTON_CONVERGED &&
          ctx->options.steps_per_period == 0)
        c[again++] = c[i];
    left = again;
  }
  if (status == PENDRES_OK) set_coarser(n, &runs, to);
  return pendres_room_close(&room, status);
}

pendres_status pendres_orbit_find(pendres_context *ctx, size_t n,
                                  const pendres_orbit_guess *guess, pendres_orbit_want want,
                                  pendres_orbit *out, pendres_status *outcome)
{
  pendres_door d = pendres_door_open_many(ctx, n, guess, sizeof *guess);
  while (pendres_door_next(&d)) {
    const pendres_orbit_guess *in = pendres_door_in_run(&d, &pendres_dim_guess, guess);
    const outputs to = {.orbit = pendres_door_out_run(&d, &pendres_dim_orbit, out),
                        .outcome = PENDRES_DOOR_AT(outcome, d.first)};
    PENDRES_DOOR_CALL(&d, orbit_refine(ctx, d.count, in, want, 0, &to));
  }
  return pendres_door_close(&d);
}

pendres_status pendres_orbit_refine_pair(pendres_context *ctx, size_t n,
                                         const pendres_orbit_guess *guess, pendres_orbit *out,
                                         pendres_orbit_coarser *coarser, pendres_status *outcome)
{
  const outputs to = {.orbit = out, .outcome = outcome, .coarser = coarser};
  return PENDRES_CONTEXT_CALL(ctx,
                              orbit_refine(ctx, n, guess, PENDRES_ORBIT_FREQUENCY_SLOPE, 0, &to));
}

pendres_status pendres_orbit_find_once(pendres_context *ctx, size_t n,
                                       const pendres_orbit_guess *guess, pendres_orbit *out,
                                       pendres_status *outcome)
{
  const outputs to = {.orbit = out, .outcome = outcome, .once = 1};
  return PENDRES_CONTEXT_CALL(ctx, orbit_refine(ctx, n, guess, PENDRES_ORBIT_PLAIN, 0, &to));
}

pendres_status pendres_orbit_find_points(pendres_context *ctx, size_t n,
                                         const pendres_orbit_guess *guess, pendres_orbit *out,
                                         pendres_status *outcome)
{
  const outputs to = {.orbit = out, .outcome = outcome};
  return PENDRES_CONTEXT_CALL(ctx, orbit_refine(ctx, n, guess, PENDRES_ORBIT_PLAIN, 1, &to));
}
