/* deck_fixture.h -- what the tests of decks share. */
#ifndef DECK_FIXTURE_H
#define DECK_FIXTURE_H

#include "check.h"

#include <stdlib.h>
#include <string.h>

#include "deck/deck.h"

/* Read a deck that must be good. The caller frees it. */
static inline deck read_good(const char *text)
{
  deck d = { 0 };
  namelist_errors errors = { 0 };
  const pendres_status status = deck_read_memory("input/t.nml", text, strlen(text), &d, &errors);
  if (status != PENDRES_OK) {
    print_error("in \"%s\"\n", text);
    namelist_errors_print(&errors, stderr);
  }
  assert_int_equal(status, PENDRES_OK);
  assert_int_equal(errors.count, 0);
  namelist_errors_free(&errors);
  return d;
}

static inline char *dump(const deck *d)
{
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  assert_non_null(out);
  assert_int_equal(deck_dump(d, out), PENDRES_OK);
  fclose(out);
  return text;
}

static inline void assert_axis_equal(const deck_axis *a, const deck_axis *b)
{
  assert_int_equal(a->count, b->count);
  if (a->count > 0) assert_memory_equal(a->value, b->value, a->count * sizeof *a->value);
}

static inline void assert_names_equal(const deck_names *a, const deck_names *b)
{
  assert_int_equal(a->count, b->count);
  for (size_t i = 0; i < a->count; i++) assert_string_equal(a->name[i], b->name[i]);
}

/* All that a deck means; memory_equal so that NaN equals NaN. */
static inline void assert_deck_equal(const deck *a, const deck *b)
{
  assert_int_equal(a->kind, b->kind);
  assert_string_equal(a->title, b->title);
  assert_string_equal(a->output, b->output);
  assert_memory_equal(&a->pendulum, &b->pendulum, sizeof a->pendulum);
  assert_memory_equal(&a->drive_period, &b->drive_period, sizeof(double));
  assert_int_equal(a->by_period, b->by_period);
  for (int i = 0; i < DECK_AXIS_COUNT; i++) assert_axis_equal(&a->axis[i], &b->axis[i]);
  assert_memory_equal(a->search, b->search, sizeof a->search);
  assert_memory_equal(&a->ensemble, &b->ensemble, sizeof a->ensemble);
  assert_memory_equal(&a->precision.tolerance, &b->precision.tolerance, sizeof(double));
  assert_string_equal(a->precision.method, b->precision.method);
  assert_string_equal(a->precision.table, b->precision.table);
  assert_int_equal(a->precision.steps_per_period, b->precision.steps_per_period);
  assert_int_equal(a->precision.block_lanes, b->precision.block_lanes);
  assert_int_equal(a->precision.period_budget, b->precision.period_budget);
  assert_memory_equal(&a->precision.exponent_error, &b->precision.exponent_error, sizeof(double));
  assert_string_equal(a->orbit.start, b->orbit.start);
  assert_memory_equal(&a->orbit.x, &b->orbit.x, 2 * sizeof(double));
  assert_int_equal(a->orbit.periods, b->orbit.periods);
  assert_int_equal(a->orbit.samples, b->orbit.samples);
  assert_int_equal(a->orbit.transient, b->orbit.transient);
  assert_memory_equal(&a->noise, &b->noise, sizeof a->noise);
  assert_int_equal(a->diagram.strobes, b->diagram.strobes);
  assert_memory_equal(&a->lyapunov, &b->lyapunov, sizeof a->lyapunov);
  assert_int_equal(a->basins.refine, b->basins.refine);
  assert_int_equal(a->basins.boundary, b->basins.boundary);
  assert_int_equal(a->basins.statistics, b->basins.statistics);
  assert_int_equal(a->basins.strobes, b->basins.strobes);
  assert_int_equal(a->basins.trajectories, b->basins.trajectories);
  assert_string_equal(a->basins.by, b->basins.by);
  assert_true(a->ramp.rate == b->ramp.rate || (isnan(a->ramp.rate) && isnan(b->ramp.rate)));
  assert_int_equal(a->ramp.points, b->ramp.points);
  assert_int_equal(a->ramp.protocol.count, b->ramp.protocol.count);
  for (size_t i = 0; i < a->ramp.protocol.count; i++)
    assert_true(a->ramp.protocol.number[i] == b->ramp.protocol.number[i]);
  assert_names_equal(&a->methods, &b->methods);
  assert_string_equal(a->unit, b->unit);
  assert_names_equal(&a->cases, &b->cases);
  assert_memory_equal(&a->units, &b->units, sizeof a->units);
}

