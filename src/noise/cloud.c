/* cloud.c -- clouds around attractors, beside linear noise theory; see cloud.h. */
#include <pendres/cloud.h>

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "engine/context_internal.h"
#include "engine/door.h"
#include "noise/cores.h"
#include "noise/noise_common.h"
#include "settling/attractor_internal.h"

enum { STATISTICS = PENDRES_LANGEVIN_STATISTICS, PART = PENDRES_NOISE_LANES };

static const pendres_langevin_estimate none = {NAN, NAN};

static const pendres_orbit *orbit_of(const pendres_cloud_request *q)
{
  return &pendres_attractors_get(q->set, q->attractor)->orbit;
}

/* Clouds are made around closed orbits that stay in their well; others run away, or have no strobe
 * point that they come back to. */
static int has_cloud(const pendres_orbit *o)
{
  return o->period > 0 && o->winding == 0;
}

/* NULL, or what is wrong with a request. */
static const char *refuse(const pendres_cloud_request *q)
{
  if (pendres_attractors_get(q->set, q->attractor) == NULL) return "there is no such attractor";
  if (!(q->temperature >= 0.0 && isfinite(q->temperature)))
    return "the temperature must be a number from 0 on";
  if (q->trajectories < 2) return "a cloud needs two trajectories";
  if (q->record < 1 || q->record > (long)UINT32_MAX)
    return "the strobes of each trajectory must be 1 to 4294967295";
  if (q->trajectories > SIZE_MAX / sizeof(double) / (size_t)q->record)
    return "there are more strobe points than memory has room for";
  return pendres_noise_refuses(&pendres_attractors_get(q->set, q->attractor)->orbit.pendulum);
}

/* Open the door to a request; returns it as it is behind, in *inside. */
static const pendres_cloud_request *open_request(pendres_door *d, pendres_context *ctx,
                                                 const pendres_cloud_request *request,
                                                 pendres_cloud_request *inside)
{
  *d = pendres_attractors_open(ctx, request != NULL ? request->set : NULL);
  if (request == NULL || !pendres_door_changes(d)) return request;
  *inside = *request;
  inside->set = pendres_attractors_inside(d, request->set);
  inside->temperature /= pendres_units_factor(&d->scales, 2, -2);
  return inside;
}

/* Announce the strobe points of the trajectories of a request, if it is one. */
static void announce(pendres_door *d, size_t trajectories, const pendres_cloud_request *request,
                     double *x, double *v)
{
  if (request == NULL || d->status != PENDRES_OK || refuse(request) != NULL) return;
  (void)pendres_door_out(d, &pendres_dim_length, trajectories * (size_t)request->record, x);
  (void)pendres_door_out(d, &pendres_dim_speed, trajectories * (size_t)request->record, v);
}

/* The same for trajectories; `cores` must live as long as the request. */
static pendres_status trajectories_of(pendres_context *ctx, const pendres_cloud_request *q,
                                      pendres_cores *cores, pendres_langevin_request *out)
{
  const pendres_orbit *o = orbit_of(q);
  pendres_langevin_request r = {.pendulum = o->pendulum, .x = o->x, .v = o->v,
                                .trajectories = q->trajectories,
                                .settle = pendres_noise_settle(o), .record = q->record,
                                .steps_per_period = q->steps_per_period,
                                .leave = pendres_cores_leave, .arg = cores};
  r.pendulum.temperature = q->temperature;
  r.first_id = pendres_noise_first_id(&r.pendulum, q->attractor);
  *out = r;
  const pendres_status status = pendres_cores_make(ctx, q->set, q->temperature, 0.0, cores);
  cores->home = (int)q->attractor;
  return status;
}

/* A cloud whose numbers are all NaN. */
static pendres_cloud unknown(void)
{
  pendres_cloud c = {.verdict = PENDRES_CLOUD_NOT_COMPARED, .linear = {NAN, NAN, NAN},
                     .linear_error = NAN, .escape_rate = {NAN, NAN, NAN, NAN}};
  c.measured.phase_lag = none;
  for (int s = 0; s < STATISTICS; s++) {
    c.measured.statistics[s] = c.bias.statistics[s] = none;
    c.bias.scale[s] = NAN;
  }
  return c;
}

/* ---- Clouds that are not followed -------------------------------------------------------- */

