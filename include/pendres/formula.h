/**
 * @file formula.h
 * @brief Forces that are given as text.
 *
 * Owns: formulas, and the numbers by which pendulums refer to them.
 *
 * A formula is the f of pendulum.h, and may depend on x and on coefficients:
 *
 *     x + a1*x^3        sin(x) + a1*sin(2*x + a2)        (1 - exp(-x))*exp(-x)
 *
 * It has x (the coordinate itself), a1, a2, ... (force_coefficients), pi, numbers, + - * / and ^ or
 * **, parentheses, and sin cos tan exp log tanh sqrt abs sign atan. Where x is in sines and cosines
 * of its whole multiples alone, the coordinate has the period 2 pi. A formula must be finite at
 * x = 0. Denominators and arguments of logarithms keep the signs that they have there: beyond a
 * pole the force is NaN, and a pendulum that gets there has left for good (PENDRES_ESCAPED).
 *
 * The number of a formula follows from its text alone, so that it is the same in every process:
 * pendulums are plain numbers wherever they go, to files, to other ranks, into sums by which states
 * are recognised. A formula is never changed and never freed, and its number stays valid to the end
 * of the process.
 *
 * Thread safety: all functions may be called from several threads at once.
 */
#ifndef PENDRES_FORMULA_H
#define PENDRES_FORMULA_H

#include <pendres/pendulum.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/** Where and why a text is no formula. */
typedef struct pendres_formula_error {
  int at;            /**< the first character that is wrong, from 0 on */
  int length;        /**< how many there are, 0 at the text's end */
  char message[120]; /**< what is wrong, without a full stop */
  char instead[24];  /**< what may have been meant in their place, or "" */
} pendres_formula_error;

/**
 * The number of the force that a formula describes, to be put into pendres_pendulum.force; the text
 * is not kept. error may be NULL. Returns PENDRES_OK; PENDRES_INVALID_ARGUMENT if the text is no
 * formula; PENDRES_OUT_OF_MEMORY, also if a process has defined 1024 other formulas.
 */
pendres_status pendres_force_define(const char *text, pendres_force *force,
                                    pendres_formula_error *error);

/** A formula's text in its standard form, without blanks and with ^ for powers: owned by the
    library. NULL if the force is no formula, or none that this process has defined. */
const char *pendres_force_text(pendres_force force);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
