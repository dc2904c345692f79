/*
 * gap.h -- what may happen between two neighbouring frequencies of a search.
 *
 * Owns: which states continue from one to the other, which members change their state, and how
 * large the mean loop area can be in between.
 */
#ifndef PENDRES_RESONANCE_GAP_H
#define PENDRES_RESONANCE_GAP_H

#include "analysis/resonance/search.h"

typedef enum pendres_gap_kind {
  PENDRES_GAP_PLAIN, /* the members keep their states, and the mean rises or falls */
  PENDRES_GAP_PEAK,  /* they keep them, and it first rises and then falls */
  PENDRES_GAP_JUMP   /* a state appears or ends, or a member changes its state */
} pendres_gap_kind;

typedef struct pendres_gap {
  pendres_gap_kind kind;
  double width;
  double bound;  /* no mean area within exceeds this */
  int loose;     /* the bound allows for members near a basin boundary that appear to keep their
                    states */
  int mixed;     /* members change to larger areas and to smaller ones */
} pendres_gap;

/* The gap between two neighbours, `members` on each. */
void pendres_gap_look(const pendres_scan_point *a, const pendres_scan_point *b, size_t members,
                      pendres_gap *out);

#endif
