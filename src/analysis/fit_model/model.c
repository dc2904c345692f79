/* model.c -- what data and values of quantities mean; see internal.h. */
#include "analysis/fit_model/internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_sf_bessel.h>

#include "base/angles.h"
#include "model/model.h"

/* ---- values ---- */

/* The scale of a parameter in the data; -1: it has none. */
static int scale_of(pendres_parameter p)
{
  return p == PENDRES_DRIVE_FREQUENCY   ? (int)PENDRES_FIT_FREQUENCY_SCALE
         : p == PENDRES_DRIVE_AMPLITUDE ? (int)PENDRES_FIT_DRIVE_SCALE
         : p == PENDRES_TORQUE          ? (int)PENDRES_FIT_TORQUE_SCALE
                                        : -1;
}

double pendres_fit_in(const fit_model *m, pendres_parameter p, const fit_values v, double raw)
{
  const int scale = scale_of(p);
  if (scale < 0) return raw / m->unit[p];
  return p == PENDRES_DRIVE_FREQUENCY ? raw / v[scale] : raw * v[scale];
}

double pendres_fit_out(const fit_model *m, pendres_parameter p, const fit_values v, double value)
{
  const int scale = scale_of(p);
  if (scale < 0) return value * m->unit[p];
  return p == PENDRES_DRIVE_FREQUENCY ? value * v[scale] : value / v[scale];
}

/* That of a formula, by its values along a swing. */
static double mean_stiffness(const fit_model *m, const fit_values v, double a)
{
  enum { POINTS = 16 };
  pendres_pendulum p = m->base;
  double sum = 0.0;
  a = fmax(a, 1e-6);
  for (int k = 0; k < PENDRES_FORCE_POWERS; k++) p.force_coefficients[k] = v[PENDRES_A1 + k];
  for (int k = 0; k < POINTS; k++) {
    const double c = cos(two_pi * (k + 0.5) / POINTS);
    double force, slope;
    pendres_model_force(&p, a * c, &force, &slope);
    sum += force * c;
  }
  return sum * 2.0 / (POINTS * a);
}

double pendres_fit_stiffness(const fit_model *m, const fit_values v, double a)
{
  const double sine = a > 1e-6 ? 2.0 * gsl_sf_bessel_J1(fmin(a, 1e3)) / a : 1.0;
  switch (m->base.force) {
  case PENDRES_FORCE_POLYNOMIAL:
    return v[PENDRES_A1] + a * a * (0.75 * v[PENDRES_A3] + 0.625 * a * a * v[PENDRES_A5]);
  case PENDRES_FORCE_SQUID: return sine + v[PENDRES_A1];
  default: return m->base.force < PENDRES_FORCE_FORMULA ? sine : mean_stiffness(m, v, a);
  }
}

void pendres_fit_point_at(const fit_model *m, const fit_curve *c, const fit_values v, double axis,
                          pendres_u u)
{
  u[PENDRES_U_Y] = u[PENDRES_U_W] = 0.0;
  for (int k = 0; k < PENDRES_PARAMETER_FOLLOWED; k++) u[PENDRES_U_OMEGA + k] = v[k];
  u[PENDRES_U_OMEGA + (int)PENDRES_DAMPING] = pendres_fit_damping(m, v);
  if (m->other != PENDRES_PARAMETER_COUNT)
    u[PENDRES_U_OMEGA + (int)m->other] = pendres_fit_in(m, m->other, v, c->other);
  u[pendres_fit_place(m)] = axis;
}

/* How the observable follows from the bases: value, and derivatives by bases and scales. */
static double read(const fit_model *m, const fit_values v, const fit_lane *l,
                   pendres_fit_observable o, double by_base[FIT_BASES], fit_values slope)
{
  const double scale = v[PENDRES_FIT_AMPLITUDE_SCALE], lag = v[PENDRES_FIT_PHASE_OFFSET];
  const double *b = l->base;
  memset(by_base, 0, FIT_BASES * sizeof *by_base);
  memset(slope, 0, sizeof(fit_values));
  switch (o) {
  case PENDRES_FIT_PHASE_LAG:
    by_base[o] = slope[PENDRES_FIT_PHASE_OFFSET] = 1.0;
    return b[o] + lag;
  case PENDRES_FIT_LOOP_AREA:
    by_base[o] = m->area;
    return m->area * b[o];
  case PENDRES_FIT_IN_PHASE:
  case PENDRES_FIT_QUADRATURE: {
    const int second = o == PENDRES_FIT_QUADRATURE;
    const double x = b[PENDRES_FIT_IN_PHASE], y = b[PENDRES_FIT_QUADRATURE];
    const double turned[2] = {x * cos(lag) - y * sin(lag), x * sin(lag) + y * cos(lag)};
    by_base[PENDRES_FIT_IN_PHASE] = scale * (second ? sin(lag) : cos(lag));
    by_base[PENDRES_FIT_QUADRATURE] = scale * (second ? cos(lag) : -sin(lag));
    slope[PENDRES_FIT_AMPLITUDE_SCALE] = turned[second];
    slope[PENDRES_FIT_PHASE_OFFSET] = scale * (second ? turned[0] : -turned[1]);
    const int back = second ? PENDRES_FIT_BACKGROUND_QUADRATURE : PENDRES_FIT_BACKGROUND_IN_PHASE;
    slope[back] = 1.0;
    return scale * turned[second] + v[back];
  }
  default:
    by_base[o] = scale;
    slope[PENDRES_FIT_AMPLITUDE_SCALE] = b[o];
    slope[PENDRES_FIT_OFFSET] = 1.0;
    return scale * b[o] + v[PENDRES_FIT_OFFSET];
  }
}

