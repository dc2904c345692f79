/*
 * bench_langevin.c -- how fast noisy pendulums are, and at which bias.
 *
 * The clouds of the paper's Fig. 7 (damping 0.12, drive period 8, amplitude 0.2): steps a
 * period are chosen such that the bias of means and covariances stays below 1 % of the
 * cloud's width; then one core advances one block, several times, and the best time counts.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include <Random123/philox.h>

#include <pendres/langevin.h>

#include "figures.h"
#include "noise/kernels_langevin.h"

/* Many short runs: the fastest of them was not disturbed by other processes. */
enum { LANES = 192, PERIODS = 40, REPEATS = 400 };

static const double two_pi = 6.28318530717958647693;

static double now(void)
{
  struct timespec t;
  if (timespec_get(&t, TIME_UTC) == 0) return 0.0;
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static pendres_langevin_answer see(void *arg, const pendres_langevin_strobe *strobe)
{
  *(double *)arg += strobe->x[0];
  return PENDRES_LANGEVIN_GO_ON;
}

/* Pendulum-periods a second, the best of several. */
static double speed(pendres_context *ctx, const pendres_pendulum *pendulum, int steps,
                    int harmonics)
{
  pendres_pendulum p[LANES];
  double x[LANES], v[LANES], best = INFINITY, sink = 0.0;
  const pendres_langevin_observer observer = {see, &sink, harmonics};

  for (int i = 0; i < LANES; i++) p[i] = *pendulum, x[i] = 2.1, v[i] = 0.1;
  for (int r = 0; r < REPEATS; r++) {
    const pendres_langevin_run run = {.n = LANES, .pendulums = p, .first_period = r * PERIODS,
                                      .periods = PERIODS, .steps_per_period = steps,
                                      .observer = &observer};
    const double start = now();
    if (pendres_langevin_advance(ctx, &run, x, v) != PENDRES_OK) return NAN;
    best = fmin(best, now() - start);
  }
  return LANES * (double)PERIODS / best;
}

/* The orbit, by waiting without noise; then steps, then speed. */
static int cloud(const char *name, double x, double temperature)
{
  pendres_pendulum p = {.damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = two_pi / 8.0};
  const pendres_langevin_run wait = {.n = 1, .pendulums = &p, .periods = 300,
                                     .steps_per_period = 1000};
  pendres_context *ctx = NULL;
  pendres_langevin_bias bias;
  double v = 0.0, worst = 0.0, error = 0.0;
  int code = 1;

  if (pendres_context_create(NULL, &ctx) != PENDRES_OK) goto done;
  if (pendres_langevin_advance(ctx, &wait, &x, &v) != PENDRES_OK) goto done;
  p.temperature = temperature;
  const pendres_langevin_request request = {.pendulum = p, .x = x, .v = v, .trajectories = 384,
                                            .settle = 60, .record = 60};
  if (pendres_langevin_choose_steps(ctx, &request, PENDRES_LANGEVIN_CLOUD, 0.01, &bias) !=
      PENDRES_OK)
    goto done;
  for (int s = 0; s <= PENDRES_LANGEVIN_COV_VV; s++) {
    worst = fmax(worst, fabs(bias.statistics[s].value) / bias.scale[s]);
    error = fmax(error, bias.statistics[s].error / bias.scale[s]);
  }
  printf("%s, T = %g: %d steps a period, bias %.2f %% of the width (known to %.2f %%): ", name,
         temperature, bias.steps_per_period, 100.0 * worst, 100.0 * error);
  const int steps = bias.steps_per_period;
  const double plain = speed(ctx, &p, steps, 0), harmonics = speed(ctx, &p, steps, 1);
  printf("%.2f million pendulum-periods a second", 1e-6 * plain);
  printf(", %.2f with harmonics and work\n", 1e-6 * harmonics);
  bench_figure(bias.steps_per_period, '<', bench_count, "noise.steps.%s.%.0e", name, temperature);
  bench_figure(plain / harmonics, '<', bench_ratio, "noise.harmonics.%s.%.0e.%s", name, temperature,
               pendres_kernels_langevin_select()->name);
  code = 0;
done:
  if (code != 0) printf("%s: failed: %s\n", name, pendres_context_message(ctx));
  pendres_context_free(ctx);
  return code;
}

/* Why Philox4x32 and not 4x64: the time of a random bit. */
static void generators(void)
{
  static _Alignas(64) uint64_t id[LANES], words[4 * LANES];
  static _Alignas(64) double gauss[4 * LANES];
  const pendres_kernels_langevin *k = pendres_kernels_langevin_select();
  const uint32_t key[2] = {1, 2};
  double best[4] = {INFINITY, INFINITY, INFINITY, INFINITY};
  uint64_t sum = 0;
  enum { CALLS = 30 };

  for (int r = 0; r < REPEATS; r++) {
    double t[5] = {now()};
    for (uint32_t c = 0; c < CALLS; c++) k->words(LANES, id, 0, c, key, words);
    t[1] = now();
    for (uint32_t c = 0; c < CALLS; c++) k->gauss(LANES, words, gauss);
    t[2] = now();
    for (uint32_t c = 0; c < CALLS * LANES; c++) {
      const philox4x32_ctr_t counter = {{c, 0, 0, 0}};
      const philox4x32_key_t both = {{1, 2}};
      sum += philox4x32(counter, both).v[0];
    }
    t[3] = now();
    for (uint32_t c = 0; c < CALLS * LANES; c++) {
      const philox4x64_ctr_t counter = {{c, 0, 0, 0}};
      const philox4x64_key_t both = {{1, 2}};
      sum += philox4x64(counter, both).v[0];
    }
    t[4] = now();
    for (int i = 0; i < 4; i++) best[i] = fmin(best[i], t[i + 1] - t[i]);
  }
  const double each = 1e9 / (4.0 * LANES * CALLS);
  printf("nanoseconds, variant %s: %.2f a 32-bit word, and %.2f more a Gaussian number;\n",
         k->name, best[0] * each, best[1] * each);
  printf("Random123's own functions: %.2f a 32-bit word of 4x32, %.2f of 4x64 (%d)\n",
         best[2] * each, best[3] * each / 2.0, (int)(sum & 1));
  bench_figure(best[2] / best[0], '>', bench_ratio, "noise.random123_to_words.%s", k->name);
}

int main(void)
{
  int failed = 0;
  generators();
  failed |= cloud("SA", 1.57079632679489661923, 1e-4);
  failed |= cloud("LA", -0.31415926535897932385, 1e-4);
  failed |= cloud("SA", 1.57079632679489661923, 1e-3);
  return failed;
}
