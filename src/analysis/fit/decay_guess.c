/*
 * decay_guess.c -- where the fit of a free decay begins: the frequency that explains most of the
 * first few cycles, by linear least squares at each of many, and the decay that does so best.
 */
#include "analysis/fit/call.h"

#include <math.h>
#include <string.h>

#include "base/angles.h"

/* x = offset + exp(-rate t) (cosine cos(w t) + sine sin(w t)). */
typedef struct wave {
  double w, rate, offset, cosine, sine;
  double left; /* sum of squares */
  int held;    /* the offset is known */
} wave;

/* Solve a symmetric system of three equations; 0: it is singular. */
static int solve(double a[3][4])
{
  for (int i = 0; i < 3; i++) {
    if (!(fabs(a[i][i]) > 1e-12)) return 0;
    for (int r = 0; r < 3; r++) {
      const double f = a[r][i] / a[i][i];
      for (int c = i; c < 4 && r != i; c++) a[r][c] -= f * a[i][c];
    }
  }
  for (int i = 0; i < 3; i++) a[i][3] /= a[i][i];
  return 1;
}

static double datum(const fit_model *m, size_t station)
{
  return m->datum[m->order[m->station[station].first]].observed;
}

static double time_of(const fit_model *m, size_t station)
{
  return m->station[station].axis - m->station[0].axis;
}

/* The best amplitudes of a wave over the first n stations. */
static void fit_wave(const fit_model *m, size_t n, wave *f)
{
  double a[3][4] = {{0.0}}, squares = 0.0;
  f->left = INFINITY;
  for (size_t i = 0; i < n; i++) {
    const double t = time_of(m, i), e = exp(-f->rate * t);
    const double x = datum(m, i) - (f->held ? f->offset : 0.0);
    const double base[3] = {f->held ? 0.0 : 1.0, e * cos(f->w * t), e * sin(f->w * t)};
    for (int r = 0; r < 3; r++) {
      for (int c = 0; c < 3; c++) a[r][c] += base[r] * base[c] / (double)n;
      a[r][3] += base[r] * x / (double)n;
    }
    squares += x * x / (double)n;
  }
  const double b[3] = {a[0][3], a[1][3], a[2][3]};
  if (f->held) a[0][0] = 1.0;
  if (!solve(a)) return;
  if (!f->held) f->offset = a[0][3];
  f->cosine = a[1][3];
  f->sine = a[2][3];
  f->left = squares - a[0][3] * b[0] - a[1][3] * b[1] - a[2][3] * b[2];
}

/* Whether the motion goes about an offset that is known, in a well of even sides. */
static int holds_offset(const fit_values v)
{
  const int even = v[PENDRES_A2] == 0.0 && v[PENDRES_A4] == 0.0 && v[PENDRES_TORQUE] == 0.0;
  return even && !isnan(v[PENDRES_FIT_OFFSET]);
}

/* The best wave over the first n stations. */
static wave find_wave(const fit_model *m, const fit_values v, size_t n)
{
  const int held = holds_offset(v);
  const double offset = held ? v[PENDRES_FIT_OFFSET] : 0.0;
  static const double rates[] = {0.0, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3};
  const double span = time_of(m, n - 1), step = 0.25 * pi / span;
  wave best = {.left = INFINITY};
  for (size_t k = 2; k < 4 * n; k++) {
    wave f = {.w = step * (double)k, .held = held, .offset = offset};
    fit_wave(m, n, &f);
    if (f.left < best.left) best = f;
  }
  const double w = best.w;
  for (size_t r = 0; r < sizeof rates / sizeof *rates; r++)
    for (int k = -4; k <= 4; k++) {
      wave f = {.w = w + 0.25 * step * k, .rate = rates[r] * w, .held = held, .offset = offset};
      fit_wave(m, n, &f);
      if (f.left < best.left) best = f;
    }
  return best;
}

/* What the wave makes of the quantities that are open. `high`: amplitude of the model where the
   scale of readings is open as well; `bent`: a3 at that amplitude where nothing tells it. */
