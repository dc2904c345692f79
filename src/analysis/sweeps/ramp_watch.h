/*
 * ramp_watch.h -- which trajectories have left a state, by the mean of what they do over its own
 * time.
 *
 * Owns: what the states of a path look like to a lock-in amplifier, and when a trajectory of a ramp
 * leaves each of them. The definition is in ramp.h.
 */
#ifndef PENDRES_RAMP_WATCH_H
#define PENDRES_RAMP_WATCH_H

#include <pendres/langevin.h>
#include <pendres/ramp.h>

/* What is measured, as the mean over a window. */
typedef struct pendres_ramp_reading {
  double cosine, sine; /* first harmonic of the angle; without a drive the position, and 0 */
  double advance;      /* of x in a drive period */
} pendres_ramp_reading;

/* Points of the path on which a state is seen, and which of them was looked at last. */
typedef struct pendres_ramp_sight {
  size_t first, last, cursor;
} pendres_ramp_sight;

/* The end of a state that a path meets: how to see that a trajectory has passed it. */
typedef struct pendres_ramp_gate {
  int usable, by_advance;
  size_t leg;          /* of the ramp: between two turns of the parameter */
  int direction;
  double own;          /* drive periods in which both states show what they are */
  long parts;          /* of a window, which lasts so long */
  pendres_ramp_sight old, new; /* the states before the jump and after it */
  double time;         /* when, in drive periods, ... */
  pendres_ramp_reading before, after; /* ... they look like this */
} pendres_ramp_gate;

/* One trajectory at the gates. */
typedef struct pendres_ramp_watcher {
  size_t leg, gate; /* where it is: all before are passed, or given up */
  int armed;        /* it has been seen in the old state */
  long out;         /* windows since it left; 0: it has not */
  double left;      /* when that was */
  double distance;  /* from the old state a window ago: 1 is half way to the new one */
  long parts;       /* of the present window that are over, ... */
  pendres_ramp_reading sum; /* ... and what was read in them */
  double x;         /* a part ago */
} pendres_ramp_watcher;

/* All gates of a ramp, and trajectories at them. */
typedef struct pendres_ramp_watch {
  const pendres_ramp *ramp;
  long clock;               /* parts of a drive period */
  size_t gates;
  pendres_ramp_gate *gate;
  size_t leg;               /* of the part that is looked at */
  size_t corner;            /* the part is before this corner */
  int direction;            /* of the leg */
  size_t watchers;
  pendres_ramp_watcher *watcher;
  double *time;             /* [gates][watchers] results */
} pendres_ramp_watch;

/* For n trajectories from one start; time[jumps][n] is filled with NaN, and kept. */
pendres_status pendres_ramp_watch_open(pendres_context *ctx, const pendres_ramp *ramp, size_t n,
                                       double *time, pendres_ramp_watch *out);
void pendres_ramp_watch_close(pendres_ramp_watch *w);

/* The parts into which drive periods are to be divided, 1 where the drive drives: without one a
   period says nothing of the pendulum, and may be long. */
pendres_status pendres_ramp_watch_clock(pendres_context *ctx, const pendres_ramp *ramp,
                                        long *clock);

/* Look at the part that ends at a strobe, whose period is the number of parts that are over; blocks
   come one after the other. */
void pendres_ramp_watch_see(pendres_ramp_watch *w, const pendres_langevin_strobe *strobe);

/* End the run: trajectories that are outside of their state have left it. */
void pendres_ramp_watch_end(pendres_ramp_watch *w);

/* Drive periods from the ramp's start to its end; 0 if it has none. */
long pendres_ramp_periods(const pendres_ramp *ramp);

#endif
