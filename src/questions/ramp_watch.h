/*
 * ramp_watch.h -- which trajectories have left a state, by the first harmonic of each drive period.
 *
 * Owns: what the states of a path look like to a lock-in amplifier, and when a trajectory of a ramp
 * leaves each of them. The definition is in ramp.h.
 */
#ifndef PENDRES_RAMP_WATCH_H
#define PENDRES_RAMP_WATCH_H

#include <pendres/langevin.h>
#include <pendres/ramp.h>

/* What is measured of a drive period. */
typedef struct pendres_ramp_reading {
  double cosine, sine; /* first harmonic of the angle */
  double advance;      /* of x */
} pendres_ramp_reading;

/* The end of a state that a path meets: how to see that a trajectory has passed it. */
typedef struct pendres_ramp_gate {
  int usable, by_advance;
  size_t leg;          /* of the ramp: between two turns of the parameter */
  int direction;
  size_t first, last;  /* points of the path on which the old state is seen */
  double half;         /* half the distance to the new one */
  size_t cursor;       /* point that was looked at last */
  double period;       /* at whose middle ... */
  pendres_ramp_reading old; /* ... the old state looks like this */
} pendres_ramp_gate;

/* One trajectory at the gates. */
typedef struct pendres_ramp_watcher {
  size_t leg, gate; /* where it is: all before are passed, or given up */
  int armed;        /* it has been seen in the old state */
  long out;         /* periods since it left; 0: it has not */
  double left;      /* when that was */
  double distance;  /* from the old state a period ago, in units of `half` */
  double x;         /* a period ago */
} pendres_ramp_watcher;

/* All gates of a ramp, and trajectories at them. */
typedef struct pendres_ramp_watch {
  const pendres_ramp *ramp;
  size_t gates;
  pendres_ramp_gate *gate;
  size_t leg;               /* of the period that is looked at */
  size_t corner;            /* the period is before this corner */
  int direction;            /* of the leg */
  size_t watchers;
  pendres_ramp_watcher *watcher;
  double *time;             /* [gates][watchers] results */
} pendres_ramp_watch;

/* For n trajectories from one start; time[jumps][n] is filled with NaN, and kept. */
pendres_status pendres_ramp_watch_open(pendres_context *ctx, const pendres_ramp *ramp, size_t n,
                                       double *time, pendres_ramp_watch *out);
void pendres_ramp_watch_close(pendres_ramp_watch *w);

/* Look at the period that ends at a strobe; blocks come one after the other. */
void pendres_ramp_watch_see(pendres_ramp_watch *w, const pendres_langevin_strobe *strobe);

/* End the run: trajectories that are outside of their state have left it. */
void pendres_ramp_watch_end(pendres_ramp_watch *w);

#endif
