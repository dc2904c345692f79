/*
 * find.c -- a resonance in scattering parameters, from data alone; see line.h.
 *
 * Without the cable what the resonance adds, D = S - far, obeys f - place - bend |D|^2 = residue/D:
 * linear in what is sought where `far` is known, whatever parts of a bent resonance the data are
 * on, jumps included. So that is fitted by linear least squares, weighed by what noise does to 1/D,
 * in turn with far and residue at the places that follow. The delay is the one of many, about the
 * slope of the phase, that leaves least.
 */
#include "analysis/line/line.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "analysis/line/numbers.h"
#include "base/angles.h"

enum { UNKNOWNS = 3 };

/* What is looked for, and in which range of frequencies. */
typedef struct search {
  int leaks, far, bent; /* something is far, and begins at the edges of the data; is it bent */
  double low, high;
} search;

/* Solve n normal equations; 0: they are singular. */
static int solve(int n, double complex a[UNKNOWNS][UNKNOWNS + 1])
{
  for (int i = 0; i < n; i++) {
    int best = i;
    for (int r = i + 1; r < n; r++)
      if (cabs(a[r][i]) > cabs(a[best][i])) best = r;
    if (!(cabs(a[best][i]) > 0.0)) return 0;
    for (int c = 0; c <= UNKNOWNS && best != i; c++) {
      const double complex t = a[i][c];
      a[i][c] = a[best][c];
      a[best][c] = t;
    }
    for (int r = 0; r < n; r++) {
      const double complex f = a[r][i] / a[i][i];
      for (int c = i; c <= UNKNOWNS && r != i; c++) a[r][c] -= f * a[i][c];
    }
  }
  for (int i = 0; i < n; i++) a[i][UNKNOWNS] /= a[i][i];
  return 1;
}

/* One more row of least squares: coefficients of the unknowns, and what they are to make. */
static void add(int n, const double complex *row, double complex right,
                double complex a[UNKNOWNS][UNKNOWNS + 1])
{
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < n; k++) a[i][k] += conj(row[i]) * row[k];
    a[i][UNKNOWNS] += conj(row[i]) * right;
  }
}

/* |D|^2 times that of the drive, of a datum. */
static double power_of(const pendres_line_data *d, const pendres_line_guess *g, size_t i)
{
  const double complex off = d->work[i] - g->far;
  return creal(off * conj(off)) * d->drive[i] * d->drive[i];
}

/* Place and bend for what is far: D (f - place - bend p) = residue. Residuals are those of S where
   they are divided by the bracket, which the last place tells; at first, without one, large D
   weigh most. */
static int find_place(const pendres_line_data *d, int bent, pendres_line_guess *g)
{
  double complex a[UNKNOWNS][UNKNOWNS + 1] = {{0.0}};
  const int first = !(cimag(g->place) > 0.0);
  for (size_t i = 0; i < d->n; i++) {
    const double complex off = d->work[i] - g->far;
    const double p = power_of(d, g, i);
    const double w = first ? cabs(off) : 1.0 / cabs(d->f[i] - g->place - g->bend * p);
    add(2 + bent, (double complex[]){w * off, w, w * p * off}, w * off * d->f[i], a);
  }
  if (!solve(2 + bent, a)) return 0;
  g->place = a[0][UNKNOWNS];
  g->bend = bent ? creal(a[2][UNKNOWNS]) : 0.0;
  return isfinite(cabs(g->place)) && isfinite(g->bend) && cimag(g->place) > 0.0;
}

/* What is far, and the residue, for places; and what is left. */
static int find_far(const pendres_line_data *d, int leaks, pendres_line_guess *g)
{
  double complex a[UNKNOWNS][UNKNOWNS + 1] = {{0.0}};
  const pendres_line_guess before = *g;
  for (int pass = 0; pass < 2; pass++) {
    g->left = 0.0;
    for (size_t i = 0; i < d->n; i++) {
      const double complex each =
        1.0 / (d->f[i] - g->place - g->bend * power_of(d, &before, i));
      if (pass == 0) add(1 + leaks, (double complex[]){each, 1.0}, d->work[i], a);
      else g->left += pow(cabs(d->work[i] - g->far - g->residue * each), 2.0) / (double)d->n;
    }
    if (pass == 0 && !solve(1 + leaks, a)) return 0;
    if (pass == 0) g->residue = a[0][UNKNOWNS];
    if (pass == 0 && leaks) g->far = a[1][UNKNOWNS];
  }
  return isfinite(g->left);
}

/* The mean of S in the outer tenths of the data. */
static double complex edges_of(const pendres_line_data *d)
{
  double complex sum = 0.0;
  double widest = 0.0;
  size_t count = 0;
  for (size_t i = 0; i < d->n; i++) widest = fmax(widest, fabs(d->f[i]));
  for (size_t i = 0; i < d->n; i++) {
    if (fabs(d->f[i]) < line_edge * widest) continue;
    sum += d->work[i];
    count++;
  }
  return sum / (double)(count > 0 ? count : 1);
}

