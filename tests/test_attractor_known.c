/*
 * test_attractor_known.c -- published facts about forced pendulums, and chaos.
 */
#include "attractor_fixture.h"
#include "states_fixture.h"

/* ---- published facts about the forced pendulum ---- */

typedef struct fact {
  double damping, frequency, drive;
  size_t attractors;
  pendres_label label; /* of all of them */
  int period, winding; /* |winding| */
} fact;

static double number_at(const pendres_orbit *o, size_t offset)
{
  double value = 0.0; /* what is exact has no error */
  if (offset != PENDRES_ORBIT_EXACT) memcpy(&value, (const char *)o + offset, sizeof value);
  return value;
}

/* The library's list of measures: each is there once, with words, and has a value in closed orbits;
   chaos has means of some, and neither value nor error of the others. */
static void check_quantities(const pendres_orbit *o, int closed)
{
  static const char *const of_chaos[] = {"amplitude", "loop_area", "dissipation", "mean_power"};
  const pendres_orbit_quantity *q;
  size_t n = 0, means = 0;
  for (; (q = pendres_orbit_quantity_get(n)) != NULL; n++) {
    const double value = number_at(o, q->value), error = number_at(o, q->error);
    int has = closed;
    for (size_t k = 0; k < sizeof of_chaos / sizeof *of_chaos; k++)
      if (strcmp(q->name, of_chaos[k]) == 0) has = 1, means++;
    for (size_t k = 0; k < n; k++)
      assert_true(strcmp(q->name, pendres_orbit_quantity_get(k)->name) != 0 &&
                  q->value != pendres_orbit_quantity_get(k)->value);
    assert_true(q->value < sizeof *o && (q->error < sizeof *o || q->error == PENDRES_ORBIT_EXACT));
    const pendres_quantity *is = pendres_quantity_of(q->name);
    assert_true(is != NULL && *is->words != '\0' && *is->definition != '\0');
    if (has)
      assert_true(isfinite(value) && (error > 0.0 || q->of_forces));
    else
      assert_true(isnan(value) && (isnan(error) || q->error == PENDRES_ORBIT_EXACT));
  }
  assert_int_equal(means, sizeof of_chaos / sizeof *of_chaos);
  for (size_t k = 0; k < sizeof o->spare / sizeof *o->spare; k++) assert_true(o->spare[k] == 0.0);
  assert_null(pendres_orbit_quantity_get(n + 1));
}

static void check_fact(pendres_context *ctx, const fact *f)
{
  const pendres_pendulum p = {
    .damping = f->damping, .drive_amplitude = f->drive, .drive_frequency = f->frequency};
  pendres_attractors *set = NULL;
  check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set));
  assert_int_equal(pendres_attractors_count(set), f->attractors);
  for (size_t i = 0; i < f->attractors; i++) {
    const pendres_attractor *a = pendres_attractors_get(set, i);
    assert_int_equal(a->label, f->label);
    check_quantities(&a->orbit, f->label != PENDRES_LABEL_CHAOTIC);
    if (f->label == PENDRES_LABEL_CHAOTIC) {
      assert_true(a->lyapunov > 5.0 * a->lyapunov_error && a->lyapunov_error > 0.0);
      assert_true(isnan(a->orbit.x) && isnan(a->orbit.phase_lag) && isnan(a->trap_radius));
    } else {
      assert_int_equal(a->orbit.period, f->period);
      assert_int_equal(abs(a->orbit.winding), f->winding);
    }
  }
  pendres_attractors_free(set);
}

/*
 * Baker and Gollub, Chaotic Dynamics (1996), chapters 3 and 4: q = 2 (damping 1/2), drive frequency
 * 2/3. Orbits that are not their own mirror image come in pairs.
 */
