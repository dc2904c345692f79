/*
 * defined.c -- the formulas that there are, by number; see formula.h.
 *
 * Pendulums are plain numbers that go through files, other processes and sums by which states are
 * recognised: a formula's number has to be the same in all of them, and follows from its text. To
 * find a formula by it there is one table in a process, the only data of the library that is
 * written. Contexts share nothing by it: what a number stands for never changes, and an entry that
 * was made is only read.
 */
#include "model/formula/formula.h"

#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { TABLE = 2048, MOST = 1024 /* formulas, so that one is found in a few tries */ };

static _Atomic(pendres_formula *) table[TABLE];
static atomic_int defined;

/* By FNV-1a. */
static uint32_t number_of(const char *text)
{
  uint32_t hash = 2166136261u;
  for (; *text != '\0'; text++) hash = (hash ^ (unsigned char)*text) * 16777619u;
  return (hash ^ hash >> 30) & (PENDRES_FORCE_FORMULA - 1u);
}

const pendres_formula *pendres_formula_of(pendres_force force)
{
  if (force < PENDRES_FORCE_FORMULA) return NULL;
  for (unsigned i = (unsigned)force;; i++) {
    const pendres_formula *f = atomic_load_explicit(&table[i % TABLE], memory_order_acquire);
    if (f == NULL || f->number == force) return f;
  }
}

static void formula_free(pendres_formula *f)
{
  if (f == NULL) return;
  for (int k = 0; k < FORMULA_PROGRAMS; k++) pendres_formula_program_free(&f->program[k]);
  free(f->text);
  free(f);
}

/* Enter a formula, or find that another thread has done so; what is not entered is freed. */
static pendres_status enter(pendres_formula *f, pendres_force *force, pendres_formula_error *error)
{
  if (atomic_load(&defined) >= MOST) {
    formula_free(f);
    return PENDRES_OUT_OF_MEMORY;
  }
  for (unsigned i = (unsigned)f->number;; i++) {
    pendres_formula *there = NULL;
    if (atomic_compare_exchange_strong(&table[i % TABLE], &there, f)) {
      (void)atomic_fetch_add(&defined, 1);
      *force = f->number;
      return PENDRES_OK;
    }
    if (there->number != f->number) continue;
    const int same = strcmp(there->text, f->text) == 0;
    *force = there->number;
    formula_free(f);
    if (same) return PENDRES_OK;
    *error = (pendres_formula_error){
      .message = "another formula has the same number: write this one a little differently"};
    return PENDRES_INVALID_ARGUMENT;
  }
}

/* ---- what follows from a formula ---- */

/* Where it begins to lead outwards for ever is asked of each state (pendres_model_escapes). */
static double outward(const double *a, double side, double need)
{
  (void)a;
  (void)side;
  (void)need;
  return INFINITY;
}

/* The programs of a force whose tree is made. */
static int compile(pendres_formula *f, formula_tree *t, int force)
{
  int node[FORMULA_OUTPUTS];
  memset(node, -1, sizeof node);
  node[FORMULA_OUT_FORCE] = pendres_formula_within(t, force);
  f->bounded = node[FORMULA_OUT_FORCE] != force;
  int good = pendres_formula_program_make(t, node, &f->program[FORMULA_FORCES]) == 0;
  node[FORMULA_OUT_SLOPE] = pendres_formula_derivative(t, force, FORMULA_X, 0);
  good = good && pendres_formula_program_make(t, node, &f->program[FORMULA_SLOPES]) == 0;
  node[FORMULA_OUT_CURVE] = pendres_formula_derivative(t, node[FORMULA_OUT_SLOPE], FORMULA_X, 0);
  good = good && node[FORMULA_OUT_CURVE] >= 0 &&
         pendres_formula_program_make(t, node, &f->program[FORMULA_CURVES]) == 0;
  node[FORMULA_OUT_CURVE] = FORMULA_NONE;
  for (int k = 0; k < PENDRES_FORCE_POWERS && good; k++) {
    node[FORMULA_OUT_BY + k] = pendres_formula_derivative(t, force, FORMULA_COEFFICIENT, k);
    good = node[FORMULA_OUT_BY + k] >= 0;
  }
  formula_program *last = &f->program[FORMULA_SENSITIVITIES];
  return good && pendres_formula_program_make(t, node, last) == 0 ? 0 : -1;
}