/* The best of places and widths all over the data, of a resonance that is not bent. */
static pendres_line_guess find_anywhere(const pendres_line_data *d, int leaks, double low,
                                        double high, double complex far)
{
  pendres_line_guess best = {.left = INFINITY};
  for (int i = 0; i < LINE_PLACES; i++)
    for (double width = 0.5 * (high - low); width > (high - low) / LINE_PLACES; width *= 0.5) {
      pendres_line_guess g = {.far = far};
      g.place = low + (high - low) * (i + 0.5) / LINE_PLACES + 0.5 * I * width;
      if (find_far(d, leaks, &g) && g.left < best.left) best = g;
    }
  return best;
}

/* The best resonance behind a cable of this delay. */
static pendres_line_guess find_at(const pendres_line_data *d, const search *how, double delay)
{
  pendres_line_guess best = {.left = INFINITY};
  for (size_t i = 0; i < d->n; i++) d->work[i] = d->s[i] * cexp(two_pi * I * delay * d->f[i]);
  const double complex far = how->far ? edges_of(d) : 0.0;
  for (int start = 0; start < 2; start++) {
    pendres_line_guess g = {.far = far};
    if (start == 1) g = find_anywhere(d, how->leaks, how->low, how->high, far);
    for (int i = 0; i < LINE_ROUNDS; i++) {
      if (!find_place(d, how->bent, &g) || !find_far(d, how->leaks, &g)) break;
      if (!(g.left < best.left)) continue;
      best = g;
      best.delay = delay;
    }
  }
  return best;
}

static int ascending(const void *a, const void *b)
{
  const double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

/* The median slope of the phase between neighbours, as a delay. */
static double slope_of(const pendres_line_data *d)
{
  double *slope = malloc((d->n > 0 ? d->n : 1) * sizeof *slope), out = 0.0;
  size_t n = 0;
  if (slope == NULL) return NAN;
  for (size_t i = 0; i + 1 < d->n; i++) {
    const double step = d->f[i + 1] - d->f[i];
    if (step != 0.0) slope[n++] = -carg(d->s[i + 1] * conj(d->s[i])) / (two_pi * step);
  }
  qsort(slope, n, sizeof *slope, ascending);
  if (n > 0) out = slope[n / 2];
  free(slope);
  return out;
}

/* Whether the best resonance explains more of the data than noise would give any of those tried. */
static int stands_out(const pendres_line_data *d, const search *how, const pendres_line_guess *g)
{
  double complex mean = 0.0;
  double without = 0.0;
  for (size_t i = 0; i < d->n; i++) {
    d->work[i] = d->s[i] * cexp(two_pi * I * g->delay * d->f[i]);
    mean += how->leaks ? d->work[i] / (double)d->n : 0.0;
  }
  for (size_t i = 0; i < d->n; i++) without += pow(cabs(d->work[i] - mean), 2.0) / (double)d->n;
  return 2.0 * (double)d->n * (without / g->left - 1.0) > line_seen;
}

int pendres_line_find(const pendres_line_data *d, pendres_line_kind kind, int leaks, double delay,
                      pendres_line_guess out[2])
{
  const int passes = kind == PENDRES_LINE_TRANSMISSION, known = !isnan(delay);
  search how = {.leaks = leaks || !passes, .far = !passes, .low = INFINITY, .high = -INFINITY};
  int count = 0;
  for (size_t i = 0; i < d->n; i++) {
    how.low = fmin(how.low, d->f[i]);
    how.high = fmax(how.high, d->f[i]);
  }
  const double step = 1.0 / (LINE_DELAYS * (how.high - how.low));
  if (!known) delay = slope_of(d);
  if (isnan(delay)) return -1;
  if (!(how.high > how.low)) return 0;
  for (how.bent = 0; how.bent < 2; how.bent++) {
    pendres_line_guess best = {.left = INFINITY};
    for (int k = -LINE_DELAYS; k <= LINE_DELAYS; k++) {
      if (known && k != 0) continue;
      const pendres_line_guess g = find_at(d, &how, delay + k * step);
      if (g.left < best.left) best = g;
    }
    double by = 0.5 * step;
    for (; !known && isfinite(best.left) && by > line_delay_fine * step; by *= 0.5) {
      const double middle = best.delay;
      for (int way = -1; way <= 1; way += 2) {
        const pendres_line_guess g = find_at(d, &how, middle + way * by);
        if (g.left < best.left) best = g;
      }
    }
    if (isfinite(best.left)) out[count++] = best;
  }
  if (count == 2 && out[1].left < out[0].left) {
    const pendres_line_guess worse = out[0];
    out[0] = out[1];
    out[1] = worse;
  }
  return count > 0 && stands_out(d, &how, &out[0]) ? count : 0;
}
