/*
 * scene_hard_cases.c -- hard cases, each with a bound derived in its comment, the measured figure,
 * and what plain adaptive ARKODE makes of it.
 *
 * A case is a task of the farm; rows are written in the order of the list whatever the threads. A
 * case that gives up leaves a row that does not hold and says why; the others still run.
 */
#include "scenes/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "validation/hard_cases.h"

typedef struct work {
  farm *farm;
  const hard_case **chosen;
  size_t count;  /* of these */
  hard_row *row; /* of all of them, in order */
  size_t rows;
} work;

/* ---- computing ----------------------------------------------------------------------------- */

/* A task's record: the rows of its case. */
static pendres_status run_case(const void *arg, size_t task, pendres_context *ctx,
                               farm_record *out)
{
  const work *w = arg;
  hard_sheet sheet = { .scale = 1.0, .stop = farm_stopped, .stop_arg = w->farm };
  char quantity[sizeof sheet.row->quantity];
  (void)ctx; /* each case has contexts of its own */
  pendres_status status = w->chosen[task]->run(&sheet);
  if (status != PENDRES_OK && status != PENDRES_INTERRUPTED && status != PENDRES_OUT_OF_MEMORY) {
    (void)snprintf(quantity, sizeof quantity, "gave up: %.140s", sheet.message);
    status = hard_sheet_add(&sheet, w->chosen[task]->name, quantity, NAN, NAN, NAN);
  }
  hard_row *row = NULL;
  if (status == PENDRES_OK) {
    row = farm_record_resize(out, sheet.count * sizeof *row);
    if (row == NULL) status = PENDRES_OUT_OF_MEMORY;
  }
  if (row != NULL && sheet.count > 0) memcpy(row, sheet.row, sheet.count * sizeof *row);
  hard_sheet_clear(&sheet);
  return status;
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  const size_t n = in->size / sizeof *w->row;
  (void)task;
  if (n == 0) return PENDRES_OK;
  hard_row *row = realloc(w->row, (w->rows + n) * sizeof *row);
  if (row == NULL) return PENDRES_OUT_OF_MEMORY;
  memcpy(row + w->rows, in->data, in->size);
  w->row = row;
  w->rows += n;
  return PENDRES_OK;
}

static pendres_status choose(const deck *d, work *w)
{
  size_t all = 0;
  while (hard_case_at(all) != NULL) all++;
  w->count = d->cases.count > 0 ? d->cases.count : all;
  w->chosen = calloc(w->count, sizeof *w->chosen);
  if (w->chosen == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < w->count; i++) {
    w->chosen[i] = d->cases.count > 0 ? hard_case_find(d->cases.name[i]) : hard_case_at(i);
    if (w->chosen[i] == NULL) return PENDRES_INTERNAL; /* the deck reader knows the same names */
  }
  return PENDRES_OK;
}

/* ---- writing ------------------------------------------------------------------------------- */

/* All rows, column by column. */
typedef struct columns {
  const char **name, **quantity;
  double *bound, *figure, *naive;
  int8_t *holds;
} columns;

static void columns_free(columns *c)
{
  free(c->name);
  free(c->bound);
  free(c->holds);
}

static pendres_status columns_make(const work *w, columns *c)
{
  const size_t n = w->rows;
  c->name = malloc(2 * n * sizeof *c->name);
  c->bound = malloc(3 * n * sizeof *c->bound);
  c->holds = malloc(n);
  if (c->name == NULL || c->bound == NULL || c->holds == NULL) return PENDRES_OUT_OF_MEMORY;
  c->quantity = c->name + n;
  c->figure = c->bound + n, c->naive = c->figure + n;
  for (size_t k = 0; k < n; k++) {
    const hard_row *row = &w->row[k];
    c->name[k] = row->name;
    c->quantity[k] = row->quantity;
    c->bound[k] = row->bound;
    c->figure[k] = row->figure;
    c->naive[k] = row->naive;
    c->holds[k] = (int8_t)hard_row_holds(row);
  }
  return PENDRES_OK;
}

static pendres_status write_rows(scene_run *run, const work *w, const columns *c)
{
  static const char *const meanings[] = { "broken", "holds" };
  const pendres_store_spec spec[] = {
    { .name = "case_name", .type = PENDRES_STORE_STRING, .long_name = "case" },
    { .name = "quantity", .type = PENDRES_STORE_STRING, .long_name = "what was measured" },
    { .name = "bound", .long_name = "what the figure must not exceed" },
    { .name = "figure", .long_name = "what was measured" },
    { .name = "holds", .type = PENDRES_STORE_INT8, .long_name = "is the figure within its bound",
      .flag_count = 2, .flag_meanings = meanings },
    { .name = "naive_figure", .long_name = "the same figure by plain adaptive ARKODE" },
  };
  const void *const data[] = { c->name, c->quantity, c->bound, c->figure, c->holds, c->naive };
  pendres_status status =
    pendres_store_dimension(run->store, NULL, "case", w->rows, NULL, "case, by number", "1");
  for (size_t i = 0; i < sizeof spec / sizeof *spec && status == PENDRES_OK; i++) {
    pendres_store_spec one = spec[i];
    one.dimensions[0] = "case";
    status = pendres_store_put(run->store, &one, data[i], w->rows);
  }
  return status == PENDRES_OK ? status : scene_store_failed(run, status);
}

static void print_table(FILE *out, const work *w)
{
  fprintf(out, "%-26s %9s %9s %5s %9s  %s\n", "case", "bound", "figure", "holds", "naive",
          "quantity");
  for (size_t k = 0; k < w->rows; k++) {
    const hard_row *row = &w->row[k];
    fprintf(out, "%-26s %9.2e %9.2e %5s %9.2e  %s\n", row->name, row->bound, row->figure,
            hard_row_holds(row) ? "yes" : "NO", row->naive, row->quantity);
  }
}

/* ---- the scene ----------------------------------------------------------------------------- */

static pendres_status report(scene_run *run, work *w)
{
  columns c = { 0 };
  for (size_t k = 0; k < w->rows; k++) run->failed_points += !hard_row_holds(&w->row[k]);
  pendres_status status = columns_make(w, &c);
  if (status != PENDRES_OK)
    (void)scene_fail(run, status, "out of memory for %zu rows", w->rows);
  else
    status = write_rows(run, w, &c);
  if (status == PENDRES_OK && run->table != NULL) print_table(run->table, w);
  columns_free(&c);
  return status;
}

static pendres_status run_scene(scene_run *run)
{
  work w = { .farm = run->farm };
  pendres_status status = choose(run->deck, &w);
  if (status != PENDRES_OK)
    (void)scene_fail(run, status, "%s", pendres_status_message(status));
  else
    status = scene_compute(run, &(farm_stage){ .what = "cases", .last = 1, .tasks = w.count,
                                               .task = run_case, .collect = collect, .arg = &w });
  if (status == PENDRES_OK) status = report(run, &w);
  free(w.row);
  free(w.chosen);
  return status;
}

static void plan(const deck *d, FILE *out)
{
  fprintf(out, "hard cases:");
  for (size_t i = 0; i < d->cases.count; i++) fprintf(out, " %s", d->cases.name[i]);
  for (size_t i = 0; d->cases.count == 0 && hard_case_at(i) != NULL; i++)
    fprintf(out, " %s", hard_case_at(i)->name);
  fprintf(out, "\n");
}

const scene_kind scene_hard_cases = {
  .kind = DECK_HARD_CASES,
  .references = "N. J. Higham, Accuracy and Stability of Numerical Algorithms; "
                "M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions, chapter 17",
  .plan = plan,
  .run = run_scene,
};
