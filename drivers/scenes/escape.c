/*
 * escape.c -- the least action with which noise carries a pendulum out of a state, over at most two
 * parameters; at one point the path, and all ways out.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/numbers.h"
#include "scenes/points.h"

enum {
  AXES = 2,
  WAYS = 8,    /* of a record */
  PATH = 4001, /* points of its path, at most */
  TABLE_ROWS = 24
};

/* A way out, as far as it is written. */
typedef struct row {
  double action, action_error, saddle_x, saddle_x_error, saddle_v, saddle_v_error;
  int escape, escape_to, escape_well, saddle_period, ways, paths;
} row;

static const row none = {NAN, NAN, NAN, NAN, NAN, NAN, .escape = PENDRES_LABEL_UNRESOLVED};

typedef struct point {
  double drive_phase, x, v, momentum_x, momentum_v, noise;
} point;

/* The record of a deck without axes: all ways, and the path of the first. */
typedef struct whole {
  row way[WAYS];
  point path[PATH];
  int ways, points;
} whole;

typedef struct work {
  const deck *d;
  pendres_sweep sweep;
  int axes;
  scene_points points; /* of rows or, without axes, of one whole */
} work;

/* ---- computing ----------------------------------------------------------------------------- */

/* The number of the state in its set; -1: there is none. */
static pendres_status choose(const scene_some *some, const pendres_attractors *set, int *from)
{
  const deck *d = ((const work *)some->of->arg)->d;
  const char *name = d->orbit.start;
  pendres_settled at = {.attractor = -1};
  int state[2];
  if (name[0] == '\0') {
    const pendres_status status =
      pendres_attractors_settle(some->ctx, set, 1, &d->orbit.x, &d->orbit.v, &at);
    *from = at.attractor;
    return status;
  }
  pendres_switching_states(set, state);
  *from = strcmp(name, "sa") == 0   ? state[0]
          : strcmp(name, "la") == 0 ? state[1]
                                    : (int)strtol(name, NULL, 10) - 1;
  if (*from >= (int)pendres_attractors_count(set)) *from = -1;
  return PENDRES_OK;
}

static row row_of(const pendres_escapes *ways, size_t k)
{
  const pendres_escape *w = pendres_escapes_get(ways, k);
  return (row){.action = w->action, .action_error = w->action_error, .saddle_x = w->saddle_x,
               .saddle_x_error = w->saddle.x_error, .saddle_v = w->saddle.v,
               .saddle_v_error = w->saddle.v_error, .escape = (int)w->label,
               .escape_to = w->attractor >= 0 ? w->attractor + 1 : 0,
               .escape_well = (int)w->well, .saddle_period = w->saddle.period,
               .ways = (int)pendres_escapes_count(ways), .paths = (int)w->paths};
}

/* The ways out at a point; NULL, and a mark, where there are none. */
static pendres_status find(const scene_some *some, size_t i, pendres_escapes **ways)
{
  const work *w = some->of->arg;
  const pendres_pendulum p = pendres_sweep_pendulum(&w->sweep, some->first + i, NULL, NULL);
  pendres_attractors *set = NULL;
  int from = -1;
  *ways = NULL;
  pendres_status status = pendres_attractors_find(some->ctx, &p, 0, NULL, NULL, &set);
  if (status == PENDRES_OK) status = choose(some, set, &from);
  if (status == PENDRES_OK && from < 0)
    scene_mark(some, i, SCENE_FAILURE_NOT_FOUND, "there is no such state to leave");
  else if (status == PENDRES_OK)
    status = pendres_escapes_find(some->ctx, set, (size_t)from, ways);
  if (status != PENDRES_OK) {
    const scene_failure reason = status == PENDRES_INVALID_ARGUMENT ? SCENE_FAILURE_REFUSED
                                                                    : scene_failure_of(status);
    if (reason != SCENE_FAILURE_NONE) {
      scene_mark(some, i, reason, pendres_context_message(some->ctx));
      status = PENDRES_OK;
    }
  }
  pendres_attractors_free(set);
  return status;
}

