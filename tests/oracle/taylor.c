/*
 * taylor.c -- the Taylor-series integrator of reference.h.
 *
 * With coefficients y_k, v_k of powers of t around the beginning of a step, and s, c those of
 * sin y and cos y, d and e those of cos theta and sin theta:
 *
 *     (k+1) y_k+1 = v_k                 (k+1) v_k+1 = -s_k - damping v_k + F0 d_k
 *     (k+1) s_k+1 = (v * c)_k           (k+1) c_k+1 = -(v * s)_k
 *     (k+1) d_k+1 = -omega e_k          (k+1) e_k+1 = omega d_k
 *
 * where * is the Cauchy product, and the first equation has been used in the usual recurrences for
 * sine and cosine. For other models s becomes f (1 + b d) - I, with powers of y as products, and c
 * in what follows becomes f' (1 + b d). A column (u, w) of the variational equation, at fixed drive
 * phase, obeys
 *
 *     (k+1) u_k+1 = w_k + a_k           (k+1) w_k+1 = -(c * u)_k - damping w_k + b_k
 *
 * with sources (a, b) = (-v, -dv/dt)/omega for the drive frequency (the clock theta runs
 * slower in t), (0, -v) for the damping, (0, cos theta) for the drive amplitude.
 *
 * Source: Jorba and Zou, Experimental Mathematics 14 (2005) 99; two-word sums: Dekker,
 * Numerische Mathematik 18 (1971) 224.
 */
#include "oracle/taylor.h"

#include <math.h>
#include <string.h>

/* Step ends lie on this grid in theta, so that the phase is exact but for its own wrap. */
static const long double grid = 0x1p-40L;

static reference_pair two_sum(long double a, long double b)
{
  const long double s = a + b;
  const long double part = s - a;
  return (reference_pair){ s, (a - (s - part)) + (b - part) };
}

static void pair_add(reference_pair *a, long double b)
{
  const reference_pair s = two_sum(a->hi, b);
  *a = two_sum(s.hi, s.lo + a->lo);
}

/* a b exactly in two words, by splitting each in halves. */
static reference_pair two_product(long double a, long double b)
{
  const long double splitter = ldexpl(1.0L, (LDBL_MANT_DIG + 1) / 2) + 1.0L;
  const long double ta = splitter * a, tb = splitter * b;
  const long double ah = ta - (ta - a), al = a - ah;
  const long double bh = tb - (tb - b), bl = b - bh;
  const long double product = a * b;
  return (reference_pair){
    product, ((ah * bh - product) + ah * bl + al * bh) + al * bl };
}

/* 2 pi as three doubles, whatever the format of long double. */
static const double two_pi_part[3] = { 0x1.921fb54442d18p+2, 0x1.1a62633145c07p-52,
                                       -0x1.f1976b7ed8fbcp-108 };

reference_pair reference_taylor_two_pi(void)
{
  reference_pair sum = two_sum(two_pi_part[0], two_pi_part[1]);
  pair_add(&sum, two_pi_part[2]);
  return sum;
}

pendres_status reference_model_of(const pendres_pendulum *p, reference_model *out)
{
  if (pendres_pendulum_check(p, NULL) != PENDRES_OK) return PENDRES_INVALID_ARGUMENT;
  *out = (reference_model){.damping = p->damping, .drive_amplitude = p->drive_amplitude,
                                   .drive_frequency = p->drive_frequency, .torque = p->torque,
                                   .parametric_amplitude = p->parametric_amplitude};
  switch (p->force) {
  case PENDRES_FORCE_PENDULUM: out->sine = out->turns = 1; break;
  case PENDRES_FORCE_SQUID: out->sine = 1; break;
  case PENDRES_FORCE_POLYNOMIAL: break;
  default: return PENDRES_INVALID_ARGUMENT;
  }
  for (int k = 0; k < PENDRES_FORCE_POWERS; k++) {
    out->power[k] = p->force_coefficients[k];
    if (out->power[k] != 0.0L) out->powers = k + 1;
  }
  return PENDRES_OK;
}

