/*
 * tree.h -- a formula as a graph of operations with shared nodes.
 *
 * Owns: nodes, each of which is made once, simplified, with products under sums as one fused
 * operation; derivatives by x, v and coefficients; what nodes depend on.
 */
#ifndef PENDRES_FORMULA_TREE_H
#define PENDRES_FORMULA_TREE_H

#include "model/formula/kind.h"

enum {
  FORMULA_MOST_NODES = 2048, /* with derivatives */
  FORMULA_NONE = -1,         /* no node: memory or room is missing */
  /* Bits of what a node depends on; coefficients follow. */
  FORMULA_BY_X = 1,
  FORMULA_BY_V = 2,
  FORMULA_BY_PHASE = 4,
  FORMULA_BY_COEFFICIENTS = 8
};

typedef struct formula_node {
  formula_kind kind;
  int a, b, c;  /* operands: nodes before this one */
  int which;
  double value; /* of a constant */
  unsigned by;  /* what it depends on */
} formula_node;

/* A node that cannot be made is FORMULA_NONE, and so is all that is made of it. */
typedef struct formula_tree {
  formula_node *node;
  int count;
} formula_tree;

int pendres_formula_constant(formula_tree *t, double value);
int pendres_formula_leaf(formula_tree *t, formula_kind kind, int which);
int pendres_formula_one(formula_tree *t, formula_kind kind, int a);
int pendres_formula_two(formula_tree *t, formula_kind kind, int a, int b);

/* a to the power b: of whole numbers by multiplications, else exp(b log a). */
int pendres_formula_power(formula_tree *t, int a, int b);

/* The derivative of a node by a leaf; `which` as in the leaf. */
int pendres_formula_derivative(formula_tree *t, int of, formula_kind by, int which);

/* A node with a value in place of x, and with 0 in place of v. */
int pendres_formula_with_x(formula_tree *t, int of, double x);

/* The node, where all denominators and arguments of logarithms and roots that may change their
   signs with x have the signs that they have at x = 0; elsewhere NaN. */
int pendres_formula_within(formula_tree *t, int of);

/* Whether a node has the period 2 pi in x: x is only in sines and cosines of its multiples. */
int pendres_formula_turns(const formula_tree *t, int of);

/* The value of a node that depends on nothing; NaN otherwise. */
double pendres_formula_value(const formula_tree *t, int of);

#endif
