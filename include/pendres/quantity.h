/**
 * @file quantity.h
 * @brief What results, parameters and keys of decks are: their kinds, dimensions and definitions.
 *
 * Owns: the list of kinds of quantities with their dimensions, and the table of quantities by name.
 * Units of records, attributes of files and a laboratory's units follow from their rows.
 *
 * Thread safety: all functions are pure. What they return is constant, and the library's.
 */
#ifndef PENDRES_QUANTITY_H
#define PENDRES_QUANTITY_H

#include <stddef.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/*
 * One row makes a kind: ITEM(code, length, time, unit)
 *
 *   length, time   the powers of a pendulum's units (pendres_units_of) that make its own
 *   unit           that of the plain pendulum, in words
 */
#define PENDRES_KIND_LIST(ITEM)                                                            \
  ITEM(NUMBER, 0, 0, "1")                                                                  \
  ITEM(PHASE, 0, 0, "rad")                                                                 \
  ITEM(POSITION, 1, 0, "rad")                                                              \
  ITEM(VELOCITY, 1, -1, "omega0")                                                          \
  ITEM(RATE, 0, -1, "omega0")                                                              \
  ITEM(FREQUENCY, 0, -1, "omega0")                                                         \
  ITEM(TIME, 0, 1, "1/omega0")                                                             \
  ITEM(FORCE, 1, -2, "m g l")                                                              \
  ITEM(ENERGY, 2, -2, "m g l")                                                             \
  ITEM(POWER, 2, -3, "m g l omega0")                                                       \
  ITEM(TEMPERATURE, 2, -2, "m g l / k")                                                    \
  ITEM(VARIANCE_X, 2, 0, "1")                                                              \
  ITEM(COVARIANCE, 2, -1, "1")                                                             \
  ITEM(VARIANCE_V, 2, -2, "1")                                                             \
  ITEM(SPECTRUM, 2, -1, "1")                                                               \
  ITEM(A1, 0, -2, "1")                                                                     \
  ITEM(A2, -1, -2, "1")                                                                    \
  ITEM(A3, -2, -2, "1")                                                                    \
  ITEM(A4, -3, -2, "1")                                                                    \
  ITEM(A5, -4, -2, "1")                                                                    \
  ITEM(NONLINEAR_DAMPING, -2, -1, "omega0")                                                \
  ITEM(QUADRATIC_DAMPING, -1, 0, "1")                                                      \
  ITEM(CUBIC_DAMPING, -2, 1, "1/omega0")                                                   \
  ITEM(SWEPT, 0, 0, "1")

/**
 * Kinds of quantities. Those of one dimension differ in how a laboratory writes them: a frequency,
 * which is an angular one, in Hz; the phase of the drive, an angle also where the coordinate is
 * none; PENDRES_KIND_COVARIANCE, of x and v; PENDRES_KIND_SPECTRUM, of v by frequency;
 * PENDRES_KIND_A1 and so on, coefficients of a polynomial force; those of friction.
 * PENDRES_KIND_SWEPT: that of the parameter that is varied.
 */
typedef enum pendres_kind {
#define PENDRES_KIND_CODE(code, length, time, unit) PENDRES_KIND_##code,
  PENDRES_KIND_LIST(PENDRES_KIND_CODE)
#undef PENDRES_KIND_CODE
  PENDRES_KIND_COUNT /**< how many there are; not a kind */
} pendres_kind;

/** What there is to say of a kind. */
typedef struct pendres_kind_info {
  const char *unit; /**< of the plain pendulum's: "omega0", "m g l"; "1": a number */
  int length;       /**< the power of the unit of length (pendres_units_of) in its own unit */
  int time;         /**< that of the unit of time */
} pendres_kind_info;

/** What there is to say of a kind; NULL if out of range. */
const pendres_kind_info *pendres_kind_of(pendres_kind kind);

/** A quantity. */
typedef struct pendres_quantity {
  const char *name;       /**< of results in files, of parameters, of fields */
  const char *words;      /**< what it is, in short */
  const char *definition; /**< as a formula in words; NULL: the words say it all */
  const char *coordinate; /**< the same where x is no angle; NULL: the same words */
  pendres_kind kind;      /**< its dimension, and how it is written */
} pendres_quantity;

/** The quantities by number, from 0 on; NULL beyond the last. */
const pendres_quantity *pendres_quantity_get(size_t number);

/** The quantity of a name, among them all parameters (pendres/parameter.h); NULL if there is none
    or the name is NULL. Names that only end in the same word are other quantities, or none. */
const pendres_quantity *pendres_quantity_of(const char *name);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
