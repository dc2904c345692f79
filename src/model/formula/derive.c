/* derive.c -- what follows from a formula's tree: derivatives, values, domain; see tree.h. */
#include "model/formula/tree.h"

#include <math.h>
#include <string.h>

#include "model/formula/operations.h"

/* Operands come before what is made of them, so that one pass over the nodes sees all of them. */
static void mark(const formula_tree *t, int of, char needed[FORMULA_MOST_NODES])
{
  memset(needed, 0, FORMULA_MOST_NODES);
  needed[of] = 1;
  for (int i = of; i >= 0; i--) {
    const formula_node *n = &t->node[i];
    const int operands = needed[i] ? formula_operands(n->kind) : 0;
    if (operands > 0) needed[n->a] = 1;
    if (operands > 1) needed[n->b] = 1;
    if (operands > 2) needed[n->c] = 1;
  }
}

static int product(formula_tree *t, int a, int b)
{
  return pendres_formula_two(t, FORMULA_MULTIPLY, a, b);
}

/* Of one operand a, whose derivative is d; i is the node itself. */
static int derive_one(formula_tree *t, int i, int d)
{
  const formula_node n = t->node[i];
  const int one = pendres_formula_constant(t, 1.0);
  switch (n.kind) {
  case FORMULA_NEGATIVE: return pendres_formula_one(t, FORMULA_NEGATIVE, d);
  case FORMULA_SIN: return product(t, pendres_formula_one(t, FORMULA_COS, n.a), d);
  case FORMULA_COS:
    return pendres_formula_one(t, FORMULA_NEGATIVE,
                               product(t, pendres_formula_one(t, FORMULA_SIN, n.a), d));
  case FORMULA_EXP: return product(t, i, d);
  case FORMULA_LOG: return pendres_formula_two(t, FORMULA_DIVIDE, d, n.a);
  case FORMULA_TANH:
    return product(t, pendres_formula_two(t, FORMULA_SUBTRACT, one, product(t, i, i)), d);
  case FORMULA_ATAN:
    return pendres_formula_two(t, FORMULA_DIVIDE, d,
                       pendres_formula_two(t, FORMULA_ADD, one, product(t, n.a, n.a)));
  case FORMULA_SQRT:
    return pendres_formula_two(t, FORMULA_DIVIDE, d,
                               product(t, pendres_formula_constant(t, 2.0), i));
  case FORMULA_ABS: return product(t, pendres_formula_one(t, FORMULA_SIGN, n.a), d);
  default: return pendres_formula_constant(t, 0.0); /* a sign's, but for its jump */
  }
}

/* Of several operands, from their derivatives. */
static int derive_more(formula_tree *t, int i, const int *d)
{
  const formula_node n = t->node[i];
  const int da = d[n.a], db = d[n.b];
  switch (n.kind) {
  case FORMULA_ADD:
  case FORMULA_SUBTRACT: return pendres_formula_two(t, n.kind, da, db);
  case FORMULA_MULTIPLY:
    return pendres_formula_two(t, FORMULA_ADD, product(t, da, n.b), product(t, n.a, db));
  case FORMULA_DIVIDE: /* (a' - (a/b) b') / b */
    return pendres_formula_two(t, FORMULA_DIVIDE,
                       pendres_formula_two(t, FORMULA_SUBTRACT, da, product(t, i, db)), n.b);
  case FORMULA_WITHIN: return da;
  default: break;
  }
  const int both = pendres_formula_two(t, FORMULA_ADD, product(t, da, n.b), product(t, n.a, db));
  if (n.kind == FORMULA_FUSED) return pendres_formula_two(t, FORMULA_ADD, both, d[n.c]);
  if (n.kind == FORMULA_FUSED_LESS) return pendres_formula_two(t, FORMULA_SUBTRACT, both, d[n.c]);
  return pendres_formula_two(t, FORMULA_SUBTRACT, d[n.c], both);
}

int pendres_formula_derivative(formula_tree *t, int of, formula_kind by, int which)
{
  char needed[FORMULA_MOST_NODES];
  int d[FORMULA_MOST_NODES];
  if (of < 0) return FORMULA_NONE;
  mark(t, of, needed);
  for (int i = 0; i <= of; i++) {
    const formula_node n = t->node[i];
    const int operands = formula_operands(n.kind);
    if (!needed[i]) continue;
    const double own = n.kind == by && n.which == which ? 1.0 : 0.0;
    if (operands == 0) d[i] = pendres_formula_constant(t, own);
    else d[i] = operands == 1 ? derive_one(t, i, d[n.a]) : derive_more(t, i, d);
  }
  return d[of];
}

