/* estimate.c -- rules and words; see run.h. */
#define _DEFAULT_SOURCE /* statvfs, _SC_PHYS_PAGES */

#include <math.h>
#include <string.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "terminal/safe_text.h"
#include "run.h"
#include "scenes/outer.h"

/* What every run has in memory, and what a thread adds. */
static const double program_memory = 19e6, thread_memory = 9e6;

/* Seconds that a program takes to start and to write what is short. */
static const double program_seconds = 0.02;

/* The damping at which the seconds a point of scene_size were measured. Below it pendulums settle
   as much longer as it is weaker, down to where budgets of periods and searches end them. */
static const double usual_damping = 0.2, slowest = 300.0;

static const scene_size *size_of(const deck *d)
{
  return &scene_find(d->kind)->size;
}

/* Scenes that are computed. */
static double runs_of(const deck *d)
{
  return deck_slices(d) > 0 ? (double)deck_slices(d) : 1.0;
}

/* Points of the results, of one of them. */
static double points_of(const deck *d)
{
  double points = 1.0;
  if (size_of(d)->points != NULL) return size_of(d)->points(d);
  for (int axis = 0; axis < DECK_AXIS_OUTER; axis++)
    if (axis != DECK_AXIS_TEMPERATURE && d->axis[axis].count > 0)
      points *= (double)d->axis[axis].count;
  return points;
}

static double values_of(const deck *d)
{
  return size_of(d)->values != NULL ? size_of(d)->values(d) : 0.0;
}

static scene_more more_of(const deck *d, const farm_trial *t)
{
  const scene_size *s = size_of(d);
  return s->more != NULL ? s->more(d, t, points_of(d)) : (scene_more){0.0, 0.0};
}

/* Bytes of the output. t: what a trial has shown; NULL: none. */
static double estimate_output(const deck *d, const farm_trial *t)
{
  const scene_size *s = size_of(d);
  return s->head + runs_of(d) * (s->point * points_of(d) + s->value * values_of(d) +
                                 more_of(d, t).output);
}

/* Bytes of memory with this number of threads. */
static double estimate_memory(const deck *d, const farm_trial *t, int threads)
{
  return program_memory + thread_memory * threads + size_of(d)->memory * points_of(d) +
         16.0 * values_of(d) + more_of(d, t).memory;
}

static double estimate_journal(const deck *d, const farm_trial *t)
{
  const int partly = t->path > 0.0 && t->path < 1.0;
  const double bytes = size_of(d)->journal * points_of(d) + 8.0 * values_of(d);
  if (t->what == NULL) return t->journal;
  if (t->journal > 0.0 && !partly) return t->journal * size_of(d)->stages;
  return runs_of(d) * (bytes + (partly ? farm_states(t->seconds / runs_of(d), bytes) : 0.0));
}

/* How many times longer points take than at the usual damping, in the mean. *beyond: some would
   take longer than the most that is known of their kind. */
