/* strobe_noise.c -- rounding along trajectories; see strobe_noise.h. */
#include "orbits/strobe_noise.h"

#include <math.h>

#include "engine/tables.h"
#include "orbits/numbers.h"

/*
 * A unit in the last place of angles up to pi, as measured with tp8. The moduli of its weights add
 * up to 7; those of vern8 add up to 96: its slopes cancel, but their rounding errors do not.
 */
double pendres_strobe_noise_of_step(pendres_table table)
{
  const pendres_tables_method *m = pendres_tables_get(table);
  double weights = 0.0;
  for (int i = 0; m != NULL && i < m->stages; i++) weights += fabs(m->b[i]);
  return 2.0 * last_place_of_one * fmax(1.0, weights / step_usual_weights);
}

/* Single precision has 29 bits less. */
double pendres_strobe_noise_of_step_in_float(void)
{
  return 0x1p29 * pendres_strobe_noise_of_step(pendres_tables_float);
}

double pendres_strobe_noise_of(double drive_frequency, const pendres_flow_error *carried)
{
  if (!isfinite(carried->yy + carried->yw + carried->ww)) return INFINITY;
  return fmax(sqrt(carried->yy), drive_frequency * sqrt(carried->ww));
}