int pendres_formula_with_x(formula_tree *t, int of, double x)
{
  char needed[FORMULA_MOST_NODES];
  int at[FORMULA_MOST_NODES];
  if (of < 0) return FORMULA_NONE;
  mark(t, of, needed);
  for (int i = 0; i <= of; i++) {
    const formula_node n = t->node[i];
    if (!needed[i]) continue;
    at[i] = i;
    if (n.kind == FORMULA_X) at[i] = pendres_formula_constant(t, x);
    if (n.kind == FORMULA_V) at[i] = pendres_formula_constant(t, 0.0);
    if ((n.by & (FORMULA_BY_X | FORMULA_BY_V)) == 0) continue;
    if (formula_operands(n.kind) == 1) at[i] = pendres_formula_one(t, n.kind, at[n.a]);
    if (formula_operands(n.kind) == 2) at[i] = pendres_formula_two(t, n.kind, at[n.a], at[n.b]);
    if (formula_operands(n.kind) < 3) continue;
    const int both = product(t, at[n.a], at[n.b]);
    const formula_kind sum = n.kind == FORMULA_FUSED ? FORMULA_ADD : FORMULA_SUBTRACT;
    at[i] = n.kind == FORMULA_FUSED_FROM
              ? pendres_formula_two(t, FORMULA_SUBTRACT, at[n.c], both)
              : pendres_formula_two(t, sum, both, at[n.c]);
  }
  return at[of];
}

/* ---- the domain ---- */

/* Whether a node is positive wherever it is defined, 2, or not negative, 1; else 0. */
static int sign_of(const formula_tree *t, int i)
{
  const formula_node *n = &t->node[i];
  switch (n->kind) {
  case FORMULA_CONSTANT: return n->value > 0.0 ? 2 : n->value == 0.0;
  case FORMULA_EXP: return 2;
  case FORMULA_ABS:
  case FORMULA_SQRT: return 1;
  case FORMULA_MULTIPLY: return n->a == n->b;
  case FORMULA_ADD: {
    const int a = sign_of(t, n->a), b = sign_of(t, n->b);
    return a == 0 || b == 0 ? 0 : a > b ? a : b;
  }
  case FORMULA_FUSED: return n->a == n->b ? sign_of(t, n->c) : 0;
  default: return 0;
  }
}

/* `of`, where the factors of a node have their signs at x = 0. */
static int keep_sign(formula_tree *t, int of, int factor)
{
  if (of < 0 || (t->node[factor].by & FORMULA_BY_X) == 0 || sign_of(t, factor) == 2) return of;
  const formula_node n = t->node[factor];
  if (n.kind == FORMULA_MULTIPLY) {
    of = keep_sign(t, of, n.a);
    return n.a == n.b ? of : keep_sign(t, of, n.b);
  }
  if (n.kind == FORMULA_NEGATIVE || n.kind == FORMULA_SQRT || n.kind == FORMULA_ABS)
    return keep_sign(t, of, n.a);
  const int there = pendres_formula_with_x(t, factor, 0.0);
  return pendres_formula_two(t, FORMULA_WITHIN, of, product(t, factor, there));
}

int pendres_formula_within(formula_tree *t, int of)
{
  char needed[FORMULA_MOST_NODES];
  const int end = of;
  if (of < 0) return FORMULA_NONE;
  mark(t, of, needed);
  for (int i = 0; i <= end; i++) {
    const formula_node n = t->node[i];
    if (!needed[i]) continue;
    if (n.kind == FORMULA_DIVIDE) of = keep_sign(t, of, n.b);
    if (n.kind == FORMULA_LOG) of = keep_sign(t, of, n.a);
  }
  return of;
}

/* ---- the period of the coordinate ---- */

/* How a node depends on x: not at all or with the period 2 pi, 0; as k x + what does not depend on
   it, k; else NaN. */
static double slope_of(const formula_tree *t, const formula_node *n, const double *slope)
{
  const int operands = formula_operands(n->kind);
  if ((n->by & FORMULA_BY_X) == 0) return 0.0;
  if (n->kind == FORMULA_X) return 1.0;
  const double a = slope[n->a], b = operands > 1 ? slope[n->b] : 0.0;
  const double c = operands > 2 ? slope[n->c] : 0.0;
  double product = a == 0.0 && b == 0.0 ? 0.0 : NAN;
  if (operands > 1 && (t->node[n->b].by & FORMULA_BY_X) == 0 && a != 0.0)
    product = a * pendres_formula_value(t, n->b);
  if (operands > 1 && (t->node[n->a].by & FORMULA_BY_X) == 0 && b != 0.0)
    product = b * pendres_formula_value(t, n->a);
  switch (n->kind) {
  case FORMULA_NEGATIVE: return -a;
  case FORMULA_SIN:
  case FORMULA_COS: return a == rint(a) ? 0.0 : NAN;
  case FORMULA_ADD: return a + b;
  case FORMULA_SUBTRACT: return a - b;
  case FORMULA_MULTIPLY: return product;
  case FORMULA_FUSED: return product + c;
  case FORMULA_FUSED_LESS: return product - c;
  case FORMULA_FUSED_FROM: return c - product;
  default: return a == 0.0 && b == 0.0 ? 0.0 : NAN;
  }
}

int pendres_formula_turns(const formula_tree *t, int of)
{
  char needed[FORMULA_MOST_NODES];
  double slope[FORMULA_MOST_NODES];
  if (of < 0) return 0;
  mark(t, of, needed);
  for (int i = 0; i <= of; i++)
    if (needed[i]) slope[i] = slope_of(t, &t->node[i], slope);
  return (t->node[of].by & FORMULA_BY_X) != 0 && slope[of] == 0.0;
}
