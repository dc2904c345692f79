/*
 * response_sampling.c -- the sampling error of an ensemble; see response_parts.h.
 *
 * Shares of states are off by their sampling errors; half of the sum of these is the share of
 * members that would have to change their state. What such members do to a mean is bounded by the
 * states that differ most, as for members that are uncertain.
 */

#include <math.h>

#include "analysis/resonance/numbers.h"
#include "base/angles.h"
#include "base/student.h"
#include "analysis/resonance/response_parts.h"

/*
 * The error of a share if `on` of `members` independent starts are on a state. One more is counted
 * on the state and one more off it (rule of succession): a share of 0 is not exact because none was
 * found.
 */
static double random_error(double on, double members)
{
  const double share = (on + 1.0) / (members + 2.0);
  return sampling_claimed * sqrt(share * (1.0 - share) / (members + 2.0));
}

/* Count the members of a row that are on the state, and the ends of stretches of them. */
static double count_row(const signed char *row, size_t columns, int state, double *ends)
{
  double on = 0.0;
  for (size_t k = 0; k < columns; k++) {
    on += row[k] == state;
    if (k > 0) *ends += (row[k] == state) != (row[k - 1] == state);
  }
  return on / (double)columns;
}

/*
 * The error of a share for starts in a rectangle, estimated like that of a basin
 * (analysis/basins/statistics.c): rows scatter around their trend, which second differences
 * remove; at the least, each end of a stretch in a row is uncertain by a uniform share of a step.
 * Where rows are too few, it is half of their largest difference.
 */
static double rectangle_error(const pendres_ensemble *e, const signed char *where, int state)
{
  const size_t columns = e->members / e->rows;
  const double n = (double)e->rows;
  double ends = 0.0, square = 0.0, last[2] = {0.0}, least = 1.0, most = 0.0;
  for (size_t i = 0; i < e->rows; i++) {
    const double share = count_row(where + i * columns, columns, state, &ends);
    const double bend = share - 2.0 * last[0] + last[1];
    if (i >= 2) square += bend * bend;
    last[1] = last[0];
    last[0] = share;
    least = fmin(least, share);
    most = fmax(most, share);
  }
  const double floor = sampling_claimed * sqrt((ends + 1.0) / 12.0) / (double)e->members;
  if (e->rows < 4) return floor + 0.5 * (most - least);
  const double student = pendres_student(PENDRES_ONE_SIGMA, (n - 2.0) * 18.0 / 35.0);
  return fmax(floor, sampling_claimed * student * sqrt(square / (6.0 * n * (n - 2.0))));
}

/* States that differ most, and the length of the mean first harmonic. */
typedef struct spread {
  double least, most, widest, length, loops;
} spread;

static spread spread_of(const pendres_response *r)
{
  spread s = {.least = INFINITY, .most = -INFINITY};
  double cosine = 0.0, sine = 0.0;
  for (size_t i = 0; i < r->states && i < PENDRES_RESPONSE_STATES; i++) {
    const pendres_attractor *a = &r->state[i];
    const double members = (double)r->state_members[i];
    s.least = fmin(s.least, a->orbit.loop_area);
    s.most = fmax(s.most, a->orbit.loop_area);
    if (!pendres_response_running(a)) s.widest = fmax(s.widest, a->orbit.amplitude);
    if (!pendres_response_has_loop(a)) continue;
    s.loops += members;
    cosine += members * a->orbit.cosine[0];
    sine += members * a->orbit.sine[0];
  }
  s.length = hypot(cosine, sine);
  return s;
}

void pendres_response_widen(pendres_response *r, double sampling)
{
  const spread s = spread_of(r);
  r->sampling = sampling;
  r->sa_fraction_error += sampling;
  r->la_fraction_error += sampling;
  if (r->states < 2) return; /* whatever the sample, its means are those of the one state */
  r->mean_loop_area_error += sampling * (s.most - s.least);
  r->mean_power_error += sampling * (s.most - s.least) * r->pendulum.drive_frequency / two_pi;
  r->mean_amplitude_error += sampling * s.widest;
  r->mean_loop_amplitude_error += 2.0 * sampling * s.widest;
  r->phase_lag_error += 2.0 * sampling * s.widest * s.loops / s.length;
}

void pendres_response_sample(const pendres_ensemble *e, const signed char *where,
                             pendres_response *r)
{
  double sum = 0.0;
  for (size_t i = 0; i < r->states && i < PENDRES_RESPONSE_STATES; i++)
    sum += e->shape == PENDRES_ENSEMBLE_RANDOM
             ? random_error((double)r->state_members[i], (double)e->members)
             : rectangle_error(e, where, (int)i);
  /* Each member that is missing on one state is on another one, and so counted twice, unless there
     is only one state. */
  pendres_response_widen(r, r->states > 1 ? 0.5 * sum : sum);
}
