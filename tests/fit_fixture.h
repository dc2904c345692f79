/*
 * fit_fixture.h -- measured responses by an integration that has no code in common with the
 * library: classical Runge-Kutta steps of fixed length of y'' + g y' + (1 + b cos(w t)) f(y) =
 * I + F cos(w t) with its variational equations, Newton's method on the map of a period from value
 * to value of the sweep, and, where the state has ended, plain integration until the motion has
 * settled on another.
 */
#ifndef FIT_FIXTURE_H
#define FIT_FIXTURE_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { LAB_STEPS = 160 };

static const double lab_pi = 3.14159265358979323846;

/* y measured from the well's bottom; sine: f = sin y, else a1 y + a2 y^2 + a3 y^3. */
typedef struct lab {
  int sine;
  double a1, a2, a3, damping, drive, frequency, torque, parametric;
} lab;

typedef struct lab_motion {
  double y, v;        /* at drive phase 0 */
  double amplitude, rms, cosine, sine, work; /* over the last period */
} lab_motion;

static double lab_force(const lab *l, double y, double *slope)
{
  *slope = l->sine ? cos(y) : l->a1 + y * (2.0 * l->a2 + 3.0 * l->a3 * y);
  return l->sine ? sin(y) : y * (l->a1 + y * (l->a2 + y * l->a3));
}

/* s: y, v and their derivatives by the first y and v. */
static void lab_slope(const lab *l, double t, const double s[6], double out[6])
{
  double k;
  const double f = lab_force(l, s[0], &k), c = cos(l->frequency * t);
  const double shaken = 1.0 + l->parametric * c;
  out[0] = s[1];
  out[1] = l->torque + l->drive * c - shaken * f - l->damping * s[1];
  for (int i = 2; i < 6; i += 2) {
    out[i] = s[i + 1];
    out[i + 1] = -shaken * k * s[i] - l->damping * s[i + 1];
  }
}

/* One period from (m->y, m->v); map[2][2]: its derivative. */
static void lab_period(const lab *l, lab_motion *m, double map[2][2])
{
  const double h = 2.0 * lab_pi / l->frequency / LAB_STEPS;
  double s[6] = {m->y, m->v, 1.0, 0.0, 0.0, 1.0}, k[4][6], at[6];
  double top = -INFINITY, bottom = INFINITY, sum = 0.0, squares = 0.0, c = 0.0, d = 0.0;
  double work = 0.0;
  for (int n = 0; n < LAB_STEPS; n++) {
    const double t = n * h, theta = 2.0 * lab_pi * n / LAB_STEPS;
    sum += s[0] / LAB_STEPS;
    squares += s[0] * s[0] / LAB_STEPS;
    c += 2.0 / LAB_STEPS * s[0] * cos(theta);
    d += 2.0 / LAB_STEPS * s[0] * sin(theta);
    work += h * l->drive * cos(theta) * s[1];
    lab_slope(l, t, s, k[0]);
    /* An extreme within the step: by the parabola with the slope and its derivative. */
    const double lead = k[0][1] != 0.0 ? -s[1] / k[0][1] : 0.0;
    const double peak = fabs(lead) < h ? s[0] + 0.5 * lead * s[1] : s[0];
    top = fmax(top, peak);
    bottom = fmin(bottom, peak);
    for (int j = 1; j < 4; j++) {
      const double part = j < 3 ? 0.5 * h : h;
      for (int i = 0; i < 6; i++) at[i] = s[i] + part * k[j - 1][i];
      lab_slope(l, t + part, at, k[j]);
    }
    for (int i = 0; i < 6; i++)
      s[i] += h / 6.0 * (k[0][i] + 2.0 * k[1][i] + 2.0 * k[2][i] + k[3][i]);
  }
  m->y = s[0];
  m->v = s[1];
  m->amplitude = 0.5 * (top - bottom);
  m->rms = sqrt(fmax(0.0, squares - sum * sum));
  m->cosine = c;
  m->sine = d;
  m->work = work;
  map[0][0] = s[2];
  map[1][0] = s[3];
  map[0][1] = s[4];
  map[1][1] = s[5];
}

