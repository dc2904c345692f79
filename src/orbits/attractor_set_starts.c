/* attractor_set_starts.c -- the default initial guesses; see
   attractor_set.h. */
#include "orbits/attractor_set.h"

#include <math.h>

#include "base/angles.h"
#include "model/model.h"

/* Positions across the turn of a pendulum, or across a well, each at rest and moving either way. */
enum { ACROSS = 12, MOST_WELLS = (PENDRES_ATTRACTOR_SET_STARTS / (3 * ACROSS)) - 1 };
/* Wells are looked for this far, in the units of length of a force, and so finely. */
enum { FAR = 8, FINENESS = 64, POINTS = 2 * FAR * FINENESS + 1 };

static double place(int i)
{
  return (double)(i - FAR * FINENESS) / FINENESS;
}

/* Where the potential, going from point i one way, first turns down again; -1: nowhere. */
static int barrier(const double u[POINTS], int i, int step)
{
  int k = i;
  while (k + step >= 0 && k + step < POINTS && u[k + step] >= u[k]) k += step;
  return k + step >= 0 && k + step < POINTS ? k : -1;
}

/* Starts in the well about point i: across it where it is as deep as its lower barrier, at up to
   seven tenths of the speed that leads over that. Returns their number: 0 without any barrier. */
static size_t in_well(const pendres_pendulum *p, const double u[POINTS], int i, double *x,
                      double *v)
{
  const int left = barrier(u, i, -1), right = barrier(u, i, 1);
  if (left < 0 && right < 0) return 0;
  const double top = fmin(left >= 0 ? u[left] : INFINITY, right >= 0 ? u[right] : INFINITY);
  int low = i, high = i;
  while (low > 0 && low != left && u[low - 1] < top) low--;
  while (high + 1 < POINTS && high != right && u[high + 1] < top) high++;
  size_t n = 0;
  for (int k = 0; k < ACROSS; k++) {
    const double part = (k + 0.5) / ACROSS;
    const double y = place(low) + part * (place(high) - place(low));
    const double at = pendres_model_origin(p) + y;
    const double fastest = sqrt(2.0 * fmax(0.0, top - pendres_model_potential(p, at)));
    for (int j = -1; j <= 1; j++) {
      x[n] = at;
      v[n++] = 0.7 * fastest * j;
    }
  }
  return n;
}

size_t pendres_attractor_set_starts(const pendres_pendulum *p,
                                    double x[PENDRES_ATTRACTOR_SET_STARTS],
                                    double v[PENDRES_ATTRACTOR_SET_STARTS])
{
  size_t n = 0;
  for (int i = 0; i < ACROSS; i++)
    for (int j = -1; j <= 1; j++) {
      x[n] = pendres_model_origin(p) + two_pi * (i - 5.5) / 12.0;
      v[n++] = 1.3 * j;
    }
  if (pendres_model_of(p->force)->period > 0.0) return n;
  double u[POINTS];
  for (int i = 0; i < POINTS; i++)
    u[i] = pendres_model_potential(p, pendres_model_origin(p) + place(i));
  for (int i = 1, wells = 0; i + 1 < POINTS && wells < MOST_WELLS; i++) {
    if (!(u[i] < u[i - 1] && u[i] <= u[i + 1])) continue;
    const size_t more = in_well(p, u, i, x + n, v + n);
    n += more;
    wells += more > 0;
  }
  return n;
}
