/* failed.c -- points without a whole result; see failed.h. */
#include "results/failed.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "results/numbers.h"

static const struct {
  const char *meaning, *words;
} reasons[] = {
#define REASON(code, meaning, words) { meaning, words },
  SCENE_FAILURE_LIST(REASON)
#undef REASON
};

scene_failure scene_failure_of(pendres_status status)
{
  switch (status) {
  case PENDRES_UNRESOLVED: return SCENE_FAILURE_UNRESOLVED;
  case PENDRES_INTEGRATION_FAILED: return SCENE_FAILURE_INTEGRATION;
  case PENDRES_TOLERANCE_UNREACHABLE: return SCENE_FAILURE_TOLERANCE;
  case PENDRES_NOT_CONVERGED: return SCENE_FAILURE_NOT_CONVERGED;
  case PENDRES_NOT_FOUND: return SCENE_FAILURE_NOT_FOUND;
  case PENDRES_INVALID_ARGUMENT: return SCENE_FAILURE_REFUSED;
  default: return SCENE_FAILURE_NONE;
  }
}

/* Whether settling takes too many steps. charted: a weakly damped pendulum that comes back to the
   same places again and again is not integrated there each time (the library's charts). */
static int too_long(const pendres_pendulum *p, double runs, int charted, char *words, size_t size)
{
  /* E-folding times after which 1e-8 of a start is left; the least number of periods of a
     verdict. */
  const double times = 18.0, periods = 20.0;
  /* In the pendulum's units: how fast it oscillates is of order one in them. */
  const pendres_units units = pendres_units_of(p);
  const double time = units.time;
  const double damping = time * pendres_pendulum_decay_rate(p);
  const double frequency = time * p->drive_frequency;
  /* The steps of about a minute. At weak damping chaos lasts long, and labels take several runs: a
     quarter of the steps is left for each. Slow drives settle within a period or two, of many
     steps. */
  const int weak = damping < 2.0;
  const double most_settling = weak ? 5e6 : 2e7, most = weak ? 2e9 : 2e7;
  const double half = 0.5 * damping;
  const double rate = half < 1.0 ? half : 1.0 / (half + sqrt(half * half - 1.0));
  /* No less than the fewest steps that a period is integrated with. */
  const double steps_per_time =
    fmax(fmax(damping / 4.0, 1.0 / 1.5), 8.0 * frequency / (2.0 * PENDRES_PI));
  double settling = runs * steps_per_time * times / rate;
  const double drive = fmax(fabs(p->drive_amplitude) * time * time / units.length,
                            fabs(p->parametric_amplitude));
  if (charted && weak && drive <= charted_drive) settling *= charted_share;
  const double steps =
    settling + runs * steps_per_time * periods * 2.0 * PENDRES_PI / frequency;
  if (settling <= most_settling && steps <= most) return 0;
  const int n = snprintf(words, size, "damping %g, drive_frequency %g ask for some %.1e steps of "
                         "the integrator, more than %.0e", p->damping, p->drive_frequency, steps,
                         settling > most_settling ? most_settling : most);
  if (frequency > far_above && n > 0 && (size_t)n < size)
    snprintf(words + n, size - (size_t)n, "; the drive has %.0e times the natural frequency",
             frequency);
  return 1;
}

int scene_failure_too_long(const pendres_pendulum *p, double runs, char *words, size_t size)
{
  return too_long(p, runs, 0, words, size);
}

int scene_settling_too_long(const deck *d, const pendres_pendulum *p, double runs, char *words,
                            size_t size)
{
  char why[200];
  const int charted =
    strcmp(d->precision.method, "block_fixed") == 0 && d->precision.steps_per_period == 0;
  if (d->precision.period_budget > 0 || !(pendres_pendulum_decay_rate(p) > 0.0)) return 0;
  if (!too_long(p, runs, charted, why, sizeof why)) return 0;
  snprintf(words, size, "%s; precision.period_budget bounds them", why);
  return 1;
}

void scene_failure_mark(scene_run *run, scene_failed *point, scene_failure reason,
                        const char *words)
{
  char *copy = NULL;
  if (words != NULL && words[0] != '\0') copy = scene_array(run, strlen(words) + 1, 1);
  if (copy != NULL) strcpy(copy, words);
  *point = (scene_failed){reason, copy};
}