/* Derivative of a parameter by its scale where it follows from the data. */
static double by_scale(pendres_parameter p, const fit_values v, const fit_lane *l)
{
  const double value = l->u[PENDRES_U_OMEGA + (int)p];
  return p == PENDRES_DRIVE_FREQUENCY ? -value / v[PENDRES_FIT_FREQUENCY_SCALE]
                                      : value / v[scale_of(p)];
}

double pendres_fit_observe(const fit_model *m, const fit_values v, const fit_lane *l,
                           pendres_fit_observable o, int bound, fit_values slope)
{
  double by_base[FIT_BASES], by[PENDRES_PARAMETER_FOLLOWED] = {0.0};
  const int line = pendres_fit_is_line(o);
  const double value = line ? pendres_fit_line_at(m, v, l, o, by, slope)
                            : read(m, v, l, o, by_base, slope);
  for (int k = 0; k < m->parameters && !line; k++)
    for (int b = 0; b < FIT_BASES; b++)
      if (by_base[b] != 0.0) by[m->parameter[k]] += by_base[b] * l->slope[b][m->parameter[k]];
  for (int k = 0; k < m->parameters; k++) {
    const int q = m->parameter[k];
    if (q != (int)m->axis && q != (int)m->other) slope[q] += by[q];
  }
  if (m->lines) pendres_fit_by_q(m, v, by, slope);
  if (bound && scale_of(m->axis) >= 0)
    slope[scale_of(m->axis)] += by[m->axis] * by_scale(m->axis, v, l);
  if (m->other != PENDRES_PARAMETER_COUNT && scale_of(m->other) >= 0)
    slope[scale_of(m->other)] += by[m->other] * by_scale(m->other, v, l);
  if (m->decays) {
    const double by_y = by_base[PENDRES_FIT_DISPLACEMENT];
    slope[PENDRES_FIT_START_DISPLACEMENT] = by_y * l->start_slope[0];
    slope[PENDRES_FIT_START_VELOCITY] = by_y * l->start_slope[1];
    slope[PENDRES_FIT_FREQUENCY_SCALE] = by_y * l->time_slope / v[PENDRES_FIT_FREQUENCY_SCALE];
  }
  return value;
}

double pendres_fit_place_at(const fit_model *m, const fit_values v, const fit_lane *l,
                            fit_values slope)
{
  const double value = pendres_fit_out(m, m->axis, v, l->u[pendres_fit_place(m)]);
  const double out = pendres_fit_out(m, m->axis, v, 1.0); /* the data's unit */
  const int scale = scale_of(m->axis);
  memset(slope, 0, sizeof(fit_values));
  for (int k = 0; k < m->parameters; k++) {
    const int q = m->parameter[k];
    if (q != (int)m->axis && q != (int)m->other) slope[q] = out * l->axis_slope[q];
  }
  if (m->other != PENDRES_PARAMETER_COUNT && scale_of(m->other) >= 0)
    slope[scale_of(m->other)] = out * l->axis_slope[m->other] * by_scale(m->other, v, l);
  if (scale >= 0)
    slope[scale] += (m->axis == PENDRES_DRIVE_FREQUENCY ? value : -value) / v[scale];
  slope[PENDRES_FIT_PHASE_OFFSET] = out * l->axis_by_lag;
  return value;
}

/* ---- data ---- */

/* Data by the other parameter, direction and axis in that direction, then by number. */
typedef struct sorted {
  const pendres_fit_datum *of;
  double other;
  size_t index;
} sorted;

