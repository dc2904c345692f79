/* small.c -- the fold that distinguishes SA from LA along a line; see line.h. */
#include "analysis/phase_diagram/line.h"

#include <math.h>

#include "continuation/sets.h"
#include "model/model.h"

/* Stable or not: the sheets of SA, LA and the state between them fold over each other. */
int pendres_phase_on_sheets(const pendres_orbit *o)
{
  return pendres_label_named(o) && (o->symmetric || !pendres_pendulum_symmetric(&o->pendulum));
}

/* Whether it is the small state that ends at a fold, which is so if the unstable orbit that it
   meets is the larger one at the same parameter, for any force and whichever way the resonance
   bends. Next to a tip the largest amplitude is off the fold: what counts is the slope along the
   curve, by the parabola through the fold and the points beside it, whose distances from it are as
   the roots of those of their parameters. point: the fold's place on its branch. */
static int ends_small(const pendres_branch *branch, size_t point, const pendres_bifurcation *f)
{
  if (point == 0 || point + 1 >= pendres_branch_count(branch)) return 0;
  const pendres_orbit *before = &pendres_branch_get(branch, point - 1)->orbit;
  const pendres_orbit *behind = &pendres_branch_get(branch, point + 1)->orbit;
  if (before->stable == behind->stable) return 0;
  const double away[2] = {fabs(pendres_parameter_get(f->parameter, &before->pendulum) - f->value),
                          fabs(pendres_parameter_get(f->parameter, &behind->pendulum) - f->value)};
  const double slope = (behind->amplitude - f->orbit.amplitude) * away[0] -
                       (before->amplitude - f->orbit.amplitude) * away[1];
  return before->stable ? slope > 0.0 : slope < 0.0;
}

/*
 * Find the fold of the largest amplitude at which the small state ends: that of the main resonance.
 * plain: of the plain pendulum along its damping or drive amplitude other folds have larger orbits
 * than those of the resonance; the fold is that of the smallest amplitude among those below whose
 * parameter two orbits exist.
 */
static pendres_small_end find_small_end(const pendres_branches *branches, int plain)
{
  pendres_small_end end = {.known = 0};
  for (size_t i = 0; i < pendres_branches_count(branches); i++) {
    const pendres_branch *branch = pendres_branches_get(branches, i);
    for (size_t k = 0; k < pendres_branch_count(branch); k++) {
      const pendres_branch_point *p = pendres_branch_get(branch, k);
      if (p->kind != PENDRES_FOLD || !pendres_phase_on_sheets(&p->orbit)) continue;
      const pendres_bifurcation *f =
        pendres_branch_bifurcation_get(branch, (size_t)p->bifurcation);
      const double larger = f->orbit.amplitude - end.amplitude;
      if (plain ? !(f->curvature < 0.0) : !ends_small(branch, k, f)) continue;
      if (end.known && (plain ? larger >= 0.0 : larger <= 0.0)) continue;
      end = (pendres_small_end){.known = 1,
                                .parameter = f->parameter,
                                .value = f->value,
                                .amplitude = f->orbit.amplitude,
                                .falling = f->curvature > 0.0};
    }
  }
  return end;
}

pendres_small_end pendres_phase_small_end(const pendres_branches *branches)
{
  const pendres_branch *first = pendres_branches_get(branches, 0);
  const pendres_branch_point *p = pendres_branch_get(first, 0);
  if (p == NULL) return (pendres_small_end){.known = 0};
  return find_small_end(branches,
                        pendres_model_kind(&p->orbit.pendulum) == PENDRES_MODEL_PLAIN &&
                          pendres_curve_parameter(&first->curve, 0) != PENDRES_DRIVE_FREQUENCY);
}
