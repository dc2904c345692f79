/*
 * failed.h -- points without a whole result: why, and how the file and the terminal say so.
 *
 * Owns: the reasons, in one list for all scenes; which failures are a point's own, so that it is
 * marked and the run goes on, and which are the run's; the variable `failed`. A point's results are
 * NaN where they do not exist, and the mark says why: no error estimate stands for it.
 */
#ifndef SCENE_FAILED_H
#define SCENE_FAILED_H

#include "results/results.h"

/* Codes of `failed` in files, with their flag_meanings and what the terminal says. New reasons are
   added at the end: codes stay. */
#define SCENE_FAILURE_LIST(X)                                                                    \
  X(NONE, "none", "nothing failed")                                                              \
  X(UNRESOLVED, "unresolved", "some pendulums did not settle within their budget")               \
  X(INTEGRATION, "integration_failed", "the integrator failed")                                  \
  X(TOLERANCE, "tolerance_unreachable", "the tolerance cannot be reached")                       \
  X(NOT_CONVERGED, "not_converged", "an iteration did not converge within its budget")           \
  X(NOT_FOUND, "not_found", "nothing with the properties asked for exists")                      \
  X(REFUSED, "refused", "the parameters are beyond what can be computed")                        \
  X(NO_MEAN, "no_mean", "no pendulum has what the mean is taken of")                             \
  X(TOO_LONG, "too_long", "settling would take too many steps of the integrator")                \
  X(BUDGET, "budget", "the search could look at too few frequencies: there may be more; a "      \
                      "narrower range of the search (sweep.drive_frequency_range, in scene "     \
                      "'response' sweep.resonance_range) leaves more for each frequency")        \
  X(OUT_OF_TIME, "out_of_time", "ended by its budget of processor time: raise "                 \
                                "--budget=SECONDS, or bound its drive periods by "              \
                                "precision.period_budget")

typedef enum scene_failure {
#define SCENE_FAILURE_CODE(code, meaning, words) SCENE_FAILURE_##code,
  SCENE_FAILURE_LIST(SCENE_FAILURE_CODE)
#undef SCENE_FAILURE_CODE
  SCENE_FAILURE_COUNT
} scene_failure;

/* The reason for a status that a point's own parameters cause; SCENE_FAILURE_NONE for success and
   for what ends the run: no memory, a signal, a file, a bug. */
scene_failure scene_failure_of(pendres_status status);

/*
 * Whether pendulums of these parameters, settled `runs` times one after another, would take more
 * steps than one would wait for. Strong damping needs short steps (their length times the damping
 * stays below 4) and a long time: the rate at which an overdamped pendulum settles is one over the
 * damping, so that the number of steps goes with its square. At weak damping it goes with the
 * damping's reciprocal, and at fast drives with their frequency. It depends on the parameters
 * alone, so that the same points are refused in all runs. words[size] then says how many steps.
 */
int scene_failure_too_long(const pendres_pendulum *p, double runs, char *words, size_t size);

/* The same for a deck that may bound the drive periods of a pendulum itself, and then never takes
   too long; words[size] name that key. Charts shorten the settling of weakly damped pendulums that
   are not driven hard, where the deck's method and steps allow them. Without damping nothing
   settles: it is not asked. */
int scene_settling_too_long(const deck *d, const pendres_pendulum *p, double runs, char *words,
                            size_t size);

/* "damping 0.12, drive_period 8": a point of the deck's grid of `axes` axes, slowest first. */
void scene_point_name(const deck *d, size_t point, int axes, const deck_axis_id *axis, char *text,
                      size_t size);

/*
 * What to say of `some` of `all` pendulums ("members", "states") that did not settle, with the
 * remedy. multiplier: the largest modulus among the attractors that are known, which tells how
 * slowly the weakest of them attracts; NaN if none is known.
 */
void scene_failure_unsettled(const deck *d, size_t some, size_t all, const char *what,
                             double multiplier, char words[SCENE_TOLD]);

/* What has become of a point; all zero: it has a result. */
typedef struct scene_failed {
  scene_failure reason;
  const char *words; /* the library's own, or NULL: those of the list */
} scene_failed;

/* Mark it; the last mark counts. words are copied into the run's room. */
void scene_failure_mark(scene_run *run, scene_failed *point, scene_failure reason,
                        const char *words);

/* The names of the codes, as columns take them; NULL beyond the last. */
const char *scene_failure_names(int value);

/* Count n points that have failed. */
void scene_failure_count(scene_run *run, scene_failure reason, size_t n);

/* Tell of the points that have failed, and `where`; 0: none. Where the deck tolerates as many that
   are unresolved, these are no failure. */
int scene_failures_told(const scene_run *run, const char *where, progress *p);

/* A line for the terminal, unless there are many already. */
void scene_failure_tell(scene_run *run, scene_failure reason, const char *words,
                        const char *format, ...) __attribute__((format(printf, 4, 5)));

#endif
