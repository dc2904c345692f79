/* cores.c -- the cores of attractors; see cores.h. */
#include "noise/cores.h"

#include <math.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/door.h"
#include "model/model.h"
#include "noise/numbers.h"
#include "settling/attractor_internal.h"

/* A symmetric matrix over (x, v): a covariance, or its inverse. */
typedef pendres_langevin_covariance matrix;

static double form(const matrix *m, double x, double v)
{
  return m->xx * x * x + 2.0 * m->xv * x * v + m->vv * v * v;
}

static matrix inverse(const matrix *m)
{
  const double d = m->xx * m->vv - m->xv * m->xv;
  return (matrix){m->vv / d, -m->xv / d, m->xx / d};
}

/* The trapping ellipse. */
static matrix ellipse_of(const pendres_attractor *a)
{
  const double w = a->orbit.pendulum.drive_frequency, r = a->trap_radius;
  return (matrix){a->trap_metric[0] / (r * r), a->trap_metric[1] / (r * r * w),
                  a->trap_metric[2] / (r * r * w * w)};
}

/* Whether the ellipse of `reach` standard deviations belongs to the basin. Its edge decides: the
   image of the inside is bounded by the edge's image, so that it settles where the edge does. */
static pendres_status settles(pendres_context *ctx, const pendres_attractors *set, int i,
                              const matrix *cloud, double reach, int *inside)
{
  const pendres_attractor *a = pendres_attractors_get(set, (size_t)i);
  const matrix ellipse = ellipse_of(a);
  const double lower[3] = {sqrt(cloud->xx), cloud->xv / sqrt(cloud->xx),
                           sqrt(cloud->vv - cloud->xv * cloud->xv / cloud->xx)};
  double x[CORES_RING], v[CORES_RING];
  pendres_settled outcome[CORES_RING];
  size_t n = 0;
  for (int k = 0; k < CORES_RING; k++) {
    const double c = reach * cos(two_pi * k / CORES_RING), s = reach * sin(two_pi * k / CORES_RING);
    const double dx = lower[0] * c, dv = lower[1] * c + lower[2] * s;
    if (form(&ellipse, dx, dv) <= 1.0) continue;
    x[n] = a->orbit.x + dx;
    v[n++] = a->orbit.v + dv;
  }
  const pendres_status status = n > 0 ? pendres_attractors_settle(ctx, set, n, x, v, outcome)
                                      : PENDRES_OK;
  *inside = 1;
  for (size_t k = 0; k < n && status == PENDRES_OK; k++)
    if (outcome[k].attractor != i || outcome[k].well != 0) *inside = 0;
  return status;
}

/* The form of the trapping ellipse, at most, at one standard deviation of the cloud. */
static double widest_in_trap(const matrix *trap, const matrix *cloud)
{
  const matrix p = inverse(cloud);
  /* The larger eigenvalue of trap relative to p. */
  const double determinant = p.xx * p.vv - p.xv * p.xv;
  const double trace =
    (trap->xx * p.vv - 2.0 * trap->xv * p.xv + trap->vv * p.xx) / determinant;
  const double product = (trap->xx * trap->vv - trap->xv * trap->xv) / determinant;
  return 0.5 * trace + sqrt(fmax(0.0, 0.25 * trace * trace - product));
}

static pendres_status depth(pendres_context *ctx, const pendres_attractors *set, size_t i,
                            double *out)
{
  if (set == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "attractors and out");
  const pendres_attractor *a = pendres_attractors_get(set, i);
  *out = NAN;
  if (a == NULL)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "there is no such attractor");
  pendres_pendulum p = a->orbit.pendulum;
  pendres_langevin_linear linear;
  p.temperature = 1.0; /* widths are in proportion to its root */
  if (!(a->trap_radius > 0.0) ||
      pendres_langevin_linear_find(&p, a->orbit.x, a->orbit.v, a->orbit.period, &linear) !=
        PENDRES_OK)
    return PENDRES_OK;
  const matrix trap = ellipse_of(a);
  double reach = 1.0 / sqrt(widest_in_trap(&trap, &linear.covariance));
  pendres_status status = PENDRES_OK;
  for (int k = 0, inside = 1; k < CORES_TRIALS && inside && status == PENDRES_OK; k++) {
    *out = 0.5 * reach * reach;
    reach *= cores_deeper;
    status = settles(ctx, set, (int)i, &linear.covariance, reach, &inside);
  }
  return status;
}

