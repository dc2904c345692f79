/* flow_drive.c -- the drive at the right-hand sides of a flow; see flow_drive.h. */
#include "engine/flow_drive.h"

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "base/grow.h"

/*
 * ARKODE adds its clock up step by step and always rounds the same way: after 3e5 steps it is off
 * by 1e-10. The phase that it means is a whole number of steps and the node of a stage.
 */
double pendres_flow_drive_phase(const pendres_flow_drive *d, double theta)
{
  if (d->steps == 0) return theta;
  const double steps = theta * d->steps / two_pi;
  double meant = rint(steps);
  for (int i = 0; i < d->stages; i++) {
    const double here = rint(steps - d->node[i]) + d->node[i];
    if (fabs(here - steps) < fabs(meant - steps)) meant = here;
  }
  return fabs(meant - steps) < 1e-3 ? two_pi * meant / d->steps : theta;
}

double pendres_flow_drive_cosine(pendres_flow_drive *d, double theta)
{
  if (d->next >= d->size) return cos(theta); /* adaptive steps, or an unforeseen call */
  const size_t i = d->next++;
  if (d->theta[i] != theta) {
    d->theta[i] = theta;
    d->cosine[i] = cos(pendres_flow_drive_phase(d, theta));
  }
  return d->cosine[i];
}

void pendres_flow_drive_rewind(pendres_flow_drive *d)
{
  d->next = 0;
}

int pendres_flow_drive_resize(pendres_flow_drive *d, int steps)
{
  const size_t wanted = (size_t)(d->stages + 1) * (size_t)(steps + 2);
  d->next = 0;
  if (wanted > d->size) {
    if (!pendres_regrow(&d->theta, wanted, sizeof *d->theta) ||
        !pendres_regrow(&d->cosine, wanted, sizeof *d->cosine))
      return -1;
    for (size_t i = d->size; i < wanted; i++) {
      d->theta[i] = 0.0;
      d->cosine[i] = 1.0;
    }
    d->size = wanted;
  }
  return 0;
}

void pendres_flow_drive_free(pendres_flow_drive *d)
{
  free(d->theta);
  free(d->cosine);
}
