/*
 * kernels.h -- the inner loops over lanes, chosen at run time.
 *
 * Owns: linear combinations of vectors, and the right-hand sides of the
 * pendulum and of its variational and sensitivity equations, for pendulums side
 * by side. kernels.c is compiled once per instruction set; all variants do the
 * same IEEE operations in the same order (every fused multiply-add is written
 * out), so they give the same bytes.
 *
 * Equation over drive phase theta = omega t, y the angle, w = dy/dtheta:
 *
 *     dy/dtheta = w
 *     dw/dtheta = -stiffness sin y + drive cos theta - friction w
 *
 * with stiffness = 1/omega^2, drive = F0/omega^2, friction = gamma/omega; with a torque, a
 * parametric drive, and any force f,
 *
 *     dw/dtheta = -stiffness f(y) (1 + modulation cos theta) + drive cos theta + torque - friction
 *                 w - (nonlinear y^2 + quadratic |w| + cubic w^2) w
 *
 * Each model (model.h) has kernels of its own, so that none spends time on terms that it does not
 * have; those of the last line, which few have, are added behind (resist). Those for a pendulum
 * with torque or parametric drive give the same bits for a plain one as its own do.
 */
#ifndef PENDRES_KERNELS_H
#define PENDRES_KERNELS_H

#include <stddef.h>

#include <pendres/parameter.h>

#include "model/model.h"

/* Coefficients of the equation, ITEM(name, what it is of pendulum p); the inverse is read by the
   sensitivities alone. */
#define PENDRES_COEFFICIENTS_PLAIN(ITEM)                                \
  ITEM(stiffness, 1.0 / (p->drive_frequency * p->drive_frequency))      \
  ITEM(drive, p->drive_amplitude / (p->drive_frequency * p->drive_frequency)) \
  ITEM(friction, p->damping / p->drive_frequency)                       \
  ITEM(inverse, 1.0 / p->drive_frequency)
/* Read for the models that have them. */
#define PENDRES_COEFFICIENTS_OTHER(ITEM)                                \
  ITEM(torque, p->torque / (p->drive_frequency * p->drive_frequency))   \
  ITEM(modulation, p->parametric_amplitude)                             \
  ITEM(nonlinear, p->nonlinear_damping / p->drive_frequency)            \
  ITEM(quadratic, p->quadratic_damping)                                 \
  ITEM(cubic, p->cubic_damping * p->drive_frequency)

/* One array entry a lane. */
typedef struct pendres_coefficients {
#define PENDRES_COEFFICIENT_ARRAY(name, value) const double *name;
  PENDRES_COEFFICIENTS_PLAIN(PENDRES_COEFFICIENT_ARRAY)
  PENDRES_COEFFICIENTS_OTHER(PENDRES_COEFFICIENT_ARRAY)
#undef PENDRES_COEFFICIENT_ARRAY
  const double *power[PENDRES_FORCE_POWERS]; /* a1 .. a5 of a force that has them */
  const struct pendres_formula *formula; /* of all lanes; NULL: the force is no formula */
  const double *const *value; /* within a kernel: what the formula gives, of each lane */
} pendres_coefficients;

/* From what pendres_kernels_force() takes a lane's force: the values of a formula that was computed
   at the lanes' y, or coefficients. */
static inline const double *const *pendres_kernels_source(pendres_model_terms model,
                                                          const pendres_coefficients *k)
{
  return model == PENDRES_MODEL_FORMULA ? k->value : k->power;
}

/*
 * Rows of a state of lanes, each row as long as there are lanes, lanes side by side:
 *   0 y, 1 w                            the state
 *   2, 3 d(y,w)/dy0   4, 5 d(y,w)/dw0   the variational equation
 *   6, 7 d/domega  8, 9 d/dgamma  10, 11 d/dF0   parameter sensitivities, at fixed
 *                                       initial y0 and w0
 *   12, 13 d/dI  14, 15 d/db            where they are asked for
 *   16, 17 d/da1  ...  24, 25 d/da5     of a polynomial force
 *   26, 27 ... 30, 31                   by nonlinear, quadratic and cubic damping
 */
