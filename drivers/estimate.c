/* estimate.c -- rules and words; see estimate.h. */
#define _DEFAULT_SOURCE /* statvfs, _SC_PHYS_PAGES */
#include "estimate.h"

#include <math.h>
#include <string.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "scenes/scene.h"

/* What every run has in memory, and what a thread adds. */
static const double program_memory = 19e6, thread_memory = 9e6;

/* Seconds that a program takes to start and to write what is short. */
static const double program_seconds = 0.02;

/* The damping at which the seconds a point of scene_size were measured. Below it pendulums settle
   as much longer as it is weaker, down to where budgets of periods and searches end them; where
   branches are followed they hardly do (measured at dampings down to 1e-5). */
static const double usual_damping = 0.2, slowest = 300.0, slowest_branch = 5.0;

/* Bytes that a grid's state adds to the compressed file where it differs from the one before; of a
   basin's boundary, mostly; of a noisy strobe point, and of one among others that may repeat; of a
   sample of an orbit beyond the first ones, which are stored with little gain. */
static const double change_bytes = 1.3, boundary_bytes = 200e3, strobe_bytes = 7.0,
                    repeated_bytes = 3.5, sample_bytes = 15.0;
enum { FIRST_SAMPLES = 2000 };

/* A diagram keeps the records of its lines, and its curves are longer the more orbits are in
   these: bytes of memory a byte, and of output a byte of a line's. */
static const double record_memory = 1.5, record_output = 0.57;

static const scene_size *size_of(const deck *d)
{
  return &scene_find(d->kind)->size;
}

/* Points of the results' grid. */
static double points_of(const deck *d)
{
  double points = 1.0;
  for (int axis = 0; axis < DECK_AXIS_COUNT; axis++)
    if (axis != DECK_AXIS_TEMPERATURE && d->axis[axis].count > 0)
      points *= (double)d->axis[axis].count;
  if (d->kind == DECK_ORBIT) points = (double)d->orbit.periods * (double)d->orbit.samples;
  if (d->kind == DECK_WORK_PRECISION) points *= (double)(1 + d->methods.count);
  if (d->kind == DECK_HARD_CASES) points = d->cases.count > 0 ? (double)d->cases.count : 12.0;
  return points;
}

/* Values beside the grid's: strobe points of clouds, two numbers for each of two attractors, and
   of a bifurcation diagram. */
static double strobes_of(const deck *d)
{
  if (d->kind == DECK_BIFURCATION_DIAGRAM) return points_of(d) * (double)d->diagram.strobes * 2.0;
  if (d->kind != DECK_BASINS || !deck_has_noise(d)) return 0.0;
  return (double)d->axis[DECK_AXIS_TEMPERATURE].count * (double)d->basins.strobes * 4.0;
}

/* Bytes of a basin's states: by how many differ from their neighbours, or, where that is not known
   or rows are not computed whole, by the resolution alone, which makes runs of equal states
   longer. */
static double states_output(const deck *d, const farm_trial *t)
{
  const double states = points_of(d), same = size_of(d)->point;
  if (t != NULL && t->changes > 0.0 && !d->basins.refine)
    return same * states + change_bytes * t->changes;
  return states * (same + 150.0 / sqrt(states));
}

/* Bytes of a ramp, and of what noise does to it. */
static double ramp_output(const deck *d)
{
  if (!deck_has_ramp(d)) return 0.0;
  const double trajectories = deck_has_noise(d) ? (double)d->noise.trajectories : 0.0;
  return 45.0 * 2.0 * (double)d->ramp.points + 14.0 * trajectories;
}

