/* fit.c -- parameters from measured responses; see fit.h. */
#include "analysis/fit/search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "engine/door.h"

/* ---- before the fit ---- */

static void set_start(pendres_fit_call *c)
{
  static const double neutral[] = {
#define SCALE_NEUTRAL(code, name, value) value,
    PENDRES_FIT_SCALE_LIST(SCALE_NEUTRAL)
#undef SCALE_NEUTRAL
  };
  for (int q = 0; q < FIT_QUANTITIES; q++)
    c->start[q] = q < PENDRES_PARAMETER_FOLLOWED
                    ? pendres_parameter_get((pendres_parameter)q, &c->model->pendulum)
                    : neutral[q - PENDRES_PARAMETER_FOLLOWED];
  for (int q = 0; q < FIT_QUANTITIES; q++)
    if (isnan(c->start[q]) || q == (int)c->data->axis || q == (int)c->data->other)
      c->start[q] = 0.0;
  /* Without a scale times are the model's, whose frequencies are angular. */
  if (c->data->axis == PENDRES_PARAMETER_COUNT)
    c->start[PENDRES_FIT_FREQUENCY_SCALE] = 1.0 / two_pi;
  for (size_t i = 0; i < c->model->unknowns; i++)
    c->start[c->model->unknown[i].quantity] = c->model->unknown[i].guess;
}

/* The blocks with the fewest rows that give the derivatives. */
static void set_parameters(const pendres_fit_call *c, fit_model *m)
{
  int wanted[PENDRES_PARAMETER_FOLLOWED] = {0}, last = 0;
  if (!m->decays) wanted[m->axis] = 1;
  if (m->lines) wanted[PENDRES_DAMPING] = 1;
  if (m->other != PENDRES_PARAMETER_COUNT) wanted[m->other] = 1;
  for (size_t i = 0; i < c->model->unknowns; i++)
    if (!c->model->unknown[i].fixed && c->model->unknown[i].quantity < PENDRES_PARAMETER_FOLLOWED)
      wanted[c->model->unknown[i].quantity] = 1;
  for (int q = 0; q < PENDRES_PARAMETER_FOLLOWED; q++) {
    if (!wanted[q]) continue;
    m->parameter[m->parameters++] = q;
    last = q;
  }
  m->flow = last <= (int)PENDRES_DRIVE_AMPLITUDE        ? PENDRES_FLOW_SENSITIVITY
            : last <= (int)PENDRES_PARAMETRIC_AMPLITUDE ? PENDRES_FLOW_DRIVES
            : last <= (int)PENDRES_A5                   ? PENDRES_FLOW_FORCE
                                                        : PENDRES_FLOW_ALL;
}

/* A pendulum with these values and the data's middle, by which units are chosen. */
static pendres_pendulum typical(const pendres_fit_call *c, const fit_model *m, const fit_values v)
{
  pendres_pendulum p = c->model->pendulum;
  for (int q = 0; q < PENDRES_PARAMETER_FOLLOWED; q++)
    pendres_parameter_set((pendres_parameter)q, v[q], &p);
  p.damping = pendres_fit_damping(m, v);
  p.temperature = 0.0;
  if (m->decays || m->rotates) {
    p.drive_frequency = 1.0;
    p.drive_amplitude = p.parametric_amplitude = 0.0;
    return p;
  }
  const fit_curve *last = &m->curve[m->curves - 1];
  pendres_parameter_set(m->axis, pendres_fit_in(m, m->axis, v, 0.5 * (last->from + last->to)), &p);
  if (m->other != PENDRES_PARAMETER_COUNT)
    pendres_parameter_set(m->other, pendres_fit_in(m, m->other, v, last->other), &p);
  return p;
}

static void set_units(fit_model *m, const pendres_units *u)
{
  for (int q = 0; q < PENDRES_PARAMETER_FOLLOWED; q++)
    m->unit[q] = pendres_units_of_parameter(u, (pendres_parameter)q);
  m->unit[PENDRES_FIT_FREQUENCY_SCALE] = u->time;
  m->unit[PENDRES_FIT_DRIVE_SCALE] = m->unit[PENDRES_DRIVE_AMPLITUDE];
  m->unit[PENDRES_FIT_TORQUE_SCALE] = m->unit[PENDRES_TORQUE];
  m->unit[PENDRES_FIT_AMPLITUDE_SCALE] = (m->rotates ? u->time : 1.0) / u->length;
  m->unit[PENDRES_FIT_START_DISPLACEMENT] = u->length;
  m->unit[PENDRES_FIT_START_VELOCITY] = u->length / u->time;
  m->area = u->length * u->length / (u->time * u->time);
  m->clock = u->time;
}

/* ---- the fit ---- */

