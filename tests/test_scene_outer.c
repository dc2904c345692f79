/*
 * test_scene_outer.c -- scenes with an outer axis: what they write of each of its values is, bit
 * for bit, what a deck with that value alone writes, whatever the kind and the threads.
 */
#include "scene_fixture.h"

#include <math.h>

#include "scenes/outer.h"

enum { VALUES = 3 };

static pendres_status run_all(scene_run *run)
{
  return scene_run_all(run, scene_find(run->deck->kind));
}

/* A variable of numbers, of any rank. */
typedef struct array {
  int rank;
  uint64_t size[PENDRES_STORE_RANK], n;
  double *value;
} array;

static array read_array(pendres_store *store, const char *name)
{
  array a;
  size_t n = 0;
  check_ok(pendres_store_shape(store, "", name, &a.rank, a.size));
  a.value = scene_values(store, name, &n);
  a.n = n;
  return a;
}

/* Is it where the padding of an array begins: NaN, or -1 of whole numbers? */
static void check_padding(double x)
{
  assert_true(isnan(x) || x == -1.0);
}

/* The element of the slice of `whole` at the place of element i in the single one; how many of the
   slice's elements have a counterpart is counted by the caller. */
static size_t place_in(const array *whole, const array *one, size_t i)
{
  size_t at = 0, step = 1;
  for (int k = one->rank - 1; k >= 0; k--) {
    at += i % one->size[k] * step;
    i /= one->size[k];
    step *= whole->size[k + 1];
  }
  return at;
}

static void check_slice(pendres_store *whole_store, size_t slice, pendres_store *one_store,
                        const char *name)
{
  array whole = read_array(whole_store, name), one = read_array(one_store, name);
  if (whole.rank == one.rank) { /* a dimension, which all slices share, or its numbers */
    assert_true(whole.n >= one.n);
  } else {
    assert_int_equal(whole.rank, one.rank + 1);
    const size_t each = (size_t)(whole.n / whole.size[0]);
    const double *from = whole.value + slice * each;
    char *seen = calloc(each + 1, 1);
    assert_non_null(seen);
    for (size_t i = 0; i < one.n; i++) {
      const size_t at = place_in(&whole, &one, i);
      if (memcmp(&from[at], &one.value[i], sizeof *from) != 0)
        print_error("%s, slice %zu, element %zu: %.17g, alone %.17g\n", name, slice, i, from[at],
                    one.value[i]);
      assert_memory_equal(&from[at], &one.value[i], sizeof *from);
      seen[at] = 1;
    }
    for (size_t i = 0; i < each; i++)
      if (!seen[i]) check_padding(from[i]);
    free(seen);
  }
  free(whole.value);
  free(one.value);
}

/* All numbers of the single run's file are in that of all; how many variables there are. */
static size_t check_slices(const char *whole, size_t slice, const char *one)
{
  pendres_store *whole_store = scene_open(whole), *one_store = scene_open(one);
  char *name = NULL;
  pendres_store_type type;
  size_t count = 0;
  for (uint64_t i = 0; pendres_store_member(one_store, "", i, &type, &name) == PENDRES_OK; i++) {
    if (type != PENDRES_STORE_STRING && type != PENDRES_STORE_TYPE_COUNT) {
      check_slice(whole_store, slice, one_store, name);
      count++;
    }
    free(name);
  }
  pendres_store_free(whole_store);
  pendres_store_free(one_store);
  return count;
}

/* A deck without the number, which is set in decks of all values and of one. A polynomial's has its
   tolerance, since the default follows the unit of length of the value of the largest size. */
typedef struct sample {
  const char *name, *deck, *key, *group;
  double value[VALUES];
} sample;

