/* chaos.c -- distinguishing chaos from slow settling; see chaos.h. */
#include "settling/chaos.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "base/student.h"
#include "settling/chaos_replicas.h"
#include "engine/context_internal.h"
#include "model/model.h"
#include "settling/exponents/growth.h"
#include "settling/numbers.h"
#include "settling/settle_lanes.h"

/* ---- replicas that are followed ---- */

typedef struct ensemble {
  pendres_replica a[REPLICAS];
  int batches; /* whole ones so far */
  long length; /* periods of each */
  double batch[REPLICAS][BATCHES][PENDRES_REPLICA_MEASURES];
  pendres_replica_trace trace;
  double y[REPLICAS * KEPT], w[REPLICAS * KEPT];
} ensemble;

static size_t points_of(const ensemble *v)
{
  return (size_t)(v->trace.filled < KEPT ? v->trace.filled : KEPT);
}

static double share_within(const pendres_cover *cover, const ensemble *v)
{
  size_t inside = 0;
  for (size_t i = 0; i < REPLICAS; i++)
    for (size_t k = 0; k < points_of(v); k++)
      inside += (size_t)pendres_cover_holds(cover, v->y[i * KEPT + k], v->w[i * KEPT + k]);
  return (double)inside / (double)(REPLICAS * points_of(v));
}

static void widen(pendres_cover *cover, const ensemble *v)
{
  for (size_t i = 0; i < REPLICAS; i++)
    for (size_t k = 0; k < points_of(v); k++)
      pendres_cover_add(cover, v->y[i * KEPT + k], v->w[i * KEPT + k]);
}

static pendres_cover *create_cover(const pendres_pendulum *p, const ensemble *v)
{
  const double turn = pendres_model_turn(p);
  const double share = 1.0 / (double)(REPLICAS * points_of(v));
  pendres_cover *cover = calloc(1, sizeof *cover);
  if (cover == NULL) return NULL;
  for (size_t i = 0; i < REPLICAS; i++)
    for (size_t k = 0; k < points_of(v); k++) {
      const double y = v->y[i * KEPT + k], w = v->w[i * KEPT + k];
      cover->w_most = fmax(cover->w_most, 1.1 * fabs(w));
      cover->mean_y += share * (y - turn * rint(y / turn));
      if (turn > two_pi) cover->span = fmax(cover->span, 2.2 * fabs(y));
      cover->mean_w += share * w;
    }
  widen(cover, v);
  cover->y = v->a[0].y;
  cover->w = v->a[0].w;
  return cover;
}

/* Find a lane whose neighbours in phase space part from it, among a few lanes; *any is 0 if there
   is none. */
static pendres_status find_suspect(pendres_context *ctx, const pendres_attractor_set *c, size_t n,
                                   const pendres_strobe_lane *const *lanes,
                                   pendres_replica *suspect,
                                   int *any)
{
  pendres_replica a[SUSPECTS];
  const size_t asked = n < SUSPECTS ? n : SUSPECTS;
  for (size_t i = 0; i < asked; i++) {
    const pendres_strobe_lane *l = lanes[i * n / asked];
    a[i] = pendres_replica_at(l->y, l->w);
  }
  const pendres_status status = pendres_replicas_advance(ctx, c, asked, a, SUSPECT_PERIODS, NULL);
  *any = 0;
  for (size_t i = 0; i < asked && !*any && status == PENDRES_OK; i++)
    if (a[i].trapped == 0 && a[i].sum[PENDRES_REPLICA_GROWTH] > chaos_suspicious) {
      *suspect = a[i];
      *any = 1;
    }
  return status;
}

/* Estimate how long transient chaos lasts, from the replicas that have left it by now. */
static void note_lifetime(pendres_attractor_set *c, const ensemble *v, size_t left)
{
  double lived = 0.0;
  for (size_t i = 0; i < REPLICAS; i++)
    lived += (double)(v->a[i].trapped > 0 ? v->a[i].trapped : v->a[i].periods);
  if (left > 0) c->transient = fmax(c->transient, lived / (double)left);
}

