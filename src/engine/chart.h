/*
 * chart.h -- a map of a square of the plane, as polynomials.
 *
 * Owns: the places at which a map must be known for that, the interpolation, and by how much it
 * misses the map between them.
 */
#ifndef PENDRES_CHART_H
#define PENDRES_CHART_H

#include "engine/kernels/kernels_chart.h"

enum {
  PENDRES_CHART_CHECKED = 4, /* places a coordinate at which the interpolation is checked: ten
                                vectors with the nodes */
  PENDRES_CHART_NODES = PENDRES_CHART_TERMS * PENDRES_CHART_TERMS,
  PENDRES_CHART_PLACES = PENDRES_CHART_NODES + PENDRES_CHART_CHECKED * PENDRES_CHART_CHECKED
};

/* Place i of those at which a map must be known: the nodes come first. */
void pendres_chart_place(int i, double *a, double *b);

/* Interpolate the images of all places; returns by how much those that are checked are missed at
   most, NaN where an image is none. */
double pendres_chart_fit(const double image[PENDRES_CHART_PLACES][2], pendres_chart *out);

/* The fastest kernel that this processor runs. */
const pendres_kernels_chart *pendres_chart_kernel(void);

#endif
