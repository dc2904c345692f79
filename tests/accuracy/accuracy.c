/*
 * accuracy.c -- `make accuracy`: how true the library's error estimates are where nobody looked.
 *
 *   accuracy [--seed=N] [--orbits=N] [--points=N] [--section=NAME] [--item=N] [--show=N]
 *
 * A new seed is drawn, and printed, unless one is given. Ends with 1 if a goal is missed: of each
 * kind at most a thousandth beyond its claim, none beyond three times of it, and half of all errors
 * above or below 0.03 to 0.7 of it. A * marks kinds that miss.
 */
#include "accuracy.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct section {
  const char *name;
  void (*run)(accuracy *a);
} section;

static const section sections[] = {
  {"orbits", accuracy_orbits},
  {"branches", accuracy_branches},
  {"models", accuracy_models},
  {"scales", accuracy_scales},
  {"weak", accuracy_weak},
  {"linear_curves", accuracy_linear_curves},
  {"strong_curves", accuracy_strong_curves},
  {"linear", accuracy_linear},
  {"advance", accuracy_advance},
  {"resonance", accuracy_resonance},
  {"search", accuracy_search},
  {"ensembles", accuracy_ensembles},
  {"sweeps", accuracy_sweeps},
  {"ramps", accuracy_ramps},
  {"switching", accuracy_switching},
  {"fits", accuracy_fits},
  {"lines", accuracy_lines},
};
enum { SECTIONS = sizeof sections / sizeof sections[0] };

static uint64_t new_seed(void)
{
  struct timespec now = {0};
  (void)timespec_get(&now, TIME_UTC);
  return ((uint64_t)now.tv_sec * 1000u + (uint64_t)now.tv_nsec / 1000000u) % 1000000007u;
}

/* The value of --name=value, or NULL. */
static const char *value_of(const char *argument, const char *name)
{
  const size_t length = strlen(name);
  if (strncmp(argument, "--", 2) != 0 || strncmp(argument + 2, name, length) != 0) return NULL;
  return argument[2 + length] == '=' ? argument + 3 + length : NULL;
}

static int read_number(const char *text, uint64_t most, uint64_t *out)
{
  char *end = NULL;
  errno = 0;
  const unsigned long long value = strtoull(text, &end, 10);
  if (errno != 0 || end == text || *end != '\0' || *text == '-' || value > most) return 0;
  *out = value;
  return 1;
}

static int read_option(const char *argument, accuracy_options *o)
{
  const char *text;
  uint64_t n = 0;
  if ((text = value_of(argument, "section")) != NULL) {
    o->section = text;
    for (int i = 0; i < SECTIONS; i++)
      if (strcmp(sections[i].name, text) == 0) return 1;
    return 0;
  }
  if ((text = value_of(argument, "seed")) != NULL) return read_number(text, UINT64_MAX, &o->seed);
  if ((text = value_of(argument, "orbits")) != NULL) {
    if (!read_number(text, 1000000000, &n)) return 0;
    o->orbits = (long)n;
  } else if ((text = value_of(argument, "points")) != NULL) {
    if (!read_number(text, 1000000000, &n)) return 0;
    o->points = (long)n;
  } else if ((text = value_of(argument, "item")) != NULL) {
    if (!read_number(text, 1000000000, &n)) return 0;
    o->item = (long)n;
  } else if ((text = value_of(argument, "show")) != NULL) {
    if (!read_number(text, 1000000, &n)) return 0;
    o->show = (int)n;
  } else {
    return 0;
  }
  return 1;
}

int main(int count, char **argument)
{
  accuracy_options o = {.seed = new_seed(), .orbits = 20000, .points = 1000, .show = 10,
                        .item = -1};
  for (int i = 1; i < count; i++)
    if (!read_option(argument[i], &o)) {
      fprintf(stderr, "accuracy: '%s'? Known: --seed=N --orbits=N --points=N --section=NAME "
                      "--item=N --show=N; sections:", argument[i]);
      for (int k = 0; k < SECTIONS; k++) fprintf(stderr, " %s", sections[k].name);
      fprintf(stderr, "\n");
      return 2;
    }
  accuracy *a = accuracy_create(&o);
  if (a == NULL) return 1;
  printf("seed %" PRIu64 ", %ld orbits, %ld points\n", o.seed, o.orbits, o.points);
  fflush(stdout);
  int met = 1;
  for (int i = 0; i < SECTIONS; i++) {
    if (o.section != NULL && strcmp(o.section, sections[i].name) != 0) continue;
    accuracy_begin_section(a, sections[i].name);
    sections[i].run(a);
    met &= accuracy_end_section(a);
  }
  printf("%s (seed %" PRIu64 ")\n", met ? "all goals are met" : "goals are missed", o.seed);
  accuracy_free(a);
  return met ? 0 : 1;
}
