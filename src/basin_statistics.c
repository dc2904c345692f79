/* basin_statistics.c -- fractions, entropy and uncertainty exponent of basins; see basin.h. */
#include <pendres/basin.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "attractor_internal.h"
#include "context_internal.h"
#include "settle.h"

enum {
  LEAST_COUNT = 25,  /* uncertain states that make a share worth fitting */
  LEAST_SCALES = 3,  /* of them that make an exponent */
  MOST_SCALES = 5,
  SAMPLES_AT_A_TIME = 4096
};

/* Shares above this feel that boundaries are less far apart than the distance. */
static const double most_uncertain = 0.5;

/* Sums of one strip of rows, or of one part of a sample. */
typedef struct strip {
  double boxes, boundary_boxes;
  double entropy; /* summed over boxes; those without a boundary have none */
  double tried[PENDRES_BASIN_SCALES], uncertain[PENDRES_BASIN_SCALES];
} strip;

struct pendres_basin_sums {
  size_t nx, nv, attractors;
  int scales;
  double step;        /* of v */
  size_t rows;        /* added so far */
  size_t unresolved;
  double *x_share, *v_share; /* of the window that belongs to each row and column of states */
  double *members;    /* share of each attractor; the last entry: unresolved */
  double *crossings;  /* along v, where each attractor's basin begins or ends */
  int16_t *box_rows;  /* attractors of the rows of unfinished boxes */
  strip strips[PENDRES_BASIN_STRIPS];
};

/* Shares of the range from the first value to the last: half the way to either neighbour. */
static double *shares_of(size_t n, const double *values)
{
  double *share = malloc(n * sizeof *share);
  const double range = values[n - 1] - values[0];
  if (share == NULL) return NULL;
  for (size_t i = 0; i < n; i++) {
    const double left = values[i > 0 ? i - 1 : 0], right = values[i + 1 < n ? i + 1 : n - 1];
    share[i] = range != 0.0 ? 0.5 * (right - left) / range : 1.0 / (double)n;
  }
  return share;
}

/* The step of v, 0 if its values are not evenly spaced to a thousandth of it. */
static double even_step(const pendres_basin_grid *grid)
{
  if (grid->nv < 2) return 0.0;
  const double step = (grid->v[grid->nv - 1] - grid->v[0]) / (double)(grid->nv - 1);
  for (size_t j = 1; j < grid->nv; j++)
    if (fabs(grid->v[j] - grid->v[j - 1] - step) > 1e-3 * fabs(step)) return 0.0;
  return fabs(step);
}

pendres_status pendres_basin_sums_create(const pendres_basin_grid *grid, size_t attractors,
                                         pendres_basin_sums **out)
{
  if (out == NULL) return PENDRES_INVALID_ARGUMENT;
  *out = NULL;
  if (grid == NULL || grid->nx < 1 || grid->nv < 1 || attractors > INT16_MAX)
    return PENDRES_INVALID_ARGUMENT;
  pendres_basin_sums *s = calloc(1, sizeof *s);
  if (s == NULL) return PENDRES_OUT_OF_MEMORY;
  s->nx = grid->nx;
  s->nv = grid->nv;
  s->attractors = attractors;
  s->step = even_step(grid);
  while (s->step > 0.0 && s->scales < PENDRES_BASIN_SCALES &&
         (size_t)8 << s->scales <= grid->nv)
    s->scales++;
  s->x_share = shares_of(grid->nx, grid->x);
  s->v_share = shares_of(grid->nv, grid->v);
  s->members = calloc(attractors + 1, sizeof *s->members);
  s->crossings = calloc(attractors + 1, sizeof *s->crossings);
  s->box_rows = calloc(PENDRES_BASIN_BOX * grid->nv, sizeof *s->box_rows);
  if (s->x_share == NULL || s->v_share == NULL || s->members == NULL || s->crossings == NULL ||
      s->box_rows == NULL) {
    pendres_basin_sums_free(s);
    return PENDRES_OUT_OF_MEMORY;
  }
  *out = s;
  return PENDRES_OK;
}

void pendres_basin_sums_free(pendres_basin_sums *s)
{
  if (s == NULL) return;
  free(s->x_share);
  free(s->v_share);
  free(s->members);
  free(s->crossings);
  free(s->box_rows);
  free(s);
}

/* ---- adding ---- */

