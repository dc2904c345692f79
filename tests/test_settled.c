/*
 * test_settled.c -- one pendulum settles on one thing, whoever is asked: trapping, averages, a
 * basin of one state, a sweep of one value, an ensemble of one member.
 */
#include "check.h"
#include "context_fixture.h"

#include <pendres/basin.h>
#include <pendres/hysteresis.h>
#include <pendres/lyapunov.h>
#include <pendres/response.h>

enum { EACH = 10, N = 3 * EACH };

static double between(double low, double high, int k, int which)
{
  static const double irrational[] = {0.8566748838545029, 0.733891856627126, 0.6287067210378087,
                                      0.5385972572236101, 0.4614011178545021, 0.3952701573542101};
  return low + (high - low) * fmod(0.5 + irrational[which] * (k + 1), 1.0);
}

/* Pendulums, junctions with and without a drive, Duffing oscillators that harden, have two wells or
   let go. */
static pendres_pendulum draw(int kind, int k, double *x, double *v)
{
  pendres_pendulum p = {.damping = between(0.1, kind == 1 ? 2.0 : 0.8, k, 0),
                        .drive_amplitude = between(0.0, 1.4, k, 1),
                        .drive_frequency = between(0.5, 1.5, k, 2)};
  if (kind == 1) p.torque = between(0.0, 1.7, k, 3);
  if (kind == 1 && k % 3 == 1) p.drive_amplitude = 0.0;
  if (kind == 2) {
    p.force = PENDRES_FORCE_POLYNOMIAL;
    p.force_coefficients[0] = k % 3 == 1 ? -1.0 : 1.0;
    p.force_coefficients[2] = k % 3 == 2 ? -1.0 : 1.0;
  }
  *x = between(-1.0, 3.0, k, 4);
  *v = between(-1.5, 1.5, k, 5);
  return p;
}

/* Orbits of one drive period have names only for those who compare them. */
static pendres_label plain(pendres_label label)
{
  return label == PENDRES_LABEL_SA || label == PENDRES_LABEL_LA ? PENDRES_LABEL_PERIODIC : label;
}

static pendres_label by_basin(pendres_context *ctx, const pendres_pendulum *p, double x, double v)
{
  const pendres_basin_grid grid = {.nx = 1, .nv = 1, .x = &x, .v = &v};
  const size_t index = 0;
  pendres_attractors *set = NULL;
  pendres_basin_state state;
  check_ok(pendres_basin_attractors(ctx, p, &grid, &set));
  check_ok(pendres_basin_states(ctx, set, &grid, 1, &index, &state));
  pendres_attractors_free(set);
  return plain((pendres_label)state.label);
}

static pendres_label by_sweep(pendres_context *ctx, const pendres_pendulum *p, double x, double v)
{
  const pendres_hysteresis_path along = {PENDRES_DAMPING, 1, &p->damping};
  const pendres_state start = {x, v};
  pendres_hysteresis *path = NULL;
  check_ok(pendres_hysteresis_find(ctx, p, &start, &along, &path));
  const pendres_label label = pendres_hysteresis_get(path, 0)->attractor.label;
  pendres_hysteresis_free(path);
  return plain(label);
}

static pendres_label by_ensemble(pendres_context *ctx, const pendres_pendulum *p, double x,
                                 double v)
{
  const pendres_ensemble e = {.members = 1, .x_first = x - 1.0, .x_last = x, .v = v};
  pendres_response r;
  check_ok(pendres_response_find(ctx, 1, p, &e, &r));
  for (size_t k = 0; k < r.states; k++)
    if (r.state_members[k] > 0) return plain(r.state[k].label);
  return PENDRES_LABEL_UNRESOLVED;
}

static void one_label(void **state)
{
  pendres_pendulum p[N];
  pendres_settled trapped[N], averaged[N];
  double x[N], v[N];
  int seen[PENDRES_LABEL_COUNT] = {0};
  (void)state;
  pendres_context *ctx = context_with(&(pendres_options){.tolerance = 1e-6});
  for (int i = 0; i < N; i++) p[i] = draw(i / EACH, i, &x[i], &v[i]);
  check_ok(pendres_settle(ctx, N, p, x, v, trapped, NULL));
  check_ok(pendres_lyapunov_find(ctx, N, p, x, v, NULL, averaged));
  for (int i = 0; i < N; i++) {
    const pendres_settled *t = &trapped[i], *a = &averaged[i];
    const pendres_label label = plain(t->label);
    assert_int_equal(label, a->label);
    assert_int_equal(label, by_basin(ctx, &p[i], x[i], v[i]));
    assert_int_equal(label, by_sweep(ctx, &p[i], x[i], v[i]));
    if (t->attractor >= 0) assert_int_equal(label, by_ensemble(ctx, &p[i], x[i], v[i]));
    assert_int_equal(t->period, a->period);
    assert_int_equal(t->winding, a->winding);
    if (t->attractor < 0) assert_int_equal(t->attractor, a->attractor);
    if (t->period > 0) assert_true(t->settling_periods >= 0 && a->settling_periods > 0);
    /* Standard errors of both, of chaos. */
    if (t->attractor >= 0) {
      check_near(t->exponent, a->exponent, 5.0 * (t->exponent_error + a->exponent_error));
      check_near(t->rotation, a->rotation, 5.0 * (t->rotation_error + a->rotation_error));
    }
    seen[label]++;
  }
  pendres_context_free(ctx);
  assert_int_equal(seen[PENDRES_LABEL_UNRESOLVED], 0);
  assert_true(seen[PENDRES_LABEL_PERIODIC] >= 10 && seen[PENDRES_LABEL_QUASI_PERIODIC] >= 2);
  assert_true(seen[PENDRES_LABEL_RUNNING] >= 1 && seen[PENDRES_LABEL_CHAOTIC] >= 1);
  assert_true(seen[PENDRES_LABEL_ESCAPE] >= 2);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(one_label)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
