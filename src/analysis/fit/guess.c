/*
 * guess.c -- values to begin a fit with, from the balance of the first harmonic.
 *
 * A response of amplitude A at the drive F and the frequency w obeys about
 *   F^2 = A^2 ((K(A) - w^2)^2 + gamma^2 w^2),
 * where K is the stiffness of the force at that amplitude. That holds on every part of a resonance,
 * stable or not, so that it is enough to fit the logarithm of its two sides: no curve has to be
 * followed, and no jump to be told. It is a guess, no result: nothing depends on it but where a fit
 * begins.
 */
#include "analysis/fit/call.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_multifit_nlinear.h>

#include "base/angles.h"

/* Quantities that the balance tells. */
static const int told[] = {PENDRES_DAMPING, PENDRES_DRIVE_AMPLITUDE, PENDRES_A1, PENDRES_A3,
                           PENDRES_FIT_FREQUENCY_SCALE, PENDRES_FIT_DRIVE_SCALE,
                           PENDRES_FIT_AMPLITUDE_SCALE};
enum { TOLD = sizeof told / sizeof *told };

/* A datum as an amplitude, or as a loop area. */
typedef struct seen {
  double axis, other, size;
  int area;
} seen;

typedef struct guess {
  const fit_model *m;
  size_t n;
  seen data[FIT_GUESS_DATA];
  int unknowns, unknown[TOLD];
  int logarithm[TOLD]; /* it stays above 0 */
  double unit[TOLD];   /* of one that does not */
  fit_values v;
} guess;

/* ---- the balance ---- */

static void at_datum(const fit_model *m, const fit_values v, const seen *s, double *w, double *f)
{
  *w = v[PENDRES_DRIVE_FREQUENCY];
  *f = v[PENDRES_DRIVE_AMPLITUDE];
  if (m->axis == PENDRES_DRIVE_FREQUENCY) *w = pendres_fit_in(m, m->axis, v, s->axis);
  if (m->axis == PENDRES_DRIVE_AMPLITUDE) *f = pendres_fit_in(m, m->axis, v, s->axis);
  if (m->other == PENDRES_DRIVE_FREQUENCY) *w = pendres_fit_in(m, m->other, v, s->other);
  if (m->other == PENDRES_DRIVE_AMPLITUDE) *f = pendres_fit_in(m, m->other, v, s->other);
}

static double amplitude_of(const fit_values v, const seen *s, double w)
{
  return s->area ? sqrt(fabs(s->size) / (pi * v[PENDRES_DAMPING] * w))
                 : fabs(s->size - v[PENDRES_FIT_OFFSET]) / v[PENDRES_FIT_AMPLITUDE_SCALE];
}

/* The logarithm of one side over the other. */
static double imbalance(const fit_model *m, const fit_values v, const seen *s)
{
  double w, f;
  at_datum(m, v, s, &w, &f);
  const double a = amplitude_of(v, s, w);
  const double d = pendres_fit_stiffness(m, v, a) - w * w, e = v[PENDRES_DAMPING] * w;
  return log(f * f + 1e-300) - log(a * a * (d * d + e * e) + 1e-300);
}

static void take(const guess *g, const gsl_vector *x, fit_values v)
{
  memcpy(v, g->v, sizeof(fit_values));
  for (int k = 0; k < g->unknowns; k++) {
    const double at = gsl_vector_get(x, (size_t)k);
    v[g->unknown[k]] = g->logarithm[k] ? exp(fmin(fmax(at, -600.0), 600.0)) : at * g->unit[k];
  }
}

static int imbalances(const gsl_vector *x, void *arg, gsl_vector *out)
{
  const guess *g = arg;
  fit_values v;
  take(g, x, v);
  for (size_t i = 0; i < g->n; i++) {
    const double r = imbalance(g->m, v, &g->data[i]);
    gsl_vector_set(out, i, isfinite(r) ? r : 1e3);
  }
  return GSL_SUCCESS;
}

