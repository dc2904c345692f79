/*
 * internal.h -- what the parts of a fit share: the model with its data, curves, and orbits at data.
 *
 * All is in canonical units but the data themselves, whose scales are unknowns: values of the
 * quantities are divided by model.unit.
 */
#ifndef PENDRES_FIT_INTERNAL_H
#define PENDRES_FIT_INTERNAL_H

#include <pendres/fit.h>

#include "analysis/fit_model/numbers.h"
#include "analysis/line/line.h"
#include "continuation/curve/follow.h"
#include "engine/context_internal.h"
#include "engine/room.h"

enum {
  FIT_QUANTITIES = PENDRES_FIT_QUANTITY_COUNT,
  FIT_BASES = PENDRES_FIT_OBSERVABLE_COUNT,
  FIT_PLACES = 3 /* y, w and the axis */
};

/* Values of all quantities. */
typedef double fit_values[FIT_QUANTITIES];

/* An orbit that is to be found and measured: across a border in the scaled (y, w, axis), which for
   orbits at given parameters is the axis itself, and for those at folds the curve's tangent; or, if
   it is tuned, where it lags by a quarter turn. */
typedef struct fit_lane {
  pendres_u u;
  double border[FIT_PLACES];
  int tuned;
  double turn[2], axis_by_lag; /* cosine and sine of the lag that the instrument adds, and how that
                                  moves the axis of a tuned one */
  int found, stable;
  double moved; /* by the last step of Newton's method */
  double base[FIT_BASES]; /* the observables, in canonical units */
  double slope[FIT_BASES][PENDRES_PARAMETER_FOLLOWED]; /* along the curve, by parameters */
  double axis_slope[PENDRES_PARAMETER_FOLLOWED];       /* of the axis, within the border's plane */
  int gradual; /* of the end of a piece: what follows begins there as it ends */
  double start_slope[2], time_slope; /* of decays: of the displacement, by the state at their start,
                                        and by the logarithm of the time */
} fit_lane;

/* A fold, or where the lag is a quarter turn: where that lies on its curve, and its orbit. */
typedef struct fit_fold {
  size_t after; /* between this node and the next */
  double part;  /* at this share of the arc */
  double tangent[FIT_PLACES];
  pendres_u u;
  size_t lane;
} fit_fold;

/* A piece of a curve along which the axis goes one way: nodes first to last, and a fold before and
   behind it (-1: the curve ends). */
typedef struct fit_piece {
  size_t first, last;
  int way; /* of the axis, 1 or -1 */
  int stable;
  int fold[2];
  double low, high; /* of the axis */
  int state; /* of rotations the way that they turn, 0: at rest */
} fit_piece;

/* The orbits over the axis at one value of the other parameter. */
typedef struct fit_curve {
  double other; /* in the data's unit */
  double from, to, span; /* of the axis in the data's unit; the span is that of the margins */
  pendres_followed kind;
  size_t nodes;
  pendres_curve_node *node; /* [FIT_NODES] */
  int ready;                /* they are those of some values */
  int marked;               /* places on its axis are data, ... */
  int tuned;                /* ... of resonances among them */
  size_t folds, quarters, pieces;
  fit_fold fold[FIT_FOLDS], quarter[FIT_FOLDS];
  fit_piece piece[FIT_FOLDS + 1];
} fit_curve;

/* Data of one sweep at one value of the axis: numbers first to first + count of the order. */
typedef struct fit_station {
  double axis;
  size_t first, count;
  long lane[FIT_STAGES]; /* of the orbits on the stages; -1: none */
  int beyond[FIT_STAGES];
  int stage; /* on which the data are taken to be */
} fit_station;

/* A sweep one way over a curve. */
typedef struct fit_track {
  size_t curve;
  int direction;
  size_t first, count; /* stations, in the order of the sweep */
  int stages;
  int piece[FIT_STAGES];
} fit_track;

/* A place on the axis that is a datum: the fold at which a stage of its track ends, or where its
   curve lags by a quarter turn. */
typedef struct fit_mark {
  size_t track, datum;
  int stage; /* -1: of a resonance */
  size_t lane;
} fit_mark;

