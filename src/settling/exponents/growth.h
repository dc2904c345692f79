/*
 * growth.h -- how fast neighbouring motions part, and whether that is chaos.
 *
 * Owns: two tangent vectors of a lane and their growth; sums over batches of periods; and the one
 * decision by growth between order and chaos, for orbits, labels, exponents and sweeps.
 *
 * Method: Benettin, Galgani, Giorgilli and Strelcyn, Meccanica 15 (1980) 9: a tangent vector is
 * advanced by the variational equation and rescaled to length one; the mean growth of its logarithm
 * is the exponent. It is advanced by a method of its own, of fourth order, which is cheaper than
 * derivatives of the map; its error is estimated from a second one, with steps twice as long.
 */
#ifndef PENDRES_GROWTH_H
#define PENDRES_GROWTH_H

#include "engine/block.h"
#include "settling/exponents/numbers.h"

/* Tangent vectors of length one, as a motion begins with them. */
#define PENDRES_TANGENTS_BEGIN {{0.6, 0.8}, {0.6, 0.8}}

void pendres_tangents_put(pendres_block *block, size_t lane, double u[2][2]);

/* Vectors of a lane after a period. They are put back to length one if this is `last`, and where
   they must be: then log[] has the logarithms of their lengths, else 0. */
void pendres_tangents_take(pendres_block *block, size_t lane, int last, double u[2][2],
                           double log_length[2]);

/* With steps twice as long the growth has 16 times the error: what is to be subtracted from that of
   the first vector, which exceeds the error that is left. */
double pendres_growth_correction(const double growth[2]);

/* The mean of the batches' sums a period, and its standard error. */
double pendres_batches_mean(const double sum[BATCHES], long batch, double *error);

/*
 * Whether batches before and after some one of them differ by more than chance makes them, by
 * Student's t of the means of both parts. Such a pendulum has gone from one chaotic motion to
 * another, and its mean is that of neither. Source: Worsley, Journal of the American Statistical
 * Association 74 (1979) 365.
 */
int pendres_batches_change(const double sum[BATCHES]);

typedef enum pendres_growth_verdict {
  PENDRES_GROWTH_ORDER, /* vectors have shrunk: an orbit, of however many periods */
  PENDRES_GROWTH_DOUBT, /* neither: next to a bifurcation, on a rotation, or too soon to say */
  PENDRES_GROWTH_CHAOS
} pendres_growth_verdict;

/* The verdict from a logarithm's growth over some time, all of it, and in the latter half of the
   time. `off` is how much of all may be an error of the steps. */
pendres_growth_verdict pendres_growth_tell(double growth, double latter, double off);

#endif