static void baker_and_gollub(void **state)
{
  static const fact facts[] = {
    {0.5, 2.0 / 3.0, 0.90, 1, PENDRES_LABEL_PERIODIC, 1, 0},
    {0.5, 2.0 / 3.0, 1.07, 2, PENDRES_LABEL_PERIODIC, 2, 0},
    {0.5, 2.0 / 3.0, 1.15, 1, PENDRES_LABEL_CHAOTIC, 0, 0},
    {0.5, 2.0 / 3.0, 1.35, 2, PENDRES_LABEL_RUNNING, 1, 1},
    {0.5, 2.0 / 3.0, 1.45, 2, PENDRES_LABEL_RUNNING, 2, 2},
    {0.5, 2.0 / 3.0, 1.47, 2, PENDRES_LABEL_RUNNING, 4, 4},
    {0.5, 2.0 / 3.0, 1.50, 1, PENDRES_LABEL_CHAOTIC, 0, 0},
  };
  for (size_t i = 0; i < sizeof facts / sizeof facts[0]; i++) check_fact(*state, &facts[i]);
}

/*
 * Basins of Wada. Hubbard, American Mathematical Monthly 106 (1999) 741: one attracting cycle, in
 * every well, at damping 0.1, drive cos t. Wagemakers, Daza and Sanjuán, Discrete and Continuous
 * Dynamical Systems B (2020), "How to detect Wada basins": at damping 0.2 three basins with the
 * drive 1.66 cos t, four with 1.71 cos t.
 */
static void wada_pendulums(void **state)
{
  static const struct { double damping, drive; size_t attractors, running; } facts[] = {
    {0.1, 1.0, 1, 0}, {0.2, 1.66, 3, 2}, {0.2, 1.71, 4, 2}};
  for (size_t k = 0; k < 3; k++) {
    const pendres_pendulum p = {
      .damping = facts[k].damping, .drive_amplitude = facts[k].drive, .drive_frequency = 1.0};
    pendres_attractors *set = NULL;
    size_t running = 0;
    check_ok(pendres_attractors_find(*state, &p, 0, NULL, NULL, &set));
    assert_int_equal(pendres_attractors_count(set), facts[k].attractors);
    for (size_t i = 0; i < facts[k].attractors; i++)
      running += pendres_attractors_get(set, i)->label == PENDRES_LABEL_RUNNING;
    assert_int_equal(running, facts[k].running);
    pendres_attractors_free(set);
  }
}

/* ---- chaos ---- */

/* The largest exponent by the reference: one long trajectory, a tangent vector of length one. */
static double reference_exponent(const pendres_pendulum *p, long periods, double *error)
{
  enum { PARTS = 20 };
  long double y = 0.3L, v = 0.1L;
  double u[2] = {1.0, 0.0}, part[PARTS], mean = 0.0, squares = 0.0;
  check_ok(reference_advance(p, &y, &v, NULL, 50));
  for (int i = 0; i < PARTS; i++) {
    part[i] = 0.0;
    for (long k = 0; k < periods / PARTS; k++) {
      reference_image m;
      check_ok(reference_map(p, y, v, 1, &m));
      const double a = (double)m.monodromy[0][0] * u[0] + (double)m.monodromy[0][1] * u[1];
      const double b = (double)m.monodromy[1][0] * u[0] + (double)m.monodromy[1][1] * u[1];
      const double length = hypot(a, b);
      part[i] += log(length) * PARTS / (double)periods;
      u[0] = a / length;
      u[1] = b / length;
      y = m.y;
      v = m.v;
    }
    mean += part[i] / PARTS;
  }
  for (int i = 0; i < PARTS; i++) squares += (part[i] - mean) * (part[i] - mean);
  const double tau = 2.0 * pi / p->drive_frequency;
  *error = sqrt(squares / (PARTS * (PARTS - 1.0))) / tau;
  return mean / tau;
}

static void lyapunov_exponent(void **state)
{
  const pendres_pendulum p = {
    .damping = 0.5, .drive_amplitude = 1.15, .drive_frequency = 2.0 / 3.0};
  pendres_attractors *set = NULL;
  double error = 0.0;
  check_ok(pendres_attractors_find(*state, &p, 0, NULL, NULL, &set));
  const pendres_attractor *a = pendres_attractors_get(set, 0);
  const double exact = reference_exponent(&p, 4000, &error);
  /* Two estimates with their standard errors: three of them together. */
  check_near(a->lyapunov, exact, 3.0 * hypot(error, a->lyapunov_error));
  /* That many periods and replicas are to give three percent. */
  assert_true(hypot(error, a->lyapunov_error) < 0.03 * exact);
  pendres_attractors_free(set);
}

