/* point.c -- the point that a task is computing; see pool_internal.h and farm_point(). */
#include "farm/pool_internal.h"

#include <stdarg.h>
#include <stdio.h>

#include "farm/dispatch.h"
#include "farm/numbers.h"
#include "system/clock.h"

enum { WORDS = 400 };

/* Seconds a point of the stage, on average; 0 while there are too few. */
static double mean_of(pool *c)
{
  pthread_mutex_lock(&c->lock);
  const double mean = c->points < POINTS_BEFORE ? 0.0 : c->point_seconds / (double)c->points;
  pthread_mutex_unlock(&c->lock);
  return mean;
}

/* Compared with the mean of at least this number of points, which is reported, too. */
static int is_costly(const farm_watch *w, double spent, double *mean)
{
  const progress *p = w->pool->farm->options.progress;
  if (p == NULL || spent < costly_wait * p->every) return 0;
  *mean = (double)w->points * mean_of(w->pool);
  return *mean > 0.0 && spent > costly_times * *mean;
}

static void tell_costly(farm_watch *w, double spent, double mean)
{
  char words[WORDS];
  const double budget = w->pool->farm->options.budget;
  const int n = snprintf(words, sizeof words, "%s takes long: %.2g s of processor time by now, "
                         "%.0f times what points took so far", w->name, spent, spent / mean);
  if (budget > 0.0)
    snprintf(words + n, sizeof words - (size_t)n, "; its budget ends it after %g s",
             budget * (double)w->points);
  else
    snprintf(words + n, sizeof words - (size_t)n, " (--budget=SECONDS ends such points)");
  w->told = 1;
  dispatch_tell(w->pool, words);
}

int point_over(farm_watch *w, long long now)
{
  if (w->points == 0 || w->over || now < w->look) return w->over;
  const double budget = w->pool->farm->options.budget, points = (double)w->points;
  const double spent = clock_thread() - w->start;
  double mean;
  w->look = now + LOOK_EVERY;
  if (!w->told && is_costly(w, spent, &mean)) tell_costly(w, spent, mean);
  w->over = budget > 0.0 && spent > budget * points;
  w->spent = spent;
  return w->over;
}

void point_end(farm_watch *w)
{
  pool *c = w->pool;
  if (w->points == 0) return;
  if (!w->over) {
    const double spent = clock_thread() - w->start;
    pthread_mutex_lock(&c->lock);
    c->points += w->points;
    c->point_seconds += spent;
    pthread_mutex_unlock(&c->lock);
  }
  w->points = 0;
  w->over = 0;
}

void farm_point(farm_record *record, size_t points, const char *format, ...)
{
  va_list args;
  farm_watch *w = record->watch;
  if (w == NULL) return; /* as in a trial */
  point_end(w);
  va_start(args, format);
  (void)vsnprintf(w->name, sizeof w->name, format, args);
  va_end(args);
  pthread_mutex_lock(&w->pool->lock);
  at_work *bench = &w->pool->bench[w->thread];
  snprintf(bench->name, sizeof bench->name, "%s", w->name);
  bench->since = pool_milliseconds();
  pthread_mutex_unlock(&w->pool->lock);
  w->points = points;
  w->told = 0;
  w->look = 0;
  w->start = clock_thread();
}

int farm_gave_up(const farm_record *record, pendres_status status)
{
  return status == PENDRES_INTERRUPTED && record->watch != NULL && record->watch->over;
}

void farm_lost_some(farm_record *record, size_t lost, char *words, size_t size)
{
  const farm_watch *w = record->watch;
  record->lost += lost;
  if (words == NULL) return;
  const double mean = mean_of(w->pool), spent = w->spent / (double)w->points;
  char times[80] = "";
  if (mean > 0.0)
    snprintf(times, sizeof times, ", %.3g times what points took so far", spent / mean);
  snprintf(words, size, "ended by its budget after %.3g s of processor time%s: raise "
           "--budget=SECONDS, or bound its drive periods by precision.period_budget", spent, times);
}

void farm_lost(farm_record *record, char *words, size_t size)
{
  const farm_watch *w = record->watch;
  farm_lost_some(record, w->points, words, size);
}
