/*
 * test_chain.c -- derivatives over many periods by the chain rule are those of one long run.
 */
#include "context_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/chain.h"

enum { N = 3, STEPS = 40, PERIODS = 11 };

/* Orbits of the pendulum or of Duffing's equation, each with parameters of its own. */
static void starts(pendres_flow_kind kind, pendres_chain_start *from)
{
  for (int i = 0; i < N; i++) {
    from[i] = (pendres_chain_start){
      .pendulum = {.damping = 0.3 + 0.1 * i, .drive_amplitude = 0.4, .drive_frequency = 0.9},
      .y = 0.3 * i - 0.4, .w = 0.2 - 0.1 * i};
    if (kind >= PENDRES_FLOW_DRIVES) from[i].pendulum.torque = 0.1;
    if (kind < PENDRES_FLOW_FORCE) continue;
    from[i].pendulum.force = PENDRES_FORCE_POLYNOMIAL;
    from[i].pendulum.force_coefficients[0] = 1.0;
    from[i].pendulum.force_coefficients[2] = 0.3;
  }
}

static void chain(pendres_context *ctx, pendres_flow_kind kind, size_t n,
                  const pendres_chain_start *from, double *out)
{
  check_ok(pendres_chain_run(ctx, &(pendres_chain){.kind = kind, .steps = STEPS,
                                                   .periods = PERIODS, .n = n, .from = from,
                                                   .rows = out}));
}

/* One period after another in one block, as far as derivatives are carried. */
static void run_long(pendres_context *ctx, pendres_flow_kind kind, const pendres_chain_start *from,
                     double *out)
{
  pendres_block *b;
  check_ok(pendres_block_open(ctx, kind, STEPS, &b));
  pendres_block_resize(b, N);
  for (size_t i = 0; i < N; i++)
    pendres_block_load(b, i, &from[i].pendulum, from[i].y, from[i].w);
  for (int k = 0; k < PERIODS; k++) check_ok(pendres_block_period(b));
  const pendres_rows rows = pendres_block_rows(b);
  for (size_t row = 0; row < pendres_flow_kind_rows(kind); row++)
    for (size_t i = 0; i < N; i++) out[row * N + i] = pendres_rows_get(&rows, (int)row, i);
}

/*
 * Both have the same numbers but for rounding. The derivatives fade as exp(-damping time / 2), to
 * 1e-5 over these periods, and those by parameters are of order one: 440 steps of 13 stages leave
 * some 1e-14 of these. States are the same bits: both kinds of kernels do the same to them.
 */
static void test_as_one_long_run(void **state)
{
  pendres_context *ctx = context_with(NULL);
  (void)state;
  for (pendres_flow_kind kind = PENDRES_FLOW_VARIATIONAL; kind <= PENDRES_FLOW_ALL; kind++) {
    pendres_chain_start from[N];
    double chained[PENDRES_ROWS_ALL * N], whole[PENDRES_ROWS_ALL * N];
    starts(kind, from);
    chain(ctx, kind, N, from, chained);
    run_long(ctx, kind, from, whole);
    assert_memory_equal(chained, whole, PENDRES_ROWS_STATE * N * sizeof *whole);
    for (size_t k = 0; k < pendres_flow_kind_rows(kind) * N; k++)
      check_near(chained[k], whole[k], 1e-13);
  }
  pendres_context_free(ctx);
}

/* What a lane gets depends neither on its neighbours nor on how many periods a block holds. */
static void test_alone_and_in_small_blocks(void **state)
{
  const pendres_flow_kind kind = PENDRES_FLOW_SENSITIVITY;
  pendres_context *large = context_with(NULL);
  pendres_context *small = context_with(&(pendres_options){.block_lanes = 8});
  pendres_chain_start from[N];
  double together[PENDRES_ROWS_SENSITIVITY * N], some[PENDRES_ROWS_SENSITIVITY * N];
  (void)state;
  starts(kind, from);
  chain(large, kind, N, from, together);
  chain(small, kind, N, from, some);
  assert_memory_equal(some, together, sizeof together);
  for (size_t i = 0; i < N; i++) {
    double alone[PENDRES_ROWS_SENSITIVITY];
    chain(large, kind, 1, &from[i], alone);
    for (size_t row = 0; row < PENDRES_ROWS_SENSITIVITY; row++)
      assert_memory_equal(&alone[row], &together[row * N + i], sizeof *alone);
  }
  pendres_context_free(large);
  pendres_context_free(small);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_as_one_long_run),
    cmocka_unit_test(test_alone_and_in_small_blocks),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
