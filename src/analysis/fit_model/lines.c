/* lines.c -- scattering parameters in fits: what they are of lanes, and first values. */
#include "analysis/fit_model/internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"

static int is_imaginary(pendres_fit_observable o)
{
  return (o - PENDRES_FIT_TRANSMISSION_REAL) % 2;
}

/* The frequency of small oscillations. */
static double rate_of(const fit_model *m, const fit_values v)
{
  return sqrt(fabs(pendres_fit_stiffness(m, v, 0.0)));
}

double pendres_fit_damping(const fit_model *m, const fit_values v)
{
  if (!m->lines) return v[PENDRES_DAMPING];
  return rate_of(m, v) * (1.0 / v[PENDRES_FIT_INTERNAL_Q] + 1.0 / v[PENDRES_FIT_COUPLING_Q]);
}

void pendres_fit_by_q(const fit_model *m, const fit_values v,
                      const double by[PENDRES_PARAMETER_FOLLOWED], fit_values slope)
{
  static const int of[] = {PENDRES_FIT_INTERNAL_Q, PENDRES_FIT_COUPLING_Q};
  const double rate = rate_of(m, v);
  for (int k = 0; k < 2; k++)
    slope[of[k]] -= by[PENDRES_DAMPING] * rate / (v[of[k]] * v[of[k]]);
  if (m->base.force != PENDRES_FORCE_PENDULUM)
    slope[PENDRES_A1] += by[PENDRES_DAMPING] * pendres_fit_damping(m, v) / (2.0 * rate * rate);
}

/* ---- at lanes ---- */

static pendres_line line_of(const fit_model *m, const fit_values v, pendres_fit_observable o)
{
  return (pendres_line){
    .kind = pendres_fit_line_kind(o), .coupling = rate_of(m, v) / v[PENDRES_FIT_COUPLING_Q],
    .phase = v[PENDRES_FIT_COUPLING_PHASE], .delay = v[PENDRES_FIT_DELAY],
    .amplitude = v[PENDRES_FIT_BACKGROUND_AMPLITUDE], .angle = v[PENDRES_FIT_BACKGROUND_PHASE],
    .leak = {v[PENDRES_FIT_BACKGROUND_IN_PHASE], v[PENDRES_FIT_BACKGROUND_QUADRATURE]}};
}

double pendres_fit_line_at(const fit_model *m, const fit_values v, const fit_lane *l,
                           pendres_fit_observable o, double by[PENDRES_PARAMETER_FOLLOWED],
                           fit_values slope)
{
  const double f = pendres_fit_out(m, PENDRES_DRIVE_FREQUENCY, v, l->u[PENDRES_U_OMEGA]);
  const double per = pendres_fit_out(m, PENDRES_DRIVE_FREQUENCY, v, 1.0), rate = rate_of(m, v);
  const double q = v[PENDRES_FIT_COUPLING_Q];
  const pendres_line line = line_of(m, v, o);
  const double complex turn = is_imaginary(o) ? -I : 1.0;
  pendres_line_value s;
  pendres_line_measure(&line, &(pendres_line_motion){
    .in_phase = l->base[PENDRES_FIT_IN_PHASE], .quadrature = l->base[PENDRES_FIT_QUADRATURE],
    .drive = l->u[PENDRES_U_DRIVE], .omega = l->u[PENDRES_U_OMEGA],
    .damping = l->u[PENDRES_U_OMEGA + (int)PENDRES_DAMPING], .from_middle = f - m->middle}, &s);
  memset(slope, 0, sizeof(fit_values));
  for (int k = 0; k < m->parameters; k++) {
    const int p = m->parameter[k];
    double complex d = s.by_in_phase * l->slope[PENDRES_FIT_IN_PHASE][p] +
                       s.by_quadrature * l->slope[PENDRES_FIT_QUADRATURE][p];
    if (p == (int)PENDRES_DRIVE_FREQUENCY) d += s.by_omega;
    if (p == (int)PENDRES_DRIVE_AMPLITUDE) d += s.by_drive;
    if (p == (int)PENDRES_DAMPING) d += s.by_damping;
    /* Where a state ends it is the axis that moves. */
    if (m->axis == PENDRES_DRIVE_FREQUENCY)
      d += l->axis_slope[p] * (s.by_omega + per * s.by_from_middle);
    if (m->axis == PENDRES_DRIVE_AMPLITUDE) d += l->axis_slope[p] * s.by_drive;
    by[p] = creal(turn * d);
  }
  slope[PENDRES_FIT_COUPLING_Q] = -creal(turn * s.by_coupling) * rate / (q * q);
  slope[PENDRES_FIT_COUPLING_PHASE] = creal(turn * s.by_phase);
  slope[PENDRES_FIT_DELAY] = creal(turn * s.by_delay);
  slope[PENDRES_FIT_BACKGROUND_AMPLITUDE] = creal(turn * s.by_amplitude);
  slope[PENDRES_FIT_BACKGROUND_PHASE] = creal(turn * s.by_angle);
  slope[PENDRES_FIT_BACKGROUND_IN_PHASE] = creal(turn * s.by_leak[0]);
  slope[PENDRES_FIT_BACKGROUND_QUADRATURE] = creal(turn * s.by_leak[1]);
  if (m->base.force != PENDRES_FORCE_PENDULUM)
    slope[PENDRES_A1] = creal(turn * s.by_coupling) * line.coupling / (2.0 * rate * rate);
  return creal(turn * s.s);
}

