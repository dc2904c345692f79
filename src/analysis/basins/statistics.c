/* statistics.c -- fractions, entropy and uncertainty exponent of grids; see basin.h. */
#include <pendres/basin.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/student.h"
#include "analysis/basins/scatter.h"
#include "analysis/basins/wells.h"

enum { BOX = PENDRES_BASIN_BOX, BOX_STATES = BOX * BOX };

/* The most that one state can change a box's entropy by: in a box whose other 24 states are alike,
   it is -1/25 log 1/25 - 24/25 log 24/25. The next one changes less. */
static const double state_entropy = 0.16794414;

typedef pendres_basin_member member;

struct pendres_basin_sums {
  size_t nx, nv, attractors;
  int scales;
  double step;        /* of v */
  size_t rows;        /* added so far */
  double *x_share, *v_share; /* of the window that belongs to each row and column of states */
  member *members;    /* the last three: what is unresolved, what escapes, and unstable rest */
  pendres_basin_end by;
  int64_t *box_rows;  /* ends of the rows of unfinished boxes */
  uint8_t *box_uncertain; /* states of them that are uncertain, by column */
  double group[PENDRES_SCATTER_QUANTITIES]; /* of the unfinished boxes' rows */
  double counts[PENDRES_BASIN_SCALES];      /* of uncertain states, over all rows */
  pendres_scatter scatter; /* between rows of boxes */
  size_t uncertain;        /* states that may belong elsewhere */
  double entropy_error, boundary_error; /* what these can change of boxes' entropy, and boxes */
  double suspect;          /* states that may be labelled wrongly, though it is not known which */
  pendres_basin_tally tally;
  pendres_basin_well *wells;
};

/* The share of the range from the first value to the last that belongs to each value: half the way
   to either neighbour. */
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
  if (grid == NULL || grid->nx < 1 || grid->nv < 1 || grid->x == NULL || grid->v == NULL ||
      attractors > INT16_MAX ||
      (grid->by != PENDRES_BASIN_BY_ATTRACTOR && grid->by != PENDRES_BASIN_BY_WELL))
    return PENDRES_INVALID_ARGUMENT;
  pendres_basin_sums *s = calloc(1, sizeof *s);
  if (s == NULL) return PENDRES_OUT_OF_MEMORY;
  s->nx = grid->nx;
  s->nv = grid->nv;
  s->attractors = attractors;
  s->by = grid->by;
  s->step = even_step(grid);
  while (s->step > 0.0 && s->scales < PENDRES_BASIN_SCALES &&
         (size_t)8 << s->scales <= grid->nv)
    s->scales++;
  s->x_share = shares_of(grid->nx, grid->x);
  s->v_share = shares_of(grid->nv, grid->v);
  s->members = calloc(attractors + 3, sizeof *s->members);
  s->box_rows = calloc(BOX * grid->nv, sizeof *s->box_rows);
  s->box_uncertain = calloc(grid->nv, sizeof *s->box_uncertain);
  if (s->x_share == NULL || s->v_share == NULL || s->members == NULL ||
      s->box_rows == NULL || s->box_uncertain == NULL) {
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
  free(s->box_rows);
  free(s->box_uncertain);
  free(s->wells);
  pendres_basin_tally_free(&s->tally);
  free(s);
}

/* ---- adding ---- */

/* How many states of the box from column `left` on are of each kind; the number of kinds. */
static int count_kinds(const pendres_basin_sums *s, size_t left, int *count)
{
  int64_t kind[BOX_STATES];
  int kinds = 0;
  for (size_t i = 0; i < BOX; i++)
    for (size_t j = left; j < left + BOX; j++) {
      const int64_t a = s->box_rows[i * s->nv + j];
      int k = 0;
      while (k < kinds && kind[k] != a) k++;
      if (k == kinds) {
        kind[kinds] = a;
        count[kinds++] = 0;
      }
      count[k]++;
    }
  return kinds;
}

