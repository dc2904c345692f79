/*
 * rotation_fixture.h -- a junction whose rotations are looked at, and their mean velocities by an
 * integrator of the tests' own.
 */
#ifndef PENDRES_TESTS_ROTATION_FIXTURE_H
#define PENDRES_TESTS_ROTATION_FIXTURE_H

#include <math.h>

#include <pendres/pendulum.h>

static const double two_pi = 6.28318530717958647693;

/* That of input/josephson.nml. */
static const pendres_pendulum junction = {
  .damping = 0.3, .drive_amplitude = 9.0, .drive_frequency = 3.0};

/* Mean turns a period by Runge and Kutta's method of fourth order with so many steps: with the
   weights of smooth averages, which leave 1e-12 after so many periods where no lock is near. */
static double work_by_hand(const pendres_pendulum *p, int steps, int periods, double *work)
{
  const double h = two_pi / p->drive_frequency / steps;
  double y = 0.0, v = p->torque / p->damping, sum = 0.0, weights = 0.0, works = 0.0;
  for (int k = -80; k < periods; k++) {
    const double from = y;
    double done = 0.0;
    for (int i = 0; i < steps; i++) {
      double dy[4], dv[4];
      done += h * v * p->drive_amplitude * cos(p->drive_frequency * i * h);
      for (int s = 0; s < 4; s++) {
        const double part = s == 0 ? 0.0 : s == 3 ? h : 0.5 * h;
        const double at = y + (s > 0 ? part * dy[s - 1] : 0.0);
        dy[s] = v + (s > 0 ? part * dv[s - 1] : 0.0);
        const double drive = cos(p->drive_frequency * (i * h + part));
        dv[s] = p->torque + p->drive_amplitude * drive -
                (1.0 + p->parametric_amplitude * drive) * sin(at) - p->damping * dy[s];
      }
      y += h / 6.0 * (dy[0] + 2.0 * (dy[1] + dy[2]) + dy[3]);
      v += h / 6.0 * (dv[0] + 2.0 * (dv[1] + dv[2]) + dv[3]);
    }
    const double turned = (y - from) / two_pi;
    y -= two_pi * floor(y / two_pi);
    if (k < 0) continue;
    const double t = (k + 0.5) / periods, weight = exp(-1.0 / (t * (1.0 - t)));
    sum += weight * turned;
    works += weight * done;
    weights += weight;
  }
  *work = works / weights;
  return sum / weights;
}

static inline double by_hand(const pendres_pendulum *p, int steps, int periods)
{
  double work;
  return work_by_hand(p, steps, periods, &work);
}

#endif