/* Take whole turns off y until it is in (-pi, pi], and count them. */
static void wrap(reference_run *run)
{
  const long double two_pi = reference_taylor_two_pi().hi;
  const long double half = two_pi / 2.0L;
  while (run->model.turns && (run->y.hi > half || run->y.hi <= -half)) {
    long double n = rintl(run->y.hi / two_pi);
    if (n == 0.0L) n = run->y.hi > 0.0L ? 1.0L : -1.0L;
    for (int i = 0; i < 3; i++) {
      const reference_pair part = two_product(-n, two_pi_part[i]);
      pair_add(&run->y, part.hi);
      pair_add(&run->y, part.lo);
    }
    run->turns += (long)n;
  }
}

long reference_taylor_init(reference_run *run,
                                   const reference_model *model, long double y,
                                   long double v)
{
  memset(run, 0, sizeof *run);
  run->model = *model;
  run->order = REFERENCE_ORDER;
  run->y.hi = y;
  run->v.hi = v;
  run->u[REFERENCE_BY_Y].hi = 1.0L;
  run->w[REFERENCE_BY_V].hi = 1.0L;
  run->highest = -HUGE_VALL;
  run->lowest = HUGE_VALL;
  wrap(run);
  const long taken = run->turns;
  run->turns = 0;
  return taken;
}

/* sum of a_j b_k-j */
static long double cauchy(const long double *a, const long double *b, int k)
{
  long double even = 0.0L, odd = 0.0L;
  int j = 0;
  /* Two sums, because one would wait for each addition to finish. */
  for (; j < k; j += 2) {
    even += a[j] * b[k - j];
    odd += a[j + 1] * b[k - j - 1];
  }
  if (j == k) even += a[k] * b[0];
  return even + odd;
}

/* sum of c_k h^k for k >= 1 */
static long double increment(const long double *c, int order, long double h)
{
  long double sum = c[order];
  for (int k = order - 1; k >= 1; k--) sum = c[k] + h * sum;
  return h * sum;
}

/* sum of k c_k h^(k-1) for k >= 1 */
static long double slope(const long double *c, int order, long double h)
{
  long double sum = c[order] * (long double)order;
  for (int k = order - 1; k >= 1; k--) sum = c[k] * (long double)k + h * sum;
  return sum;
}

/* Terms k of the force's series, from those of y, sine and cosine up to k. */
static void expand_force(reference_run *run, int k)
{
  const reference_model *m = &run->model;
  long double f = 0.0L, slope = 0.0L;
  run->spower[0][k] = k == 0 ? 1.0L : 0.0L;
  for (int j = 1; j <= m->powers; j++) {
    run->spower[j][k] = cauchy(run->sy, run->spower[j - 1], k);
    f += m->power[j - 1] * run->spower[j][k];
    slope += (long double)j * m->power[j - 1] * run->spower[j - 1][k];
  }
  if (k == 0) f += slope * run->y.lo; /* the sine knows of it */
  run->sbare[k] = m->sine ? f + run->ssin[k] : f;
  run->sbare_slope[k] = m->sine ? slope + run->scos[k] : slope;
  run->sforce[k] = run->sbare[k];
  run->sslope[k] = run->sbare_slope[k];
  if (m->parametric_amplitude == 0.0L) return;
  run->sdriven[k] = cauchy(run->sdrive, run->sbare, k);
  run->sforce[k] += m->parametric_amplitude * run->sdriven[k];
  run->sslope[k] += m->parametric_amplitude * cauchy(run->sdrive, run->sbare_slope, k);
}

static void expand_state(reference_run *run)
{
  const long double damping = run->model.damping, omega = run->model.drive_frequency;
  const long double force = run->model.drive_amplitude;
  long double *y = run->sy, *v = run->sv, *s = run->ssin, *c = run->scos;
  long double *d = run->sdrive, *e = run->squad;
  const long double sine = sinl(run->y.hi), cosine = cosl(run->y.hi);
  y[0] = run->y.hi;
  v[0] = run->v.hi;
  s[0] = sine + cosine * run->y.lo;
  c[0] = cosine - sine * run->y.lo;
  d[0] = cosl(run->theta);
  e[0] = sinl(run->theta);
  for (int k = 0; k < run->order; k++) {
    const long double n = k + 1, torque = k == 0 ? run->model.torque : 0.0L;
    expand_force(run, k);
    y[k + 1] = v[k] / n;
    v[k + 1] = (force * d[k] - (run->sforce[k] - torque) - damping * v[k]) / n;
    s[k + 1] = cauchy(v, c, k) / n;
    c[k + 1] = -cauchy(v, s, k) / n;
    d[k + 1] = -omega * e[k] / n;
    e[k + 1] = omega * d[k] / n;
  }
}

