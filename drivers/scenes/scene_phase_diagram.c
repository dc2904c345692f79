/*
 * scene_phase_diagram.c -- regimes over damping and drive frequency, by scan and by curves.
 *
 * The paper's Fig. 8, and its loop area as a surface (section III D). One task a damping: its line
 * of drive frequencies, the branches that the members' orbits lie on, and their bifurcations;
 * from these the curves of folds are followed down from the cusp, and show each line what its
 * members have missed.
 */
#include <math.h>
#include <stdlib.h>

#include "scenes/scene_lines.h"

typedef struct diagram {
  scene_lines lines;
  size_t tally[PENDRES_REGIME_COUNT]; /* points of each regime */
  size_t differ;                      /* where scan and curves differ */
  size_t skipped;                     /* orbits without a branch */
} diagram;

static void plan(const deck *d, FILE *out)
{
  const deck_axis *damping = &d->axis[DECK_AXIS_DAMPING];
  const deck_axis *drive = &d->axis[DECK_AXIS_DRIVE_FREQUENCY];
  fprintf(out,
          "regimes of %lld members at %zu dampings, %g to %g, and %zu drive frequencies, %g to "
          "%g,\ndrive amplitude %g; and the curves of folds and symmetry breakings, with their "
          "cusp\n",
          (long long)d->ensemble.members, damping->count, damping->value[0],
          damping->value[damping->count - 1], drive->count, drive->value[0],
          drive->value[drive->count - 1], d->pendulum.drive_amplitude);
}

static void count_points(diagram *g)
{
  for (size_t i = 0; i < g->lines.dampings; i++)
    g->skipped += pendres_branches_skipped(g->lines.line[i].branches);
  for (size_t i = 0; i < g->lines.dampings * g->lines.drives; i++) {
    const pendres_phase_point *p = scene_lines_point(&g->lines, i);
    g->tally[p->regime]++;
    g->differ += p->regime != PENDRES_REGIME_OTHER && p->regime != p->exact;
  }
}

/* ---- results ------------------------------------------------------------------------------- */

