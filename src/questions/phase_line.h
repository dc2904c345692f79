/*
 * phase_line.h -- what lines of a phase diagram and the whole diagram share.
 */
#ifndef PENDRES_PHASE_LINE_H
#define PENDRES_PHASE_LINE_H

#include <pendres/phase_diagram.h>

/* Orbits on the sheets of SA and LA and the unstable one between, whatever their stability: one
   drive period, no winding, their own mirror images. */
int pendres_phase_on_sheets(const pendres_orbit *orbit);

/* How far branches and curves are followed in a parameter around a diagram's first and last
   value of it, so that what names its points is met. */
void pendres_phase_reach(pendres_parameter parameter, double first, double last, double *low,
                         double *high);

/* Whether a value of the parameter across the lines lies where SA and LA are one, seen from the
   cusp's: at stronger damping, higher frequencies, weaker drives. */
int pendres_phase_beyond(pendres_parameter across, double value, double cusp);

#endif