static void describe(pendres_formula *f, const formula_tree *t, int force)
{
  const int turns = pendres_formula_turns(t, force);
  int coefficients = 0;
  f->by = t->node[force].by;
  for (int k = 0; k < PENDRES_FORCE_POWERS; k++)
    if ((f->by & (unsigned)FORMULA_BY_COEFFICIENTS << k) != 0) coefficients = k + 1;
  f->model = (pendres_model){.name = "formula",
                             .period = turns ? 2.0 * PENDRES_PI : 0.0,
                             .angle = turns,
                             .coefficients = coefficients,
                             .outward = turns ? NULL : outward};
}

static pendres_status define(const char *text, formula_tree *t, char *canonical,
                             pendres_force *force, pendres_formula_error *error)
{
  const int node = pendres_formula_parse(text, t, canonical, error);
  if (node < 0) return PENDRES_INVALID_ARGUMENT;
  if ((t->node[node].by & FORMULA_BY_X) == 0) {
    *error = (pendres_formula_error){.length = (int)strlen(text),
                                     .message = "a force that does not depend on x"};
    return PENDRES_INVALID_ARGUMENT;
  }
  pendres_formula *f = calloc(1, sizeof *f);
  if (f == NULL) return PENDRES_OUT_OF_MEMORY;
  f->text = malloc(strlen(canonical) + 1);
  f->number = (pendres_force)(PENDRES_FORCE_FORMULA | number_of(canonical));
  const int good = f->text != NULL && compile(f, t, node) == 0;
  if (!good) {
    formula_free(f);
    *error = (pendres_formula_error){.length = (int)strlen(text),
                                     .message = "this formula has too many operations"};
    return PENDRES_INVALID_ARGUMENT;
  }
  strcpy(f->text, canonical);
  describe(f, t, node);
  return enter(f, force, error);
}

pendres_status pendres_force_define(const char *text, pendres_force *force,
                                    pendres_formula_error *error)
{
  pendres_formula_error unused, *told = error != NULL ? error : &unused;
  *told = (pendres_formula_error){.message = "no text was given"};
  if (text == NULL || force == NULL) return PENDRES_INVALID_ARGUMENT;
  told->message[0] = '\0';
  formula_tree t = {.node = malloc(FORMULA_MOST_NODES * sizeof *t.node)};
  char *canonical = malloc(FORMULA_LONGEST + 1);
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (t.node != NULL && canonical != NULL) status = define(text, &t, canonical, force, told);
  free(t.node);
  free(canonical);
  return status;
}

const char *pendres_force_text(pendres_force force)
{
  const pendres_formula *f = pendres_formula_of(force);
  return f != NULL ? f->text : NULL;
}

/* ---- values at one point ---- */

void pendres_formula_at(const pendres_formula *f, formula_programs which, const double *a,
                        double y, double *out)
{
  const formula_program *p = &f->program[which];
  const double *at[FORMULA_MOST_PLACES];
  _Alignas(64) double slots[FORMULA_MOST_SLOTS * FORMULA_LANES];
  at[FORMULA_AT_X] = &y;
  for (int k = 0; k < PENDRES_FORCE_POWERS; k++) at[FORMULA_AT_COEFFICIENTS + k] = &a[k];
  pendres_formula_bind(p, at, slots);
  pendres_formula_run(p, 1, at, slots);
  for (int k = 0; k < FORMULA_OUTPUTS; k++)
    if (p->output[k] >= 0) out[k] = at[p->output[k]][0];
}
