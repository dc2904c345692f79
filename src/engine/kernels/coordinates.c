/* coordinates.c -- states on their way into lanes and out of them; see coordinates.h. */
#include "engine/kernels/coordinates.h"

#include <math.h>

#include "base/angles.h"
#include "base/numbers.h"
#include "model/equation.h"
#include "model/model.h"

/* What two_pi lacks, so that taking out many turns costs no digits. */
static const double two_pi_low = 2.4492935982947064e-16;

const char *pendres_coordinates_refuses(const pendres_pendulum *p, double x, double v)
{
  const double w = p->drive_frequency, drag = pendres_equation_least_drag(p);
  const double slowest = fmax(w, drag);
  if (!(isfinite(x) && isfinite(v))) return "position and velocity must be finite";
  if (!(fabs(x) <= pendres_farthest))
    return "beyond 1e15 double precision knows a position to a tenth of a radian at best";
  if (!(fabs(v) / slowest <= pendres_farthest && isfinite(v / w)))
    return "so fast a pendulum is beyond 1e15 within a period, where its angle is not known";
  if (!(fabs(p->drive_amplitude) / w / slowest <= pendres_farthest))
    return "so strong a drive shakes the pendulum farther than 1e15, where its angle is not known";
  if (!(fabs(p->torque) / w / slowest <= pendres_farthest))
    return "so strong a torque turns the pendulum farther than 1e15, where its angle is not known";
  if (!(drag / w <= pendres_farthest))
    return "so strong a damping acts within less of a period than double precision can tell";
  if (!(isfinite(1.0 / (w * w)) && isfinite(p->drive_amplitude / (w * w)) &&
        isfinite(p->torque / (w * w))))
    return "so low a drive frequency has a square that is zero in double precision";
  return NULL;
}

void pendres_coordinates_wrap(const pendres_pendulum *p, double *y, long *turns)
{
  if (fabs(*y) <= PENDRES_PI || pendres_model_of(p->force)->period == 0.0) return;
  const double k = rint(*y / two_pi);
  if (!(fabs(k + (double)*turns) * two_pi <= pendres_farthest)) {
    *y = NAN;
    return;
  }
  *y = fma(-k, two_pi_low, fma(-k, two_pi, *y));
  *turns += (long)k;
}

pendres_coordinates pendres_coordinates_in(const pendres_pendulum *p, double x, double v)
{
  pendres_coordinates s = {.y = NAN, .w = v / p->drive_frequency};
  if (!(fabs(x) <= pendres_farthest)) return s;
  const double origin = pendres_model_origin(p), turn = pendres_model_turn(p), from = x - origin;
  if (fabs(from) <= 0.5 * turn) {
    s.y = from;
    pendres_coordinates_wrap(p, &s.y, &s.turns);
    return s;
  }
  /* Whole turns first: the difference would lose digits of a large x. */
  const double k = rint(from / turn);
  s.turns = (long)k;
  s.y = fma(-k, two_pi_low, fma(-k, two_pi, x)) - origin;
  pendres_coordinates_wrap(p, &s.y, &s.turns);
  return s;
}

pendres_coordinates pendres_coordinates_in_whole(const pendres_pendulum *p, double x, double v)
{
  return (pendres_coordinates){.y = x - pendres_model_origin(p), .w = v / p->drive_frequency};
}

void pendres_coordinates_out(const pendres_pendulum *p, const pendres_coordinates *s, double *x,
                             double *v)
{
  const double turns = (double)s->turns;
  *x = fma(two_pi, turns, fma(two_pi_low, turns, s->y + pendres_model_origin(p)));
  if (v != NULL) *v = s->w * p->drive_frequency;
}

void pendres_coordinates_arrive(const pendres_pendulum *p, double *y, double *w, long *turns)
{
  static const double nothing = 1e-290;
  pendres_coordinates_wrap(p, y, turns);
  if (p->drive_amplitude == 0.0 && p->torque == 0.0 && pendres_equation_undamped(p) == NULL &&
      fabs(*y) < nothing && fabs(*w) < nothing)
    *y = *w = 0.0;
}
