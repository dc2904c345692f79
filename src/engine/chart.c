/* chart.c -- a map of a square of the plane, as polynomials; see chart.h. */
#include "engine/chart.h"

#include <math.h>

#include "base/angles.h"
#include "base/instructions.h"

enum { TERMS = PENDRES_CHART_TERMS, CHECKED = PENDRES_CHART_CHECKED };

const pendres_kernels_chart *pendres_chart_kernel(void)
{
  return PENDRES_INSTRUCTIONS_BEST(pendres_kernels_chart);
}

/* Chebyshev's points, between which interpolation by a polynomial errs least. */
static double node(int i)
{
  return cos(pi * (i + 0.5) / TERMS);
}

/* Some of the places, the ends among them, where it errs most: half way in angle from one point to
   the next. */
static double between(int i)
{
  return cos(pi * (i * TERMS / (CHECKED - 1)) / TERMS);
}

void pendres_chart_place(int i, double *a, double *b)
{
  const int k = i - PENDRES_CHART_NODES;
  *a = k < 0 ? node(i % TERMS) : between(k % CHECKED);
  *b = k < 0 ? node(i / TERMS) : between(k / CHECKED);
}

/* What a value at node i has in the sum for term k. */
static void find_weights(double weight[TERMS][TERMS])
{
  for (int k = 0; k < TERMS; k++)
    for (int i = 0; i < TERMS; i++)
      weight[k][i] = (k > 0 ? 2.0 : 1.0) / TERMS * cos(pi * k * (i + 0.5) / TERMS);
}

double pendres_chart_fit(const double image[PENDRES_CHART_PLACES][2], pendres_chart *out)
{
  const pendres_kernels_chart *kernel = pendres_chart_kernel();
  double weight[TERMS][TERMS], half[TERMS][TERMS], missed = 0.0;
  find_weights(weight);
  for (int c = 0; c < 2; c++) {
    for (int j = 0; j < TERMS; j++)
      for (int k = 0; k < TERMS; k++) {
        half[j][k] = 0.0;
        for (int i = 0; i < TERMS; i++) half[j][k] += weight[k][i] * image[j * TERMS + i][c];
      }
    for (int k = 0; k < TERMS; k++)
      for (int i = 0; i < TERMS; i++) {
        double sum = 0.0;
        for (int j = 0; j < TERMS; j++) sum += weight[k][j] * half[j][i];
        out->term[k][c][i] = sum;
      }
  }
  for (int i = PENDRES_CHART_NODES; i < PENDRES_CHART_PLACES && !isnan(missed); i++) {
    double a, b, at[2], by[2][2];
    pendres_chart_place(i, &a, &b);
    kernel->at(out, a, b, at, by);
    const double off = hypot(at[0] - image[i][0], at[1] - image[i][1]);
    if (!(off <= missed)) missed = off;
  }
  return missed;
}
