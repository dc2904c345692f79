/*
 * numbers.h -- how long the farm waits, and for what, and how much it keeps: numbers that were
 * chosen, each with its reason. None changes a result.
 */
#ifndef FARM_NUMBERS_H
#define FARM_NUMBERS_H

enum {
  FARM_MOST_THREADS = 4096,
  /* Bytes of each thread's stack, of which tasks need some hundred thousand. */
  FARM_STACK = 8 << 20,
  /* Bytes of records in memory that wait: for their turn, where the journal holds them as well, or
     to be sent to another rank. */
  FARM_MOST_WAITING = 64 << 20,
  /* Microseconds between two looks for a message, at most: of threads that wait, and while they
     work. */
  WAIT_OFTEN = 1000,
  WAIT_SELDOM = 10000,
  /* Sleeps, some seconds together, in which memory for a message may become free. */
  WAIT_PATIENCE = 1000,
  /* More than a scene has, so that stages of different slices have different numbers. */
  FARM_SLICE_STAGES = 1000000,
  /* Bytes of outdated states that a journal may hold beside as many as it has of what counts: to
     write it anew then takes no longer than they have taken. */
  JOURNAL_DEAD = 1 << 20,
  JOURNAL_ATTEMPTS = 100, /* how often it may be removed or replaced between two checks */
  POINTS_BEFORE = 8,      /* a point is costly beside the mean of these at least */
  LOOK_EVERY = 20         /* milliseconds, at what threads do */
};

/* At most the records of this number of seconds are lost when the machine fails. */
static const double journal_sync_after = 10.0;

/* Seconds after which a task's state is kept, and the share of the time that it has taken so far:
   what a run that is killed has to do again. Writing takes no larger share of the time. */
static const double state_every = 0.5, state_share = 0.1;

/* A point is costly, and reported, when it has taken this multiple of the mean of those before, and
   longer than a fraction of the time between two lines on the run, usually five seconds. */
static const double costly_times = 20.0, costly_wait = 1.0 / 60.0;

#endif
