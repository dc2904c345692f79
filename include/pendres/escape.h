/**
 * @file escape.h
 * @brief The least action with which noise carries a pendulum out of a state, and the path.
 *
 * Owns: the saddles on the boundary of a state's basin, and over each of them the path of least
 * action. At a small temperature T the rate of leaving a state over a saddle is a prefactor times
 * exp(-S/T), and nearly all that leave do so close to the path: the least S over all saddles
 * counts. Without a periodic drive S is the height of the barrier, whatever the damping. Nothing is
 * counted, so that S/T may be as large as it is.
 *
 * The path solves x' = v, v' = -damping v - f + drives + 2 damping q, p' = f' q, q' = damping q - p
 * and leads from the state's orbit, which it leaves as small clouds of linear noise theory widen,
 * to the saddle orbit; S is the integral of damping q^2. The noise that this takes is 2 damping q,
 * in the equation of motion's units. Paths are found by minimising the action from several guesses,
 * and made exact by multiple shooting.
 *
 * Sources: Freidlin and Wentzell, Random Perturbations of Dynamical Systems (1984); Dykman and
 * Krivoglaz, Sov. Phys. JETP 50 (1979) 30; Beri, Mannella, Luchinsky, Silchenko and McClintock,
 * Phys. Rev. E 72 (2005) 036131.
 *
 * Thread safety: that of the context (context.h); a set of attractors is only read.
 */
#ifndef PENDRES_ESCAPE_WAYS_H
#define PENDRES_ESCAPE_WAYS_H

#include <stddef.h>

#include <pendres/attractor.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/** A way out of a state. Its arrays belong to the list that it is in. */
typedef struct pendres_escape {
  pendres_orbit saddle;  /**< the orbit that it leads over */
  double saddle_x;       /**< where that orbit's Poincare point is on this way: whole turns away
                              from saddle.x */
  double action;         /**< S: an energy, in m g l */
  double action_error;   /**< its error: the difference from a path with larger steps that is cut
                              off earlier at both ends, and what the drive's phase may make of
                              it */
  pendres_label label;   /**< of what it leads to: ESCAPE to infinity, UNRESOLVED if not known */
  int attractor;         /**< its number in the set, or PENDRES_ATTRACTOR_UNKNOWN, ..._ESCAPED */
  long well;             /**< the well there; 0 of what is in none */
  size_t paths;          /**< different paths over this saddle that were found; this is the least */
  size_t points;         /**< of the arrays */
  const double *phase;   /**< [points] drive phase, growing, in rad */
  const double *x;       /**< [points] position, rad */
  const double *v;       /**< [points] velocity */
  const double *momentum_x; /**< [points] p */
  const double *momentum_v; /**< [points] q */
  const double *noise;   /**< [points] 2 damping q: the noise that carries it along */
} pendres_escape;

/** Opaque: ways out of a state, the one with the least action first. */
typedef struct pendres_escapes pendres_escapes;

/**
 * All ways out of attractor `from`, a closed orbit that does not wind, that are found: over the
 * saddles where lines from it, to all other attractors of the set and along both axes, cross the
 * boundary of its basin. *out is to be freed by pendres_escapes_free. Its temperature is not used.
 *
 * Errors: PENDRES_INVALID_ARGUMENT (no such attractor, it is no closed orbit or winds, or no
 * friction that is linear, for which alone the noise is stated); PENDRES_NOT_FOUND: no saddle is
 * found, or no path over any; PENDRES_TOLERANCE_UNREACHABLE: paths would take too many periods;
 * those of the integration. The context's message says which.
 */
pendres_status pendres_escapes_find(pendres_context *ctx, const pendres_attractors *set,
                                    size_t from, pendres_escapes **out);

/** Free a list; NULL is allowed. */
void pendres_escapes_free(pendres_escapes *ways);
/** How many ways there are; 0 for NULL. */
size_t pendres_escapes_count(const pendres_escapes *ways);
/** Way number i, owned by the list; NULL out of range. */
const pendres_escape *pendres_escapes_get(const pendres_escapes *ways, size_t i);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