/* Entropy of a box of PENDRES_BASIN_BOX rows from column `left` on; 0 if all are alike. */
static double box_entropy(const pendres_basin_sums *s, size_t left)
{
  enum { STATES = PENDRES_BASIN_BOX * PENDRES_BASIN_BOX };
  int16_t kind[STATES];
  int count[STATES], kinds = 0;
  for (size_t i = 0; i < PENDRES_BASIN_BOX; i++)
    for (size_t j = left; j < left + PENDRES_BASIN_BOX; j++) {
      const int16_t a = s->box_rows[i * s->nv + j];
      int k = 0;
      while (k < kinds && kind[k] != a) k++;
      if (k == kinds) {
        kind[kinds] = a;
        count[kinds++] = 0;
      }
      count[k]++;
    }
  double sum = 0.0;
  for (int k = 0; k < kinds && kinds > 1; k++) {
    const double p = (double)count[k] / STATES;
    sum -= p * log(p);
  }
  return sum;
}

static void add_boxes(pendres_basin_sums *s, strip *t)
{
  for (size_t left = 0; left + PENDRES_BASIN_BOX <= s->nv; left += PENDRES_BASIN_BOX) {
    const double entropy = box_entropy(s, left);
    t->boxes += 1.0;
    t->boundary_boxes += entropy > 0.0;
    t->entropy += entropy;
  }
}

static void add_row(pendres_basin_sums *s, const pendres_basin_state *state)
{
  const size_t row = s->rows++, slot = row % PENDRES_BASIN_BOX;
  int16_t *a = s->box_rows + slot * s->nv;
  strip *t = &s->strips[row * PENDRES_BASIN_STRIPS / s->nx];
  for (size_t j = 0; j < s->nv; j++) {
    const int known = state[j].attractor >= 0 && (size_t)state[j].attractor < s->attractors;
    a[j] = known ? state[j].attractor : (int16_t)s->attractors;
    s->members[a[j]] += s->x_share[row] * s->v_share[j];
    s->unresolved += !known;
    if (j > 0 && a[j] != a[j - 1]) {
      s->crossings[a[j]] += 1.0;
      s->crossings[a[j - 1]] += 1.0;
    }
  }
  for (int k = 0; k < s->scales; k++) {
    const size_t far = (size_t)1 << k;
    size_t unlike = 0;
    for (size_t j = far; j + far < s->nv; j++)
      unlike += a[j - far] != a[j] || a[j + far] != a[j];
    t->tried[k] += (double)(s->nv - 2 * far);
    t->uncertain[k] += (double)unlike;
  }
  if (slot == PENDRES_BASIN_BOX - 1) add_boxes(s, t);
}

pendres_status pendres_basin_sums_add(pendres_basin_sums *s, size_t rows,
                                      const pendres_basin_state *state)
{
  if (s == NULL || (rows > 0 && state == NULL) || rows > s->nx - s->rows)
    return PENDRES_INVALID_ARGUMENT;
  for (size_t i = 0; i < rows; i++) add_row(s, state + i * s->nv);
  return PENDRES_OK;
}

/* ---- results ---- */

/* A number made of the sums of all strips but one; -1: of all. */
typedef double estimate(const strip *strips, int without, const double *distance);

static strip total(const strip *strips, int without)
{
  strip t = {0};
  for (int i = 0; i < PENDRES_BASIN_STRIPS; i++) {
    if (i == without) continue;
    t.boxes += strips[i].boxes;
    t.boundary_boxes += strips[i].boundary_boxes;
    t.entropy += strips[i].entropy;
    for (int k = 0; k < PENDRES_BASIN_SCALES; k++) {
      t.tried[k] += strips[i].tried[k];
      t.uncertain[k] += strips[i].uncertain[k];
    }
  }
  return t;
}

static double mean_entropy(const strip *strips, int without, const double *distance)
{
  const strip t = total(strips, without);
  (void)distance;
  return t.boxes > 0.0 ? t.entropy / t.boxes : NAN;
}

static double mean_boundary_entropy(const strip *strips, int without, const double *distance)
{
  const strip t = total(strips, without);
  (void)distance;
  return t.boundary_boxes > 0.0 ? t.entropy / t.boundary_boxes : NAN;
}

/* Whether a share is well known and small enough to be a power of the distance. */
static int usable(const strip *t, int k)
{
  return t->uncertain[k] >= LEAST_COUNT && t->uncertain[k] <= most_uncertain * t->tried[k];
}

/* Slope of log share against log distance over the scales first, ... last - 1; NaN if fewer than
   `least` of them are usable. */