static double slowness(const deck *d, int *beyond)
{
  const deck_axis *a = &d->axis[DECK_AXIS_DAMPING];
  const size_t n = a->count > 0 ? a->count : 1;
  const scene_size *s = size_of(d);
  const double most = s->searched > 0.0  ? s->searched / s->seconds
                      : s->slowest > 0.0 ? s->slowest : slowest;
  const double unit = deck_pendulum_units(d).time;
  double sum = 0.0;
  for (size_t i = 0; i < n; i++) {
    pendres_pendulum p = d->pendulum;
    if (a->count > 0) p.damping = a->value[i];
    const double damping = unit * pendres_pendulum_decay_rate(&p);
    const double times = damping > 0.0 ? fmax(usual_damping / damping, 1.0) : 1.0;
    sum += fmin(times, most);
    *beyond |= s->searched > 0.0 && times > most;
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
  else if (t->members) fputs(", by what some members need at one point", out);
  if (t->path > 0.0 && t->path < 1.0)
    fprintf(out, ", if the rest of its path is like the first %.2g %%", 100.0 * t->path);
  if (t->what == NULL && !t->cut) fputs(": all of it was computed to see\n", out);
  else if (t->what == NULL) fputs(": what comes first takes longer than a trial\n", out);
  else if (t->tried == 0) fputs(": a task is too long to be tried\n", out);
  else
    fprintf(out, ": %zu of %zu %s were tried%s\n", t->tried, t->tasks, t->what,
            t->cut ? ", and the next would have taken longer than a trial may" : "");
}

static void print_time(const deck *d, const farm_trial *t, int threads, FILE *out)
{
  const scene_size *r = size_of(d);
  const int unknown = t->cut || (t->what != NULL && t->tried == 0);
  const double factor = t->what == NULL ? 1.0 : r->after;
  const double seen = program_seconds + t->outside + factor * t->seconds;
  const double points = runs_of(d) * points_of(d);
  int beyond = 0;
  const double rule = points * r->seconds * slowness(d, &beyond);
  const double most = r->searched > 0.0 ? fmax(points * r->searched, t->spent) : INFINITY;
  const double seconds = unknown ? fmin(fmax(seen, rule), most) : seen;
  const int least = unknown && (beyond || (t->cut && !t->members && seconds == seen));
  fprintf(out, "time      %s ", least ? "at least" : "about");
  print_seconds(seconds, out);
  fputs(" of processor time", out);
  if (threads > 1) {
    fputs(", ", out);
    print_seconds(seconds / threads, out);
    fprintf(out, " or more on %d threads", threads);
  }
  print_basis(t, seconds > seen, out);
}

static void print_estimate(const deck *d, const farm_trial *t, int threads, FILE *out)
{
  print_time(d, t, threads, out);
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

static void print_space(const char *path, FILE *out)
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

/* ---- --dry-run ----------------------------------------------------------------------------- */

/* Processor seconds: no new task is begun after the first, and after the second nothing goes on. */
static const double few_seconds = 1.0, most_seconds = 5.0;

/* Costs of tasks differ by ten and more: a mean of two would not do. */
enum { least_tasks = 6 };

/* And enough members to meet what an ensemble meets, if they are spread over its range. */
enum { few_members = 8 };

static void print_line(const char *name, const char *text)
{
  printf("%-9s ", name);
  safe_text_write(stdout, text);
  putchar('\n');
}

static void print_description(const scene_run *run, const scene_kind *scene)
{
  const deck *d = run->deck;
  print_line("deck", d->name);
  if (d->title[0] != '\0') print_line("title", d->title);
  print_line("scene", deck_kind_name(d->kind));
  print_line("output", d->output);
  printf("tolerance %g\n", d->precision.tolerance);
  printf("threads   %d\n\n", farm_threads(run->farm));
  scene_describe_all(d, scene, stdout);
}

/* Of an outer axis some slices are tried, which stand for all. */
static void add_trial(const farm_trial *t, double times, farm_trial *sum)
{
  sum->seconds += times * t->seconds;
  sum->journal += times * t->journal;
  sum->changes += t->changes;
  sum->cost.pendulum_periods += times * t->cost.pendulum_periods;
  sum->cost.settled_pendulums += times * t->cost.settled_pendulums;
  sum->spent += times * t->spent;
  sum->periods += times * t->periods;
  sum->cut |= t->cut;
  sum->path = t->path;
  if (t->what == NULL) return;
  sum->what = t->what;
  sum->tasks += t->tasks;
  sum->tried += t->tried;
}

/* Try all that a trial tries of a deck, into a file that is let go of with the run. */
static pendres_status try_deck(scene_run *run, const scene_kind *scene, farm_trial *sum)
{
  char path[DECK_PATH];
  const size_t tries = scene_trials(run->deck);
  pendres_store_free(run->store);
  together_output(path, sizeof path);
  if (scene_stored(run, pendres_store_create(path, NULL, &run->store)) != PENDRES_OK)
    return run->status;
  for (size_t i = 0; i < tries; i++) {
    const double times = runs_of(run->deck) / (double)tries;
    farm_trial one = { .few = few_seconds / (double)tries, .most = most_seconds / (double)tries,
                       .least = least_tasks };
    farm_set_trial(run->farm, &one);
    const pendres_status status = scene_try(run, scene, i);
    farm_set_trial(run->farm, NULL);
    if (status != PENDRES_OK && status != PENDRES_INTERRUPTED) return status;
    /* Interrupted before there were tasks, or between them. */
    if (status == PENDRES_INTERRUPTED && one.what == NULL) one.cut = 1;
    sum->outside += times * farm_trial_outside(&one);
    add_trial(&one, times, sum);
  }
  return PENDRES_OK;
}

/* Some members at one point, in the place of tasks that are too long: how many drive periods they
   take is known then, and from the tasks how many a second has. */
static pendres_status try_members(scene_run *run, const scene_kind *scene, farm_trial *whole)
{
  const deck *d = run->deck;
  deck few = *d;
  if (!scene->size.members || whole->tried > 0 || !whole->cut) return PENDRES_OK;
  for (int axis = 0; axis < DECK_AXIS_OUTER; axis++) {
    deck_axis *a = &few.axis[axis];
    a->value += a->count / 2;
    a->count = a->count > 0;
  }
  if (few.ensemble.members > few_members) few.ensemble.members = few_members;
  farm_trial t = { .seconds = 0.0 };
  run->deck = &few;
  run->status = PENDRES_OK;
  const pendres_status status = try_deck(run, scene, &t);
  run->deck = d;
  const double times = points_of(d) * (double)d->ensemble.members /
                       (points_of(&few) * (double)few.ensemble.members);
  const double seconds = times * t.periods * whole->spent / fmax(whole->periods, 1.0);
  if (status != PENDRES_OK || !(seconds > whole->seconds)) return status;
  whole->seconds = seconds;
  whole->members = !t.cut;
  return status;
}

int estimate_dry_run(scene_run *run, const scene_kind *scene, progress *p)
{
  farm_trial trial = { .seconds = 0.0 };
  print_description(run, scene);
  (void)fflush(stdout);
  pendres_status status = try_deck(run, scene, &trial);
  if (status == PENDRES_OK) status = try_members(run, scene, &trial);
  putchar('\n');
  if (status != PENDRES_OK) {
    progress_error(p, "%s", progress_words(run->message, status));
    return FAILED;
  }
  print_estimate(run->deck, &trial, farm_threads(run->farm), stdout);
  print_space(run->deck->output, stdout);
  return DONE;
}
