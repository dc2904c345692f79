/* accuracy_table.c -- draws, notes and tables; see accuracy.h. */
#include "accuracy.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { KINDS = 64 };

/*
 * The goals. Fewer than 30 results of a kind have no median to speak of, and a single one of fewer
 * than 1000 beyond its claim does not tell whether the share is above a thousandth: it is printed
 * with what repeats it, and two are more than that share lets expect.
 */
static const double most_beyond = 1e-3, worst_ratio = 3.0;
static const double least_median = 0.03, most_median = 0.7;
enum { ENOUGH_FOR_MEDIAN = 30 };

/* A result that falls short, and how to have it again. */
typedef struct shortfall {
  double ratio, error, claimed;
  char *how;
} shortfall;

typedef struct kind {
  char name[64];
  double *ratio;
  size_t count, size;
  size_t marked; /* of which no finite error was claimed */
  shortfall *shortfalls;
  size_t short_count, short_size;
} kind;

struct accuracy {
  accuracy_options options;
  const char *section;
  kind kinds[KINDS];
  size_t kind_count;
  size_t complaints;
};

static void *grown(void *memory, size_t count, size_t *size, size_t each)
{
  if (count < *size) return memory;
  *size = *size > 0 ? 2 * *size : 64;
  memory = realloc(memory, *size * each);
  if (memory == NULL) {
    fprintf(stderr, "accuracy: out of memory\n");
    exit(1);
  }
  return memory;
}

accuracy *accuracy_create(const accuracy_options *options)
{
  accuracy *a = calloc(1, sizeof *a);
  if (a != NULL) a->options = *options;
  return a;
}

static void clear_kinds(accuracy *a)
{
  for (size_t k = 0; k < a->kind_count; k++) {
    for (size_t i = 0; i < a->kinds[k].short_count; i++) free(a->kinds[k].shortfalls[i].how);
    free(a->kinds[k].ratio);
    free(a->kinds[k].shortfalls);
  }
  memset(a->kinds, 0, sizeof a->kinds);
  a->kind_count = 0;
  a->complaints = 0;
}

void accuracy_free(accuracy *a)
{
  if (a != NULL) clear_kinds(a);
  free(a);
}

const accuracy_options *accuracy_get_options(const accuracy *a)
{
  return &a->options;
}

/* ---- draws: splitmix64 ---- */

static uint64_t mixed(uint64_t z)
{
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return z ^ (z >> 31);
}

accuracy_random accuracy_item(const accuracy *a, long item)
{
  uint64_t state = mixed(a->options.seed + UINT64_C(0x9e3779b97f4a7c15));
  for (const char *s = a->section; *s != '\0'; s++) state = mixed(state ^ (uint64_t)*s);
  return (accuracy_random){.state = mixed(state + (uint64_t)item)};
}

double accuracy_uniform(accuracy_random *r, double from, double to)
{
  r->state += UINT64_C(0x9e3779b97f4a7c15);
  return from + (to - from) * ((double)(mixed(r->state) >> 11) * 0x1p-53);
}

double accuracy_logarithmic(accuracy_random *r, double from, double to)
{
  return exp(accuracy_uniform(r, log(from), log(to)));
}

int accuracy_choice(accuracy_random *r, int n)
{
  return (int)accuracy_uniform(r, 0.0, n);
}

/* Small values matter as much as large ones. */
static double either_way(accuracy_random *r, double from, double to)
{
  return accuracy_choice(r, 2) == 0 ? accuracy_uniform(r, from, to)
                                    : accuracy_logarithmic(r, from, to);
}

pendres_pendulum accuracy_pendulum(accuracy_random *r)
{
  pendres_pendulum p = {0};
  p.drive_amplitude = either_way(r, 0.01, 1.5);
  p.damping = either_way(r, 0.03, 3.0);
  p.drive_frequency = either_way(r, 0.1, 2.0);
  return p;
}

double accuracy_tolerance(accuracy_random *r)
{
  return accuracy_logarithmic(r, 1e-12, 1e-3);
}

/* ---- items ---- */

long accuracy_each(accuracy *a, const accuracy_work *w)
{
  const long asked = a->options.item;
  const long first = asked >= 0 ? asked : 0, last = asked >= 0 ? asked + 1 : w->items;
  char *items = malloc((size_t)w->at_once * w->size);
  if (items == NULL) {
    accuracy_complain(a, "out of memory", a->section);
    return 0;
  }
  for (long base = first; base < last; base += w->at_once) {
    const long n = last - base < w->at_once ? last - base : w->at_once;
    memset(items, 0, (size_t)n * w->size);
#pragma omp parallel for schedule(dynamic)
    for (long i = 0; i < n; i++) {
      accuracy_random r = accuracy_item(a, base + i);
      w->compute(&r, items + (size_t)i * w->size, base + i);
    }
    for (long i = 0; i < n; i++) w->note(a, items + (size_t)i * w->size, base + i, w->tally);
  }
  free(items);
  return last - first;
}

