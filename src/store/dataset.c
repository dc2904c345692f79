/*
 * dataset.c -- the arrays of a store on disk: their types, chunks, filters, and writing.
 *
 * Owns: how an array is divided into chunks, compressed and protected. A chunk is a row (one index
 * of the first dimension), or as many short rows as make 64 KiB, or a piece of a row longer than 1
 * MiB: a run that writes row by row then compresses each chunk once. Scalars and short arrays lie
 * in the file as they are (contiguous), not in the header of their dataset (compact): readers that
 * look up places of data in a file find none there, and some give NaN without a word. All numbers
 * have checksums: compressed chunks zlib's (Adler-32), which whoever expands them checks; others
 * Fletcher32, which not every reader knows; the rest one in sums.c. Texts have none: HDF5 keeps
 * those of variable length in a heap without one. Sizes are in elements unless a comment says
 * otherwise.
 */
#include "store/internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Bytes. Rows are gathered up to the first, and divided above the second. */
#define CHUNK_GOAL ((hsize_t)64 * 1024)
#define CHUNK_LIMIT ((hsize_t)1024 * 1024)
/* Bytes of chunks not yet full that an open variable may keep. */
#define CHUNK_CACHE ((size_t)4 * 1024 * 1024)
#define DEFLATE_DEFAULT 4
/* Bytes passed to HDF5 at a time. After a refused write not much more than this is kept in
 * memory (file.h). */
#define PIECE ((size_t)4 * 1024 * 1024)

/* ---- Types ----------------------------------------------------------------------------------- */

static hid_t string_type(void)
{
  const hid_t type = H5Tcopy(H5T_C_S1);

  if (type >= 0 && (H5Tset_size(type, H5T_VARIABLE) < 0 || H5Tset_cset(type, H5T_CSET_UTF8) < 0)) {
    H5Tclose(type);
    return H5I_INVALID_HID;
  }
  return type;
}

/* A type on disk, to be closed like one in memory. */
static hid_t file_type(pendres_store_type type)
{
  switch (type) {
  case PENDRES_STORE_DOUBLE: return H5T_IEEE_F64LE;
  case PENDRES_STORE_INT8: return H5T_STD_I8LE;
  case PENDRES_STORE_INT32: return H5T_STD_I32LE;
  case PENDRES_STORE_INT64: return H5T_STD_I64LE;
  case PENDRES_STORE_STRING: return string_type();
  case PENDRES_STORE_TYPE_COUNT: break;
  }
  return H5I_INVALID_HID;
}

hid_t pendres_store_memory_type(pendres_store_type type)
{
  switch (type) {
  case PENDRES_STORE_DOUBLE: return H5T_NATIVE_DOUBLE;
  case PENDRES_STORE_INT8: return H5T_NATIVE_INT8;
  case PENDRES_STORE_INT32: return H5T_NATIVE_INT32;
  case PENDRES_STORE_INT64: return H5T_NATIVE_INT64;
  case PENDRES_STORE_STRING: return string_type();
  case PENDRES_STORE_TYPE_COUNT: break;
  }
  return H5I_INVALID_HID;
}

void pendres_store_type_close(pendres_store_type type, hid_t id)
{
  if (type == PENDRES_STORE_STRING && id >= 0) H5Tclose(id);
}

/* ---- Size and storage ------------------------------------------------------------------------ */

static size_t element_bytes(pendres_store_type type)
{
  switch (type) {
  case PENDRES_STORE_INT8: return 1;
  case PENDRES_STORE_INT32: return 4;
  default: return 8;
  }
}

pendres_status pendres_store_measure(pendres_store *store, pendres_store_node *node,
                                     const char *path)
{
  const uint64_t most = (uint64_t)PTRDIFF_MAX / 16; /* strings have 16 bytes an element on disk */
  uint64_t total = 1;

  node->row = 1;
  for (int k = node->rank - 1; k >= 0; k--) {
    if (node->sizes[k] && total > most / node->sizes[k])
      return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "'%s' is too large", path);
    node->row = (size_t)total;
    total *= node->sizes[k];
  }
  return PENDRES_OK;
}

/* A chunk is as many whole rows as make CHUNK_GOAL bytes, unless one row exceeds CHUNK_LIMIT. */
static void chunk_sizes(const pendres_store_node *node, size_t rows_wanted, hsize_t *chunk)
{
  hsize_t bytes = element_bytes(node->type), rows;

  for (int k = node->rank - 1; k > 0; k--) {
    const hsize_t fit = CHUNK_LIMIT / bytes;

    chunk[k] = node->sizes[k] < fit ? node->sizes[k] : fit;
    if (chunk[k] < 1) chunk[k] = 1;
    bytes *= chunk[k];
  }
  rows = rows_wanted ? rows_wanted : CHUNK_GOAL / bytes;
  if (rows > CHUNK_LIMIT / bytes) rows = CHUNK_LIMIT / bytes;
  if (rows > node->sizes[0]) rows = node->sizes[0];
  chunk[0] = rows ? rows : 1;
}

