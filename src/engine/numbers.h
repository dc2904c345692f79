/*
 * numbers.h -- numbers that were chosen for the integration, each with its reason. Tolerances that
 * follow from the caller's are in accuracy.h.
 */
#ifndef PENDRES_ENGINE_NUMBERS_H
#define PENDRES_ENGINE_NUMBERS_H

#include "base/numbers.h"

/* ---- blocks of lanes: these change the time, and no result ---- */

enum {
  LANES_USUAL = 512, /* of a block, unless asked: more is hardly faster */
  LANES_MOST = 4096,
  PARTS_MOST_THREADS = 4096 /* more than any machine has processors */
};

/* A chain of derivatives is divided among threads where it has more steps than this, some two
   milliseconds: to start a thread takes a twentieth of them. */
static const double chain_worth_threads = 1e4;

/* ---- how many steps: the lattice of cells that share a number of steps (steps.c) ---- */

/* Below these values all pendulums share a cell, and those that follow are so much larger each: as
   a step moves by about as much as these ratios. The lattice is finer for frequencies, which the
   steps follow most closely. Speeds, which count by their bounds, may be coarse. */
static const double lattice_damping = 0.05, lattice_drive = 0.25, lattice_tolerance = 1e-18;
static const double lattice_ratio = 1.25;
static const double lattice_frequency = 1e-4, lattice_frequency_ratio = 1.06;
static const double lattice_speed = 2.0, lattice_speed_ratio = 1.5;

/*
 * Steps of a Nystrom method for each of a table's at this error a period, where multipliers count
 * and no trajectory. Then those of random pendulums of four forces are right to 1e-5 at nineteen in
 * twenty, and to 1e-4 at all. More exact ones have as many more steps as the order says.
 */
static const double average_rough = 1e-4, average_steps = 0.7;
/* Averages of such an error a period may be in single precision, which rounds a hundredth of it. */
static const double average_single = 1e-5;
/* Its rounding was measured for pendulums that turn by so many radians a period. */
static const double single_farthest = 50.0;

/* ---- how many steps: probes of a cell ---- */

enum {
  PROBES = 16,       /* initial states a cell is probed with, two vectors of eight */
  PROBE_POINTS = 65, /* of a period at which they are compared: 64 intervals and the end */
  STEPS_FEWEST = 8,
  STEPS_FEWEST_OF_FEW = 12
};

/* Growth of an error of the start beyond which a probe is not followed. */
static const double probe_wild = 100.0;

/* Half of the probes start at rest so far from the bottom: short of the top, where there is little
   force. */
static const double probe_reach = 2.75;

/* A speed, in the unit of small oscillations, at which turning over takes as many steps as swinging
   does; drives do not lead beyond it, since faster oscillations get out of phase. */
static const double probe_fast = 4.0;

/* A step is at most so long, in units of time, and in those of friction: the real stability
   interval of tables of order 8 is about 4 to 5. */
static const double step_longest = 1.5, step_stable = 4.0;

/* Errors below this that do not fall to half are rounding: more steps would not help. */
static const double probe_rounding = 1e-9;

/* The order of any table where |v| bends the slope between two stages. */
enum { ORDER_BENT = 3 };

/* Errors below this fall as the order of the method says. Then the steps are those that follow from
   the order, less a twentieth; before, half as many more. Four times as many at most are tried. */
static const double probe_regular = 1e-2, probe_less = 0.95, probe_more = 1.5, probe_most = 4.0;

/* ---- charts of the strobe map (charts.c) ---- */

enum {
  CHARTS_FAR = 8,   /* units of length from rest to the last square */
  CHARTS_TIMES = 8, /* the periods of a chart are so many times those of the level before */
  CHARTS_LEVELS = 5, /* 1, 8, 64, 512 and 4096 periods */
  /* A context keeps the charts of so many pendulums, as the lines of a diagram that are computed
     side by side, if they are no more than so many together: a chart takes a kilobyte. */
  CHARTS_KEPT = 96,
  CHARTS_MOST = 65536
};

/* Settling takes at least so many periods where charts are made; the longest ones are over this
   share of it. */
static const double charts_worth = 300.0, charts_longest = 0.125;

/* What a chart may miss between its nodes, of the distance from the bottom, in a time of settling;
   the share of that by the integrator; and what counts of the most that was seen to be missed:
   from place to place it changes its sign, and pendulums were off by a fiftieth of this at most. */
static const double charts_missed = 3e-6, charts_integrated = 0.1, charts_between = 0.5;

/* What a polynomial of degree seven misses falls by 2^8 where a square is divided; twice that,
   since more may be missed farther from the bottom. */
static const double charts_falls = 512.0;

/* Squares have half sides of at least the distance from the bottom times the root of this over the
   time of settling, twice that for each further level, and of at least the second number: smaller
   ones are not come back to often enough. */
static const double charts_rounds = 100.0, charts_smallest = 1e-3;

/* A chart takes as long as so many slopes. */
static const double charts_slopes = 64.0;

#endif
