/*
 * test_units.c -- motions, attractors, orbits, branches, curves, boundaries and sweeps of the same
 * oscillator in other units: every number is the same, bit for bit (units_fixture.h).
 */
#include "units_fixture.h"

#include "continuation/sets.h"

static void ask_attractors(const problem *q)
{
  enum { N = 20 };
  double x[N], v[N];
  pendres_settled outcome[N];
  pendres_attractors *set = NULL;
  pendres_state point = {NAN, NAN};
  notes *to = q->to;
  check_ok(pendres_attractors_find(q->ctx, &q->p, 0, NULL, NULL, &set));
  NOTE(pendres_attractors_count(set), 0, 0);
  NOTE(pendres_attractors_weakest_multiplier(set), 0, 0);
  for (size_t i = 0; i < pendres_attractors_count(set); i++) {
    note_attractor(to, pendres_attractors_get(set, i));
    NOTE(pendres_attractors_point_find(q->ctx, set, i, &point), 0, 0);
    note_arrays(to, 1, &point.x, &point.v);
  }
  for (int i = 0; i < N; i++) {
    x[i] = q->u.length * (0.1 * i - 0.5);
    v[i] = q->u.length / q->u.time * (0.05 * i - 0.3);
  }
  check_ok(pendres_attractors_settle(q->ctx, set, N, x, v, outcome));
  for (int i = 0; i < N; i++) {
    NOTE(outcome[i].attractor, 0, 0);
    NOTE(outcome[i].settling_periods, 0, 0);
    NOTE(outcome[i].exponent, 0, -1);
    NOTE(outcome[i].exponent_error, 0, -1);
    NOTE(outcome[i].rotation, 0, 0);
  }
  pendres_attractors_free(set);
}

static void ask_motion(const problem *q)
{
  enum { N = 3, PERIODS = 4, SAMPLES = 8, POINTS = PERIODS * SAMPLES + 1 };
  double x[N], v[N], error[N], rx[POINTS], rv[POINTS], ex[POINTS], ev[POINTS];
  pendres_pendulum p[N];
  notes *to = q->to;
  for (int i = 0; i < N; i++) {
    p[i] = q->p;
    x[i] = q->u.length * 0.3 * i;
    v[i] = 0.1 * q->u.length / q->u.time;
  }
  const pendres_state start = {x[1], v[1]};
  check_ok(pendres_strobe_advance(q->ctx, N, p, x, v, PERIODS, error));
  note_arrays(to, N, x, v);
  for (int i = 0; i < N; i++) NOTE(error[i], 1, 0);
  const pendres_record record = {.x = rx, .v = rv, .x_error = ex, .v_error = ev};
  check_ok(pendres_strobe_record(q->ctx, p, &start, PERIODS, SAMPLES, &record));
  note_arrays(to, POINTS, rx, rv);
  note_arrays(to, POINTS, ex, ev);
}

static void ask_orbit(const problem *q, const pendres_orbit *o)
{
  enum { SAMPLES = 16, PERIODS = 2, N = SAMPLES * PERIODS };
  double x[N], v[N], ex[N], ev[N], error[2];
  pendres_status outcome;
  pendres_orbit slope;
  notes *to = q->to;
  const pendres_orbit_guess g = {o->pendulum, o->x, o->v, o->period, o->winding};
  check_ok(pendres_orbit_find(q->ctx, 1, &g, PENDRES_ORBIT_FREQUENCY_SLOPE, &slope, &outcome));
  NOTE(outcome, 0, 0);
  note_orbit(to, &slope);
  check_ok(pendres_orbit_sample(q->ctx, o, SAMPLES / o->period, x, v, error));
  note_arrays(to, (size_t)(SAMPLES / o->period * o->period), x, v);
  note_arrays(to, 1, &error[0], &error[1]);
  const pendres_record record = {.x = x, .v = v, .x_error = ex, .v_error = ev};
  const pendres_orbit_stretch stretch = {.samples = SAMPLES, .periods = PERIODS};
  check_ok(pendres_orbit_record(q->ctx, o, &stretch, &record));
  note_arrays(to, N, x, v);
  note_arrays(to, N, ex, ev);
}

