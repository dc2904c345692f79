/*
 * bench_settle.c -- what whole jobs cost: decks as users run them, on one thread.
 *
 * Drive periods, right-hand sides and Newton steps are counts: they do not depend on the machine.
 * Time is compared with a block's own: what a right-hand side costs within the job, searching,
 * judging and storing included, over what it costs in a block that does nothing else. Job and block
 * take turns, and the best time of each counts, since whatever else a machine does can only make
 * either slower. A job that comes to need fewer right-hand sides takes less time, but has a larger
 * ratio, as the rest is as much as before. Decks are read from input/, as from the top of the tree.
 */
#define _POSIX_C_SOURCE 200809L /* clock_gettime, unlink */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "figures.h"
#include "engine/kernels.h"
#include "scenes/scene.h"

enum { LANES = 512, PERIODS = 4, REPEATS = 60, ROUNDS = 5 };

/* Figures of a job, by name; a deck with bounds for what a bench may take. */
static const char *const jobs[] = { "f02", "f03", "f07" };

static double seconds_now(void)
{
  struct timespec t = { 0 };
  (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void need_ok(int status, const char *what, const char *message)
{
  if (status == 0) return;
  fprintf(stderr, "bench_settle: %s failed: %s\n", what, message);
  exit(1);
}

/* Seconds a right-hand side of a full block, the best of many short runs. */
static double block_seconds(void)
{
  static pendres_pendulum p[LANES];
  static double x[LANES], v[LANES];
  const pendres_options options = { .steps_per_period = 24, .block_lanes = LANES };
  pendres_context *ctx = NULL;
  pendres_cost cost;
  double best = INFINITY;
  need_ok(pendres_context_create(&options, &ctx), "a context", "");
  for (int i = 0; i < LANES; i++) {
    p[i] = (pendres_pendulum){ .damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.8 };
    x[i] = 6.0 * i / LANES - 1.5;
    v[i] = 0.0;
  }
  for (int k = 0; k < REPEATS; k++) {
    pendres_context_cost_reset(ctx);
    const double start = seconds_now();
    need_ok(pendres_strobe_advance(ctx, LANES, p, x, v, PERIODS, NULL), "a block",
            pendres_context_message(ctx));
    const double took = seconds_now() - start;
    pendres_context_cost(ctx, &cost);
    best = fmin(best, took / cost.rhs_evaluations);
  }
  pendres_context_free(ctx);
  return best;
}

/* Run a deck's scene; its cost, and the seconds that it took. */
static double run_deck(const char *name, pendres_cost *cost)
{
  char path[64], out[64];
  const char *why = "", *folder = getenv("BUILD");
  deck d;
  namelist_errors errors = { 0 };
  farm_options options = { .threads = 1 };
  scene_run run = { .deck = &d };
  snprintf(path, sizeof path, "input/%s.nml", name);
  snprintf(out, sizeof out, "%.40s/bench/%s.h5", folder != NULL ? folder : "build", name);
  need_ok(deck_read_set(path, NULL, 0, &d, &errors), path, "not a deck");
  need_ok(scene_precision(&d, &options.library, &why), path, why);
  need_ok(farm_create(&options, &run.farm), path, "no threads");
  need_ok(pendres_store_create(out, NULL, &run.store), out, pendres_store_message(run.store));
  const double start = seconds_now();
  need_ok(scene_find(d.kind)->run(&run), path, run.message);
  need_ok(pendres_store_close(run.store), out, pendres_store_message(run.store));
  const double took = seconds_now() - start;
  farm_cost(run.farm, cost);
  pendres_store_free(run.store);
  farm_free(run.farm);
  deck_free(&d);
  namelist_errors_free(&errors);
  (void)unlink(out);
  return took;
}

int main(void)
{
  const char *kernels = pendres_kernels_select()->name;
  printf("\nWhole jobs, one thread, kernels %s\n", kernels);
  printf("%6s %10s %12s %14s %14s %10s %8s %12s\n", "deck", "pendulums", "million rhs",
         "periods each", "rhs each", "Newton", "s", "job : block");
  for (size_t i = 0; i < sizeof jobs / sizeof *jobs; i++) {
    pendres_cost cost;
    double took = INFINITY, block = block_seconds();
    for (int k = 0; k < ROUNDS; k++) {
      took = fmin(took, run_deck(jobs[i], &cost));
      block = fmin(block, block_seconds());
    }
    const double n = cost.settled_pendulums, share = took / cost.rhs_evaluations / block;
    printf("%6s %10.0f %12.1f %14.3f %14.1f %10.0f %8.2f %12.2f\n", jobs[i], n,
           1e-6 * cost.rhs_evaluations, cost.pendulum_periods / n, cost.rhs_evaluations / n,
           cost.newton_steps, took, share);
    bench_figure(cost.rhs_evaluations, '<', bench_count, "job.%s.rhs", jobs[i]);
    bench_figure(cost.pendulum_periods / n, '<', bench_count, "job.%s.periods_each", jobs[i]);
    bench_figure(cost.rhs_evaluations / n, '<', bench_count, "job.%s.rhs_each", jobs[i]);
    bench_figure(cost.newton_steps, '<', bench_count, "job.%s.newton_steps", jobs[i]);
    bench_figure(share, '<', bench_ratio, "job.%s.seconds_to_block.%s", jobs[i], kernels);
  }
  return 0;
}