/* ---- notes ---- */

static kind *kind_named(accuracy *a, const char *name)
{
  for (size_t k = 0; k < a->kind_count; k++)
    if (strcmp(a->kinds[k].name, name) == 0) return &a->kinds[k];
  if (a->kind_count == KINDS) {
    fprintf(stderr, "accuracy: more than %d kinds of results\n", KINDS);
    exit(1);
  }
  kind *k = &a->kinds[a->kind_count++];
  snprintf(k->name, sizeof k->name, "%s", name);
  return k;
}

void accuracy_note_error(accuracy *a, const char *name, double error, double claimed,
                         const char *how)
{
  kind *k = kind_named(a, name);
  if (!isfinite(claimed)) {
    k->marked++;
    return;
  }
  double ratio = error == 0.0 ? 0.0 : error / claimed;
  if (isnan(ratio) || claimed < 0.0) ratio = INFINITY;
  k->ratio = grown(k->ratio, k->count, &k->size, sizeof *k->ratio);
  k->ratio[k->count++] = ratio;
  if (a->options.item >= 0)
    printf("  %-24s off by %.3g, claims %.3g\n", name, error, claimed);
  if (!(ratio > 1.0)) return;
  k->shortfalls = grown(k->shortfalls, k->short_count, &k->short_size, sizeof *k->shortfalls);
  shortfall *s = &k->shortfalls[k->short_count++];
  *s = (shortfall){.ratio = ratio, .error = error, .claimed = claimed};
  s->how = malloc(strlen(how) + 1);
  if (s->how != NULL) strcpy(s->how, how);
}

void accuracy_note(accuracy *a, const char *name, double got, double claimed, long double wanted,
                   const char *how)
{
  accuracy_note_error(a, name, (double)fabsl((long double)got - wanted), claimed, how);
}

void accuracy_complain(accuracy *a, const char *what, const char *how)
{
  if (a->complaints++ < (size_t)a->options.show) printf("%s:\n  %s\n", what, how);
}

/* ---- tables ---- */

static int by_value(const void *p, const void *q)
{
  const double a = *(const double *)p, b = *(const double *)q;
  return (a > b) - (a < b);
}

static int worst_first(const void *p, const void *q)
{
  const shortfall *a = p, *b = q;
  return (a->ratio < b->ratio) - (a->ratio > b->ratio);
}

static int print_kind(kind *k)
{
  size_t below = 0, beyond = 0;
  if (k->count == 0) {
    printf("%-30s %7zu %7zu\n", k->name, k->count, k->marked);
    return 1;
  }
  qsort(k->ratio, k->count, sizeof *k->ratio, by_value);
  const double median = k->ratio[k->count / 2], largest = k->ratio[k->count - 1];
  for (size_t i = 0; i < k->count; i++) {
    below += k->ratio[i] < 0.01;
    beyond += k->ratio[i] > 1.0;
  }
  const double share = (double)beyond / (double)k->count;
  const int wide = k->count >= ENOUGH_FOR_MEDIAN &&
                   !(median >= least_median && median <= most_median);
  const int many = beyond > 1 && share > most_beyond;
  const int met = !many && largest <= worst_ratio && !wide;
  printf("%-30s %7zu %7zu %8.3f %9.3g %8.3f%% %8.1f%%%s\n", k->name, k->count, k->marked, median,
         largest, 100.0 * share, 100.0 * (double)below / (double)k->count, met ? "" : "  *");
  return met;
}

static void print_shortfalls(const accuracy *a, kind *k)
{
  if (k->short_count == 0) return;
  qsort(k->shortfalls, k->short_count, sizeof *k->shortfalls, worst_first);
  for (size_t i = 0; i < k->short_count && i < (size_t)a->options.show; i++) {
    const shortfall *s = &k->shortfalls[i];
    printf("%s: off by %.3g, %.3g times the claim of %.3g:\n  %s\n", k->name, s->error, s->ratio,
           s->claimed, s->how != NULL ? s->how : "(out of memory)");
  }
}

void accuracy_begin_section(accuracy *a, const char *name)
{
  clear_kinds(a);
  a->section = name;
}

int accuracy_end_section(accuracy *a)
{
  int met = a->complaints == 0;
  printf("\n%s: true error over the claimed one\n", a->section);
  printf("%-30s %7s %7s %8s %9s %9s %9s\n", "", "number", "marked", "median", "largest",
         "beyond 1", "< 0.01");
  for (size_t k = 0; k < a->kind_count; k++) met &= print_kind(&a->kinds[k]);
  for (size_t k = 0; k < a->kind_count; k++) print_shortfalls(a, &a->kinds[k]);
  if (a->complaints > 0) printf("%zu complaints\n", a->complaints);
  fflush(stdout);
  return met;
}
