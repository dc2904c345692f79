/*
 * refine.h -- from a bracket to a resonance with its error.
 */
#ifndef PENDRES_RESONANCE_REFINE_H
#define PENDRES_RESONANCE_REFINE_H

#include <pendres/resonance.h>

#include "orbits/orbit_pair.h"

typedef enum pendres_gap_kind {
  PENDRES_GAP_PLAIN, /* the members keep their states, and the mean rises or falls */
  PENDRES_GAP_PEAK,  /* they keep them, and it first rises and then falls */
  PENDRES_GAP_JUMP   /* a state appears or ends, or a member changes its state */
} pendres_gap_kind;

/* What may happen between two neighbouring points. */
typedef struct pendres_gap {
  pendres_gap_kind kind;
  double width;
  double bound; /* no mean area within exceeds this */
  double around; /* nor this if members may also be on the states that they are on beside the gap;
                    the bound, unless that may exceed all that is known */
  int loose;    /* the bound allows for members near a basin boundary that appear to keep their
                   states */
  int changed;  /* members change their states */
  int mixed;    /* members change to larger areas and to smaller ones */
  size_t counted; /* members that make the bound */
} pendres_gap;

/* A frequency that was evaluated. */
typedef struct pendres_scan_point {
  pendres_response response; /* its states have their slopes by frequency */
  double slope;              /* d(mean loop area)/domega with the members' states held */
  int jump_to_next;          /* there is a jump before the next point, even if the states agree */
  int fold_sought;           /* the gap to the next point was already searched for a fold */
  int at_fold;               /* not 0: the point is at a fold, on the side without the state that
                                ends there, which exists at lower (-1) or higher (1) omega; or at
                                a kink, and belongs to what is on the other side */
  double fold, fold_error;   /* NaN, and the error of the frequency, at a kink */
  signed char *where;        /* the state that each member is on (response_parts.h); NULL: not asked
                                for */
  pendres_gap gap;           /* to the next point, ... */
  const signed char *next;   /* ... whose members these are; NULL: the gap has not been examined */
} pendres_scan_point;

static inline double pendres_scan_frequency(const pendres_scan_point *p)
{
  return p->response.pendulum.drive_frequency;
}

/* Responses with slopes of n pendulums; where[n * members] may be NULL, and is not kept. */
pendres_status pendres_scan_evaluate(pendres_context *ctx, size_t n,
                                     const pendres_pendulum *pendulums,
                                     const pendres_ensemble *ensemble, signed char *where,
                                     pendres_scan_point *out);

/* A point's states, with the same members, at a nearby frequency. coarser, which may be NULL,
   receives the coarser computations of all states that are orbits, in their order. */
pendres_status pendres_scan_follow(pendres_context *ctx, const pendres_scan_point *from,
                                   double omega, pendres_orbit_coarser *coarser,
                                   pendres_scan_point *to);

/* Set the resonance's frequency, area and response to those of a point. */
void pendres_resonance_take(pendres_resonance *r, const pendres_scan_point *at);

/* Add to its errors the change along the branch within the error of the frequency, by means of a
   nearby point `near`. */
void pendres_resonance_add_error(pendres_resonance *r, const pendres_scan_point *near);

/*
 * The zero of the slope between a (rising) and b (falling), with the ensemble on the same states
 * there. PENDRES_NOT_FOUND: there is none, so there is a jump.
 */
pendres_status pendres_resonance_refine_peak(pendres_context *ctx, const pendres_ensemble *ensemble,
                                             const pendres_scan_point *a,
                                             const pendres_scan_point *b, pendres_resonance *out);

/* A bifurcation that parts the states below it from those above, and the points at it. */
typedef struct pendres_scan_border {
  size_t points; /* 0: there is none, and nothing below */
  /* At a fold, which ends a state and makes a jump by that, the point without that state. At a
     kink, where a state loses its mirror symmetry, the mean area is continuous and its slope jumps:
     the point with the states on the lower side, and that with those on the upper one. */
  pendres_scan_point at[2];
  double beside; /* of a fold: a frequency on the side with the state, close by */
} pendres_scan_border;

/* The fold that ends a state between a and b, if one does. */
pendres_status pendres_resonance_find_fold(pendres_context *ctx, const pendres_ensemble *ensemble,
                                           const pendres_scan_point *a,
                                           const pendres_scan_point *b, pendres_scan_border *out);

/* The kink between a and b that follows from the states of both, if there is one. */
pendres_status pendres_resonance_find_kink(pendres_context *ctx, const pendres_scan_point *a,
                                           const pendres_scan_point *b, pendres_scan_border *out);

/* The resonance at a point at a fold or a kink. */
pendres_status pendres_resonance_at_fold(pendres_context *ctx, const pendres_scan_point *at,
                                         pendres_resonance *out);

/* The jump between a and b, by halving, and the larger of the values at it. */
pendres_status pendres_resonance_refine_edge(pendres_context *ctx, const pendres_ensemble *ensemble,
                                             const pendres_scan_point *a,
                                             const pendres_scan_point *b, pendres_resonance *out);

#endif
