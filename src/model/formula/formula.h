/*
 * formula.h -- forces that are given as text, by their numbers; see <pendres/formula.h>.
 *
 * Owns: formulas with their programs. A formula is found by the number in pendres_pendulum.force.
 */
#ifndef PENDRES_FORMULA_FORMULA_H
#define PENDRES_FORMULA_FORMULA_H

#include <pendres/formula.h>

#include "model/formula/program.h"

/* What is computed together. */
typedef enum formula_programs {
  FORMULA_FORCES,        /* the force alone, */
  FORMULA_SLOPES,        /* with its derivative, */
  FORMULA_CURVES,        /* with the second one as well, */
  FORMULA_SENSITIVITIES, /* or with those by the coefficients */
  FORMULA_PROGRAMS
} formula_programs;

typedef struct pendres_formula {
  pendres_force number;
  char *text; /* in its standard form */
  pendres_model model;
  unsigned by;  /* what it depends on: bits of tree.h */
  int bounded;  /* it is not defined for every x */
  formula_program program[FORMULA_PROGRAMS];
} pendres_formula;

enum { FORMULA_LONGEST = 400 /* characters of a text */ };

/* The tree's node of a text; FORMULA_NONE, and an error, if it is no formula. canonical: room for
   FORMULA_LONGEST + 1 characters. */
int pendres_formula_parse(const char *text, formula_tree *t, char *canonical,
                  pendres_formula_error *error);

/* The formula of a force; NULL if it is none that was defined. */
const pendres_formula *pendres_formula_of(pendres_force force);

/* f at y, and what else the program computes: out[0] the force, out[1] its slope, ... in the order
   of formula_output, those that are not computed left alone. */
void pendres_formula_at(const pendres_formula *f, formula_programs which, const double *a,
                        double y, double *out);

/* 0 where the force is odd at all points at which it is tried, and there is no torque; else NaN. */
double pendres_formula_centre(const pendres_formula *f, const double *a, double torque);

/* Whether the force pushes outwards by more than `need` from y on, as far as it is tried. */
int pendres_formula_leads_out(const pendres_formula *f, const double *a, double y, double need);

/* The distance from 0 to which the force is defined on one side; a guess where it is far. */
double pendres_formula_edge(const pendres_formula *f, const double *a, double side);

/* The integral of the force from 0 to y, to rounding where the force is smooth over an eighth. */
double pendres_formula_potential(const pendres_formula *f, const double *a, double y);

/* What a formula's terms may leave of a sum that is 0, relative to what is summed up. */
static const double formula_rounding = 0x1p-44;

#endif
