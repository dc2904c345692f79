/*
 * deck.h -- what a run computes: a deck, checked and complete, as one plain struct.
 *
 * Owns: the meaning of groups and keys. namelist.h turns text into a tree; the table in
 * table.c says which scene takes which key, of what type, in what range and with what
 * default; check.c holds what concerns several keys at once.
 *
 * Units are those of the dimensionless equation x'' + g x' - cos x = F0 cos wt + noise: see
 * <pendres/pendulum.h>. Thread safe: no state outside the arguments.
 */
#ifndef DECK_H
#define DECK_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <pendres/parameter.h>
#include <pendres/status.h>
#include <pendres/sweep.h>

#include "deck/namelist/namelist.h"

/*
 * Kinds of scenes, a row each: the name in decks, what is computed, in words for --list, and
 * those fields of deck_kind_info that are not 0, which say what its results are over.
 */
#define DECK_KIND_LIST(ITEM)                                                                      \
  ITEM(FREE_OSCILLATION, "free_oscillation",                                                      \
       "frequency without damping and drive against the amplitude, of any force", .most = 0)      \
  ITEM(RESONANCE_CURVE, "resonance_curve",                                                        \
       "resonance of an ensemble, found to the tolerance, against damping",                       \
       .layout = DECK_RESONANCES, .least = 1, .most = 1, .takes = "results have one axis")        \
  ITEM(RESPONSE, "response",                                                                      \
       "amplitude, phase lag and loop area of an ensemble against drive period or frequency",     \
       .layout = DECK_PLANE, .least = 2, .most = DECK_AXES, .steady = 1,                          \
       .takes = "results have three axes at most, with temperatures two")                         \
  ITEM(ORBIT, "orbit",                                                                            \
       "one pendulum in time: an attractor, or the way to it, with measures and multipliers",     \
       .most = 0)                                                                                 \
  ITEM(BASINS, "basins",                                                                          \
       "attractor on which each start of a window settles; with a temperature, thermal clouds",   \
       .steady = 1)                                                                               \
  ITEM(PHASE_DIAGRAM, "phase_diagram",                                                            \
       "where SA, LA, both or neither exist, over damping and drive frequency",                   \
       .layout = DECK_PLANE, .least = 2, .most = 2, .followed = 1,                                \
       .takes = "results have two axes")                                                          \
  ITEM(BRANCHES, "branches",                                                                      \
       "orbits followed over the drive frequency, unstable parts and bifurcations included",      \
       .layout = DECK_PLANE, .least = 2, .most = 2, .followed = 1,                                \
       .takes = "results have two axes")                                                          \
  ITEM(WORK_PRECISION, "work_precision",                                                          \
       "methods compared: speed against error on the same pendulums", .most = 0)                  \
  ITEM(HARD_CASES, "hard_cases",                                                                  \
       "cases that break pendulum programs, each with its bound and the figure measured",         \
       .most = 0)                                                                                 \
  ITEM(SWITCHING, "switching",                                                                    \
       "rates at which noise drives a pendulum from one state to another, against temperature",   \
       .most = 0)                                                                                 \
  ITEM(HYSTERESIS, "hysteresis",                                                                  \
       "state of a pendulum while one parameter is swept slowly, up and then down; its jumps",    \
       .layout = DECK_MOVING, .least = 1, .most = 1, .followed = 1,                               \
       .takes = "one parameter is swept")                                                         \
  ITEM(BIFURCATION_DIAGRAM, "bifurcation_diagram",                                                \
       "strobe points against one parameter, bifurcations on the way, and a doubling cascade",    \
       .layout = DECK_MOVING, .least = 1, .most = 1, .followed = 1,                               \
       .takes = "one parameter moves")                                                            \
  ITEM(LYAPUNOV_MAP, "lyapunov_map",                                                              \
       "largest Lyapunov exponent, period and winding over two parameters",                       \
       .layout = DECK_MOVING, .least = 2, .most = 2, .takes = "a map has two axes")               \
  ITEM(ESCAPE, "escape",                                                                          \
       "least action with which noise carries a pendulum out of a state, and its path",           \
       .layout = DECK_MOVING, .most = 2, .takes = "results have two axes at most")                \
  ITEM(FIT, "fit",                                                                                \
       "parameters of an oscillator and scales of an instrument from measured responses",         \
       .most = 0)

