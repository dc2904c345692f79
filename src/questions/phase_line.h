/*
 * phase_line.h -- what lines of a phase diagram and the whole diagram share.
 */
#ifndef PENDRES_PHASE_LINE_H
#define PENDRES_PHASE_LINE_H

#include <pendres/phase_diagram.h>

#include "questions/small_end.h"

/* Orbits on the sheets of SA and LA and the unstable one between, whatever their stability: one
   drive period, no winding, their own mirror images where there is the mirror symmetry. */
int pendres_phase_on_sheets(const pendres_orbit *orbit);

/* The fold at which SA ends along the line whose branches these are; not known if there is none. */
pendres_small_end pendres_phase_small_end(const pendres_branches *branches);

/* How far branches and curves are followed in a parameter around a diagram's first and last
   value of it, so that what names its points is met. plain: the pendulums have neither torque nor
   parametric drive nor another force; of others it is not known where that is, and branches reach
   a tenth of the diagram's width beyond it. */
void pendres_phase_reach(pendres_parameter parameter, int plain, double first, double last,
                         double *low, double *high);

/* Whether a pendulum is plain, and stays so as a parameter changes. */
int pendres_phase_plain(const pendres_pendulum *p, pendres_parameter parameter);

/* Whether a value of the parameter across the lines lies where SA and LA are one, seen from the
   cusp's: at stronger damping, higher frequencies, weaker drives; never where others change. */
int pendres_phase_beyond(pendres_parameter across, double value, double cusp);

#endif
