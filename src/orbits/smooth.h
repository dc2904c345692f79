/*
 * smooth.h -- means over the periods of a rotation, with weights that fall smoothly to zero at both
 * ends.
 *
 * Owns: the sums, and the scatter of means over parts of the periods.
 *
 * Source: Das, Saiki, Sander and Yorke, Nonlinearity 30 (2017) 4111.
 */
#ifndef PENDRES_SMOOTH_H
#define PENDRES_SMOOTH_H

enum { PENDRES_SMOOTH_SPANS = 4 };

/* All zero before the first period. */
typedef struct pendres_smooth {
  /* Sums over all periods, and over the first, the last and the middle half of them. */
  double weight[PENDRES_SMOOTH_SPANS], growth[PENDRES_SMOOTH_SPANS], turned[PENDRES_SMOOTH_SPANS];
  double length; /* logarithm of the tangent vector's length */
  double lengths, reciprocals; /* sums of that length and of its reciprocal */
  long count;
} pendres_smooth;

/* Add period k of n: the growth of the logarithm and the turns in it. */
void pendres_smooth_add(pendres_smooth *s, long k, long n, double growth, double turned);

/* Means a period, and how far those over the parts are apart; `uneven` is by how much more than the
   mean a change counts where the rotation is slow. */
typedef struct pendres_smooth_means {
  double growth, growth_apart, turned, turned_apart, uneven;
} pendres_smooth_means;

pendres_smooth_means pendres_smooth_take(const pendres_smooth *s);

#endif
