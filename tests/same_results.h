/*
 * same_results.h -- do two files hold the same results, byte by byte? What must differ from run to
 * run, the group `provenance`, is left out.
 */
#ifndef SAME_RESULTS_H
#define SAME_RESULTS_H

#include "check.h"

#include <stdlib.h>
#include <string.h>

#include <hdf5.h>

typedef struct comparison {
  hid_t other;
  int datasets;
} comparison;

/* The bytes of a dataset of numbers; to be freed. */
static inline void *bytes_of(hid_t file, const char *name, size_t *size)
{
  const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  assert_true(set >= 0);
  const hid_t type = H5Dget_type(set), space = H5Dget_space(set);
  *size = H5Tget_size(type) * (size_t)H5Sget_simple_extent_npoints(space);
  void *bytes = H5Tis_variable_str(type) > 0 || *size == 0 ? NULL : malloc(*size);
  if (bytes != NULL) assert_true(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes) >= 0);
  H5Tclose(type);
  H5Sclose(space);
  H5Dclose(set);
  return bytes;
}

static inline herr_t compare(hid_t file, const char *name, const H5O_info_t *info, void *arg)
{
  comparison *c = arg;
  size_t size = 0, other_size = 0;
  if (info->type != H5O_TYPE_DATASET || strncmp(name, "provenance", 10) == 0) return 0;
  void *bytes = bytes_of(file, name, &size), *other = bytes_of(c->other, name, &other_size);
  assert_int_equal(size, other_size);
  if (bytes != NULL) assert_memory_equal(bytes, other, size);
  free(bytes);
  free(other);
  c->datasets++;
  return 0;
}

/* All datasets outside of the provenance hold the same bytes. */
static inline void check_same_results(const char *a, const char *b)
{
  const hid_t file = H5Fopen(a, H5F_ACC_RDONLY, H5P_DEFAULT);
  comparison c = { .other = H5Fopen(b, H5F_ACC_RDONLY, H5P_DEFAULT) };
  assert_true(file >= 0 && c.other >= 0);
#if H5_VERSION_GE(1, 12, 0)
  assert_true(H5Ovisit3(file, H5_INDEX_NAME, H5_ITER_INC, compare, &c, H5O_INFO_BASIC) >= 0);
#else
  assert_true(H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, compare, &c) >= 0);
#endif
  assert_true(c.datasets > 3);
  H5Fclose(file);
  H5Fclose(c.other);
}

#endif
