/* tree.c -- nodes of a formula; see tree.h. */
#include "model/formula/tree.h"

#include <math.h>

#include "model/formula/operations.h"

static unsigned depends(const formula_tree *t, const formula_node *n)
{
  static const unsigned own[] = {[FORMULA_X] = FORMULA_BY_X,
                                 [FORMULA_V] = FORMULA_BY_V,
                                 [FORMULA_PHASE] = FORMULA_BY_PHASE,
                                 [FORMULA_PHASE_COSINE] = FORMULA_BY_PHASE,
                                 [FORMULA_PHASE_SINE] = FORMULA_BY_PHASE};
  const int operands = formula_operands(n->kind);
  if (n->kind == FORMULA_COEFFICIENT) return (unsigned)FORMULA_BY_COEFFICIENTS << n->which;
  if (operands == 0) return own[n->kind];
  unsigned by = t->node[n->a].by;
  if (operands > 1) by |= t->node[n->b].by;
  if (operands > 2) by |= t->node[n->c].by;
  return by;
}

/* The node that is the same, or a new one. */
static int make(formula_tree *t, formula_node n)
{
  const int operands = formula_operands(n.kind);
  if ((operands > 0 && n.a < 0) || (operands > 1 && n.b < 0) || (operands > 2 && n.c < 0))
    return FORMULA_NONE;
  for (int i = t->count; i-- > 0;) {
    const formula_node *o = &t->node[i];
    if (o->kind == n.kind && o->which == n.which &&
        pendres_formula_bits(o->value) == pendres_formula_bits(n.value) &&
        (operands < 1 || o->a == n.a) && (operands < 2 || o->b == n.b) &&
        (operands < 3 || o->c == n.c))
      return i;
  }
  if (t->count == FORMULA_MOST_NODES) return FORMULA_NONE;
  n.by = depends(t, &n);
  t->node[t->count] = n;
  return t->count++;
}

int pendres_formula_constant(formula_tree *t, double value)
{
  return make(t, (formula_node){.kind = FORMULA_CONSTANT, .value = value + 0.0});
}

int pendres_formula_leaf(formula_tree *t, formula_kind kind, int which)
{
  return make(t, (formula_node){.kind = kind, .which = which});
}

static int is(const formula_tree *t, int i, formula_kind kind)
{
  return i >= 0 && t->node[i].kind == kind;
}

static int is_value(const formula_tree *t, int i, double value)
{
  return is(t, i, FORMULA_CONSTANT) && t->node[i].value == value;
}

double pendres_formula_value(const formula_tree *t, int of)
{
  return is(t, of, FORMULA_CONSTANT) ? t->node[of].value : NAN;
}

/* ---- one operand ---- */

/* The factor of a node that is a multiple of the phase; 0 if it is not. */
static double phase_times(const formula_tree *t, int a, int b)
{
  if (is(t, a, FORMULA_PHASE)) return pendres_formula_value(t, b);
  return is(t, b, FORMULA_PHASE) ? pendres_formula_value(t, a) : 0.0;
}

/* n and rest of n phase + rest; 0 if a node is no such sum. The rest is FORMULA_NONE if it is 0. */
static int phase_of(formula_tree *t, int i, int *n, int *rest)
{
  const formula_node o = t->node[i];
  const int one = pendres_formula_constant(t, 1.0);
  double factor = 0.0;
  *rest = FORMULA_NONE;
  switch (o.kind) {
  case FORMULA_PHASE: factor = 1.0; break;
  case FORMULA_NEGATIVE: factor = -phase_times(t, o.a, one); break;
  case FORMULA_ADD:
  case FORMULA_SUBTRACT:
    factor = phase_times(t, o.a, one);
    *rest = factor != 0.0 ? o.b : o.a;
    if (factor == 0.0) factor = phase_times(t, o.b, one) * (o.kind == FORMULA_ADD ? 1.0 : -1.0);
    else if (o.kind == FORMULA_SUBTRACT) *rest = pendres_formula_one(t, FORMULA_NEGATIVE, o.b);
    break;
  case FORMULA_MULTIPLY: factor = phase_times(t, o.a, o.b); break;
  case FORMULA_FUSED:
  case FORMULA_FUSED_LESS:
  case FORMULA_FUSED_FROM:
    factor = phase_times(t, o.a, o.b) * (o.kind == FORMULA_FUSED_FROM ? -1.0 : 1.0);
    *rest = o.kind == FORMULA_FUSED_LESS ? pendres_formula_one(t, FORMULA_NEGATIVE, o.c) : o.c;
    break;
  default: break;
  }
  if (!(factor == rint(factor) && fabs(factor) >= 1.0 && fabs(factor) <= FORMULA_MOST_HARMONIC))
    return 0;
  *n = (int)factor;
  return *rest < 0 || (t->node[*rest].by & FORMULA_BY_PHASE) == 0;
}

