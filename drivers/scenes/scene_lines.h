/*
 * scene_lines.h -- points over damping and drive frequency, a line a damping, with the branches
 * that they lie on: what phase_diagram and branches both compute.
 *
 * Owns: the lines, one task each, the curves of bifurcations through all of them, and what these
 * tell each line in turn.
 */
#ifndef SCENE_LINES_H
#define SCENE_LINES_H

#include "scenes/scene_curves.h"
#include "scenes/scene_failed.h"

typedef struct scene_line {
  size_t count;                /* drives that could be computed */
  pendres_phase_point *points; /* [count] */
  size_t *place;               /* [drive] where it stands in points; SIZE_MAX: it failed */
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
  scene_failures failed; /* [damping][drive] */
  pendres_phase_point nothing; /* what stands for a point that failed */
} scene_lines;

/* Compute all lines, follow the curves and complete the lines by them. l holds spacing; free it in
   any case. */
pendres_status scene_lines_compute(scene_run *run, scene_lines *l);

void scene_lines_free(scene_lines *l);

/* Point number i = damping * drives + drive. */
const pendres_phase_point *scene_lines_point(const scene_lines *l, size_t i);

/* Write which points failed, and how many members are uncertain: `failed`, `uncertain_members`. */
pendres_status scene_lines_write_doubtful(scene_run *run, const scene_lines *l);

/* Lines of the short table: the cusp, if there is one; what the branches' own bifurcations do not
   explain of them, if there is any. */
void scene_lines_print(const scene_lines *l, FILE *out);

/* Write `branch_doubts`: at how many points branches and bifurcations disagree. */
pendres_status scene_lines_write_doubts(const scene_lines *l);

#endif