void scene_point_name(const deck *d, size_t point, int axes, const deck_axis_id *axis, char *text,
                      size_t size)
{
  size_t block = 1, used = 0;
  text[0] = '\0';
  for (int i = 1; i < axes; i++) block *= d->axis[axis[i]].count;
  for (int i = 0; i < axes; i++) {
    const deck_axis *a = &d->axis[axis[i]];
    const int n = snprintf(text + used, size - used, "%s%s %.10g", i > 0 ? ", " : "",
                           deck_axis_name(axis[i]), a->value[point / block % a->count]);
    if (n < 0 || (size_t)n >= size - used) return;
    used += (size_t)n;
    if (i + 1 < axes) block /= d->axis[axis[i + 1]].count;
  }
}

void scene_failure_unsettled(const deck *d, size_t some, size_t all, const char *what,
                             double multiplier, char words[SCENE_TOLD])
{
  char periods[80] = "the budget of periods that damping and tolerance make", weakest[60] = "";
  if (d->precision.period_budget > 0)
    snprintf(periods, sizeof periods, "%lld periods", (long long)d->precision.period_budget);
  if (!isnan(multiplier))
    snprintf(weakest, sizeof weakest, " (weakest multiplier %.4g)", multiplier);
  const double frequency = deck_pendulum_units(d).time * deck_pendulum(d).drive_frequency;
  const int n = snprintf(words, SCENE_TOLD, "%zu of %zu %s did not settle within %s%s: ", some, all,
                         what, periods, weakest);
  if (n < 0 || n >= SCENE_TOLD) return;
  if (frequency > far_above)
    snprintf(words + n, (size_t)(SCENE_TOLD - n), "the drive has %.0e times the natural frequency",
             frequency);
  else snprintf(words + n, (size_t)(SCENE_TOLD - n), "raise precision.period_budget");
}

/* ---- the terminal -------------------------------------------------------------------------- */

void scene_failure_count(scene_run *run, scene_failure reason, size_t n)
{
  run->failed_points += n;
  if (reason == SCENE_FAILURE_UNRESOLVED) run->unresolved += n;
}

void scene_failure_tell(scene_run *run, scene_failure reason, const char *words,
                        const char *format, ...)
{
  const int open = reason == SCENE_FAILURE_UNRESOLVED;
  size_t at = run->told_count;
  if (at == SCENE_MOST_TOLD) { /* a failure takes the place of what a deck may tolerate */
    if (open || !(run->deck->precision.unresolved_share > 0.0)) return;
    while (at > 0 && !run->told_open[at - 1]) at--;
    if (at-- == 0) return;
  } else {
    run->told_count++;
  }
  run->told_open[at] = (char)open;
  char *line = run->told[at];
  va_list args;
  snprintf(line, SCENE_TOLD, "%s%s", run->where, run->where[0] != '\0' ? ", " : "");
  size_t used = strlen(line);
  va_start(args, format);
  (void)vsnprintf(line + used, SCENE_TOLD - used, format, args);
  va_end(args);
  used = strlen(line);
  snprintf(line + used, SCENE_TOLD - used, ": %s", words != NULL ? words : reasons[reason].words);
}

int scene_failures_told(const scene_run *run, const char *where, progress *p)
{
  const double share = run->deck->precision.unresolved_share;
  const int within = (double)run->unresolved <= share * (double)run->points;
  const size_t tolerated = within ? run->unresolved : 0, failed = run->failed_points - tolerated;
  for (size_t i = 0; i < run->told_count; i++)
    if (tolerated > 0 && run->told_open[i]) progress_note(p, "%s", run->told[i]);
    else progress_error(p, "%s", run->told[i]);
  if (tolerated > 0)
    progress_note(p, "%zu of %zu points unresolved, which precision.unresolved_share = %g "
                  "tolerates, %s", tolerated, run->points, share, where);
  if (failed > 0)
    progress_error(p, "%zu point%s failed, %s", failed, failed == 1 ? "" : "s", where);
  return failed > 0;
}

/* ---- the file ------------------------------------------------------------------------------ */

const char *scene_failure_names(int value)
{
  return value >= 0 && value < SCENE_FAILURE_COUNT ? reasons[value].meaning : NULL;
}
