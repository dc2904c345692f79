/**
 * @file resonance.h
 * @brief The drive frequency at which an ensemble dissipates most in a cycle.
 *
 * Owns: the search for the largest mean loop area over drive frequency at given damping and
 * drive amplitude (the paper's definition of resonance).
 *
 * The mean loop area is smooth in omega where the members keep their attractors, and jumps where
 * an attractor ends in a fold or a member changes its basin. Where one loses its mirror symmetry
 * the slope jumps. The largest value is either a smooth peak (a zero of dA/domega along the branch,
 * from the variational equation) or an edge (the largest value at a jump of either kind). Both are
 * searched for in the whole range, and the larger one counts.
 *
 * The range is scanned in steps of damping times omega, the least width of a resonance. In the gap
 * between two frequencies the area of each state is bounded by its slopes at both ends, and each
 * member is taken to be on a state that it, or a neighbouring member, is on at one of the ends.
 * Gaps that may hold more than the largest known value are cut, until the changes of single members
 * are located. Where members change so often that this does not end, the peak is ragged. A state
 * that exists only between the points of the scan is not seen.
 *
 * All models are served. With other forces the steps follow from the damping and from the frequency
 * of free oscillations that the drive can sustain. Only the work of drive_amplitude counts, not
 * that of a torque or a parametric drive: without drive_amplitude there is no resonance. Members
 * that escape to infinity, or rest in an unstable state, are in no mean: it is that of the others.
 * Members without a known attractor have no loop area: errors allow for them as if they could be on
 * any state.
 */
#ifndef PENDRES_RESONANCE_H
#define PENDRES_RESONANCE_H

#include <pendres/response.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/** What kind of maximum a resonance is. */
typedef enum pendres_peak {
  PENDRES_PEAK_SMOOTH = 0, /**< a maximum with a vanishing slope */
  PENDRES_PEAK_EDGE = 1,   /**< the largest mean area where it, or its slope, jumps */
  PENDRES_PEAK_RAGGED = 2, /**< the largest mean area found, where the shares of the members change
                                so often that there is no largest one to many digits; errors are
                                spreads */
  PENDRES_PEAK_COUNT       /**< how many there are; not a kind */
} pendres_peak;

/** A resonance. */
typedef struct pendres_resonance {
  pendres_peak peak;                 /**< what kind of maximum it is */
  double frequency;                  /**< drive frequency omega; the period is 2 pi / omega */
  double frequency_error;            /**< its error */
  double loop_area;                  /**< mean loop area there, the largest in the range: the work
                                          of the drive in one of its periods, in m g l */
  double loop_area_error;            /**< its error */
  pendres_response response;         /**< everything else there; at an edge, on its upper side */
  double fold_frequency;             /**< of the fold that makes the edge; NaN at a smooth peak, at
                                          an edge made by basins alone, and where a state loses its
                                          mirror symmetry */
  double fold_frequency_error;       /**< its error; NaN where there is none */
  int complete;                      /**< 1; 0: a larger area may exist, since the search ended at
                                          its budget of work, or resonances may be narrower than its
                                          steps */
} pendres_resonance;

/**
 * The resonance of pendulums with p's damping and drive amplitude for frequencies in [lowest,
 * highest] (p's own frequency is not read), with the starts of pendres_ensemble_of(), the paper's
 * 200 of a pendulum.
 *
 * PENDRES_NOT_FOUND: the mean loop area is largest at an end of the range (message says which), or
 * zero throughout, as without a drive. On failure all numbers of *out are NaN.
 * PENDRES_NOT_CONVERGED: not even a coarse scan could be computed within the budget of work.
 *
 * The budget, ten to thirty seconds of a processor, is counted in slopes of the equation of motion
 * and steps of Newton's method, so that results do not depend on the machine. With F0 = 0.2 a
 * damping of 0.001 is refused within it.
 */
pendres_status pendres_resonance_find(pendres_context *ctx, const pendres_pendulum *p,
                                      double lowest, double highest, pendres_resonance *out);

/** The same with the caller's ensemble. */
pendres_status pendres_resonance_find_ensemble(pendres_context *ctx, const pendres_pendulum *p,
                                               double lowest, double highest,
                                               const pendres_ensemble *ensemble,
                                               pendres_resonance *out);

enum { PENDRES_RESONANCE_MESSAGE = 512 /**< bytes of a search's message */ };

/** One of several searches. */
typedef struct pendres_resonance_search {
  pendres_pendulum pendulum;   /**< of the resonance; its drive frequency is not read */
  double lowest;               /**< lower end of the range of drive frequencies */
  double highest;              /**< upper end of the range */
  pendres_status outcome;      /**< written: what pendres_resonance_find_ensemble() would return */
  pendres_resonance resonance; /**< written: all NaN unless the outcome is PENDRES_OK */
  char message[PENDRES_RESONANCE_MESSAGE]; /**< written: why the outcome is not PENDRES_OK, as
                                                in pendres_context_message(); otherwise empty */
} pendres_resonance_search;

/**
 * Resonances of many pendulums, with one ensemble each. Searches run side by side, which takes less
 * time than one after another, especially if neighbours in the list are similar. Each result is bit
 * by bit that of pendres_resonance_find_ensemble(), whatever the other pendulums are.
 *
 * @param ctx      belongs to one thread at a time
 * @param n        how many
 * @param searches n of them; outcome, resonance and message are written
 * @param ensemble starts of the members of each
 * @return PENDRES_OK if all searches have an outcome, whatever it is; PENDRES_INTERRUPTED or
 *         PENDRES_OUT_OF_MEMORY if not all have; PENDRES_INVALID_ARGUMENT if a pointer is NULL
 */
pendres_status pendres_resonance_find_many(pendres_context *ctx, size_t n,
                                           pendres_resonance_search *searches,
                                           const pendres_ensemble *ensemble);

/** Where the resonance frequency is largest over damping: the curve of resonance frequency against
    amplitude turns there. */
typedef struct pendres_resonance_turn {
  double damping;         /**< gamma there */
  double damping_error;   /**< its error */
  double frequency;       /**< the resonance frequency there */
  double frequency_error; /**< its error */
} pendres_resonance_turn;

/**
 * The damping at which the resonance frequency is largest, from parabolas through resonances at
 * three dampings, ever closer together. The errors contain the effect of the cubic term, which a
 * parabola lacks, as estimated from the last four resonances, and of the resonances' own errors.
 *
 * @param ctx      belongs to one thread at a time
 * @param near     a pendulum with a damping near it; its drive_frequency is not read
 * @param lowest   lowest drive frequency at which resonances are searched for
 * @param highest  highest drive frequency
 * @param ensemble as in pendres_resonance_find_ensemble()
 * @param out      written; on failure all numbers are NaN
 * @return PENDRES_NOT_FOUND: there is no such damping near, or a resonance on the way is not a
 *         smooth peak. Else as pendres_resonance_find_ensemble()
 */
pendres_status pendres_resonance_turn_find(pendres_context *ctx, const pendres_pendulum *near,
                                           double lowest, double highest,
                                           const pendres_ensemble *ensemble,
                                           pendres_resonance_turn *out);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
