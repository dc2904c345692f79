/*
 * sums.c -- a checksum of the numbers that HDF5 itself does not protect.
 *
 * Owns: the attribute `checksum` of the group provenance, or of the root where there is none: that
 * of all scalars and short arrays, whose bytes lie in the file as they are. HDF5 has checksums for
 * headers and for what passes through a filter, which needs chunks.
 */
#include "store/internal.h"

#include "base/mix.h"

#define PLACE "provenance"
#define NAME "checksum"

static uint64_t sum_of(uint64_t sum, const void *bytes, size_t n)
{
  for (size_t i = 0; i < n; i++) sum = pendres_mix(sum ^ ((const unsigned char *)bytes)[i]);
  return sum;
}

/* Numbers that lie in the file as they are. */
static int is_plain(hid_t dataset, hid_t type)
{
  const hid_t creation = H5Dget_create_plist(dataset);
  const H5T_class_t kind = H5Tget_class(type);
  const int plain = creation >= 0 && H5Pget_layout(creation) == H5D_CONTIGUOUS &&
                    (kind == H5T_FLOAT || kind == H5T_INTEGER);

  if (creation >= 0) H5Pclose(creation);
  return plain;
}

herr_t pendres_store_sums_add(hid_t dataset, uint64_t *sum)
{
  const hid_t type = H5Dget_type(dataset);
  const hid_t space = H5Dget_space(dataset);
  const size_t size = (size_t)H5Dget_storage_size(dataset);
  unsigned char bytes[PENDRES_STORE_SHORT];
  char path[256] = "";
  herr_t result = type < 0 || space < 0 ? -1 : 0;
  /* In a damaged file the room that it says it takes may not be what HDF5 reads. */
  const int fits = !result && size && size < sizeof bytes &&
                   (hsize_t)H5Sget_simple_extent_npoints(space) == size / H5Tget_size(type);

  if (fits && is_plain(dataset, type)) {
    const ssize_t length = H5Iget_name(dataset, path, sizeof path);

    result = length < 0 ? -1 : H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes);
    /* Added up: the order in which a file is read does not matter. */
    if (result >= 0) *sum += sum_of(sum_of((uint64_t)length, path, sizeof path), bytes, size);
  }
  if (type >= 0) H5Tclose(type);
  if (space >= 0) H5Sclose(space);
  return result;
}

/* 31 bits: those of an integer that every reader has. */
static int32_t told_as(uint64_t sum)
{
  return (int32_t)(sum >> 33);
}

pendres_status pendres_store_sums_write(pendres_store *store)
{
  const pendres_store_node *place = pendres_store_find(store, PLACE);
  uint64_t sum = 0;

  if (!place) place = pendres_store_find(store, "");
  for (size_t i = 0; i < store->count; i++)
    if (store->nodes[i].kind != PENDRES_STORE_GROUP &&
        pendres_store_sums_add(store->nodes[i].id, &sum) < 0)
      return pendres_store_fail_hdf5(store, "cannot read '%s' again", store->nodes[i].path);
  const int32_t told = told_as(sum);

  return pendres_store_set(store, place->id, NAME,
                           &(pendres_store_value){ H5T_STD_I32LE, H5T_NATIVE_INT32, 0, &told });
}

pendres_status pendres_store_sums_check(pendres_store *store, uint64_t sum)
{
  const htri_t placed = H5Lexists(store->h5, PLACE, H5P_DEFAULT);
  const char *const place = placed > 0 ? "/" PLACE : "/";
  const htri_t told = placed < 0 ? -1 : H5Aexists_by_name(store->h5, place, NAME, H5P_DEFAULT);
  int32_t wanted = -1;

  if (!told) return PENDRES_OK;
  const hid_t id =
    told < 0 ? -1 : H5Aopen_by_name(store->h5, place, NAME, H5P_DEFAULT, H5P_DEFAULT);
  const herr_t result = id < 0 ? -1 : H5Aread(id, H5T_NATIVE_INT32, &wanted);

  if (id >= 0) H5Aclose(id);
  if (result < 0) return pendres_store_fail_hdf5(store, "'%s' cannot be read", NAME);
  if (wanted == told_as(sum)) return PENDRES_OK;
  return pendres_store_fail(store, PENDRES_IO,
                            "scalars or short arrays are not those that were written");
}
