/*
 * kernels.h -- the inner loops over lanes, chosen at run time.
 *
 * Owns: linear combinations of vectors, and the right-hand sides of the
 * pendulum and of its variational and sensitivity equations, for a block of
 * pendulums side by side. kernels.c is compiled once per instruction set; all
 * variants do the same IEEE operations in the same order (every fused
 * multiply-add is written out), so they give the same bytes.
 *
 * Equation over drive phase theta = omega t, y the angle, w = dy/dtheta:
 *
 *     dy/dtheta = w
 *     dw/dtheta = -stiffness sin y + drive cos theta - friction w
 *
 * with stiffness = 1/omega^2, drive = F0/omega^2, friction = gamma/omega.
 */
#ifndef PENDRES_KERNELS_H
#define PENDRES_KERNELS_H

#include <stddef.h>

/* Coefficients of a block, one array entry a lane. */
typedef struct pendres_coefficients {
  const double *stiffness; /* 1/omega^2 */
  const double *drive;     /* F0/omega^2 */
  const double *friction;  /* gamma/omega */
  const double *inverse;   /* 1/omega; read by the sensitivities alone */
} pendres_coefficients;

/*
 * Rows of a state of lanes, each row `stride` doubles long, lanes side by side:
 *   0 y, 1 w                            the state
 *   2, 3 d(y,w)/dy0   4, 5 d(y,w)/dw0   the variational equation
 *   6, 7 d/domega  8, 9 d/dgamma  10, 11 d/dF0   parameter sensitivities, at fixed
 *                                       initial y0 and w0
 */
enum { PENDRES_ROWS_STATE = 2, PENDRES_ROWS_VARIATIONAL = 6, PENDRES_ROWS_SENSITIVITY = 12 };

typedef void pendres_rhs_kernel(size_t stride, const pendres_coefficients *k, double cos_theta,
                                const double *state, double *slope);

typedef struct pendres_kernels {
  const char *name;
  /* z = sum over terms of c[i] x[i]; n a multiple of 8; z may be one of the x. */
  void (*combine)(size_t n, int terms, const double *c, const double *const *x, double *z);
  pendres_rhs_kernel *state;       /* rows 0..1 */
  pendres_rhs_kernel *variational; /* rows 0..5 */
  pendres_rhs_kernel *sensitivity; /* rows 0..11 */
} pendres_kernels;

/* The fastest variant that this processor runs. Never NULL; static. */
const pendres_kernels *pendres_kernels_select(void);

extern const pendres_kernels pendres_kernels_base;
#if defined(__x86_64__)
extern const pendres_kernels pendres_kernels_avx2;
extern const pendres_kernels pendres_kernels_avx512;
#endif

#endif