/* What uncertain states can change: a box's entropy, and whether there is a boundary in it. */
static void add_uncertain(pendres_basin_sums *s, size_t left, int kinds, const int *count)
{
  int uncertain = 0, largest = count[0], smallest = count[0];
  for (size_t j = left; j < left + BOX; j++) uncertain += s->box_uncertain[j];
  if (uncertain == 0) return;
  for (int k = 1; k < kinds; k++) {
    if (count[k] > largest) largest = count[k];
    if (count[k] < smallest) smallest = count[k];
  }
  /* One state that goes from m to n of its box changes the entropy by log(m / n) / 25. */
  s->entropy_error +=
    uncertain * (kinds > 1 ? log((largest + 1.0) / smallest) / BOX_STATES : state_entropy);
  s->boundary_error += BOX_STATES - largest <= uncertain;
}

static void add_boxes(pendres_basin_sums *s)
{
  for (size_t left = 0; left + BOX <= s->nv; left += BOX) {
    int count[BOX_STATES];
    const int kinds = count_kinds(s, left, count);
    double entropy = 0.0;
    for (int k = 0; k < kinds; k++) {
      const double p = (double)count[k] / BOX_STATES;
      if (kinds > 1) entropy -= p * log(p);
    }
    s->group[PENDRES_SCATTER_ENTROPY] += entropy;
    s->group[PENDRES_SCATTER_BOUNDARY_BOXES] += kinds > 1;
    add_uncertain(s, left, kinds, count);
  }
  memset(s->box_uncertain, 0, s->nv * sizeof *s->box_uncertain);
}

/* Add a share of a row to that of the area, and its second difference to the scatter. */
static void add_share(const pendres_basin_sums *s, size_t row, member *m)
{
  const double share = m->row_share, bend = m->last[1] - 2.0 * m->last[0] + share;
  const double weight = row > 0 ? s->x_share[row - 1] : 0.0;
  m->share += s->x_share[row] * share;
  if (row >= 2) m->square += bend * bend * weight * weight;
  m->last[1] = m->last[0];
  m->last[0] = share;
  m->row_share = 0.0;
}

static void add_shares(pendres_basin_sums *s, size_t row)
{
  for (size_t a = 0; a <= s->attractors + 2; a++) add_share(s, row, &s->members[a]);
  for (size_t i = 0; i < s->tally.places; i++)
    if (s->tally.place[i].well.states > 0) add_share(s, row, &s->tally.place[i].sums);
}

/* How many states differ from one of those so far before and after them. A number or its negative
   has the highest bit set unless it is zero: without a comparison lanes count side by side. */
static void count_unlike(pendres_basin_sums *s, const int64_t *a)
{
  for (int k = 0; k < s->scales; k++) {
    const size_t far = (size_t)1 << k;
    const int64_t *before = a, *here = a + far, *after = here + far;
    const size_t n = s->nv > 2 * far ? s->nv - 2 * far : 0;
    uint64_t unlike = 0;
    for (size_t j = 0; j < n; j++) {
      const uint64_t off = (uint64_t)((before[j] ^ here[j]) | (after[j] ^ here[j]));
      unlike += (off | (0 - off)) >> 63;
    }
    s->group[k] += (double)unlike;
    s->counts[k] += (double)unlike;
  }
}

/* The attractor of a state; their number if it is unresolved, one more if it escapes, and two if it
   rests in an unstable state. */
static size_t attractor_of(const pendres_basin_sums *s, const pendres_basin_state *state)
{
  const int known = state->attractor >= 0 && (size_t)state->attractor < s->attractors;
  if (state->attractor == PENDRES_ATTRACTOR_ESCAPED) return s->attractors + 1;
  if (state->attractor == PENDRES_ATTRACTOR_UNSTABLE) return s->attractors + 2;
  return known ? (size_t)state->attractor : s->attractors;
}

