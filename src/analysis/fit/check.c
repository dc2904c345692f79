/* check.c -- whether arguments can be fitted; see call.h. */
#include "analysis/fit/call.h"

#include <math.h>

#include "base/angles.h"
#include "base/sized.h"
#include "model/model.h"
#include "model/parameter.h"

static int is_size(pendres_fit_observable o)
{
  return o == PENDRES_FIT_AMPLITUDE || o == PENDRES_FIT_RMS || o == PENDRES_FIT_FIRST_HARMONIC ||
         o == PENDRES_FIT_LOOP_AREA;
}

static int adds_offset(const pendres_fit_model *m, pendres_fit_observable o)
{
  for (size_t i = 0; i < m->unknowns && o != PENDRES_FIT_LOOP_AREA; i++)
    if (m->unknown[i].quantity == PENDRES_FIT_OFFSET) return 1;
  return 0;
}

/* Numbers that no error and no noise makes of what they are said to be; `largest`: of the data of
   the same kind. */
static const char *refuses_value(const pendres_fit_model *m, const pendres_fit_datum *one,
                                 double largest)
{
  if (one->observable == PENDRES_FIT_PHASE_LAG &&
      fabs(one->observed) > two_pi + fit_beyond_errors * one->error)
    return "a phase_lag is in rad, and this one is more than a turn: multiply degrees by pi/180, "
           "or take off whole turns";
  if (!is_size(one->observable)) return NULL;
  const double least = adds_offset(m, one->observable) ? -largest
                       : one->error > 0.0              ? -fit_beyond_errors * one->error
                                                       : -fit_beyond_noise * largest;
  if (!(one->observed < least && one->observed < 0.0)) return NULL;
  if (adds_offset(m, one->observable))
    return "readings lie further below 0 than any lies above: decibels do, which become lengths by "
           "10^(dB/20); where an offset does it, add a number to all of them first";
  return one->observable == PENDRES_FIT_LOOP_AREA
           ? "a loop area is the work of the drive, and this one is negative: give the magnitude"
           : "amplitudes and rms are not negative, and this one is, beyond errors: make lengths of "
             "dB by 10^(dB/20), or give the magnitude; where the instrument adds an offset, free "
             "or fix 'offset'";
}

static const char *refuses_datum(const pendres_fit_data *d, const pendres_fit_datum *one)
{
  if ((unsigned)one->observable >= FIT_BASES) return "a datum is of no observable that there is";
  if (one->direction != 1 && one->direction != -1) return "the direction of a datum is 1 or -1";
  if (!isfinite(one->axis) || !isfinite(one->observed)) return "a datum is no finite number";
  if (!isfinite(one->error) || one->error < 0.0)
    return "a standard error is no finite number from 0 on";
  const int is_place = pendres_fit_is_place(one->observable);
  if (is_place && d->axis == PENDRES_PARAMETER_COUNT)
    return "a free decay has neither jumps nor resonances";
  if (!(one->error > 0.0) && is_place != pendres_fit_is_place(d->datum[0].observable))
    return "jumps and resonances need standard errors beside other data: nothing else tells how "
           "well their places are known";
  if (d->axis == PENDRES_PARAMETER_COUNT && one->direction != 1) return "time goes one way";
  if ((d->axis == PENDRES_PARAMETER_COUNT) != (one->observable == PENDRES_FIT_DISPLACEMENT))
    return "a displacement is a datum over time, and nothing else is";
  if ((one->observable == PENDRES_FIT_MEAN_VELOCITY) !=
      (d->datum[0].observable == PENDRES_FIT_MEAN_VELOCITY))
    return "mean velocities are fitted alone: leave the other observables out";
  const int line = pendres_fit_is_line(one->observable);
  if (line != pendres_fit_is_line(d->datum[0].observable) ||
      (line && pendres_fit_line_kind(one->observable) !=
                 pendres_fit_line_kind(d->datum[0].observable)))
    return "scattering parameters of one kind of line are fitted alone: leave out what else was "
           "measured";
  if (line && d->axis != PENDRES_DRIVE_FREQUENCY && d->axis != PENDRES_DRIVE_AMPLITUDE)
    return "scattering parameters are measured over the frequency or the amplitude of the drive";
  const double axis = is_place ? one->observed : one->axis;
  if (d->axis != PENDRES_PARAMETER_COUNT && pendres_parameter_of(d->axis)->positive &&
      !(axis > 0.0))
    return "the swept parameter must be positive";
  if (d->other == PENDRES_PARAMETER_COUNT) return NULL;
  if (!isfinite(one->other)) return "the other parameter of a datum is no finite number";
  if (pendres_parameter_of(d->other)->positive && !(one->other > 0.0))
    return "the other parameter of a datum must be positive";
  return NULL;
}

