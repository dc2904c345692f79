/*
 * read.c -- reading a result file back, to resume a run and in tests.
 *
 * Owns: nothing that lasts. Every call opens what it reads and closes it again; an analysis of
 * results is the business of h5py and xarray. Works on stores being written, too.
 */
#include "store/internal.h"

#include <stdlib.h>
#include <string.h>

#include <hdf5_hl.h>

/* The "group/name" of something that must exist, for HDF5: the root is "/". */
static pendres_status existing_path(pendres_store *store, const char *group, const char *name,
                                    char **out)
{
  char *path = pendres_store_path(group, name);

  *out = NULL;
  if (!path) return PENDRES_OUT_OF_MEMORY;
  if (*path && H5LTpath_valid(store->h5, path, 0) <= 0) {
    pendres_store_fail(store, PENDRES_NOT_FOUND, "'%s' holds no '%s'", store->file.path, path);
    free(path);
    return PENDRES_NOT_FOUND;
  }
  if (!*path) {
    free(path);
    path = pendres_store_copy("/");
    if (!path) return PENDRES_OUT_OF_MEMORY;
  }
  *out = path;
  return PENDRES_OK;
}

/* Open a dataset, and get its shape. On success *id must be closed. */
static pendres_status open_dataset(pendres_store *store, const char *group, const char *name,
                                   hid_t *id, int *rank, hsize_t *sizes)
{
  char *path = NULL;
  hid_t space = H5I_INVALID_HID;
  pendres_status status = name ? existing_path(store, group, name, &path)
                          : pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "no name given");

  *id = H5I_INVALID_HID;
  if (status) return status;
  for (int k = 0; k < PENDRES_STORE_RANK; k++) sizes[k] = 1;
  if ((*id = H5Dopen2(store->h5, path, H5P_DEFAULT)) < 0 || (space = H5Dget_space(*id)) < 0 ||
      (*rank = H5Sget_simple_extent_ndims(space)) < 0)
    status = pendres_store_fail_hdf5(store, "cannot read '%s'", path);
  else if (*rank > PENDRES_STORE_RANK)
    status = pendres_store_fail(store, PENDRES_UNSUPPORTED, "'%s' has %d dimensions", path, *rank);
  else if (H5Sget_simple_extent_dims(space, sizes, NULL) < 0)
    status = pendres_store_fail_hdf5(store, "cannot read '%s'", path);
  if (space >= 0) H5Sclose(space);
  if (status && *id >= 0) {
    H5Dclose(*id);
    *id = H5I_INVALID_HID;
  }
  free(path);
  return status;
}

int pendres_store_has(pendres_store *store, const char *group, const char *name)
{
  char *path = NULL;
  pendres_status status = pendres_store_enter(store, 0);
  const int found = !status && !existing_path(store, group, name, &path);

  if (!status) store->message[0] = '\0'; /* absence is an answer, not a failure */
  free(path);
  pendres_store_leave(store, PENDRES_OK);
  return found;
}

pendres_status pendres_store_shape(pendres_store *store, const char *group, const char *name,
                                   int *rank, uint64_t sizes[PENDRES_STORE_RANK])
{
  hsize_t found[PENDRES_STORE_RANK];
  hid_t id = H5I_INVALID_HID;
  int n = 0;
  pendres_status status = pendres_store_enter(store, 0);

  if (!status) status = open_dataset(store, group, name, &id, &n, found);
  if (!status && rank) *rank = n;
  for (int k = 0; k < PENDRES_STORE_RANK && !status && sizes; k++) sizes[k] = found[k];
  if (id >= 0) H5Dclose(id);
  return pendres_store_leave(store, status);
}

/* ---- what there is ------------------------------------------------------------------------- */

/* The type that elements of a member are read as. */
static pendres_store_type type_of(pendres_store *store, const char *path)
{
  H5T_class_t kind = H5T_NO_CLASS;
  size_t size = 0;

  if (H5LTget_dataset_info(store->h5, path, NULL, &kind, &size) < 0)
    return PENDRES_STORE_TYPE_COUNT;
  if (kind == H5T_STRING) return PENDRES_STORE_STRING;
  if (kind == H5T_FLOAT) return PENDRES_STORE_DOUBLE;
  if (kind == H5T_INTEGER && size == 1) return PENDRES_STORE_INT8;
  if (kind == H5T_INTEGER && size <= 4) return PENDRES_STORE_INT32;
  return kind == H5T_INTEGER && size == 8 ? PENDRES_STORE_INT64 : PENDRES_STORE_TYPE_COUNT;
}

