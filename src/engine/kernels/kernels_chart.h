/*
 * kernels_chart.h -- the image of a place by a chart.
 *
 * Owns: the sum over the terms of a chart (chart.h), with its derivatives. Like kernels.c it is
 * compiled once for each instruction set, and gives the same bytes with each.
 */
#ifndef PENDRES_KERNELS_CHART_H
#define PENDRES_KERNELS_CHART_H

enum { PENDRES_CHART_TERMS = 8 /* a coordinate: of degree seven in each */ };

/* In a, b from -1 to 1: coordinate c of the image is a sum over term[j][c][i] Ti(a) Tj(b), with
   Chebyshev's polynomials. */
typedef struct pendres_chart {
  double term[PENDRES_CHART_TERMS][2][PENDRES_CHART_TERMS];
} pendres_chart;

typedef struct pendres_kernels_chart {
  /* The image of a place, and its derivatives by a and by b. */
  void (*at)(const pendres_chart *c, double a, double b, double image[2], double by[2][2]);
} pendres_kernels_chart;

extern const pendres_kernels_chart pendres_kernels_chart_base;
#if defined(__x86_64__)
extern const pendres_kernels_chart pendres_kernels_chart_avx2;
extern const pendres_kernels_chart pendres_kernels_chart_avx512;
#endif

#endif