static double points_output(const deck *d, const farm_trial *t)
{
  const scene_size *r = size_of(d);
  const double points = points_of(d);
  switch (d->kind) {
  case DECK_BASINS:
    return states_output(d, t) + (d->basins.boundary ? boundary_bytes : 0.0);
  case DECK_ORBIT:
    return r->point * fmin(points, FIRST_SAMPLES) +
           sample_bytes * fmax(points - FIRST_SAMPLES, 0.0);
  case DECK_PHASE_DIAGRAM:
    return r->point * points +
           (t != NULL && t->tasks > 0 ? record_output * t->journal / (double)t->tasks : 0.0);
  case DECK_HYSTERESIS: return r->point * points + ramp_output(d);
  default: return r->point * points;
  }
}

/* Bytes of the output. t: what a trial has shown; NULL: none. */
static double estimate_output(const deck *d, const farm_trial *t)
{
  const double strobe = d->kind == DECK_BIFURCATION_DIAGRAM ? repeated_bytes : strobe_bytes;
  return size_of(d)->head + points_output(d, t) + strobe * strobes_of(d);
}

/* Bytes of memory with this number of threads. */
static double estimate_memory(const deck *d, const farm_trial *t, int threads)
{
  double grid = size_of(d)->memory * points_of(d);
  /* Rows are written as they come; records that wait for their turn have this much (pool.c). */
  if (d->kind == DECK_BASINS && !d->basins.refine) grid = fmin(grid, 64e6);
  /* Whole points are in memory as long as they are few (scenes/temporary.h). */
  if (d->kind == DECK_RESPONSE) grid += fmin(7e3 * points_of(d), 64e6);
  if (d->kind == DECK_PHASE_DIAGRAM && t != NULL) grid += record_memory * t->journal;
  return program_memory + thread_memory * threads + grid + 16.0 * strobes_of(d);
}

/* Where not even a task could be tried it is a path's, whose points have a kilobyte each, and its
   strobe points. */
static double estimate_journal(const deck *d, const farm_trial *t)
{
  if (t->what == NULL) return t->journal;
  if (t->tried > 0) return t->journal * size_of(d)->stages;
  const int ways = d->kind == DECK_HYSTERESIS ? 2 : d->kind == DECK_BIFURCATION_DIAGRAM;
  return 1.2e3 * ways * points_of(d) + 8.0 * strobes_of(d);
}

/* How many times longer points take than at the usual damping, in the mean. */
static double slowness(const deck *d)
{
  const deck_axis *a = &d->axis[DECK_AXIS_DAMPING];
  const size_t n = a->count > 0 ? a->count : 1;
  const int branch = d->kind == DECK_HYSTERESIS || d->kind == DECK_BIFURCATION_DIAGRAM ||
                     d->kind == DECK_BRANCHES;
  const double most = branch ? slowest_branch : slowest;
  const double unit = deck_pendulum_units(d).time;
  double sum = 0.0;
  for (size_t i = 0; i < n; i++) {
    const double damping = unit * (a->count > 0 ? a->value[i] : d->pendulum.damping);
    sum += damping > 0.0 ? fmin(fmax(usual_damping / damping, 1.0), most) : 1.0;
  }
  return sum / (double)n;
}

/* ---- words --------------------------------------------------------------------------------- */

/* Two digits of a number of bytes. */
static void print_bytes(double bytes, FILE *out)
{
  static const char *const units[] = { "bytes", "kB", "MB", "GB", "TB", "PB" };
  int unit = 0;
  for (; bytes >= 999.5 && unit < 5; unit++) bytes /= 1000.0;
  fprintf(out, bytes < 9.95 ? "%.1f %s" : "%.0f %s", bytes, units[unit]);
}

static void print_seconds(double seconds, FILE *out)
{
  if (seconds < 100.0) fprintf(out, "%.2g s", seconds);
  else if (seconds < 600.0) fprintf(out, "%.1f min", seconds / 60.0);
  else if (seconds < 6000.0) fprintf(out, "%.0f min", seconds / 60.0);
  else if (seconds < 172800.0) fprintf(out, "%.1f h", seconds / 3600.0);
  else fprintf(out, "%.1f days", seconds / 86400.0);
}