/* A group's member; *name is NULL on failure. */
static pendres_status find_member(pendres_store *store, const char *group, uint64_t index,
                                  char **name)
{
  H5G_info_t info;
  char *path = NULL;
  ssize_t length = -1;
  pendres_status status = existing_path(store, group, NULL, &path);

  if (status) return status;
  if (H5Gget_info_by_name(store->h5, path, &info, H5P_DEFAULT) < 0)
    status = pendres_store_fail_hdf5(store, "cannot read '%s'", path);
  else if (index >= info.nlinks)
    status = pendres_store_fail(store, PENDRES_NOT_FOUND, "'%s' has no member number %llu", path,
                                (unsigned long long)index);
  else if ((length = H5Lget_name_by_idx(store->h5, path, H5_INDEX_CRT_ORDER, H5_ITER_INC, index,
                                        NULL, 0, H5P_DEFAULT)) < 0)
    status = pendres_store_fail_hdf5(store, "cannot read '%s'", path);
  else if ((*name = malloc((size_t)length + 1)) == NULL)
    status = PENDRES_OUT_OF_MEMORY;
  else if (H5Lget_name_by_idx(store->h5, path, H5_INDEX_CRT_ORDER, H5_ITER_INC, index, *name,
                              (size_t)length + 1, H5P_DEFAULT) < 0)
    status = pendres_store_fail_hdf5(store, "cannot read '%s'", path);
  if (status) {
    free(*name);
    *name = NULL;
  }
  free(path);
  return status;
}

pendres_status pendres_store_member(pendres_store *store, const char *group, uint64_t index,
                                    pendres_store_type *type, char **name)
{
  char *path = NULL;
  pendres_status status = pendres_store_enter(store, 0);

  if (name) *name = NULL;
  if (!status && !name)
    status = pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "no room for a name");
  if (!status) status = find_member(store, group, index, name);
  if (!status && type) {
    path = pendres_store_path(group, *name);
    if (path) *type = type_of(store, path);
    else status = PENDRES_OUT_OF_MEMORY;
    free(path);
  }
  if (status && name) {
    free(*name);
    *name = NULL;
  }
  return pendres_store_leave(store, status);
}

/* The last part of a dataset's path, into *name, NULL without memory. Negative: it has none. */
static int take_name(hid_t dataset, char **name)
{
  char path[1024];
  const ssize_t length = H5Iget_name(dataset, path, sizeof path);
  const char *slash = strrchr(path, '/');

  if (length <= 0 || (size_t)length >= sizeof path) return -1;
  *name = pendres_store_copy(slash ? slash + 1 : path);
  return 1;
}

/* The name of a dimension's first scale, read as HDF5's specification of scales has it: lists of
   references, one a dimension. HDF5's own function for it, H5DSiterate_scales(), has hung
   (1.14.5). 0: no scale, negative: failed. */
static int take_scale(hid_t dataset, int rank, int axis, char **name)
{
  hvl_t list[PENDRES_STORE_RANK] = {{0, NULL}};
  const htri_t listed = H5Aexists(dataset, "DIMENSION_LIST");
  const hid_t attribute = listed > 0 ? H5Aopen(dataset, "DIMENSION_LIST", H5P_DEFAULT) : -1;
  const hid_t space = attribute >= 0 ? H5Aget_space(attribute) : -1;
  const hid_t type = H5Tvlen_create(H5T_STD_REF_OBJ);
  hid_t scale = H5I_INVALID_HID;
  int taken = listed == 0 ? 0 : -1;

  if (space >= 0 && type >= 0 && H5Sget_simple_extent_npoints(space) == rank &&
      H5Aread(attribute, type, list) >= 0) {
    taken = 0;
    if (list[axis].len > 0) {
      scale = H5Rdereference2(dataset, H5P_DEFAULT, H5R_OBJECT, list[axis].p);
      taken = scale >= 0 ? take_name(scale, name) : -1;
    }
    (void)H5Dvlen_reclaim(type, space, H5P_DEFAULT, list);
  }
  if (scale >= 0) H5Oclose(scale);
  if (type >= 0) H5Tclose(type);
  if (space >= 0) H5Sclose(space);
  if (attribute >= 0) H5Aclose(attribute);
  return taken;
}

