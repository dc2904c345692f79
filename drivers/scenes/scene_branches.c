/*
 * scene_branches.c -- amplitudes of SA and LA over the drive frequency, with the branches between.
 *
 * The paper's Fig. 9. One task a damping. Beside the ensemble's means stand the branches
 * themselves, unstable parts included, the curves of folds that bound the coexistence region (the
 * figure's thick lines), and two backbones: the free pendulum's, and the driven one's at a lag of
 * pi/2.
 */
#include <math.h>
#include <stdlib.h>

#include "scenes/scene_lines.h"

enum { BACKBONE = 101, FREE = 156 };

static void plan(const deck *d, FILE *out)
{
  const deck_axis *damping = &d->axis[DECK_AXIS_DAMPING];
  const deck_axis *drive = &d->axis[DECK_AXIS_DRIVE_FREQUENCY];
  fprintf(out,
          "amplitudes of %lld members at %zu dampings and %zu drive frequencies, %g to %g, drive\n"
          "amplitude %g; the branches of orbits that they lie on, curves of folds, and backbones\n",
          (long long)d->ensemble.members, damping->count, drive->count, drive->value[0],
          drive->value[drive->count - 1], d->pendulum.drive_amplitude);
}

/* ---- the grid ------------------------------------------------------------------------------ */

