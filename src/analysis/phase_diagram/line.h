/*
 * line.h -- what lines of a phase diagram and the whole diagram share.
 */
#ifndef PENDRES_PHASE_LINE_H
#define PENDRES_PHASE_LINE_H

#include <pendres/phase_diagram.h>

#include "orbits/label.h"


/* Whether an orbit, stable or not, lies on the sheets of SA, of LA, or of the unstable state
   between them: it has one drive period, no winding, and is its own mirror image where there is
   mirror symmetry. */
int pendres_phase_on_sheets(const pendres_orbit *orbit);

/* The fold at which SA ends along the line whose branches these are; not known if there is none. */
pendres_small_end pendres_phase_small_end(const pendres_branches *branches);

/* How far branches and curves are followed in a parameter around a diagram's first and last value
   of it, so that they meet the fold that the names of its points follow from. plain: the pendulums
   have neither torque nor parametric drive nor another force. Of others it is not known where that
   fold is, and branches reach beyond the diagram by a tenth of its width. */
void pendres_phase_reach(pendres_parameter parameter, int plain, double first, double last,
                         double *low, double *high);

/* Whether a pendulum is plain, and stays so as a parameter changes. */
int pendres_phase_plain(const pendres_pendulum *p, pendres_parameter parameter);

/* Whether a value of the parameter across the lines lies beyond the cusp, where SA and LA are one:
   at stronger damping, higher frequencies or weaker drives; never for any other parameter. */
int pendres_phase_beyond(pendres_parameter across, double value, double cusp);

#endif
