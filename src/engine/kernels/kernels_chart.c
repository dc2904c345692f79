/* kernels_chart.c -- the image of a place by a chart; see kernels_chart.h. */
#include "engine/kernels/kernels_chart.h"

#include "base/instructions.h"

enum { TERMS = PENDRES_CHART_TERMS };

/* Eight numbers, of which as many are one vector as the instruction set has. */
typedef double row __attribute__((vector_size(TERMS * sizeof(double))));
typedef double stored __attribute__((vector_size(TERMS * sizeof(double)), aligned(8), may_alias));

/* Chebyshev's polynomials of a place, and their slopes. */
static inline void polynomials(double a, double value[TERMS], double slope[TERMS])
{
  const double twice = 2.0 * a;
  value[0] = 1.0;
  value[1] = a;
  slope[0] = 0.0;
  slope[1] = 1.0;
  for (int i = 2; i < TERMS; i++) {
    value[i] = twice * value[i - 1] - value[i - 2];
    slope[i] = 2.0 * value[i - 1] + (twice * slope[i - 1] - slope[i - 2]);
  }
}

/* The sum of all products, in pairs. */
static inline double total(const row *a, const row *b)
{
  const row c = *a * *b;
  return ((c[0] + c[1]) + (c[2] + c[3])) + ((c[4] + c[5]) + (c[6] + c[7]));
}

static void at(const pendres_chart *c, double a, double b, double image[2], double by[2][2])
{
  row of_a, slope_a;
  double of_b[TERMS], slope_b[TERMS];
  polynomials(b, of_b, slope_b);
  double values[TERMS], slopes[TERMS];
  polynomials(a, values, slopes);
  for (int i = 0; i < TERMS; i++) {
    of_a[i] = values[i];
    slope_a[i] = slopes[i];
  }
  for (int k = 0; k < 2; k++) {
    row sum = {0.0}, by_b = {0.0};
    for (int j = TERMS - 1; j >= 0; j--) {
      const row term = *(const stored *)c->term[j][k];
      sum += of_b[j] * term;
      by_b += slope_b[j] * term;
    }
    image[k] = total(&sum, &of_a);
    by[k][0] = total(&sum, &slope_a);
    by[k][1] = total(&by_b, &of_a);
  }
}

const pendres_kernels_chart PENDRES_INSTRUCTIONS_OWN(pendres_kernels_chart) = {at};