enum {
  PENDRES_ROWS_STATE = 2,
  PENDRES_ROWS_VARIATIONAL = 6,
  PENDRES_ROWS_SENSITIVITY = 12,
  PENDRES_ROWS_DRIVES = 16,
  PENDRES_ROWS_FORCE = PENDRES_ROWS_DRIVES + 2 * PENDRES_FORCE_POWERS,
  PENDRES_ROWS_ALL = PENDRES_ROWS_VARIATIONAL + 2 * PENDRES_PARAMETER_FOLLOWED
};
typedef enum pendres_row {
  PENDRES_ROW_Y,
  PENDRES_ROW_W,
  PENDRES_ROW_BY_Y, /* from here on two rows each: of y and of w, derived by ... */
  PENDRES_ROW_BY_W = PENDRES_ROW_BY_Y + 2,
  PENDRES_ROW_BY_PARAMETERS = PENDRES_ROW_BY_W + 2, /* by number, <pendres/parameter.h> */
  PENDRES_ROW_BY_OMEGA = PENDRES_ROW_BY_PARAMETERS + 2 * (int)PENDRES_DRIVE_FREQUENCY,
  PENDRES_ROW_BY_GAMMA = PENDRES_ROW_BY_PARAMETERS + 2 * (int)PENDRES_DAMPING,
  PENDRES_ROW_BY_DRIVE = PENDRES_ROW_BY_PARAMETERS + 2 * (int)PENDRES_DRIVE_AMPLITUDE,
  PENDRES_ROW_BY_TORQUE = PENDRES_ROW_BY_PARAMETERS + 2 * (int)PENDRES_TORQUE,
  PENDRES_ROW_BY_MODULATION = PENDRES_ROW_BY_PARAMETERS + 2 * (int)PENDRES_PARAMETRIC_AMPLITUDE,
  PENDRES_ROW_BY_POWERS = PENDRES_ROW_BY_PARAMETERS + 2 * (int)PENDRES_A1, /* and so on */
  PENDRES_ROW_BY_NONLINEAR = PENDRES_ROW_BY_PARAMETERS + 2 * (int)PENDRES_NONLINEAR_DAMPING,
  PENDRES_ROW_BY_QUADRATIC = PENDRES_ROW_BY_PARAMETERS + 2 * (int)PENDRES_QUADRATIC_DAMPING,
  PENDRES_ROW_BY_CUBIC = PENDRES_ROW_BY_PARAMETERS + 2 * (int)PENDRES_CUBIC_DAMPING
} pendres_row;

/* The rows of a block, to be read: row r of lane i is at[r stride + i]. */
typedef struct pendres_rows {
  const double *at;
  size_t stride;
} pendres_rows;

static inline double pendres_rows_get(const pendres_rows *rows, int row, size_t lane)
{
  return rows->at[(size_t)row * rows->stride + lane];
}

/* Derivatives of a lane's (y, w), the pair of rows that starts with `row`. */
static inline void pendres_rows_pair(const pendres_rows *rows, int row, size_t lane,
                                     double pair[2])
{
  pair[0] = pendres_rows_get(rows, row, lane);
  pair[1] = pendres_rows_get(rows, row + 1, lane);
}

/* The derivative of a lane's (y, w) by its initial (y, w). */
static inline void pendres_rows_tangent(const pendres_rows *rows, size_t lane, double m[2][2])
{
  for (int i = 0; i < 2; i++) {
    m[i][0] = pendres_rows_get(rows, PENDRES_ROW_BY_Y + i, lane);
    m[i][1] = pendres_rows_get(rows, PENDRES_ROW_BY_W + i, lane);
  }
}

enum { PENDRES_KERNELS_TERMS = 20 }; /* the most terms of a sum: stages of a table, plus some */