/* Improve v; returns the mean square that is left, or NaN without memory. */
static double improve(guess *g, fit_values v)
{
  enum { STEPS = 25 };
  double left = NAN;
  const size_t p = (size_t)g->unknowns;
  gsl_multifit_nlinear_parameters rules = gsl_multifit_nlinear_default_parameters();
  gsl_multifit_nlinear_workspace *w =
    gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &rules, g->n, p);
  gsl_vector *x = gsl_vector_alloc(p);
  gsl_multifit_nlinear_fdf rows = {.f = imbalances, .n = g->n, .p = p, .params = g};
  if (w != NULL && x != NULL) {
    int info;
    memcpy(g->v, v, sizeof g->v);
    for (int k = 0; k < g->unknowns; k++) {
      const double at = v[g->unknown[k]];
      g->logarithm[k] = at > 0.0 && g->unknown[k] != PENDRES_A3;
      g->unit[k] = at != 0.0 ? fabs(at) : 1.0;
      gsl_vector_set(x, (size_t)k, g->logarithm[k] ? log(at) : at / g->unit[k]);
    }
    int told = gsl_multifit_nlinear_init(x, &rows, w);
    left = told == GSL_ENOMEM ? NAN : INFINITY;
    if (told == GSL_SUCCESS) {
      told = gsl_multifit_nlinear_driver(STEPS, 1e-6, 1e-6, 1e-6, NULL, NULL, &info, w);
      take(g, gsl_multifit_nlinear_position(w), v);
      left = told == GSL_ENOMEM ? NAN : 0.0;
      for (size_t i = 0; i < g->n; i++) {
        const double r = gsl_vector_get(gsl_multifit_nlinear_residual(w), i);
        left += (isfinite(r) ? r * r : INFINITY) / (double)g->n;
      }
    }
  }
  gsl_vector_free(x);
  gsl_multifit_nlinear_free(w);
  return left;
}

/* ---- data ---- */

/* The data of a station as one amplitude; 0: they tell none. */
static int see(const fit_model *m, const fit_station *s, double other, seen *out)
{
  double part[2] = {NAN, NAN};
  *out = (seen){.axis = s->axis, .other = other, .size = NAN};
  for (size_t k = s->first; k < s->first + s->count; k++) {
    const pendres_fit_datum *d = &m->datum[m->order[k]];
    switch (d->observable) {
    case PENDRES_FIT_AMPLITUDE:
    case PENDRES_FIT_FIRST_HARMONIC: out->size = d->observed; out->area = 0; return 1;
    case PENDRES_FIT_RMS: out->size = d->observed * sqrt(2.0); out->area = 0; return 1;
    case PENDRES_FIT_LOOP_AREA: out->size = d->observed; out->area = 1; break;
    case PENDRES_FIT_IN_PHASE: part[0] = d->observed; break;
    case PENDRES_FIT_QUADRATURE: part[1] = d->observed; break;
    default: break;
    }
  }
  if (!isnan(part[0]) && !isnan(part[1])) {
    out->size = hypot(part[0], part[1]);
    out->area = 0;
  }
  return isfinite(out->size);
}

/* The larger data, at most FIT_GUESS_DATA, evenly chosen; the largest comes first. */
static void look(guess *g)
{
  const fit_model *m = g->m;
  double largest = 0.0;
  size_t good = 0;
  seen s, top = {0.0, 0.0, 0.0, 0};
  for (int pass = 0; pass < 3; pass++) {
    size_t number = 0;
    const size_t every = good / (FIT_GUESS_DATA - 1) + 1;
    for (size_t k = 0; k < m->tracks; k++)
      for (size_t i = m->track[k].first; i < m->track[k].first + m->track[k].count; i++) {
        if (!see(m, &m->station[i], m->curve[m->track[k].curve].other, &s)) continue;
        if (pass == 0 && fabs(s.size) > largest) {
          largest = fabs(s.size);
          top = s;
        }
        if (pass == 0 || fabs(s.size) < fit_guess_least * largest) continue;
        if (pass == 1) good++;
        else if (number++ % every == 0 && g->n < FIT_GUESS_DATA) g->data[g->n++] = s;
      }
    if (pass == 0 && largest > 0.0) g->data[g->n++] = top;
  }
}

/* ---- where to begin ---- */

static int is_open(const fit_values v, int q)
{
  return isnan(v[q]);
}

/* A start: what is chosen of the values, and how well the rest fits then. */
typedef struct start {
  fit_values v;
  double left;
  int place;
} start;

/* Set what follows from the place of the small resonance and, unless it is NaN, from the largest
   amplitude: the backbone goes through the largest datum. */