/* A number for the end that a state comes to; equal ends have equal numbers. */
static int64_t end_of(const pendres_basin_sums *s, size_t attractor,
                      const pendres_basin_state *state)
{
  const int by_well = s->by == PENDRES_BASIN_BY_WELL && attractor < s->attractors;
  return (int64_t)attractor * (INT64_C(1) << 32) + (by_well ? state->well : 0);
}

/* Count the states of a row by attractor and well, a run of equal ones at a time. */
static pendres_status count_states(pendres_basin_sums *s, const pendres_basin_state *state)
{
  for (size_t j = 0, end; j < s->nv; j = end) {
    const size_t a = attractor_of(s, &state[j]);
    end = j + 1;
    while (end < s->nv && attractor_of(s, &state[end]) == a && state[end].well == state[j].well)
      end++;
    s->members[a].states += end - j;
    if (a >= s->attractors) continue;
    member *m = pendres_basin_tally_add(&s->tally, (int)a, state[j].well, end - j);
    if (m == NULL) return PENDRES_OUT_OF_MEMORY;
    for (size_t k = j; k < end; k++) {
      m->row_share += s->v_share[k];
      m->uncertain += state[k].how == PENDRES_BASIN_UNCERTAIN;
    }
    m->crossings += (j > 0) + (end < s->nv);
  }
  return PENDRES_OK;
}

static pendres_status add_row(pendres_basin_sums *s, const pendres_basin_state *state)
{
  const size_t row = s->rows++, slot = row % BOX;
  int64_t *ends = s->box_rows + slot * s->nv;
  for (size_t j = 0, last = 0; j < s->nv; j++) {
    const size_t a = attractor_of(s, &state[j]);
    ends[j] = end_of(s, a, &state[j]);
    s->members[a].row_share += s->v_share[j];
    if (state[j].how == PENDRES_BASIN_UNCERTAIN) {
      s->uncertain++;
      s->box_uncertain[j]++;
    }
    if (j > 0 && a != last) {
      s->members[a].crossings += 1.0;
      s->members[last].crossings += 1.0;
    }
    last = a;
  }
  const pendres_status status = count_states(s, state);
  if (status != PENDRES_OK) return status;
  add_shares(s, row);
  count_unlike(s, ends);
  if (slot == BOX - 1) {
    add_boxes(s);
    pendres_scatter_add(&s->scatter, s->group);
    memset(s->group, 0, sizeof s->group);
  }
  return PENDRES_OK;
}

pendres_status pendres_basin_sums_add(pendres_basin_sums *s, size_t rows,
                                      const pendres_basin_state *state)
{
  if (s == NULL || (rows > 0 && state == NULL) || rows > s->nx - s->rows)
    return PENDRES_INVALID_ARGUMENT;
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < rows && status == PENDRES_OK; i++)
    status = add_row(s, state + i * s->nv);
  return status;
}

pendres_status pendres_basin_sums_suspect(pendres_basin_sums *s, double states)
{
  if (s == NULL || !(states >= 0.0) || !isfinite(states)) return PENDRES_INVALID_ARGUMENT;
  s->suspect += states;
  return PENDRES_OK;
}

/* ---- results ---- */

/*
 * By how many states a basin may be too small or too large because n states are uncertain. These
 * lie on both sides of its boundaries and cancel but for their scatter. Twice that is claimed, and
 * a tenth of their number for what does not cancel.
 */
static double cancelled(double n)
{
  return fmin(n, 2.0 * sqrt(n) + 0.1 * n);
}

static double misplaced(const pendres_basin_sums *s, pendres_basin_end by)
{
  const size_t escaped = s->members[s->attractors + 1].states;
  const int ends = s->attractors > 1 || escaped > 0 || by == PENDRES_BASIN_BY_WELL;
  return ends ? cancelled((double)s->uncertain) : 0.0;
}

