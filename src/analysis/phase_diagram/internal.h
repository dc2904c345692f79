/*
 * internal.h -- what a phase diagram holds: phase_diagram.c has its lines and points, curves.c its
 * curves, record.c the results of a line and their form as plain bytes.
 */
#ifndef PENDRES_PHASE_INTERNAL_H
#define PENDRES_PHASE_INTERNAL_H

#include <stdint.h>

#include <pendres/phase_diagram.h>

#include "base/bytes.h"

/* The place of a point that has no results. */
#define PENDRES_PHASE_NOWHERE SIZE_MAX

/* What became of a point. */
typedef struct pendres_phase_mark {
  pendres_status outcome;
  char *message; /* NULL: none */
} pendres_phase_mark;

/* PENDRES_OUT_OF_MEMORY, or PENDRES_OK; the message is copied. */
pendres_status pendres_phase_mark_set(pendres_phase_mark *mark, pendres_status outcome,
                                      const char *message);
void pendres_phase_mark_free(pendres_phase_mark *mark);
void pendres_phase_mark_pass(pendres_bytes *bytes, pendres_phase_mark *mark);

typedef struct pendres_phase_done {
  size_t values;               /* points of the line */
  size_t count;                /* those that have results */
  pendres_phase_point *points; /* [values], the first `count` set */
  size_t *place;               /* [values] its index in points */
  pendres_phase_mark *mark;    /* [values] */
  pendres_branches *branches;
} pendres_phase_done;

/* A line without results. Free it in any case. */
pendres_status pendres_phase_done_create(size_t values, pendres_phase_done *out);
void pendres_phase_done_free(pendres_phase_done *line);

/* Pass a line as plain bytes; reading it sets one without results. */
void pendres_phase_done_pass(pendres_bytes *bytes, pendres_phase_done *line);

/* Read a line. PENDRES_INVALID_ARGUMENT: this is none with so many values. On failure there is
   nothing to be freed. */
pendres_status pendres_phase_done_read(size_t values, pendres_bytes *bytes,
                                       pendres_phase_done *out);

/* What was followed of a family of bifurcations; all NULL and zero before. */
typedef struct pendres_phase_family {
  size_t first;            /* the first bifurcation of the family */
  pendres_curves *curves;  /* NULL: not taken yet */
  size_t end;              /* the bifurcation that `mark` is about */
  pendres_phase_mark mark; /* why it was not continued */
} pendres_phase_family;

struct pendres_phase_diagram {
  pendres_phase_grid grid;
  pendres_phase_round round;   /* the present one; no tasks: before the first, or all is done */
  int begun;
  pendres_phase_done *line;    /* [lines] */
  pendres_phase_point nothing; /* is given for a point that has no results */
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
  int falling;                 /* SA ends as the lines' parameter falls, see label.h */
};

/* Whether a failure is caused by the parameters, and not by the machine or the caller: the rest of
   the diagram is then computed nevertheless. */
int pendres_phase_is_own(pendres_status status);

/* Gather the bifurcations of all lines. *families receives how many families they form, 0 if there
   is no new one, or all rounds are done. */
pendres_status pendres_phase_find_families(pendres_phase_diagram *d, size_t *families);

/* Follow the curves through the bifurcations of a family, as far as they are not known. */
pendres_status pendres_phase_follow_family(pendres_context *ctx, const pendres_phase_diagram *d,
                                           size_t family, pendres_bytes *out);

/* Take over what was followed of a family; with the last of them the diagram has the curves. */
pendres_status pendres_phase_take_family(pendres_phase_diagram *d, size_t family, size_t size,
                                         const void *bytes);

/* Free what the curves hold of a diagram. */
void pendres_phase_curves_free(pendres_phase_diagram *diagram);

#endif
