/*
 * hard_near.c -- next to a fold, where a stable orbit meets an unstable one and both vanish, and
 * next to the cusp in which two folds meet.
 *
 * At a distance d before a fold the two orbits are some sqrt(d) apart, and errors of the map are
 * amplified by 1 / sqrt(d); beyond it nothing is left but a ghost that takes pendulums some
 * 1 / sqrt(d) periods to pass. At a cusp it is d^(1/3) and d^(2/3). Where everything is comes
 * from extended precision (reference.h).
 */
#include <math.h>
#include <stdlib.h>

#include "oracle/reference.h"

#include "validation/exact.h"
#include "validation/hard_cases.h"

static const double half_pi = 1.57079632679489661923;

enum {
  NEAREST = 12,     /* 1e-12 */
  BUDGET = 300,     /* periods that a pendulum gets before it is unresolved */
  NAIVE_PERIODS = 200,
  STARTS = 4,
  GUESSES = 3
};

static const double tightest = 1e-13, standard = 1e-8;
/* Orbits closer to the fold's in the (x, v) plane are the ones that meet there; the other attractor
   is more than twice as far away. */
static const double vicinity = 0.3;
/* The naive way takes a pendulum that moves less than this in a period for settled. */
static const double at_rest = 1e-6;
static const double naive_tolerance = 1e-6;

/* Decades between distances; shorter runs take fewer of them. */
static int stride(const hard_sheet *sheet)
{
  return sheet->scale >= 1.0 ? 1 : sheet->scale >= 0.1 ? 3 : 9;
}

/* A fold, or the cusp; the pair of orbits exists at drive frequencies on one side of a fold. */
typedef struct place {
  reference_cycle at;
  int exists; /* -1: below, 1: above; 0: the cusp, where one orbit exists on both sides */
} place;

/* What extended precision finds at a distance: the orbits of the place, if they are there. */
typedef struct truth {
  pendres_pendulum p;
  reference_cycle node, saddle;
  int nodes, saddles;
  double off; /* of the place, in drive frequency */
} truth;

static pendres_status find_folds(place folds[2])
{
  const pendres_pendulum p = { .damping = 0.13, .drive_amplitude = 0.2, .drive_frequency = 0.8 };
  folds[0].exists = -1;
  folds[1].exists = 1;
  const pendres_status status =
    reference_find(REFERENCE_FOLD, &p,
                           &(reference_guess){0.8449L, 0.847L, 0.467L, 0.0L}, &folds[0].at);
  return status == PENDRES_OK
           ? reference_find(REFERENCE_FOLD, &p,
                                    &(reference_guess){0.7535L, 0.321L, 1.608L, 0.0L},
                                    &folds[1].at)
           : status;
}

static pendres_status find_cusp(place *cusp)
{
  const pendres_pendulum p = { .drive_amplitude = 0.2, .drive_frequency = 0.86, .damping = 0.16 };
  cusp->exists = 0;
  return reference_find(REFERENCE_CUSP, &p,
                                &(reference_guess){0.862L, 0.7L, 0.7L, 0.1637L}, &cusp->at);
}

/* Orbits next to a fold or cusp lie on the line along which nothing contracts there. */
static void look_around(const place *l, int side, double off, truth *t)
{
  const long double reach = l->exists != 0 ? sqrtl(off) : cbrtl(off);
  const long double along[2] = { l->at.monodromy[0][1], 1.0L - l->at.monodromy[0][0] };
  const long double length = hypotl(along[0], along[1]);
  reference_cycle one;
  *t = (truth){ .off = off, .p = { .damping = (double)l->at.damping,
                       .drive_amplitude = (double)l->at.drive_amplitude,
                       .drive_frequency =
                         (double)(l->at.drive_frequency + side * (long double)off) } };
  if (l->exists != 0 && side != l->exists) return;
  for (int i = -12; i <= 12 && (t->nodes == 0 || (l->exists != 0 && t->saddles == 0)); i++) {
    const long double s = 0.4L * i * reach / length;
    if (reference_orbit(&t->p, l->at.y + s * along[0], l->at.v + s * along[1], 1, 0,
                                &one) != PENDRES_OK)
      continue;
    if (hypotl(one.y - l->at.y, one.v - l->at.v) > vicinity) continue;
    if (one.multiplier_re[0] > 1.0L) t->saddle = one, t->saddles = 1;
    else t->node = one, t->nodes = 1;
  }
}

