/*
 * oracle.h -- driven pendulums and polynomial oscillators in long double, for tests alone.
 *
 * Owns: extrapolation of the modified midpoint rule (Gragg, Bulirsch and Stoer; Hairer, Norsett and
 * Wanner I, II.9) over time t of x'' and its variational equation, and Newton's method on what a
 * test asks of a period. It shares no code, no variables and no method with the library. Order 16
 * and 32 steps a period leave less than 1e-15 of what the tests ask for.
 */
#ifndef ORACLE_H
#define ORACLE_H

#include <math.h>
#include <string.h>

#include <pendres/pendulum.h>

#define ORACLE_PI 3.14159265358979323846264338L

enum { ORACLE_SIZE = 6, ORACLE_PARTS = 32 };

/* y'' + gamma y' + f(y) (1 + b cos omega t) = torque + drive cos omega t; f is sin y, or where
   `polynomial` is set the sum of a[k - 1] y^k, or where `ring` is set sin y + a[0] y, or what
   `own`, a function of the test's, makes of y; its derivative is then left out. */
typedef struct oracle {
  long double gamma, drive, omega, torque, b, a[PENDRES_FORCE_POWERS];
  long double eta, cubic, quadratic; /* friction eta y^2 v + cubic v^3 + quadratic v |v| besides */
  int polynomial, ring;
  long double (*own)(const void *arg, long double y);
  const void *arg;
  int parts; /* of a period; 0: ORACLE_PARTS */
  int reflects; /* oracle_miss() asks for the mirror image, y -> -y, of the start */
} oracle;

static inline oracle oracle_of(const pendres_pendulum *p)
{
  oracle o = {.gamma = p->damping, .drive = p->drive_amplitude, .omega = p->drive_frequency,
              .torque = p->torque, .b = p->parametric_amplitude,
              .eta = p->nonlinear_damping, .cubic = p->cubic_damping,
              .quadratic = p->quadratic_damping,
              .polynomial = p->force == PENDRES_FORCE_POLYNOMIAL,
              .ring = p->force == PENDRES_FORCE_SQUID};
  for (int k = 0; k < PENDRES_FORCE_POWERS; k++) o.a[k] = p->force_coefficients[k];
  return o;
}

/* The slopes at time t of y, v and the derivatives of both by the initial y (2, 3) and v (4, 5);
   |v| is way v. */
static inline void oracle_slope(const oracle *p, long double way, long double t,
                                const long double *s, long double *d)
{
  const long double drive = cosl(p->omega * t), y = s[0];
  long double f = 0.0L, by = 0.0L, power = 1.0L;
  for (int k = 1; p->polynomial && k <= PENDRES_FORCE_POWERS; k++) {
    by += k * p->a[k - 1] * power;
    power *= y;
    f += p->a[k - 1] * power;
  }
  if (!p->polynomial) f = sinl(y), by = cosl(y);
  if (p->ring) f += p->a[0] * y, by += p->a[0];
  if (p->own != NULL) f = p->own(p->arg, y), by = 0.0L;
  const long double strength = 1.0L + p->b * drive;
  const long double v = s[1], drag = way * p->quadratic * v;
  const long double loss = p->gamma + p->eta * y * y + drag + p->cubic * v * v;
  for (int k = 0; k < ORACLE_SIZE; k += 2) {
    d[k] = s[k + 1];
    d[k + 1] = -(loss + drag + 2.0L * p->cubic * v * v) * s[k + 1] -
               (strength * by + 2.0L * p->eta * y * v) * s[k];
  }
  d[1] = p->torque + p->drive * drive - loss * v - strength * f;
}

static inline void oracle_midpoint(const oracle *p, long double way, long double t,
                                   long double step, int n, const long double *from,
                                   long double *to)
{
  long double before[ORACLE_SIZE], here[ORACLE_SIZE], next[ORACLE_SIZE], d[ORACLE_SIZE];
  const long double h = step / n;
  memcpy(before, from, sizeof before);
  oracle_slope(p, way, t, from, d);
  for (int i = 0; i < ORACLE_SIZE; i++) here[i] = from[i] + h * d[i];
  for (int k = 1; k < n; k++) {
    oracle_slope(p, way, t + k * h, here, d);
    for (int i = 0; i < ORACLE_SIZE; i++) next[i] = before[i] + 2.0L * h * d[i];
    memcpy(before, here, sizeof before);
    memcpy(here, next, sizeof here);
  }
  oracle_slope(p, way, t + step, here, d);
  for (int i = 0; i < ORACLE_SIZE; i++) to[i] = 0.5L * (before[i] + here[i] + h * d[i]);
}