/* Hard cases by their names, in the order in which they are printed. */
#define DECK_CASE_LIST(ITEM)                                                                      \
  ITEM(equilibrium)                                                                               \
  ITEM(separatrix)                                                                                \
  ITEM(energy)                                                                                    \
  ITEM(weak_damping)                                                                              \
  ITEM(stiff)                                                                                     \
  ITEM(frequency)                                                                                 \
  ITEM(fold)                                                                                      \
  ITEM(cusp)                                                                                      \
  ITEM(boundary)                                                                                  \
  ITEM(wild)                                                                                      \
  ITEM(tolerance)                                                                                 \
  ITEM(drive)

typedef enum deck_kind {
#define DECK_KIND_CODE(code, ...) DECK_##code,
  DECK_KIND_LIST(DECK_KIND_CODE)
#undef DECK_KIND_CODE
  DECK_KIND_COUNT
} deck_kind;

/* Over which parameters a kind has its results: deck_axes(). */
typedef enum deck_layout {
  DECK_NO_AXES = 0,
  DECK_MOVING,    /* those that have several values */
  DECK_PLANE,     /* damping and the drive's frequency or period, or what is given in &sweep */
  DECK_RESONANCES /* one of these: the drive's frequency is what is searched for */
} deck_layout;

typedef struct deck_kind_info {
  const char *name, *words;
  deck_layout layout;
  int least, most;   /* axes of the results, with that of temperatures where noise is steady */
  int followed;      /* nonzero: orbits are followed along them */
  int steady;        /* nonzero: with noise, results are those of the steady state */
  const char *takes; /* the words where there are fewer or more */
} deck_kind_info;

/* Axes: the parameters, in the order of their list, two more of &sweep, and that of &outer. */
typedef enum deck_axis_id {
#define DECK_AXIS_CODE(code, ...) DECK_AXIS_##code,
  PENDRES_PARAMETER_LIST(DECK_AXIS_CODE)
#undef DECK_AXIS_CODE
  DECK_AXIS_AMPLITUDE,
  DECK_AXIS_TOLERANCE,
  DECK_AXIS_OUTER,
  DECK_AXIS_COUNT
} deck_axis_id;

enum { DECK_TITLE = 256, DECK_PATH = 1024, DECK_NAME = 64, DECK_FORMULA = 401,
       DECK_MAX_COUNT = 1000000 };

/** Values along one axis. A scene without the axis has count 0. */
typedef struct deck_axis {
  double *value; /* count values, ascending, without repetitions */
  size_t count;
  /* What they were made of: the values listed and the range, for deck_dump. */
  double *listed;
  size_t listed_count;
  double range_first, range_last;
  size_t range_count; /* 0: no range was given */
} deck_axis;

/** A list of names, each in its own buffer of DECK_NAME bytes. */
typedef struct deck_names {
  char (*name)[DECK_NAME];
  size_t count;
} deck_names;

/** A list of numbers. */
typedef struct deck_numbers {
  double *number;
  size_t count;
} deck_numbers;

/**
 * A deck. A quantity that is an axis of the scene is in axis[] alone, also where the deck gives
 * one value of it in &pendulum; its field in `pendulum` is then NaN. Fields that the scene does
 * not use hold their defaults (NaN where there is none). The temperature is always an axis;
 * without one there is no noise.
 */
