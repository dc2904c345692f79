/* attractor_set_explore.c -- integrating initial guesses to find attractors; see attractor_set.h.
   */
#include "settling/attractor_set.h"

#include <math.h>
#include <stdlib.h>

#include "base/angles.h"
#include "engine/accuracy.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/steps.h"
#include "model/equation.h"
#include "model/model.h"
#include "settling/numbers.h"

typedef struct guess_run {
  pendres_initial_guess *guesses; /* y and w: one period ago */
  double *angle;         /* the angle then, with its whole turns */
  const long *periods;   /* of each set */
  const pendres_attractor_set *attractor_sets;
} guess_run;

/* An initial guess stops where it hardly moves, or after the time in which transients should have
   faded. */
static int guess_look(void *arg, size_t index, const pendres_strobe_lane *lane)
{
  const guess_run *s = arg;
  pendres_initial_guess *me = &s->guesses[index];
  const double angle = lane->y + two_pi * (double)lane->turns;
  const double turn = pendres_model_turn(lane->pendulum);
  const double advance = angle - s->angle[index], turns = rint(advance / turn);
  const double dy = advance - turn * turns, dw = lane->w - me->w;
  s->angle[index] = angle;
  me->y = lane->y;
  me->w = lane->w;
  me->period = 1;
  /* An initial guess on its way to infinity finds nothing: NaN marks that it is not to be used. */
  if (pendres_escape_certain(lane->pendulum, &s->attractor_sets[me->set].beside, lane->y, lane->w))
    me->y = NAN;
  if (!(isfinite(advance) && isfinite(me->y))) return 1;
  me->winding = (int)turns;
  return dy * dy + dw * dw < guess_at_rest * guess_at_rest || lane->period >= s->periods[me->set];
}

/* Periods after which a transient has faded to a hundredth. */
static double fading_periods(const pendres_pendulum *p)
{
  return 4.6 / pendres_equation_fading(p);
}

/* At least 4 of them, and at most 60. */
static long guess_periods(const pendres_pendulum *p)
{
  return (long)ceil(fmin(fmax(fading_periods(p), 4.0), guess_longest));
}

pendres_status pendres_attractor_set_explore(pendres_context *ctx, size_t sets,
                                             pendres_attractor_set *attractor_sets, size_t n,
                                             pendres_initial_guess *guesses)
{
  if (n == 0) return PENDRES_OK;
  pendres_room room = pendres_room_open(ctx, "initial guesses");
  pendres_strobe_lane *lanes = pendres_room_take(&room, n, sizeof *lanes);
  long *periods = pendres_room_take(&room, sets, sizeof *periods);
  double *angle = pendres_room_take(&room, n, sizeof *angle);
  pendres_status status = room.status;
  if (status != PENDRES_OK) return pendres_room_close(&room, status);
  for (size_t i = 0; i < sets; i++) periods[i] = guess_periods(&attractor_sets[i].pendulum);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    const pendres_pendulum *p = &attractor_sets[guesses[i].set].pendulum;
    lanes[i] = (pendres_strobe_lane){.pendulum = p, .y = guesses[i].y, .w = guesses[i].w};
    angle[i] = guesses[i].y;
    /* A low accuracy is enough: initial guesses only have to come near an orbit. */
    const double speed = pendres_steps_speed(p, guesses[i].y + pendres_model_origin(p),
                                             guesses[i].w * p->drive_frequency);
    /* By the method that orbits come from: next to a cusp another one has other attractors. */
    lanes[i].way = PENDRES_FLOW_TABLE;
    status = pendres_steps_choose(ctx, lanes[i].pendulum, speed, pendres_accuracy_to_follow(ctx),
                                  &lanes[i].steps);
  }
  guess_run s = {.guesses = guesses, .angle = angle, .periods = periods,
                 .attractor_sets = attractor_sets};
  if (status == PENDRES_OK) status = pendres_strobe_run(ctx, n, lanes, guess_look, &s);
  if (status == PENDRES_OK) status = pendres_attractor_set_add(ctx, attractor_sets, n, guesses);
  return pendres_room_close(&room, status);
}

/* ---- Where to start ------------------------------------------------------------------------- */

/* Positions across the turn of a pendulum, or across a well, each at rest and moving either way. */
enum { MOST_WELLS = (PENDRES_ATTRACTOR_SET_STARTS / (3 * GUESS_ACROSS)) - 1 };
/* The range in which wells are searched for, in units of length of a force, and its resolution. */
enum { POINTS = 2 * WELL_FAR * GUESS_FINENESS + 1 };

static double place(int i)
{
  return (double)(i - WELL_FAR * GUESS_FINENESS) / GUESS_FINENESS;
}

static void potentials(const pendres_pendulum *p, double u[POINTS])
{
  for (int i = 0; i < POINTS; i++)
    u[i] = pendres_model_potential(p, pendres_model_origin(p) + place(i));
}

static int is_bottom(const double u[POINTS], int i)
{
  return u[i] < u[i - 1] && u[i] <= u[i + 1];
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
  for (int k = 0; k < GUESS_ACROSS; k++) {
    const double part = (k + 0.5) / GUESS_ACROSS;
    const double y = place(low) + part * (place(high) - place(low));
    const double at = pendres_model_origin(p) + y;
    const double fastest = sqrt(2.0 * fmax(0.0, top - pendres_model_potential(p, at)));
    for (int j = -1; j <= 1; j++) {
      x[n] = at;
      v[n++] = guess_speed * fastest * j;
    }
  }
  return n;
}

size_t pendres_attractor_set_starts(const pendres_pendulum *p,
                                    double x[PENDRES_ATTRACTOR_SET_STARTS],
                                    double v[PENDRES_ATTRACTOR_SET_STARTS])
{
  size_t n = 0;
  for (int i = 0; i < GUESS_ACROSS; i++)
    for (int j = -1; j <= 1; j++) {
      x[n] = pendres_model_origin(p) + two_pi * (i + 0.5 - 0.5 * GUESS_ACROSS) / GUESS_ACROSS;
      v[n++] = guess_pendulum_speed * j;
    }
  if (pendres_model_of(p->force)->period > 0.0) return n;
  double u[POINTS];
  potentials(p, u);
  for (int i = 1, wells = 0; i + 1 < POINTS && wells < MOST_WELLS; i++) {
    if (!is_bottom(u, i)) continue;
    const size_t more = in_well(p, u, i, x + n, v + n);
    n += more;
    wells += more > 0;
  }
  return n;
}

size_t pendres_attractor_set_bottoms(const pendres_pendulum *p,
                                     double y[PENDRES_ATTRACTOR_SET_BOTTOMS])
{
  double u[POINTS];
  size_t n = 0;
  y[0] = 0.0;
  if (!(fading_periods(p) > guess_longest)) return 0;
  if (pendres_model_of(p->force)->period > 0.0) return 1;
  potentials(p, u);
  for (int i = 1; i + 1 < POINTS && n < PENDRES_ATTRACTOR_SET_BOTTOMS; i++)
    if (is_bottom(u, i)) y[n++] = place(i);
  return n;
}
