/*
 * along.h -- what scenes share in which parameters of the pendulum move.
 *
 * Owns: the pendulum whose parameters stand still, those that move, and the attractor that a start
 * names.
 */
#ifndef SCENE_ALONG_H
#define SCENE_ALONG_H

#include "results/columns.h"
#include "results/failed.h"
#include "scenes/points.h"

/*
 * The attractor that a deck's `start` names at some parameters: "sa", "la", or its number from 1
 * on; of a chaotic one orbit.x and orbit.v are a point on it. PENDRES_NOT_FOUND if there is none;
 * why[size] then says what there is.
 */
pendres_status scene_along_named(pendres_context *ctx, const pendres_pendulum *p, const char *start,
                                 pendres_attractor *out, char *why, size_t size);

/* A path and what was met on it, in arrays of the run. */
typedef struct scene_along_path {
  deck_axis_id axis; /* of what moves */
  size_t points, jumps, steps;
  pendres_hysteresis_point *point; /* [points] in the order of the path */
  pendres_jump *jump;              /* [jumps] */
  pendres_step *step;              /* [steps] */
} scene_along_path;

/* Values of an axis in the order in which they are followed. */
typedef struct scene_along_way {
  deck_axis_id axis;
  size_t n;
  const double *value;
  int states_only; /* jumps are not asked for */
} scene_along_way;

/* The state that the deck's pendulum starts from along a way; message[SCENE_MESSAGE] says why there
   is none. */
pendres_status scene_along_start(const deck *d, const scene_along_way *way, pendres_context *ctx,
                                 char *message, pendres_state *out);

/* Follow the deck's pendulum from its start along a way, in a task; the path is the run's. The
   budget is of all values together: where it ends the path, the rest of it stays unresolved. What
   does not depend on the path is computed meanwhile: points of so many kinds. */
void scene_along_compute(scene_run *run, const scene_along_way *way, scene_along_path *path,
                         size_t beside, scene_points *const *points);

/* Whether a point is on a closed orbit. */
int scene_along_closed(const pendres_hysteresis_point *point);

/* A point as a row of results, and columns of what it and its attractor and orbit have. */
typedef struct scene_along_row {
  pendres_hysteresis_point of;
  double period, period_error, winding, winding_error; /* NaN unless the orbit closes */
  int uncertain, failed;                               /* a scene_failure */
} scene_along_row;

/* What ends a state, as a row of results. */
typedef struct scene_along_jump {
  double parameter, parameter_error, period, period_error; /* period: of the orbit jumped to; NaN */
  double share, share_error;                               /* of trials: the binomial error */
  double winding, winding_error, mean_velocity, mean_velocity_error; /* of that orbit, too */
  int direction, kind, from, to, gradual, certain, to_period;
} scene_along_jump;

/* All points of a path as rows; see scene_array(). */
scene_along_row *scene_along_rows(scene_run *run, const scene_along_path *path);

/* Write the jumps of a path as a table of scene_along_jump over a dimension `what`, which is before
   all names, too. SCENE_ALONG_WRITE_JUMPS writes the columns of an array. */
void scene_along_write_jumps(scene_run *run, const scene_along_path *path, const char *what,
                             size_t count, const scene_column *columns);

/* The mean velocity of an orbit that closes after some turns in some drive periods, at a value of
   what moves; and how well that is known. */
double scene_along_velocity(const deck *d, deck_axis_id axis, double value, int winding,
                            int period);
double scene_along_velocity_error(deck_axis_id axis, double velocity, double value, double error);

/* Whether the deck's coordinate has a period, so that pendulums turn over. */
int scene_along_turns(const deck *d);
#define SCENE_ALONG_WRITE_JUMPS(run, path, what, columns) \
  scene_along_write_jumps(run, path, what, sizeof columns / sizeof *columns, columns)

/* Whether errors of the integration may have chosen the state that the path begins on. */
int scene_along_uncertain(const scene_along_path *path);

/* Write columns of a table of scene_along_row: `label`, `failed` and, if it is, `uncertain`. */
void scene_along_write_verdicts(scene_run *run, const scene_along_path *path,
                                const scene_table *table);

/* Count the points that failed, and tell the first of them. If there are two ways, points of the
   way back are in the order of the axis, too. */
void scene_along_tell(scene_run *run, deck_axis_id axis, const scene_along_path *path, int ways);

enum { SCENE_DIRECTIONS = 2 /* of a path that goes up and then down */ };

/* ---- ramp.c: the parameter of scene hysteresis moved in real time, up and then down ---- */

/* All of it, where the deck asks for a ramp; the dimensions `direction` and `jump` exist. The path
   was followed up and down, and the points of the way back are in the order of the axis. */
void scene_ramp_run(scene_run *run, deck_axis_id axis, const scene_along_path *path);

/* What is said of it before a run. */
void scene_ramp_describe(const deck *d, deck_axis_id axis, FILE *out);

#endif