static const sample samples[] = {
  {"response", "&scene kind = 'response' /\n&ensemble members = 5 /\n&pendulum damping = 0.2 /\n"
   "&sweep drive_frequency_range = 0.6, 0.9, 4 /\n", "drive_amplitude", "pendulum",
   {0.1, 0.2, 0.4}},
  {"curve", "&scene kind = 'resonance_curve' /\n&ensemble members = 5 /\n"
   "&sweep damping = 0.2, 0.3 /\n", "drive_amplitude", "pendulum", {0.1, 0.2, 0.3}},
  {"hysteresis", "&scene kind = 'hysteresis' /\n&pendulum damping = 0.15 /\n"
   "&sweep drive_frequency_range = 0.65, 0.9, 6 /\n&hysteresis start = 'sa' /\n",
   "drive_amplitude", "pendulum", {0.05, 0.2, 0.3}},
  {"branches", "&scene kind = 'branches' /\n&ensemble members = 4 /\n&pendulum damping = 0.15 /\n"
   "&sweep drive_frequency_range = 0.7, 0.9, 3 /\n", "drive_amplitude", "pendulum",
   {0.05, 0.2, 0.3}},
  {"basins", "&scene kind = 'basins' /\n&pendulum damping = 0.12, drive_period = 8 /\n"
   "&sweep x_range = -1.5, 4.7, 12, v_range = -2, 2, 12 /\n", "drive_amplitude", "pendulum",
   {0.1, 0.2, 0.3}},
  {"clock", "&scene kind = 'basins' /\n&pendulum damping = 0.12, drive_amplitude = 0.2 /\n"
   "&sweep x_range = -1.5, 4.7, 8, v_range = -2, 2, 8 /\n", "drive_period", "pendulum",
   {7.5, 8, 9}},
  {"coefficient", "&scene kind = 'basins' /\n&pendulum damping = 0.1, drive_frequency = 1.3,\n"
   "  drive_amplitude = 0.3, force = 'polynomial', force_coefficients = 1 /\n"
   "&sweep x_range = -3, 3, 8, v_range = -3, 3, 8 /\n&precision tolerance = 1e-9 /\n&ANY /\n",
   "a3", "sweep", {0.2, 0.3, 0.5}},
  {"members", "&scene kind = 'response' /\n&pendulum damping = 0.2, drive_amplitude = 0.2 /\n"
   "&sweep drive_frequency_range = 0.6, 0.9, 4 /\n", "ensemble.members", "ensemble",
   {3, 4, 7}},
};

/* Put the deck of a sample together; slice < 0: that of all values. */
static void make_deck(const sample *s, int slice, char text[1000])
{
  const char *dot = strchr(s->key, '.'), *name = dot != NULL ? dot + 1 : s->key;
  const char *any = strstr(s->deck, "&ANY /\n");
  const int length = any != NULL ? (int)(any - s->deck) : (int)strlen(s->deck);
  if (slice < 0) {
    snprintf(text, 1000, "%.*s&outer key = '%s', values = %.17g, values_range = %.17g, %.17g, 2 "
             "/\n", length, s->deck, s->key, s->value[1], s->value[0], s->value[2]);
    return;
  }
  if (any != NULL) { /* a coefficient */
    const char *at = strstr(s->deck, "force_coefficients = 1");
    const int before = (int)(at - s->deck) + (int)strlen("force_coefficients = 1");
    snprintf(text, 1000, "%.*s, 0, %.17g%.*s", before, s->deck, s->value[slice], length - before,
             s->deck + before);
    return;
  }
  char group[80];
  snprintf(group, sizeof group, "&%s ", s->group);
  const char *at = strstr(s->deck, group);
  if (at == NULL) {
    snprintf(text, 1000, "%s%s%s = %.17g /\n", s->deck, group, name, s->value[slice]);
    return;
  }
  const int before = (int)(at - s->deck) + (int)strlen(group);
  snprintf(text, 1000, "%.*s%s = %.17g, %s", before, s->deck, name, s->value[slice],
           s->deck + before);
}

static void slices_are_single_runs(void **state)
{
  char text[1000];
  (void)state;
  for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
    const sample *s = &samples[i];
    make_deck(s, -1, text);
    scene_run_deck_by(run_all, text, 1, "whole");
    scene_run_deck_by(run_all, text, 3, "again");
    scene_check_same_bytes("whole", "again");
    for (int k = 0; k < VALUES; k++) {
      make_deck(s, k, text);
      scene_run_deck(text, 2, "one");
      assert_true(check_slices("whole", (size_t)k, "one") > 10);
    }
  }
}

/* The axis is there in each group, and lengths of what differs are told. */
static void what_differs_is_counted(void **state)
{
  char text[1000];
  size_t n = 0;
  (void)state;
  make_deck(&samples[4], -1, text);
  scene_run_deck_by(run_all, text, 2, "basins");
  pendres_store *store = scene_open("basins");
  double *axis = scene_values(store, "drive_amplitude", &n);
  assert_int_equal(n, 3);
  for (int k = 0; k < VALUES; k++) assert_true(axis[k] == samples[4].value[k]);
  double *count = scene_values(store, "attractor_length", &n);
  assert_true(n == 3 && count[0] == 1.0 && count[1] == 2.0 && count[2] == 1.0);
  double *share = scene_values(store, "basin_fraction", &n);
  assert_int_equal(n, 6);
  assert_true(isnan(share[1]) && isnan(share[5]));
  check_near(share[0], 1.0, 1e-14);
  check_near(share[2] + share[3], 1.0, 1e-14);
  check_near(share[4], 1.0, 1e-14);
  double *label = scene_values(store, "attractor_label", &n);
  assert_true(label[1] == -1.0 && label[5] == -1.0);
  assert_true(pendres_store_has(store, "cut", "drive_amplitude"));
  pendres_store_free(store);
  free(axis), free(count), free(share), free(label);
}

