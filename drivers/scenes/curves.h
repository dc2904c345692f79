/*
 * curves.h -- what phase_diagram and branches both write of bifurcations.
 *
 * Owns: the tables of folds, flips and bifurcations of a diagram, its cusp, and what the paper
 * prints of them.
 */
#ifndef SCENE_CURVES_H
#define SCENE_CURVES_H

#include "scenes/lines.h"

/* Write the dimensions `fold`, `flip` and `bifurcation` with their arrays, and the cusp. */
void scene_curves_write(const scene_lines *l);

/* What the paper prints on these, where the deck has it. */
void scene_curves_write_paper(const scene_lines *l);

#endif