static void take(const fit_model *m, const wave *f, double high, double bent, fit_values v)
{
  const double size = hypot(f->cosine, f->sine);
  const int polynomial = m->base.force == PENDRES_FORCE_POLYNOMIAL;
  if (isnan(v[PENDRES_FIT_AMPLITUDE_SCALE])) v[PENDRES_FIT_AMPLITUDE_SCALE] = size / high;
  if (isnan(v[PENDRES_FIT_OFFSET])) v[PENDRES_FIT_OFFSET] = f->offset;
  const double scale = v[PENDRES_FIT_AMPLITUDE_SCALE], a = size / scale;
  const int open_time = isnan(v[PENDRES_FIT_FREQUENCY_SCALE]);
  if (isnan(v[PENDRES_A3]) && !open_time && !isnan(v[PENDRES_A1]))
    bent = (pow(f->w / (two_pi * v[PENDRES_FIT_FREQUENCY_SCALE]), 2.0) - v[PENDRES_A1]) / 0.75;
  if (isnan(v[PENDRES_A3])) v[PENDRES_A3] = bent / (a * a + 1e-300);
  for (int q = PENDRES_A2; q <= PENDRES_A5; q++)
    if (isnan(v[q])) v[q] = 0.0;
  if (open_time && isnan(v[PENDRES_A1])) v[PENDRES_A1] = polynomial;
  if (open_time)
    v[PENDRES_FIT_FREQUENCY_SCALE] =
      f->w / (two_pi * sqrt(fabs(pendres_fit_stiffness(m, v, a)) + 1e-300));
  const double rate = two_pi * v[PENDRES_FIT_FREQUENCY_SCALE];
  if (isnan(v[PENDRES_A1])) {
    v[PENDRES_A1] = 0.0;
    v[PENDRES_A1] = f->w * f->w / (rate * rate) - pendres_fit_stiffness(m, v, a);
  }
  if (isnan(v[PENDRES_DAMPING])) v[PENDRES_DAMPING] = 2.0 * fmax(f->rate, 1e-4 * f->w) / rate;
  if (isnan(v[PENDRES_FIT_START_DISPLACEMENT]))
    v[PENDRES_FIT_START_DISPLACEMENT] = f->cosine / scale;
  if (isnan(v[PENDRES_FIT_START_VELOCITY]))
    v[PENDRES_FIT_START_VELOCITY] = (f->w * f->sine - f->rate * f->cosine) / (scale * rate);
}

/* The first stations themselves, by a parabola over a sixth of a cycle: where the motion changes
   its frequency as it decays the wave begins elsewhere, perhaps beyond the well. */
static wave begin_at_data(const fit_model *m, size_t n, const wave *f)
{
  double a[3][4] = {{0.0}};
  const double span = 2.0 * pi / 6.0 / f->w;
  wave out = *f;
  for (size_t i = 0; i < n && time_of(m, i) < span; i++)
    for (int r = 0; r < 3; r++) {
      const double t = time_of(m, i) / span;
      for (int c = 0; c < 3; c++) a[r][c] += pow(t, r + c) / (double)n;
      a[r][3] += pow(t, r) * datum(m, i) / (double)n;
    }
  if (!solve(a)) return out;
  out.cosine = a[0][3] - out.offset;
  out.sine = (a[1][3] / span + out.rate * out.cosine) / out.w;
  return out;
}

/* A start whose energy leads over the barrier on its side is one at rest before that. */
static void stay(const fit_model *m, fit_values v)
{
  pendres_pendulum p = {.force = m->base.force, .drive_frequency = 1.0,
                        .torque = v[PENDRES_TORQUE]};
  const double y = v[PENDRES_FIT_START_DISPLACEMENT], w = v[PENDRES_FIT_START_VELOCITY];
  const double way = 2.0 * y / FIT_DECAY_WAY, origin = pendres_model_of(p.force)->origin;
  double work = 0.0, energy = INFINITY;
  for (int k = 0; k < PENDRES_FORCE_POWERS; k++)
    p.force_coefficients[k] = v[PENDRES_A1 + k];
  for (int k = 1; k <= FIT_DECAY_WAY; k++) {
    const double pull = -way * pendres_pendulum_acceleration(&p, origin + way * k, 0.0, 0.0);
    if (pull > 0.0) work += pull;
    if (k <= FIT_DECAY_WAY / 2) energy = 0.5 * w * w + work;
    if (pull > 0.0) continue;
    if (k == 1 || (k > FIT_DECAY_WAY / 2 && energy < work)) return;
    v[PENDRES_FIT_START_DISPLACEMENT] = fabs(y) < fabs(way * (k - 2)) ? y : way * (k - 2);
    v[PENDRES_FIT_START_VELOCITY] = 0.0;
    return;
  }
}

int pendres_fit_decay_guess(fit_model *m, const fit_values v, fit_values out[FIT_GUESSES])
{
  static const double high[] = {0.3, 1.0, 2.0}, bent[] = {0.0, 0.3, -0.2, -0.8};
  const size_t all = m->stations, most = all < FIT_DECAY_WINDOW ? all : FIT_DECAY_WINDOW;
  size_t n = all < FIT_DECAY_FIRST ? all : FIT_DECAY_FIRST;
  m->active = all;
  if (all < 4) return 0;
  wave f = find_wave(m, v, n);
  while (n < most && !(f.w * time_of(m, n - 1) > fit_decay_cycles * two_pi)) {
    n = 2 * n < most ? 2 * n : most;
    f = find_wave(m, v, n);
  }
  if (!isfinite(f.left)) return 0;
  m->active = n;
  int count = 0;
  const int is_free =
    isnan(v[PENDRES_FIT_START_DISPLACEMENT]) && isnan(v[PENDRES_FIT_START_VELOCITY]);
  const int scaled = !isnan(v[PENDRES_FIT_AMPLITUDE_SCALE]), straight = !isnan(v[PENDRES_A3]);
  for (int data = 0; data < 2; data++, f = begin_at_data(m, n, &f))
    for (int k = 0; k < (scaled ? 1 : 3); k++)
      for (int i = 0; i < (straight ? 1 : 4) && count < FIT_GUESSES; i++) {
        memcpy(out[count], v, sizeof(fit_values));
        take(m, &f, high[k], bent[i], out[count]);
        if (is_free) stay(m, out[count]);
        count++;
      }
  return count;
}