pendres_status pendres_switching_depth(pendres_context *ctx, const pendres_attractors *set,
                                       size_t i, double *energy)
{
  pendres_door d = pendres_attractors_open(ctx, set);
  const pendres_attractors *inside = pendres_attractors_inside(&d, set);
  (void)pendres_door_out(&d, &pendres_dim_energy, 1, energy);
  return PENDRES_DOOR_END(&d, depth(ctx, inside, i, energy));
}

/* The ellipse of a core, before it is scaled by its size: P. */
static pendres_status ellipse(pendres_context *ctx, const pendres_attractors *set, int i,
                              double temperature, matrix *p)
{
  const pendres_attractor *a = pendres_attractors_get(set, (size_t)i);
  pendres_pendulum hot = a->orbit.pendulum;
  pendres_langevin_linear linear;
  const double turn = pendres_model_turn(&hot), length = pendres_model_scale(&hot);
  int inside = 0;
  *p = ellipse_of(a);
  hot.temperature = temperature;
  pendres_status status = PENDRES_OK;
  if (temperature > 0.0 &&
      pendres_langevin_linear_find(&hot, a->orbit.x, a->orbit.v, a->orbit.period, &linear) ==
        PENDRES_OK) {
    double reach =
      fmin(cores_widest, fmin(0.5 * turn, cores_lengths * length) / sqrt(linear.covariance.xx));
    for (int k = 0; k < CORES_TRIALS && status == PENDRES_OK && !inside; k++, reach *= sqrt(0.5)) {
      status = settles(ctx, set, i, &linear.covariance, reach, &inside);
      if (!inside) continue;
      *p = inverse(&linear.covariance);
      *p = (matrix){p->xx / (reach * reach), p->xv / (reach * reach), p->vv / (reach * reach)};
    }
  }
  return status;
}

pendres_status pendres_cores_make(pendres_context *ctx, const pendres_attractors *set,
                                  double temperature, double size, pendres_cores *out)
{
  const double scale = cores_share * (size > 0.0 ? size : 1.0), square = scale * scale;
  const size_t n = pendres_attractors_count(set);
  *out = (pendres_cores){0};
  for (size_t i = 0; i < n && out->count < PENDRES_SWITCHING_STATES; i++) {
    const pendres_attractor *a = pendres_attractors_get(set, i);
    matrix p;
    /* A chaotic attractor has no ellipse, and an orbit that is about to vanish one of size zero. */
    if (!(a->trap_radius > 0.0)) continue;
    const pendres_status status = ellipse(ctx, set, (int)i, temperature, &p);
    if (status != PENDRES_OK) return status;
    out->core[out->count++] =
      (pendres_core){.attractor = (int)i, .running = a->orbit.winding != 0, .x = a->orbit.x,
                     .v = a->orbit.v, .turn = pendres_model_turn(&a->orbit.pendulum),
                     .xx = p.xx / square, .xv = p.xv / square, .vv = p.vv / square};
  }
  return PENDRES_OK;
}

const pendres_core *pendres_cores_locate(const pendres_cores *c, double x, double v, long *well)
{
  if (!(fabs(x) <= pendres_farthest)) return NULL;
  for (size_t i = 0; i < c->count; i++) {
    const pendres_core *s = &c->core[i];
    const double turns = rint((x - s->x) / s->turn);
    const double dx = x - s->x - s->turn * turns, dv = v - s->v;
    if (!(s->xx * dx * dx + 2.0 * s->xv * dx * dv + s->vv * dv * dv <= 1.0)) continue;
    *well = s->running ? PENDRES_NO_WELL : (long)turns;
    return s;
  }
  return NULL;
}

void pendres_cores_leave(void *cores, const pendres_langevin_strobe *strobe, unsigned char *left)
{
  const pendres_cores *c = cores;
  for (size_t i = 0; i < strobe->count; i++) {
    long well = PENDRES_NO_WELL;
    const pendres_core *s = pendres_cores_locate(c, strobe->x[i], strobe->v[i], &well);
    if (s == NULL) continue;
    if (s->attractor != c->home || (well != 0 && well != PENDRES_NO_WELL)) left[i] = 1;
  }
}