/* Sine or cosine of n phase + rest, by those of the phase alone, the same in all lanes. */
static int of_phase(formula_tree *t, formula_kind kind, int n, int rest)
{
  const int size = n < 0 ? -n : n;
  const int cosine = pendres_formula_leaf(t, FORMULA_PHASE_COSINE, size);
  int sine = pendres_formula_leaf(t, FORMULA_PHASE_SINE, size);
  if (n < 0) sine = pendres_formula_one(t, FORMULA_NEGATIVE, sine);
  if (rest < 0) return kind == FORMULA_SIN ? sine : cosine;
  const int s = pendres_formula_one(t, FORMULA_SIN, rest);
  const int c = pendres_formula_one(t, FORMULA_COS, rest);
  const int same = pendres_formula_two(t, FORMULA_MULTIPLY, cosine, kind == FORMULA_SIN ? s : c);
  const int other = pendres_formula_two(t, FORMULA_MULTIPLY, sine, kind == FORMULA_SIN ? c : s);
  return pendres_formula_two(t, kind == FORMULA_SIN ? FORMULA_ADD : FORMULA_SUBTRACT, same, other);
}

int pendres_formula_one(formula_tree *t, formula_kind kind, int a)
{
  int n, rest;
  if (a < 0) return FORMULA_NONE;
  const formula_node o = t->node[a];
  if (o.kind == FORMULA_CONSTANT)
    return pendres_formula_constant(t, pendres_formula_of_one(kind, o.value));
  if ((kind == FORMULA_SIN || kind == FORMULA_COS) && phase_of(t, a, &n, &rest))
    return of_phase(t, kind, n, rest);
  if (kind == FORMULA_NEGATIVE && o.kind == FORMULA_NEGATIVE) return o.a;
  if (kind == FORMULA_NEGATIVE && o.kind == FORMULA_SUBTRACT)
    return pendres_formula_two(t, FORMULA_SUBTRACT, o.b, o.a);
  if (kind == FORMULA_COS && o.kind == FORMULA_NEGATIVE) return pendres_formula_one(t, kind, o.a);
  if (kind == FORMULA_SIN && o.kind == FORMULA_NEGATIVE)
    return pendres_formula_one(t, FORMULA_NEGATIVE, pendres_formula_one(t, kind, o.a));
  return make(t, (formula_node){.kind = kind, .a = a});
}

/* ---- two operands ---- */

static int three(formula_tree *t, formula_kind kind, int product, int c)
{
  const formula_node p = t->node[product];
  return make(t, (formula_node){.kind = kind, .a = p.a, .b = p.b, .c = c});
}

static int multiply(formula_tree *t, int a, int b)
{
  if (is_value(t, a, 0.0) || is_value(t, b, 0.0)) return pendres_formula_constant(t, 0.0);
  if (is_value(t, a, 1.0)) return b;
  if (is_value(t, b, 1.0)) return a;
  if (is_value(t, a, -1.0)) return pendres_formula_one(t, FORMULA_NEGATIVE, b);
  if (is_value(t, b, -1.0)) return pendres_formula_one(t, FORMULA_NEGATIVE, a);
  if (is(t, a, FORMULA_NEGATIVE))
    return pendres_formula_one(t, FORMULA_NEGATIVE, multiply(t, t->node[a].a, b));
  if (is(t, b, FORMULA_NEGATIVE))
    return pendres_formula_one(t, FORMULA_NEGATIVE, multiply(t, a, t->node[b].a));
  return make(t, (formula_node){.kind = FORMULA_MULTIPLY, .a = a < b ? a : b, .b = a < b ? b : a});
}

