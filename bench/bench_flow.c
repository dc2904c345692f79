/*
 * bench_flow.c -- what ARKODE costs a block of pendulums, and what blocks gain.
 *
 * Prints, on one core and as ratios within one run (each way in turn, the best of many short runs,
 * so that a busy machine matters little; longer runs by processor time):
 *   1. blocks of several widths beside a bare SIMD loop of the same method (bare_loop.h);
 *   2. the Nystrom method of bulk work beside them;
 *   3. pendulum-periods a second of the reference ensemble at measured errors, by table;
 *   4. the same beside one ARKODE problem a pendulum.
 *
 * Reference ensemble: 200 pendulums at rest, spread over one turn; damping 0.12, the drive's period
 * 8, its amplitude 0.2; 100 drive periods. Error: the largest over the ensemble in position and
 * velocity against extended precision, without members that amplify a change over 1000-fold.
 */
#define _POSIX_C_SOURCE 200809L /* clock_gettime */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "oracle/reference.h"
#include <pendres/strobe.h>

#include "engine/sundials/compat.h"
#include "figures.h"
#include "engine/block.h"
#include "engine/kernels/kernels.h"
#include "engine/kernels/tables.h"

enum { MEMBERS = 200, PERIODS = 100, SINGLES = 20, BARE_STAGES = PENDRES_TABLES_MOST_STAGES };

static const double two_pi = 6.28318530717958647693;
static const double half_pi = 1.57079632679489661923;
static const pendres_pendulum pendulum = {
  .damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 6.28318530717958647693 / 8.0};

static double seconds_between(const struct timespec *a, const struct timespec *b)
{
  return (double)(b->tv_sec - a->tv_sec) + 1e-9 * (double)(b->tv_nsec - a->tv_nsec);
}

/* ---- The bare loop --------------------------------------------------------------------------- */

typedef struct bare_sum {
  int terms, j[BARE_STAGES];
  double c[BARE_STAGES]; /* times the step */
} bare_sum;

typedef struct bare_method {
  int stages, steps;
  bare_sum sum[BARE_STAGES + 1]; /* of each stage, and of the step */
  double *cosine;                /* by step and stage */
} bare_method;

typedef struct bare_block {
  size_t lanes;
  double *y, *w, *stiffness, *drive, *friction;
} bare_block;

#define BARE_LANES 2
#define BARE_RUN bare_base
#define BARE_TARGET
#include "bare_loop.h"
#undef BARE_LANES
#undef BARE_RUN
#undef BARE_TARGET
#if defined(__x86_64__)
#define BARE_LANES 4
#define BARE_RUN bare_avx2
#define BARE_TARGET __attribute__((target("avx2,fma")))
#include "bare_loop.h"
#undef BARE_LANES
#undef BARE_RUN
#undef BARE_TARGET
#define BARE_LANES 8
#define BARE_RUN bare_avx512
#define BARE_TARGET __attribute__((target("avx512f,avx512dq,avx512vl,fma")))
#include "bare_loop.h"
#endif

static void bare_run(const bare_method *m, const bare_block *b, long periods)
{
#if defined(__x86_64__)
  const char *name = pendres_kernels_select()->name; /* the same instructions for both */
  if (strcmp(name, "avx512") == 0) {
    bare_avx512(m, b, periods);
    return;
  }
  if (strcmp(name, "avx2") == 0) {
    bare_avx2(m, b, periods);
    return;
  }
#endif
  bare_base(m, b, periods);
}

static void *need(void *memory)
{
  if (memory == NULL) {
    fprintf(stderr, "bench_flow: out of memory\n");
    exit(1);
  }
  return memory;
}

static void need_ok(int status, const char *what)
{
  if (status == 0) return;
  fprintf(stderr, "bench_flow: %s failed with status %d\n", what, status);
  exit(1);
}

static void bare_open(bare_method *m, pendres_table table, int steps)
{
  const pendres_tables_method *t = pendres_tables_get(table);
  const double h = two_pi / steps;
  *m = (bare_method){.stages = t->stages, .steps = steps};
  while (t->b[m->stages - 1] == 0.0) m->stages--;
  for (int k = 0; k < t->entries; k++) {
    if (t->a[k].row >= m->stages) continue;
    bare_sum *q = &m->sum[(int)t->a[k].row];
    q->j[q->terms] = t->a[k].column;
    q->c[q->terms++] = h * t->a[k].value;
  }
  for (int i = 0; i < m->stages; i++) {
    bare_sum *q = &m->sum[m->stages];
    if (t->b[i] == 0.0) continue;
    q->j[q->terms] = i;
    q->c[q->terms++] = h * t->b[i];
  }
  m->cosine = need(malloc((size_t)(steps * m->stages) * sizeof *m->cosine));
  for (int k = 0; k < steps; k++)
    for (int i = 0; i < m->stages; i++) m->cosine[k * m->stages + i] = cos(h * (k + t->c[i]));
}

