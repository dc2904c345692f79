/*
 * scene_curves.h -- what phase_diagram and branches both write of bifurcations.
 *
 * Owns: bifurcations gathered line by line, the curves through them, and their arrays.
 */
#ifndef SCENE_CURVES_H
#define SCENE_CURVES_H

#include <pendres/phase_diagram.h>

#include "scenes/scene.h"

typedef struct scene_curves {
  pendres_bifurcation *list; /* of all lines, in their order */
  size_t count, capacity;
  pendres_curves *curves;    /* through them, damping and drive frequency varied */
  pendres_cusp cusp;         /* where SA and LA become one */
  int has_cusp;
  int8_t failed;             /* a scene_failure: why some of the curves are missing */
} scene_curves;

void scene_curves_free(scene_curves *c);

/* Take the bifurcations of a line's branches over. */
pendres_status scene_curves_add(scene_curves *c, const pendres_branches *branches);

/* Follow the curves through all bifurcations, within and around the deck's axes, beside those that
   are known already; find the cusp. */
pendres_status scene_curves_follow(scene_run *run, scene_curves *c);

/* Write the dimensions `fold`, `flip` and `bifurcation` with their arrays, and the cusp. */
pendres_status scene_curves_write(scene_run *run, const scene_curves *c);

/* The fold of SA (la = 0) or LA (la = 1) at a damping of the deck; NULL if there is none. */
const pendres_bifurcation *scene_curves_fold(const scene_curves *c, double damping, int la);

/* What the paper prints on these, where the deck has it. */
pendres_status scene_curves_write_paper(scene_run *run, const scene_curves *c);

/* Write n values and their errors along a dimension. */
pendres_status scene_curves_put(scene_run *run, const char *dimension, const char *name,
                                const char *long_name, const char *units, const double *value,
                                const double *error, size_t n);

#endif