static int in_vicinity(const place *l, double x, double v)
{
  const double dx = remainder(x - half_pi - (double)l->at.y, 4.0 * half_pi);
  return hypot(dx, v - (double)l->at.v) < vicinity;
}

static int labelled_here(const place *l, const pendres_attractors *set, const pendres_settled *o)
{
  const pendres_attractor *a =
    o->attractor >= 0 ? pendres_attractors_get(set, (size_t)o->attractor) : NULL;
  return a != NULL && in_vicinity(l, a->orbit.x, a->orbit.v);
}

/* ---- beyond: ghosts ------------------------------------------------------------------------ */

/* What starts at positions at[0] and velocities at[1] settle on; *found is freed by the caller,
   also after a failure. */
static pendres_status settle_starts(hard_sheet *sheet, const truth *t, double tolerance,
                                    const double at[2][STARTS], pendres_settled outcome[STARTS],
                                    pendres_attractors **found)
{
  const pendres_pendulum p[STARTS] = { t->p, t->p, t->p, t->p };
  pendres_context *ctx = NULL;
  *found = NULL;
  pendres_status status = hard_context(
    sheet, &(pendres_options){ .tolerance = tolerance, .period_budget = BUDGET }, &ctx);
  if (status != PENDRES_OK) return status;
  status = pendres_settle(ctx, STARTS, p, at[0], at[1], outcome, found);
  if (status != PENDRES_OK) (void)hard_failed(sheet, status, ctx);
  pendres_context_free(ctx);
  return status;
}

/* Attractors found where there is none, and pendulums labelled to settle there. */
static pendres_status count_ghosts(hard_sheet *sheet, const place *l, const truth *t,
                                   double tolerance, int *wrong)
{
  const double x0 = (double)l->at.y + half_pi, v0 = (double)l->at.v;
  const double at[2][STARTS] = { { x0, x0 + 0.02, x0 - 0.02, x0 + 1e-6 }, { v0, v0, v0, v0 } };
  pendres_settled outcome[STARTS];
  pendres_attractors *found = NULL;
  const pendres_status status = settle_starts(sheet, t, tolerance, at, outcome, &found);
  for (size_t i = 0; status == PENDRES_OK && i < pendres_attractors_count(found); i++) {
    const pendres_orbit *o = &pendres_attractors_get(found, i)->orbit;
    *wrong += in_vicinity(l, o->x, o->v);
  }
  for (int i = 0; status == PENDRES_OK && i < STARTS; i++)
    *wrong += labelled_here(l, found, &outcome[i]);
  pendres_attractors_free(found);
  return status;
}

/* Where the naive way is after some periods, and how far it moves in one more. */
static pendres_status go_naively(hard_sheet *sheet, const pendres_pendulum *p, double *x, double *v,
                                 double *moved)
{
  pendres_context *ctx = NULL;
  pendres_status status = hard_naive_context(sheet, naive_tolerance, &ctx);
  if (status != PENDRES_OK) return status;
  status = pendres_strobe_advance(ctx, 1, p, x, v, NAIVE_PERIODS, NULL);
  const double x0 = *x, v0 = *v;
  if (status == PENDRES_OK) status = pendres_strobe_advance(ctx, 1, p, x, v, 1, NULL);
  *moved = hypot(*x - x0, *v - v0);
  if (status != PENDRES_OK) (void)hard_failed(sheet, status, ctx);
  pendres_context_free(ctx);
  return status;
}

/*
 * Beyond a fold there is no orbit, at any tolerance: no attractor may be found, no pendulum be
 * labelled to go there. Bound: none.
 */