/* ---- The ensemble ---------------------------------------------------------------------------- */

static double start(size_t i, size_t n)
{
  return two_pi * (double)(i + 1) / (double)n - half_pi;
}

typedef struct ensemble {
  double x[MEMBERS], v[MEMBERS]; /* after all periods */
  int counts[MEMBERS];           /* not amplified too much to be compared */
} ensemble;

static void make_reference(ensemble *e)
{
  for (size_t i = 0; i < MEMBERS; i++) {
    reference_image image;
    const long double y = (long double)start(i, MEMBERS) - 1.57079632679489661923132169163975L;
    need_ok(reference_map(&pendulum, y, 0.0L, PERIODS, &image), "the reference");
    e->x[i] = (double)(image.y + 6.28318530717958647692528676655901L * image.turns) + half_pi;
    e->v[i] = (double)image.v;
    e->counts[i] = 1;
    for (int j = 0; j < 4; j++)
      if (fabsl(image.monodromy[j / 2][j % 2]) > 1000.0L) e->counts[i] = 0;
  }
}

/* Every `stride`-th member with these options; its largest error, and the seconds that it took. */
static double run(const pendres_options *options, const ensemble *reference, size_t stride,
                  long periods, double *seconds)
{
  pendres_context *ctx = NULL;
  pendres_pendulum p[MEMBERS];
  double x[MEMBERS], v[MEMBERS], error = 0.0;
  struct timespec a, b;
  size_t n = 0;
  for (size_t i = stride - 1; i < MEMBERS; i += stride, n++) {
    p[n] = pendulum;
    x[n] = start(i, MEMBERS);
    v[n] = 0.0;
  }
  need_ok(pendres_context_create(options, &ctx), "a context");
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &a);
  need_ok(pendres_strobe_advance(ctx, n, p, x, v, periods, NULL), "the ensemble");
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &b);
  *seconds = seconds_between(&a, &b);
  pendres_context_free(ctx);
  for (size_t i = stride - 1, k = 0; i < MEMBERS; i += stride, k++)
    if (reference != NULL && reference->counts[i])
      error = fmax(error, fmax(fabs(x[k] - reference->x[i]), fabs(v[k] - reference->v[i])));
  return error;
}

/* ---- Two ways in turn ------------------------------------------------------------------------ */

typedef struct duel {
  pendres_context *ctx;
  pendres_block *block;
  bare_method method;
  bare_block bare;
  double *memory;
} duel;

static void duel_open(duel *d, pendres_table table, size_t lanes, int steps)
{
  const pendres_options options = {.block_lanes = (int)lanes, .table = table};
  need_ok(pendres_context_create(&options, &d->ctx), "a context");
  need_ok(pendres_block_open(d->ctx, PENDRES_FLOW_STATE, steps, &d->block), "a block");
  pendres_block_resize(d->block, lanes);
  bare_open(&d->method, table, steps);
  const size_t n = pendres_block_rows(d->block).stride;
  double *m = d->memory = need(aligned_alloc(64, 5 * n * sizeof *m));
  d->bare = (bare_block){n, m, m + n, m + 2 * n, m + 3 * n, m + 4 * n};
  const double omega = pendulum.drive_frequency;
  for (size_t i = 0; i < n; i++) {
    d->bare.stiffness[i] = 1.0 / (omega * omega);
    d->bare.drive[i] = pendulum.drive_amplitude / (omega * omega);
    d->bare.friction[i] = pendulum.damping / omega;
  }
}

static void duel_close(duel *d)
{
  pendres_context_free(d->ctx);
  free(d->method.cosine);
  free(d->memory);
}

