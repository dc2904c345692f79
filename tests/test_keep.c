/*
 * test_keep.c -- computations that are killed again and again, and taken up from the states that
 * they keep, end, and give the bytes and the costs of one that was not; states that are damaged do
 * no harm.
 */
#include <pendres/attractor.h>
#include <pendres/cascade.h>
#include <pendres/hysteresis.h>

#include "keep_fixture.h"

/* A question, and the bytes of its answer. */
typedef struct question {
  pendres_pendulum p;
  pendres_state start;
  pendres_hysteresis_path path;
  int states_only;
} question;

typedef struct answer {
  unsigned char *bytes;
  size_t size;
  pendres_cost cost;
} answer;

static void add(answer *a, size_t size, const void *from)
{
  a->bytes = realloc(a->bytes, a->size + size);
  assert_non_null(a->bytes);
  memcpy(a->bytes + a->size, from, size);
  a->size += size;
}

/* Numbers of a point, one after another: structs have gaps. */
static void add_point(answer *a, const pendres_hysteresis_point *p)
{
  const pendres_orbit *o = &p->attractor.orbit;
  const double number[] = {
    p->value, p->x, p->v, p->mean_velocity, p->mean_velocity_error, p->certain, p->outcome,
    p->attractor.label, p->attractor.lyapunov, p->attractor.lyapunov_error, o->x, o->v, o->x_error,
    o->loop_area, o->loop_area_error, o->amplitude, o->phase_lag, o->multiplier_re[0],
    o->multiplier_im[0], o->period, o->winding};
  add(a, sizeof number, number);
}

static pendres_status ask(pendres_context *ctx, const question *q, answer *a)
{
  pendres_hysteresis *h = NULL;
  const pendres_status status =
    q->states_only ? pendres_hysteresis_states_find(ctx, &q->p, &q->start, &q->path, &h)
                   : pendres_hysteresis_find(ctx, &q->p, &q->start, &q->path, &h);
  *a = (answer){.size = 0};
  for (size_t i = 0; i < pendres_hysteresis_count(h) && status == PENDRES_OK; i++)
    add_point(a, pendres_hysteresis_get(h, i));
  for (size_t i = 0; i < pendres_hysteresis_jump_count(h) && status == PENDRES_OK; i++) {
    const pendres_jump *j = pendres_hysteresis_jump_get(h, i);
    const double number[] = {(double)j->step, j->direction, j->kind, j->value, j->value_error,
                             j->from, j->to, j->to_period, j->gradual, j->share, j->certain,
                             j->to_winding};
    add(a, sizeof number, number);
  }
  for (size_t i = 0; i < pendres_hysteresis_step_count(h) && status == PENDRES_OK; i++) {
    const pendres_step *s = pendres_hysteresis_step_get(h, i);
    const double number[] = {s->winding, s->period, s->lower_end, s->upper_end, s->lower, s->upper};
    add(a, sizeof number, number);
  }
  pendres_hysteresis_free(h);
  pendres_context_cost(ctx, &a->cost);
  return status;
}

/* In processes of their own, as it were: each with a context that knows nothing of the others. */
static pendres_status ask_anew(const question *q, keeper *k, answer *a)
{
  pendres_context *ctx = context_with(NULL);
  keeper_begin(k, ctx);
  const pendres_status status = ask(ctx, q, a);
  pendres_context_free(ctx);
  keeper_end(k);
  return status;
}

static void check_kept(const question *q)
{
  pendres_context *ctx = context_with(NULL);
  keeper k = {.most = 2};
  answer whole, kept = {.size = 0};
  pendres_status status = PENDRES_INTERRUPTED;
  int jobs = 0;
  check_ok(ask(ctx, q, &whole));
  while (status == PENDRES_INTERRUPTED && jobs < 4 * (int)q->path.n) {
    free(kept.bytes);
    status = ask_anew(q, &k, &kept);
    jobs++;
  }
  check_ok(status);
  assert_true(jobs > 1);
  assert_int_equal(kept.size, whole.size);
  assert_memory_equal(kept.bytes, whole.bytes, whole.size);
  assert_true(kept.cost.pendulum_periods == whole.cost.pendulum_periods);
  assert_true(kept.cost.rhs_evaluations == whole.cost.rhs_evaluations);
  pendres_context_free(ctx);
  free(kept.bytes);
  free(whole.bytes);
  free(k.state);
}

/* n values from one to another, and back. */
static void fill(size_t n, double from, double to, double *value)
{
  const size_t half = n / 2;
  for (size_t i = 0; i < half; i++)
    value[i] = value[n - 1 - i] = from + (to - from) * (double)i / (double)(half - 1);
}

/* Jumps between two states of a resonance, and a frequency that asks for too much. */
static void resonance(void **state)
{
  enum { N = 12 };
  double value[N];
  (void)state;
  fill(N, 0.4, 1.0, value);
  value[0] = 1e-5;
  check_kept(&(question){.p = {.damping = 0.12, .drive_amplitude = 0.2}, .start = {1.6, 0.0},
                         .path = {PENDRES_DRIVE_FREQUENCY, N, value}});
}

