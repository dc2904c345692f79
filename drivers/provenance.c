/* provenance.c -- see run.h. */
#define _POSIX_C_SOURCE 200809L /* gmtime_r */
#include "run.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>

#include "system/clock.h"

void provenance_start(provenance *p)
{
  const time_t t = time(NULL);
  struct tm utc;
  *p = (provenance){ .wall = clock_wall(), .processor = clock_process() };
  if (gmtime_r(&t, &utc) != NULL)
    (void)strftime(p->date, sizeof p->date, "%Y-%m-%dT%H:%M:%SZ", &utc);
}

double provenance_wall(const provenance *p)
{
  return clock_wall() - p->wall;
}

static pendres_status write_deck(const deck *d, pendres_store *store)
{
  char *text = NULL;
  pendres_status status = deck_resolved(d, &text);
  if (status == PENDRES_OK) {
    const pendres_store_entry entries[] = {
      { .key = "deck_name", .text = d->name, .long_name = "file that the deck was read from" },
      { .key = "deck", .text = d->text, .long_name = "the deck, verbatim" },
      { .key = "settings", .text = d->settings,
        .long_name = "keys set on the command line, in the place of the deck's" },
      { .key = "deck_resolved", .text = text, .long_name = "the deck with settings and defaults" },
    };
    status = pendres_store_provenance(store, entries, sizeof entries / sizeof *entries);
  }
  free(text);
  return status;
}

static pendres_status write_origin(const provenance *p, const deck *d, const farm *f,
                                   pendres_store *store)
{
  struct utsname host;
  char hdf5[64], system[2 * sizeof host.sysname + 2] = "";
  unsigned version[3] = { 0 };
  const int noise = deck_has_noise(d);

  if (uname(&host) != 0) memset(&host, 0, sizeof host);
  snprintf(system, sizeof system, "%s %s", host.sysname, host.machine);
  pendres_store_hdf5_version(&version[0], &version[1], &version[2]);
  snprintf(hdf5, sizeof hdf5, "%u.%u.%u", version[0], version[1], version[2]);
  const pendres_store_entry entries[] = {
    { .key = "version", .text = pendres_version(),
      .long_name = "version of resonance and libpendres" },
    { .key = "build", .text = pendres_build_info(), .long_name = "libraries and compiler" },
    { .key = "hdf5_version", .text = hdf5, .long_name = "HDF5 library in use" },
    { .key = "host", .text = host.nodename, .long_name = "name of the machine" },
    { .key = "system", .text = system, .long_name = "operating system and processor" },
    { .key = "date", .text = p->date, .long_name = "start of the run, UTC" },
    { .key = "threads", .integer = farm_threads(f), .is_integer = 1, .long_name = "threads" },
    { .key = "seed", .integer = noise ? d->noise.seed : 0, .is_integer = 1,
      .long_name = noise ? "seed of the random numbers" : "no random numbers were used" },
  };
  return pendres_store_provenance(store, entries, sizeof entries / sizeof *entries);
}

/* Not where tolerances are compared: they are a dimension of the file, and h5netcdf does not open a
   group with a number that has the name of a dimension above it. */
static pendres_status write_tolerance(const deck *d, pendres_store *store)
{
  const pendres_store_entry entry = { .key = "tolerance", .number = d->precision.tolerance,
                                      .long_name = "tolerance of the results" };
  if (d->axis[DECK_AXIS_TOLERANCE].count > 0) return PENDRES_OK;
  return pendres_store_provenance(store, &entry, 1);
}

static pendres_status write_cost(const provenance *p, const farm *f, size_t failed_points,
                                 pendres_store *store)
{
  pendres_cost cost;
  farm_cost(f, &cost);
  const pendres_store_entry entries[] = {
    { .key = "wall_time", .number = clock_wall() - p->wall, .units = "s",
      .long_name = "duration of the run" },
    { .key = "processor_time", .number = clock_process() - p->processor, .units = "s",
      .long_name = "processor time of all threads" },
    { .key = "pendulum_periods", .number = cost.pendulum_periods,
      .long_name = "drive periods, summed over pendulums" },
    { .key = "rhs_evaluations", .number = cost.rhs_evaluations,
      .long_name = "right-hand sides, one a pendulum, stage and step" },
    { .key = "integrator_steps", .number = cost.steps,
      .long_name = "steps of the integrators, summed over pendulums" },
    { .key = "newton_steps", .number = cost.newton_steps,
      .long_name = "Newton iterations on the stroboscopic map" },
    { .key = "settled_pendulums", .number = cost.settled_pendulums,
      .long_name = "pendulums that were asked what they settle on" },
    { .key = "periods_per_settled_pendulum",
      .number = cost.settled_pendulums > 0.0 ? cost.pendulum_periods / cost.settled_pendulums : NAN,
      .long_name = "drive periods of the whole run for each settled pendulum" },
    { .key = "budget", .number = farm_budget(f) > 0.0 ? farm_budget(f) : NAN, .units = "s",
      .long_name = "processor time after which a point was given up (NaN: never)" },
    { .key = "points_given_up", .integer = (int64_t)farm_points_lost(f), .is_integer = 1,
      .long_name = "points that this budget has ended, and that a faster machine may not end" },
    { .key = "failed_points", .integer = (int64_t)failed_points, .is_integer = 1,
      .long_name = "points without a result" },
  };
  return pendres_store_provenance(store, entries, sizeof entries / sizeof *entries);
}

pendres_status provenance_write(const provenance *p, const deck *d, const farm *f,
                                size_t failed_points, pendres_store *store)
{
  pendres_status status = write_deck(d, store);
  if (status == PENDRES_OK) status = write_origin(p, d, f, store);
  if (status == PENDRES_OK) status = write_tolerance(d, store);
  if (status == PENDRES_OK) status = write_cost(p, f, failed_points, store);
  return status;
}
