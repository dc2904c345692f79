/* scene_lines.c -- lines of points and their branches; see scene_lines.h. */
#include "scene_lines.h"

#include <stdlib.h>

enum { MOST_ROUNDS = 4 }; /* of following curves, see below */

static pendres_status compute(void *arg, size_t task, pendres_context *ctx)
{
  scene_lines *l = arg;
  scene_line *line = &l->line[task];
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  pendres_pendulum *p = calloc(l->drives, sizeof *p);
  line->points = calloc(l->drives, sizeof *line->points);
  if (p == NULL || line->points == NULL) goto done;
  for (size_t k = 0; k < l->drives; k++)
    p[k] = pendres_sweep_pendulum(&l->sweep, task * l->drives + k, NULL, NULL);
  status = pendres_phase_line(ctx, l->drives, p, &l->ensemble, l->spacing, line->points,
                              &line->branches);
done:
  free(p);
  return status;
}

static pendres_status complete(void *arg, size_t task, pendres_context *ctx)
{
  scene_lines *l = arg;
  const scene_line *line = &l->line[task];
  return pendres_phase_line_complete(ctx, l->drives, l->curves.curves, &l->ensemble, l->spacing,
                                     line->points, line->branches);
}

/* The bifurcations of all lines. */
static pendres_status gather(scene_lines *l)
{
  l->curves.count = 0;
  for (size_t i = 0; i < l->dampings; i++)
    if (scene_curves_add(&l->curves, l->line[i].branches) != PENDRES_OK)
      return scene_fail(l->run, PENDRES_OUT_OF_MEMORY, "out of memory for bifurcations");
  return PENDRES_OK;
}

/*
 * Curves through the lines' bifurcations show branches that some lines have missed, whose own
 * bifurcations may lie on further curves; mostly the first round has shown all.
 */
static pendres_status follow_curves(scene_lines *l)
{
  pendres_status status = gather(l);
  size_t before = 0;
  for (int i = 0; i < MOST_ROUNDS && status == PENDRES_OK && l->curves.count > before; i++) {
    before = l->curves.count;
    status = scene_curves_follow(l->run, &l->curves);
    if (status != PENDRES_OK) return status;
    status = farm_run(l->run->farm, "lines", l->dampings, complete, NULL, l);
    if (status != PENDRES_OK) return scene_farm_failed(l->run, status);
    status = gather(l);
  }
  return status;
}

pendres_status scene_lines_compute(scene_run *run, scene_lines *l)
{
  const deck *d = run->deck;
  l->run = run;
  l->sweep = scene_sweep(d);
  l->ensemble = scene_ensemble(d);
  l->dampings = d->axis[DECK_AXIS_DAMPING].count;
  l->drives = d->axis[DECK_AXIS_DRIVE_FREQUENCY].count;
  l->line = calloc(l->dampings, sizeof *l->line);
  if (l->line == NULL)
    return scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu lines", l->dampings);
  pendres_status status = farm_run(run->farm, "dampings", l->dampings, compute, NULL, l);
  if (status != PENDRES_OK) return scene_farm_failed(run, status);
  for (size_t i = 0; i < l->dampings; i++)
    for (size_t k = 0; k < l->drives; k++)
      run->failed_points += l->line[i].points[k].unresolved > 0;
  return follow_curves(l);
}

void scene_lines_free(scene_lines *l)
{
  for (size_t i = 0; i < l->dampings && l->line != NULL; i++) {
    free(l->line[i].points);
    pendres_branches_free(l->line[i].branches);
  }
  free(l->line);
  scene_curves_free(&l->curves);
}

void scene_lines_print_cusp(const scene_lines *l, FILE *out)
{
  const pendres_cusp *c = &l->curves.cusp;
  if (l->curves.has_cusp)
    fprintf(out, "cusp: damping %.12f +- %.0e, drive frequency %.12f +- %.0e\n", c->value[1],
            c->value_error[1], c->value[0], c->value_error[0]);
}
