/*
 * bench_settle.c -- what whole jobs cost: decks as users run them, on one thread.
 *
 * Drive periods, right-hand sides and Newton steps are counts: they do not depend on the machine.
 * Time is compared with a block's own: what a right-hand side costs within the job, searching,
 * judging and storing included, over what it costs in a block that does nothing else. Job and block
 * take turns, and the best time of each counts, since whatever else a machine does can only make
 * either slower. A job that comes to need fewer right-hand sides takes less time, but has a larger
 * ratio, as the rest is as much as before. Decks are read from input/, as from the top of the tree,
 * the longer ones with less of everything: what they take is chaos, weak damping, and what runs one
 * parameter value at a time.
 */
#define _POSIX_C_SOURCE 200809L /* clock_gettime, unlink */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "figures.h"
#include "engine/kernels/kernels.h"
#include "scenes/scene.h"

enum { LANES = 512, PERIODS = 4, REPEATS = 60, MOST_KEYS = 5 };

/* A deck with some of its keys set, and how often it is run. */
typedef struct job {
  const char *name, *deck;
  int rounds;
  const char *set[MOST_KEYS];
} job;

static const job jobs[] = {
  { "f02", "f02", 5, { NULL } },
  { "f03", "f03", 5, { NULL } },
  { "f07", "f07", 5, { NULL } },
  { "cascade", "cascade", 2, { "sweep.drive_amplitude_range=1.06,1.09,31" } },
  { "picture", "cascade", 2,
    { "sweep.drive_amplitude_range=1.06,1.09,31", "bifurcation_diagram.attractors=F",
      "bifurcation_diagram.bifurcations=F", "bifurcation_diagram.exponents=F" } },
  { "lyapunov_map", "lyapunov", 2,
    { "sweep.drive_amplitude_range=0.8,2,40", "sweep.drive_frequency_range=0.4,1,40" } },
  { "current_voltage", "josephson", 2, { "sweep.torque_range=0,3,101" } },
  { "dampings", "f02", 2, { "pendulum.drive_amplitude=0.5", "sweep.damping=0.1,0.2,0.4,0.8" } },
  { "two_wells", "duffing", 2,
    { "pendulum.force_coefficients=-1,0,1", "pendulum.damping=0.25", "pendulum.drive_frequency=1",
      "sweep.drive_amplitude_range=0.1,0.5,21" } },
  { "two_wells_diagram", "cascade", 2,
    { "pendulum.force='polynomial'", "pendulum.force_coefficients=-1,0,1", "pendulum.damping=0.15",
      "pendulum.drive_frequency=1", "sweep.drive_amplitude_range=0.25,0.27,11" } },
  { "hysteresis", "hysteresis", 2, { NULL } },
  { "f07_refine", "f07_refine", 2,
    { "sweep.x_range=-1.5707963267948966,4.7123889803846899,1024",
      "sweep.v_range=-2.5,2.5,1024" } },
  { "section", "section", 2, { "orbit.periods=10000" } },
  { "ueda_section", "ueda_section", 2, { "orbit.periods=5000" } },
  { "ueda", "ueda", 2, { "sweep.x_range=-4,4,21", "sweep.v_range=-6,6,21" } },
  { "hubbard", "hubbard", 2,
    { "sweep.x_range=-1.5707963267948966,4.7123889803846899,64", "sweep.v_range=-4,4,64" } },
  { "f08", "f08", 2,
    { "sweep.damping_range=0.06,0.19,20", "sweep.drive_frequency_range=0.6,0.99,20" } },
  { "weak_branches", "f09", 2,
    { "sweep.damping=2e-4", "pendulum.drive_amplitude=1e-4",
      "sweep.drive_frequency_range=0.995,1.005,21", "ensemble.members=20" } },
  { "weak_sweep", "hysteresis", 2,
    { "pendulum.damping=2e-4", "pendulum.drive_amplitude=1e-4",
      "sweep.drive_frequency_range=0.998,1.002,81" } },
  { "weaker_sweep", "hysteresis", 2,
    { "pendulum.damping=1e-5", "pendulum.drive_amplitude=1e-5",
      "sweep.drive_frequency_range=0.9,1.005,51" } },
};

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
static double run_deck(const job *j, pendres_cost *cost)
{
  char path[64], out[80];
  size_t set = 0;
  const char *why = "", *folder = getenv("BUILD");
  deck d;
  namelist_errors errors = { 0 };
  farm_options options = { .threads = 1 };
  scene_run run = { .deck = &d };
  snprintf(path, sizeof path, "input/%s.nml", j->deck);
  snprintf(out, sizeof out, "%.40s/bench/%.20s.h5", folder != NULL ? folder : "build", j->name);
  while (set < MOST_KEYS && j->set[set] != NULL) set++;
  need_ok(deck_read_set(path, j->set, set, &d, &errors), path, "not a deck");
  need_ok(scene_precision(&d, &options.library, &why), path, why);
  need_ok(farm_create(&options, &run.farm), path, "no threads");
  need_ok(pendres_store_create(out, NULL, &run.store), out, pendres_store_message(run.store));
  const double start = seconds_now();
  need_ok(scene_find(d.kind)->run(&run), path, run.message);
  need_ok(pendres_store_close(run.store), out, pendres_store_message(run.store));
  const double took = seconds_now() - start;
  farm_cost(run.farm, cost);
  scene_room_end(&run.room);
  pendres_store_free(run.store);
  farm_free(run.farm);
  deck_free(&d);
  namelist_errors_free(&errors);
  (void)unlink(out);
  return took;
}

/* Counts of a job, and its time beside that of a block. */
static void measure(const job *j, const char *kernels)
{
  pendres_cost cost;
  double took = INFINITY, block = block_seconds();
  for (int k = 0; k < j->rounds; k++) {
    took = fmin(took, run_deck(j, &cost));
    block = fmin(block, block_seconds());
  }
  const double n = cost.settled_pendulums, share = took / cost.rhs_evaluations / block;
  const double periods = cost.pendulum_periods / n, rhs = cost.rhs_evaluations / n;
  printf("%17s %10.0f %12.1f %14.3f %14.1f %10.0f %8.2f %12.2f\n", j->name, n,
         1e-6 * cost.rhs_evaluations, n > 0.0 ? periods : NAN, n > 0.0 ? rhs : NAN,
         cost.newton_steps, took, share);
  bench_figure(cost.rhs_evaluations, '<', bench_count, "job.%s.rhs", j->name);
  if (n > 0.0) {
    bench_figure(periods, '<', bench_count, "job.%s.periods_each", j->name);
    bench_figure(rhs, '<', bench_count, "job.%s.rhs_each", j->name);
  }
  bench_figure(cost.newton_steps, '<', bench_count, "job.%s.newton_steps", j->name);
  bench_figure(share, '<', bench_ratio, "job.%s.seconds_to_block.%s", j->name, kernels);
}

int main(void)
{
  const char *kernels = pendres_kernels_select()->name;
  printf("\nWhole jobs, one thread, kernels %s\n", kernels);
  printf("%17s %10s %12s %14s %14s %10s %8s %12s\n", "job", "pendulums", "million rhs",
         "periods each", "rhs each", "Newton", "s", "job : block");
  for (size_t i = 0; i < sizeof jobs / sizeof *jobs; i++) measure(&jobs[i], kernels);
  return 0;
}