static pendres_status compute(const scene_some *some)
{
  row *rows = some->rows;
  pendres_status status = PENDRES_OK;
  for (size_t i = 0; i < some->n && status == PENDRES_OK; i++) {
    pendres_escapes *ways;
    status = find(some, i, &ways);
    rows[i] = ways != NULL ? row_of(ways, 0) : none;
    pendres_escapes_free(ways);
  }
  return status;
}

/* Of one point all ways, and the path. */
static pendres_status compute_whole(const scene_some *some)
{
  whole *out = some->rows;
  pendres_escapes *ways;
  const pendres_status status = find(some, 0, &ways);
  memset(out, 0, sizeof *out);
  out->ways = (int)pendres_escapes_count(ways);
  for (int k = 0; k < out->ways && k < WAYS; k++) out->way[k] = row_of(ways, (size_t)k);
  const pendres_escape *w = pendres_escapes_get(ways, 0);
  if (w != NULL) {
    const size_t each = (w->points + PATH - 1) / PATH;
    for (size_t k = 0; k < w->points; k += each)
      out->path[out->points++] = (point){w->phase[k], w->x[k], w->v[k], w->momentum_x[k],
                                         w->momentum_v[k], w->noise[k]};
  }
  pendres_escapes_free(ways);
  return status;
}

static int check_whole(const scene_points *p, const void *row)
{
  const whole *w = row;
  (void)p;
  return scene_check_code(w->ways, WAYS + 1) && scene_check_code(w->points, PATH + 1);
}

/* ---- writing ------------------------------------------------------------------------------- */

static const scene_column columns[] = {
  SCENE_COLUMN(row, action, NULL),
  SCENE_CODE(row, escape, "kind of motion that the path leads to", scene_motion_names),
  {SCENE_TYPED(SCENE_NUMBER, "escape_to", row, escape_to,
               "attractor that the path leads to, by amplitude from 1 on; 0: none")},
  {SCENE_TYPED(SCENE_NUMBER, "escape_well", row, escape_well,
               "well that it leads to, from that of the state on")},
  {SCENE_AS("saddle_x", row, saddle_x, "position of the saddle orbit at drive phase 0", "x")},
  {SCENE_AS("saddle_v", row, saddle_v, "velocity of the saddle orbit at drive phase 0", "v")},
  {SCENE_TYPED(SCENE_NUMBER, "saddle_period", row, saddle_period,
               "drive periods until the saddle orbit closes")},
  {SCENE_TYPED(SCENE_NUMBER, "paths", row, paths, "different paths found over this saddle")},
};

static const scene_column path_columns[] = {
  {SCENE_TYPED(SCENE_PLAIN, "path_phase", point, drive_phase, "drive phase along the path"),
   .quantity = "drive_phase"},
  {SCENE_TYPED(SCENE_PLAIN, "path_x", point, x, "position along the path"), .quantity = "x"},
  {SCENE_TYPED(SCENE_PLAIN, "path_v", point, v, "velocity along the path"), .quantity = "v"},
  {SCENE_TYPED(SCENE_PLAIN, "path_momentum_x", point, momentum_x,
               "momentum of x along the path, dS/dx, a unit of mass"), .quantity = "drive"},
  {SCENE_TYPED(SCENE_PLAIN, "path_momentum", point, momentum_v,
               "momentum of v along the path, dS/dv, a unit of mass"), .quantity = "v"},
  {SCENE_TYPED(SCENE_PLAIN, "path_noise", point, noise,
               "force of the noise along the path, 2 damping path_momentum"), .quantity = "drive"},
};

static const scene_cell cells[] = {
  SCENE_CELL(row, action, "              action", "%20.12g"),
  SCENE_CELL(row, action_error, "      error", " %10.1e"),
  SCENE_CELL(row, saddle_x, "     saddle x", " %12.7g"),
  SCENE_CELL(row, saddle_v, "            v", " %12.7g"),
};

