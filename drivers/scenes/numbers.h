/*
 * numbers.h -- how scenes are cut into tasks, and other numbers that were chosen for them, each
 * with its reason. A task takes a second or so. Results do not depend on how a scene is cut.
 */
#ifndef SCENES_NUMBERS_H
#define SCENES_NUMBERS_H

enum {
  /* Points of a task whose pendulums are advanced side by side: full blocks, and tasks enough for
     many threads. Of those that search, follow, or have ensembles there are fewer. */
  SCENE_PENDULUMS = 192,
  TASK_ATTRACTORS = 16,   /* values whose attractors are found together, to fill blocks */
  TASK_RESONANCES = 8,    /* at most, and so few that there are ... */
  RESONANCE_TASKS = 12,   /* ... as many tasks as this */
  TASK_EXPONENTS = 8192,  /* pendulums, at least; four times as many at most, and so few that ... */
  TASKS_OF_EXPONENTS = 32, /* ... there are as many tasks as this */
  FEWEST_EXPONENTS = 256, /* where each takes long, so that a stopped run keeps what took some
                             seconds; with 72 blocks are half empty, and take half as long again */
  TASK_SAMPLES = 65536,   /* of a record, or one period */
  TASK_STATES = 65536,    /* of a basin: whole rows of about this number, but so few that ... */
  BASINS_TASKS = 16,      /* ... there are as many tasks as this: for 3 % of the time two threads or
                             more have work on small grids, too, ... */
  TASK_STATES_LEAST = 256, /* ... but no fewer: the last of a task's states take as long as these */
  TASK_REFINED = 4096,    /* states in a refinement: several blocks; fewer are not worth a stage */
  TASK_LOST = 64,         /* unresolved states of so many, TASK_STATES, that are remembered */
  BASINS_BAND = 1 << 24,  /* states that a plan holds at a time */
  BASINS_ROWS = 256       /* rows of it that are written or added up at a time */
};

/* Bytes of a fit's data as text: some millions of lines, of which a fit would take days; what is
   larger was hardly meant, and would take the memory of others. */
enum { FIT_MOST_BYTES = 256 << 20 };

/* States that a refinement has filled are verified: so many of them, or one of so many if these are
   more. */
enum { BASINS_LEAST_SAMPLE = 10000, BASINS_SAMPLED = 256 };

/* Passes again with attractors that unresolved states have shown. */
enum { BASINS_EXTENSIONS = 4 };

/* Following branches and curves through a point takes as long as settling its members again. */
enum { LINES_RUNS_A_POINT = 5 };

/* A damping at which a thousand exponents take some seconds. */
static const double usual_damping = 0.2;

/* The spacing of branches that are not written: it may be sparse. */
static const double lines_sparse = 0.1;

/* Strobe points that a dimension is measured from, at most; segments of a spectrum, without
   overlap, if the deck does not say; tolerances below which distances are not looked at. */
enum { ORBIT_POINTS = 32768, ORBIT_SEGMENTS = 16, ORBIT_RESOLUTION = 100 };

#endif