static size_t trapped_replicas(const ensemble *v)
{
  size_t n = 0;
  for (size_t i = 0; i < REPLICAS; i++) n += v->a[i].trapped > 0;
  return n;
}

/*
 * Start replicas around the suspect and let them separate. If some of them are in a
 * trapping ellipse then, the suspect may have stood at the edge of the basin of chaos, and
 * replicas start again around one that has stayed. *together is 1 if none of them has left in the
 * end.
 */
static pendres_status send_out(pendres_context *ctx, pendres_attractor_set *c,
                               const pendres_replica *suspect, ensemble *v, int *together)
{
  pendres_replica from = *suspect;
  double radius = chaos_scatter;
  *together = 0;
  for (int attempt = 0; attempt < ATTEMPTS && !*together; attempt++, radius *= chaos_closer) {
    for (size_t i = 0; i < REPLICAS; i++) {
      const double angle = golden_angle * (double)i;
      v->a[i] = pendres_replica_at(from.y + radius * cos(angle), from.w + radius * sin(angle));
    }
    const pendres_status status = pendres_replicas_advance(ctx, c, REPLICAS, v->a, WARM_UP, NULL);
    if (status != PENDRES_OK) return status;
    const size_t left = trapped_replicas(v);
    note_lifetime(c, v, left);
    if (left == REPLICAS) return status;
    *together = left == 0;
    for (size_t i = 0; i < REPLICAS; i++)
      if (v->a[i].trapped == 0) from = v->a[i];
  }
  return PENDRES_OK;
}

/* Join the batches in pairs. */
static void merge_batches(ensemble *v)
{
  for (size_t i = 0; i < REPLICAS; i++)
    for (int b = 0; b < BATCHES / 2; b++)
      for (int m = 0; m < PENDRES_REPLICA_MEASURES; m++)
        v->batch[i][b][m] = v->batch[i][2 * b][m] + v->batch[i][2 * b + 1][m];
  v->batches = BATCHES / 2;
  v->length *= 2;
}

static pendres_status next_batch(pendres_context *ctx, const pendres_attractor_set *c, ensemble *v)
{
  for (size_t i = 0; i < REPLICAS; i++) memset(v->a[i].sum, 0, sizeof v->a[i].sum);
  const pendres_status status =
    pendres_replicas_advance(ctx, c, REPLICAS, v->a, v->length, &v->trace);
  for (size_t i = 0; i < REPLICAS && status == PENDRES_OK; i++)
    memcpy(v->batch[i][v->batches], v->a[i].sum, sizeof v->a[i].sum);
  v->batches += status == PENDRES_OK;
  return status;
}

/*
 * Look for orbits that replicas have settled on: such a replica's tangent vector has shrunk in the
 * latest batch, and it comes back near where it was. Newton's method does the rest.
 */
static pendres_status seek_orbits(pendres_context *ctx, pendres_attractor_set *c, const ensemble *v,
                                  size_t *settled)
{
  pendres_initial_guess guesses[PENDRES_MOST_GUESSES];
  size_t n = 0;
  *settled = 0;
  for (size_t i = 0; i < REPLICAS; i++) {
    const pendres_recurrence r = {v->trace.filled, KEPT, v->y + i * KEPT, v->w + i * KEPT};
    pendres_initial_guess guess;
    if (!(v->batch[i][v->batches - 1][PENDRES_REPLICA_GROWTH] < 0.0)) continue;
    if (!pendres_recurrence_find(&r, pendres_model_turn(&c->pendulum), &guess)) continue;
    ++*settled;
    if (n < PENDRES_MOST_GUESSES) guesses[n++] = guess;
  }
  return pendres_attractor_set_add(ctx, c, n, guesses);
}

