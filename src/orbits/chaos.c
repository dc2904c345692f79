/* chaos.c -- telling chaos from slow settling; see chaos.h. */
#include "orbits/chaos.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "base/student.h"
#include "orbits/chaos_walkers.h"
#include "engine/context_internal.h"
#include "model/model.h"
#include "orbits/recurrence.h"
#include "orbits/settle_lanes.h"

enum {
  SUSPECTS = 16,         /* lanes that are looked at first ... */
  SUSPECT_PERIODS = 128, /* ... for so long */
  WALKERS = 64,          /* that are then watched, after having lost each other */
  WARM_UP = 200,
  ATTEMPTS = 3,          /* walkers sent out anew where some were in no chaos */
  BATCHES = 16,          /* that a walker's periods are parted into, an even number */
  BATCH = 120,           /* periods of a batch, at first (walkers may visit the bands of an
                            attractor by turns, all in step: whole rounds of 2, 3, 4, 5, 6, 8) */
  LONGEST_BATCH = 4 * BATCH, /* where walkers have not agreed before */
  FEW_BATCHES = 4,       /* after which walkers that are on different attractors are told apart */
  KEPT = 8 * BATCH,      /* latest strobe points of a walker */
  MOST_GUESSES = 8       /* orbits looked for at a time */
};

/* Standard errors that an exponent must be above zero. */
static const double significance = 5.0;
/* Least growth of the logarithm a period: slower is not told from slow settling. */
static const double least_growth = 0.01;
/* A suspect's tangent vector must have grown by e to this: without chaos it grows by a few. */
static const double suspicious = 2.0;
/* Walkers start this close to the suspect, and closer by the same factor once more at each further
   attempt: the basin of a chaos in narrow bands may end nearby. */
static const double scatter = 1e-3, closer = 0.03;
/* Walkers agree when their means vary by so much more than their batches let expect: for walkers
   that are alike this ratio exceeds 2 in one case of 10^6 (F distribution). */
static const double agreement = 2.0;
/* Confidence of a mean's error, and of the escape rate that is excluded. */
static const double confidence = 0.999, escape_confidence = 0.95;

/* ---- walkers that are watched ---- */

typedef struct vigil {
  pendres_walker a[WALKERS];
  int batches; /* whole ones so far */
  long length; /* periods of each */
  double batch[WALKERS][BATCHES][PENDRES_WALKER_MEASURES];
  pendres_walker_trace trace;
  double y[WALKERS * KEPT], w[WALKERS * KEPT];
} vigil;

static size_t points_of(const vigil *v)
{
  return (size_t)(v->trace.filled < KEPT ? v->trace.filled : KEPT);
}

static double share_within(const pendres_cover *cover, const vigil *v)
{
  size_t inside = 0;
  for (size_t i = 0; i < WALKERS; i++)
    for (size_t k = 0; k < points_of(v); k++)
      inside += (size_t)pendres_cover_holds(cover, v->y[i * KEPT + k], v->w[i * KEPT + k]);
  return (double)inside / (double)(WALKERS * points_of(v));
}

static void widen(pendres_cover *cover, const vigil *v)
{
  for (size_t i = 0; i < WALKERS; i++)
    for (size_t k = 0; k < points_of(v); k++)
      pendres_cover_add(cover, v->y[i * KEPT + k], v->w[i * KEPT + k]);
}

static pendres_cover *create_cover(const pendres_pendulum *p, const vigil *v)
{
  const double turn = pendres_model_turn(p);
  const double share = 1.0 / (double)(WALKERS * points_of(v));
  pendres_cover *cover = calloc(1, sizeof *cover);
  if (cover == NULL) return NULL;
  for (size_t i = 0; i < WALKERS; i++)
    for (size_t k = 0; k < points_of(v); k++) {
      const double y = v->y[i * KEPT + k], w = v->w[i * KEPT + k];
      cover->w_most = fmax(cover->w_most, 1.1 * fabs(w));
      cover->mean_y += share * (y - turn * rint(y / turn));
      if (turn > two_pi) cover->span = fmax(cover->span, 2.2 * fabs(y));
      cover->mean_w += share * w;
    }
  widen(cover, v);
  return cover;
}