/*
 * Where a pair of mirror images has gone through its period doublings, there are two chaotic
 * attractors, mirror images too: each has its own entry, and the same exponent.
 */
static void two_chaotic_attractors(void **state)
{
  const pendres_pendulum p = {
    .damping = 0.5, .drive_amplitude = 1.0875, .drive_frequency = 2.0 / 3.0};
  ensemble e;
  int chaotic[2] = {0}, n = 0;
  settle_row(*state, &p, -0.5 * pi, 1.5 * pi, &e);
  assert_int_equal(count_label(&e, PENDRES_LABEL_UNRESOLVED), 0);
  for (size_t i = 0; i < pendres_attractors_count(e.set); i++)
    if (pendres_attractors_get(e.set, i)->label == PENDRES_LABEL_CHAOTIC && n < 2)
      chaotic[n++] = (int)i;
  assert_int_equal(n, 2);
  const pendres_attractor *a = pendres_attractors_get(e.set, (size_t)chaotic[0]);
  const pendres_attractor *b = pendres_attractors_get(e.set, (size_t)chaotic[1]);
  check_near(a->lyapunov, b->lyapunov, 4.0 * hypot(a->lyapunov_error, b->lyapunov_error));
  int members[2] = {0};
  for (int i = 0; i < MEMBERS; i++)
    for (int k = 0; k < 2; k++) members[k] += e.outcome[i].attractor == chaotic[k];
  assert_true(members[0] > 20 && members[1] > 20);
  for (int k = 0; k < 2; k++) { /* a point on either is on no other */
    pendres_state at;
    pendres_settled outcome;
    check_ok(pendres_attractors_point_find(*state, e.set, (size_t)chaotic[k], &at));
    check_ok(pendres_attractors_settle(*state, e.set, 1, &at.x, &at.v, &outcome));
    assert_int_equal(outcome.attractor, chaotic[k]);
  }
  assert_true(isnan(pendres_attractors_weakest_multiplier(e.set)) ||
              pendres_attractors_count(e.set) > 2);
  pendres_attractors_free(e.set);
}

/*
 * An orbit of period 4 next to its flip: neighbours approach it by 0.5 % a period, less than what
 * the steps of tangent vectors may be wrong by, which is not to be taken for chaos. A classical
 * Runge-Kutta method with 4000 steps a period is at these points after 5000 periods; with 400
 * steps it is 2e-7 from them, so that its error here is 2e-11.
 */
static void slow_settling(void **state)
{
  const pendres_pendulum p = {
    .damping = 0.0782919, .drive_amplitude = 0.2, .drive_frequency = 0.616};
  const double points[4][2] = {{-0.4481041690, 0.5700733179}, {0.8402249793, 1.8247585773},
                               {-0.4624529486, 0.6167606003}, {0.5993949086, 1.7360158212}};
  pendres_settled outcome;
  double nearest = INFINITY;
  (void)state;
  pendres_attractors *set = settle_one(&p, -1.0681415022205296, 0.0, &outcome);
  const pendres_attractor *a = pendres_attractors_get(set, (size_t)outcome.attractor);
  assert_int_equal(a->label, PENDRES_LABEL_PERIODIC);
  assert_int_equal(a->orbit.period, 4);
  for (int k = 0; k < 4; k++)
    nearest = fmin(nearest, hypot(a->orbit.x - points[k][0], a->orbit.v - points[k][1]));
  assert_true(nearest < 1e-9 + a->orbit.x_error + a->orbit.v_error);
  pendres_attractors_free(set);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(baker_and_gollub, setup, teardown),
    cmocka_unit_test_setup_teardown(wada_pendulums, setup, teardown),
    cmocka_unit_test_setup_teardown(lyapunov_exponent, setup, teardown),
    cmocka_unit_test_setup_teardown(two_chaotic_attractors, setup, teardown),
    cmocka_unit_test(slow_settling),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