/* Whether an observable is such a place. */
static inline int pendres_fit_is_place(pendres_fit_observable o)
{
  return o == PENDRES_FIT_JUMP || o == PENDRES_FIT_RESONANCE;
}

/* Whether it is a scattering parameter. */
static inline int pendres_fit_is_line(pendres_fit_observable o)
{
  return o >= PENDRES_FIT_TRANSMISSION_REAL && o <= PENDRES_FIT_REFLECTION_IMAGINARY;
}

static inline pendres_line_kind pendres_fit_line_kind(pendres_fit_observable o)
{
  return (pendres_line_kind)((o - PENDRES_FIT_TRANSMISSION_REAL) / 2);
}

typedef struct fit_model {
  pendres_context *ctx;
  pendres_pendulum base; /* what is neither unknown nor varies */
  pendres_parameter axis, other;
  double unit[FIT_QUANTITIES], area; /* area: that of loop areas */
  size_t data;
  const pendres_fit_datum *datum;
  size_t *order;
  size_t curves, tracks, stations, marks;
  fit_curve *curve;
  fit_track *track;
  fit_station *station;
  fit_mark *mark;
  int decays;    /* the data are over time */
  int rotates;   /* they are mean velocities */
  int lines;     /* they are scattering parameters, ... */
  double middle; /* ... this is between their frequencies, ... */
  double narrow; /* ... and at the first values a resonance as wide, over its frequency */
  double clock;  /* the caller's unit of time over the canonical one, of velocities */
  size_t left;   /* data that do not count, next to where a rotation ends */
  size_t active; /* of these the stations that count */
  int measured[FIT_BASES];
  /* Parameters by which derivatives are wanted, and the blocks that give them. */
  int parameters, parameter[PENDRES_PARAMETER_FOLLOWED];
  pendres_flow_kind flow;
  size_t lanes, room;
  int usual_steps; /* a period, at the values that a start began with; 0: not known yet */
  fit_lane *lane;
  const char *lost; /* why the model could not be computed at the last values */
} fit_model;

/* The model cannot be computed at the last values, and why. */
static inline pendres_status pendres_fit_lose(fit_model *m, const char *why)
{
  m->lost = why;
  return PENDRES_NOT_CONVERGED;
}

/* Guesses from the data, and all that are tried: the caller's and those around it as well. */
enum { FIT_GUESSES = 16, FIT_TRIED = FIT_GUESSES + 1 + FIT_GUESS_AROUND };

/* ---- model.c: what values mean ---- */

/* Sort the data into curves, tracks and stations. */
pendres_status pendres_fit_model_begin(fit_model *m, pendres_room *room,
                                       const pendres_fit_data *data);

/* The axis' or the other parameter's value in canonical units, and back. */
double pendres_fit_in(const fit_model *m, pendres_parameter p, const fit_values v, double raw);
double pendres_fit_out(const fit_model *m, pendres_parameter p, const fit_values v, double value);

/* The square of the frequency at an amplitude, by the balance of the first harmonic. */
double pendres_fit_stiffness(const fit_model *m, const fit_values v, double amplitude);

/* The point of a curve's pendulum at a value of the axis, without its state. */
void pendres_fit_point_at(const fit_model *m, const fit_curve *c, const fit_values v, double axis,
                          pendres_u u);

/* Value of an observable at a lane, and its derivatives by the quantities. bound: the axis is not
   free, so that it moves with its scale. */
double pendres_fit_observe(const fit_model *m, const fit_values v, const fit_lane *l,
                           pendres_fit_observable o, int bound, fit_values slope);

/* Value of the axis at a fold, or of a tuned lane, in the data's unit, and its derivatives. */
double pendres_fit_place_at(const fit_model *m, const fit_values v, const fit_lane *l,
                            fit_values slope);

/* ---- lines.c ---- */

/* The damping that follows from quality factors, of lines; or is a value itself. */
double pendres_fit_damping(const fit_model *m, const fit_values v);

/* A scattering parameter at a lane, and its derivatives: by the parameters, and by other
   quantities. */