static pendres_status take_room(fit_search *s, size_t unknowns, pendres_room *room)
{
  fit_problem *p = s->p;
  const size_t rows = pendres_fit_rows(p->m) + unknowns, n = unknowns;
  p->unknowns = unknowns;
  p->free = pendres_room_take(room, n, sizeof *p->free);
  p->x = pendres_room_take(room, n, sizeof *p->x);
  p->rows.rows = rows;
  p->rows.residual = pendres_room_take(room, rows, sizeof *p->rows.residual);
  p->rows.slope = pendres_room_take(room, rows, sizeof *p->rows.slope);
  p->rows.used = pendres_room_take(room, p->m->tracks * FIT_STAGES, sizeof *p->rows.used);
  p->rows.from = pendres_room_take(room, p->m->stations + 1, sizeof *p->rows.from);
  fit_result *both[] = {&s->best, &s->now};
  for (int k = 0; k < 2; k++) {
    both[k]->covariance = pendres_room_take(room, n * n, sizeof *both[k]->covariance);
    both[k]->combination = pendres_room_take(room, n + 1, sizeof *both[k]->combination);
    both[k]->at_bound = pendres_room_take(room, n, sizeof *both[k]->at_bound);
    both[k]->spread = pendres_room_take(room, n, sizeof *both[k]->spread);
  }
  s->error = pendres_room_take(room, p->m->data, sizeof *s->error);
  s->work = pendres_room_take(room, p->m->data, sizeof *s->work);
  return room->status;
}

static void set_free(const pendres_fit_call *c, fit_problem *p)
{
  size_t k = 0;
  /* The frequency of a resonance is known to a share of its width. */
  const double narrow = p->m->lines ? p->m->narrow : 0.0;
  for (size_t i = 0; i < c->model->unknowns; i++) {
    const pendres_fit_unknown *u = &c->model->unknown[i];
    const double unit = p->m->unit[u->quantity];
    if (u->fixed) continue;
    p->free[k++] = (fit_free){.of = u, .quantity = u->quantity, .low = u->low / unit,
                              .high = u->high / unit, .prior = u->prior / unit,
                              .prior_error = u->prior_error / unit,
                              .narrow = u->quantity == PENDRES_FIT_FREQUENCY_SCALE ? narrow : 0.0};
  }
}

/* ---- the call ---- */

/* What an unknown begins with: its guess, or where places of jumps or resonances are data, which
   tell none, its prior or the middle of its bounds. */
static double own_guess(const fit_model *m, const pendres_fit_unknown *u)
{
  if (!isnan(u->guess) || m->marks == 0) return u->guess;
  if (u->prior_error > 0.0) return u->prior;
  return u->low < u->high ? 0.5 * (u->low + u->high) : NAN;
}

/* Starts in the caller's units: the deck's own, where it has all values, then those from the data.
   Returns how many. */
static int find_starts(pendres_fit_call *c, fit_model *m, fit_values start[FIT_TRIED])
{
  int count = 0, whole = 1, damped = 0; /* whether the damping is sought */
  fit_values open, own;
  memcpy(open, c->start, sizeof open);
  memcpy(own, c->start, sizeof own);
  for (size_t i = 0; i < c->model->unknowns; i++) {
    const pendres_fit_unknown *u = &c->model->unknown[i];
    if (u->fixed) continue;
    own[u->quantity] = own_guess(m, u);
    whole &= !isnan(own[u->quantity]);
    damped |= u->quantity == PENDRES_DAMPING;
    /* A prior is a guess as well, and what has bounds begins in their middle. */
    if (isnan(u->guess) && u->prior_error > 0.0) open[u->quantity] = u->prior;
  }
  c->own = whole;
  if (whole) {
    memcpy(start[count++], own, sizeof(fit_values));
    for (size_t i = 0; i < c->model->unknowns; i++)
      if (!c->model->unknown[i].fixed && c->model->unknown[i].prior_error <= 0.0 &&
          c->model->unknown[i].quantity != PENDRES_FIT_OFFSET)
        open[c->model->unknown[i].quantity] = NAN;
  }
  /* Where places are data and the guess has none, one of less damping, or of more, may. */
  for (int k = 0; k < FIT_GUESS_AROUND && whole && damped && m->marks > 0; k++) {
    memcpy(start[count], own, sizeof(fit_values));
    start[count++][PENDRES_DAMPING] *= fit_guess_around[k];
  }
  const int more = m->decays    ? pendres_fit_decay_guess(m, open, start + count)
                   : m->rotates ? pendres_fit_rotation_guess(m, open, start + count)
                   : m->lines   ? pendres_fit_line_guess(m, open, start + count)
                                : pendres_fit_guess(m, open, start + count);
  if (more < 0) return more;
  count += more;
  for (int k = 0; k < count; k++)
    for (int q = 0; q < FIT_QUANTITIES; q++)
      if (isnan(start[k][q])) start[k][q] = 0.0;
  return count;
}