/* Shortest seconds of one period either way, in turn for `budget` seconds. */
static void duel_run(duel *d, double budget, double *block, double *bare)
{
  struct timespec first, a, b, c;
  const size_t n = d->bare.lanes;
  *block = *bare = INFINITY;
  clock_gettime(CLOCK_MONOTONIC, &first);
  do {
    for (size_t i = 0; i < n; i++) {
      d->bare.y[i] = start(i, n) - half_pi;
      d->bare.w[i] = 0.0;
      pendres_block_load(d->block, i, &pendulum, d->bare.y[i], 0.0);
    }
    clock_gettime(CLOCK_MONOTONIC, &a);
    need_ok(pendres_block_period(d->block), "a period");
    clock_gettime(CLOCK_MONOTONIC, &b);
    bare_run(&d->method, &d->bare, 1);
    clock_gettime(CLOCK_MONOTONIC, &c);
    *block = fmin(*block, seconds_between(&a, &b));
    *bare = fmin(*bare, seconds_between(&b, &c));
  } while (seconds_between(&first, &c) < budget);
  const pendres_rows rows = pendres_block_rows(d->block);
  for (size_t i = 0; i < n; i++) /* the same method: the same numbers but for rounding */
    if (!(fabs(pendres_rows_get(&rows, PENDRES_ROW_Y, i) - d->bare.y[i]) < 1e-11))
      need_ok(1, "the bare loop");
}

static void print_widths(void)
{
  static const size_t widths[] = {8, 64, 128, 200, 256, 512, 1024, 2048, 4096};
  const int steps = 20;
  printf("\nBlocks beside a bare SIMD loop: table tp8, %d steps a period, kernels %s\n", steps,
         pendres_kernels_select()->name);
  printf("%8s %22s %22s %14s\n", "lanes", "block, us a step", "bare, us a step", "block : bare");
  for (size_t i = 0; i < sizeof widths / sizeof *widths; i++) {
    duel d = {0};
    double block, bare;
    duel_open(&d, PENDRES_TABLE_TP8, widths[i], steps);
    duel_run(&d, 0.4, &block, &bare);
    printf("%8zu %22.3f %22.3f %12.0f %%\n", widths[i], 1e6 * block / steps, 1e6 * bare / steps,
           100.0 * bare / block);
    if (widths[i] >= MEMBERS)
      bench_figure(bare / block, '>', bench_ratio, "flow.block_to_bare.%zu.%s", widths[i],
                   pendres_kernels_select()->name);
    duel_close(&d);
  }
}

/* ---- Bulk work ------------------------------------------------------------------------------- */

enum { WAYS = PENDRES_FLOW_SINGLE + 1 };

/* Shortest seconds of a period of states, or of these with a tangent each, by each way, in turn for
   `budget` seconds. */
static void time_ways(pendres_block *block, size_t lanes, pendres_flow_load load, double budget,
                      double best[WAYS])
{
  struct timespec first, a, b;
  need_ok(pendres_block_carry(block, load), "what is carried");
  for (int way = 0; way < WAYS; way++) best[way] = INFINITY;
  clock_gettime(CLOCK_MONOTONIC, &first);
  do {
    for (int way = 0; way < WAYS; way++) {
      for (size_t i = 0; i < lanes; i++) {
        pendres_block_load(block, i, &pendulum, start(i, lanes) - half_pi, 0.0);
        for (int k = 0; k < 2 && load == PENDRES_FLOW_TANGENTS; k++)
          pendres_block_put_tangent(block, i, k, (double[2]){1.0, 0.0});
      }
      clock_gettime(CLOCK_MONOTONIC, &a);
      need_ok(pendres_block_period_by(block, (pendres_flow_way)way), "a period");
      clock_gettime(CLOCK_MONOTONIC, &b);
      best[way] = fmin(best[way], seconds_between(&a, &b));
    }
  } while (seconds_between(&first, &b) < budget);
  need_ok(pendres_block_carry(block, PENDRES_FLOW_NOTHING), "what is carried");
}

static void print_ways(void)
{
  static const size_t lanes[] = {8, 64, 200, 512};
  static const char *const beside[] = {"states", "tangents"};
  printf("\nThe Nystrom method beside table tp8 in as many steps: times as fast\n");
  printf("%8s %10s %12s %12s\n", "lanes", "of", "double", "single");
  for (size_t i = 0; i < sizeof lanes / sizeof *lanes; i++) {
    const pendres_options options = {.block_lanes = (int)lanes[i]};
    pendres_context *ctx = NULL;
    pendres_block *block = NULL;
    need_ok(pendres_context_create(&options, &ctx), "a context");
    need_ok(pendres_block_open(ctx, PENDRES_FLOW_STATE, 12, &block), "a block");
    pendres_block_resize(block, lanes[i]);
    for (int k = 0; k < 2; k++) {
      double best[WAYS];
      time_ways(block, lanes[i], k == 0 ? PENDRES_FLOW_NOTHING : PENDRES_FLOW_TANGENTS, 0.3, best);
      const double twice = best[PENDRES_FLOW_TABLE] / best[PENDRES_FLOW_NYSTROM];
      const double single = best[PENDRES_FLOW_TABLE] / best[PENDRES_FLOW_SINGLE];
      printf("%8zu %10s %12.2f %12.2f\n", lanes[i], beside[k], twice, single);
      bench_figure(twice, '>', bench_ratio, "flow.nystrom_to_table.%s.%zu.%s", beside[k], lanes[i],
                   pendres_kernels_select()->name);
      bench_figure(single, '>', bench_ratio, "flow.single_to_table.%s.%zu.%s", beside[k], lanes[i],
                   pendres_kernels_select()->name);
    }
    pendres_context_free(ctx);
  }
}