/* A stretch of time with |v| = way v; s is replaced. */
static inline void oracle_stretch(const oracle *p, long double way, long double t, long double step,
                                  long double *s)
{
  enum { COLUMNS = 8 };
  long double table[COLUMNS][ORACLE_SIZE];
  for (int k = 0; k < COLUMNS; k++) {
    oracle_midpoint(p, way, t, step, 2 * (k + 1), s, table[k]);
    for (int m = k - 1; m >= 0; m--) {
      const long double ratio = (long double)(k + 1) / (m + 1);
      for (int i = 0; i < ORACLE_SIZE; i++)
        table[m][i] = table[m + 1][i] + (table[m + 1][i] - table[m][i]) / (ratio * ratio - 1.0L);
    }
  }
  memcpy(s, table[0], sizeof table[0]);
}

/* One of the parts of a period, each as long as the others; s is replaced. Where v turns, in the
   first part that it does, is found by Newton's method. */
static inline void oracle_part(const oracle *p, int part, long double *s)
{
  enum { ROUNDS = 8 };
  const int parts = p->parts > 0 ? p->parts : ORACLE_PARTS;
  const long double step = 2.0L * ORACLE_PI / p->omega / parts, t = part * step;
  long double end[ORACLE_SIZE], slope[ORACLE_SIZE], until = 0.5L * step;
  oracle_slope(p, 1.0L, t, s, slope);
  const long double way = s[1] < 0.0L || (s[1] == 0.0L && slope[1] < 0.0L) ? -1.0L : 1.0L;
  memcpy(end, s, sizeof end);
  oracle_stretch(p, way, t, step, end);
  if (p->quadratic != 0.0L && way * end[1] < 0.0L) {
    for (int k = 0; k < ROUNDS; k++) {
      memcpy(end, s, sizeof end);
      oracle_stretch(p, way, t, until, end);
      oracle_slope(p, way, t + until, end, slope);
      until -= end[1] / slope[1];
    }
    oracle_stretch(p, -way, t + until, step - until, end);
  }
  memcpy(s, end, sizeof end);
}

/* From time 0 on, over so many periods; s is replaced. */
static inline void oracle_advance(const oracle *p, int periods, long double *s)
{
  const int parts = p->parts > 0 ? p->parts : ORACLE_PARTS;
  for (int part = 0; part < parts * periods; part++) oracle_part(p, part, s);
}

/* How a start (y, v) misses being that of an orbit of so many periods and turns (0, 1), and the
   determinant of the derivative of where it leads, less `sign` (2). */
static inline void oracle_miss(const oracle *p, int periods, int winding, int sign,
                               const long double *start, long double *miss)
{
  long double s[ORACLE_SIZE] = {start[0], start[1], 1.0L, 0.0L, 0.0L, 1.0L};
  oracle_advance(p, periods, s);
  for (int i = 0; p->reflects && i < ORACLE_SIZE; i++) s[i] = -s[i];
  miss[0] = s[0] - start[0] - 2.0L * ORACLE_PI * winding;
  miss[1] = s[1] - start[1];
  miss[2] = (s[2] - sign) * (s[5] - sign) - s[3] * s[4];
}

/* a x = b by elimination; a and b are overwritten, b by x. */
static inline void oracle_solve(long double a[3][3], long double *b)
{
  for (int c = 0; c < 3; c++) {
    int best = c;
    for (int r = c + 1; r < 3; r++)
      if (fabsl(a[r][c]) > fabsl(a[best][c])) best = r;
    for (int k = 0; k < 3; k++) {
      const long double t = a[c][k];
      a[c][k] = a[best][k], a[best][k] = t;
    }
    const long double t = b[c];
    b[c] = b[best], b[best] = t;
    for (int r = 0; r < 3; r++) {
      if (r == c) continue;
      const long double f = a[r][c] / a[c][c];
      for (int k = 0; k < 3; k++) a[r][k] -= f * a[c][k];
      b[r] -= f * b[c];
    }
  }
  for (int c = 0; c < 3; c++) b[c] /= a[c][c];
}