static pendres_status fit_within(pendres_context *ctx, const pendres_fit_call *c, fit_model *m,
                                 pendres_room *room, int starts, fit_values *start)
{
  size_t open = 0;
  for (size_t i = 0; i < c->model->unknowns; i++) open += !c->model->unknown[i].fixed;
  fit_problem p = {.m = m, .errors_known = c->errors_known,
                   .terms = {.jump_error = c->options.jump_error, .huber = c->options.huber}};
  fit_search s = {.call = c, .p = &p, .starts = starts, .start = start};
  pendres_status status = take_room(&s, open, room);
  if (status != PENDRES_OK) return status;
  fit_result *best = &s.best;
  p.terms.error = s.error;
  set_free(c, &p);
  status = pendres_fit_search(&s);
  if (status != PENDRES_OK) return status;
  if (!best->computed)
    return pendres_context_fail(ctx, PENDRES_NOT_CONVERGED,
                                "the model could not be computed from any start%s%s: give guesses "
                                "of the unknowns", m->lost != NULL ? "; the last: " : "",
                                m->lost != NULL ? m->lost : "");
  if (best->impossible) best->converged *= 2;
  if (!p.known) pendres_fit_forget(&p);
  if (status == PENDRES_OK && !pendres_fit_evaluate(&p, best->v))
    status = p.status != PENDRES_OK ? p.status : pendres_context_fail(
      ctx, PENDRES_NOT_CONVERGED, "the model could not be computed anew at the best values%s%s",
      m->lost != NULL ? ": " : "", m->lost != NULL ? m->lost : "");
  if (status != PENDRES_OK) return status;
  status = pendres_fit_result(c, &p, best);
  if (status == PENDRES_NOT_CONVERGED)
    (void)pendres_context_fail(ctx, status, "the fit has not converged%s; the values are the best",
                               best->converged ? " to a chi-square that can be" : "");
  return status;
}

static pendres_status fit(pendres_context *ctx, pendres_fit_call *c)
{
  fit_model m = {.ctx = ctx, .base = c->model->pendulum};
  fit_values start[FIT_TRIED];
  pendres_room room = pendres_room_open(ctx, "a fit");
  pendres_status status = pendres_fit_check(ctx, c);
  if (status != PENDRES_OK) return status;
  c->errors_known = c->data->datum[0].error > 0.0;
  if (c->options.iterations == 0) c->options.iterations = FIT_ITERATIONS;
  for (int q = 0; q < FIT_QUANTITIES; q++) m.unit[q] = 1.0;
  m.area = m.clock = 1.0;
  set_start(c);
  status = pendres_fit_model_begin(&m, &room, c->data);
  if (status != PENDRES_OK) return pendres_room_close(&room, status);
  set_parameters(c, &m);
  const int starts = find_starts(c, &m, start);
  if (starts < 0)
    return pendres_room_close(
      &room, pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for guesses"));
  if (starts == 0)
    return pendres_room_close(
      &room, pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT,
                                  "these data tell no guess of the unknowns: give their values"));
  const pendres_pendulum p = typical(c, &m, start[0]);
  const char *why = NULL;
  if (pendres_pendulum_check(&p, &why) != PENDRES_OK)
    return pendres_room_close(
      &room, pendres_context_fail(ctx, PENDRES_INVALID_ARGUMENT, "the first guess: %s", why));
  /* On a line the drive is in a unit of its own, which no tolerance can be told in. */
  const double tolerance = ctx->options.tolerance, length = pendres_units_of(&p).length;
  if (m.lines) ctx->options.tolerance = fmax(tolerance, fit_finest * length);
  pendres_door d = pendres_door_open(ctx, &p);
  set_units(&m, &d.scales.unit);
  m.narrow = 1.0 / start[0][PENDRES_FIT_INTERNAL_Q] + 1.0 / start[0][PENDRES_FIT_COUPLING_Q];
  PENDRES_DOOR_CALL(&d, fit_within(ctx, c, &m, &room, starts, start));
  status = d.status;
  if (*c->out != NULL)
    for (size_t i = 0; i < m.data; i++)
      pendres_units_out(&d.scales, &pendres_dim_guess, 1, &(*c->out)->point[i].orbit);
  const pendres_status closed = pendres_door_close(&d);
  ctx->options.tolerance = tolerance;
  return pendres_room_close(&room, status != PENDRES_OK ? status : closed);
}

pendres_status pendres_fit_find(pendres_context *ctx, const pendres_fit_data *data,
                                const pendres_fit_model *model,
                                const pendres_fit_options *options, pendres_fit **out)
{
  if (out != NULL) *out = NULL;
  pendres_fit_call c = {.data = data, .model = model, .out = out};
  if (data == NULL || model == NULL || out == NULL ||
      (model->unknown == NULL && model->unknowns > 0))
    return PENDRES_CONTEXT_CALL(ctx, PENDRES_CONTEXT_NULL(ctx, "data, model, unknowns and out"));
  if (options != NULL) c.options = *options;
  return PENDRES_CONTEXT_CALL(ctx, fit(ctx, &c));
}
