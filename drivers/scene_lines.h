/*
 * scene_lines.h -- points over damping and drive frequency, a line a damping, with the branches
 * that they lie on: what phase_diagram and branches both compute.
 *
 * Owns: the lines, one task each, the curves of bifurcations through all of them, and what these
 * tell each line in turn.
 */
#ifndef SCENE_LINES_H
#define SCENE_LINES_H

#include "scene_curves.h"

typedef struct scene_line {
  pendres_phase_point *points; /* [drive] */
  pendres_branches *branches;
} scene_line;

typedef struct scene_lines {
  scene_run *run;
  pendres_sweep sweep; /* damping, drive frequency */
  pendres_ensemble ensemble;
  double spacing;      /* of the points of branches, see phase_diagram.h */
  size_t dampings, drives;
  scene_line *line;    /* [damping] */
  scene_curves curves;
} scene_lines;

/* Compute all lines, follow the curves and complete the lines by them. l holds spacing; free it in
   any case. */
pendres_status scene_lines_compute(scene_run *run, scene_lines *l);

void scene_lines_free(scene_lines *l);

/* Point number i = damping * drives + drive. */
static inline const pendres_phase_point *scene_lines_point(const scene_lines *l, size_t i)
{
  return &l->line[i / l->drives].points[i % l->drives];
}

/* A line of the short table on the cusp, if there is one. */
void scene_lines_print_cusp(const scene_lines *l, FILE *out);

#endif