/* A lane whose nearby motions part from each other, among the first few; *any: 0 if none is. */
static pendres_status find_suspect(pendres_context *ctx, const pendres_catalogue *c, size_t n,
                                   const pendres_strobe_lane *const *lanes, pendres_walker *suspect,
                                   int *any)
{
  pendres_walker a[SUSPECTS];
  const size_t asked = n < SUSPECTS ? n : SUSPECTS;
  for (size_t i = 0; i < asked; i++) {
    const pendres_strobe_lane *l = lanes[i * n / asked];
    a[i] = pendres_walker_at(l->y, l->w);
  }
  const pendres_status status = pendres_walkers_advance(ctx, c, asked, a, SUSPECT_PERIODS, NULL);
  *any = 0;
  for (size_t i = 0; i < asked && !*any && status == PENDRES_OK; i++)
    if (a[i].trapped == 0 && a[i].sum[PENDRES_WALKER_GROWTH] > suspicious) {
      *suspect = a[i];
      *any = 1;
    }
  return status;
}

/* Chaos that ends: how long it lasts, from the walkers that have left by now. */
static void note_lifetime(pendres_catalogue *c, const vigil *v, size_t left)
{
  double lived = 0.0;
  for (size_t i = 0; i < WALKERS; i++)
    lived += (double)(v->a[i].trapped > 0 ? v->a[i].trapped : v->a[i].periods);
  if (left > 0) c->transient = fmax(c->transient, lived / (double)left);
}

static size_t trapped_walkers(const vigil *v)
{
  size_t n = 0;
  for (size_t i = 0; i < WALKERS; i++) n += v->a[i].trapped > 0;
  return n;
}

/*
 * Walkers that start around the suspect and lose each other. Where some of them are in a trap
 * then, the suspect may have stood at the edge of the basin of chaos: the others are followed on.
 * *together: none of them has left.
 */
static pendres_status send_out(pendres_context *ctx, pendres_catalogue *c,
                               const pendres_walker *suspect, vigil *v, int *together)
{
  pendres_walker from = *suspect;
  double radius = scatter;
  *together = 0;
  for (int attempt = 0; attempt < ATTEMPTS && !*together; attempt++, radius *= closer) {
    for (size_t i = 0; i < WALKERS; i++) {
      /* Spread by an irrational angle: no two walkers start at the same place. */
      const double angle = 2.39996322972865332 * (double)i;
      v->a[i] = pendres_walker_at(from.y + radius * cos(angle), from.w + radius * sin(angle));
    }
    const pendres_status status = pendres_walkers_advance(ctx, c, WALKERS, v->a, WARM_UP, NULL);
    if (status != PENDRES_OK) return status;
    const size_t left = trapped_walkers(v);
    note_lifetime(c, v, left);
    if (left == WALKERS) return status;
    *together = left == 0;
    for (size_t i = 0; i < WALKERS; i++)
      if (v->a[i].trapped == 0) from = v->a[i];
  }
  return PENDRES_OK;
}

/* Two batches become one. */
static void merge_batches(vigil *v)
{
  for (size_t i = 0; i < WALKERS; i++)
    for (int b = 0; b < BATCHES / 2; b++)
      for (int m = 0; m < PENDRES_WALKER_MEASURES; m++)
        v->batch[i][b][m] = v->batch[i][2 * b][m] + v->batch[i][2 * b + 1][m];
  v->batches = BATCHES / 2;
  v->length *= 2;
}

static pendres_status next_batch(pendres_context *ctx, const pendres_catalogue *c, vigil *v)
{
  for (size_t i = 0; i < WALKERS; i++) memset(v->a[i].sum, 0, sizeof v->a[i].sum);
  const pendres_status status =
    pendres_walkers_advance(ctx, c, WALKERS, v->a, v->length, &v->trace);
  for (size_t i = 0; i < WALKERS && status == PENDRES_OK; i++)
    memcpy(v->batch[i][v->batches], v->a[i].sum, sizeof v->a[i].sum);
  v->batches += status == PENDRES_OK;
  return status;
}

/*
 * Orbits that walkers have settled on, whose tangent vectors shrank in the latest batch: each comes
 * back near itself, and Newton's method does the rest.
 */