static void expand_column(reference_run *run, int column)
{
  const long double damping = run->model.damping, omega = run->model.drive_frequency;
  long double *u = run->su[column], *w = run->sw[column];
  u[0] = run->u[column].hi;
  w[0] = run->w[column].hi;
  for (int k = 0; k < run->order; k++) {
    const long double n = k + 1;
    long double a = 0.0L, b = 0.0L;
    if (column == REFERENCE_BY_FREQUENCY) {
      a = -run->sv[k] / omega;
      b = -run->sv[k + 1] * n / omega;
    } else if (column == REFERENCE_BY_DAMPING) {
      b = -run->sv[k];
    } else if (column == REFERENCE_BY_AMPLITUDE) {
      b = run->sdrive[k];
    }
    u[k + 1] = (w[k] + a) / n;
    w[k + 1] = (b - cauchy(run->sslope, u, k) - damping * w[k]) / n;
  }
}

/* Size of the k-th coefficients of everything integrated, each beside its own scale. */
static long double relative_term(const reference_run *run, int k)
{
  const long double scale = fabsl(run->sy[0]) + fabsl(run->sv[0]) +
                            fabsl(run->model.drive_amplitude) + fabsl(run->model.torque);
  if (scale == 0.0L) return 0.0L;
  long double largest = fmaxl(fabsl(run->sy[k]), fabsl(run->sv[k])) / scale;
  for (int i = 0; i < run->columns; i++) {
    const int small = i == REFERENCE_BY_FREQUENCY || i == REFERENCE_BY_DAMPING;
    const long double own = fabsl(run->su[i][0]) + fabsl(run->sw[i][0]) + (small ? scale : 1.0L);
    largest = fmaxl(largest, fmaxl(fabsl(run->su[i][k]), fabsl(run->sw[i][k])) / own);
  }
  return largest;
}

/* The step in theta that the series allows: its last two terms fall below the rounding. */
static long double allowed_step(const reference_run *run)
{
  const long double omega = run->model.drive_frequency;
  /* Longer than a decay time, terms of a series would cancel; longer than a radian, those
     of the drive. */
  double longest = (double)(1.0L / fmaxl(fmaxl(1.0L, run->model.damping), omega));
  for (int k = run->order - 1; k <= run->order; k++) {
    const double term = (double)relative_term(run, k);
    if (term > 0.0)
      longest = fmin(longest, exp((log((double)LDBL_EPSILON / 256.0) - log(term)) / k));
  }
  return floorl(longest * omega / grid) * grid;
}

/* Largest and smallest y - drift theta within the step: ends and zeros of its velocity. */
static void note_extremes(reference_run *run, const long double *series, long double h)
{
  enum { PIECES = 8 };
  long double before = series[1];
  for (int i = 0; i <= PIECES; i++) {
    long double at = h * (long double)i / PIECES;
    const long double here = slope(series, run->order, at);
    if ((before < 0.0L && here > 0.0L) || (before > 0.0L && here < 0.0L)) {
      long double from = at - h / PIECES, to = at;
      /* Bisection is enough: an extreme forgives half of the digits of its place. */
      for (int j = 0; j < LDBL_MANT_DIG * 2 / 3; j++) {
        at = 0.5L * (from + to);
        const long double middle = slope(series, run->order, at);
        if ((middle < 0.0L) == (before < 0.0L)) from = at;
        else to = at;
      }
    }
    const long double value = series[0] + increment(series, run->order, at);
    run->highest = fmaxl(run->highest, value);
    run->lowest = fminl(run->lowest, value);
    before = here;
  }
}

/* A step of t + rest by a series, where rest is the second word of the step. It acts at the
   step's end: taken from its beginning it would feed energy in, a little each period. */
static long double advance_series(const long double *c, int order, reference_pair t)
{
  return increment(c, order, t.hi) + t.lo * slope(c, order, t.hi);
}