/* ---- statistics ---- */

/* The mean of a measure a period over all replicas, and its standard error. *ratio is the variance
   of the replicas' means over that expected from the scatter of their batches. */
static pendres_chaos_mean mean_of(const ensemble *v, pendres_replica_measure m, double *ratio)
{
  const double periods = (double)v->length, batches = v->batches;
  double mean[REPLICAS], sum = 0.0, between = 0.0, within = 0.0;
  for (size_t i = 0; i < REPLICAS; i++) {
    mean[i] = 0.0;
    for (int b = 0; b < v->batches; b++) mean[i] += v->batch[i][b][m] / (periods * batches);
    sum += mean[i] / REPLICAS;
  }
  for (size_t i = 0; i < REPLICAS; i++) {
    between += (mean[i] - sum) * (mean[i] - sum) / (REPLICAS - 1.0);
    for (int b = 0; b < v->batches; b++) {
      const double d = v->batch[i][b][m] / periods - mean[i];
      within += d * d / (REPLICAS * (batches - 1.0));
    }
  }
  *ratio = between / (within / batches);
  return (pendres_chaos_mean){.value = sum,
                              .error = sqrt(fmax(between, within / batches) / REPLICAS)};
}

/* A standard error becomes half the confidence interval (Student's distribution). */
static pendres_chaos_mean confident(pendres_chaos_mean m)
{
  m.error *= pendres_student(chaos_confidence, REPLICAS - 1.0);
  return m;
}

/* Whether each replica by itself is chaotic. */
static int all_chaotic(const ensemble *v)
{
  for (size_t i = 0; i < REPLICAS; i++) {
    double growth = 0.0, latter = 0.0, off = 0.0;
    for (int b = 0; b < v->batches; b++) {
      growth += v->batch[i][b][PENDRES_REPLICA_GROWTH];
      off += v->batch[i][b][PENDRES_REPLICA_COARSE];
      if (b >= v->batches / 2) latter += v->batch[i][b][PENDRES_REPLICA_GROWTH];
    }
    if (pendres_growth_tell(growth, latter, fabs(off)) != PENDRES_GROWTH_CHAOS) return 0;
  }
  return 1;
}

/* Whether replicas differ by no more than chance, so that they are on one attractor. */
static int alike(const ensemble *v)
{
  static const pendres_replica_measure telling[] = {PENDRES_REPLICA_GROWTH, PENDRES_REPLICA_TURNS,
                                                   PENDRES_REPLICA_SPEED};
  for (size_t k = 0; k < sizeof telling / sizeof telling[0]; k++) {
    double ratio = 0.0;
    (void)mean_of(v, telling[k], &ratio);
    if (ratio > chaos_agreement) return 0;
  }
  return 1;
}

static pendres_open_measures measures_of(const pendres_attractor_set *c, const ensemble *v)
{
  double ratio = 0.0;
  /* A replica that leaves is recognised only after some time, which does not count as watched. */
  const double each = (double)v->length * v->batches;
  const double late = fmin((double)pendres_settle_first_budget(&c->pendulum), 0.5 * each);
  const double watched = REPLICAS * (each - late);
  pendres_open_measures m = {
    .label = PENDRES_LABEL_CHAOTIC,
    .x = NAN,
    .v = NAN,
    .growth = mean_of(v, PENDRES_REPLICA_GROWTH, &ratio),
    .work = confident(mean_of(v, PENDRES_REPLICA_WORK, &ratio)),
    .loss = confident(mean_of(v, PENDRES_REPLICA_LOSS, &ratio)),
    .amplitude = confident(mean_of(v, PENDRES_REPLICA_AMPLITUDE, &ratio)),
    .turns = confident(mean_of(v, PENDRES_REPLICA_TURNS, &ratio)),
    .watched_periods = watched,
    .escape_rate_bound = -log(1.0 - chaos_escape_confidence) / watched};
  m.growth.error += fabs(mean_of(v, PENDRES_REPLICA_COARSE, &ratio).value);
  /* In the long run friction dissipates the work of the drives and the torque. */
  const double other = mean_of(v, PENDRES_REPLICA_OTHER, &ratio).value;
  const double imbalance = fabs(m.work.value + other - m.loss.value);
  m.work.error += imbalance;
  m.loss.error += imbalance;
  return m;
}