static pendres_status seek_orbits(pendres_context *ctx, pendres_catalogue *c, const vigil *v,
                                  size_t *settled)
{
  pendres_scout guesses[MOST_GUESSES];
  size_t n = 0;
  const long points = v->trace.filled < PENDRES_RECURRENCE_POINTS ? v->trace.filled
                                                                  : PENDRES_RECURRENCE_POINTS;
  *settled = 0;
  for (size_t i = 0; i < WALKERS; i++) {
    double y[PENDRES_RECURRENCE_POINTS], w[PENDRES_RECURRENCE_POINTS];
    pendres_recurrence r;
    if (!(v->batch[i][v->batches - 1][PENDRES_WALKER_GROWTH] < 0.0)) continue;
    for (long k = 0; k < points; k++) {
      const size_t at = i * KEPT + (size_t)((v->trace.filled - points + k) % KEPT);
      y[k] = v->y[at];
      w[k] = v->w[at];
    }
    if (!pendres_recurrence_find((int)points, pendres_model_turn(&c->pendulum), y, w, &r)) continue;
    ++*settled;
    if (n < MOST_GUESSES)
      guesses[n++] = (pendres_scout){.y = r.y, .w = r.w, .period = r.period, .winding = r.winding};
  }
  return pendres_catalogue_add(ctx, c, n, guesses);
}

/* ---- statistics ---- */

/* Mean a period of what walkers have, and its standard error. */
static pendres_chaos_mean mean_of(const vigil *v, pendres_walker_measure m, double *ratio)
{
  const double periods = (double)v->length, batches = v->batches;
  double mean[WALKERS], sum = 0.0, between = 0.0, within = 0.0;
  for (size_t i = 0; i < WALKERS; i++) {
    mean[i] = 0.0;
    for (int b = 0; b < v->batches; b++) mean[i] += v->batch[i][b][m] / (periods * batches);
    sum += mean[i] / WALKERS;
  }
  for (size_t i = 0; i < WALKERS; i++) {
    between += (mean[i] - sum) * (mean[i] - sum) / (WALKERS - 1.0);
    for (int b = 0; b < v->batches; b++) {
      const double d = v->batch[i][b][m] / periods - mean[i];
      within += d * d / (WALKERS * (batches - 1.0));
    }
  }
  *ratio = between / (within / batches);
  return (pendres_chaos_mean){.value = sum,
                              .error = sqrt(fmax(between, within / batches) / WALKERS)};
}

/* The error as a share of scatter that the given confidence asks for (Student). */
static pendres_chaos_mean confident(pendres_chaos_mean m)
{
  m.error *= pendres_student(confidence, WALKERS - 1.0);
  return m;
}

/* Walkers whose own exponent over the latter half of their batches is not above zero. */
static size_t calm_walkers(const vigil *v)
{
  size_t calm = 0;
  for (size_t i = 0; i < WALKERS; i++) {
    double growth = 0.0;
    for (int b = v->batches / 2; b < v->batches; b++)
      growth += v->batch[i][b][PENDRES_WALKER_GROWTH];
    calm += !(growth > 0.0);
  }
  return calm;
}

/* Whether walkers differ by no more than chance has them: they are on one attractor then. */
static int alike(const vigil *v)
{
  static const pendres_walker_measure telling[] = {PENDRES_WALKER_GROWTH, PENDRES_WALKER_TURNS,
                                                   PENDRES_WALKER_SPEED};
  for (size_t k = 0; k < sizeof telling / sizeof telling[0]; k++) {
    double ratio = 0.0;
    (void)mean_of(v, telling[k], &ratio);
    if (ratio > agreement) return 0;
  }
  return 1;
}

static pendres_chaos_measures measures_of(const pendres_catalogue *c, const vigil *v)
{
  double ratio = 0.0;
  /* Who leaves is recognized after some time only: that does not count as watched. */
  const double each = (double)v->length * v->batches;
  const double late = fmin((double)pendres_settle_first_budget(&c->pendulum), 0.5 * each);
  const double watched = WALKERS * (each - late);
  pendres_chaos_measures m = {
    .growth = mean_of(v, PENDRES_WALKER_GROWTH, &ratio),
    .work = confident(mean_of(v, PENDRES_WALKER_WORK, &ratio)),
    .loss = confident(mean_of(v, PENDRES_WALKER_LOSS, &ratio)),
    .amplitude = confident(mean_of(v, PENDRES_WALKER_AMPLITUDE, &ratio)),
    .turns = confident(mean_of(v, PENDRES_WALKER_TURNS, &ratio)),
    .watched_periods = watched,
    .escape_rate_bound = -log(1.0 - escape_confidence) / watched};
  /* In the long run friction takes what the drive gives. */
  const double imbalance = fabs(m.work.value - m.loss.value);
  m.work.error += imbalance;
  m.loss.error += imbalance;
  return m;
}

