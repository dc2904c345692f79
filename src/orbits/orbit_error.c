/* orbit_error.c -- errors of orbits from two computations; see orbit_error.h. */
#include "orbits/orbit_error.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/angles.h"
#include "engine/kernels/coordinates.h"
#include "model/equation.h"
#include "model/model.h"
#include "orbits/numbers.h"
#include "orbits/orbit_newton.h"
#include "orbits/orbit_table.h"

/*
 * With 1.4 times the steps the error of a method of order 8 falls to a fifteenth. A quarter of a
 * value's own difference is claimed, since errors may not fall that fast yet, and in addition what
 * an eighth of the difference of the whole orbits could make.
 */
double pendres_orbit_error(double coarse, double fine, double sensitivity,
                           const pendres_orbit_uncertainty *uncertainty)
{
  return claimed_share * fabs(fine - coarse) +
         sensitivity * (orbit_whole_share * uncertainty->apart + uncertainty->rounding);
}

/*
 * An orbit about the top has the mean pi by symmetry. The sign of the error of that mean must not
 * decide to which well the orbit belongs.
 */
static long turns_of_mean(const pendres_pendulum *p, double mean)
{
  long turns = 0;
  double inside = mean;
  pendres_coordinates_wrap(p, &inside, &turns);
  return inside <= orbit_tie - pi && pendres_model_of(p->force)->period > 0.0 ? turns - 1 : turns;
}

/* The values of the table's measures and their errors. */
static void set_rows(const pendres_orbit_measures *a, const pendres_orbit_measures *b,
                     const pendres_orbit_uncertainty *uncertainty, pendres_orbit *o)
{
  const pendres_orbit_row *row;
  for (size_t k = 0; (row = pendres_orbit_row_get(k)) != NULL; k++) {
    const pendres_orbit_value *fine = &b->of[k];
    double coarse = a->of[k].value, *error = pendres_orbit_row_error(row, o);
    if (row->measure == NULL) continue;
    *pendres_orbit_row_value(row, o) = fine->value;
    if (error == NULL) continue;
    if (row->angle) coarse = fine->value + remainder(coarse - fine->value, two_pi);
    *error =
      pendres_orbit_error(coarse, fine->value, fine->sensitivity, uncertainty) + fine->unresolved;
  }
}

/*
 * Whether an orbit is its own mirror image: harmonics that the symmetry forbids are missing, and
 * the mean is at the centre. Of a pendulum the former is enough: what swings to both sides alike
 * swings about a bottom or a top, which all are centres.
 */
static int is_symmetric(const pendres_orbit_measures *a, const pendres_orbit_measures *b,
                        const pendres_orbit_uncertainty *uncertainty, const pendres_orbit *o)
{
  const double nothing = orbit_no_harmonic * fmax(1.0, b->amplitude);
  if (o->winding != 0 || !pendres_pendulum_symmetric(&o->pendulum)) return 0;
  if (!(b->symmetry_defect <= nothing)) return 0;
  if (pendres_model_of(o->pendulum.force)->period > 0.0) return 1;
  const double centre = pendres_model_centre(&o->pendulum, b->mean_angle);
  return fabs(b->mean_angle - centre) <=
         nothing + pendres_orbit_error(a->mean_angle, b->mean_angle, 1.0, uncertainty);
}

/* Everything but the point, the multipliers and the slopes. Returns the whole turns by which the
   orbit's mean lies outside of well 0. */
static long set_measures(const pendres_orbit_measures *a, const pendres_orbit_measures *b,
                         const pendres_orbit_uncertainty *uncertainty, pendres_orbit *o)
{
  const pendres_pendulum *p = &o->pendulum;
  const double omega = p->drive_frequency;
  const long turns = turns_of_mean(p, b->mean_angle);

  set_rows(a, b, uncertainty, o);
  o->mean_angle = b->mean_angle - two_pi * (double)turns;
  /* What the drives and the torque give is dissipated. A difference is an error of one of the two
     at least. */
  const double given = o->loop_area + o->torque_work + o->parametric_work;
  const double balance = 0.5 * fabs(given - o->dissipation);
  if (p->parametric_amplitude != 0.0)
    o->parametric_work_error = fmax(o->parametric_work_error, balance);
  o->loop_area_error = fmax(o->loop_area_error, balance);
  o->dissipation_error = fmax(o->dissipation_error, balance);
  o->mean_power = o->loop_area * omega / two_pi;
  o->mean_power_error = o->loop_area_error * omega / two_pi;
  memcpy(o->cosine, b->cosine, sizeof o->cosine);
  memcpy(o->sine, b->sine, sizeof o->sine);
  o->harmonics_rest = b->harmonics_rest;
  o->symmetric = is_symmetric(a, b, uncertainty, o);
  return turns;
}

