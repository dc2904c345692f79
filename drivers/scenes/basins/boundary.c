/* boundary.c -- the boundary of basins as a curve; see basins.h. */
#include "scenes/basins/basins.h"

#include <pendres/boundary.h>

/* A point of the curve. */
typedef struct row {
  double x, x_error, v, v_error;
  int piece;
} row;

static const scene_column columns[] = {
  SCENE_COLUMN(row, x, "position on the boundary of basins"),
  SCENE_COLUMN(row, v, "velocity on the boundary of basins"),
  SCENE_COLUMN_OF(SCENE_NUMBER, row, piece, "piece of the boundary that the point belongs to"),
};

static void put_boundary(scene_run *run, const pendres_boundary *curve)
{
  static const scene_column whole = {.name = "complete", .type = SCENE_COUNT,
                                     .long_name = "1: all of the boundary within the window"};
  const size_t n = curve->count;
  const size_t complete = (size_t)curve->complete;
  /* The error of v is that of x divided by the unit of time. */
  const double time = deck_pendulum_units(run->deck).time;
  row *rows = scene_array(run, n, sizeof *rows);
  const scene_table points = {.dimensions = {"boundary_point"}, .prefix = "boundary",
                              SCENE_ROWS(rows, n)};
  const scene_table all = {.prefix = "boundary", SCENE_ROWS(&complete, 1)};
  for (size_t i = 0; rows != NULL && i < n; i++) {
    const double error = curve->error[i];
    rows[i] = (row){curve->x[i], error, curve->v[i], error / time,
                    (int)curve->piece[i]};
  }
  scene_numbering(run, "boundary_point", n, "point of the boundary, in order along it");
  SCENE_WRITE(run, &points, columns);
  scene_columns_write(run, &all, 1, &whole);
}

void basins_write_boundary(basins *b)
{
  const deck_axis *x = &b->d->axis[DECK_AXIS_X], *v = &b->d->axis[DECK_AXIS_V];
  const pendres_boundary_options window = {.x_low = x->value[0], .x_high = x->value[x->count - 1],
                                           .v_low = v->value[0], .v_high = v->value[v->count - 1]};
  pendres_boundary *curve = NULL;
  pendres_orbit saddle;
  pendres_context *ctx = scene_context(b->run);
  const pendres_attractor *first = pendres_attractors_get(b->set, 0);
  if (ctx == NULL) return;
  b->curve = "none: the first attractor has no unstable orbit beside it on its branch";
  if (first == NULL || first->orbit.period != 1 || first->orbit.winding != 0) return;
  pendres_status status = pendres_saddle_find(ctx, &first->orbit, &saddle);
  if (status == PENDRES_NOT_FOUND) return; /* nothing beside it on its branch */
  if (status == PENDRES_OK) status = pendres_boundary_find(ctx, &saddle, &window, &curve);
  if (scene_asked(b->run, status) == PENDRES_OK) {
    b->curve = curve->complete ? "all of it" : "a part, it goes on";
    put_boundary(b->run, curve);
  }
  pendres_boundary_free(curve);
}
