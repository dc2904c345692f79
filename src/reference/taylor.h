/*
 * taylor.h -- the Taylor-series integrator behind reference.h.
 *
 * Owns: the run of one pendulum over whole drive periods, with columns of the variational
 * equation and the integrals over a cycle on request. Units and equation: reference.h.
 */
#ifndef PENDRES_REFERENCE_TAYLOR_H
#define PENDRES_REFERENCE_TAYLOR_H

#include <float.h>

#include <pendres/pendulum.h>
#include <pendres/status.h>

/* Near the optimum -ln(epsilon)/2 of Jorba and Zou, a little higher because the series of
   the columns fall off later: 30 for 64 bits, 52 for 113. */
#define PENDRES_REFERENCE_ORDER (LDBL_MANT_DIG * 15 / 32)

/* A number in two words, |lo| at most half a unit in the last place of hi. */
typedef struct pendres_reference_pair {
  long double hi, lo;
} pendres_reference_pair;

/* Parameters in long double, since solvers vary them. */
typedef struct pendres_reference_model {
  long double damping, drive_amplitude, drive_frequency, torque, parametric_amplitude;
  int sine;       /* 1: the force has the term sin y */
  int powers;     /* how many powers of y it has, 0 to 5, ... */
  long double power[PENDRES_FORCE_COEFFICIENTS]; /* ... and their coefficients a1, a2, ... */
  int turns;      /* 1: y and y + 2 pi are the same */
} pendres_reference_model;

/* Convert a pendulum. PENDRES_INVALID_ARGUMENT if it is not valid, or the series of its force is
   not known here. */
pendres_status pendres_reference_model_of(const pendres_pendulum *p, pendres_reference_model *out);

/* Columns of the variational equation: derivatives with respect to ... */
enum {
  PENDRES_REFERENCE_BY_Y,
  PENDRES_REFERENCE_BY_V,
  PENDRES_REFERENCE_BY_FREQUENCY,
  PENDRES_REFERENCE_BY_DAMPING,
  PENDRES_REFERENCE_BY_AMPLITUDE,
  PENDRES_REFERENCE_COLUMNS
};

/* Power series in t around the beginning of a step. */
typedef long double pendres_reference_series[PENDRES_REFERENCE_ORDER + 1];

typedef struct pendres_reference_run {
  /* What to do: set by init, may be changed before the run. */
  pendres_reference_model model;
  int order;         /* at most PENDRES_REFERENCE_ORDER */
  int steps;         /* a drive period; 0: chosen from the series */
  int columns;       /* how many, in the order above */
  int measures;      /* nonzero: integrals and extremes as well */
  long double drift; /* turns a drive cycle, taken off y in the measures */
  /* The state, at drive phase 0 before and after a run. */
  pendres_reference_pair y, v;
  long turns;
  pendres_reference_pair u[PENDRES_REFERENCE_COLUMNS]; /* of y */
  pendres_reference_pair w[PENDRES_REFERENCE_COLUMNS]; /* of v */
  /* Integrals over t since init. */
  pendres_reference_pair area;    /* F v */
  pendres_reference_pair square;  /* v^2 */
  pendres_reference_pair parametric; /* -b f cos(theta) v */
  pendres_reference_pair cosine;  /* (y - drift theta) cos theta */
  pendres_reference_pair sine;    /* (y - drift theta) sin theta */
  pendres_reference_pair area_by[PENDRES_REFERENCE_COLUMNS];
  long double highest, lowest;    /* of y - drift theta */
  /* Workspace. */
  long periods; /* run so far */
  long double theta;
  pendres_reference_series sy, sv, ssin, scos, sdrive, squad; /* squad: sine of the phase */
  pendres_reference_series spower[PENDRES_FORCE_COEFFICIENTS + 1]; /* y^0, y^1, ... */
  pendres_reference_series sbare, sbare_slope; /* f and df/dy, */
  pendres_reference_series sdriven;            /* f cos(theta), */
  pendres_reference_series sforce, sslope;     /* and f and df/dy times 1 + b cos(theta) */
  pendres_reference_series su[PENDRES_REFERENCE_COLUMNS], sw[PENDRES_REFERENCE_COLUMNS];
} pendres_reference_run;

/* 2 pi in two words. */
pendres_reference_pair pendres_reference_taylor_two_pi(void);

/* A run from (y, v), |y| <= 1e9, with the columns at their start. Returns the whole turns
   taken off y; the run's own count begins at 0. */
long pendres_reference_taylor_init(pendres_reference_run *run,
                                   const pendres_reference_model *model, long double y,
                                   long double v);

/* Advance by `periods` drive periods. PENDRES_INTEGRATION_FAILED if steps become too small. */
pendres_status pendres_reference_taylor_advance(pendres_reference_run *run, long periods);

/* Advance by half a period from drive phase 0. The run cannot go on from there. */
pendres_status pendres_reference_taylor_advance_half(pendres_reference_run *run);

#endif