/* Newton's method from a state; 0 where it does not lead to a stable motion close by. */
static int lab_newton(const lab *l, double near, lab_motion *m)
{
  const double y0 = m->y, v0 = m->v;
  for (int i = 0; i < 30; i++) {
    double map[2][2];
    const double y = m->y, v = m->v;
    lab_period(l, m, map);
    const double a = 1.0 - map[0][0], b = -map[0][1], c = -map[1][0], d = 1.0 - map[1][1];
    const double det = a * d - b * c, ry = m->y - y, rv = m->v - v;
    const double dy = (d * ry - b * rv) / det, dv = (a * rv - c * ry) / det;
    m->y = y + dy;
    m->v = v + dv;
    const double size = hypot(m->y, m->v);
    if (hypot(dy, dv) < 1e-11 * (size + 1e-12)) {
      const double trace = map[0][0] + map[1][1];
      const double full = map[0][0] * map[1][1] - map[0][1] * map[1][0];
      return hypot(m->y - y0, m->v - v0) < near && 1.0 - trace + full > 0.0 &&
             1.0 + trace + full > 0.0;
    }
    if (!(hypot(dy, dv) < 10.0)) return 0;
  }
  return 0;
}

/* Integrate until the motion has settled, then to its orbit. */
static int lab_settle(const lab *l, lab_motion *m)
{
  const double time = 6.0 / l->damping;
  const int periods = (int)(time * l->frequency / (2.0 * lab_pi)) + 20;
  double map[2][2];
  for (int i = 0; i < 20; i++) {
    for (int k = 0; k < periods; k++) lab_period(l, m, map);
    const double size = hypot(m->y, m->v) + 1e-12;
    lab_motion at = *m;
    if (!lab_newton(l, 0.05 * size, &at)) continue;
    *m = at;
    return 1;
  }
  return 0;
}

/* Measure at n values, in order, of the number at *swept, beginning at rest; the state is followed
   as an experimenter who waits long enough at each does. Returns how many were measured. */
static inline int lab_sweep_of(lab *l, double *swept, int n, const double *value, lab_motion *out)
{
  lab_motion m = {0};
  double map[2][2];
  for (int i = 0; i < n; i++) {
    lab_motion at = m, before = m;
    *swept = value[i];
    const double size = hypot(m.y, m.v);
    if (i == 0 || !lab_newton(l, 0.6 * size, &at)) {
      at = before;
      if (!lab_settle(l, &at)) return i;
    }
    m = at;
    lab_period(l, &at, map);
    out[i] = at;
    out[i].y = m.y;
    out[i].v = m.v;
  }
  return n;
}

static inline int lab_sweep(lab l, int n, const double *frequency, lab_motion *out)
{
  return lab_sweep_of(&l, &l.frequency, n, frequency, out);
}

/* Random numbers of its own: splitmix64, and normal ones by Box and Muller. */
static double lab_uniform(uint64_t *seed)
{
  uint64_t z = *seed += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return ((double)((z ^ (z >> 31)) >> 11) + 0.5) / 9007199254740992.0;
}

static double lab_normal(uint64_t *seed)
{
  const double r = sqrt(-2.0 * log(lab_uniform(seed)));
  return r * cos(2.0 * lab_pi * lab_uniform(seed));
}

/* Displacements at n ascending times of which the first is 0, by steps of 1/20 at most. */
static inline void lab_decay(lab l, double y, double v, size_t n, const double *time, double *out)
{
  double s[6] = {y, v, 0.0, 0.0, 0.0, 0.0}, k[4][6], at[6];
  l.drive = 0.0;
  l.frequency = 1.0;
  for (size_t i = 0; i < n; i++) {
    const double span = time[i] - (i > 0 ? time[i - 1] : 0.0);
    const int steps = (int)(20.0 * span) + 1;
    const double h = span / steps;
    for (int m = 0; m < steps; m++) {
      lab_slope(&l, 0.0, s, k[0]);
      for (int j = 1; j < 4; j++) {
        for (int c = 0; c < 6; c++) at[c] = s[c] + (j < 3 ? 0.5 * h : h) * k[j - 1][c];
        lab_slope(&l, 0.0, at, k[j]);
      }
      for (int c = 0; c < 6; c++)
        s[c] += h / 6.0 * (k[0][c] + 2.0 * k[1][c] + 2.0 * k[2][c] + k[3][c]);
    }
    out[i] = s[0];
  }
}

#endif