/* *at: the datum that is refused, or their number where none is. */
static const char *refuses_data(const pendres_fit_data *d, const pendres_fit_model *m, size_t *at)
{
  size_t known = 0, i = *at = d->n;
  double largest[FIT_BASES];
  const int decays = d->axis == PENDRES_PARAMETER_COUNT;
  if (!decays && (unsigned)d->axis >= PENDRES_PARAMETER_FOLLOWED)
    return "the axis is no parameter of orbits";
  if (decays && d->other != PENDRES_PARAMETER_COUNT) return "data over time are of one free decay";
  if (d->other != PENDRES_PARAMETER_COUNT && (unsigned)d->other >= PENDRES_PARAMETER_FOLLOWED)
    return "the other parameter is no parameter of orbits";
  if (!decays && d->axis == d->other) return "the axis and the other parameter are the same";
  if (d->n > 0 && d->datum == NULL) return "there are no data";
  for (int o = 0; o < FIT_BASES; o++) largest[o] = -INFINITY;
  for (i = 0; i < d->n; i++) {
    const char *why = refuses_datum(d, &d->datum[*at = i]);
    if (why != NULL) return why;
    double *most = &largest[d->datum[i].observable];
    *most = fmax(*most, d->datum[i].observed);
    known += d->datum[i].error > 0.0;
  }
  for (i = 0; i < d->n; i++) {
    const char *why = refuses_value(m, &d->datum[*at = i], largest[d->datum[i].observable]);
    if (why != NULL) return why;
  }
  *at = d->n;
  if (known != 0 && known != d->n) return "some data have a standard error and others have none";
  return NULL;
}

pendres_status pendres_fit_data_check(const pendres_fit_data *data, const pendres_fit_model *model,
                                      size_t *datum, const char **why)
{
  const int given = data != NULL && model != NULL && (model->unknown != NULL || !model->unknowns);
  size_t at = 0;
  const char *refused = given ? refuses_data(data, model, &at) : "data and model are needed";
  if (why != NULL) *why = refused;
  if (datum != NULL) *datum = at;
  return refused != NULL ? PENDRES_INVALID_ARGUMENT : PENDRES_OK;
}

/* Mean velocities are those of rest and rotations, without a drive. */
static const char *refuses_rotations(const pendres_fit_call *c)
{
  const pendres_pendulum *p = &c->model->pendulum;
  const int of_damping = c->data->other == PENDRES_DAMPING;
  if (c->data->axis != PENDRES_TORQUE || (c->data->other != PENDRES_PARAMETER_COUNT && !of_damping))
    return "mean velocities are measured over the torque, at one or several dampings";
  if (p->force != PENDRES_FORCE_PENDULUM) return "only the pendulum's force has rotations";
  if (pendres_model_driven(p))
    return "mean velocities are those without a drive: its amplitude must be 0";
  for (size_t i = 0; i < c->model->unknowns; i++) {
    const int q = c->model->unknown[i].quantity;
    if (q != PENDRES_DAMPING && q != PENDRES_FIT_TORQUE_SCALE && q != PENDRES_FIT_OFFSET &&
        q != PENDRES_FIT_AMPLITUDE_SCALE)
      return "mean velocities tell damping, torque_scale, amplitude_scale and offset alone";
  }
  return NULL;
}

/* What lines have, and what they alone have. */
static const char *refuses_of_line(const pendres_fit_call *c, int q)
{
  const pendres_fit_data *d = c->data;
  const pendres_fit_observable o = d->n > 0 ? d->datum[0].observable : PENDRES_FIT_AMPLITUDE;
  const int own = q >= PENDRES_FIT_INTERNAL_Q && q <= PENDRES_FIT_BACKGROUND_PHASE;
  const int leak = q == PENDRES_FIT_BACKGROUND_IN_PHASE || q == PENDRES_FIT_BACKGROUND_QUADRATURE;
  if (!pendres_fit_is_line(o))
    return own ? "quality factors, delay and background_amplitude and _phase are of scattering "
                 "parameters alone" : NULL;
  const int passes = pendres_fit_line_kind(o) == PENDRES_LINE_TRANSMISSION;
  if (q == PENDRES_DAMPING)
    return "the damping of an oscillator on a line follows from internal_q and coupling_q: free "
           "these";
  if (q == PENDRES_FIT_AMPLITUDE_SCALE || q == PENDRES_FIT_OFFSET || q == PENDRES_FIT_PHASE_OFFSET)
    return "a line's scale and phase are background_amplitude and background_phase";
  if (leak && !passes) return "background_in_phase and _quadrature are of transmission alone";
  if (passes && q == PENDRES_FIT_COUPLING_PHASE)
    return "the asymmetry of a transmission is that of background_in_phase and _quadrature";
  if (q == PENDRES_FIT_DELAY && d->axis != PENDRES_DRIVE_FREQUENCY &&
      d->other != PENDRES_DRIVE_FREQUENCY)
    return "a delay is seen over frequencies, and the data have one";
  return NULL;
}