/* Integral over the step of the product of two series. */
static void integrate(const reference_run *run, const long double *a,
                      const long double *b, long double factor, reference_pair t,
                      reference_pair *sum)
{
  reference_series product = { 0.0L };
  for (int k = 0; k < run->order; k++)
    product[k + 1] = cauchy(a, b, k) / (long double)(k + 1);
  pair_add(sum, factor * advance_series(product, run->order, t));
}

static void measure(reference_run *run, reference_pair t)
{
  const long double two_pi = reference_taylor_two_pi().hi;
  const long double omega = run->model.drive_frequency, force = run->model.drive_amplitude;
  reference_series steady;
  memcpy(steady, run->sy, sizeof steady);
  steady[0] += two_pi * ((long double)run->turns - run->drift * (long double)run->periods) -
               run->drift * run->theta;
  steady[1] -= run->drift * omega;
  note_extremes(run, steady, t.hi);
  integrate(run, steady, run->sdrive, 1.0L, t, &run->cosine);
  integrate(run, steady, run->squad, 1.0L, t, &run->sine);
  integrate(run, run->sv, run->sv, 1.0L, t, &run->square);
  integrate(run, run->sv, run->sdrive, force, t, &run->area);
  if (run->model.parametric_amplitude != 0.0L)
    integrate(run, run->sv, run->sdriven, -run->model.parametric_amplitude, t, &run->parametric);
  for (int i = 0; i < run->columns; i++)
    integrate(run, run->sw[i], run->sdrive, force, t, &run->area_by[i]);
  if (run->columns > REFERENCE_BY_FREQUENCY)
    integrate(run, run->sv, run->sdrive, -force / omega, t,
              &run->area_by[REFERENCE_BY_FREQUENCY]);
  if (run->columns > REFERENCE_BY_AMPLITUDE)
    integrate(run, run->sv, run->sdrive, 1.0L, t,
              &run->area_by[REFERENCE_BY_AMPLITUDE]);
}

/* One step of h + tail in theta; h is on the grid or ends the period. */
static void step(reference_run *run, long double h, long double tail)
{
  const int order = run->order;
  const long double omega = run->model.drive_frequency;
  reference_pair t = { h / omega, 0.0L };
  const reference_pair back = two_product(t.hi, omega);
  t.lo = (((h - back.hi) - back.lo) + tail) / omega;
  if (run->measures) measure(run, t);
  /* The second word of y is in the series, that of v acts to first order. */
  const long double more = t.hi * run->v.lo;
  pair_add(&run->y, advance_series(run->sy, order, t) + more);
  pair_add(&run->v, advance_series(run->sv, order, t) - run->model.damping * more);
  for (int i = 0; i < run->columns; i++) {
    pair_add(&run->u[i], advance_series(run->su[i], order, t));
    pair_add(&run->w[i], advance_series(run->sw[i], order, t));
  }
  run->theta += h;
  wrap(run);
}

/* Advance from drive phase 0 to phase `end`. */
static pendres_status advance_to(reference_run *run, reference_pair end)
{
  run->theta = 0.0L;
  for (;;) {
    expand_state(run);
    for (int i = 0; i < run->columns; i++) expand_column(run, i);
    const long double h = run->steps > 0
                            ? floorl(two_pi_part[0] / run->steps / grid + 1.0L) * grid
                            : allowed_step(run);
    const long double left = end.hi - run->theta;
    /* NaN and infinities end here, too. A million steps a period are far more than
       anything physical asks for. */
    if (!(h > 1e-6L) || !isfinite(run->y.hi) || !isfinite(run->v.hi))
      return PENDRES_INTEGRATION_FAILED;
    if (h >= left) {
      step(run, left, end.lo);
      return PENDRES_OK;
    }
    step(run, h, 0.0L);
  }
}

pendres_status reference_taylor_advance(reference_run *run, long periods)
{
  for (long i = 0; i < periods; i++) {
    const pendres_status status = advance_to(run, reference_taylor_two_pi());
    if (status != PENDRES_OK) return status;
    run->periods++;
  }
  return PENDRES_OK;
}

pendres_status reference_taylor_advance_half(reference_run *run)
{
  const reference_pair two_pi = reference_taylor_two_pi();
  return advance_to(run, (reference_pair){ 0.5L * two_pi.hi, 0.5L * two_pi.lo });
}