/* ---- Speed at measured errors ---------------------------------------------------------------- */

static const double targets[] = {1e-6, 1e-8, 1e-10, 2e-14};
enum { TARGETS = 4, MOST_STEPS = 120 };

/* What a table needs for each target: steps a period (0: too many), and its error there. */
typedef struct need_of {
  int steps[TARGETS];
  double error[TARGETS];
} need_of;

/*
 * Even numbers of steps alone, as the library chooses them: with odd ones the two halves of a
 * period, mirror images on symmetric orbits, are not stepped alike, and errors are up to three
 * times as large.
 */
static void find_steps(pendres_table table, const ensemble *reference, need_of *q)
{
  *q = (need_of){{0}, {0}};
  for (int n = 8, step = 2; n <= MOST_STEPS && q->steps[TARGETS - 1] == 0; n += step) {
    double seconds;
    const pendres_options options = {.table = table, .steps_per_period = n};
    const double error = run(&options, reference, 1, PERIODS, &seconds);
    for (int t = 0; t < TARGETS; t++)
      if (error <= targets[t] && q->steps[t] == 0) {
        q->steps[t] = n;
        q->error[t] = error;
      } else if (error > 2.0 * targets[t]) {
        q->steps[t] = 0; /* it was luck */
      }
    step = error > 1e-12 ? 2 : 4;
  }
}

static void print_tables(const ensemble *reference, int steps[TARGETS])
{
  need_of needs[PENDRES_TABLE_COUNT];
  printf("\nReference ensemble, million pendulum-periods a second at a measured error\n");
  printf("%8s %8s %8s %10s %10s %10s %14s\n", "error", "table", "steps", "measured", "block",
         "bare", "block : bare");
  for (pendres_table table = PENDRES_TABLE_TP8; table < PENDRES_TABLE_DP5; table++)
    if (pendres_tables_order(table) >= 8) find_steps(table, reference, &needs[table]);
  for (int t = 0; t < TARGETS; t++)
    for (pendres_table table = PENDRES_TABLE_TP8; table < PENDRES_TABLE_DP5; table++) {
      if (pendres_tables_order(table) < 8 || needs[table].steps[t] == 0) continue;
      double block, bare;
      duel d = {0};
      duel_open(&d, table, MEMBERS, needs[table].steps[t]);
      duel_run(&d, 0.25, &block, &bare);
      duel_close(&d);
      printf("%8.0e %8s %8d %10.1e %10.2f %10.2f %12.0f %%\n", targets[t],
             pendres_name_get(PENDRES_NAMES_TABLE, table), needs[table].steps[t],
             needs[table].error[t],
             1e-6 * MEMBERS / block, 1e-6 * MEMBERS / bare, 100.0 * bare / block);
      bench_figure(needs[table].steps[t], '<', bench_count, "flow.steps.%s.%.0e",
                   pendres_name_get(PENDRES_NAMES_TABLE, table), targets[t]);
    }
  memcpy(steps, needs[PENDRES_TABLE_TP8].steps, sizeof needs[PENDRES_TABLE_TP8].steps);
}

/*
 * One ARKODE problem a pendulum: the tolerance with which these members meet the target, 0 if none
 * does. Fewer members than the ensemble has: their largest error is smaller, if anything.
 */
static double single_tolerance(pendres_table table, const ensemble *reference, double target)
{
  for (double tolerance = 10.0 * target; tolerance > 2e-13; tolerance *= 0.5623) {
    double seconds;
    const pendres_options options = {
      .method = PENDRES_SINGLE, .table = table, .tolerance = tolerance};
    if (run(&options, reference, MEMBERS / SINGLES, PERIODS, &seconds) <= target) return tolerance;
  }
  return 0.0;
}