#define FIELD(name, text) {#name, text, offsetof(pendres_phase_point, name), \
                           offsetof(pendres_phase_point, name##_error)}

static const struct {
  const char *name, *long_name;
  size_t value, error;
} fields[] = {
  FIELD(sa_fraction, "share of the members on the small-amplitude state"),
  FIELD(la_fraction, "share of the members on the large-amplitude state"),
  FIELD(mean_loop_area, "mean loop area of the ensemble"),
};

static double field(const pendres_phase_point *p, size_t offset)
{
  return *(const double *)(const void *)((const char *)p + offset);
}

static pendres_status write_fields(scene_run *run, const diagram *g, double *value, double *error)
{
  const size_t n = g->lines.dampings * g->lines.drives;
  pendres_status status = PENDRES_OK;
  for (size_t f = 0; f < sizeof fields / sizeof *fields && status == PENDRES_OK; f++) {
    const pendres_store_spec spec = {.name = fields[f].name,
                                     .dimensions = {"damping", "drive_frequency"},
                                     .long_name = fields[f].long_name};
    for (size_t i = 0; i < n; i++) {
      const pendres_phase_point *p = scene_lines_point(&g->lines, i);
      value[i] = field(p, fields[f].value);
      error[i] = field(p, fields[f].error);
    }
    status = pendres_store_put_result(run->store, &spec, value, error, n);
  }
  return status == PENDRES_OK ? status : scene_store_failed(run, status);
}

static pendres_status write_flags(scene_run *run, const diagram *g, int8_t *flag)
{
  static const char *const regimes[] = {"sa", "la", "coexistence", "single", "other"};
  static const int8_t bits[] = {0, PENDRES_OTHER_ASYMMETRIC, PENDRES_OTHER_PERIODIC,
                                PENDRES_OTHER_RUNNING, PENDRES_OTHER_CHAOTIC,
                                PENDRES_OTHER_UNRESOLVED};
  static const char *const meanings[] = {"none",    "asymmetric", "periodic",
                                         "running", "chaotic",    "unresolved"};
  static const char *const names[] = {"regime", "regime_exact", "other"};
  static const char *const words[] = {
    "state of motion that the members of the ensemble settle on",
    "states of motion that exist as attractors, by the branches, whether members reach them or not",
    "what else members settle on: sum of the flags"};
  const size_t n = g->lines.dampings * g->lines.drives;
  pendres_status status = PENDRES_OK;
  for (int f = 0; f < 3 && status == PENDRES_OK; f++) {
    const pendres_store_spec spec = {.name = names[f],
                                     .type = PENDRES_STORE_INT8,
                                     .dimensions = {"damping", "drive_frequency"},
                                     .long_name = words[f],
                                     .flag_count = f < 2 ? PENDRES_REGIME_COUNT : 6,
                                     .flag_values = f < 2 ? NULL : bits,
                                     .flag_meanings = f < 2 ? regimes : meanings};
    for (size_t i = 0; i < n; i++) {
      const pendres_phase_point *p = scene_lines_point(&g->lines, i);
      flag[i] = (int8_t)(f == 0 ? (int)p->regime : f == 1 ? (int)p->exact : p->other);
    }
    status = pendres_store_put(run->store, &spec, flag, n);
  }
  return status == PENDRES_OK ? status : scene_store_failed(run, status);
}

static pendres_status write_results(scene_run *run, const diagram *g)
{
  const size_t n = g->lines.dampings * g->lines.drives;
  double *value = malloc(n * sizeof *value), *error = malloc(n * sizeof *error);
  int8_t *flag = malloc(n);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (value == NULL || error == NULL || flag == NULL) {
    (void)scene_fail(run, status, "out of memory for %zu results", n);
    goto done;
  }
  status = scene_dimension(run, "", DECK_AXIS_DAMPING);
  if (status == PENDRES_OK) status = scene_dimension(run, "", DECK_AXIS_DRIVE_FREQUENCY);
  if (status == PENDRES_OK) status = write_flags(run, g, flag);
  if (status == PENDRES_OK) status = write_fields(run, g, value, error);
  if (status == PENDRES_OK) status = scene_lines_write_doubtful(run, &g->lines);
  if (status == PENDRES_OK) status = scene_lines_write_doubts(&g->lines);
  if (status == PENDRES_OK) status = scene_curves_write(run, &g->lines.curves);
  if (status == PENDRES_OK) status = scene_curves_write_paper(run, &g->lines.curves);
done:
  free(value);
  free(error);
  free(flag);
  return status;
}

static void print_table(FILE *out, const diagram *g)
{
  const size_t n = g->lines.dampings * g->lines.drives;
  fprintf(out, "regime        points\n");
  for (int r = 0; r < PENDRES_REGIME_COUNT; r++)
    fprintf(out, "%-12s  %zu\n", pendres_regime_name((pendres_regime)r), g->tally[r]);
  fprintf(out, "members miss a state that exists at %zu of %zu points\n", g->differ, n);
  if (g->skipped > 0) fprintf(out, "orbits without a branch: %zu\n", g->skipped);
  scene_lines_print(&g->lines, out);
}

static pendres_status run_scene(scene_run *run)
{
  /* Nobody sees the branches themselves: their points may be sparse. */
  diagram g = {.lines = {.spacing = 0.1}};
  pendres_status status = scene_lines_compute(run, &g.lines);
  if (status == PENDRES_OK) count_points(&g);
  if (status == PENDRES_OK) status = write_results(run, &g);
  if (status == PENDRES_OK && run->table != NULL) print_table(run->table, &g);
  scene_lines_free(&g.lines);
  return status;
}

const scene_kind scene_phase_diagram = {
  .kind = DECK_PHASE_DIAGRAM,
  .references = "D. Kharkongor and M. C. Mahato, Resonance oscillation of a damped driven simple "
                "pendulum, Fig. 8 and section III D; Y. A. Kuznetsov, Elements of Applied "
                "Bifurcation Theory, chapters 9 and 10",
  .plan = plan,
  .run = run_scene};