static void note_bifurcation(notes *to, const pendres_bifurcation *b, int l, int t)
{
  NOTE(b->kind, 0, 0);
  NOTE(b->value, l, t);
  NOTE(b->value_error, l, t);
  NOTE(b->curvature, l - 2, t);
  NOTE(b->curvature_error, l - 2, t);
  note_orbit(to, &b->orbit);
}

/* Curves through a bifurcation, as the drive frequency and the amplitude change, with a cusp. */
static void ask_curve(const problem *q, const pendres_bifurcation *fold)
{
  const double force = factor(q->u, 1, -2), rate = factor(q->u, 0, -1);
  pendres_curve *curve = NULL;
  pendres_cusp cusp;
  pendres_bifurcation crossed[4];
  size_t found = 0;
  notes *to = q->to;
  const pendres_curve_options options = {.second = PENDRES_DRIVE_AMPLITUDE,
                                         .low = {0.5 * rate, 0.05 * force},
                                         .high = {3.0 * rate, 0.5 * force}};
  check_ok(pendres_curve_follow(q->ctx, fold, &options, &curve));
  for (size_t i = 0; i < pendres_curve_count(curve); i++) {
    const pendres_curve_point *p = pendres_curve_get(curve, i);
    NOTE(p->arclength, 0, 0);
    NOTE(p->value[0], 0, -1);
    NOTE(p->value[1], 1, -2);
    NOTE(p->value_error[0], 0, -1);
    NOTE(p->value_error[1], 1, -2);
    NOTE(p->curvature, -2, -1);
    note_orbit(to, &p->orbit);
  }
  check_ok(pendres_curve_cross(q->ctx, curve, 0.25 * force, 4, crossed, &found));
  NOTE(found, 0, 0);
  for (size_t i = 0; i < found; i++) note_bifurcation(to, &crossed[i], 0, -1);
  NOTE(pendres_cusp_find(q->ctx, fold, PENDRES_DRIVE_AMPLITUDE, &cusp), 0, 0);
  NOTE(cusp.value[0], 0, -1);
  NOTE(cusp.value[1], 1, -2);
  NOTE(cusp.value_error[0], 0, -1);
  NOTE(cusp.value_error[1], 1, -2);
  note_orbit(to, &cusp.orbit);
  pendres_curve_free(curve);
}

static void ask_branch(const problem *q, const pendres_orbit *o)
{
  const double rate = factor(q->u, 0, -1);
  pendres_branch *branch = NULL;
  pendres_branches *set = NULL;
  pendres_orbit crossed[8];
  pendres_fold fold;
  size_t found = 0;
  notes *to = q->to;
  const pendres_branch_options options = {.parameter = PENDRES_DRIVE_FREQUENCY,
                                          .low = 0.5 * rate, .high = 3.0 * rate};
  check_ok(pendres_branch_follow(q->ctx, o, &options, &branch));
  for (size_t i = 0; i < pendres_branch_count(branch); i++) {
    const pendres_branch_point *p = pendres_branch_get(branch, i);
    NOTE(p->arclength, 0, 0);
    NOTE(p->parameter_error, 0, -1);
    NOTE(p->doubt, 0, 0);
    note_orbit(to, &p->orbit);
  }
  for (size_t i = 0; i < pendres_branch_bifurcation_count(branch); i++)
    note_bifurcation(to, pendres_branch_bifurcation_get(branch, i), 0, -1);
  check_ok(pendres_branch_cross(q->ctx, branch, 1.4 * rate, 8, crossed, &found));
  NOTE(found, 0, 0);
  for (size_t i = 0; i < found; i++) note_orbit(to, &crossed[i]);
  check_ok(pendres_branches_find(q->ctx, found, crossed, &options, &set));
  NOTE(pendres_branches_count(set), 0, 0);
  const pendres_status status = pendres_fold_find(q->ctx, o, PENDRES_DRIVE_FREQUENCY, &fold);
  NOTE(status, 0, 0);
  if (status == PENDRES_OK) {
    note_bifurcation(to, &fold, 0, -1);
    check_ok(pendres_branches_extend(q->ctx, 1, &fold, &options, set));
    ask_curve(q, &fold);
  }
  NOTE(pendres_branches_count(set), 0, 0);
  for (size_t i = 0; i < pendres_branches_count(set); i++) {
    const pendres_branch *b = pendres_branches_get(set, i);
    note_orbit(to, &pendres_branch_get(b, pendres_branch_count(b) / 2)->orbit);
  }
  pendres_branches_free(set);
  pendres_branch_free(branch);
}

