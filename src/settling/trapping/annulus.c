/* annulus.c -- where a state is in an annulus; see annulus.h. */
#include "settling/trapping/annulus.h"

#include <math.h>

#include "base/angles.h"

enum { NODES = PENDRES_ANNULUS_NODES };

/* Node k, and how far behind it an angle is, in distances of nodes. */
static int node_of(double y, double *t)
{
  const double at = NODES * (pendres_less_turns(y, two_pi) / two_pi + 0.5), below = floor(at);
  *t = at - below;
  return ((int)below % NODES + NODES) % NODES;
}

double pendres_annulus_centre(const pendres_annulus *a, double y, double *slope)
{
  const double h = two_pi / NODES;
  double t;
  const int k = node_of(y, &t), next = (k + 1) % NODES;
  const double rise = a->centre[next] - a->centre[k];
  const double p = h * a->slope[k] - rise, q = rise - h * a->slope[next];
  *slope = (rise + (1.0 - 2.0 * t) * (p + t * (q - p)) + t * (1.0 - t) * (q - p)) / h;
  return a->centre[k] + t * rise + t * (1.0 - t) * (p + t * (q - p));
}

double pendres_annulus_room(const pendres_annulus *a, double y, double w, double *slope)
{
  const double off = w - pendres_annulus_centre(a, y, slope);
  return fmin(off + a->below, a->above - off);
}
