/*
 * phase_diagram.c -- regimes over two parameters, by an ensemble and by curves.
 *
 * The paper's Fig. 8, and its loop area as a surface (section III D): pendres_phase_diagram, one
 * task a line.
 */
#include "scenes/lines/lines.h"
#include "scenes/numbers.h"

#include <math.h>

static void describe(const deck *d, FILE *out)
{
  fprintf(out, "regimes of ");
  scene_lines_describe(d, out);
  fprintf(out, "; and the curves of folds and symmetry breakings, with their cusp\n");
}

/* ---- results ------------------------------------------------------------------------------- */

static const int8_t other_bits[] = {0, PENDRES_OTHER_ASYMMETRIC, PENDRES_OTHER_PERIODIC,
                                    PENDRES_OTHER_RUNNING, PENDRES_OTHER_CHAOTIC,
                                    PENDRES_OTHER_UNRESOLVED, PENDRES_OTHER_ESCAPE,
                                    PENDRES_OTHER_UNSTABLE};

static const char *others(int value)
{
  if (value == 0) return "none";
  return value < (int)sizeof other_bits ? pendres_name_get(PENDRES_NAMES_OTHER, other_bits[value])
                                        : NULL;
}

/* Under a drive, which rest needs to be without, and where nothing escapes. */
static const char *others_driven(int value)
{
  return value + 1 < (int)sizeof other_bits ? others(value) : NULL;
}

static const char *others_that_stay(int value)
{
  return value + 2 < (int)sizeof other_bits ? others(value) : NULL;
}

static int stays(const deck *d)
{
  return !deck_may_rest(d) && !deck_leaves(d);
}

static int leaves(const deck *d)
{
  return !deck_may_rest(d) && deck_leaves(d);
}

#define OTHER(which, names_of)                                                                     \
  {SCENE_TYPED(SCENE_FLAG, "other", pendres_phase_point, other,                                    \
               "what else members settle on: sum of the flags"), .names = names_of,                \
   .codes = other_bits, .when = which}

static const scene_column columns[] = {
  SCENE_CODE(pendres_phase_point, regime,
             "state of motion that the members of the ensemble settle on", scene_regime_names),
  {SCENE_TYPED(SCENE_FLAG, "regime_exact", pendres_phase_point, exact, "states of motion that "
               "are known as attractors, by the branches, whether members reach them or not"),
   .names = scene_regime_names},
  OTHER(stays, others_that_stay),
  OTHER(leaves, others_driven),
  OTHER(deck_may_rest, others),
  SCENE_COLUMN(pendres_phase_point, sa_fraction, NULL),
  SCENE_COLUMN(pendres_phase_point, la_fraction, NULL),
  SCENE_COLUMN(pendres_phase_point, mean_loop_area, NULL),
};

static void write_results(const scene_lines *l)
{
  scene_lines_write(l, sizeof columns / sizeof *columns, columns);
  scene_lines_write_doubts(l);
  scene_curves_write(l);
  scene_curves_write_paper(l);
}

static void print_table(const scene_lines *l, FILE *out)
{
  const pendres_phase_point *points = l->points.rows;
  size_t tally[PENDRES_REGIME_COUNT] = {0}, differ = 0, skipped = 0;
  for (size_t i = 0; i < l->points.n; i++) {
    const pendres_phase_point *p = &points[i];
    tally[p->regime]++;
    differ += p->regime != PENDRES_REGIME_OTHER && p->regime != p->exact;
  }
  for (size_t i = 0; i < l->grid.lines; i++)
    skipped += pendres_branches_skipped(pendres_phase_diagram_branches_get(l->diagram, i));
  fprintf(out, "regime        points\n");
  for (int r = 0; r < PENDRES_REGIME_COUNT; r++)
    fprintf(out, "%-12s  %zu\n", scene_regime_names(r), tally[r]);
  fprintf(out, "members miss a state that is known at %zu of %zu points\n", differ, l->points.n);
  if (skipped > 0) fprintf(out, "orbits without a branch: %zu\n", skipped);
  scene_lines_print(l, out);
}

static pendres_status run_scene(scene_run *run)
{
  scene_lines l;
  scene_lines_compute(run, lines_sparse, &l);
  if (scene_going(run)) write_results(&l);
  if (scene_prints(run)) print_table(&l, run->table);
  scene_lines_free(&l);
  return run->status;
}

/* A diagram keeps the records of its lines, and its curves are longer the more orbits are in
   these: bytes of output a byte of a line's, and of memory a byte. */
static scene_more more(const deck *d, const farm_trial *trial, double points)
{
  (void)d;
  (void)points;
  if (trial == NULL) return (scene_more){0.0, 0.0};
  const double tasks = fmax((double)trial->tasks, 1.0);
  return (scene_more){.output = 0.57 * trial->journal / tasks, .memory = 1.5 * trial->journal};
}

const scene_kind scene_phase_diagram = {
  .kind = DECK_PHASE_DIAGRAM,
  .figures = "Fig. 8 and section III D",
  .references = "; Y. A. Kuznetsov, Elements of Applied Bifurcation Theory, chapters 9 and 10",
  .budget = 1,
  .size = {.head = 60e3, .point = 17.0, .memory = 300.0, .stages = 3.0, .after = 1.2, .members = 1,
           .seconds = 1e-3, .more = more},
  .describe = describe,
  .run = run_scene};