/* Mean and covariance of the q strobe points of an orbit. */
static void still_moments(const pendres_orbit *o, const double *x, const double *v,
                          pendres_langevin_estimate *out)
{
  const double q = o->period;
  double mean_x = 0.0, mean_v = 0.0, xx = 0.0, xv = 0.0, vv = 0.0;
  for (int k = 0; k < o->period; k++) {
    mean_x += x[k] / q;
    mean_v += v[k] / q;
  }
  for (int k = 0; k < o->period; k++) {
    xx += (x[k] - mean_x) * (x[k] - mean_x) / q;
    xv += (x[k] - mean_x) * (v[k] - mean_v) / q;
    vv += (v[k] - mean_v) * (v[k] - mean_v) / q;
  }
  out[PENDRES_LANGEVIN_MEAN_X] = (pendres_langevin_estimate){mean_x, o->x_error};
  out[PENDRES_LANGEVIN_MEAN_V] = (pendres_langevin_estimate){mean_v, o->v_error};
  out[PENDRES_LANGEVIN_COV_XX] = (pendres_langevin_estimate){xx, 2.0 * sqrt(xx) * o->x_error};
  out[PENDRES_LANGEVIN_COV_XV] =
    (pendres_langevin_estimate){xv, sqrt(xx) * o->v_error + sqrt(vv) * o->x_error};
  out[PENDRES_LANGEVIN_COV_VV] = (pendres_langevin_estimate){vv, 2.0 * sqrt(vv) * o->v_error};
}

/* First harmonic and loop area from an orbit, which has the harmonic's length and direction with
 * their errors. */
static void still_response(const pendres_orbit *o, pendres_langevin_cloud *out)
{
  const double lag = atan2(o->sine[0], o->cosine[0]);
  const double error = hypot(o->first_harmonic_amplitude_error,
                             o->first_harmonic_amplitude * o->phase_lag_error);
  out->statistics[PENDRES_LANGEVIN_COSINE] = (pendres_langevin_estimate){o->cosine[0], error};
  out->statistics[PENDRES_LANGEVIN_SINE] = (pendres_langevin_estimate){o->sine[0], error};
  out->statistics[PENDRES_LANGEVIN_LOOP_AREA] =
    (pendres_langevin_estimate){o->loop_area, o->loop_area_error};
  out->phase_lag =
    (pendres_langevin_estimate){lag < 0.0 ? lag + two_pi : lag, o->phase_lag_error};
}

/* Without noise, or with noise below rounding, the cloud is the orbit's own points. */
static pendres_status make_still(pendres_context *ctx, const pendres_cloud_request *q,
                                 pendres_cloud *c, double *x, double *v)
{
  const pendres_orbit *o = orbit_of(q);
  const size_t period = (size_t)o->period, n = q->trajectories * (size_t)q->record;
  double *points = malloc(2 * period * sizeof *points);
  if (points == NULL) return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory");
  const pendres_status status = pendres_orbit_sample(ctx, o, 1, points, points + period, NULL);
  if (status == PENDRES_OK) {
    /* The Poincare point itself, to the last digit. */
    points[0] = o->x;
    points[period] = o->v;
    for (size_t k = 0; x != NULL && k < n; k++) {
      x[k] = points[k % period];
      v[k] = points[period + k % period];
    }
    still_moments(o, points, points + period, c->measured.statistics);
    still_response(o, &c->measured);
    c->measured.strobes = (double)n;
    c->escape_rate = (pendres_langevin_interval){0.0, 0.0, 0.0, 0.0};
    for (int s = 0; s < STATISTICS; s++)
      c->bias.statistics[s] = (pendres_langevin_estimate){0.0, 0.0};
  }
  free(points);
  return status;
}

/* A narrow cloud takes its covariance from theory. */
static void take_theory(pendres_cloud *c)
{
  pendres_langevin_estimate *s = c->measured.statistics;
  s[PENDRES_LANGEVIN_COV_XX] = (pendres_langevin_estimate){c->linear.xx, c->linear_error};
  s[PENDRES_LANGEVIN_COV_XV] = (pendres_langevin_estimate){c->linear.xv, c->linear_error};
  s[PENDRES_LANGEVIN_COV_VV] = (pendres_langevin_estimate){c->linear.vv, c->linear_error};
}

/* ---- Comparison with theory ---------------------------------------------------------------- */

/* Linear theory, and how the cloud is to be made. */
static void ask_theory(const pendres_langevin_request *r, const pendres_orbit *o, pendres_cloud *c)
{
  pendres_langevin_linear linear;
  const pendres_status status =
    pendres_langevin_linear_find(&r->pendulum, r->x, r->v, o->period, &linear);
  c->way = PENDRES_CLOUD_FOLLOWED;
  if (status != PENDRES_OK) return;
  if (!(linear.covariance.xx > last_place_of_one)) c->way = PENDRES_CLOUD_NARROW;
  /* The cloud of an orbit of several periods lies around several points; theory is for one. */
  if (o->period != 1) return;
  c->linear = linear.covariance;
  c->linear_error = linear.error;
}

/*
 * Whether the cloud agrees with linear theory within three times the sum of all errors, the bias
 * included. With an error as large as half the width anything would agree: no verdict then.
 */
