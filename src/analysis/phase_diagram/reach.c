/* reach.c -- how far branches and curves are followed around a diagram, and what lies beyond a
   cusp; see line.h. */
#include "analysis/phase_diagram/line.h"

#include <math.h>

#include "model/model.h"
#include "continuation/parameter.h"

int pendres_phase_plain(const pendres_pendulum *p, pendres_parameter parameter)
{
  return pendres_model_kind(p) == PENDRES_MODEL_PLAIN && pendres_parameter_of(parameter)->plain;
}

/* Reach beyond a diagram by a tenth of its width, or of its value if there is only one. */
static void reach_beyond(pendres_parameter parameter, double first, double last, double *low,
                         double *high)
{
  const double margin = 0.1 * (last > first ? last - first : fmax(fabs(first), 1.0));
  *low = pendres_parameter_beyond(parameter, first, -margin);
  *high = last + margin;
}

void pendres_phase_reach(pendres_parameter parameter, int plain, double first, double last,
                         double *low, double *high)
{
  if (!plain) {
    reach_beyond(parameter, first, last, low, high);
    return;
  }
  switch (parameter) {
  case PENDRES_DRIVE_AMPLITUDE:
    /* SA and LA part somewhere between the weakest drives and those that turn pendulums over. */
    *low = fmin(0.5 * first, 0.01);
    *high = fmax(1.5 * last, 0.5);
    return;
  case PENDRES_DAMPING:
    /* Up as far as the cusp, wherever it is; down a little below the diagram's own. */
    *low = fmin(0.06, 0.98 * first);
    *high = fmax(2.0, last);
    return;
  default:
    /* The fold at which SA ends lies below the frequency of small oscillations, 1. */
    *low = fmin(0.8 * first, 0.7);
    *high = fmax(1.1 * last, 1.1);
  }
}

int pendres_phase_beyond(pendres_parameter across, double value, double cusp)
{
  if (!pendres_parameter_of(across)->plain) return 0;
  return across == PENDRES_DRIVE_AMPLITUDE ? !(value > cusp) : !(value < cusp);
}