/* A deck with mistakes, and every error in order: its position, and words of the message after a
   blank. */
typedef struct bad_deck {
  const char *text;
  const char *error[8];
} bad_deck;

/* Is a deck refused with these errors, and nothing applied? */
static inline int is_refused(const bad_deck *bad)
{
  deck d;
  namelist_errors errors = { 0 };
  size_t wanted = 0;
  memset(&d, 0x55, sizeof d);
  const pendres_status status = deck_read_memory("input/t.nml", bad->text, strlen(bad->text), &d,
                                                 &errors);
  const deck zero = { 0 };
  while (wanted < 8 && bad->error[wanted] != NULL) wanted++;
  int good_errors = errors.count == wanted;
  for (size_t k = 0; k < wanted && k < errors.count; k++) {
    char position[60];
    const char *words = strchr(bad->error[k], ' ');
    snprintf(position, sizeof position, "input/t.nml:%.*s: error: ", (int)(words - bad->error[k]),
             bad->error[k]);
    if (strncmp(errors.item[k].text, position, strlen(position)) != 0) good_errors = 0;
    if (strstr(errors.item[k].text, words + 1) == NULL) good_errors = 0;
    if (strchr(errors.item[k].text, '^') == NULL) good_errors = 0;
  }
  if (!good_errors) {
    print_error("case:\n%s\n", bad->text);
    namelist_errors_print(&errors, stderr);
  }
  namelist_errors_free(&errors);
  assert_int_equal(status, PENDRES_INVALID_ARGUMENT);
  assert_memory_equal(&d, &zero, sizeof d);
  return good_errors;
}

#define ONE "&pendulum drive_amplitude=0.2 damping=0.12 drive_period=8 /\n"