static pendres_cloud_verdict verdict_on(const pendres_cloud *c)
{
  enum { FIRST = PENDRES_LANGEVIN_COV_XX, ELEMENTS = 3 };
  const pendres_langevin_covariance *l = &c->linear;
  const double linear[ELEMENTS] = {l->xx, l->xv, l->vv};
  const double scale[ELEMENTS] = {l->xx, sqrt(l->xx * l->vv), l->vv};
  pendres_cloud_verdict verdict = PENDRES_CLOUD_AGREES;
  if (c->way == PENDRES_CLOUD_NARROW) return PENDRES_CLOUD_BELOW_ROUNDING;
  if (isnan(c->linear_error) || !isfinite(c->measured.statistics[FIRST].value))
    return PENDRES_CLOUD_NOT_COMPARED;
  for (int k = 0; k < ELEMENTS; k++) {
    const pendres_langevin_estimate s = c->measured.statistics[FIRST + k];
    const pendres_langevin_estimate b = c->bias.statistics[FIRST + k];
    /* Where the bias could not be measured its bound is taken. */
    const double off =
      isfinite(b.value) ? hypot(b.value, b.error) : pendres_noise_bias * fabs(linear[k]);
    const double error =
      sqrt(s.error * s.error + c->linear_error * c->linear_error + off * off);
    if (!(fabs(s.value - linear[k]) <= surely * error)) return PENDRES_CLOUD_TOO_HOT;
    if (error > 0.5 * scale[k]) verdict = PENDRES_CLOUD_UNCERTAIN;
  }
  return verdict;
}

/* ---- The parts ----------------------------------------------------------------------------- */

/* A cloud without noise, or a narrow one, complete. */
static pendres_status complete(pendres_context *ctx, const pendres_cloud_request *q,
                               pendres_cloud *c, double *x, double *v)
{
  const pendres_status status = make_still(ctx, q, c, x, v);
  if (status != PENDRES_OK) return status;
  if (c->way == PENDRES_CLOUD_NARROW && !isnan(c->linear_error)) take_theory(c);
  if (c->way == PENDRES_CLOUD_STILL && orbit_of(q)->period == 1) {
    c->linear = (pendres_langevin_covariance){0.0, 0.0, 0.0};
    c->linear_error = 0.0;
  }
  c->verdict = verdict_on(c);
  return PENDRES_OK;
}