/* ---- the verdict ---- */

/*
 * Whether replicas need not be followed further: they agree, and each by itself is chaotic. Before
 * all of their batches are over this is asked after 4, 6, 8, ... of them, and then the exponent
 * must also be as accurate as requested. Where any error of it will do, means are not asked for:
 * replicas that do not agree, such as those in the many bands of chaos next to its beginning, are
 * as chaotic.
 */
static int seen_enough(const pendres_context *ctx, const pendres_attractor_set *c,
                       const ensemble *v)
{
  const double wanted = ctx->options.exponent_error;
  if (v->batches < BATCHES) {
    if (v->batches < FEW_BATCHES || v->batches % 2 != 0) return 0;
    const pendres_chaos_mean growth = measures_of(c, v).growth;
    if (!(growth.error <= wanted * growth.value)) return 0;
  }
  return (wanted >= 1.0 || alike(v)) && all_chaotic(v);
}

/* The known chaotic attractor that more than half of the replicas' points lie on; NULL if none. */
static pendres_cover *known_cover(const pendres_attractor_set *c, const ensemble *v)
{
  pendres_cover *cover = NULL;
  for (size_t i = 0; i < c->covers; i++)
    if (share_within(c->cover[i], v) > 0.5) cover = c->cover[i];
  return cover;
}

/*
 * Watch replicas until one of them has left, or they turn out to be on an attractor that is known,
 * or they agree, or have been watched for as long as they may be. Then *verdict is NEW if each of
 * them is chaotic. Replicas that have gone to different attractors, such as
 * mirror images of each other, are sent out once more from where one of them is.
 */
static pendres_status watch(pendres_context *ctx, pendres_attractor_set *c, ensemble *v,
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
    const size_t left = trapped_replicas(v);
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
    if (seen_enough(ctx, c, v)) break;
    if (v->batches < BATCHES) continue;
    if (v->length == LONGEST_BATCH) break;
    merge_batches(v);
  }
  if (all_chaotic(v)) *verdict = PENDRES_CHAOS_NEW;
  return status;
}

pendres_status pendres_chaos_find(pendres_context *ctx, pendres_attractor_set *c, size_t n,
                                  const pendres_strobe_lane *const *lanes,
                                  pendres_chaos_verdict *verdict)
{
  pendres_replica suspect;
  int any = 0, together = 0;
  *verdict = PENDRES_CHAOS_NONE;
  if (n == 0 || c->covers == PENDRES_MOST_COVERS) return PENDRES_OK;
  pendres_status status = find_suspect(ctx, c, n, lanes, &suspect, &any);
  if (status != PENDRES_OK || !any) return status;

  ensemble *v = calloc(1, sizeof *v);
  if (v == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for chaotic motion");
  v->trace = (pendres_replica_trace){.length = KEPT, .y = v->y, .w = v->w};
  status = send_out(ctx, c, &suspect, v, &together);
  if (status == PENDRES_OK && !together) *verdict = PENDRES_CHAOS_TRANSIENT;
  if (status == PENDRES_OK && together) status = watch(ctx, c, v, verdict);
  if (status == PENDRES_OK && *verdict == PENDRES_CHAOS_NEW) {
    const pendres_open_measures m = measures_of(c, v);
    pendres_cover *cover = create_cover(&c->pendulum, v);
    status = cover != NULL
               ? pendres_attractor_set_add_open(ctx, c, &m, cover, NULL)
               : pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for chaos");
  }
  free(v);
  return status;
}
