/* basins_boundary.c -- the boundary of basins as a curve; see basins.h. */
#include "scenes/basins.h"

#include <stdlib.h>

#include <pendres/boundary.h>

static pendres_status put_boundary(scene_run *run, const pendres_boundary *curve)
{
  pendres_store *store = run->store;
  static const char *const names[] = {"boundary_x", "boundary_v"};
  static const char *const words[] = {"position on the boundary of basins",
                                      "velocity on the boundary of basins"};
  const size_t n = curve->count;
  /* That of v has the errors divided by the unit of time. */
  const double time = deck_pendulum_units(run->deck).time;
  double *error = malloc((n + 1) * sizeof *error);
  if (error == NULL) return PENDRES_OUT_OF_MEMORY;
  pendres_status status = scene_numbering(run, "boundary_point", n,
                                          "point of the boundary, in order along it");
  for (int k = 0; k < 2 && status == PENDRES_OK; k++) {
    const pendres_store_spec spec = {.name = names[k], .dimensions = {"boundary_point"},
                                     .long_name = words[k], .units = k == 0 ? "rad" : "1"};
    for (size_t i = 0; i < n; i++)
      error[i] = curve->error[i] / (k == 0 ? 1.0 : time);
    status = pendres_store_put(store, &spec, k == 0 ? curve->x : curve->v, error, n);
  }
  free(error);
  int32_t *piece = malloc((n + 1) * sizeof *piece);
  if (piece == NULL) return PENDRES_OUT_OF_MEMORY;
  for (size_t i = 0; i < n; i++) piece[i] = curve->piece[i];
  const pendres_store_spec spec = {.name = "boundary_piece", .dimensions = {"boundary_point"},
                                   .long_name = "piece of the boundary that the point belongs to",
                                   .type = PENDRES_STORE_INT32};
  if (status == PENDRES_OK) status = pendres_store_put(store, &spec, piece, NULL, n);
  free(piece);
  const pendres_store_spec whole = {.name = "boundary_complete",
                                    .long_name = "1: all of the boundary within the window",
                                    .type = PENDRES_STORE_INT64};
  const int64_t complete = curve->complete;
  return status == PENDRES_OK ? pendres_store_put(store, &whole, &complete, NULL, 1) : status;
}

pendres_status basins_write_boundary(basins *b)
{
  const deck_axis *x = &b->d->axis[DECK_AXIS_X], *v = &b->d->axis[DECK_AXIS_V];
  const pendres_boundary_options window = {.x_low = x->value[0], .x_high = x->value[x->count - 1],
                                           .v_low = v->value[0], .v_high = v->value[v->count - 1]};
  pendres_boundary *curve = NULL;
  pendres_orbit saddle;
  pendres_context *ctx = scene_context(b->run);
  const pendres_attractor *first = pendres_attractors_get(b->set, 0);
  if (ctx == NULL) return PENDRES_OUT_OF_MEMORY;
  b->curve = "none: the first attractor has no unstable orbit beside it on its branch";
  if (first == NULL || first->orbit.period != 1 || first->orbit.winding != 0) return PENDRES_OK;
  pendres_status status = pendres_saddle_find(ctx, &first->orbit, &saddle);
  if (status == PENDRES_NOT_FOUND) return PENDRES_OK; /* nothing beside it on its branch */
  if (status == PENDRES_OK) status = pendres_boundary_find(ctx, &saddle, &window, &curve);
  if (scene_asked(b->run, status) == PENDRES_OK) {
    b->curve = curve->complete ? "all of it" : "a part, it goes on";
    status = scene_stored(b->run, put_boundary(b->run, curve));
  }
  pendres_boundary_free(curve);
  return status;
}
