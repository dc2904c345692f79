/* dry_run.c -- see dry_run.h. */
#include "dry_run.h"

#include <stdio.h>

#include "estimate.h"
#include "terminal/safe_text.h"
#include "together.h"

/* Processor seconds: no new task is begun after the first, and after the second nothing goes on. */
static const double few_seconds = 1.0, most_seconds = 5.0;

/* Costs of tasks differ by ten and more: a mean of two would not do. */
enum { least_tasks = 6 };

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
  scene->describe(d, stdout);
}

void dry_run(scene_run *run, const scene_kind *scene)
{
  char path[DECK_PATH];
  farm_trial trial = { .few = few_seconds, .most = most_seconds, .least = least_tasks };
  print_description(run, scene);
  (void)fflush(stdout);
  together_output(path, sizeof path);
  if (pendres_store_create(path, NULL, &run->store) != PENDRES_OK) return;
  farm_set_trial(run->farm, &trial);
  const pendres_status status = scene->run(run);
  if (status != PENDRES_OK && trial.what == NULL && trial.spent > 0.0) return; /* it fails early */
  /* Interrupted before there were tasks, or between them. */
  if (status == PENDRES_INTERRUPTED && trial.what == NULL) trial.cut = 1;
  putchar('\n');
  estimate_print(run->deck, &trial, farm_trial_outside(&trial), farm_threads(run->farm), stdout);
  estimate_print_space(run->deck->output, stdout);
}