static double slope(const strip *t, const double *distance, int first, int last, int least)
{
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (int k = first; k < last; k++) {
    if (!usable(t, k)) continue;
    const double a = log(distance[k]), b = log(t->uncertain[k] / t->tried[k]);
    n += 1.0;
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  return n >= least ? (n * xy - x * y) / (n * xx - x * x) : NAN;
}

/* The exponent is a limit of small distances: the smallest usable ones. */
static void fit_range(const strip *t, int *first, int *last)
{
  *first = *last = 0;
  for (int k = 0; k < PENDRES_BASIN_SCALES && *last - *first < MOST_SCALES; k++) {
    if (!usable(t, k)) continue;
    if (*last == 0) *first = k;
    *last = k + 1;
  }
}

static double exponent(const strip *strips, int without, const double *distance)
{
  const strip t = total(strips, without);
  int first, last;
  fit_range(&t, &first, &last);
  return slope(&t, distance, first, last, LEAST_SCALES);
}

/* Jackknife: Efron and Stein, Annals of Statistics 9 (1981) 586. */
static double jackknife(estimate *f, const strip *strips, const double *distance)
{
  const int n = PENDRES_BASIN_STRIPS;
  double value[PENDRES_BASIN_STRIPS], mean = 0.0, squares = 0.0;
  for (int i = 0; i < n; i++) {
    value[i] = f(strips, i, distance);
    mean += value[i] / n;
  }
  for (int i = 0; i < n; i++) squares += (value[i] - mean) * (value[i] - mean);
  return sqrt(squares * (n - 1.0) / n);
}

/*
 * The exponent with its error: the jackknife's, and how far the slopes between neighbouring scales
 * are from it, since a share is a power of the distance only within limits.
 */
static void fit(const strip *strips, pendres_basin_statistics *out)
{
  const strip t = total(strips, -1);
  int first, last;
  double bend = 0.0;
  for (int k = 0; k < PENDRES_BASIN_SCALES; k++) {
    const double share = k < out->scales && t.tried[k] > 0.0 ? t.uncertain[k] / t.tried[k] : NAN;
    out->uncertain[k] = share;
    out->uncertain_error[k] = k < out->scales ? sqrt(share * (1.0 - share) / t.tried[k]) : NAN;
  }
  out->uncertainty_exponent = exponent(strips, -1, out->distance);
  out->uncertainty_exponent_error = NAN;
  if (isnan(out->uncertainty_exponent)) return;
  fit_range(&t, &first, &last);
  for (int k = first; k + 1 < last; k++) {
    const double local = slope(&t, out->distance, k, k + 2, 2);
    if (isfinite(local)) bend = fmax(bend, fabs(local - out->uncertainty_exponent));
  }
  out->uncertainty_exponent_error = hypot(jackknife(exponent, strips, out->distance), bend);
}

pendres_status pendres_basin_sums_result(const pendres_basin_sums *s, pendres_basin_statistics *out,
                                         double *fraction, double *error)
{
  if (s == NULL || out == NULL || s->rows < s->nx) return PENDRES_INVALID_ARGUMENT;
  const double states = (double)s->rows * (double)s->nv;
  const double lost = s->members[s->attractors];
  for (size_t a = 0; a < s->attractors; a++) {
    if (fraction != NULL) fraction[a] = s->members[a];
    /* A basin's end on a row is uncertain by a uniform share of a step, 1/sqrt(12) of it; twice
       that, since the boundary is as uncertain between the rows. */
    if (error != NULL) error[a] = sqrt((s->crossings[a] + 1.0) / 3.0) / states + lost;
  }
  *out = (pendres_basin_statistics){.states = s->rows * s->nv,
                                    .unresolved = s->unresolved,
                                    .scales = s->scales};
  for (int k = 0; k < PENDRES_BASIN_SCALES; k++)
    out->distance[k] = k < s->scales ? s->step * (double)((size_t)1 << k) : NAN;
  const strip t = total(s->strips, -1);
  out->boundary_boxes = t.boxes > 0.0 ? t.boundary_boxes / t.boxes : NAN;
  out->entropy = mean_entropy(s->strips, -1, NULL);
  out->entropy_error = jackknife(mean_entropy, s->strips, NULL);
  out->boundary_entropy = mean_boundary_entropy(s->strips, -1, NULL);
  out->boundary_entropy_error = jackknife(mean_boundary_entropy, s->strips, NULL);
  fit(s->strips, out);
  return PENDRES_OK;
}

/* ---- random states ---- */

/* The bits of splitmix64 (Steele, Lea, Flood, OOPSLA 2014), as a number in [0, 1). */
static double uniform(uint64_t seed, uint64_t counter)
{
  uint64_t z = seed * UINT64_C(0xd1342543de82ef95) + (counter + 1) * UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/* Count one state and its neighbours: outcome[0] its own, then two a distance. */
static void count_sample(strip *t, int scales, const pendres_outcome *outcome)
{
  for (int k = 0; k < scales; k++) {
    t->tried[k] += 1.0;
    t->uncertain[k] += outcome[1 + 2 * k].attractor != outcome[0].attractor ||
                       outcome[2 + 2 * k].attractor != outcome[0].attractor;
  }
}

static pendres_status basin_uncertainty(pendres_context *ctx, const pendres_attractors *set,
                                        const pendres_basin_window *window, size_t n, int scales,
                                        const double *distance, uint64_t seed,
                                        pendres_basin_statistics *out)
{
  if (set == NULL || window == NULL || distance == NULL || out == NULL)
    return PENDRES_CONTEXT_NULL(ctx, "attractors, window, distance and out");
  if (n < PENDRES_BASIN_STRIPS || scales < LEAST_SCALES || scales > PENDRES_BASIN_SCALES ||
      set->sets != 1)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "an uncertainty exponent needs states and at least %d distances",
                                LEAST_SCALES);
  const size_t each = 1 + 2 * (size_t)scales, room = SAMPLES_AT_A_TIME * each;
  strip strips[PENDRES_BASIN_STRIPS] = {{0}};
  pendres_status status = PENDRES_OK;
  double *x = calloc(room, sizeof *x), *v = calloc(room, sizeof *v);
  pendres_outcome *outcome = malloc(room * sizeof *outcome);
  *out = (pendres_basin_statistics){.states = n, .scales = scales,
                                    .entropy = NAN, .entropy_error = NAN, .boundary_entropy = NAN,
                                    .boundary_entropy_error = NAN, .boundary_boxes = NAN};
  for (int k = 0; k < PENDRES_BASIN_SCALES; k++)
    out->distance[k] = k < scales ? distance[k] : NAN;
  if (x == NULL || v == NULL || outcome == NULL) {
    status = pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for random states");
    goto done;
  }
  for (size_t first = 0; first < n && status == PENDRES_OK; first += SAMPLES_AT_A_TIME) {
    const size_t count = n - first < SAMPLES_AT_A_TIME ? n - first : SAMPLES_AT_A_TIME;
    for (size_t i = 0; i < count; i++) {
      const uint64_t counter = 2 * (uint64_t)(first + i);
      for (size_t k = 0; k < each; k++)
        x[i * each + k] =
          window->x_low + (window->x_high - window->x_low) * uniform(seed, counter);
      double *one = &v[i * each];
      one[0] = window->v_low + (window->v_high - window->v_low) * uniform(seed, counter + 1);
      for (int k = 0; k < scales; k++) {
        one[1 + 2 * k] = one[0] - distance[k];
        one[2 + 2 * k] = one[0] + distance[k];
      }
    }
    status = pendres_settle_known(ctx, set->catalogues, count * each, x, v,
                                  10.0 * ctx->options.tolerance, PENDRES_SETTLE_FULL, outcome);
    for (size_t i = 0; i < count && status == PENDRES_OK; i++) {
      out->unresolved += outcome[i * each].attractor < 0;
      count_sample(&strips[(first + i) % PENDRES_BASIN_STRIPS], scales, &outcome[i * each]);
    }
  }
  if (status != PENDRES_OK) goto done;
  fit(strips, out);
  if (isnan(out->uncertainty_exponent))
    status = pendres_context_fail(ctx, PENDRES_NOT_FOUND,
                                  "at too few of the distances the boundary is met often enough, "
                                  "and by fewer than half of the states");
done:
  free(x);
  free(v);
  free(outcome);
  return status;
}

pendres_status pendres_basin_uncertainty(pendres_context *ctx, const pendres_attractors *set,
                                         const pendres_basin_window *window, size_t n, int scales,
                                         const double *distance, uint64_t seed,
                                         pendres_basin_statistics *out)
{
  return PENDRES_CONTEXT_CALL(ctx, basin_uncertainty(ctx, set, window, n, scales, distance, seed,
                                                     out));
}
