/*
 * fuzz_data.c -- any bytes in the place of a fit's data: they are data, all of them finite and in
 * range, or refused with words. The first byte says what the deck asks for. A comment behind them
 * changes nothing.
 */
#include "fuzz/fuzz_limit.h"

#include <math.h>

#include "scenes/fit/data.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* What is asked of the file. */
static const char *const data_keys[] = {
  "",
  "columns = 'frequency', 'volts', 'error', 'direction', 'drive_amplitude=drive'\n"
  "observable = 'first_harmonic_amplitude'",
  "columns = '1', '2', '3' observable = 'amplitude', 'phase_lag'",
  "axis = 'time'",
  "columns = '1', 'direction=2' observable = 'jump'",
  "axis = 'torque' observable = 'mean_velocity' direction = 'down'",
};

enum { DATA_KEYS = sizeof data_keys / sizeof *data_keys };

static void data_check(const fit_data *read)
{
  REQUIRE(read->of.n > 0 && read->of.datum != NULL);
  for (size_t i = 0; i < read->of.n; i++) {
    const pendres_fit_datum *one = &read->of.datum[i];
    REQUIRE(isfinite(one->axis) && isfinite(one->other) && isfinite(one->observed));
    REQUIRE(isfinite(one->error) && one->error >= 0.0 && abs(one->direction) <= 1);
    REQUIRE((int)one->observable >= 0 && one->observable < PENDRES_FIT_OBSERVABLE_COUNT);
  }
}

/* Read the file as a deck says; what is read stays in the run's room. */
static pendres_status data_read(const char *path, const char *keys, scene_run *run, fit_data *out)
{
  char text[600];
  deck d;
  namelist_errors errors = { 0 };
  snprintf(text, sizeof text, "&scene kind = 'fit', output = '%s.h5' /\n&data file = '%s' %s /\n"
           "&fit free = 'damping' /\n&pendulum drive_amplitude = 0.1, damping = 0.1 /\n", path,
           path, keys);
  const pendres_status known = deck_read_memory("fuzz.nml", text, strlen(text), &d, &errors);
  if (known != PENDRES_OK) namelist_errors_print(&errors, stderr);
  REQUIRE(known == PENDRES_OK);
  *run = (scene_run){ .deck = &d };
  fit_data_read(run, out);
  REQUIRE(run->status == PENDRES_OK || run->message[0] != '\0');
  if (run->status == PENDRES_OK) data_check(out);
  deck_free(&d);
  namelist_errors_free(&errors);
  return run->status;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static const char comment[] = "\n# a comment, with 1.0, 2.0\n";
  char path[64];
  scene_run one, other;
  fit_data first, second;
  if (size < 1) return 0;
  const char *keys = data_keys[data[0] % DATA_KEYS];
  uint8_t *more = malloc(size + sizeof comment);
  REQUIRE(more != NULL);
  memcpy(more, data + 1, size - 1);
  memcpy(more + size - 1, comment, sizeof comment - 1);
  fuzz_path(path, sizeof path, "data.txt");
  fuzz_save(path, data + 1, size - 1);
  const pendres_status status = data_read(path, keys, &one, &first);
  const int stored = size > 4 && memcmp(data + 1, "\211HDF", 4) == 0;
  if (!stored) {
    fuzz_save(path, more, size - 1 + sizeof comment - 1);
    REQUIRE(data_read(path, keys, &other, &second) == status);
    if (status == PENDRES_OK)
      REQUIRE(first.of.n == second.of.n && memcmp(first.of.datum, second.of.datum,
                                                  first.of.n * sizeof *first.of.datum) == 0);
    scene_room_end(&other.room);
  }
  scene_room_end(&one.room);
  free(more);
  REQUIRE(unlink(path) == 0);
  return 0;
}