double pendres_fit_line_at(const fit_model *m, const fit_values v, const fit_lane *l,
                           pendres_fit_observable o, double by[PENDRES_PARAMETER_FOLLOWED],
                           fit_values slope);

/* Derivatives by quality factors, from those by parameters. */
void pendres_fit_by_q(const fit_model *m, const fit_values v,
                      const double by[PENDRES_PARAMETER_FOLLOWED], fit_values slope);

/* Values to begin with, of lines; how many there are; -1: out of memory. */
int pendres_fit_line_guess(const fit_model *m, const fit_values v, fit_values out[FIT_GUESSES]);

/* ---- curves.c ---- */

/* Bring all curves to these values; PENDRES_NOT_CONVERGED, with m->lost, where that fails. */
pendres_status pendres_fit_curves(fit_model *m, const fit_values v);

/* A point of a piece at a value of the axis. */
void pendres_fit_between(const fit_model *m, const fit_curve *c, const fit_piece *piece,
                         double axis, pendres_u u);

/* Place of the axis in points. */
static inline int pendres_fit_place(const fit_model *m)
{
  return PENDRES_U_OMEGA + (int)m->axis;
}

/* ---- orbits.c ---- */

/* Samples of a block: row r of lane i at step k is at[(k rows + r) lanes + i], 0 <= k <= steps. */
typedef struct fit_samples {
  size_t steps, rows, lanes;
  double *at;
} fit_samples;

static inline double pendres_fit_sample(const fit_samples *s, size_t lane, size_t k, int row)
{
  return s->at[(k * s->rows + (size_t)row) * s->lanes + lane];
}

/* A period of n pendulums with these parameters and states. */
pendres_status pendres_fit_sample_period(const fit_model *m, int steps, size_t n,
                                         fit_lane *const *lanes, fit_samples *s);

/* Find and measure n orbits with these steps a period; those that fail are not found. */
pendres_status pendres_fit_orbits(const fit_model *m, int steps, size_t n, fit_lane *lanes);

/* ---- places.c ---- */

/* Put where curves lag by a quarter turn among the lanes, if that was measured. */
pendres_status pendres_fit_quarters(fit_model *m, const fit_values v, int steps);

/* Which fold of its track, or which resonance of its curve, each mark is: the nearest. 0: there is
   none. */
int pendres_fit_find_marks(fit_model *m, const fit_values v);

/* ---- stages.c ---- */

/* What residuals are made with. */
typedef struct fit_terms {
  const double *error; /* [data] */
  double jump_error, huber;
} fit_terms;

/* Residuals in units of the errors, and their derivatives by the quantities: a row each datum, then
   FIT_STAGES - 1 rows each track for its jumps. */
typedef struct fit_rows {
  size_t rows;
  double *residual;
  fit_values *slope;
  int *used; /* [jumps] 1: the data jump between two of them, 2: beyond them */
  signed char (*from)[FIT_STAGES]; /* [data + 1] for the assignment */
} fit_rows;

static inline size_t pendres_fit_rows(const fit_model *m)
{
  return m->data + m->tracks * (FIT_STAGES - 1);
}

/* The stages of all tracks, and orbits at all stations. */
pendres_status pendres_fit_stages(fit_model *m, const fit_values v);

/* The lane of the fold at which a stage of a track ends; NULL: it has none. */
const fit_lane *pendres_fit_fold_lane(const fit_model *m, const fit_track *t, int stage);

/* Decide on which stages data are, and make the residuals; raw ones, without Huber's loss. */
void pendres_fit_residuals(fit_model *m, const fit_values v, const fit_terms *t, fit_rows *rows);

/* ---- decay.c ---- */

/* The motion at all stations that count. */
pendres_status pendres_fit_decay(fit_model *m, const fit_values v);

/* ---- rotations.c ---- */

/* The pieces over the torque of rest and rotations. */
pendres_status pendres_fit_rotation_curves(fit_model *m, const fit_values v);

/* Mean velocities of all lanes. */
void pendres_fit_rotations(fit_model *m);

/* Values to begin with; how many there are. */
int pendres_fit_rotation_guess(const fit_model *m, const fit_values v, fit_values out[FIT_GUESSES]);

#endif