static pendres_status prepare(pendres_context *ctx, const pendres_cloud_request *q,
                              pendres_cloud *c, double *x, double *v)
{
  if (q == NULL || c == NULL) return PENDRES_CONTEXT_NULL(ctx, "request and cloud");
  const char *wrong = refuse(q);
  if (wrong == NULL && (x == NULL) != (v == NULL))
    wrong = "strobe points need room for both x and v";
  if (wrong != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", wrong);
  const pendres_orbit *o = orbit_of(q);
  *c = unknown();
  for (size_t k = 0; x != NULL && k < q->trajectories * (size_t)q->record; k++) x[k] = v[k] = NAN;
  if (!has_cloud(o)) return PENDRES_OK;
  if (!(q->temperature > 0.0)) {
    c->way = PENDRES_CLOUD_STILL;
    return complete(ctx, q, c, x, v);
  }
  pendres_cores cores;
  pendres_langevin_request r;
  const pendres_status status = trajectories_of(ctx, q, &cores, &r);
  if (status != PENDRES_OK) return status;
  ask_theory(&r, o, c);
  if (c->way == PENDRES_CLOUD_NARROW) return complete(ctx, q, c, x, v);
  r.trajectories = 2 * PENDRES_NOISE_LANES; /* to choose steps by */
  r.record = PENDRES_NOISE_RECORD;
  return pendres_noise_choose_steps(ctx, &r, PENDRES_LANGEVIN_CLOUD, pendres_noise_bias, &c->bias);
}

/* What prepares or measures a whole cloud, in canonical units. */
typedef pendres_status work(pendres_context *ctx, const pendres_cloud_request *q, pendres_cloud *c,
                            double *x, double *v);

static pendres_status behind_door(pendres_context *ctx, const pendres_cloud_request *request,
                                  pendres_cloud *cloud, double *x, double *v, work *body)
{
  pendres_door d;
  pendres_cloud_request inside;
  request = open_request(&d, ctx, request, &inside);
  announce(&d, request != NULL ? request->trajectories : 0, request, x, v);
  PENDRES_DOOR_OUT(&d, whole_cloud, 1, cloud);
  return PENDRES_DOOR_END(&d, body(ctx, request, cloud, x, v));
}

pendres_status pendres_cloud_prepare(pendres_context *ctx, const pendres_cloud_request *request,
                                     pendres_cloud *cloud, double *x, double *v)
{
  return behind_door(ctx, request, cloud, x, v, prepare);
}

size_t pendres_cloud_parts(const pendres_cloud_request *request)
{
  return request != NULL ? pendres_noise_parts(request->trajectories, PART) : 0;
}

size_t pendres_cloud_part(const pendres_cloud_request *request, size_t part, size_t *first)
{
  size_t unused;
  if (first == NULL) first = &unused;
  *first = 0;
  if (part >= pendres_cloud_parts(request)) return 0;
  return pendres_noise_part(request->trajectories, PART, part, first);
}

static pendres_status follow(pendres_context *ctx, const pendres_cloud_request *q, size_t part,
                             pendres_langevin_cloud *out, double *x, double *v)
{
  if (q == NULL || out == NULL) return PENDRES_CONTEXT_NULL(ctx, "request and out");
  const char *wrong = refuse(q);
  if (wrong == NULL && part >= pendres_cloud_parts(q)) wrong = "there is no such part";
  if (wrong == NULL && !has_cloud(orbit_of(q))) wrong = "around this attractor there is no cloud";
  if (wrong == NULL && q->steps_per_period == 0) wrong = "to follow trajectories asks for steps";
  if (wrong != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", wrong);
  pendres_cores cores;
  pendres_langevin_request r;
  size_t first;
  pendres_status status = trajectories_of(ctx, q, &cores, &r);
  if (status != PENDRES_OK) return status;
  r.trajectories = pendres_cloud_part(q, part, &first);
  r.first_id += first;
  status = pendres_langevin_cloud_find(ctx, &r, out, x, v);
  return status == PENDRES_NOT_FOUND ? PENDRES_OK : status; /* all have left: an empty part */
}

pendres_status pendres_cloud_follow(pendres_context *ctx, const pendres_cloud_request *request,
                                    size_t part, pendres_langevin_cloud *out, double *x,
                                    double *v)
{
  pendres_door d;
  pendres_cloud_request inside;
  request = open_request(&d, ctx, request, &inside);
  announce(&d, pendres_cloud_part(request, part, NULL), request, x, v);
  PENDRES_DOOR_OUT(&d, cloud, 1, out);
  return PENDRES_DOOR_END(&d, follow(ctx, request, part, out, x, v));
}

pendres_status pendres_cloud_conclude(const pendres_cloud_request *request, size_t parts,
                                      const pendres_langevin_cloud *part, pendres_cloud *cloud)
{
  if (request == NULL || cloud == NULL || refuse(request) != NULL) return PENDRES_INVALID_ARGUMENT;
  if (cloud->way != PENDRES_CLOUD_FOLLOWED) return PENDRES_OK;
  const pendres_status status = pendres_langevin_merge(parts, part, &cloud->measured);
  if (status != PENDRES_OK) return status;
  const double period = two_pi / orbit_of(request)->pendulum.drive_frequency;
  cloud->escape_exposure = cloud->measured.exposure * period;
  const pendres_scales scales = {request->set->units[0], 1.0, 1.0};
  pendres_cloud inside = *cloud;
  pendres_units_in(&scales, &pendres_dim_whole_cloud, 1, &inside);
  cloud->verdict = verdict_on(&inside);
  if (!(cloud->escape_exposure > 0.0)) return PENDRES_OK;
  return pendres_langevin_rate((double)cloud->measured.left, cloud->escape_exposure,
                               pendres_noise_level, &cloud->escape_rate);
}

static pendres_status measure(pendres_context *ctx, const pendres_cloud_request *q,
                              pendres_cloud *c, double *x, double *v)
{
  pendres_status status = prepare(ctx, q, c, x, v);
  if (status != PENDRES_OK || c->way != PENDRES_CLOUD_FOLLOWED) return status;
  const size_t n = pendres_cloud_parts(q);
  pendres_langevin_cloud *part = calloc(n, sizeof *part);
  pendres_cloud_request chosen = *q;
  chosen.steps_per_period = c->bias.steps_per_period;
  if (part == NULL)
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for %zu parts", n);
  for (size_t k = 0; k < n && status == PENDRES_OK; k++) {
    size_t first;
    (void)pendres_cloud_part(q, k, &first);
    const size_t place = first * (size_t)q->record;
    status = follow(ctx, &chosen, k, &part[k], x != NULL ? x + place : NULL,
                    v != NULL ? v + place : NULL);
  }
  if (status == PENDRES_OK) status = pendres_cloud_conclude(q, n, part, c);
  free(part);
  return status;
}

pendres_status pendres_cloud_find(pendres_context *ctx, const pendres_cloud_request *request,
                                  pendres_cloud *cloud, double *x, double *v)
{
  return behind_door(ctx, request, cloud, x, v, measure);
}