static void set_backbone(const guess *g, double place, double high, fit_values v)
{
  const fit_model *m = g->m;
  const seen *top = &g->data[0];
  const int polynomial = m->base.force == PENDRES_FORCE_POLYNOMIAL;
  double w, f;
  if (is_open(v, PENDRES_FIT_FREQUENCY_SCALE)) {
    if (is_open(v, PENDRES_A1)) v[PENDRES_A1] = polynomial;
    const double small = v[PENDRES_A1] + !polynomial;
    v[PENDRES_FIT_FREQUENCY_SCALE] = place / sqrt(fabs(small) + 1e-300);
  }
  at_datum(m, v, top, &w, &f);
  if (is_open(v, PENDRES_A1))
    v[PENDRES_A1] = (m->axis == PENDRES_DRIVE_FREQUENCY
                       ? pow(pendres_fit_in(m, m->axis, v, place), 2.0) : place * w * w) -
                    !polynomial;
  const double bent = w * w - v[PENDRES_A1] - !polynomial;
  const double curvature = polynomial ? 0.75 * v[PENDRES_A3] : -0.125;
  if (is_open(v, PENDRES_FIT_AMPLITUDE_SCALE)) {
    double a = bent / curvature > 0.0 ? fmin(2.5, sqrt(bent / curvature)) : 1.0;
    if (!isnan(high)) a = high;
    v[PENDRES_FIT_AMPLITUDE_SCALE] = fabs(top->size) / (isfinite(a) && a > 1e-9 ? a : 1.0);
  }
  if (is_open(v, PENDRES_A3)) {
    if (is_open(v, PENDRES_DAMPING) && top->area) v[PENDRES_DAMPING] = 0.1;
    const double a = amplitude_of(v, top, w);
    v[PENDRES_A3] = bent / (0.75 * a * a);
  }
}

/* Drive and damping, whose squares enter the balance as they are: its least squares. */
static void set_linear(const guess *g, fit_values v)
{
  const fit_model *m = g->m;
  const int scaled = m->axis == PENDRES_DRIVE_AMPLITUDE || m->other == PENDRES_DRIVE_AMPLITUDE;
  const int drive = scaled ? (int)PENDRES_FIT_DRIVE_SCALE : (int)PENDRES_DRIVE_AMPLITUDE;
  const int open_drive = is_open(v, drive), open_damping = is_open(v, PENDRES_DAMPING);
  double a11 = 0.0, a12 = 0.0, a22 = 0.0, b1 = 0.0, b2 = 0.0;
  fit_values at;
  memcpy(at, v, sizeof at);
  if (open_drive) at[drive] = 1.0;
  for (size_t i = 0; i < g->n; i++) {
    double w, f;
    at_datum(m, at, &g->data[i], &w, &f);
    const double a = amplitude_of(at, &g->data[i], w), d = pendres_fit_stiffness(m, at, a) - w * w;
    /* f^2 drive^2 - (a w)^2 gamma^2 = (a d)^2 */
    const double p = f * f, q = -a * a * w * w;
    const double known = a * a * d * d - (open_drive ? 0.0 : p) -
                         (open_damping ? 0.0 : q * at[PENDRES_DAMPING] * at[PENDRES_DAMPING]);
    a11 += p * p;
    a12 += p * q;
    a22 += q * q;
    b1 += p * known;
    b2 += q * known;
  }
  const double det = a11 * a22 - a12 * a12;
  const double both[2] = {(b1 * a22 - b2 * a12) / det, (a11 * b2 - a12 * b1) / det};
  if (open_drive) v[drive] = sqrt(fabs(open_damping ? both[0] : b1 / a11));
  if (open_damping) v[PENDRES_DAMPING] = sqrt(fabs(open_drive ? both[1] : b2 / a22));
}

static double imbalance_of(const guess *g, const fit_values v)
{
  double sum = 0.0;
  for (size_t i = 0; i < g->n; i++) {
    const double r = imbalance(g->m, v, &g->data[i]);
    /* What is far off counts little: data may be of another resonance. */
    sum += fmin(r * r, 9.0) / (double)g->n;
  }
  return isfinite(sum) ? sum : INFINITY;
}

/* Places of the small resonance over the range of the data and as far again. Where the frequency is
   not what is swept, its square over that of the drive. */