/* What was tried, and how the trial ended. */
static void print_basis(const farm_trial *t, int rule, FILE *out)
{
  if (rule) fputs(", by a rule for scenes of this kind", out);
  if (t->what == NULL && !t->cut) fputs(": all of it was computed to see\n", out);
  else if (t->what == NULL) fputs(": what comes first takes longer than a trial\n", out);
  else if (t->tried == 0) fputs(": a task is too long to be tried\n", out);
  else
    fprintf(out, ": %zu of %zu %s were tried%s\n", t->tried, t->tasks, t->what,
            t->cut ? ", and another takes longer than a trial" : "");
}

static void print_time(const deck *d, const farm_trial *t, double outside, int threads, FILE *out)
{
  const scene_size *r = size_of(d);
  const int unknown = t->cut || (t->what != NULL && t->tried == 0);
  const double factor = t->what == NULL ? 1.0 : r->after;
  const double seen = program_seconds + outside + factor * t->seconds;
  const double seconds =
    unknown ? fmax(seen, r->seconds * points_of(d) * slowness(d)) : seen;
  fprintf(out, "time      %s ", t->cut && seconds == seen ? "at least" : "about");
  print_seconds(seconds, out);
  fputs(" of processor time", out);
  if (threads > 1) {
    fputs(", ", out);
    print_seconds(seconds / threads, out);
    fprintf(out, " or more on %d threads", threads);
  }
  print_basis(t, seconds > seen, out);
}

void estimate_print(const deck *d, const farm_trial *t, double outside, int threads, FILE *out)
{
  print_time(d, t, outside, threads, out);
  if (t->cost.settled_pendulums > 0.0)
    fprintf(out, "work      about %.2g pendulums settle, after %.2g drive periods altogether\n",
            t->cost.settled_pendulums, t->cost.pendulum_periods);
  else if (t->cost.pendulum_periods > 0.0)
    fprintf(out, "work      about %.2g drive periods of all pendulums\n", t->cost.pendulum_periods);
  fputs("memory    about ", out);
  print_bytes(estimate_memory(d, t, threads), out);
  fputs("\noutput    about ", out);
  print_bytes(estimate_output(d, t), out);
  const double journal = estimate_journal(d, t);
  if (journal > 0.0) {
    fputs(", and while the run lasts a journal of ", out);
    print_bytes(journal, out);
  }
  fputs("\n", out);
}

/* ---- space on the disk --------------------------------------------------------------------- */

/* Bytes that this user can write in the folder of `path`; NaN: unknown. */
static double space_beside(const char *path)
{
  char folder[DECK_PATH + 16];
  struct statvfs info;
  const char *slash = strrchr(path, '/');
  const int length = slash == NULL ? 0 : (int)(slash - path) + 1;
  snprintf(folder, sizeof folder, "%.*s", length == 0 ? 1 : length, length == 0 ? "." : path);
  if (statvfs(folder, &info) != 0) return NAN;
  return (double)info.f_bavail * (double)info.f_frsize;
}

void estimate_print_space(const char *path, FILE *out)
{
  const double space = space_beside(path);
  if (isnan(space)) return;
  fputs("disk      ", out);
  print_bytes(space, out);
  fputs(" free where the output goes\n", out);
}

/* Bytes of memory that this machine has. */
static double memory_there(void)
{
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  return pages > 0 && page > 0 ? (double)pages * (double)page : INFINITY;
}

int estimate_fits(const deck *d, const farm *f, progress *p)
{
  const double space = space_beside(d->output), needed = estimate_output(d, NULL);
  const double memory = estimate_memory(d, NULL, farm_threads(f));
  if (!isnan(space) && space < needed)
    progress_note(p, "the output will take about %.2g MB, and where it goes only %.2g MB are free",
                  1e-6 * needed, 1e-6 * space);
  if (memory <= memory_there()) return 1;
  progress_error(p, "the run will take about %.2g GB of memory, and this machine has %.2g GB",
                 1e-9 * memory, 1e-9 * memory_there());
  return 0;
}