typedef struct deck {
  char *name;         /* the file it came from */
  char *text;         /* verbatim */
  size_t text_length;
  char *settings;     /* keys set outside of it, as they were written, with blanks between them */

  deck_kind kind;
  char title[DECK_TITLE];
  char output[DECK_PATH];

  pendres_pendulum pendulum;
  double drive_period;      /* both it and the frequency are set, whichever was given */
  int by_period;            /* nonzero: drive_period was given */
  char force[DECK_NAME];    /* a name of pendres_model_of() */
  char formula[DECK_FORMULA]; /* as pendres_force_text() has it; "": the force is none */

  deck_axis axis[DECK_AXIS_COUNT];
  int64_t resolution;       /* number of parts into which each step of the ranges is divided */
  double search[2];         /* bounds of drive frequency in the search of a resonance */
  int search_given;         /* the deck says them */

  struct {                  /* the outer axis; its values are in axis[] */
    char key[DECK_NAME];    /* as the deck names it; "": there is none */
    int known;              /* nonzero: it is a number of the scene, whose row of the table is */
    size_t row;
    int coefficient;        /* 1 to 5 of 'force_coefficients'; 0: the row is the number */
  } outer;

  struct {                  /* as in struct pendres_ensemble */
    int64_t members;
    char shape[DECK_NAME];  /* "line", "rectangle", "random" */
    double x_first, x_last;
    double v, v_last;
    int64_t rows;
    int64_t seed;
  } ensemble;

  struct {                  /* zero: chosen by the library */
    double tolerance;       /* of the results */
    char method[DECK_NAME];
    char table[DECK_NAME];
    int64_t steps_per_period;
    int64_t block_lanes;
    int64_t period_budget;
    double unresolved_share; /* of the points, that may stay unresolved without a failure */
    double exponent_error;  /* of chaos, relative; 0: the library's */
  } precision;

  struct {
    char start[DECK_NAME];  /* "sa", "la", the number of an attractor from "1" on, in the order of
                               amplitude; or "" for the start at x, v */
    double x, v;
    int64_t periods;        /* drive periods recorded */
    int64_t samples;        /* per period */
    int transient;          /* nonzero: record from the start instead of after settling */
    int dimension, spectrum; /* nonzero: measure them */
    int64_t segment;        /* drive periods of the spectrum's segments; 0: chosen */
  } orbit;

  struct {                  /* of the scene hysteresis, in real time */
    double rate;            /* of the parameter a drive period; NaN: none was given */
    deck_numbers protocol;  /* time, value, time, value, ... */
    int64_t points;         /* recorded each way, at most */
  } ramp;

  struct {
    int64_t strobes;        /* of the scene bifurcation_diagram, at each value */
    int attractors, bifurcations, exponents; /* nonzero: find them */
  } diagram;

  struct {                  /* of the scene lyapunov_map; 0: the library's */
    int64_t transient, periods;
  } lyapunov;

  struct {
    int refine;
    int boundary;
    int statistics;
    int64_t strobes;        /* noisy strobes recorded for each attractor */
    int64_t trajectories;
    char by[DECK_NAME];     /* what counts as one end */
  } basins;

  struct {
    int64_t from, to;       /* numbers of attractors, from 1 on; both 0: SA and LA */
  } switching;

  struct {
    int64_t seed;
    int64_t trajectories;
    int64_t periods;
  } noise;

  struct {                  /* in SI; NaN: it was not told, and does not follow (scales.c) */
    double natural_frequency; /* the unit of time is 1/(2 pi natural_frequency) */
    double mass, length, gravity;
    double volts_per_length;  /* positions are then in volts */
    double critical_current, resistance, capacitance;
  } units;

  struct {                  /* of the scene fit: a file of text, and what is in it */
    char file[DECK_PATH];
    deck_names columns;     /* in words of the user: "3", "volts", "direction=4" */
    deck_names units;       /* of these, in their order */
    char format[DECK_NAME], decimal[DECK_NAME];
    double loss;            /* of drives in dBm, in dB */
    int64_t time_sign;
    char axis[DECK_NAME];   /* name of a parameter */
    deck_names observables;
    char direction[DECK_NAME];
    double error, relative_error; /* standard errors where no column has them; 0: none */
  } data;

  struct {
    deck_names free, fixed, bounds, prior; /* "NAME", "NAME VALUE", "NAME LOW HIGH", "NAME MEAN
                                              ERROR" */
    char model[DECK_NAME];  /* of a line; "": there is none */
    double huber, jump_error;
    int64_t starts, iterations;
  } fit;

  deck_names methods;       /* work_precision */
  char unit[DECK_NAME];
  deck_names cases;         /* hard_cases; none: all */
} deck;