/* A value at which the scene has no result is marked, and the others have theirs. */
static void one_that_fails_is_marked(void **state)
{
  static const char deck_text[] =
    "&scene kind = 'basins' /\n&pendulum drive_amplitude = 0.2, drive_period = 8 /\n"
    "&sweep x_range = -1.5, 4.7, 8, v_range = -2, 2, 8 /\n"
    "&outer key = 'damping', values = 1e-7, 0.12 /\n";
  size_t n = 0;
  (void)state;
  assert_int_equal(scene_run_marked(run_all, deck_text, 1, "failed"), 1);
  assert_non_null(strstr(scene_told, "damping 1e-07, "));
  pendres_store *store = scene_open("failed");
  double *failed = scene_values(store, "outer_failed", &n);
  assert_true(n == 2 && failed[0] != 0.0 && failed[1] == 0.0);
  double *share = scene_values(store, "basin_fraction", &n);
  assert_int_equal(n, 4);
  assert_true(isnan(share[0]) && isnan(share[1]));
  check_near(share[2] + share[3], 1.0, 1e-14);
  pendres_store_free(store);
  free(failed), free(share);
}

#define SWEEP "&scene kind = 'hysteresis' /\n&hysteresis start = 'sa' /\n" \
  "&sweep drive_frequency_range = 0.65, 0.9, 6 /\n"

static void what_is_no_outer_axis_is_told(void **state)
{
  static const struct { const char *rest, *words; } bad[] = {
    {"&pendulum drive_amplitude = 0.2, damping = 0.1 /\n&outer key = 'damping', values = 1 /\n",
     "'damping' has its values in &outer"},
    {"&pendulum drive_amplitude = 0.2 /\n&outer key = 'dampin', values = 1 /\n",
     "did you mean 'damping'?"},
    {"&pendulum drive_amplitude = 0.2 /\n&outer key = 'damping', values = -1 /\n",
     "'damping' must be positive"},
    {"&pendulum drive_amplitude = 0.2 /\n&outer key = 'damping' /\n", "an outer axis has both"},
    {"&pendulum drive_amplitude = 0.2, damping = 0.1 /\n&outer values = 1 /\n",
     "an outer axis has both"},
    {"&pendulum drive_amplitude = 0.2, damping = 0.1 /\n&outer key = 'a3', values = 1 /\n",
     "a pendulum's force has no 'force_coefficients'"},
    {"&pendulum drive_amplitude = 0.2, damping = 0.1 /\n"
     "&outer key = 'points', values = 10.5 /\n", "takes whole numbers"},
  };
  char text[1000];
  (void)state;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    snprintf(text, sizeof text, "%s%s", SWEEP, bad[i].rest);
    scene_check_refused(text, bad[i].words);
  }
  scene_check_refused("&scene kind = 'hysteresis' /\n&hysteresis start = 'sa' /\n"
                      "&pendulum damping = 0.1 /\n&sweep drive_frequency = 0.7, 0.8,\n"
                      "  drive_amplitude = 0.1, 0.2 /\n",
                      "&outer takes several values of one more");
  scene_check_refused("&scene kind = 'response' /\n"
                      "&pendulum damping = 0.2, drive_amplitude = 0.2 /\n"
                      "&sweep drive_frequency = 0.7, 0.8 /\n"
                      "&ensemble shape = 'rectangle', rows = 3, v_last = 1 /\n"
                      "&outer key = 'ensemble.members', values = 6, 7, 9 /\n",
                      "with ensemble.members = 7.0: 'members' must make whole 'rows'");
  scene_check_refused("&scene kind = 'response' /\n&pendulum drive_amplitude = 0.2 /\n"
                      "&sweep drive_frequency = 0.7, 0.8 /\n"
                      "&outer key = 'damping', values = 0.1, 0.2 /\n",
                      "is an axis of the results without &outer");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(slices_are_single_runs),
    cmocka_unit_test(what_differs_is_counted),
    cmocka_unit_test(one_that_fails_is_marked),
    cmocka_unit_test(what_is_no_outer_axis_is_told),
  };
  return cmocka_run_group_tests(tests, scene_enter, scene_leave);
}