static double norm_of(const double m[2][2])
{
  return hypot(hypot(m[0][0], m[0][1]), hypot(m[1][0], m[1][1]));
}

double pendres_orbit_apart_beside(const pendres_orbit_computed *coarse,
                                  const pendres_orbit_computed *fine, const double from[2])
{
  const double (*by)[2][2] = coarse->m_by;
  double squares = 0.0;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      /* Less what they differ by because they were taken at two points. */
      const double moved = by[0][i][j] * from[0] + by[1][i][j] * from[1];
      const double off = fmax(0.0, fabs(fine->m[i][j] - coarse->m[i][j]) - fabs(moved));
      squares += off * off;
    }
  const double size = fine->measures.amplitude, bends = coarse->measures.bends;
  const double way = norm_of(fine->m) / hypot(norm_of(by[0]), norm_of(by[1]));
  double reach = orbit_beside_share * fmin(size, way);
  /* Where |v| bends, errors go up and down as that place passes from one step to the next. */
  if (bends > 0.0) reach = fmin(reach, bends * size);
  return reach * sqrt(squares) * pendres_newton_share(fine->m);
}

/* The derivative of the map at the finer computation's point. Returns its relative error by
   rounding, and by the way there from where it was taken: the next term, as of an exponential, and
   the error of the difference quotients. */
static double matrix_at(const pendres_orbit_twice *two, double m[2][2])
{
  const pendres_orbit_computed *fine = two->fine;
  const double (*by)[2][2] = two->coarse->m_by, *off = fine->off;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++)
      m[i][j] = fine->m[i][j] + by[0][i][j] * off[0] + by[1][i][j] * off[1];
  const double by_y = norm_of(by[0]), by_w = norm_of(by[1]);
  const double size = fmax(norm_of(fine->m), DBL_MIN);
  const double change = (by_y * fabs(off[0]) + by_w * fabs(off[1])) / size;
  return newton_matrix * two->rounding +
         0.5 * change * (change + newton_aside * hypot(by_y, by_w) / size);
}

/* The size of the entries, of the two off the diagonal in units in which they are equal. */
static double size_of(const double (*m)[2])
{
  return fmax(fmax(fabs(m[0][0]), fabs(m[1][1])), sqrt(fabs(m[0][1] * m[1][0])));
}

/* The error of the trace. Its two parts are looked at one by one, since their sum may agree by
   chance. With few steps both parts may agree by chance: then the entries off the diagonal tell, in
   units in which they are equal. left: the relative error of entries beside what steps leave. */
static double trace_error_of(const pendres_orbit_twice *two, const double (*m)[2], double left)
{
  const double (*coarse)[2] = two->coarse->m, (*by)[2][2] = two->coarse->m_by;
  const pendres_orbit_uncertainty *uncertainty = &two->at_start;
  const double upper = m[0][0] - coarse[0][0], lower = m[1][1] - coarse[1][1];
  const double bend = hypot(by[0][0][0] + by[0][1][1], by[1][0][0] + by[1][1][1]);
  const double across = sqrt(fabs((m[0][1] - coarse[0][1]) * (m[1][0] - coarse[1][0])));
  return 0.3 * fabs(upper + lower) + 0.3 * (fabs(upper) + fabs(lower)) + 0.04 * across +
         bend * (0.1 * uncertainty->apart + uncertainty->rounding) + left * size_of(m);
}