#define FIELD(name, text, unit) {#name, text, unit, offsetof(pendres_phase_point, name), \
                                 offsetof(pendres_phase_point, name##_error)}

static const struct {
  const char *name, *long_name, *units;
  size_t value, error;
} fields[] = {
  FIELD(sa_amplitude, "amplitude of the small-amplitude orbit, reached by members or not", "rad"),
  FIELD(la_amplitude, "amplitude of the large-amplitude orbit, reached by members or not", "rad"),
  FIELD(mean_loop_amplitude, "amplitude of the ensemble-averaged loop", "rad"),
  FIELD(mean_loop_area, "mean loop area of the ensemble", "1"),
  FIELD(sa_fraction, "share of the members on the small-amplitude state", "1"),
  FIELD(la_fraction, "share of the members on the large-amplitude state", "1"),
};

static double field(const pendres_phase_point *p, size_t offset)
{
  return *(const double *)(const void *)((const char *)p + offset);
}

static pendres_status write_grid(scene_run *run, const scene_lines *g)
{
  static const char *const regimes[] = {"sa", "la", "coexistence", "single", "other"};
  const size_t n = g->dampings * g->drives;
  double *value = malloc(n * sizeof *value), *error = malloc(n * sizeof *error);
  int8_t *regime = malloc(n);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (value == NULL || error == NULL || regime == NULL) {
    (void)scene_fail(run, status, "out of memory for %zu results", n);
    goto done;
  }
  status = scene_dimension(run, "", DECK_AXIS_DAMPING);
  if (status == PENDRES_OK) status = scene_dimension(run, "", DECK_AXIS_DRIVE_FREQUENCY);
  if (status != PENDRES_OK) goto done;
  for (size_t f = 0; f < sizeof fields / sizeof *fields && status == PENDRES_OK; f++) {
    const pendres_store_spec spec = {.name = fields[f].name,
                                     .dimensions = {"damping", "drive_frequency"},
                                     .long_name = fields[f].long_name, .units = fields[f].units};
    for (size_t i = 0; i < n; i++) {
      const pendres_phase_point *p = scene_lines_point(g, i);
      value[i] = field(p, fields[f].value);
      error[i] = field(p, fields[f].error);
      regime[i] = (int8_t)p->regime;
    }
    status = pendres_store_put_result(run->store, &spec, value, error, n);
  }
  const pendres_store_spec spec = {.name = "regime",
                                   .type = PENDRES_STORE_INT8,
                                   .dimensions = {"damping", "drive_frequency"},
                                   .long_name = "states of motion that members settle on",
                                   .flag_count = PENDRES_REGIME_COUNT,
                                   .flag_meanings = regimes};
  if (status == PENDRES_OK) status = pendres_store_put(run->store, &spec, regime, n);
  if (status != PENDRES_OK) (void)scene_store_failed(run, status);
done:
  free(value);
  free(error);
  free(regime);
  return status;
}

/* ---- branches ------------------------------------------------------------------------------ */

enum { DAMPING, FREQUENCY, AMPLITUDE, PHASE_LAG, LOOP_AREA, VALUES };

/* Points of all branches of all dampings, one after another. */
typedef struct points {
  size_t n;
  double *value[VALUES], *error[VALUES], *multiplier_re, *multiplier_im; /* last two: [n][2] */
  double *multiplier_error;
  int8_t *stable, *kind, *doubt;
  int32_t *branch, *period;
} points;

static void points_free(points *p)
{
  for (int i = 0; i < VALUES; i++) {
    free(p->value[i]);
    free(p->error[i]);
  }
  free(p->multiplier_re);
  free(p->multiplier_im);
  free(p->multiplier_error);
  free(p->stable);
  free(p->kind);
  free(p->doubt);
  free(p->branch);
  free(p->period);
}

static int points_create(size_t n, points *p)
{
  int good = 1;
  *p = (points){.n = 0};
  for (int i = 0; i < VALUES; i++) {
    p->value[i] = malloc((n + 1) * sizeof(double));
    p->error[i] = malloc((n + 1) * sizeof(double));
    good = good && p->value[i] != NULL && p->error[i] != NULL;
  }
  p->multiplier_re = malloc((2 * n + 1) * sizeof(double));
  p->multiplier_im = malloc((2 * n + 1) * sizeof(double));
  p->multiplier_error = malloc((2 * n + 1) * sizeof(double));
  p->stable = malloc(n + 1);
  p->kind = malloc(n + 1);
  p->doubt = malloc(n + 1);
  p->branch = malloc((n + 1) * sizeof *p->branch);
  p->period = malloc((n + 1) * sizeof *p->period);
  return good && p->multiplier_re != NULL && p->multiplier_im != NULL &&
         p->multiplier_error != NULL && p->stable != NULL && p->kind != NULL &&
         p->doubt != NULL && p->branch != NULL && p->period != NULL;
}

static void points_add(points *p, const pendres_branch_point *b, int32_t branch)
{
  const pendres_orbit *o = &b->orbit;
  const double value[VALUES] = {o->pendulum.damping, o->pendulum.drive_frequency, o->amplitude,
                                o->phase_lag, o->loop_area};
  const double error[VALUES] = {0.0, b->parameter_error, o->amplitude_error, o->phase_lag_error,
                                o->loop_area_error};
  const size_t i = p->n++;
  for (int k = 0; k < VALUES; k++) {
    p->value[k][i] = value[k];
    p->error[k][i] = error[k];
  }
  for (size_t k = 0; k < 2; k++) {
    p->multiplier_re[2 * i + k] = o->multiplier_re[k];
    p->multiplier_im[2 * i + k] = o->multiplier_im[k];
    p->multiplier_error[2 * i + k] = o->multiplier_error;
  }
  p->stable[i] = (int8_t)o->stable;
  p->kind[i] = (int8_t)b->kind;
  p->doubt[i] = (int8_t)b->doubt;
  p->branch[i] = branch;
  p->period[i] = o->period;
}

static size_t count_points(const scene_lines *g)
{
  size_t n = 0;
  for (size_t i = 0; i < g->dampings; i++)
    for (size_t k = 0; k < pendres_branches_count(g->line[i].branches); k++)
      n += pendres_branch_count(pendres_branches_get(g->line[i].branches, k));
  return n;
}

static pendres_status put_points(scene_run *run, const points *p)
{
  static const struct {
    const char *name, *long_name, *units;
  } about[VALUES] = {
    {"branch_damping", "friction coefficient", "1"},
    {"branch_frequency", "drive frequency", "1"},
    {"branch_amplitude", "amplitude of the orbit", "rad"},
    {"branch_phase_lag", "phase lag of the orbit", "rad"},
    {"branch_loop_area", "loop area of the orbit", "1"},
  };
  static const char *const no_yes[] = {"unstable", "stable"};
  static const char *const kinds[] = {"regular", "fold", "period_doubling", "symmetry_breaking"};
  static const int8_t bits[] = {0, PENDRES_DOUBT_SIGN, PENDRES_DOUBT_TURN,
                                PENDRES_DOUBT_BIFURCATION};
  static const char *const doubts[] = {"none", "unlisted_change", "turn_without_fold",
                                       "bifurcation_without_its_signs"};
  const size_t n = p->n;
  pendres_store *store = run->store;
  pendres_status status = pendres_store_dimension(
    store, "", "point", n, NULL, "number of the point, in order along each branch", "1");
  if (status == PENDRES_OK)
    status = pendres_store_dimension(store, "", "multiplier", 2, NULL,
                                     "Floquet multiplier, the larger modulus first", "1");
  if (status != PENDRES_OK) return scene_store_failed(run, status);
  for (int k = 0; k < VALUES && status == PENDRES_OK; k++)
    status = scene_curves_put(run, "point", about[k].name, about[k].long_name, about[k].units,
                              p->value[k], p->error[k], n);
  if (status != PENDRES_OK) return status;
  const pendres_store_spec re = {.name = "branch_multiplier_re",
                                 .dimensions = {"point", "multiplier"},
                                 .long_name = "real part of the Floquet multiplier"};
  const pendres_store_spec im = {.name = "branch_multiplier_im",
                                 .dimensions = {"point", "multiplier"},
                                 .long_name = "imaginary part of the Floquet multiplier"};
  const pendres_store_spec stable = {.name = "branch_stable", .type = PENDRES_STORE_INT8,
                                     .dimensions = {"point"}, .flag_count = 2,
                                     .flag_meanings = no_yes,
                                     .long_name = "whether the orbit attracts"};
  const pendres_store_spec kind = {.name = "branch_kind", .type = PENDRES_STORE_INT8,
                                   .dimensions = {"point"}, .flag_count = 4, .flag_meanings = kinds,
                                   .long_name = "what happens at the point"};
  const pendres_store_spec doubt = {
    .name = "branch_doubt", .type = PENDRES_STORE_INT8, .dimensions = {"point"}, .flag_count = 4,
    .flag_values = bits, .flag_meanings = doubts,
    .long_name = "what the bifurcations do not explain there: sum of the flags"};
  const pendres_store_spec number = {.name = "branch_number", .type = PENDRES_STORE_INT32,
                                     .dimensions = {"point"}, .long_name = "number of the branch"};
  const pendres_store_spec period = {.name = "branch_period", .type = PENDRES_STORE_INT32,
                                     .dimensions = {"point"},
                                     .long_name = "drive periods until the orbit closes"};
  status = pendres_store_put_result(store, &re, p->multiplier_re, p->multiplier_error, 2 * n);
  if (status == PENDRES_OK)
    status = pendres_store_put_result(store, &im, p->multiplier_im, p->multiplier_error, 2 * n);
  if (status == PENDRES_OK) status = pendres_store_put(store, &stable, p->stable, n);
  if (status == PENDRES_OK) status = pendres_store_put(store, &kind, p->kind, n);
  if (status == PENDRES_OK) status = pendres_store_put(store, &doubt, p->doubt, n);
  if (status == PENDRES_OK) status = pendres_store_put(store, &number, p->branch, n);
  if (status == PENDRES_OK) status = pendres_store_put(store, &period, p->period, n);
  return status == PENDRES_OK ? status : scene_store_failed(run, status);
}

static pendres_status write_branches(scene_run *run, const scene_lines *g)
{
  points p;
  int32_t number = 0;
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (!points_create(count_points(g), &p)) {
    (void)scene_fail(run, status, "out of memory for the points of branches");
    goto done;
  }
  for (size_t i = 0; i < g->dampings; i++)
    for (size_t k = 0; k < pendres_branches_count(g->line[i].branches); k++, number++) {
      const pendres_branch *b = pendres_branches_get(g->line[i].branches, k);
      for (size_t m = 0; m < pendres_branch_count(b); m++)
        points_add(&p, pendres_branch_get(b, m), number);
    }
  status = put_points(run, &p);
done:
  points_free(&p);
  return status;
}

/* ---- backbones ----------------------------------------------------------------------------- */

/* Dampings in geometric order, from below where the backbone begins to twice the deck's own; but
   not to where steps are legion and the pendulum has long been a linear one. */
static void backbone_dampings(const scene_lines *g, pendres_pendulum *p)
{
  const deck_axis *damping = &g->run->deck->axis[DECK_AXIS_DAMPING];
  const double low = 0.5 * damping->value[0];
  const double high = fmax(fmax(1.0, 2.0 * damping->value[0]),
                           fmin(2.0 * damping->value[damping->count - 1], 100.0));
  for (int i = 0; i < BACKBONE; i++)
    p[i] = (pendres_pendulum){.damping = low * pow(high / low, i / (BACKBONE - 1.0)),
                              .drive_amplitude = g->run->deck->pendulum.drive_amplitude};
}

static pendres_status put_backbone(scene_run *run, const pendres_pendulum *p,
                                   const pendres_orbit *orbit, const double *error,
                                   const pendres_status *outcome)
{
  double damping[BACKBONE], value[3][BACKBONE], errors[3][BACKBONE];
  static const struct {
    const char *name, *long_name, *units;
  } about[3] = {
    {"backbone_frequency", "drive frequency at which the orbit lags by a quarter turn", "1"},
    {"backbone_amplitude", "amplitude of that orbit", "rad"},
    {"backbone_loop_area", "loop area of that orbit", "1"},
  };
  for (int i = 0; i < BACKBONE; i++) {
    const pendres_orbit *o = &orbit[i];
    const int has = outcome[i] == PENDRES_OK || outcome[i] == PENDRES_TOLERANCE_UNREACHABLE;
    damping[i] = p[i].damping;
    value[0][i] = has ? o->pendulum.drive_frequency : NAN;
    errors[0][i] = has ? error[i] : NAN;
    value[1][i] = has ? o->amplitude : NAN;
    errors[1][i] = has ? o->amplitude_error : NAN;
    value[2][i] = has ? o->loop_area : NAN;
    errors[2][i] = has ? o->loop_area_error : NAN;
  }
  pendres_status status = pendres_store_dimension(
    run->store, "", "backbone_damping", BACKBONE, damping, "friction coefficient", "1");
  if (status != PENDRES_OK) return scene_store_failed(run, status);
  for (int k = 0; k < 3 && status == PENDRES_OK; k++)
    status = scene_curves_put(run, "backbone_damping", about[k].name, about[k].long_name,
                              about[k].units, value[k], errors[k], BACKBONE);
  return status;
}

/* What cannot be had of all dampings at a time is had, or not, of each. */
static pendres_status find_backbone(pendres_context *ctx, const pendres_pendulum *p,
                                    pendres_orbit *orbit, double *error, pendres_status *outcome)
{
  pendres_status status = pendres_backbone_find(ctx, BACKBONE, p, orbit, error, outcome);
  if (scene_failure_of(status) == SCENE_FAILURE_NONE) return status;
  status = PENDRES_OK;
  for (int i = 0; i < BACKBONE && status == PENDRES_OK; i++) {
    status = pendres_backbone_find(ctx, 1, &p[i], &orbit[i], &error[i], &outcome[i]);
    if (scene_failure_of(status) == SCENE_FAILURE_NONE) continue;
    outcome[i] = PENDRES_NOT_FOUND; /* the backbone ends, or cannot be followed, there */
    status = PENDRES_OK;
  }
  return status;
}

static pendres_status write_backbone(scene_run *run, const scene_lines *g)
{
  pendres_pendulum p[BACKBONE];
  pendres_status outcome[BACKBONE], status = PENDRES_OUT_OF_MEMORY;
  double error[BACKBONE];
  pendres_context *ctx = farm_context(run->farm);
  pendres_orbit *orbit = calloc(BACKBONE, sizeof *orbit);
  if (ctx == NULL || orbit == NULL) {
    (void)scene_fail(run, status, "out of memory for the backbone");
    goto done;
  }
  backbone_dampings(g, p);
  status = find_backbone(ctx, p, orbit, error, outcome);
  if (status != PENDRES_OK)
    (void)scene_fail(run, status, "%s", pendres_context_message(ctx));
  else
    status = put_backbone(run, p, orbit, error, outcome);
done:
  free(orbit);
  return status;
}

/* The free pendulum, without damping and drive: exact. */
static pendres_status write_free(scene_run *run)
{
  double amplitude[FREE], frequency[FREE], error[FREE];
  for (int i = 0; i < FREE; i++) {
    amplitude[i] = 0.02 * (i + 1);
    frequency[i] = pendres_free_frequency(amplitude[i]);
    error[i] = 2e-15 * frequency[i]; /* some units in the last place */
  }
  const pendres_status status = pendres_store_dimension(
    run->store, "", "free_amplitude", FREE, amplitude, "amplitude of the free pendulum", "rad");
  if (status != PENDRES_OK) return scene_store_failed(run, status);
  return scene_curves_put(run, "free_amplitude", "free_frequency",
                          "frequency of the undamped, undriven pendulum", "1", frequency, error,
                          FREE);
}

/* ---- the scene ----------------------------------------------------------------------------- */

static void print_table(FILE *out, const scene_lines *g)
{
  fprintf(out, "damping   LA from omega          SA up to omega\n");
  for (size_t i = 0; i < g->dampings; i++) {
    const double damping = g->run->deck->axis[DECK_AXIS_DAMPING].value[i];
    const pendres_bifurcation *la = scene_curves_fold(&g->curves, damping, 1);
    const pendres_bifurcation *sa = scene_curves_fold(&g->curves, damping, 0);
    fprintf(out, "%-9.4g", damping);
    if (la != NULL) fprintf(out, " %.12f +- %.0e", la->value, la->value_error);
    else fprintf(out, " no fold               ");
    if (sa != NULL) fprintf(out, " %.12f +- %.0e\n", sa->value, sa->value_error);
    else fprintf(out, " no fold\n");
  }
  scene_lines_print(g, out);
}

static pendres_status write_results(scene_run *run, const scene_lines *g)
{
  pendres_status status = write_grid(run, g);
  if (status == PENDRES_OK) status = scene_lines_write_doubtful(run, g);
  if (status == PENDRES_OK) status = write_branches(run, g);
  if (status == PENDRES_OK) status = scene_lines_write_doubts(g);
  if (status == PENDRES_OK) status = scene_curves_write(run, &g->curves);
  if (status == PENDRES_OK) status = write_backbone(run, g);
  if (status == PENDRES_OK) status = write_free(run);
  if (status == PENDRES_OK) status = scene_curves_write_paper(run, &g->curves);
  return status;
}

static pendres_status run_scene(scene_run *run)
{
  scene_lines g = {.spacing = 0.0};
  pendres_status status = scene_lines_compute(run, &g);
  if (status == PENDRES_OK) status = write_results(run, &g);
  if (status == PENDRES_OK && run->table != NULL) print_table(run->table, &g);
  scene_lines_free(&g);
  return status;
}

const scene_kind scene_branches = {
  .kind = DECK_BRANCHES,
  .references = "D. Kharkongor and M. C. Mahato, Resonance oscillation of a damped driven simple "
                "pendulum, Fig. 9; Y. A. Kuznetsov, Elements of Applied Bifurcation Theory, "
                "chapters 4, 9 and 10",
  .plan = plan,
  .run = run_scene};