/**
 * Read and check a deck from a file or, for "-", from standard input. On success *out is complete
 * and the caller frees it with deck_free; after any error *out is all zero and errors holds every
 * mistake in the order of the text.
 *
 * Keys may be set outside of the deck, by `count` texts such as "pendulum.damping=0.13": each
 * takes the place of all that the deck says of the same quantity (of an axis, its list, its range
 * and its single value; of the drive, frequency and period). Their errors name the command line.
 * Returns PENDRES_OK, PENDRES_INVALID_ARGUMENT (a bad deck), PENDRES_IO (no deck there) or
 * PENDRES_OUT_OF_MEMORY.
 */
pendres_status deck_read_set(const char *path, const char *const *settings, size_t count,
                             deck *out, namelist_errors *errors);

/** The same from memory; `name` stands in messages and gives the output its default name. */
pendres_status deck_read_memory(const char *name, const char *text, size_t length, deck *out,
                                namelist_errors *errors);

/** Whether it has the form of a key set outside of a deck, GROUP.KEY=VALUES. */
int deck_is_setting(const char *argument);

/** Free what a deck holds and make it all zero; an all-zero deck is allowed. */
void deck_free(deck *d);

/**
 * Write the resolved deck, every key in use with its value, as a namelist that Fortran reads and
 * that deck_read_set turns into the same deck. PENDRES_IO if the stream reports an error.
 */
pendres_status deck_dump(const deck *d, FILE *stream);

/** The same as a text, to be freed by free(); NULL on failure: there is no memory. */
pendres_status deck_resolved(const deck *d, char **out);

/** The pendulum of a deck; parameters that are axes have their first values. */
pendres_pendulum deck_pendulum(const deck *d);

/** The canonical units of a deck's pendulums (pendres_units_of); of parameters that are swept the
 *  value of the largest size decides. */
pendres_units deck_pendulum_units(const deck *d);

/** Starts that the responses of all of them span, as pendres_ensemble_of() says. */
pendres_ensemble deck_starts(const deck *d);

/** Does the deck ask for noise: a temperature above 0? */
int deck_has_noise(const deck *d);

/** Does a parameter move in real time? */
int deck_has_ramp(const deck *d);

/** The axes of the parameters over which a scene has its results, slowest first, and how many there
 *  are, which is at most DECK_AXES in a deck that was checked. */
enum { DECK_AXES = 3 };
int deck_axes(const deck *d, deck_axis_id axis[DECK_AXES]);

/**
 * The outer axis: the scene is computed once for each of its values. How many there are (0: there
 * is no such axis), the name of the axis in results, and what it is in words. All else in a deck
 * with one is that of a single scene, of the value of the largest size.
 */
size_t deck_slices(const deck *d);
const char *deck_outer_name(const deck *d, char name[2 * DECK_NAME]);
const char *deck_outer_words(const deck *d);

/** The deck of one of these scenes, number 0 to deck_slices() - 1: the same without the outer axis,
 *  with that value in its place. It owns nothing: it lasts as long as the whole, and is not
 *  freed. */
deck deck_slice(const deck *d, size_t slice);

/** Does it tell a laboratory's scales, in &units? */
int deck_has_units(const deck *d);

/** What makes SI of the numbers of a kind, or of a quantity by its name (pendres/quantity.h): they
    times `factor` are in `units`, which UDUNITS reads. 0 where the deck does not tell enough, or
    they have no unit. */
enum { DECK_UNITS = 40 };
typedef struct deck_si {
  double factor;
  char units[DECK_UNITS];
} deck_si;
int deck_si_of_kind(const deck *d, pendres_kind kind, deck_si *out);
int deck_si_of(const deck *d, const char *name, deck_si *out);

