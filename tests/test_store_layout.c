/*
 * test_store_layout.c -- where the numbers of a file lie: where readers other than HDF5 find them
 * too, and under a checksum each.
 */
#include "store_files.h"

#include <math.h>

enum { ROWS = 3, COLUMNS = 81, LONG = 40000 };

/* Kinds of numbers: a scalar, few, just below and above what is divided into chunks, many; some not
   compressed. */
static void write_kinds(const char *path)
{
  double values[ROWS * COLUMNS], *many = malloc(LONG * sizeof *many);
  const int8_t labels[ROWS] = { 0, -1, 7 };
  const int64_t count = -42;
  const char *const text = "text";
  pendres_store *store = NULL;

  assert_non_null(many);
  for (size_t i = 0; i < LENGTH(values); i++) values[i] = 1.0 / (double)(i + 3);
  for (size_t i = 0; i < LONG; i++) many[i] = sin((double)i);
  OK(pendres_store_create(path, &(pendres_store_options){ .title = "kinds" }, &store));
  OK(pendres_store_dimension(store, &(pendres_store_spec){ .name = "row", .long_name = "row" },
                             ROWS, NULL));
  OK(pendres_store_dimension(store, &(pendres_store_spec){ .name = "column",
       .long_name = "column" }, COLUMNS, values));
  OK(pendres_store_dimension(store, &(pendres_store_spec){ .name = "many", .long_name = "many" },
                             LONG, many));
  OK(pendres_store_dimension(store, &(pendres_store_spec){ .name = "none", .long_name = "none" },
                             0, NULL));
  OK(pendres_store_put(store, &(pendres_store_spec){ .name = "scalar", .long_name = "scalar" },
                       &values[7], &values[8], 1));
  OK(pendres_store_put(store, &(pendres_store_spec){ .name = "count", .long_name = "count",
       .type = PENDRES_STORE_INT64 }, &count, NULL, 1));
  OK(pendres_store_put(store, &(pendres_store_spec){ .name = "text", .long_name = "text",
       .type = PENDRES_STORE_STRING }, &text, NULL, 1));
  OK(pendres_store_put(store, &(pendres_store_spec){ .name = "amplitude",
       .long_name = "amplitude", .dimensions = { "row", "column" } }, values, NULL,
       LENGTH(values)));
  OK(pendres_store_put(store, &(pendres_store_spec){ .name = "label", .long_name = "label",
       .type = PENDRES_STORE_INT8, .dimensions = { "row" } }, labels, NULL, ROWS));
  OK(pendres_store_put(store, &(pendres_store_spec){ .name = "plainly", .long_name = "plainly",
       .dimensions = { "many" }, .deflate = -1 }, many, NULL, LONG));
  OK(pendres_store_close(store));
  pendres_store_free(store);
  free(many);
}

/* What is asked of each dataset, and how many there were. */
typedef struct look {
  void (*at)(struct look *l, const char *name, hid_t id, hid_t creation);
  const char *path;
  int seen;
} look;

static herr_t look_at(hid_t root, const char *name, const H5L_info_t *info, void *arg)
{
  look *l = arg;
  const hid_t id = H5Dopen2(root, name, H5P_DEFAULT);

  (void)info;
  if (id < 0) return 0; /* a group */
  const hid_t creation = H5Dget_create_plist(id);
  l->at(l, name, id, creation);
  l->seen++;
  H5Pclose(creation);
  H5Dclose(id);
  return 0;
}

static int look_at_all(look *l)
{
  const hid_t file = H5Fopen(l->path, H5F_ACC_RDONLY, H5P_DEFAULT);

  assert_true(file >= 0);
  assert_true(H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, NULL, look_at, l) >= 0);
  H5Fclose(file);
  return l->seen;
}

