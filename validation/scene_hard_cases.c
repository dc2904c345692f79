/*
 * scene_hard_cases.c -- hard cases, each with a bound derived in its comment, the measured figure,
 * and what plain adaptive ARKODE makes of it.
 *
 * A case is a task of the farm; rows are written in the order of the list whatever the threads. A
 * case that gives up leaves a row that does not hold and says why; the others still run.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "results/columns.h"
#include "scenes/scene.h"
#include "system/grow.h"
#include "validation/hard_cases.h"

/* A row of a case, and whether its figure is within its bound. */
typedef struct row {
  hard_row of;
  int holds;
  double figure_error, naive_figure_error;
} row;

/* Of a figure: counts, which must be zero, are exact; all else is an error itself, or a ratio of
   errors: the bound leaves room for what the truth beside it is uncertain by. */
static double error_of(const hard_row *r, double figure)
{
  return r->bound == 0.0 && isfinite(figure) ? 0.0 : NAN;
}

typedef struct work {
  farm *farm;
  const hard_case **chosen;
  size_t count;  /* of these */
  row *row;      /* of all of them, in order */
  size_t rows, room;
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

static int check(const void *arg, size_t task, const farm_record *in)
{
  const hard_row *found = in->data;
  int good = in->size % sizeof *found == 0;
  (void)arg;
  (void)task;
  for (size_t k = 0; good && k < in->size / sizeof *found; k++)
    good = scene_check_text(found[k].name, sizeof found[k].name) &&
           scene_check_text(found[k].quantity, sizeof found[k].quantity);
  return good;
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  work *w = arg;
  const size_t n = in->size / sizeof(hard_row);
  const hard_row *found = in->data;
  (void)task;
  if (n == 0) return PENDRES_OK;
  if (!grow_to(&w->row, w->rows + n, &w->room, sizeof *w->row)) return PENDRES_OUT_OF_MEMORY;
  for (size_t k = 0; k < n; k++)
    w->row[w->rows++] = (row){found[k], hard_row_holds(&found[k]),
                              error_of(&found[k], found[k].figure),
                              error_of(&found[k], found[k].naive)};
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

static const char *holds_names(int value)
{
  return value == 0 ? "broken" : value == 1 ? "holds" : NULL;
}

static const char *yes_or_no(int value)
{
  return value != 0 ? "yes" : "NO";
}

#define NO_ERROR                                                                                  \
  "counts, which must be 0, are exact; other figures are errors themselves, against exact values " \
  "or extended precision, and have no error of their own (NaN): the bound leaves room for what "   \
  "these are uncertain by"

static const scene_column columns[] = {
  {SCENE_TYPED(SCENE_TEXT, "case_name", row, of.name, "case")},
  {SCENE_TYPED(SCENE_TEXT, "quantity", row, of.quantity, "what was measured")},
  {SCENE_TYPED(SCENE_PLAIN, "bound", row, of.bound, "what the figure must not exceed")},
  {.name = "figure", .long_name = "what was measured", .value = offsetof(row, of.figure),
   .error = offsetof(row, figure_error), .comment = NO_ERROR},
  SCENE_CODE(row, holds, "is the figure within its bound", holds_names),
  {.name = "naive_figure", .long_name = "the same figure by plain adaptive ARKODE",
   .value = offsetof(row, of.naive), .error = offsetof(row, naive_figure_error),
   .comment = NO_ERROR},
};

static const scene_cell cells[] = {
  {.heading = "case                       ", .format = "%-26s ", .type = SCENE_TEXT,
   .value = offsetof(row, of.name)},
  SCENE_CELL(row, of.bound, "    bound ", "%9.2e "),
  SCENE_CELL(row, of.figure, "   figure ", "%9.2e "),
  {.heading = "holds ", .format = "%5s ", .type = SCENE_FLAG, .value = offsetof(row, holds),
   .names = yes_or_no},
  SCENE_CELL(row, of.naive, "    naive  ", "%9.2e  "),
  {.heading = "quantity", .format = "%s", .type = SCENE_TEXT, .value = offsetof(row, of.quantity)},
};

/* ---- the scene ----------------------------------------------------------------------------- */

static void report(scene_run *run, work *w)
{
  const scene_table table = {.dimensions = {"case"}, SCENE_ROWS(w->row, w->rows)};
  scene_numbering(run, "case", w->rows, "case, by number");
  for (size_t k = 0; k < w->rows; k++) run->failed_points += !w->row[k].holds;
  SCENE_WRITE(run, &table, columns);
  if (scene_prints(run)) SCENE_PRINT(run->table, &table, w->rows, cells, NULL);
}

static pendres_status run_scene(scene_run *run)
{
  work w = { .farm = run->farm };
  const pendres_status status = choose(run->deck, &w);
  if (status != PENDRES_OK) scene_fail(run, status, "%s", pendres_status_message(status));
  scene_compute(run, &(farm_stage){ .what = "cases", .last = 1, .tasks = w.count, .task = run_case,
                                    .check = check, .collect = collect, .arg = &w });
  report(run, &w);
  free(w.row);
  free(w.chosen);
  return run->status;
}

static void describe(const deck *d, FILE *out)
{
  fprintf(out, "hard cases:");
  for (size_t i = 0; i < d->cases.count; i++) fprintf(out, " %s", d->cases.name[i]);
  for (size_t i = 0; d->cases.count == 0 && hard_case_at(i) != NULL; i++)
    fprintf(out, " %s", hard_case_at(i)->name);
  fprintf(out, "\n");
}

static double cases_of(const deck *d)
{
  return d->cases.count > 0 ? (double)d->cases.count : 12.0;
}

const scene_kind scene_hard_cases = {
  .kind = DECK_HARD_CASES,
  .references = "N. J. Higham, Accuracy and Stability of Numerical Algorithms; "
                "M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions, chapter 17",
  .size = {.head = 24e3, .point = 100.0, .memory = 1e3, .stages = 1.0, .after = 1.0,
           .seconds = 10.0, .points = cases_of},
  .any_method = 1,
  .describe = describe,
  .run = run_scene,
};