/* ---- the verdict ---- */

/* The attractor that walkers are on after their first batch, if it is known. */
static pendres_cover *known_cover(const pendres_catalogue *c, const vigil *v)
{
  pendres_cover *cover = NULL;
  for (size_t i = 0; i < c->covers; i++)
    if (share_within(c->cover[i], v) > 0.5) cover = c->cover[i];
  return cover;
}

/*
 * Watch walkers until they agree, or one of them has left, or they are on an attractor that is
 * known. Otherwise *verdict is NEW when they have been watched for long enough. Walkers that have
 * gone to different attractors, as mirror images are, are sent out once more from where one is.
 */
static pendres_status watch(pendres_context *ctx, pendres_catalogue *c, vigil *v,
                            pendres_chaos_verdict *verdict)
{
  pendres_status status = PENDRES_OK;
  int again = 0, together = 0;
  v->length = BATCH;
  for (;;) {
    size_t settled = 0;
    const size_t known = c->count;
    status = next_batch(ctx, c, v);
    if (status == PENDRES_OK) status = seek_orbits(ctx, c, v, &settled);
    if (status != PENDRES_OK) return status;
    const size_t left = trapped_walkers(v);
    if (left > 0 || c->count > known) {
      note_lifetime(c, v, left > 0 ? left : settled);
      *verdict = PENDRES_CHAOS_TRANSIENT;
      return status;
    }
    pendres_cover *cover = v->trace.filled == BATCH ? known_cover(c, v) : NULL;
    if (cover != NULL) {
      widen(cover, v);
      *verdict = PENDRES_CHAOS_KNOWN;
      return status;
    }
    if (v->batches == FEW_BATCHES && v->length == BATCH && !again && !alike(v)) {
      again = 1;
      status = send_out(ctx, c, &v->a[0], v, &together);
      if (status != PENDRES_OK || !together) {
        *verdict = PENDRES_CHAOS_TRANSIENT;
        return status;
      }
      v->batches = 0;
      v->trace.filled = 0;
    }
    if (v->batches < BATCHES) continue;
    if ((alike(v) && calm_walkers(v) == 0) || v->length == LONGEST_BATCH) break;
    merge_batches(v);
  }
  const pendres_chaos_measures m = measures_of(c, v);
  if (calm_walkers(v) == 0 && m.growth.value > significance * m.growth.error &&
      m.growth.value > least_growth)
    *verdict = PENDRES_CHAOS_NEW;
  return status;
}

pendres_status pendres_chaos_find(pendres_context *ctx, pendres_catalogue *c, size_t n,
                                  const pendres_strobe_lane *const *lanes,
                                  pendres_chaos_verdict *verdict)
{
  pendres_walker suspect;
  int any = 0, together = 0;
  *verdict = PENDRES_CHAOS_NONE;
  if (n == 0 || c->covers == PENDRES_MOST_COVERS) return PENDRES_OK;
  pendres_status status = find_suspect(ctx, c, n, lanes, &suspect, &any);
  if (status != PENDRES_OK || !any) return status;

  vigil *v = calloc(1, sizeof *v);
  if (v == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for chaotic motion");
  v->trace = (pendres_walker_trace){.length = KEPT, .y = v->y, .w = v->w};
  status = send_out(ctx, c, &suspect, v, &together);
  if (status == PENDRES_OK && !together) *verdict = PENDRES_CHAOS_TRANSIENT;
  if (status == PENDRES_OK && together) status = watch(ctx, c, v, verdict);
  if (status == PENDRES_OK && *verdict == PENDRES_CHAOS_NEW) {
    const pendres_chaos_measures m = measures_of(c, v);
    pendres_cover *cover = create_cover(&c->pendulum, v);
    status = cover != NULL
               ? pendres_catalogue_add_chaos(ctx, c, &m, cover)
               : pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for chaos");
  }
  free(v);
  return status;
}
