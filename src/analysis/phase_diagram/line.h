/*
 * line.h -- what lines of a phase diagram and the whole diagram share.
 */
#ifndef PENDRES_PHASE_LINE_H
#define PENDRES_PHASE_LINE_H

#include <pendres/phase_diagram.h>

#include "engine/room.h"
#include "orbits/label.h"

/* Whether an orbit, stable or not, lies on the sheets of SA, of LA, or of the unstable state
   between them: it has one drive period, no winding, and is its own mirror image where there is
   mirror symmetry. */
int pendres_phase_on_sheets(const pendres_orbit *orbit);

/* The fold at which SA ends along the line whose branches these are; not known if there is none. */
pendres_small_end pendres_phase_small_end(const pendres_branches *branches);

/* How far branches and curves are followed in a parameter around a diagram's first and last value
   of it, so that they include the fold by which SA and LA are told apart. plain: the pendulums have
   neither torque nor parametric drive nor another force. For others it is not known where that fold
   is, and branches reach beyond the diagram by a tenth of its width. */
void pendres_phase_reach(pendres_parameter parameter, int plain, double first, double last,
                         double *low, double *high);

/* Whether a pendulum is plain, and stays so as a parameter changes. */
int pendres_phase_plain(const pendres_pendulum *p, pendres_parameter parameter);

/* Whether a value of the parameter across the lines lies beyond the cusp, where SA and LA are one:
   at stronger damping, higher frequencies or weaker drives; never for any other parameter. */
int pendres_phase_beyond(pendres_parameter across, double value, double cusp);

/*
 * Stable orbits of one drive period from guesses that swing about as far as free oscillations of
 * the drive's frequency, at some points of a line: of branches that are detached from all that
 * members reach. Their array is in the room.
 */
pendres_status pendres_phase_detached(pendres_context *ctx, size_t n, const pendres_response *r,
                                      pendres_room *room, pendres_orbit **out, size_t *count);

/*
 * A line of the diagram: n pendulums that differ in options->parameter alone, whose values ascend.
 *
 * @param ctx       belongs to one thread at a time
 * @param n         how many pendulums; none is allowed
 * @param pendulums [n], read
 * @param options   read
 * @param out       [n], written
 * @param branches  may be NULL; receives all branches that the members' orbits lie on, which reach
 *                    beyond the line's values; to be freed by pendres_branches_free(); NULL on
 *                  failure
 * @return PENDRES_INVALID_ARGUMENT, or a failure of the integration; then out is not meaningful
 */
pendres_status pendres_phase_line(pendres_context *ctx, size_t n, const pendres_pendulum *pendulums,
                                  const pendres_phase_options *options, pendres_phase_point *out,
                                  pendres_branches **branches);

/*
 * Complete a line by curves of bifurcations that were followed from other lines. Where such a
 * curve crosses the line at a fold or a symmetry breaking of orbits that can be SA or LA, and the
 * line's branches have no such bifurcation there, the branch through it is added and the points are
 * classified again. A branch that no member of this line reaches is found in this way if one of the
 * curves bounds it, and stays unknown otherwise. Members are computed once more only where the fold
 * at which SA ends was unknown.
 *
 * @param ctx      belongs to one thread at a time
 * @param n        how many points
 * @param curves   of bifurcations, whose first parameter is the line's and whose second is another
 *                 one; all other parameters must be the line's; read; NULL: there are none
 * @param options  those that the line was computed with
 * @param points   [n], of pendres_phase_line(), brought up to date
 * @param branches of pendres_phase_line(), brought up to date
 * @return PENDRES_INVALID_ARGUMENT, or a failure of the integration; then points are not meaningful
 */
pendres_status pendres_phase_line_complete(pendres_context *ctx, size_t n,
                                           const pendres_curves *curves,
                                           const pendres_phase_options *options,
                                           pendres_phase_point *points,
                                           pendres_branches *branches);

#endif