/** Is a quantity of a fit sought, or held at a value that &fit gives? And what makes SI of it, as
 *  deck_si_of; of drive_scale for one of the data's unit. */
int deck_fit_has(const deck *d, const char *name);
int deck_fit_si(const deck *d, const char *name, deck_si *out);

/** Read an entry of &fit, of a form such as "NAME LOW HIGH", perhaps with a unit behind it: numbers
 *  in the model's units. 0, with the reason: it is none. */
enum { DECK_FIT_WHY = 200 };
typedef struct deck_fit_value {
  char name[DECK_NAME];
  double number[2];
} deck_fit_value;
int deck_fit_entry(const deck *d, const char *text, const char *form, deck_fit_value *out,
                   char why[DECK_FIT_WHY]);

/** A unit of a column of data: SI of one, or of what 0 dB are where `decibel` is set. `of`: the SI
 *  units that it must fit, "" those of a number; NULL: any. 0: it is no unit, -1: it does not
 *  fit. */
typedef struct deck_column_unit {
  double factor;
  int decibel, milliwatt; /* milliwatt: of a power at 50 ohm, in dBm */
} deck_column_unit;
int deck_column_unit_read(const char *text, const char *of, deck_column_unit *out);

/** The same in a unit with the prefix in which a number of that size in SI is easiest to read. */
deck_si deck_si_prefixed(const deck_si *si, double value);

/** Whether it is one of these. */
int deck_has_axis(const deck *d, deck_axis_id axis);

/** What an axis varies; PENDRES_PARAMETER_COUNT if that is no parameter. */
pendres_parameter deck_axis_parameter(deck_axis_id axis);

/** Whether it is the drive's frequency or period. */
int deck_is_clock(deck_axis_id axis);

/** Does a scene of that deck search for resonances: a resonance curve, or a response over the
    drive's frequency or period? Models other than the plain pendulum may have resonances anywhere;
    a response of theirs searches only if the deck gives the range. */
int deck_searches(const deck *d);

/** The shortest segment of a spectrum in drive periods: an even number of samples, 4 or more. */
int64_t deck_spectrum_least(const deck *d);

/** Is there no drive somewhere, so that a pendulum may rest in an unstable state? */
int deck_may_rest(const deck *d);

/** Does the deck ask for the plain pendulum: no torque, no parametric drive, no other force? */
int deck_is_plain(const deck *d);

/** Whether the force, at some point of the deck, lets pendulums go to infinity. */
int deck_leaves(const deck *d);

/** The row of a kind, and names in decks; NULL if out of range. */
const deck_kind_info *deck_kind_of(deck_kind kind);
const char *deck_kind_name(deck_kind kind);
const char *deck_axis_name(deck_axis_id axis);
pendres_kind deck_axis_kind(deck_axis_id axis);

/* ---- explain.c: kinds and keys in words for readers (--list, --explain, --init, docs/decks.md),
   all from the table that the reader checks decks by ---- */

/** All kinds with what they compute, a line each. */
void deck_list(FILE *out);

/**
 * Everything about a kind (all its keys), a group, or a key (`damping`, `damping_range`,
 * `pendulum.damping`): meaning, unit, default, range, scenes. A word that is none of these returns
 * PENDRES_INVALID_ARGUMENT, and `why`, of `size` bytes, says so with the nearest one that is.
 */
pendres_status deck_explain(const char *word, FILE *out, char *why, size_t size);

/** Write words in lines that begin with `margin`; repeated blanks are written as one. */
void deck_write_wrapped(FILE *out, const char *margin, const char *words);

/** The same of all kinds and keys, as the page docs/decks.md. */
void deck_reference(FILE *out);

/**
 * A deck of that kind that runs, with a comment on every key: those that must be given have a
 * value, the others stand there with their defaults as comments. Instead of a kind the name of a
 * laboratory's oscillator, "resonator", "junction" or "two_wells": ten lines in SI.
 * PENDRES_INVALID_ARGUMENT as above.
 */
pendres_status deck_init(const char *kind, FILE *out, char *why, size_t size);

#endif