static const char *const good[] = {
  "&scene kind='free_oscillation' /\n&sweep amplitude=0.1 amplitude_range=0.5,3.1,60 /\n",
  "&scene kind='resonance_curve', title='Fig. 2' /\n&pendulum drive_amplitude=0.2 /\n"
  "&sweep damping=0.165,0.24,0.32 damping_range=0.06,1.0,95 drive_frequency_range=0.5,1.2 /\n"
  "&precision tolerance=1e-8 /\n",
  "&scene kind='resonance_curve' output='a''b.h5' /\n&pendulum drive_amplitude=0.1 damping=0.3 /\n"
  "&ensemble members=64 x_first=-1 x_last=1 v=0.25 /\n"
  "&precision tolerance=1d-10 method='block_adaptive' table='vern9' steps_per_period=40\n"
  " block_lanes=64 period_budget=1000 /\n",
  "&scene kind='response' /\n&pendulum drive_amplitude=0.2 /\n"
  "&sweep damping=0.24,0.32 drive_period_range=5,10,101 /\n",
  "&scene kind='response' /\n&pendulum drive_amplitude=0.2 temperature=1e-3 damping=0.5 /\n"
  "&sweep drive_frequency=0.9 /\n&noise seed=9223372036854775807 trajectories=64 periods=10 /\n",
  "&scene kind='orbit' /\n" ONE "&orbit start='LA ' periods=3 samples=512 /\n",
  "&scene kind='orbit' /\n&pendulum drive_amplitude=0 damping=0 drive_frequency=0.7 /\n"
  "&orbit x=0.3 v=-1 transient=.true. /\n",
  "&scene kind='basins' /\n" ONE "&sweep x_range=-1.5,4.7,1024 v=0 /\n",
  "&scene kind='basins' /\n" ONE "&sweep x_range=-1.5,4.7,100000 v_range=-2,2,100000 /\n"
  "&basins refine=T boundary=T statistics=F /\n",
  "&scene kind='basins' /\n" ONE "&sweep x=0,1 v=0 temperature=1e-4,1e-3 /\n"
  "&basins strobes=10 seed=7 trajectories=8 /\n",
  "&scene kind='phase_diagram' /\n&pendulum drive_amplitude=0.2 /\n"
  "&sweep damping_range=0.06,0.2,200 drive_frequency_range=0.7,0.9,200 /\n",
  "&scene kind='branches' /\n&pendulum drive_amplitude=0.2 /\n"
  "&sweep damping=0.13,0.14,0.15 drive_frequency_range=0.7,0.9,200 /\n",
  "&scene kind='work_precision' /\n&sweep method='block_fixed','gsl_rk8pd' tolerance=1e-4,1e-13 "
  "unit='sweep' /\n",
  "&scene kind='hard_cases' /",
  "&scene kind='hard_cases' /\n&sweep case='separatrix', 'tolerance' /",
  "&scene kind='switching' /\n" ONE "&sweep temperature_range=1e-3,1e-2,5 /\n",
  "&scene kind='switching' /\n" ONE "&sweep temperature=0.01 /\n&switching from=1, to=3 /\n",
  "&scene kind='orbit' /\n" ONE "&orbit start='2' /\n",
  "&scene kind='hysteresis' /\n&pendulum drive_amplitude=0.2 damping=0.12 /\n"
  "&sweep drive_frequency_range=0.6,0.9,31 /\n&hysteresis start='sa' /\n",
  "&scene kind='hysteresis' /\n&pendulum drive_period=8 damping=0.12 /\n"
  "&sweep drive_amplitude=0.1,0.3 /\n&hysteresis x=1 v=0.5 /\n",
  "&scene kind='hysteresis' /\n&pendulum drive_period=8 damping=0.12 temperature=0.01 /\n"
  "&sweep drive_amplitude=0.1,0.3 /\n"
  "&hysteresis x=1 protocol=0,0.1,50,0.1,2000,0.3 points=7 /\n&noise seed=3 /\n",
  "&scene kind='bifurcation_diagram' /\n&pendulum drive_frequency=0.66 damping=0.5 /\n"
  "&sweep drive_amplitude_range=1.0,1.1,9 /\n&bifurcation_diagram x=1 v=0.1 strobes=50 /\n",
  "&scene kind='lyapunov_map' /\n&pendulum drive_frequency=0.66 /\n"
  "&sweep drive_amplitude_range=0.5,1.5,9 damping=0.2,0.5 /\n"
  "&lyapunov_map x=1 v=0.1 transient=50 periods=64 /\n",
  "&scene kind='phase_diagram' /\n&pendulum drive_amplitude=0.2 /\n"
  "&sweep damping=0.1 drive_frequency_range=0.7,0.9,200 /\n"
  "&ensemble shape='rectangle' members=64 rows=8 v=-1 v_last=1 /\n",
  "&scene kind='response' /\n&pendulum drive_amplitude=0.2 damping=0.1 /\n"
  "&sweep drive_period=8 /\n"
  "&ensemble shape='random' v=-1 v_last=1 seed=3 /\n",
  "&scene kind='fit' /\n&data file='a.csv' columns='1','volts','direction=3' /\n"
  "&fit free='damping','a1','frequency_scale' fixed='offset 0.1' bounds='a1 0 2' huber=2 /\n"
  "&pendulum force='polynomial' drive_amplitude=0.1 /\n",
  "&scene kind='escape' /\n&pendulum drive_amplitude=0 drive_frequency=1 damping=0.5 /\n"
  "&sweep torque=0.5,0.8 /\n&escape x=2.5 v=0.1 /\n",
};

enum { GOOD = sizeof good / sizeof *good };

#endif
