/*
 * verify.c -- reading all of a file, to know whether it can be read.
 *
 * Owns: the way through groups, datasets and attributes. HDF5 itself looks at its checksums when
 * it reads: those of chunks (zlib's, or Fletcher32) and of headers. That of the rest is in sums.c.
 */
#include "store/internal.h"

#include <stdlib.h>
#include <string.h>

/* Bytes that are read at once, unless a single row or chunk is larger. */
#define PIECE ((hsize_t)16 * 1024 * 1024)
/* The depth of groups within groups: what is deeper is a circle in a damaged file. */
enum { DEEPEST = 32, MOST_RANK = 32 };

/* What HDF5 has allocated for n elements: texts and lists of variable length. */
static void free_elements(hid_t type, size_t n, void *data)
{
  if (H5Tis_variable_str(type) > 0) {
    for (size_t i = 0; i < n; i++) H5free_memory(((char **)data)[i]);
  } else if (H5Tget_class(type) == H5T_VLEN) {
    for (size_t i = 0; i < n; i++) H5free_memory(((hvl_t *)data)[i].p);
  }
}

static herr_t read_attribute(hid_t object, const char *name, const H5A_info_t *info, void *unused)
{
  const hid_t id = H5Aopen(object, name, H5P_DEFAULT);
  const hid_t stored = id >= 0 ? H5Aget_type(id) : H5I_INVALID_HID;
  const hid_t type = stored >= 0 ? H5Tget_native_type(stored, H5T_DIR_ASCEND) : H5I_INVALID_HID;
  const hid_t space = id >= 0 ? H5Aget_space(id) : H5I_INVALID_HID;
  const hssize_t n = space >= 0 ? H5Sget_simple_extent_npoints(space) : -1;
  herr_t result = -1;
  void *data = NULL;

  (void)info;
  (void)unused;
  if (type >= 0 && n >= 0 && (data = calloc((size_t)n + 1, H5Tget_size(type))) != NULL) {
    result = H5Aread(id, type, data);
    if (result >= 0) free_elements(type, (size_t)n, data);
  }
  free(data);
  if (space >= 0) H5Sclose(space);
  if (type >= 0) H5Tclose(type);
  if (stored >= 0) H5Tclose(stored);
  if (id >= 0) H5Aclose(id);
  return result;
}

/* Some rows of a dataset, or all of a scalar, which has rank 0. */
typedef struct piece {
  int rank;
  hsize_t start[MOST_RANK], count[MOST_RANK];
  size_t n; /* elements */
} piece;

static herr_t read_some(hid_t id, hid_t type, hid_t space, const piece *p)
{
  const hid_t memory = p->rank ? H5Screate_simple(p->rank, p->count, NULL) : H5Screate(H5S_SCALAR);
  void *data = calloc(p->n + 1, H5Tget_size(type));
  herr_t result = -1;

  if (memory >= 0 && data &&
      (!p->rank ||
       H5Sselect_hyperslab(space, H5S_SELECT_SET, p->start, NULL, p->count, NULL) >= 0) &&
      (result = H5Dread(id, type, memory, space, H5P_DEFAULT, data)) >= 0)
    free_elements(type, p->n, data);
  if (memory >= 0) H5Sclose(memory);
  free(data);
  return result;
}

/* How many rows are read at a time: whole chunks, so that none is read twice. */
static hsize_t rows_at_once(hid_t id, int rank, hsize_t row_bytes)
{
  const hid_t creation = H5Dget_create_plist(id);
  hsize_t chunk[MOST_RANK] = { 1 }, rows = row_bytes && row_bytes < PIECE ? PIECE / row_bytes : 1;

  if (creation >= 0 && H5Pget_layout(creation) == H5D_CHUNKED &&
      H5Pget_chunk(creation, rank, chunk) > 0 && chunk[0] > 0)
    rows = rows > chunk[0] ? rows - rows % chunk[0] : chunk[0];
  if (creation >= 0) H5Pclose(creation);
  return rows;
}

static herr_t read_rows(hid_t id, hid_t type, hid_t space)
{
  const int rank = H5Sget_simple_extent_ndims(space);
  piece p = { .rank = rank, .count = { 1 } };
  hsize_t row = 1, step;
  herr_t result = 0;

  if (rank < 0 || rank > MOST_RANK || H5Sget_simple_extent_dims(space, p.count, NULL) < 0)
    return -1;
  for (int k = 1; k < rank; k++) row *= p.count[k];
  if (!row) return 0;
  const hsize_t rows = rank ? p.count[0] : 1;
  step = rank ? rows_at_once(id, rank, row * H5Tget_size(type)) : 1;
  for (hsize_t done = 0; done < rows && result >= 0; done += step) {
    p.start[0] = done;
    p.count[0] = rows - done < step ? rows - done : step;
    p.n = (size_t)(p.count[0] * row);
    result = read_some(id, type, space, &p);
  }
  return result;
}

