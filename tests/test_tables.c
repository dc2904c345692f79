/*
 * test_tables.c -- the Butcher tables satisfy what their names promise.
 *
 * Order conditions: a method has order p when, for every rooted tree t of up to p nodes,
 * sum b_i u_i(t) = 1/gamma(t). u of a single node is 1; u of a tree is the product of A u over
 * the subtrees at its root; gamma is its number of nodes times the gammas of the subtrees
 * (Butcher, Numerical Methods for Ordinary Differential Equations, chapter 3).
 *
 * Tolerance: the coefficients are correct to half a unit in the last place of a double. A tree of
 * n nodes multiplies n of them, so its sum is off by at most n 2^-53 times the same sum of
 * absolute values; nodes come in only through the row sums. Sums are in long double, and twice
 * the bound is allowed for that. What a wrong digit does is larger by orders of magnitude.
 */
#include "check.h"

#include <string.h>

#include "engine/sundials/flow_table.h"
#include "engine/kernels/tables.h"

enum { MOST_ORDER = 10, MOST_TREES = 1300, STAGES = PENDRES_TABLES_MOST_STAGES };

static const long double half_ulp = 1.1102230246251565e-16L;

/* Trees in the order of their size: subtrees at the root as indices of smaller trees, falling. */
typedef struct tree {
  int nodes, children, child[MOST_ORDER];
  long double gamma;
} tree;

static tree trees[MOST_TREES];
static int tree_count;

/* All ways to complete t with subtrees of at most index `most` and `left` nodes in all. */
static void grow(tree *t, int left, int most)
{
  if (left == 0) {
    assert_true(tree_count < MOST_TREES);
    trees[tree_count++] = *t;
    return;
  }
  for (int i = most; i >= 0; i--) {
    if (trees[i].nodes > left) continue;
    tree more = *t;
    more.child[more.children++] = i;
    more.gamma *= trees[i].gamma;
    grow(&more, left - trees[i].nodes, i);
  }
}

static int make_trees(void **state)
{
  (void)state;
  for (int nodes = 1; nodes <= MOST_ORDER; nodes++) {
    tree root = {.nodes = nodes, .gamma = nodes};
    grow(&root, nodes - 1, tree_count - 1);
  }
  return 0;
}

/* Cayley's numbers: the test of the test. */
static void test_number_of_trees(void **state)
{
  static const int want[MOST_ORDER] = {1, 1, 2, 4, 9, 20, 48, 115, 286, 719};
  (void)state;
  for (int n = 1, i = 0; n <= MOST_ORDER; n++) {
    int count = 0;
    for (; i < tree_count && trees[i].nodes == n; i++) count++;
    assert_int_equal(count, want[n - 1]);
  }
}

/* Sums of b_i u_i(t) for all trees, and of absolute values. */
typedef struct weights {
  long double value[MOST_TREES], size[MOST_TREES];
} weights;

static void dense(const pendres_tables_method *m, long double a[STAGES][STAGES])
{
  memset(a, 0, sizeof(long double) * STAGES * STAGES);
  for (int k = 0; k < m->entries; k++) a[m->a[k].row][m->a[k].column] = m->a[k].value;
}

static void weigh(const pendres_tables_method *m, const double *b, weights *w)
{
  /* A u of every tree, by stage, and with absolute values. */
  static long double au[MOST_TREES][STAGES], size[MOST_TREES][STAGES];
  long double a[STAGES][STAGES];
  dense(m, a);
  for (int t = 0; t < tree_count; t++) {
    long double u[STAGES], v[STAGES];
    w->value[t] = w->size[t] = 0.0L;
    for (int i = 0; i < m->stages; i++) {
      u[i] = v[i] = 1.0L;
      for (int k = 0; k < trees[t].children; k++) {
        u[i] *= au[trees[t].child[k]][i];
        v[i] *= size[trees[t].child[k]][i];
      }
      w->value[t] += b[i] * u[i];
      w->size[t] += fabsl((long double)b[i]) * v[i];
    }
    for (int i = 0; i < m->stages; i++) {
      au[t][i] = size[t][i] = 0.0L;
      for (int j = 0; j < m->stages; j++) {
        au[t][i] += a[i][j] * u[j];
        size[t][i] += fabsl(a[i][j]) * v[j];
      }
    }
  }
}

/* How many trees of that many nodes miss their condition. */
static int misses(const weights *w, int nodes, long double *worst)
{
  int count = 0;
  *worst = 0.0L;
  for (int t = 0; t < tree_count; t++) {
    if (trees[t].nodes != nodes) continue;
    const long double off = fabsl(w->value[t] - 1.0L / trees[t].gamma);
    if (!(off <= 2.0L * half_ulp * nodes * w->size[t])) count++;
    if (!(off <= *worst)) *worst = off;
  }
  return count;
}

static void check_order(int table, const pendres_tables_method *m, const double *b, int order)
{
  static weights w;
  weigh(m, b, &w);
  for (int n = 1; n <= order; n++) {
    long double worst;
    const int count = misses(&w, n, &worst);
    if (count == 0) continue;
    print_error("%s: %d conditions of order %d missed, by up to %.2Lg\n",
                pendres_name_get(PENDRES_NAMES_TABLE, table), count, n, worst);
    fail();
  }
}

static const pendres_tables_method *method_at(int table)
{
  const pendres_tables_method *m = pendres_tables_get((pendres_table)table);
  return table == PENDRES_TABLE_DEFAULT ? NULL : m;
}