static pendres_status add_beyond(hard_sheet *sheet, const place folds[2], double off)
{
  const double tolerances[] = { standard, tightest };
  int wrong = 0, naive = 0;
  pendres_status status = PENDRES_OK;
  for (int f = 0; f < 2 && status == PENDRES_OK; f++) {
    const place *l = &folds[f];
    double x = (double)l->at.y + half_pi, v = (double)l->at.v, moved = NAN;
    truth t;
    look_around(l, -l->exists, off, &t);
    for (int k = 0; k < 2 && status == PENDRES_OK; k++)
      status = count_ghosts(sheet, l, &t, tolerances[k], &wrong);
    if (status == PENDRES_OK) status = go_naively(sheet, &t.p, &x, &v, &moved);
    naive += moved < at_rest && in_vicinity(l, x, v);
  }
  if (status != PENDRES_OK) return status;
  return hard_sheet_add(sheet, hard_at("fold_ghost", off).text,
                        "beyond folds: labels of orbits that are gone", wrong, 0.0, naive);
}

/* ---- before: orbits ------------------------------------------------------------------------ */

/* The largest of an orbit's errors over the claimed one; infinite if it was not found. */
static pendres_status error_over_claimed(hard_sheet *sheet, const truth *t, double tolerance,
                                         double most, double *ratio)
{
  const pendres_orbit_guess guess = { .pendulum = t->p, .x = (double)t->node.y + half_pi,
                                      .v = (double)t->node.v, .period = 1 };
  pendres_context *ctx = NULL;
  pendres_orbit o;
  pendres_status outcome;
  pendres_status status = hard_context(sheet, &(pendres_options){ .tolerance = tolerance }, &ctx);
  if (status != PENDRES_OK) return status;
  status = pendres_orbit_find(ctx, 1, &guess, PENDRES_ORBIT_PLAIN, &o, &outcome);
  if (status != PENDRES_OK) (void)hard_failed(sheet, status, ctx);
  *ratio = INFINITY;
  if (status == PENDRES_OK && outcome != PENDRES_NOT_CONVERGED) {
    /* Newton's method may have gone to the twin: that is an orbit, too. */
    const reference_cycle *e = t->saddles && !o.stable ? &t->saddle : &t->node;
    const long double exact_x = e->y + half_pi_exact;
    const struct { long double off; double claim; } measures[] = {
      { o.x - exact_x, o.x_error },
      { o.v - e->v, o.v_error },
      { o.amplitude - e->amplitude, o.amplitude_error },
      { o.loop_area - e->loop_area, o.loop_area_error },
    };
    *ratio = 0.0;
    for (size_t i = 0; i < sizeof measures / sizeof *measures; i++)
      *ratio = hard_larger(*ratio, hard_over_claim((double)fabsl(measures[i].off),
                                                   measures[i].claim, most));
  }
  pendres_context_free(ctx);
  return status;
}

/*
 * The orbit that is there must be found at the tightest tolerance, with errors within ten times
 * the claimed ones; at the default one, where its own errors may exceed the distance to the fold,
 * with such errors or not at all. The naive way starts next to the orbit and claims what it moves
 * in the last period, and no less than its tolerance.
 */
static pendres_status worst_orbit(hard_sheet *sheet, const truth *t, double off_by, double *worst,
                                  double *naive)
{
  double ratio, loose, x = (double)t->node.y + half_pi + 1e-3, v = (double)t->node.v, moved;
  /* At the tightest tolerance the claim tells the orbit from its twin, sqrt(off) away. */
  pendres_status status = error_over_claimed(sheet, t, tightest, 0.1 * sqrt(off_by), &ratio);
  if (status == PENDRES_OK) status = error_over_claimed(sheet, t, standard, vicinity, &loose);
  if (status == PENDRES_OK) status = go_naively(sheet, &t->p, &x, &v, &moved);
  if (status != PENDRES_OK) return status;
  *worst = hard_larger(*worst, ratio);
  if (loose != INFINITY) *worst = hard_larger(*worst, loose);
  const double off = hypot(x - half_pi - (double)t->node.y, v - (double)t->node.v);
  *naive = hard_larger(*naive, off / fmax(moved, naive_tolerance));
  return status;
}

/* How much of the way to the saddle the trapping ellipse reaches. */
static double reach_of(const pendres_attractor *a, const truth *t)
{
  const double dy = (double)(t->saddle.y - t->node.y);
  const double dw = (double)(t->saddle.v - t->node.v) / t->p.drive_frequency;
  const double *m = a->trap_metric;
  return a->trap_radius / sqrt(m[0] * dy * dy + 2.0 * m[1] * dy * dw + m[2] * dw * dw);
}