static herr_t read_dataset(hid_t id, uint64_t *sum)
{
  const hid_t stored = H5Dget_type(id), space = H5Dget_space(id);
  const hid_t type = stored >= 0 ? H5Tget_native_type(stored, H5T_DIR_ASCEND) : H5I_INVALID_HID;
  herr_t result = type >= 0 && space >= 0 ? read_rows(id, type, space) : -1;

  if (result >= 0) result = pendres_store_sums_add(id, sum);
  if (type >= 0) H5Tclose(type);
  if (stored >= 0) H5Tclose(stored);
  if (space >= 0) H5Sclose(space);
  return result;
}

static pendres_status unreadable(pendres_store *store, hid_t object)
{
  char path[256] = "";

  if (H5Iget_name(object, path, sizeof path) <= 0) strcpy(path, "?");
  return pendres_store_fail_hdf5(store, "'%s' cannot be read", path);
}

/* What is read on the way. */
typedef struct reading {
  pendres_store *store;
  int depth;
  uint64_t count; /* of datasets */
  uint64_t sum;   /* of scalars and short arrays */
  pendres_status status;
} reading;

static pendres_status read_object(reading *w, hid_t object);

static herr_t read_member(hid_t group, const char *name, const H5L_info_t *info, void *arg)
{
  reading *w = arg;
  const hid_t member = H5Oopen(group, name, H5P_DEFAULT);

  (void)info;
  w->status = member < 0 ? unreadable(w->store, group) : read_object(w, member);
  if (member >= 0) H5Oclose(member);
  return w->status ? -1 : 0;
}

/* A group lists its members twice: in the order in which they were made, where that is kept, and by
 * name, as each of them is opened. */
static pendres_status read_group(reading *w, hid_t group)
{
  const hid_t creation = H5Gget_create_plist(group);
  unsigned order = 0;
  H5_index_t list = H5_INDEX_NAME;
  herr_t result = creation < 0 ? -1 : H5Pget_link_creation_order(creation, &order);

  if (creation >= 0) H5Pclose(creation);
  if (order & H5P_CRT_ORDER_TRACKED) list = H5_INDEX_CRT_ORDER;
  w->depth++;
  if (result >= 0 && w->depth <= DEEPEST)
    result = H5Literate(group, list, H5_ITER_INC, NULL, read_member, w);
  else
    result = -1;
  w->depth--;
  if (w->status) return w->status;
  return result < 0 ? unreadable(w->store, group) : PENDRES_OK;
}

/* HDF5's own indices and lists of free space of an object: asking for their size reads them. */
static herr_t read_indices(hid_t object)
{
#if H5_VERSION_GE(1, 12, 0)
  H5O_native_info_t info;

  return H5Oget_native_info(object, &info, H5O_NATIVE_INFO_META_SIZE);
#else
  H5O_info_t info;

  return H5Oget_info(object, &info);
#endif
}

/* An object with all that is in it. */
static pendres_status read_object(reading *w, hid_t object)
{
  const H5I_type_t kind = H5Iget_type(object);

  if (read_indices(object) < 0 ||
      H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_NATIVE, NULL, read_attribute, NULL) < 0)
    return unreadable(w->store, object);
  if (kind == H5I_GROUP) return read_group(w, object);
  if (kind != H5I_DATASET) return PENDRES_OK;
  w->count++;
  return read_dataset(object, &w->sum) < 0 ? unreadable(w->store, object) : PENDRES_OK;
}

pendres_status pendres_store_verify(pendres_store *store, uint64_t *datasets)
{
  hid_t root = H5I_INVALID_HID;
  reading w = { .store = store };
  pendres_status status = pendres_store_enter(store, 0);

  if (!status && (root = H5Gopen2(store->h5, "/", H5P_DEFAULT)) < 0)
    status = pendres_store_fail_hdf5(store, "'%s' cannot be read", store->file.path);
  if (!status) status = read_object(&w, root);
  if (!status) status = pendres_store_sums_check(store, w.sum);
  if (root >= 0) H5Gclose(root);
  if (datasets) *datasets = w.count;
  return pendres_store_leave(store, status);
}