static void layout_of(look *l, const char *name, hid_t id, hid_t creation)
{
  const H5D_layout_t layout = H5Pget_layout(creation);
  const int filters = layout == H5D_CHUNKED ? H5Pget_nfilters(creation) : 0;
  unsigned flags;
  size_t none = 0;

  (void)l;
  (void)id;
  assert_int_not_equal(layout, H5D_COMPACT);
  for (int i = 0; i < filters; i++) {
    const H5Z_filter_t filter =
      H5Pget_filter2(creation, (unsigned)i, &flags, &none, NULL, 0, NULL, NULL);
    assert_int_equal(filter == H5Z_FILTER_FLETCHER32, !strcmp(name, "plainly"));
  }
  assert_int_equal(layout == H5D_CHUNKED, !strcmp(name, "many") || !strcmp(name, "plainly"));
}

static void nothing_is_in_a_header(void **state)
{
  char path[PATH_ROOM];
  look l = { .at = layout_of, .path = in_folder(path, "kinds.h5") };

  (void)state;
  write_kinds(path);
  assert_int_equal(look_at_all(&l), 11);
}

/* Verify, with one bit of a byte changed. */
static pendres_status verify_changed(const char *path, haddr_t offset, int bit)
{
  FILE *f = fopen(path, "r+b");
  pendres_store *store = NULL;
  uint64_t count;

  assert_non_null(f);
  assert_int_equal(fseek(f, (long)offset, SEEK_SET), 0);
  const int byte = fgetc(f);
  assert_int_equal(fseek(f, (long)offset, SEEK_SET), 0);
  fputc(byte ^ 1 << bit, f);
  fclose(f);
  pendres_status status = pendres_store_open(path, &store);
  if (!status) status = pendres_store_verify(store, &count);
  pendres_store_free(store);
  f = fopen(path, "r+b");
  assert_int_equal(fseek(f, (long)offset, SEEK_SET), 0);
  fputc(byte, f);
  fclose(f);
  return status;
}

enum { MOST_PLACES = 64 };
static struct {
  haddr_t at[MOST_PLACES];
  hsize_t size[MOST_PLACES];
  int n;
} places;

/* The bytes of numbers. */
static void places_of(look *l, const char *name, hid_t id, hid_t creation)
{
  (void)l;
  if (!strcmp(name, "text")) return;
  if (H5Pget_layout(creation) == H5D_CONTIGUOUS) {
    places.at[places.n] = H5Dget_offset(id);
    places.size[places.n] = H5Dget_storage_size(id);
    if (places.size[places.n]) places.n++;
    return;
  }
#if H5_VERSION_GE(1, 10, 5)
  const hid_t space = H5Dget_space(id);
  hsize_t chunks = 0, start[1];
  unsigned mask;

  assert_true(H5Dget_num_chunks(id, space, &chunks) >= 0);
  for (hsize_t i = 0; i < chunks && places.n < MOST_PLACES; i++, places.n++)
    assert_true(H5Dget_chunk_info(id, space, i, start, &mask, &places.at[places.n],
                                  &places.size[places.n]) >= 0);
  H5Sclose(space);
#endif
}

static void each_changed_bit_is_told(void **state)
{
  char path[PATH_ROOM];
  look l = { .at = places_of, .path = in_folder(path, "bits.h5") };
  int tried = 0;

  (void)state;
  write_kinds(path);
  places.n = 0;
  look_at_all(&l);
  assert_true(places.n >= 8);
  for (int i = 0; i < places.n; i++) {
    const hsize_t step = 1 + places.size[i] / 40;

    for (hsize_t k = 0; k < places.size[i]; k += step, tried++)
      if (verify_changed(path, places.at[i] + k, (int)(k % 8)) != PENDRES_IO) {
        print_error("byte %d of %d of place %d: not told\n", (int)k, (int)places.size[i], i);
        fail();
      }
  }
  assert_true(tried > 200);
  WITH_STATUS(verify_changed(path, 0, 7), assert_int_not_equal(status_, PENDRES_OK));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    TEST(nothing_is_in_a_header),
    TEST(each_changed_bit_is_told),
  };

  return cmocka_run_group_tests_name("store_layout", tests, make_folder, remove_folder);
}