/* All ways of one point, and its path. */
static void write_whole(scene_run *run, const work *w)
{
  const whole *all = w->points.rows;
  const size_t ways = (size_t)all->ways, points = (size_t)all->points;
  if (ways == 0) return;
  const scene_table table = {.dimensions = {"way"}, SCENE_ROWS(all->way, ways)};
  const scene_table path = {.dimensions = {"path"}, SCENE_ROWS(all->path, points)};
  scene_numbering(run, "way", ways, "way out of the state, that of the least action first");
  scene_numbering(run, "path", points, "point of the path of least action, from the state on");
  SCENE_WRITE(run, &table, columns);
  SCENE_WRITE(run, &path, path_columns);
  if (!scene_prints(run)) return;
  SCENE_PRINT(run->table, &table, TABLE_ROWS, cells, NULL);
  for (size_t k = 0; k < ways; k++) {
    const row *r = &all->way[k];
    fprintf(run->table, "way %zu leads to ", k + 1);
    if (r->escape_to > 0)
      fprintf(run->table, "attractor %d, well %d\n", r->escape_to, r->escape_well);
    else fprintf(run->table, "what is %s\n", scene_motion_names(r->escape));
  }
}

/* The points, or the first of them. */
static void tabulate(scene_run *run, const work *w)
{
  const scene_points *p = &w->points;
  const row *rows = p->rows;
  for (size_t k = 0; k < p->n && k < TABLE_ROWS; k++) {
    char name[SCENE_TOLD];
    scene_point_name(w->d, k, p->axes, p->axis, name, sizeof name);
    fprintf(run->table, "%-32s %20.12g %9.1e  %s %d\n", name, rows[k].action,
            rows[k].action_error, scene_motion_names(rows[k].escape), rows[k].escape_to);
  }
  if (p->n > TABLE_ROWS) fprintf(run->table, "... and %zu more\n", p->n - TABLE_ROWS);
}

/* ---- the scene ----------------------------------------------------------------------------- */

static pendres_status run_scene(scene_run *run)
{
  deck_axis_id axis[DECK_AXES];
  work w = {.d = run->deck, .sweep = scene_sweep(run->deck), .axes = deck_axes(run->deck, axis)};
  scene_points *p = &w.points;
  *p = w.axes > 0 ? (scene_points){.size = sizeof(row), .compute = compute, .none = &none,
                                   SCENE_COLUMNS(columns)}
                  : (scene_points){.size = sizeof(whole), .compute = compute_whole,
                                   .check = check_whole};
  p->chunk = 1;
  p->arg = &w;
  p->what = "the least action";
  scene_points_over(p, run->deck, w.axes, axis);
  SCENE_COMPUTE(run, p, "least actions", .last = 1);
  for (int i = 0; i < w.axes; i++) scene_dimension(run, NULL, axis[i]);
  if (w.axes > 0) scene_points_write(run, p);
  else write_whole(run, &w);
  scene_points_write_failed(run, p, "failed", "why there is no least action");
  if (w.axes > 0 && scene_prints(run)) tabulate(run, &w);
  return run->status;
}

static void describe(const deck *d, FILE *out)
{
  deck_axis_id axis[DECK_AXES];
  size_t n = 1;
  const int axes = deck_axes(d, axis);
  for (int i = 0; i < axes; i++) n *= d->axis[axis[i]].count;
  fprintf(out, "least action out of ");
  if (d->orbit.start[0] != '\0') fprintf(out, "attractor '%s'", d->orbit.start);
  else fprintf(out, "what x = %g, v = %g settles on", d->orbit.x, d->orbit.v);
  fprintf(out, ", at %zu points\n", n);
}

const scene_kind scene_escape = {
  .kind = DECK_ESCAPE,
  .references = "; M. I. Freidlin and A. D. Wentzell, Random Perturbations of Dynamical Systems "
                "(1984); S. Beri et al., Physical Review E 72 (2005) 036131",
  .budget = 1,
  .size = {.head = 40e3, .point = 100.0, .memory = 1e6, .stages = 1.0, .after = 1.0,
           .seconds = 0.5},
  .describe = describe,
  .run = run_scene,
};
