/*
 * internal.h -- what a phase diagram holds: phase_diagram.c has its lines and points,
 * curves.c its curves.
 */
#ifndef PENDRES_PHASE_INTERNAL_H
#define PENDRES_PHASE_INTERNAL_H

#include "analysis/phase_diagram/record.h"

/* What was followed of a family of bifurcations; all NULL and zero before. */
typedef struct pendres_phase_family {
  size_t first;            /* the first bifurcation of the family */
  pendres_curves *curves;  /* NULL: not taken yet */
  size_t end;              /* the bifurcation that `mark` is about */
  pendres_phase_mark mark; /* why it was not gone on with */
} pendres_phase_family;

struct pendres_phase_diagram {
  pendres_phase_grid grid;
  pendres_phase_done *line;    /* [lines] */
  pendres_phase_point nothing; /* what stands for a point that has no results */
  pendres_bifurcation *bifurcation; /* of all lines, in their order */
  size_t *first;               /* [lines + 1] the first bifurcation of each line */
  size_t bifurcations;
  int rounds;
  pendres_phase_family *family; /* of bifurcations whose curves are followed in this round */
  size_t families, families_taken;
  pendres_curves *curves;
  pendres_phase_mark curves_mark;
  pendres_cusp cusp;
  int has_cusp;
  int falling;                 /* SA ends as the lines' parameter falls, see small_end.h */
};

/* Whether a failure is caused by the parameters, and not by the machine or the caller: the rest of
   the diagram is then computed all the same. */
int pendres_phase_is_own(pendres_status status);

/* Free what the curves hold of a diagram. */
void pendres_phase_curves_free(pendres_phase_diagram *diagram);

#endif