/*
 * The error of a share of the area: two standard errors from the scatter of rows around a trend. It
 * is not less than what follows from the ends of the basin on each row, which are uncertain by a
 * uniform share of a step, 1/sqrt(12) of it; twice that, since the boundary is as uncertain between
 * the rows. Where rows are too few for a scatter, it is half of their largest difference.
 */
static double fraction_error(const pendres_basin_sums *s, const member *m, double lost)
{
  const double states = (double)s->rows * (double)s->nv, n = (double)s->rows;
  const double ends = sqrt((m->crossings + 1.0) / 3.0) / states;
  const double uncertain =
    (lost + s->suspect) / states + s->members[s->attractors].share;
  if (s->rows == 1) return ends + uncertain;
  if (s->rows < 4) return ends + 0.5 * fabs(m->last[0] - m->last[1]) + uncertain;
  const double student = pendres_student(PENDRES_ONE_SIGMA, (n - 2.0) * 18.0 / 35.0);
  return fmax(ends, 2.0 * student * sqrt(m->square / 6.0 * n / (n - 2.0))) + uncertain;
}

/* The mean entropy over all boxes, and over those with a boundary. */
static void conclude_entropy(const pendres_basin_sums *s, pendres_basin_statistics *out)
{
  const double boxes = (double)s->scatter.groups * (double)(s->nv / BOX);
  const double entropy = s->scatter.total[PENDRES_SCATTER_ENTROPY];
  const double boundary = s->scatter.total[PENDRES_SCATTER_BOUNDARY_BOXES];
  const double all = (double)s->rows * (double)s->nv;
  /* Uncertain states lie on both sides of boundaries, as above; those that are suspect anywhere. */
  const double part = s->uncertain > 0 ? misplaced(s, s->by) / (double)s->uncertain : 0.0;
  const double suspect = state_entropy * s->suspect * boxes * BOX_STATES / all;
  double weight[PENDRES_SCATTER_QUANTITIES] = {0.0};
  out->boundary_boxes = out->entropy = out->entropy_error = NAN;
  out->boundary_entropy = out->boundary_entropy_error = NAN;
  if (boxes == 0.0) return;
  weight[PENDRES_SCATTER_ENTROPY] = 1.0 / boxes;
  out->boundary_boxes = boundary / boxes;
  out->entropy = entropy / boxes;
  out->entropy_error = sqrt(pendres_scatter_variance(&s->scatter, weight)) +
                       (part * s->entropy_error + suspect) / boxes;
  /* Nor is no boundary at all a certainty: one state may be unlike the others of its box. */
  if (out->entropy_error < state_entropy / boxes) out->entropy_error = state_entropy / boxes;
  if (boundary == 0.0) return;
  weight[PENDRES_SCATTER_ENTROPY] = 1.0 / boundary;
  weight[PENDRES_SCATTER_BOUNDARY_BOXES] = -entropy / (boundary * boundary);
  out->boundary_entropy = entropy / boundary;
  /* A suspect state changes the entropy of a box with a boundary, or makes another box with one, of
     the least entropy. */
  const double each = fmax(1.0, fabs(out->boundary_entropy / state_entropy - 1.0));
  out->boundary_entropy_error =
    sqrt(pendres_scatter_variance(&s->scatter, weight)) +
    (part * (s->entropy_error + out->boundary_entropy * s->boundary_error) + suspect * each) /
      boundary;
}