/* ---- first values ---- */

/* The data as complex numbers, with the drives relative to the largest. 0: some lack a part. */
static void look(const fit_model *m, const fit_values v, double *f, double *drive,
                 double complex *s, size_t *n)
{
  double largest = 0.0;
  *n = 0;
  for (size_t k = 0; k < m->tracks; k++)
    for (size_t i = m->track[k].first; i < m->track[k].first + m->track[k].count; i++) {
      const fit_station *at = &m->station[i];
      const double other = m->curve[m->track[k].curve].other;
      double part[2] = {NAN, NAN};
      for (size_t j = at->first; j < at->first + at->count; j++) {
        const pendres_fit_datum *d = &m->datum[m->order[j]];
        part[is_imaginary(d->observable)] = d->observed;
      }
      if (isnan(part[0] + part[1])) continue;
      s[*n] = part[0] + I * part[1];
      f[*n] = (m->other == PENDRES_DRIVE_FREQUENCY ? other : at->axis) - m->middle;
      drive[*n] = m->axis == PENDRES_DRIVE_AMPLITUDE    ? at->axis
                  : m->other == PENDRES_DRIVE_AMPLITUDE ? other
                                                        : v[PENDRES_DRIVE_AMPLITUDE];
      if (isnan(drive[*n])) drive[*n] = 1.0;
      largest = fmax(largest, fabs(drive[(*n)++]));
    }
  for (size_t i = 0; i < *n && largest > 0.0; i++) drive[i] /= largest;
}

/* The largest drive in the data's unit; NaN: it is not known. */
static double largest_drive(const fit_model *m, const fit_values v)
{
  double largest = 0.0;
  if (m->axis != PENDRES_DRIVE_AMPLITUDE && m->other != PENDRES_DRIVE_AMPLITUDE)
    return v[PENDRES_DRIVE_AMPLITUDE];
  for (size_t i = 0; i < m->data; i++)
    largest = fmax(largest, fabs(m->axis == PENDRES_DRIVE_AMPLITUDE ? m->datum[i].axis
                                                                    : m->datum[i].other));
  return largest;
}

static void set(fit_values v, int q, double value)
{
  if (isnan(v[q])) v[q] = value;
}

/* How strongly the force bends the resonance, and the drive: bend is a3 times the square of the
   latter. Where the force is known the drive follows, and otherwise the force. */
static void set_bend(const fit_model *m, double bend, double damping, fit_values v)
{
  const int scaled = m->axis == PENDRES_DRIVE_AMPLITUDE || m->other == PENDRES_DRIVE_AMPLITUDE;
  const int drive = scaled ? (int)PENDRES_FIT_DRIVE_SCALE : (int)PENDRES_DRIVE_AMPLITUDE;
  const double known = largest_drive(m, v), unit = scaled ? known : 1.0;
  const int polynomial = m->base.force == PENDRES_FORCE_POLYNOMIAL;
  if (isnan(v[drive]) && isnan(v[PENDRES_A3])) v[drive] = damping / unit;
  const double cubic = polynomial ? v[PENDRES_A3] : -1.0 / 6.0;
  if (isnan(v[drive]))
    v[drive] = sqrt(fmax(bend / cubic, fit_line_straight * pow(damping, 3.0) / fabs(cubic))) / unit;
  const double force = v[drive] * unit;
  if (isnan(v[PENDRES_A3])) v[PENDRES_A3] = bend / (force * force);
}