static int subtract(formula_tree *t, int a, int b)
{
  if (is_value(t, b, 0.0)) return a;
  if (is_value(t, a, 0.0)) return pendres_formula_one(t, FORMULA_NEGATIVE, b);
  if (a == b) return pendres_formula_constant(t, 0.0);
  if (is(t, b, FORMULA_NEGATIVE)) return pendres_formula_two(t, FORMULA_ADD, a, t->node[b].a);
  if (is(t, a, FORMULA_MULTIPLY)) return three(t, FORMULA_FUSED_LESS, a, b);
  if (is(t, b, FORMULA_MULTIPLY)) return three(t, FORMULA_FUSED_FROM, b, a);
  return make(t, (formula_node){.kind = FORMULA_SUBTRACT, .a = a, .b = b});
}

static int add(formula_tree *t, int a, int b)
{
  if (is_value(t, a, 0.0)) return b;
  if (is_value(t, b, 0.0)) return a;
  if (a == b) return multiply(t, pendres_formula_constant(t, 2.0), a);
  if (is(t, b, FORMULA_NEGATIVE)) return subtract(t, a, t->node[b].a);
  if (is(t, a, FORMULA_NEGATIVE)) return subtract(t, b, t->node[a].a);
  if (is(t, a, FORMULA_MULTIPLY)) return three(t, FORMULA_FUSED, a, b);
  if (is(t, b, FORMULA_MULTIPLY)) return three(t, FORMULA_FUSED, b, a);
  return make(t, (formula_node){.kind = FORMULA_ADD, .a = a < b ? a : b, .b = a < b ? b : a});
}

int pendres_formula_two(formula_tree *t, formula_kind kind, int a, int b)
{
  if (a < 0 || b < 0) return FORMULA_NONE;
  if (is(t, a, FORMULA_CONSTANT) && is(t, b, FORMULA_CONSTANT))
    return pendres_formula_constant(
      t, pendres_formula_of_two(kind, t->node[a].value, t->node[b].value));
  switch (kind) {
  case FORMULA_ADD: return add(t, a, b);
  case FORMULA_SUBTRACT: return subtract(t, a, b);
  case FORMULA_MULTIPLY: return multiply(t, a, b);
  case FORMULA_DIVIDE:
    if (is_value(t, b, 1.0)) return a;
    if (is_value(t, a, 0.0)) return a;
    if (is(t, a, FORMULA_NEGATIVE))
      return pendres_formula_one(t, FORMULA_NEGATIVE,
                                 pendres_formula_two(t, kind, t->node[a].a, b));
    break;
  case FORMULA_WITHIN:
    if (is(t, b, FORMULA_CONSTANT) && t->node[b].value > 0.0) return a;
    break;
  default: break;
  }
  return make(t, (formula_node){.kind = kind, .a = a, .b = b});
}

static int whole_power(formula_tree *t, int a, int n)
{
  if (n == 1) return a;
  const int half = whole_power(t, a, n / 2), square = multiply(t, half, half);
  return n % 2 == 0 || square < 0 ? square : multiply(t, square, a);
}

int pendres_formula_power(formula_tree *t, int a, int b)
{
  if (a < 0 || b < 0) return FORMULA_NONE;
  const double n = pendres_formula_value(t, b), size = fabs(n);
  if (n == 0.0) return pendres_formula_constant(t, 1.0);
  if (size <= FORMULA_MOST_POWER && 2.0 * n == rint(2.0 * n)) {
    const int root = n == rint(n) ? a : pendres_formula_one(t, FORMULA_SQRT, a);
    const int power = whole_power(t, root, (int)(n == rint(n) ? size : 2.0 * size));
    return n > 0.0 ? power
                   : pendres_formula_two(t, FORMULA_DIVIDE, pendres_formula_constant(t, 1.0),
                                         power);
  }
  const int logarithm = pendres_formula_one(t, FORMULA_LOG, a);
  return pendres_formula_one(t, FORMULA_EXP,
                             pendres_formula_two(t, FORMULA_MULTIPLY, b, logarithm));
}
