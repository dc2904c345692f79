/*
 * accuracy_crises.c -- interior crises beside an own simulation; see accuracy.h.
 *
 * At a crisis chaos suddenly becomes larger. One long trajectory just before the value and one just
 * beyond it then differ: of the one, many strobe points lie where the other never comes, and hardly
 * any the other way round. Chaos that only changes gradually is the same on both sides.
 */
#include "accuracy.h"

#include <math.h>
#include <stdlib.h>

static const double two_pi = 6.28318530717958647693;

enum {
  SETTLE = 1000,   /* drive periods */
  PERIODS = 16384, /* twice as many as the library's pendulums are watched for together */
  LONGEST = 64,    /* orbits of more periods would be taken for chaos */
  CELLS = 40,      /* a side of what both trajectories fill */
  DISTANCES = 3
};

/* A step in time: the method's error moves a crisis by less than least_aside. */
static const double longest_step = 0.02;
/* How far from the value trajectories are taken, in its errors, and at least, in its size. Where an
   orbit has a window in the chaos, one of the farther distances is not in it. */
static const double aside[DISTANCES] = {2.0, 4.0, 8.0};
static const double least_aside = 1e-6;
/* Of larger chaos at least this share is outside the smaller one; in a burst it is there for some
   periods, and twice the error away bursts come in thousands at most. */
static const double least_share = 1e-3;
/* The smaller chaos has less than this of that share outside the larger one. */
static const double least_contrast = 0.1;

/* Strobe points of a trajectory. */
typedef struct track {
  double y[PERIODS], v[PERIODS];
} track;

/* What both of two tracks fill, in cells; the angle is counted from `centre`, and comes round. */
typedef struct region {
  double centre, low[2], size[2];
  int round;
  unsigned char cell[CELLS][CELLS];
} region;

static accuracy_own own_at(const pendres_pendulum *p, pendres_parameter parameter, double value)
{
  accuracy_own own = {.pendulum = *p};
  pendres_parameter_set(parameter, value, &own.pendulum);
  own.steps = (int)ceil(two_pi / own.pendulum.drive_frequency / longest_step);
  return own;
}

void accuracy_crisis_come(const pendres_pendulum *p, pendres_parameter parameter, double value,
                          double s[2])
{
  const accuracy_own own = own_at(p, parameter, value);
  double harmonic[2];
  for (long k = 0; k < SETTLE; k++) accuracy_own_period(&own, k, NULL, s, harmonic);
}

/* Continue from the state s for the length of a track; 0: it goes to infinity. */
static int record(const accuracy_own *own, double s[2], track *out)
{
  double harmonic[2];
  for (long k = -SETTLE; k < PERIODS; k++) {
    accuracy_own_period(own, k, NULL, s, harmonic);
    if (!(isfinite(s[0]) && isfinite(s[1]))) return 0;
    if (k < 0) continue;
    out->y[k] = s[0];
    out->v[k] = s[1];
  }
  return 1;
}

static double turn_of(const pendres_pendulum *p)
{
  return pendres_model_of(p->force)->period;
}

/* An angle from the centre. */
static double from_centre(const region *r, double turn, double y)
{
  return turn > 0.0 ? remainder(y - r->centre, turn) : y;
}

static void measure(const track t[2], double turn, region *r)
{
  double high[2] = {-INFINITY, -INFINITY}, sine = 0.0, cosine = 0.0;
  r->low[0] = r->low[1] = INFINITY;
  for (int i = 0; i < 2 * PERIODS && turn > 0.0; i++) {
    sine += sin(two_pi / turn * t[i / PERIODS].y[i % PERIODS]);
    cosine += cos(two_pi / turn * t[i / PERIODS].y[i % PERIODS]);
  }
  r->centre = atan2(sine, cosine) / two_pi * turn;
  for (int i = 0; i < 2 * PERIODS; i++) {
    const double at[2] = {from_centre(r, turn, t[i / PERIODS].y[i % PERIODS]),
                          t[i / PERIODS].v[i % PERIODS]};
    for (int k = 0; k < 2; k++) {
      r->low[k] = fmin(r->low[k], at[k]);
      high[k] = fmax(high[k], at[k]);
    }
  }
  for (int k = 0; k < 2; k++) r->size[k] = (high[k] - r->low[k]) / CELLS * (1.0 + 1e-9);
  r->round = turn > 0.0 && (CELLS + 2) * r->size[0] > turn;
}

static unsigned char *cell_of(region *r, double turn, double y, double v, int right, int up)
{
  int i = (int)floor((from_centre(r, turn, y) - r->low[0]) / r->size[0]) + right;
  const int k = (int)floor((v - r->low[1]) / r->size[1]) + up;
  if (r->round) i = (i + CELLS) % CELLS;
  return i < 0 || i >= CELLS || k < 0 || k >= CELLS ? NULL : &r->cell[i][k];
}

/* The share of track b that is not next to a cell of track a. */
static double share_outside(region *r, double turn, const track *a, const track *b)
{
  int outside = 0;
  for (int i = 0; i < CELLS; i++)
    for (int k = 0; k < CELLS; k++) r->cell[i][k] = 0;
  for (int i = 0; i < PERIODS; i++)
    for (int n = 0; n < 9; n++) {
      unsigned char *cell = cell_of(r, turn, a->y[i], a->v[i], n / 3 - 1, n % 3 - 1);
      if (cell != NULL) *cell = 1;
    }
  for (int i = 0; i < PERIODS; i++) {
    const unsigned char *cell = cell_of(r, turn, b->y[i], b->v[i], 0, 0);
    outside += cell == NULL || !*cell;
  }
  return (double)outside / PERIODS;
}

static int is_chaotic(const track *t)
{
  static const double returns = 1e-6;
  const int last = PERIODS - 1;
  for (int q = 1; q <= LONGEST; q++)
    if (hypot(sin(0.5 * (t->y[last] - t->y[last - q])), t->v[last] - t->v[last - q]) < returns)
      return 0;
  return 1;
}

/* A trajectory before the value and what becomes of it beyond: 1 if both are chaotic. */
static int record_both(const pendres_pendulum *p, pendres_parameter parameter,
                       const pendres_jump *j, double apart, const double from[2], track t[2])
{
  double s[2] = {from[0], from[1]};
  for (int k = 0; k < 2; k++) {
    const double value = j->value + (2 * k - 1) * j->direction * apart;
    const accuracy_own own = own_at(p, parameter, value);
    if (!record(&own, s, &t[k]) || !is_chaotic(&t[k])) return 0;
  }
  return 1;
}

accuracy_crisis accuracy_crisis_beside(const pendres_pendulum *p, pendres_parameter parameter,
                                       const pendres_jump *j, const double from[2])
{
  accuracy_crisis c = {.compared = 0};
  const double turn = turn_of(p);
  track *t = malloc(2 * sizeof *t);
  region *r = malloc(sizeof *r);
  for (int i = 0; i < DISTANCES && t != NULL && r != NULL && !c.differs; i++) {
    c.aside = aside[i] * fmax(j->value_error, least_aside * fabs(j->value));
    if (!record_both(p, parameter, j, c.aside, from, t)) continue;
    c.compared = 1;
    measure(t, turn, r);
    c.outside[0] = share_outside(r, turn, &t[1], &t[0]);
    c.outside[1] = share_outside(r, turn, &t[0], &t[1]);
    const double more = fmax(c.outside[0], c.outside[1]), less = fmin(c.outside[0], c.outside[1]);
    c.differs = more > least_share && less < least_contrast * more;
  }
  free(t);
  free(r);
  return c;
}