/* Fletcher32 only where nothing else is a checksum: kerchunk passes over variables that have it,
   and hidefix refuses their file. */
static herr_t set_filters(hid_t creation, size_t element, int deflate)
{
  if (deflate < 0 || H5Zfilter_avail(H5Z_FILTER_DEFLATE) <= 0)
    return H5Zfilter_avail(H5Z_FILTER_FLETCHER32) > 0 ? H5Pset_fletcher32(creation) : 0;
  if (element > 1 && H5Pset_shuffle(creation) < 0) return -1;
  return H5Pset_deflate(creation, deflate ? (unsigned)deflate : DEFLATE_DEFAULT);
}

/* Fill value, chunks and filters. */
static herr_t set_storage(hid_t creation, const pendres_store_node *node, int deflate,
                          size_t chunk_rows)
{
  const double nan_value = NAN;
  hsize_t chunk[PENDRES_STORE_RANK], total = element_bytes(node->type);

  for (int k = 0; k < node->rank; k++) total *= node->sizes[k];
  if (H5Pset_obj_track_times(creation, 0) < 0) return -1;
  /* For doubles alone: a fill value on an integer makes xarray read it as floating point, and a
   * coordinate must have none. */
  if (node->kind == PENDRES_STORE_VARIABLE && node->type == PENDRES_STORE_DOUBLE &&
      H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, &nan_value) < 0)
    return -1;
  /* Strings are pointers into the heap. */
  if (total < PENDRES_STORE_SHORT || node->type == PENDRES_STORE_STRING)
    return H5Pset_layout(creation, H5D_CONTIGUOUS);
  chunk_sizes(node, chunk_rows, chunk);
  if (H5Pset_chunk(creation, node->rank, chunk) < 0) return -1;
  return set_filters(creation, element_bytes(node->type), deflate);
}

pendres_status pendres_store_make(pendres_store *store, const char *path,
                                  const pendres_store_node *node, int deflate, size_t chunk_rows)
{
  pendres_store_node made = *node;
  const hid_t type = file_type(node->type);
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  const hid_t access = H5Pcreate(H5P_DATASET_ACCESS);
  const hid_t space = node->rank ? H5Screate_simple(node->rank, node->sizes, NULL)
                      : H5Screate(H5S_SCALAR);
  pendres_status status = pendres_store_reserve(store, path, &made.path);

  if (!status &&
      (type < 0 || creation < 0 || access < 0 || space < 0 ||
       set_storage(creation, node, deflate, chunk_rows) < 0 ||
       H5Pset_chunk_cache(access, H5D_CHUNK_CACHE_NSLOTS_DEFAULT, CHUNK_CACHE, 1.0) < 0 ||
       (made.id = H5Dcreate2(store->h5, path, type, space, H5P_DEFAULT, creation, access)) < 0))
    status = pendres_store_fail_hdf5(store, "cannot make variable '%s'", path);
  if (!status)
    store->nodes[store->count++] = made;
  else
    free(made.path);
  if (space >= 0) H5Sclose(space);
  if (access >= 0) H5Pclose(access);
  if (creation >= 0) H5Pclose(creation);
  pendres_store_type_close(node->type, type);
  return status;
}

/* ---- Writing --------------------------------------------------------------------------------- */

/* Write a number of rows that HDF5 takes in one call. */
static herr_t write_piece(const pendres_store_node *node, hid_t type, hid_t space,
                          const pendres_store_piece *piece, const void *data)
{
  hsize_t start[PENDRES_STORE_RANK] = { 0 }, count[PENDRES_STORE_RANK];
  hid_t memory = H5I_INVALID_HID;
  herr_t result = -1;

  if (!node->rank) return H5Dwrite(node->id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
  memcpy(count, node->sizes, sizeof count);
  start[0] = piece->first;
  count[0] = piece->rows;
  memory = H5Screate_simple(node->rank, count, NULL);
  if (memory >= 0 && H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) >= 0)
    result = H5Dwrite(node->id, type, memory, space, H5P_DEFAULT, data);
  if (memory >= 0) H5Sclose(memory);
  return result;
}