/* Shares of uncertain states by distance, and their exponent. */
static void conclude_exponent(const pendres_basin_sums *s, pendres_basin_statistics *out)
{
  const double rows = (double)s->rows, grouped = (double)(s->scatter.groups * BOX);
  pendres_scatter scatter = s->scatter;
  double tried[PENDRES_BASIN_SCALES];
  for (int k = 0; k < PENDRES_BASIN_SCALES; k++) {
    double weight[PENDRES_SCATTER_QUANTITIES] = {0.0};
    const int used = k < out->scales;
    tried[k] = used ? rows * (double)(s->nv - ((size_t)2 << k)) : NAN;
    weight[k] = 1.0;
    scatter.total[k] = s->counts[k]; /* rows that make no box as well */
    /* A state that is labelled wrongly makes itself and two others uncertain. */
    scatter.uncertain[k] = 3.0 * (double)s->uncertain;
    scatter.unknown[k] = 3.0 * (double)s->members[s->attractors].states;
    out->distance[k] = used ? s->step * (double)((size_t)1 << k) : NAN;
    out->uncertain[k] = used ? s->counts[k] / tried[k] : NAN;
    /* Rows at the end that make no box scatter like the others. */
    out->uncertain_error[k] =
      used ? sqrt(pendres_scatter_variance(&scatter, weight) * rows / grouped +
                  scatter.uncertain[k]) / tried[k] + scatter.unknown[k] / tried[k] +
               3.0 * s->suspect / ((double)s->nv * rows)
           : NAN;
    /* Not below one state in all of them: that none is unlike is no certainty. */
    if (out->uncertain_error[k] < 1.0 / tried[k]) out->uncertain_error[k] = 1.0 / tried[k];
  }
  pendres_scatter_exponent(&scatter, out->scales, out->distance, tried,
                           &out->uncertainty_exponent, &out->uncertainty_exponent_error);
}

pendres_status pendres_basin_sums_result(const pendres_basin_sums *s, pendres_basin_statistics *out,
                                         double *fraction, double *error)
{
  if (s == NULL || out == NULL || s->rows < s->nx) return PENDRES_INVALID_ARGUMENT;
  const double lost = misplaced(s, PENDRES_BASIN_BY_ATTRACTOR);
  const member *escaped = &s->members[s->attractors + 1];
  for (size_t a = 0; a < s->attractors; a++) {
    if (fraction != NULL) fraction[a] = s->members[a].share;
    if (error != NULL) error[a] = fraction_error(s, &s->members[a], lost);
  }
  *out = (pendres_basin_statistics){.states = s->rows * s->nv,
                                    .unresolved = s->members[s->attractors].states,
                                    .scales = s->scales,
                                    .uncertain_states = s->uncertain,
                                    .escaped = escaped->states,
                                    .escape_fraction = escaped->share,
                                    .escape_fraction_error = fraction_error(s, escaped, lost)};
  conclude_entropy(s, out);
  conclude_exponent(s, out);
  return PENDRES_OK;
}

pendres_status pendres_basin_sums_counts(const pendres_basin_sums *s, size_t *states)
{
  if (s == NULL || states == NULL || s->rows < s->nx) return PENDRES_INVALID_ARGUMENT;
  for (size_t a = 0; a < s->attractors; a++) states[a] = s->members[a].states;
  return PENDRES_OK;
}

pendres_status pendres_basin_sums_wells(pendres_basin_sums *s, size_t *n,
                                        const pendres_basin_well **wells)
{
  if (s == NULL || n == NULL || wells == NULL || s->rows < s->nx) return PENDRES_INVALID_ARGUMENT;
  *n = 0;
  *wells = NULL;
  pendres_basin_entry *entry = pendres_basin_tally_list(&s->tally);
  pendres_basin_well *list = malloc((s->tally.used + 1) * sizeof *list);
  if (entry == NULL || list == NULL) {
    free(entry);
    free(list);
    return PENDRES_OUT_OF_MEMORY;
  }
  for (size_t i = 0; i < s->tally.used; i++) {
    /* As many come to a well as leave it, but for their scatter: one more, if there are any. */
    const member *m = &entry[i].sums;
    const double lost = s->uncertain > 0 ? cancelled((double)m->uncertain + 1.0) : 0.0;
    list[i] = entry[i].well;
    list[i].fraction = m->share;
    list[i].fraction_error = fraction_error(s, m, lost);
  }
  free(entry);
  free(s->wells);
  s->wells = list;
  *n = s->tally.used;
  *wells = list;
  return PENDRES_OK;
}