/* Monodromy matrix, multipliers and their error. */
static void set_spectrum(const pendres_orbit_twice *two, pendres_orbit *o)
{
  double m[2][2];
  const double left = matrix_at(two, m), omega = o->pendulum.drive_frequency;
  const double trace = m[0][0] + m[1][1], determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
  const pendres_orbit_value *few = &two->coarse->measures.contraction;
  const pendres_orbit_value *rate = &two->fine->measures.contraction;
  const double half = o->period * pi / omega;
  const double modulus =
    pendres_equation_left(rate->value * o->period * pi / omega, sqrt(fabs(determinant)));
  double trace_error = trace_error_of(two, (const double (*)[2])m, left);
  /* Of the modulus, as a share of it. */
  const double loose =
    isnan(rate->value)
      ? trace_error * size_of((const double (*)[2])m) / fmax(fabs(determinant), 1e-300)
      : half * pendres_orbit_error(few->value, rate->value, rate->sensitivity, &two->along);

  o->monodromy[0][0] = m[0][0];
  o->monodromy[0][1] = m[0][1] / omega;
  o->monodromy[1][0] = m[1][0] * omega;
  o->monodromy[1][1] = m[1][1];
  pendres_orbit_set_multipliers(trace, modulus, o);
  /* The determinant follows from the contraction (Liouville). What the computed one is off by tells
     the error of the entries, and the trace is known no better. */
  const double off =
    0.5 * fabs(determinant - modulus * modulus) / (2.0 * size_of((const double (*)[2])m));
  if (off > trace_error) trace_error = off;
  if (two->fine->measures.bends > 0.0) trace_error *= orbit_bent_trace;
  /* The trace's error moves a multiplier mu by trace' mu / (mu - other); where two meet they move
     with the square root. */
  const double size = hypot(o->multiplier_re[0], o->multiplier_im[0]);
  const double gap = hypot(o->multiplier_re[0] - o->multiplier_re[1],
                           o->multiplier_im[0] - o->multiplier_im[1]);
  o->multiplier_error =
    fmin(trace_error * size / fmax(gap, 1e-300), sqrt(trace_error) + trace_error) +
    modulus * fmin(2.0 * modulus * loose / fmax(gap, 1e-300) + loose, sqrt(loose) + loose);
}

/* What Newton's last step, a linear one, leaves of the orbit's start: terms of second order, and
   half as much again, since terms of third order follow. */
static void left_over(const pendres_orbit_twice *two, double left[2])
{
  const double *off = two->fine->off;
  double bent[2] = {0.0, 0.0};
  left[0] = left[1] = 0.0;
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < 2; i++)
      for (int j = 0; j < 2; j++) bent[i] += 0.5 * two->coarse->m_by[k][i][j] * off[k] * off[j];
  (void)pendres_newton_solve(two->fine->m, bent, left, NULL);
  for (int i = 0; i < 2; i++) left[i] = orbit_left_over * fabs(left[i]);
}

/* The Poincaré point and its errors. turns: whole turns by which the orbit's mean lies outside of
   well 0. */
static void set_point(const pendres_orbit_twice *two, long turns, pendres_orbit *o)
{
  const double omega = o->pendulum.drive_frequency;
  const pendres_orbit_uncertainty *uncertainty = &two->at_start;
  const pendres_orbit_computed *coarse = two->coarse, *fine = two->fine;
  const pendres_coordinates s = {.y = fine->y, .w = fine->w, .turns = -turns};
  double left[2];
  left_over(two, left);
  pendres_coordinates_out(&o->pendulum, &s, &o->x, &o->v);
  /* x itself is a double, and half of pi is none. */
  o->x_error = pendres_orbit_error(coarse->y, fine->y, 1.0, uncertainty) + left[0] +
               0.5 * DBL_EPSILON * (fabs(o->x) + half_pi);
  /* Errors by rounding swing between y and v: below omega = 1, v has those of y. */
  const double w_error = pendres_orbit_error(coarse->w, fine->w, 1.0, uncertainty) + left[1];
  o->v_error = omega * w_error + fmax(0.0, 1.0 - omega) * uncertainty->rounding;
}

void pendres_orbit_set(const pendres_orbit_twice *two, pendres_orbit *o)
{
  memset(o, 0, sizeof *o);
  o->pendulum = two->pendulum;
  o->period = two->period;
  o->winding = two->winding;
  o->steps = two->steps;
  /* The mean angle belongs into well 0. */
  const long turns = set_measures(&two->coarse->measures, &two->fine->measures, &two->along, o);
  /* What moves by rounding alone may be faster than rounding of its place tells, by the ratio of
     its own frequency to the drive's; but all that it is seen to dissipate is an error. */
  if (two->rests) o->dissipation_error = fmax(o->dissipation_error, 2.0 * o->dissipation);
  set_point(two, turns, o);
  set_spectrum(two, o);
  o->frequency_derivative[0] = o->frequency_derivative[1] = NAN;
  o->loop_area_slope = o->loop_area_slope_error = NAN;
}