/* Doublings, chaos and windows. */
static void chaos(void **state)
{
  enum { N = 8 };
  double value[N];
  (void)state;
  fill(N, 1.06, 1.12, value);
  const question q = {.p = {.damping = 0.5, .drive_frequency = 2.0 / 3.0}, .start = {1.6, 0.0},
                      .path = {PENDRES_DRIVE_AMPLITUDE, N, value}, .states_only = 1};
  check_kept(&q);
}

/* Locked and unlocked rotations of a junction, and those without a drive. */
static void rotations(void **state)
{
  enum { N = 16 };
  double value[N];
  (void)state;
  fill(N, 0.0, 2.5, value);
  check_kept(&(question){.p = {.damping = 0.3, .drive_amplitude = 9.0, .drive_frequency = 3.0},
                         .start = {1.6, 0.0}, .path = {PENDRES_TORQUE, N, value}});
  check_kept(&(question){.p = {.damping = 0.3, .drive_frequency = 1.0}, .start = {1.6, 0.0},
                         .path = {PENDRES_TORQUE, N, value}});
}

/* ---- the cascade --------------------------------------------------------------------------- */

static pendres_orbit first_orbit(pendres_context *ctx)
{
  const pendres_pendulum p = {
    .damping = 0.5, .drive_amplitude = 1.05, .drive_frequency = 2.0 / 3.0};
  const double x = 1.6, v = 0.0;
  pendres_attractors *found = NULL;
  pendres_settled outcome;
  check_ok(pendres_settle(ctx, 1, &p, &x, &v, &outcome, &found));
  const pendres_orbit o = pendres_attractors_get(found, 0)->orbit;
  pendres_attractors_free(found);
  return o;
}

static void cascade(void **state)
{
  pendres_context *ctx = context_with(NULL);
  const pendres_orbit start = first_orbit(ctx);
  pendres_cascade whole, kept;
  keeper k = {.most = 1};
  pendres_status status = PENDRES_INTERRUPTED;
  int jobs = 0;
  (void)state;
  check_ok(pendres_cascade_find(ctx, &start, PENDRES_DRIVE_AMPLITUDE, 1.09, &whole));
  for (; status == PENDRES_INTERRUPTED && jobs < 20; jobs++) {
    keeper_begin(&k, ctx);
    status = pendres_cascade_find(ctx, &start, PENDRES_DRIVE_AMPLITUDE, 1.09, &kept);
    keeper_end(&k);
  }
  check_ok(status);
  assert_true(jobs > 5);
  assert_int_equal(kept.doublings, whole.doublings);
  assert_memory_equal(kept.value, whole.value, sizeof whole.value);
  assert_memory_equal(kept.x, whole.x, sizeof whole.x);
  assert_true(kept.limit == whole.limit && kept.ratio_error == whole.ratio_error);
  free(k.state);
  pendres_context_free(ctx);
}

/* ---- states that are none ------------------------------------------------------------------ */

/* States cut short, of another question, and with changed bytes: the answer is found anew, or the
   call ends with a status. */
static void damaged(void **state)
{
  enum { N = 12, TRIES = 40 };
  double value[N];
  unsigned random = 1;
  keeper k = {.most = 1};
  answer whole, a;
  (void)state;
  fill(N, 0.4, 0.6, value);
  question q = {.p = {.damping = 0.12, .drive_amplitude = 0.2}, .start = {1.6, 0.0},
                .path = {PENDRES_DRIVE_FREQUENCY, N, value}};
  assert_int_equal(ask_anew(&q, &k, &a), PENDRES_INTERRUPTED);
  free(a.bytes);
  const keeper good = k;
  for (int i = 0; i < TRIES; i++) {
    const size_t size = i % 4 == 0 ? good.size * (size_t)i / TRIES : good.size;
    k = (keeper){.state = malloc(size + 1), .size = size, .most = 1};
    assert_non_null(k.state);
    memcpy(k.state, good.state, size);
    for (int bytes = 0; bytes < 3 && size > 0 && i % 4 != 0; bytes++) {
      random = random * 1103515245u + 12345u;
      k.state[(random >> 8) % size] ^= (unsigned char)(1u << (i % 8));
    }
    (void)ask_anew(&q, &k, &a);
    free(a.bytes);
    free(k.state);
  }
  q.p.damping = 0.13;
  k = (keeper){.state = good.state, .size = good.size, .most = 1000};
  check_ok(ask_anew(&q, &k, &a));
  pendres_context *ctx = context_with(NULL);
  check_ok(ask(ctx, &q, &whole));
  assert_int_equal(a.size, whole.size);
  assert_memory_equal(a.bytes, whole.bytes, a.size);
  pendres_context_free(ctx);
  free(a.bytes);
  free(whole.bytes);
  free(k.state);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(resonance), cmocka_unit_test(chaos), cmocka_unit_test(rotations),
    cmocka_unit_test(cascade), cmocka_unit_test(damaged),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