static void test_order_conditions(void **state)
{
  int seen = 0;
  (void)state;
  for (int table = 0; table < PENDRES_TABLE_COUNT; table++) {
    const pendres_tables_method *m = method_at(table);
    if (m == NULL) continue;
    check_order(table, m, m->b, m->order);
    seen++;
  }
  assert_int_equal(seen, PENDRES_TABLE_COUNT - 2); /* not the default's alias, not ARKODE's own */
}

static void test_embedded_order_conditions(void **state)
{
  (void)state;
  for (int table = 0; table < PENDRES_TABLE_COUNT; table++) {
    const pendres_tables_method *m = method_at(table);
    if (m != NULL) check_order(table, m, m->d, m->embedded_order);
  }
}

/* An order too modest would pass the tests above. */
static void test_no_order_is_understated(void **state)
{
  static weights w;
  long double worst;
  (void)state;
  for (int table = 0; table < PENDRES_TABLE_COUNT; table++) {
    const pendres_tables_method *m = method_at(table);
    if (m == NULL) continue;
    weigh(m, m->b, &w);
    assert_true(misses(&w, m->order + 1, &worst) > 0);
    weigh(m, m->d, &w);
    assert_true(misses(&w, m->embedded_order + 1, &worst) > 0);
  }
}

/* sum b c^k = 1/(k+1) with the nodes as given: the conditions above never read them. */
static void test_quadrature(void **state)
{
  (void)state;
  for (int table = 0; table < PENDRES_TABLE_COUNT; table++) {
    const pendres_tables_method *m = method_at(table);
    for (int k = 0; m != NULL && k < m->order; k++) {
      long double sum = 0.0L, size = 0.0L;
      for (int i = 0; i < m->stages; i++) {
        const long double term = m->b[i] * powl((long double)m->c[i], k);
        sum += term;
        size += fabsl(term);
      }
      /* b and k times c: 1 + k roundings of a coefficient. */
      check_near((double)(sum - 1.0L / (k + 1)), 0.0,
                 (double)(2.0L * half_ulp * (k + 1) * size));
    }
  }
}

static void test_row_sums_are_the_nodes(void **state)
{
  (void)state;
  for (int table = 0; table < PENDRES_TABLE_COUNT; table++) {
    const pendres_tables_method *m = method_at(table);
    long double a[STAGES][STAGES];
    if (m == NULL) continue;
    dense(m, a);
    for (int i = 0; i < m->stages; i++) {
      long double sum = 0.0L, size = fabsl((long double)m->c[i]);
      for (int j = 0; j < m->stages; j++) {
        sum += a[i][j];
        size += fabsl(a[i][j]);
      }
      check_near((double)(sum - m->c[i]), 0.0, (double)(2.0L * half_ulp * size));
    }
  }
}

/* Explicit, each coefficient once and in order, none zero. */
static void test_shape(void **state)
{
  (void)state;
  for (int table = 0; table < PENDRES_TABLE_COUNT; table++) {
    const pendres_tables_method *m = method_at(table);
    if (m == NULL) continue;
    assert_in_range(m->stages, 1, STAGES);
    for (int k = 0; k < m->entries; k++) {
      const pendres_tables_entry *e = &m->a[k];
      assert_in_range(e->row, 1, m->stages - 1);
      assert_in_range(e->column, 0, e->row - 1);
      assert_true(e->value != 0.0);
      if (k == 0) continue;
      assert_true(e->row > e[-1].row || (e->row == e[-1].row && e->column > e[-1].column));
    }
  }
}

/* With fixed steps ARKODE gets just the stages that count, and the same numbers. */
static void test_tables_for_arkode(void **state)
{
  (void)state;
  for (int table = 0; table < PENDRES_TABLE_COUNT; table++) {
    const pendres_tables_method *m = method_at(table);
    for (int fixed = 0; m != NULL && fixed < 2; fixed++) {
      int stages = 0;
      ARKodeButcherTable t = pendres_flow_table((pendres_table)table, fixed, &stages);
      assert_non_null(t);
      assert_int_equal(t->stages, stages);
      assert_int_equal(t->q, m->order);
      if (fixed) assert_true(t->b[stages - 1] != 0.0);
      for (int i = fixed ? stages : 0; i < m->stages && fixed; i++) assert_true(m->b[i] == 0.0);
      if (!fixed) assert_int_equal(t->p, m->embedded_order);
      double a[STAGES][STAGES] = {{0}};
      for (int k = 0; k < m->entries; k++) a[m->a[k].row][m->a[k].column] = m->a[k].value;
      for (int i = 0; i < stages; i++) {
        assert_true(t->b[i] == m->b[i] && t->c[i] == m->c[i]);
        if (!fixed) assert_true(t->d[i] == m->d[i]);
        for (int j = 0; j < stages; j++) assert_true(t->A[i][j] == a[i][j]);
      }
      ARKodeButcherTable_Free(t);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_number_of_trees),
    cmocka_unit_test(test_order_conditions),
    cmocka_unit_test(test_embedded_order_conditions),
    cmocka_unit_test(test_no_order_is_understated),
    cmocka_unit_test(test_quadrature),
    cmocka_unit_test(test_row_sums_are_the_nodes),
    cmocka_unit_test(test_shape),
    cmocka_unit_test(test_tables_for_arkode),
  };
  return cmocka_run_group_tests(tests, make_trees, NULL);
}