/* The same for strings: all become UTF-8 on the way. */
static pendres_status write_text_piece(pendres_store *store, const pendres_store_node *node,
                                       hid_t type, hid_t space,
                                       const pendres_store_piece *piece, const char *const *data)
{
  char **list = pendres_store_utf8_list(data, piece->n);
  pendres_status status = PENDRES_OK;

  if (!list) return PENDRES_OUT_OF_MEMORY;
  if (write_piece(node, type, space, piece, list) < 0)
    status = pendres_store_fail_hdf5(store, "cannot write '%s'", node->path);
  pendres_store_utf8_free(list, piece->n);
  return status;
}

pendres_status pendres_store_node_write(pendres_store *store, const pendres_store_node *node,
                                        uint64_t first, uint64_t rows, const void *data)
{
  const size_t memory_element =
    node->type == PENDRES_STORE_STRING ? sizeof(char *) : element_bytes(node->type);
  const size_t row_bytes = node->row * memory_element;
  const uint64_t most = row_bytes && row_bytes < PIECE ? PIECE / row_bytes : 1;
  const hid_t type = pendres_store_memory_type(node->type);
  const hid_t space = H5Dget_space(node->id);
  const char *from = data;
  pendres_status status = PENDRES_OK;

  if (type < 0 || space < 0)
    status = pendres_store_fail_hdf5(store, "cannot write '%s'", node->path);
  for (uint64_t done = 0; done < rows && row_bytes && !status; done += most) {
    const uint64_t now = rows - done < most ? rows - done : most;
    const pendres_store_piece piece = { first + done, now, (size_t)now * node->row };

    if (node->type == PENDRES_STORE_STRING)
      status = write_text_piece(store, node, type, space, &piece,
                                (const char *const *)(const void *)from);
    else if (write_piece(node, type, space, &piece, from) < 0)
      status = pendres_store_fail_hdf5(store, "cannot write '%s'", node->path);
    if (store->file.error) status = PENDRES_IO; /* pendres_store_leave() says why */
    from += (size_t)now * row_bytes;
  }
  if (space >= 0) H5Sclose(space);
  pendres_store_type_close(node->type, type);
  return status;
}

pendres_status pendres_store_check_rows(pendres_store *store, const char *name, uint64_t all,
                                        const pendres_store_piece *piece)
{
  if (piece->first <= all && piece->rows <= all - piece->first) return PENDRES_OK;
  return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT,
                            "'%s' has %llu rows: %llu from row %llu on are too many", name,
                            (unsigned long long)all, (unsigned long long)piece->rows,
                            (unsigned long long)piece->first);
}

/* Find the variable with this number, and check that there are data for a piece of it. */
static pendres_status check_write(pendres_store *store, int id, const pendres_store_piece *piece,
                                  const void *data, const pendres_store_node **out)
{
  const pendres_store_node *node;
  pendres_status status;

  if (id < 0 || (size_t)id >= store->count ||
      store->nodes[id].kind != PENDRES_STORE_VARIABLE)
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "there is no variable number %d",
                              id);
  node = *out = &store->nodes[id];
  status = pendres_store_check_rows(store, node->path, node->sizes[0], piece);
  if (status) return status;
  if (piece->n != piece->rows * node->row)
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT,
                              "'%s': %llu elements are wanted, %llu were given", node->path,
                              (unsigned long long)(piece->rows * node->row),
                              (unsigned long long)piece->n);
  if (piece->n && !data)
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "'%s': no data", node->path);
  return PENDRES_OK;
}

pendres_status pendres_store_write_rows(pendres_store *store, int id, uint64_t first,
                                        uint64_t rows, const void *data, size_t n)
{
  const pendres_store_piece piece = { first, rows, n };
  const pendres_store_node *node = NULL;
  pendres_status status = pendres_store_enter(store, 1);

  if (!status) status = check_write(store, id, &piece, data, &node);
  if (!status) status = pendres_store_node_write(store, node, first, rows, data);
  return pendres_store_leave(store, status);
}

pendres_status pendres_store_write(pendres_store *store, int id, const void *data, size_t n)
{
  const uint64_t rows =
    store && id >= 0 && (size_t)id < store->count ? store->nodes[id].sizes[0] : 0;

  return pendres_store_write_rows(store, id, 0, rows, data, n);
}

/* ---- Define and write in one call ------------------------------------------------------------ */

pendres_status pendres_store_put(pendres_store *store, const pendres_store_spec *spec,
                                 const void *data, const double *error, size_t n)
{
  int id = -1, error_id = -1;
  /* This is checked before a variable is made that would stay empty. */
  if (store && spec && n && !data)
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "'%s': no data",
                              spec->name ? spec->name : "");
  pendres_status status = pendres_store_variable(store, spec, &id, error ? &error_id : NULL);

  if (!status) status = pendres_store_write(store, id, data, n);
  return status || !error ? status : pendres_store_write(store, error_id, error, n);
}