static double place_of(const guess *g, int k)
{
  double low = INFINITY, high = -INFINITY;
  if (g->m->axis != PENDRES_DRIVE_FREQUENCY)
    return pow(2.0, (k - FIT_GUESS_PLACES / 2) * 6.0 / FIT_GUESS_PLACES);
  for (size_t i = 0; i < g->m->curves; i++) {
    low = fmin(low, g->m->curve[i].from);
    high = fmax(high, g->m->curve[i].to);
  }
  const double span = high - low;
  return fmax(low + span * (2.0 * k / (FIT_GUESS_PLACES - 1.0) - 0.5), 0.1 * low);
}

/* Put a start among the best, of which neighbours count as one. */
static int rank(start *best, int count, const start *s)
{
  for (int i = 0; i < count; i++)
    if (abs(best[i].place - s->place) < 2) {
      if (!(s->left < best[i].left)) return count;
      memmove(&best[i], &best[i + 1], (size_t)(count - i - 1) * sizeof *best);
      count--;
      break;
    }
  int at = count;
  while (at > 0 && best[at - 1].left > s->left) at--;
  if (at >= FIT_GUESS_STARTS) return count;
  const int last = count < FIT_GUESS_STARTS ? count : FIT_GUESS_STARTS - 1;
  memmove(&best[at + 1], &best[at], (size_t)(last - at) * sizeof *best);
  best[at] = *s;
  return last + 1;
}

/* Keep a set among the best, unless it is one of them. */
static int keep(fit_values *out, double *cost, int count, const fit_values v, double left)
{
  int at = count;
  for (int i = 0; i < count; i++)
    if (fabs(left - cost[i]) < 1e-3 * (left + cost[i])) return count;
  while (at > 0 && cost[at - 1] > left) at--;
  if (at >= FIT_GUESSES || !isfinite(left)) return count;
  const int last = count < FIT_GUESSES ? count : FIT_GUESSES - 1;
  for (int i = last; i > at; i--) {
    memcpy(out[i], out[i - 1], sizeof(fit_values));
    cost[i] = cost[i - 1];
  }
  memcpy(out[at], v, sizeof(fit_values));
  cost[at] = left;
  return last + 1;
}

static int search(const guess *g, const fit_values v, start *best)
{
  const int placed = !is_open(v, PENDRES_FIT_FREQUENCY_SCALE) && !is_open(v, PENDRES_A1);
  const int sized = !is_open(v, PENDRES_FIT_AMPLITUDE_SCALE);
  int count = 0;
  for (int i = 0; i < (placed ? 1 : FIT_GUESS_PLACES); i++)
    for (int k = 0; k < (sized ? 1 : FIT_GUESS_SIZES); k++) {
      start s = {.place = placed ? 2 * k : i};
      memcpy(s.v, v, sizeof s.v);
      set_backbone(g, place_of(g, i), k == 0 ? NAN : pow(10.0, 0.75 - 0.25 * k), s.v);
      for (int q = 0; q < FIT_QUANTITIES; q++)
        if (isnan(s.v[q]) && q != PENDRES_DAMPING && q != PENDRES_DRIVE_AMPLITUDE &&
            q != PENDRES_FIT_DRIVE_SCALE)
          s.v[q] = 0.0;
      set_linear(g, s.v);
      s.left = imbalance_of(g, s.v);
      if (isfinite(s.left)) count = rank(best, count, &s);
    }
  return count;
}

int pendres_fit_guess(const fit_model *m, const fit_values v, fit_values out[FIT_GUESSES])
{
  guess g = {.m = m};
  start best[FIT_GUESS_STARTS + 1];
  double cost[FIT_GUESSES];
  int count = 0;
  look(&g);
  for (int k = 0; k < TOLD; k++)
    if (is_open(v, told[k])) g.unknown[g.unknowns++] = told[k];
  /* Where all that the balance tells is known, what it does not tell begins at 0. */
  if (g.unknowns == 0) memcpy(out[0], v, sizeof out[0]);
  if (g.n <= (size_t)g.unknowns || g.unknowns == 0) return g.unknowns == 0;
  const int starts = search(&g, v, best);
  for (int i = 0; i < starts; i++) {
    /* What noise makes of the logarithms may be worse than where it began. */
    if (i < FIT_GUESS_RAW) count = keep(out, cost, count, best[i].v, best[i].left);
    const double left = improve(&g, best[i].v);
    if (isnan(left)) return -1;
    count = keep(out, cost, count, best[i].v, left);
  }
  return count;
}
