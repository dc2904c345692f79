/*
 * test_fit_keep.c -- a fit that is killed again and again, and taken up from the states that it
 * keeps, ends, and gives the bytes and the costs of one that was not; damaged states do no harm.
 */
#include "fit_fixture.h"
#include "keep_fixture.h"

#include <pendres/pendres.h>

enum { SWEEP = 60, DECAY = 240 };

/* In a process of its own, as it were: a context that knows nothing of the others. */
static pendres_status fit_anew(const pendres_fit_data *data, const pendres_fit_model *model,
                               keeper *k, pendres_fit **out, pendres_cost *cost)
{
  pendres_context *ctx = context_with(NULL);
  if (k != NULL) keeper_begin(k, ctx);
  const pendres_status status = pendres_fit_find(ctx, data, model, NULL, out);
  pendres_context_cost(ctx, cost);
  pendres_context_free(ctx);
  if (k != NULL) keeper_end(k);
  return status;
}

static void check_same(const pendres_fit *a, const pendres_fit *b, size_t unknowns)
{
  const pendres_fit_summary s = pendres_fit_summary_get(a), t = pendres_fit_summary_get(b);
  assert_true(s.chi_square == t.chi_square && s.remaining == t.remaining);
  assert_true(s.converged == t.converged && s.determined == t.determined);
  assert_true(s.iterations == t.iterations && s.evaluations == t.evaluations);
  for (size_t i = 0; i < unknowns; i++) {
    assert_true(pendres_fit_value(a, i) == pendres_fit_value(b, i));
    for (size_t k = 0; k < unknowns; k++)
      assert_true(pendres_fit_covariance(a, i, k) == pendres_fit_covariance(b, i, k));
  }
  for (size_t i = 0; i < s.data; i++)
    assert_true(pendres_fit_point_get(a, i)->modelled == pendres_fit_point_get(b, i)->modelled);
  for (size_t i = 0; pendres_fit_note_get(a, i) != NULL; i++)
    assert_string_equal(pendres_fit_note_get(a, i), pendres_fit_note_get(b, i));
}

/* Killed at every second state, and once more with a byte of the first one changed. */
static void check_kept(const pendres_fit_data *data, const pendres_fit_model *model, int least)
{
  keeper k = {.most = 2};
  pendres_fit *whole = NULL, *kept = NULL;
  pendres_cost cost, now;
  pendres_status status = PENDRES_INTERRUPTED;
  int jobs = 0;
  const pendres_status right = fit_anew(data, model, NULL, &whole, &cost);
  assert_non_null(whole);
  for (; status == PENDRES_INTERRUPTED && jobs < 200; jobs++)
    status = fit_anew(data, model, &k, &kept, &now);
  assert_int_equal(status, right);
  assert_true(jobs >= least);
  check_same(whole, kept, model->unknowns);
  assert_true(now.rhs_evaluations == cost.rhs_evaluations);
  pendres_fit_free(kept);
  free(k.state);
  k = (keeper){.most = 1};
  assert_int_equal(fit_anew(data, model, &k, &kept, &now), PENDRES_INTERRUPTED);
  k.size--; /* one that was torn */
  k.most = 1000;
  assert_int_equal(fit_anew(data, model, &k, &kept, &now), right);
  check_same(whole, kept, model->unknowns);
  pendres_fit_free(kept);
  pendres_fit_free(whole);
  free(k.state);
}

/* The linear response, without errors of the data: all starts are followed. */
static void sweep(void **state)
{
  (void)state;
  pendres_fit_datum data[SWEEP];
  uint64_t seed = 3;
  for (int i = 0; i < SWEEP; i++) {
    const double w = 0.5 + 1.0 * i / (SWEEP - 1);
    data[i] = (pendres_fit_datum){
      .observable = PENDRES_FIT_AMPLITUDE, .direction = 1, .axis = w,
      .observed = fabs(0.3 / hypot(1.0 - w * w, 0.2 * w) + 0.01 * lab_normal(&seed))};
  }
  const pendres_fit_unknown open[] = {{.quantity = PENDRES_DAMPING, .guess = NAN},
                                      {.quantity = PENDRES_DRIVE_AMPLITUDE, .guess = NAN},
                                      {.quantity = PENDRES_A1, .guess = NAN}};
  const pendres_fit_model model = {.pendulum.force = PENDRES_FORCE_POLYNOMIAL, .unknowns = 3,
                                   .unknown = open};
  check_kept(&(pendres_fit_data){.n = SWEEP, .datum = data, .axis = PENDRES_DRIVE_FREQUENCY,
                                 .other = PENDRES_PARAMETER_COUNT}, &model, 3);
}

/* A decay that leaves its scale open: chi-square is followed along it, both ways. */
static void open_decay(void **state)
{
  (void)state;
  static double time[DECAY], y[DECAY];
  pendres_fit_datum data[DECAY];
  uint64_t seed = 5;
  for (int i = 0; i < DECAY; i++) time[i] = 0.4 * i;
  lab_decay((lab){.a1 = 1.0, .a3 = 0.05, .damping = 0.02}, 0.4, 0.1, DECAY, time, y);
  for (int i = 0; i < DECAY; i++)
    data[i] = (pendres_fit_datum){.observable = PENDRES_FIT_DISPLACEMENT, .direction = 1,
                                  .axis = time[i], .error = 0.02,
                                  .observed = y[i] + 0.02 * lab_normal(&seed)};
  const pendres_fit_unknown open[] = {{.quantity = PENDRES_DAMPING, .guess = NAN},
                                      {.quantity = PENDRES_FIT_AMPLITUDE_SCALE, .guess = NAN},
                                      {.quantity = PENDRES_A1, .guess = NAN},
                                      {.quantity = PENDRES_FIT_START_DISPLACEMENT, .guess = NAN},
                                      {.quantity = PENDRES_FIT_START_VELOCITY, .guess = NAN}};
  const pendres_fit_model model = {
    .pendulum = {.force = PENDRES_FORCE_POLYNOMIAL, .force_coefficients = {1.0, 0.0, 0.05}},
    .unknowns = 5, .unknown = open};
  check_kept(&(pendres_fit_data){.n = DECAY, .datum = data, .axis = PENDRES_PARAMETER_COUNT,
                                 .other = PENDRES_PARAMETER_COUNT}, &model, 5);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(sweep), cmocka_unit_test(open_decay)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
