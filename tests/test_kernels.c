/* test_kernels.c -- the inner loops: the same bytes on every instruction set and for every split of
   the lanes, and right sums. What the slopes are is in test_slopes.c. */
#include "kernels_fixture.h"

static const equation plain = {PENDRES_ROWS_STATE, PENDRES_MODEL_PLAIN};

static void test_same_bytes_on_every_instruction_set(void **state)
{
  const pendres_kernels *list[3];
  const size_t count = available(list);
  (void)state;
  for (size_t e = 0; e < EQUATIONS; e++)
    for (size_t lanes = 8; lanes <= MOST_LANES; lanes += 8) {
      bench first = {0};
      for (size_t k = 0; k < count; k++) {
        bench b;
        pendres_operation o[12];
        open_bench(&b, 1000 * e + lanes);
        const size_t n = program(&b, o);
        const pendres_strip s = strip_of(&b, equations[e], 0, lanes);
        list[k]->run(equations[e].rows, &s, o, n);
        for (int i = 0; i < VECTORS && k > 0; i++)
          assert_memory_equal(b.vector[i], first.vector[i],
                              equations[e].rows * lanes * sizeof(double));
        for (int i = 0; i < TANGENTS && k > 0; i++)
          assert_memory_equal(b.tangent[i], first.tangent[i], lanes * sizeof(double));
        if (k == 0)
          first = b;
        else
          close_bench(&b);
      }
      close_bench(&first);
    }
}

/* One strip of 88 lanes, or eleven of 8, or 80 and 8: each lane gets the same bytes. */
static void test_same_bytes_however_lanes_are_split(void **state)
{
  const pendres_kernels *list[3];
  const size_t count = available(list), lanes = 88;
  (void)state;
  for (size_t k = 0; k < count; k++)
    for (size_t e = 0; e < EQUATIONS; e++) {
      const size_t rows = equations[e].rows;
      bench whole, parts;
      pendres_operation o[12];
      open_bench(&whole, e);
      open_bench(&parts, e);
      /* The same numbers, row by row of each part. */
      for (int i = 0; i < VECTORS; i++)
        for (size_t lane = 0; lane < lanes; lane++)
          for (size_t r = 0; r < rows; r++)
            parts.vector[i][rows * (lane - lane % 8) + 8 * r + lane % 8] =
              whole.vector[i][r * lanes + lane];
      size_t n = program(&whole, o);
      pendres_strip s = strip_of(&whole, equations[e], 0, lanes);
      list[k]->run(rows, &s, o, n);
      n = program(&parts, o);
      for (size_t lane = 0; lane < lanes; lane += 8) {
        s = strip_of(&parts, equations[e], lane, 8);
        list[k]->run(rows, &s, o, n);
      }
      for (int i = 0; i < VECTORS; i++)
        for (size_t lane = 0; lane < lanes; lane++)
          for (size_t r = 0; r < rows; r++)
            assert_memory_equal(
              &parts.vector[i][rows * (lane - lane % 8) + 8 * r + lane % 8],
              &whole.vector[i][r * lanes + lane], sizeof(double));
      for (int i = 0; i < TANGENTS; i++)
        assert_memory_equal(parts.tangent[i], whole.tangent[i], lanes * sizeof(double));
      close_bench(&whole);
      close_bench(&parts);
    }
}

/* Sum and slope in one go are what they are one after the other. */
static void test_stage_is_sum_then_slope(void **state)
{
  const pendres_kernels *list[3];
  const size_t count = available(list), lanes = 72;
  (void)state;
  for (size_t k = 0; k < count; k++)
    for (size_t e = 0; e < EQUATIONS; e++)
      for (int keep = 0; keep < 2; keep++) {
        const size_t bytes = equations[e].rows * lanes * sizeof(double);
        bench a, b;
        open_bench(&a, 7 * e);
        open_bench(&b, 7 * e);
        const pendres_operation two[] = {
          {.sum = &a.sum[0], .to = a.vector[0]},
          {.from = a.vector[0], .slope = a.vector[5], .cos_theta = 0.4}};
        const pendres_operation one = {
          .sum = &b.sum[0], .to = b.vector[0], .slope = b.vector[5], .cos_theta = 0.4,
          .keep = keep};
        pendres_strip s = strip_of(&a, equations[e], 0, lanes);
        list[k]->run(equations[e].rows, &s, two, 2);
        s = strip_of(&b, equations[e], 0, lanes);
        list[k]->run(equations[e].rows, &s, &one, 1);
        assert_memory_equal(a.vector[5], b.vector[5], bytes);
        if (keep) assert_memory_equal(a.vector[0], b.vector[0], bytes);
        close_bench(&a);
        close_bench(&b);
      }
}

/* Sums against long double: each of t operations is off by half a unit of what has piled up. */
static void test_sums(void **state)
{
  const pendres_kernels *list[3];
  const size_t count = available(list), lanes = 40;
  (void)state;
  for (size_t k = 0; k < count; k++)
    for (uint64_t seed = 0; seed < 20; seed++) {
      bench b;
      open_bench(&b, seed);
      pendres_sum *q = &b.sum[1];
      long double want[2 * 40], size[2 * 40];
      for (size_t i = 0; i < 2 * lanes; i++) {
        want[i] = size[i] = 0.0L;
        for (int j = 0; j < q->terms; j++) {
          want[i] += (long double)q->term[j].c * q->term[j].x[i];
          size[i] += fabsl((long double)q->term[j].c * q->term[j].x[i]);
        }
      }
      const pendres_operation o = {.sum = q, .to = q->z};
      const pendres_strip s = strip_of(&b, plain, 0, lanes);
      list[k]->run(PENDRES_ROWS_STATE, &s, &o, 1);
      for (size_t i = 0; i < 2 * lanes; i++)
        check_near((double)(q->z[i] - want[i]), 0.0, (double)(q->terms * 0x1p-53L * size[i]));
      close_bench(&b);
    }
}

static void test_the_fastest_is_chosen(void **state)
{
  const pendres_kernels *list[3];
  const size_t count = available(list);
  (void)state;
  assert_ptr_equal(pendres_kernels_select(), list[count - 1]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_same_bytes_on_every_instruction_set),
    cmocka_unit_test(test_same_bytes_however_lanes_are_split),
    cmocka_unit_test(test_stage_is_sum_then_slope),
    cmocka_unit_test(test_sums),
    cmocka_unit_test(test_the_fastest_is_chosen),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