/* Of the orbit of one period that (y, v) is near and becomes: the work of the drive in a period.
   Equally spaced samples of a smooth periodic function add up to its integral. */
static inline long double oracle_loop_area(const oracle *p, long double *start)
{
  enum { ROUNDS = 4 };
  long double s[ORACLE_SIZE], area = 0.0L;
  for (int round = 0; round <= ROUNDS; round++) {
    memcpy(s, (const long double[ORACLE_SIZE]){start[0], start[1], 1.0L, 0.0L, 0.0L, 1.0L},
           sizeof s);
    area = 0.0L;
    for (int k = 0; k < ORACLE_PARTS; k++) {
      area += p->drive * cosl(2.0L * ORACLE_PI * k / ORACLE_PARTS) * s[1];
      oracle_part(p, k, s);
    }
    if (round == ROUNDS) break;
    /* s[2..3] is the derivative by y, s[4..5] by v. */
    const long double miss[2] = {s[0] - start[0], s[1] - start[1]};
    const long double det = (s[2] - 1.0L) * (s[5] - 1.0L) - s[3] * s[4];
    start[0] -= ((s[5] - 1.0L) * miss[0] - s[4] * miss[1]) / det;
    start[1] -= ((s[2] - 1.0L) * miss[1] - s[3] * miss[0]) / det;
  }
  return area * 2.0L * ORACLE_PI / p->omega / ORACLE_PARTS;
}

/* The frequency near p->omega at which that area is largest, by the secant rule for its slope, of
   fourth order in differences of h; *area, the largest. */
static inline long double oracle_resonance(oracle *p, double y, double v, long double *area)
{
  enum { ROUNDS = 3 };
  const long double h = 2e-5L * p->omega;
  long double at[2] = {p->omega * (1.0L - 1e-5L), p->omega * (1.0L + 1e-5L)}, slope[2];
  for (int k = 0; k < ROUNDS + 2; k++) {
    long double of[4];
    for (int i = 0; i < 4; i++) {
      long double start[2] = {y, v};
      p->omega = at[k < 2 ? k : 1] + h * (i < 2 ? i - 2 : i - 1);
      of[i] = oracle_loop_area(p, start);
    }
    slope[k < 2 ? k : 1] = (of[0] - 8.0L * of[1] + 8.0L * of[2] - of[3]) / (12.0L * h);
    if (k == 0) continue;
    if (slope[1] == slope[0] || k == ROUNDS + 1) break;
    const long double next = at[1] - slope[1] * (at[1] - at[0]) / (slope[1] - slope[0]);
    at[0] = at[1], slope[0] = slope[1], at[1] = next;
  }
  p->omega = at[1];
  *area = oracle_loop_area(p, (long double[2]){y, v});
  return at[1];
}

/*
 * The value of *parameter, a field of *p, at which the orbit near (y, v) has a multiplier `sign`,
 * by Newton's method with central differences from the values at hand on; *left is the last step.
 */
static inline double oracle_bifurcation(oracle *p, long double *parameter, int periods,
                                        int winding, int sign, double y, double v, double *left)
{
  enum { ROUNDS = 3 };
  const long double h = 1e-5L;
  long double u[2] = {y, v};
  for (int round = 0; round < ROUNDS; round++) {
    long double a[3][3], r[3], side[2][3];
    oracle_miss(p, periods, winding, sign, u, r);
    for (int column = 0; column < 3; column++) {
      long double *const moved = column < 2 ? &u[column] : parameter, old = *moved;
      for (int k = 0; k < 2; k++) {
        *moved = k == 0 ? old + h : old - h;
        oracle_miss(p, periods, winding, sign, u, side[k]);
      }
      *moved = old;
      for (int i = 0; i < 3; i++) a[i][column] = (side[0][i] - side[1][i]) / (2.0L * h);
    }
    oracle_solve(a, r);
    u[0] -= r[0];
    u[1] -= r[1];
    *parameter -= r[2];
    *left = (double)fabsl(r[2]);
  }
  return (double)*parameter;
}

#endif
