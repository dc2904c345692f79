/*
 * taylor.h -- the Taylor-series integrator behind reference.h.
 *
 * Owns: the run of one pendulum over whole drive periods, with columns of the variational
 * equation and the integrals over a cycle on request. Units and equation: reference.h.
 */
#ifndef REFERENCE_TAYLOR_H
#define REFERENCE_TAYLOR_H

#include <float.h>

#include <pendres/pendulum.h>
#include <pendres/status.h>

/* Near the optimum -ln(epsilon)/2 of Jorba and Zou, a little higher because the series of
   the columns fall off later: 30 for 64 bits, 52 for 113. */
#define REFERENCE_ORDER (LDBL_MANT_DIG * 15 / 32)

/* A number in two words, |lo| at most half a unit in the last place of hi. */
typedef struct reference_pair {
  long double hi, lo;
} reference_pair;

/* Parameters in long double, since solvers vary them. */
typedef struct reference_model {
  long double damping, drive_amplitude, drive_frequency, torque, parametric_amplitude;
  int sine;       /* 1: the force has the term sin y */
  int powers;     /* how many powers of y it has, 0 to 5, ... */
  long double power[PENDRES_FORCE_POWERS]; /* ... and their coefficients a1, a2, ... */
  int turns;      /* 1: y and y + 2 pi are the same */
} reference_model;

/* Convert a pendulum. PENDRES_INVALID_ARGUMENT if it is not valid, or the series of its force is
   not known here. */
pendres_status reference_model_of(const pendres_pendulum *p, reference_model *out);

/* Columns of the variational equation: derivatives with respect to ... */
enum {
  REFERENCE_BY_Y,
  REFERENCE_BY_V,
  REFERENCE_BY_FREQUENCY,
  REFERENCE_BY_DAMPING,
  REFERENCE_BY_AMPLITUDE,
  REFERENCE_COLUMNS
};

/* Power series in t around the beginning of a step. */
typedef long double reference_series[REFERENCE_ORDER + 1];

typedef struct reference_run {
  /* What to do: set by init, may be changed before the run. */
  reference_model model;
  int order;         /* at most REFERENCE_ORDER */
  int steps;         /* a drive period; 0: chosen from the series */
  int columns;       /* how many, in the order above */
  int measures;      /* nonzero: integrals and extremes as well */
  long double drift; /* turns a drive cycle, taken off y in the measures */
  /* The state, at drive phase 0 before and after a run. */
  reference_pair y, v;
  long turns;
  reference_pair u[REFERENCE_COLUMNS]; /* of y */
  reference_pair w[REFERENCE_COLUMNS]; /* of v */
  /* Integrals over t since init. */
  reference_pair area;    /* F v */
  reference_pair square;  /* v^2 */
  reference_pair parametric; /* -b f cos(theta) v */
  reference_pair cosine;  /* (y - drift theta) cos theta */
  reference_pair sine;    /* (y - drift theta) sin theta */
  reference_pair area_by[REFERENCE_COLUMNS];
  long double highest, lowest;    /* of y - drift theta */
  /* Workspace. */
  long periods; /* run so far */
  long double theta;
  reference_series sy, sv, ssin, scos, sdrive, squad; /* squad: sine of the phase */
  reference_series spower[PENDRES_FORCE_POWERS + 1]; /* y^0, y^1, ... */
  reference_series sbare, sbare_slope; /* f and df/dy, */
  reference_series sdriven;            /* f cos(theta), */
  reference_series sforce, sslope;     /* and f and df/dy times 1 + b cos(theta) */
  reference_series su[REFERENCE_COLUMNS], sw[REFERENCE_COLUMNS];
} reference_run;

/* 2 pi in two words. */
reference_pair reference_taylor_two_pi(void);

/* A run from (y, v), |y| <= 1e9, with the columns at their start. Returns the whole turns
   taken off y; the run's own count begins at 0. */
long reference_taylor_init(reference_run *run,
                                   const reference_model *model, long double y,
                                   long double v);

/* Advance by `periods` drive periods. PENDRES_INTEGRATION_FAILED if steps become too small. */
pendres_status reference_taylor_advance(reference_run *run, long periods);

/* Advance by half a period from drive phase 0. The run cannot go on from there. */
pendres_status reference_taylor_advance_half(reference_run *run);

#endif