/* Pendulum-periods a second of a block of all members and of two single problems, in turn. */
static void race(const pendres_options *block, const pendres_options *single, double *block_speed,
                 double *single_speed)
{
  double seconds;
  *block_speed = *single_speed = 0.0;
  for (int k = 0; k < 60; k++) {
    (void)run(block, NULL, 1, 5, &seconds);
    *block_speed = fmax(*block_speed, 5.0 * MEMBERS / seconds);
    (void)run(single, NULL, MEMBERS / 2, 50, &seconds);
    *single_speed = fmax(*single_speed, 2.0 * 50.0 / seconds);
  }
}

static void print_singles(const ensemble *reference, const int steps[TARGETS])
{
  static const pendres_table tables[] = {PENDRES_TABLE_TP8, PENDRES_TABLE_DP5};
  printf("\nOne ARKODE problem a pendulum at the same measured error (%d of the members)\n",
         SINGLES);
  printf("%8s %8s %10s %16s %16s %16s\n", "error", "table", "tolerance", "million pp a s",
         "block tp8", "block : single");
  for (int t = 0; t < 3; t++)
    for (int i = 0; i < 2; i++) {
      const double tolerance = single_tolerance(tables[i], reference, targets[t]);
      const pendres_options block = {.table = PENDRES_TABLE_TP8, .steps_per_period = steps[t]};
      const pendres_options single = {
        .method = PENDRES_SINGLE, .table = tables[i], .tolerance = tolerance};
      double fast, slow;
      if (tolerance == 0.0 || steps[t] == 0) continue;
      race(&block, &single, &fast, &slow);
      printf("%8.0e %8s %10.1e %16.4f %16.2f %16.0f\n", targets[t],
             pendres_name_get(PENDRES_NAMES_TABLE, tables[i]), tolerance, 1e-6 * slow, 1e-6 * fast,
             fast / slow);
      bench_figure(fast / slow, '>', bench_ratio, "flow.block_to_single.%s.%.0e.%s",
                   pendres_name_get(PENDRES_NAMES_TABLE, tables[i]), targets[t],
                   pendres_kernels_select()->name);
    }
}

/* Processor seconds of many periods from the bottom with this speed and without a drive, the best
   of three. */
static double free_seconds(double damping, double v0)
{
  enum { LANES = 64, RUNS = 3, FREE_PERIODS = 1000 };
  const pendres_options options = {.tolerance = 1e-8, .block_lanes = LANES};
  pendres_context *ctx = NULL;
  pendres_pendulum p[LANES];
  double x[LANES], v[LANES], best = INFINITY;
  need_ok(pendres_context_create(&options, &ctx), "pendres_context_create");
  for (int k = 0; k < RUNS; k++) {
    for (int i = 0; i < LANES; i++) {
      p[i] = (pendres_pendulum){.damping = damping, .drive_frequency = 1.0};
      x[i] = half_pi;
      v[i] = v0;
    }
    const clock_t start = clock();
    need_ok(pendres_strobe_advance(ctx, LANES, p, x, v, FREE_PERIODS, NULL),
            "pendres_strobe_advance");
    best = fmin(best, (double)(clock() - start) / CLOCKS_PER_SEC);
  }
  pendres_context_free(ctx);
  return best;
}

/*
 * Denormal numbers take processors some 150 cycles an operation. What has come to rest must not
 * pay for that; what really swings that little pays up to a hundred times, as strobe.h says.
 */
static void print_denormals(void)
{
  const double rest = free_seconds(0.2, 1e-310) / free_seconds(0.2, 0.1);
  const double swing = free_seconds(0.0, 1e-310) / free_seconds(0.0, 0.1);
  const char *kernels = pendres_kernels_select()->name;
  printf("\nDenormal numbers: at rest %.2f times, swinging %.0f times as long\n", rest, swing);
  bench_figure(rest, '<', bench_ratio, "flow.denormals.rest.%s", kernels);
  bench_figure(swing, '<', 2.0 * bench_ratio, "flow.denormals.swing.%s", kernels);
}

int main(void)
{
  static ensemble reference;
  int steps[TARGETS];
  setvbuf(stdout, NULL, _IOLBF, 0);
  printf("SUNDIALS %s. Ratios count; other work on the machine changes absolute figures.\n",
         SUNDIALS_VERSION);
  print_widths();
  print_ways();
  make_reference(&reference);
  print_tables(&reference, steps);
  print_singles(&reference, steps);
  print_denormals();
  return 0;
}