/* A path up and down, of the drive frequency or another parameter of dimension l, t. */
static void ask_path(const problem *q, pendres_parameter parameter, int l, int t,
                     const double *plain_value, size_t n)
{
  double value[64];
  pendres_hysteresis *h = NULL;
  const pendres_state start = {0.2 * q->u.length, 0.0};
  notes *to = q->to;
  for (size_t i = 0; i < n; i++) value[i] = plain_value[i] * factor(q->u, l, t);
  const pendres_hysteresis_path path = {parameter, n, value};
  check_ok(pendres_hysteresis_find(q->ctx, &q->p, &start, &path, &h));
  for (size_t i = 0; i < n; i++) {
    const pendres_hysteresis_point *p = pendres_hysteresis_get(h, i);
    NOTE(p->value, l, t);
    NOTE(p->outcome, 0, 0);
    note_attractor(to, &p->attractor);
    note_arrays(to, 1, &p->x, &p->v);
    NOTE(p->mean_velocity, 1, -1);
    NOTE(p->mean_velocity_error, 1, -1);
  }
  NOTE(pendres_hysteresis_jump_count(h), 0, 0);
  for (size_t i = 0; i < pendres_hysteresis_jump_count(h); i++) {
    const pendres_jump *j = pendres_hysteresis_jump_get(h, i);
    NOTE(j->step, 0, 0);
    NOTE(j->kind, 0, 0);
    NOTE(j->value, l, t);
    NOTE(j->value_error, l, t);
    NOTE(j->certain, 0, 0);
    NOTE(j->to_winding, 0, 0);
  }
  NOTE(pendres_hysteresis_step_count(h), 0, 0);
  for (size_t i = 0; i < pendres_hysteresis_step_count(h); i++) {
    const pendres_step *s = pendres_hysteresis_step_get(h, i);
    NOTE(s->lower, l, t);
    NOTE(s->lower_error, l, t);
    NOTE(s->upper, l, t);
    NOTE(s->upper_error, l, t);
    NOTE(s->width, l, t);
    NOTE(s->width_error, l, t);
  }
  pendres_hysteresis_free(h);
}

static void ask_lyapunov(const problem *q)
{
  pendres_settled out;
  const double x = 0.1 * q->u.length, v = 0.0;
  notes *to = q->to;
  check_ok(pendres_lyapunov_find(q->ctx, 1, &q->p, &x, &v, NULL, &out));
  NOTE(out.label, 0, 0);
  NOTE(out.exponent, 0, -1);
  NOTE(out.exponent_error, 0, -1);
  NOTE(out.rotation, 0, 0);
  NOTE(out.period, 0, 0);
}