/*
 * Starts on the line from the orbit through the saddle, a tenth and a thousandth of their distance
 * short of the saddle and beyond: the latter do not belong to the orbit, as the basin's boundary
 * crosses the line at the saddle.
 */
static const double beyond[STARTS] = { -0.1, -1e-3, 1e-3, 0.1 };

static void place_starts(const truth *t, double x[STARTS], double v[STARTS])
{
  const double dx = (double)(t->saddle.y - t->node.y), dv = (double)(t->saddle.v - t->node.v);
  for (int i = 0; i < STARTS; i++) {
    x[i] = (double)t->node.y + half_pi + (1.0 + beyond[i]) * dx;
    v[i] = (double)t->node.v + (1.0 + beyond[i]) * dv;
  }
}

/* Nearer folds a pendulum takes longer than anybody waits here, some 10 / sqrt(off) periods; that
   it is found to belong nowhere is right then. */
static const double least_settling = 0.9e-6;

static long budget_at(double off)
{
  return off > least_settling ? (long)fmax(BUDGET, 10.0 / sqrt(off)) : BUDGET;
}

static pendres_status label_starts(hard_sheet *sheet, const place *l, const truth *t,
                                   double tolerance, int *wrong, double *reach)
{
  const double guess_x[GUESSES] = { (double)t->node.y + half_pi, half_pi, 0.0 };
  const double guess_v[GUESSES] = { (double)t->node.v, 0.0, 0.0 };
  double x[STARTS], v[STARTS], here = NAN;
  pendres_settled outcome[STARTS];
  pendres_attractors *found = NULL;
  pendres_context *ctx = NULL;
  place_starts(t, x, v);
  pendres_status status = hard_context(
    sheet, &(pendres_options){ .tolerance = tolerance, .period_budget = budget_at(t->off) }, &ctx);
  if (status != PENDRES_OK) return status;
  status = pendres_attractors_find(ctx, &t->p, GUESSES, guess_x, guess_v, &found);
  if (status == PENDRES_OK)
    status = pendres_attractors_settle(ctx, found, STARTS, x, v, outcome);
  if (status != PENDRES_OK) (void)hard_failed(sheet, status, ctx);
  for (int i = 0; i < STARTS && status == PENDRES_OK; i++)
    *wrong += outcome[i].attractor >= 0 &&
              labelled_here(l, found, &outcome[i]) != (beyond[i] < 0.0);
  /* Starts far from the saddle have time enough: a label that is none is no right one. */
  for (int i = 0; i < STARTS && status == PENDRES_OK; i++)
    *wrong += t->off > least_settling && fabs(beyond[i]) > 0.01 && outcome[i].attractor < 0;
  for (size_t i = 0; status == PENDRES_OK && i < pendres_attractors_count(found); i++) {
    const pendres_attractor *a = pendres_attractors_get(found, i);
    if (in_vicinity(l, a->orbit.x, a->orbit.v)) here = reach_of(a, t);
  }
  *reach = hard_larger(*reach, here); /* NaN, not found, stays */
  pendres_attractors_free(found);
  pendres_context_free(ctx);
  return status;
}

/* What the naive way is next to in the end counts as its label. */
static pendres_status label_naively(hard_sheet *sheet, const place *l, const truth *t, int *wrong)
{
  double x[STARTS], v[STARTS], moved;
  pendres_status status = PENDRES_OK;
  place_starts(t, x, v);
  for (int i = 0; i < STARTS && status == PENDRES_OK; i++) {
    status = go_naively(sheet, &t->p, &x[i], &v[i], &moved);
    *wrong += in_vicinity(l, x[i], v[i]) != (beyond[i] < 0.0);
  }
  return status;
}

/*
 * Labels right at the tightest tolerance, and at the standard one while the fold is further than
 * the ten tolerances that each period is allowed; unresolved is not wrong for starts close to the
 * saddle, and close to the fold; but the attractor itself must be found everywhere. An ellipse is
 * part of the basin and the saddle on the basin's edge: the ellipse ends before the saddle.
 */