static void take(const fit_model *m, pendres_fit_observable o, const pendres_line_guess *g,
                 fit_values v)
{
  const int passes = pendres_fit_line_kind(o) == PENDRES_LINE_TRANSMISSION;
  const double place = m->middle + creal(g->place), width = 2.0 * cimag(g->place);
  const double q = place / width;
  const int polynomial = m->base.force == PENDRES_FORCE_POLYNOMIAL, bends = isnan(v[PENDRES_A3]);
  const double complex far = passes ? g->residue * 2.0 * I / width : g->far;
  set(v, PENDRES_FIT_DELAY, g->delay);
  set(v, PENDRES_FIT_BACKGROUND_AMPLITUDE, cabs(far));
  set(v, PENDRES_FIT_BACKGROUND_PHASE, carg(far));
  set(v, PENDRES_FIT_BACKGROUND_IN_PHASE, passes ? creal(g->far / far) : 0.0);
  set(v, PENDRES_FIT_BACKGROUND_QUADRATURE, passes ? cimag(g->far / far) : 0.0);
  if (bends) v[PENDRES_A3] = 0.0;
  if (isnan(v[PENDRES_FIT_FREQUENCY_SCALE])) set(v, PENDRES_A1, polynomial);
  set(v, PENDRES_A1, pow(place / v[PENDRES_FIT_FREQUENCY_SCALE], 2.0));
  set(v, PENDRES_FIT_FREQUENCY_SCALE, place / rate_of(m, v));
  const double times = pendres_fit_line_kind(o) == PENDRES_LINE_REFLECTION ? 2.0 : 1.0;
  const double complex share = g->residue * 2.0 / (I * width * times * g->far);
  const double part = fmin(fmax(creal(share), fit_line_share), 1.0 - fit_line_share);
  set(v, PENDRES_FIT_COUPLING_Q, passes ? INFINITY : q / part);
  set(v, PENDRES_FIT_COUPLING_PHASE, passes ? 0.0 : atan(cimag(share) / part));
  set(v, PENDRES_FIT_INTERNAL_Q, 1.0 / fmax(1.0 / q - 1.0 / v[PENDRES_FIT_COUPLING_Q],
                                             fit_line_share / q));
  for (int k = PENDRES_A1; k <= (int)PENDRES_A5; k++) set(v, k, 0.0);
  const double damping = pendres_fit_damping(m, v), height = 2.0 * cabs(g->residue) / width;
  const double shift = g->bend * height * height / place; /* of the largest amplitude */
  const double rate = rate_of(m, v);
  if (bends) v[PENDRES_A3] = NAN;
  set_bend(m, 8.0 / 3.0 * shift * pow(rate * rate * damping, 2.0), damping, v);
}

int pendres_fit_line_guess(const fit_model *m, const fit_values v, fit_values out[FIT_GUESSES])
{
  pendres_line_guess found[2];
  const pendres_fit_observable o = m->datum[0].observable;
  const size_t most = m->stations > 0 ? m->stations : 1;
  double *f = malloc(most * sizeof *f), *drive = malloc(most * sizeof *drive);
  double complex *s = malloc(2 * most * sizeof *s);
  int count = -1;
  if (f != NULL && drive != NULL && s != NULL) {
    pendres_line_data d = {.f = f, .drive = drive, .s = s, .work = s + most};
    look(m, v, f, drive, s, &d.n);
    const int leaks = isnan(v[PENDRES_FIT_BACKGROUND_IN_PHASE]) ||
                      isnan(v[PENDRES_FIT_BACKGROUND_QUADRATURE]);
    count = pendres_line_find(&d, pendres_fit_line_kind(o), leaks, v[PENDRES_FIT_DELAY], found);
  }
  for (int k = 0; k < count; k++) {
    memcpy(out[k], v, sizeof(fit_values));
    take(m, o, &found[k], out[k]);
  }
  free(f);
  free(drive);
  free(s);
  return count;
}