static void ask_boundary(const problem *q, const pendres_orbit *o)
{
  pendres_orbit saddle;
  pendres_boundary *b = NULL;
  notes *to = q->to;
  check_ok(pendres_saddle_find(q->ctx, o, &saddle));
  note_orbit(to, &saddle);
  check_ok(pendres_boundary_find(q->ctx, &saddle, NULL, &b));
  NOTE(b->count, 0, 0);
  note_arrays(to, b->count, b->x, b->v);
  for (size_t i = 0; i < b->count; i++) NOTE(b->error[i], 1, 0);
  NOTE(b->bound, 1, 0);
  pendres_boundary_free(b);
}

static void ask_few(const problem *q)
{
  ask_motion(q);
  ask_attractors(q);
  const pendres_attractor a = settled(q, 0.2);
  if (a.label == PENDRES_LABEL_CHAOTIC) return;
  ask_orbit(q, &a.orbit);
}

/* Models that the literature has, at parameters with different kinds of attractors. */
static void every_model(void **state)
{
  static const struct {
    const char *name;
    pendres_pendulum p;
  } model[] = {
    {"hard Duffing", {.damping = 0.1, .drive_amplitude = 0.3, .drive_frequency = 1.5,
                      .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.0, 1.0}}},
    {"two wells", {.damping = 0.25, .drive_amplitude = 0.1, .drive_frequency = 1.0,
                   .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {-1.0, 0.0, 1.0}}},
    {"chaos in two wells", {.damping = 0.25, .drive_amplitude = 0.4, .drive_frequency = 1.0,
                            .force = PENDRES_FORCE_POLYNOMIAL,
                            .force_coefficients = {-1.0, 0.0, 1.0}}},
    {"Helmholtz", {.damping = 0.1, .drive_amplitude = 0.05, .drive_frequency = 0.85,
                   .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, -1.0}}},
    {"Ueda", {.damping = 0.2, .drive_amplitude = 0.3, .drive_frequency = 1.0,
              .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {0.0, 0.0, 1.0}}},
    {"lopsided", {.damping = 0.1, .drive_amplitude = 0.3, .drive_frequency = 1.3, .torque = 0.1,
                  .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.3, 0.2}}},
    {"linear", {.damping = 0.2, .drive_amplitude = 0.3, .drive_frequency = 1.1,
                .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0}}}};
  (void)state;
  for (size_t k = 0; k < sizeof model / sizeof *model; k++)
    in_all_units(model[k].name, &model[k].p, 1e-9, ask_few);
}

static void ask_continuation(const problem *q)
{
  const pendres_attractor a = settled(q, 0.2);
  ask_branch(q, &a.orbit);
  ask_boundary(q, &a.orbit);
}

static void ask_paths(const problem *q)
{
  static const double up[] = {1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 1.8, 1.6, 1.4, 1.2, 1.0},
                      drive[] = {0.1, 0.2, 0.4, 0.2, 0.1}, stiff[] = {0.5, 1.0, 2.0, 0.5};
  ask_path(q, PENDRES_DRIVE_FREQUENCY, 0, -1, up, sizeof up / sizeof *up);
  ask_path(q, PENDRES_DRIVE_AMPLITUDE, 1, -2, drive, sizeof drive / sizeof *drive);
  ask_path(q, PENDRES_A3, -2, -2, stiff, sizeof stiff / sizeof *stiff);
  ask_lyapunov(q);
}

/* A branch without bifurcations has an array without elements, which goes through the door, too. */
static void ask_plain_branch(const problem *q)
{
  const pendres_attractor a = settled(q, 0.2);
  ask_branch(q, &a.orbit);
}

static void every_question(void **state)
{
  static const pendres_pendulum strongly_damped = {
    .damping = 1.0, .drive_amplitude = 0.1, .drive_frequency = 1.2,
    .force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.0, 1.0}};
  (void)state;
  in_all_units("no bifurcations", &strongly_damped, 1e-9, ask_plain_branch);
  in_all_units("branches", &duffing, 1e-9, ask_continuation);
  in_all_units("paths", &duffing, 1e-9, ask_paths);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_model),
                                     cmocka_unit_test(every_question)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