pendres_status pendres_store_dimension_of(pendres_store *store, const char *group,
                                          const char *name, int axis, char **dimension)
{
  hsize_t sizes[PENDRES_STORE_RANK];
  hid_t id = H5I_INVALID_HID;
  int rank = 0;
  pendres_status status = pendres_store_enter(store, 0);

  if (dimension) *dimension = NULL;
  if (!status && !dimension)
    status = pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "no room for a name");
  if (!status) status = open_dataset(store, group, name, &id, &rank, sizes);
  if (!status && (axis < 0 || axis >= rank))
    status = pendres_store_fail(store, PENDRES_NOT_FOUND, "'%s' has no dimension number %d", name,
                                axis);
  if (!status) {
    const int one = H5DSis_scale(id) > 0 ? take_name(id, dimension)
                                         : take_scale(id, rank, axis, dimension);
    if (one == 0)
      status = pendres_store_fail(store, PENDRES_NOT_FOUND, "dimension %d of '%s' has no name",
                                  axis, name);
    else if (one < 0) status = pendres_store_fail_hdf5(store, "cannot read '%s'", name);
    else if (!*dimension) status = PENDRES_OUT_OF_MEMORY;
  }
  if (id >= 0) H5Dclose(id);
  return pendres_store_leave(store, status);
}

/* ---- values -------------------------------------------------------------------------------- */

/* Check that there is room at data for as many elements as a piece of that shape holds. */
static pendres_status check_read(pendres_store *store, const char *name, const hsize_t *sizes,
                                 const pendres_store_piece *piece, const void *data)
{
  const pendres_status status = pendres_store_check_rows(store, name, sizes[0], piece);
  const size_t n = piece->n;
  size_t wanted = piece->rows;

  if (status) return status;
  for (int k = 1; k < PENDRES_STORE_RANK; k++) wanted *= (size_t)sizes[k];
  if (n != wanted || (n && !data))
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT,
                              "'%s': room for %llu elements is wanted, not for %llu", name,
                              (unsigned long long)wanted, (unsigned long long)(data ? n : 0));
  return PENDRES_OK;
}

/* Read rows; for a scalar the only one. */
static herr_t read_rows(hid_t id, hid_t type, int rank, const hsize_t *sizes,
                        const pendres_store_piece *piece, void *data)
{
  hsize_t start[PENDRES_STORE_RANK] = { 0 }, count[PENDRES_STORE_RANK];
  hid_t space = H5I_INVALID_HID, memory = H5I_INVALID_HID;
  herr_t result = -1;

  if (!rank) return H5Dread(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
  memcpy(count, sizes, sizeof count);
  start[0] = piece->first;
  count[0] = piece->rows;
  space = H5Dget_space(id);
  memory = H5Screate_simple(rank, count, NULL);
  if (space >= 0 && memory >= 0 &&
      H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) >= 0)
    result = H5Dread(id, type, memory, space, H5P_DEFAULT, data);
  if (memory >= 0) H5Sclose(memory);
  if (space >= 0) H5Sclose(space);
  return result;
}

/* Read numbers; rows UINT64_MAX: all rows that there are. */
static pendres_status read_numbers(pendres_store *store, const char *group, const char *name,
                                   pendres_store_type type, pendres_store_piece piece,
                                   void *data)
{
  hsize_t sizes[PENDRES_STORE_RANK];
  hid_t id = H5I_INVALID_HID;
  int rank = 0;
  pendres_status status;

  if ((int)type < 0 || type >= PENDRES_STORE_STRING)
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "only numbers can be read so");
  status = open_dataset(store, group, name, &id, &rank, sizes);
  if (!status && piece.rows == UINT64_MAX) piece.rows = sizes[0];
  if (!status) status = check_read(store, name, sizes, &piece, data);
  if (!status && piece.n &&
      read_rows(id, pendres_store_memory_type(type), rank, sizes, &piece, data) < 0)
    status = pendres_store_fail_hdf5(store, "cannot read '%s'", name);
  if (id >= 0) H5Dclose(id);
  return status;
}

pendres_status pendres_store_read(pendres_store *store, const char *group, const char *name,
                                  pendres_store_type type, void *data, size_t n)
{
  const pendres_store_piece all = { 0, UINT64_MAX, n };
  pendres_status status = pendres_store_enter(store, 0);

  if (!status) status = read_numbers(store, group, name, type, all, data);
  return pendres_store_leave(store, status);
}

pendres_status pendres_store_read_rows(pendres_store *store, const pendres_store_spec *spec,
                                       uint64_t first, uint64_t rows, void *data, size_t n)
{
  const pendres_store_piece piece = { first, rows, n };
  pendres_status status = pendres_store_enter(store, 0);

  if (!status && !spec)
    status = pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "no specification");
  if (!status && rows == UINT64_MAX)
    status = pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "too many rows");
  if (!status) status = read_numbers(store, spec->group, spec->name, spec->type, piece, data);
  return pendres_store_leave(store, status);
}