/* z = sum of c x, added up in this order; z may be one of the x. At least one term. */
typedef struct pendres_sum {
  int terms;
  double *z;
  struct {
    double c;
    const double *x;
  } term[PENDRES_KERNELS_TERMS];
} pendres_sum;

/*
 * One operation on vectors; what is NULL says which:
 *   sum, no slope     the sum
 *   sum, slope        the sum, then slope = right-hand side at its z; unless keep is set z is not
 *                     needed any more, and its contents are undefined
 *   from, slope       slope = right-hand side at from, another vector
 *   from, to          to = from
 *   from, carry       errors or tangents of the strip's lanes over a step of this length that ends
 *                     at from
 *   to                to = 0
 *   nothing           nothing
 */
typedef struct pendres_operation {
  const pendres_sum *sum;
  const double *from;
  double *to, *slope;
  double cos_theta;
  double carry; /* 0: nothing is carried; else cos_theta is that of the step's end */
  int second;   /* tangents: with steps twice as long, too */
  int keep;
} pendres_operation;

/*
 * The covariance of the error of each lane: of y, of y and w, of w; and the variance that a step
 * adds to that of y, while that of w gets 1/omega^2 times as much. It is advanced by steps of
 * second order, which cost little compared with those of the state and need be correct only to a
 * few per cent. Two factors of a step are constants: `keep`, by which the drag reduces the error
 * of w, and `kick`, which, times cos y, is the spring's contribution from the error of y.
 */
typedef struct pendres_carried {
  double *yy, *yw, *ww;
  const double *added;
  const double *keep, *kick;
} pendres_carried;

/*
 * A tangent vector of each lane: the distance of a neighbour, divided by a small number. Its w is
 * replaced by w + friction y / 2, so that the drag only multiplies both components by `keep` in
 * each step. Tangents are advanced by steps of their own, with one cosine each: once with the steps
 * of the state, and once with steps twice as long, from which the error follows.
 */
typedef struct pendres_tangents {
  double *y[2], *w[2];
  const double *keep; /* exp(-friction step / 2) */
} pendres_tangents;

/* What a block advances beside its states. */
typedef enum pendres_flow_load {
  PENDRES_FLOW_NOTHING,
  PENDRES_FLOW_ERRORS,
  PENDRES_FLOW_TANGENTS
} pendres_flow_load;

/* The same for one lane. */
typedef struct pendres_flow_error {
  double yy, yw, ww;
} pendres_flow_error;

/* By what periods with fixed steps are computed. */
typedef enum pendres_flow_way {
  PENDRES_FLOW_TABLE,   /* a Butcher table, with ARKODE */
  PENDRES_FLOW_NYSTROM, /* a Nystrom method (kernels_nystrom.h) */
  PENDRES_FLOW_SINGLE   /* the same in single precision */
} pendres_flow_way;

/* A few lanes side by side: where in each vector they are, and their coefficients. */
typedef struct pendres_strip {
  size_t lanes; /* a multiple of 8 */
  pendres_model_terms model;
  int drags;    /* some have friction other than damping x' */
  size_t at;    /* a vector's rows are at x + at, x + at + lanes, ... */
  pendres_coefficients k;
  pendres_carried off; /* read and written where errors are carried, */
  pendres_tangents tangent; /* or tangents; NULL: not so */
} pendres_strip;

typedef struct pendres_kernels {
  const char *name;
  /* Do the operations in their order. rows: one of PENDRES_ROWS_; data on 64-byte boundaries. */
  void (*run)(size_t rows, const pendres_strip *strip, const pendres_operation *operations,
              size_t n);
} pendres_kernels;

/* The fastest variant that this processor runs. Never NULL; static. Defined in block.c, since
   kernels.c is compiled once for each variant. */
const pendres_kernels *pendres_kernels_select(void);

extern const pendres_kernels pendres_kernels_base;
#if defined(__x86_64__)
extern const pendres_kernels pendres_kernels_avx2;
extern const pendres_kernels pendres_kernels_avx512;
#endif

#endif