static pendres_status add_before(hard_sheet *sheet, const place folds[2], double off)
{
  double worst = 0.0, naive_worst = 0.0, reach = 0.0;
  int wrong = 0, naive = 0;
  pendres_status status = PENDRES_OK;
  for (int f = 0; f < 2 && status == PENDRES_OK; f++) {
    truth t;
    look_around(&folds[f], folds[f].exists, off, &t);
    if (!t.nodes || !t.saddles) return hard_failed(sheet, PENDRES_NOT_FOUND, NULL);
    status = worst_orbit(sheet, &t, off, &worst, &naive_worst);
    if (status == PENDRES_OK)
      status = label_starts(sheet, &folds[f], &t, tightest, &wrong, &reach);
    if (status == PENDRES_OK && off > 9.0 * standard)
      status = label_starts(sheet, &folds[f], &t, standard, &wrong, &reach);
    if (status == PENDRES_OK) status = label_naively(sheet, &folds[f], &t, &naive);
  }
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, hard_at("fold_orbit", off).text,
                            "before folds: the orbit's errors over the claimed", worst, 10.0,
                            naive_worst);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, hard_at("fold_trap", off).text,
                            "its trap over the way to the saddle", reach, 1.0, NAN);
  if (status == PENDRES_OK)
    status = hard_sheet_add(sheet, hard_at("fold_label", off).text,
                            "wrong labels of starts on both sides of the saddle", wrong, 0.0,
                            naive);
  return status;
}

pendres_status hard_fold(hard_sheet *sheet)
{
  place folds[2];
  pendres_status status = find_folds(folds);
  if (status != PENDRES_OK) return hard_failed(sheet, status, NULL);
  for (int k = 3; k <= NEAREST && status == PENDRES_OK; k += stride(sheet)) {
    status = add_beyond(sheet, folds, pow(10.0, -k));
    if (status == PENDRES_OK) status = add_before(sheet, folds, pow(10.0, -k));
  }
  return status;
}

/* ---- the cusp ------------------------------------------------------------------------------ */

/*
 * At the cusp's damping one orbit exists at every drive frequency, before the cusp and beyond, and
 * is all that pendulums can settle on: one attractor, errors as above.
 */
static pendres_status count_others(hard_sheet *sheet, const place *l, const truth *t, int *wrong)
{
  const double x0 = (double)l->at.y + half_pi, v0 = (double)l->at.v;
  const double at[2][STARTS] = { { x0, x0 + 0.05, x0 - 0.05, half_pi }, { v0, v0, v0, 0.0 } };
  pendres_settled outcome[STARTS];
  pendres_attractors *found = NULL;
  const pendres_status status = settle_starts(sheet, t, tightest, at, outcome, &found);
  /* It must be found, too. */
  if (status == PENDRES_OK) *wrong += abs((int)pendres_attractors_count(found) - 1);
  pendres_attractors_free(found);
  return status;
}

pendres_status hard_cusp(hard_sheet *sheet)
{
  place cusp;
  pendres_status status = find_cusp(&cusp);
  if (status != PENDRES_OK) return hard_failed(sheet, status, NULL);
  for (int k = 3; k <= NEAREST && status == PENDRES_OK; k += stride(sheet)) {
    const double off = pow(10.0, -k);
    double worst = 0.0, naive = 0.0;
    int wrong = 0;
    for (int side = -1; side <= 1 && status == PENDRES_OK; side += 2) {
      truth t;
      look_around(&cusp, side, off, &t);
      if (!t.nodes) return hard_failed(sheet, PENDRES_NOT_FOUND, NULL);
      status = worst_orbit(sheet, &t, off, &worst, &naive);
      if (status == PENDRES_OK) status = count_others(sheet, &cusp, &t, &wrong);
    }
    if (status == PENDRES_OK)
      status = hard_sheet_add(sheet, hard_at("cusp_orbit", off).text,
                              "both sides of the cusp: errors over the claimed", worst, 10.0,
                              naive);
    if (status == PENDRES_OK)
      status = hard_sheet_add(sheet, hard_at("cusp_label", off).text,
                              "attractors beside the only one, or none", wrong, 0.0, NAN);
  }
  return status;
}