/* HDF5's copy of a text becomes ours, which free() can free whatever allocator HDF5 uses. */
static pendres_status take_text(char *words, char **text)
{
  *text = pendres_store_copy(words ? words : "");
  if (words) H5free_memory(words);
  return *text ? PENDRES_OK : PENDRES_OUT_OF_MEMORY;
}

pendres_status pendres_store_read_text(pendres_store *store, const char *group, const char *name,
                                       uint64_t index, char **text)
{
  hsize_t sizes[PENDRES_STORE_RANK];
  char *words = NULL;
  const char *label = name ? name : "(null)";
  hid_t id = H5I_INVALID_HID, type = H5I_INVALID_HID;
  const pendres_store_piece piece = { index, 1, 1 };
  int rank = 0;
  pendres_status status = pendres_store_enter(store, 0);

  if (!status && !text)
    status = pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "no room for a text");
  if (text) *text = NULL;
  if (!status) status = open_dataset(store, group, name, &id, &rank, sizes);
  if (!status && (rank > 1 || index >= sizes[0]))
    status = pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "'%s' has no text number %llu",
                                label, (unsigned long long)index);
  if (!status) {
    type = pendres_store_memory_type(PENDRES_STORE_STRING);
    if (type < 0 || read_rows(id, type, rank, sizes, &piece, &words) < 0)
      status = pendres_store_fail_hdf5(store, "cannot read '%s' as text", label);
    else
      status = take_text(words, text);
  }
  pendres_store_type_close(PENDRES_STORE_STRING, type);
  if (id >= 0) H5Dclose(id);
  return pendres_store_leave(store, status);
}

/* Read a scalar attribute of a group's object, or of the group. */
static pendres_status read_attribute(pendres_store *store, const char *group, const char *object,
                                     const char *name, hid_t type, void *value)
{
  hid_t id = H5I_INVALID_HID, space = H5I_INVALID_HID;
  htri_t found = 0;
  char *path = NULL;
  pendres_status status = existing_path(store, group, object, &path);

  if (status) return status;
  if (!name || (found = H5Aexists_by_name(store->h5, path, name, H5P_DEFAULT)) <= 0)
    status = pendres_store_fail(store, PENDRES_NOT_FOUND, "'%s' has no attribute '%s'", path,
                                name ? name : "(null)");
  else if ((id = H5Aopen_by_name(store->h5, path, name, H5P_DEFAULT, H5P_DEFAULT)) < 0 ||
           (space = H5Aget_space(id)) < 0)
    status = pendres_store_fail_hdf5(store, "cannot read attribute '%s' of '%s'", name, path);
  else if (H5Sget_simple_extent_npoints(space) != 1)
    status = pendres_store_fail(store, PENDRES_UNSUPPORTED, "attribute '%s' of '%s' is an array",
                                name, path);
  else if (H5Aread(id, type, value) < 0)
    status = pendres_store_fail_hdf5(store, "cannot read attribute '%s' of '%s'", name, path);
  if (space >= 0) H5Sclose(space);
  if (id >= 0) H5Aclose(id);
  free(path);
  return status;
}

pendres_status pendres_store_read_attribute_text(pendres_store *store, const char *group,
                                                 const char *object, const char *name,
                                                 char **text)
{
  char *words = NULL;
  hid_t type = H5I_INVALID_HID;
  pendres_status status = pendres_store_enter(store, 0);

  if (!status && !text)
    status = pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "no room for a text");
  if (text) *text = NULL;
  if (!status && (type = pendres_store_memory_type(PENDRES_STORE_STRING)) < 0)
    status = pendres_store_fail_hdf5(store, "cannot read attributes");
  if (!status) status = read_attribute(store, group, object, name, type, &words);
  if (!status) status = take_text(words, text);
  pendres_store_type_close(PENDRES_STORE_STRING, type);
  return pendres_store_leave(store, status);
}

pendres_status pendres_store_read_attribute_double(pendres_store *store, const char *group,
                                                   const char *object, const char *name,
                                                   double *value)
{
  pendres_status status = pendres_store_enter(store, 0);

  if (!status && !value)
    status = pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "no room for a number");
  if (!status) status = read_attribute(store, group, object, name, H5T_NATIVE_DOUBLE, value);
  return pendres_store_leave(store, status);
}