static const char *refuses_unknown(const pendres_fit_call *c, const pendres_fit_unknown *u)
{
  const int q = u->quantity;
  if (q < 0 || q >= FIT_QUANTITIES) return "an unknown is no quantity that there is";
  const int decays = c->data->axis == PENDRES_PARAMETER_COUNT;
  if (q < PENDRES_PARAMETER_FOLLOWED && (q == (int)c->data->axis || q == (int)c->data->other))
    return "an unknown is given by the data: scales of them may be unknown instead";
  const int drives = c->data->axis == PENDRES_DRIVE_AMPLITUDE ||
                     c->data->other == PENDRES_DRIVE_AMPLITUDE;
  if (q == PENDRES_FIT_DRIVE_SCALE && !drives)
    return "drive_scale is of drives that the data give, and they give none";
  if (q == PENDRES_FIT_TORQUE_SCALE && c->data->axis != PENDRES_TORQUE &&
      c->data->other != PENDRES_TORQUE)
    return "torque_scale is of torques that the data give, and they give none";
  const int clocks = c->data->axis == PENDRES_DRIVE_FREQUENCY ||
                     c->data->other == PENDRES_DRIVE_FREQUENCY;
  if (q == PENDRES_FIT_FREQUENCY_SCALE && !clocks && !decays)
    return "frequency_scale is of frequencies that the data give, and they give none";
  if (refuses_of_line(c, q) != NULL) return refuses_of_line(c, q);
  const int of_start = q == PENDRES_FIT_START_DISPLACEMENT || q == PENDRES_FIT_START_VELOCITY;
  if (of_start && !decays) return "the start is unknown of data over time alone";
  if (decays && (q == PENDRES_DRIVE_FREQUENCY || q == PENDRES_DRIVE_AMPLITUDE ||
                 q == PENDRES_PARAMETRIC_AMPLITUDE || q == PENDRES_FIT_PHASE_OFFSET ||
                 q == PENDRES_FIT_BACKGROUND_IN_PHASE || q == PENDRES_FIT_BACKGROUND_QUADRATURE))
    return "an unknown is of a drive, and a free decay has none";
  if (q < PENDRES_PARAMETER_FOLLOWED &&
      pendres_parameter_refuses((pendres_parameter)q, c->model->pendulum.force) != NULL)
    return "an unknown is a coefficient that the force does not have";
  if (u->fixed && !isfinite(u->guess)) return "a fixed unknown has no finite value";
  if (isinf(u->guess) || !isfinite(u->low) || !isfinite(u->high) || u->low > u->high)
    return "a guess or bounds of an unknown are no numbers, or do not ascend";
  if (!isfinite(u->prior) || !(u->prior_error >= 0.0) || !isfinite(u->prior_error))
    return "the prior of an unknown is no number";
  return NULL;
}

pendres_status pendres_fit_check(pendres_context *ctx, const pendres_fit_call *c)
{
  size_t open = 0, at = c->data->n;
  const pendres_fit_model *model = c->model;
  const char *why =
    pendres_model_of(model->pendulum.force) == NULL ? "the pendulum has no force" : NULL;
  if (why == NULL) why = refuses_data(c->data, model, &at);
  if (why == NULL && c->data->n > 0 &&
      c->data->datum[0].observable == PENDRES_FIT_MEAN_VELOCITY)
    why = refuses_rotations(c);
  if (why == NULL && PENDRES_SIZED_REFUSES(&c->options) != NULL)
    why = PENDRES_SIZED_REFUSES(&c->options);
  if (why == NULL && !(c->options.huber >= 0.0 && c->options.jump_error >= 0.0 &&
                       c->options.starts >= 0 && c->options.iterations >= 0))
    why = "an option is negative or no number";
  for (size_t i = 0; i < c->model->unknowns && why == NULL; i++) {
    why = refuses_unknown(c, &c->model->unknown[i]);
    open += !c->model->unknown[i].fixed;
    for (size_t k = 0; k < i && why == NULL; k++)
      if (model->unknown[k].quantity == model->unknown[i].quantity)
        why = "an unknown is given twice";
  }
  if (at < c->data->n)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "datum %zu: %s", at, why);
  if (why != NULL) return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "%s", why);
  if (open == 0)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "nothing is free to be fitted");
  if (c->data->n <= open)
    return pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                "%zu data do not determine %zu unknowns: take more data or fix "
                                "some",
                                c->data->n, open);
  return PENDRES_OK;
}
