/*
 * accuracy_search.c -- whether a search for the largest loop area overlooks a larger one: every
 * resonance beside the responses at 400 frequencies of its range, computed one by one.
 */
#define _POSIX_C_SOURCE 200809L /* clock_gettime */
#include "accuracy.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "analysis/sweeps/sweep.h"

enum { FREQUENCIES = 400, PART = 20, HOW = 200 };

/* Where every member is chaotic a response takes seconds: what this long is not enough for stays
 * unseen, and is counted. */
static const double most_seconds = 40.0;

typedef struct item {
  pendres_pendulum pendulum;
  double lowest, highest;
  pendres_status status;
  pendres_resonance found;
  double largest, largest_error, at; /* of those computed one by one */
  int seen;                          /* how many of them */
} item;

static void draw(accuracy_random *r, item *t)
{
  t->pendulum = (pendres_pendulum){.damping = accuracy_logarithmic(r, 0.03, 1.0),
                                   .drive_amplitude = accuracy_logarithmic(r, 0.02, 0.6),
                                   .drive_frequency = 1.0};
  t->lowest = accuracy_uniform(r, 0.05, 1.2);
  t->highest = accuracy_uniform(r, t->lowest + 0.05, 2.0);
}

static double seconds_of_this_thread(void)
{
  struct timespec now = {0};
  (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void look_everywhere(pendres_context *ctx, item *t)
{
  const pendres_ensemble ensemble = pendres_ensemble_default();
  const pendres_range range = {t->lowest, t->highest, FREQUENCIES};
  const double start = seconds_of_this_thread();
  pendres_response *r = calloc(PART, sizeof *r);
  t->largest = -INFINITY;
  for (int first = 0; r != NULL && first < FREQUENCIES; first += PART) {
    pendres_pendulum p[PART];
    for (int i = 0; i < PART; i++) {
      p[i] = t->pendulum;
      p[i].drive_frequency = pendres_range_value(&range, (size_t)(first + i));
    }
    if (seconds_of_this_thread() - start > most_seconds ||
        pendres_response_find(ctx, PART, p, &ensemble, r) != PENDRES_OK)
      break;
    t->seen += PART;
    for (int i = 0; i < PART; i++)
      if (r[i].mean_loop_area - r[i].mean_loop_area_error > t->largest - t->largest_error) {
        t->largest = r[i].mean_loop_area;
        t->largest_error = r[i].mean_loop_area_error;
        t->at = p[i].drive_frequency;
      }
  }
  free(r);
}

static void compute(accuracy_random *r, void *of, long number)
{
  item *t = of;
  pendres_context *ctx = NULL;
  (void)number;
  draw(r, t);
  t->status = pendres_context_create(NULL, &ctx);
  if (t->status == PENDRES_OK)
    t->status = pendres_resonance_find(ctx, &t->pendulum, t->lowest, t->highest, &t->found);
  if (t->status == PENDRES_OK) look_everywhere(ctx, t);
  pendres_context_free(ctx);
}

typedef struct tally {
  long peaks, ragged, cut, none;
} tally;

static void note(accuracy *a, const void *of, long number, void *counts)
{
  const item *t = of;
  tally *c = counts;
  const pendres_resonance *f = &t->found;
  char how[HOW];
  snprintf(how, sizeof how, "item %ld: F0 %.17g, damping %.17g, range %.17g to %.17g: at %.17g",
           number, t->pendulum.drive_amplitude, t->pendulum.damping, t->lowest, t->highest, t->at);
  if (t->status != PENDRES_OK) {
    c->none++;
    if (t->status != PENDRES_NOT_FOUND && t->status != PENDRES_NOT_CONVERGED)
      accuracy_complain(a, "the search failed", how);
    return;
  }
  c->peaks++;
  c->ragged += f->peak == PENDRES_PEAK_RAGGED;
  c->cut += t->seen < FREQUENCIES;
  if (!(t->largest - t->largest_error <= f->loop_area + f->loop_area_error))
    accuracy_complain(a, "a larger loop area than the largest", how);
}

void accuracy_search(accuracy *a)
{
  tally c = {0};
  accuracy_each(a, &(accuracy_work){.items = accuracy_get_options(a)->points / 5, .at_once = 8,
                                    .size = sizeof(item), .compute = compute, .note = note,
                                    .tally = &c});
  printf("\nsearch: %ld resonances, %ld of them ragged, %ld not beside all %d frequencies; %ld "
         "ranges without one\n", c.peaks, c.ragged, c.cut, (int)FREQUENCIES, c.none);
}