static int in_order(const void *a, const void *b)
{
  const sorted *p = a, *q = b;
  if (p->other != q->other) return p->other < q->other ? -1 : 1;
  if (p->of->direction != q->of->direction) return p->of->direction > q->of->direction ? -1 : 1;
  /* Places come behind the stations of their sweep. */
  const int is_place = pendres_fit_is_place(p->of->observable);
  if (is_place != pendres_fit_is_place(q->of->observable)) return is_place ? 1 : -1;
  if (p->of->axis != q->of->axis && !is_place)
    return (p->of->axis < q->of->axis) == (p->of->direction > 0) ? -1 : 1;
  return p->index < q->index ? -1 : p->index > q->index;
}

/* Put one more datum behind those that are there. */
static void append(fit_model *m, const sorted *s, size_t k)
{
  const int curve = m->curves == 0 || m->curve[m->curves - 1].other != s->other;
  const int is_place = pendres_fit_is_place(s->of->observable);
  const double axis = is_place ? s->of->observed : s->of->axis;
  if (curve) m->curve[m->curves++] = (fit_curve){.other = s->other, .from = axis, .to = axis};
  const int track =
    curve || m->track[m->tracks - 1].direction != s->of->direction;
  if (track)
    m->track[m->tracks++] = (fit_track){.curve = m->curves - 1, .direction = s->of->direction,
                                        .first = m->stations};
  const int station = !is_place && (track || m->station[m->stations - 1].axis != axis);
  if (is_place) {
    m->mark[m->marks++] = (fit_mark){.track = m->tracks - 1, .datum = s->index};
    m->curve[m->curves - 1].marked = 1;
    m->curve[m->curves - 1].tuned |= s->of->observable == PENDRES_FIT_RESONANCE;
  } else if (station) {
    m->station[m->stations++] = (fit_station){.axis = axis, .first = k};
    m->track[m->tracks - 1].count++;
  }
  if (!is_place) m->station[m->stations - 1].count++;
  m->order[k] = s->index;
  m->measured[s->of->observable] = 1;
  fit_curve *c = &m->curve[m->curves - 1];
  c->from = fmin(c->from, axis);
  c->to = fmax(c->to, axis);
}

static size_t count_curves(size_t n, const sorted *s)
{
  size_t curves = n > 0;
  for (size_t k = 1; k < n; k++) curves += s[k].other != s[k - 1].other;
  return curves;
}

/* The middle of the data's frequencies. */
static void set_middle(fit_model *m)
{
  double low = INFINITY, high = -INFINITY;
  for (size_t i = 0; i < m->data; i++) {
    const double f = m->other == PENDRES_DRIVE_FREQUENCY ? m->datum[i].other : m->datum[i].axis;
    low = fmin(low, f);
    high = fmax(high, f);
  }
  m->middle = 0.5 * (low + high);
}

pendres_status pendres_fit_model_begin(fit_model *m, pendres_room *room,
                                       const pendres_fit_data *data)
{
  const size_t n = data->n;
  sorted *s = pendres_room_take(room, n, sizeof *s);
  if (room->status != PENDRES_OK) return room->status;
  m->data = n;
  m->datum = data->datum;
  m->axis = data->axis;
  m->decays = data->axis == PENDRES_PARAMETER_COUNT;
  m->rotates = data->datum[0].observable == PENDRES_FIT_MEAN_VELOCITY;
  m->lines = pendres_fit_is_line(data->datum[0].observable);
  m->other = data->other;
  for (size_t k = 0; k < n; k++)
    s[k] = (sorted){&data->datum[k],
                    m->other != PENDRES_PARAMETER_COUNT ? data->datum[k].other : 0.0, k};
  qsort(s, n, sizeof *s, in_order);
  const size_t curves = count_curves(n, s);
  m->order = pendres_room_take(room, n, sizeof *m->order);
  m->curve = pendres_room_take(room, curves, sizeof *m->curve);
  m->track = pendres_room_take(room, 2 * curves, sizeof *m->track);
  m->station = pendres_room_take(room, n, sizeof *m->station);
  m->mark = pendres_room_take(room, n, sizeof *m->mark);
  if (room->status != PENDRES_OK) return room->status;
  for (size_t k = 0; k < n; k++) append(m, &s[k], k);
  double widest = 0.0;
  set_middle(m);
  for (size_t c = 0; c < curves; c++) widest = fmax(widest, m->curve[c].to - m->curve[c].from);
  for (size_t c = 0; c < curves; c++) {
    fit_curve *curve = &m->curve[c];
    curve->span = widest > 0.0 ? widest : fmax(0.1 * fabs(curve->to), 1e-3);
    curve->node = pendres_room_take(room, FIT_NODES, sizeof *curve->node);
  }
  m->room = n * FIT_STAGES + 2 * curves * FIT_FOLDS;
  m->lane = pendres_room_take(room, m->room, sizeof *m->lane);
  return room->status;
}
