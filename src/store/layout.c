/*
 * layout.c -- groups, dimensions and variables of a store.
 *
 * Owns: the list of all that a store made, and the rules that a definition must obey. All checks
 * come before anything is made, so that a refused definition leaves no trace in the file.
 * Source: HDF5 Dimension Scale specification 1.0; CF Conventions 1.8, sections 3.4, 3.5, 5.
 */
#include "store/internal.h"

#include <hdf5_hl.h>

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"

/* ---- The list of nodes ----------------------------------------------------------------------- */

pendres_store_node *pendres_store_find(const pendres_store *store, const char *path)
{
  for (size_t i = 0; i < store->count; i++)
    if (!strcmp(store->nodes[i].path, path)) return &store->nodes[i];
  return NULL;
}

pendres_status pendres_store_reserve(pendres_store *store, const char *path, char **copy)
{
  pendres_store_node *nodes =
    pendres_grow(store->nodes, store->count, &store->room, sizeof *nodes);
  if (nodes == NULL) return PENDRES_OUT_OF_MEMORY;
  store->nodes = nodes;
  *copy = pendres_store_copy(path);
  return *copy ? PENDRES_OK : PENDRES_OUT_OF_MEMORY;
}

/* ---- Groups ---------------------------------------------------------------------------------- */

static pendres_status make_group(pendres_store *store, const char *path)
{
  char *copy = NULL;
  hid_t creation = H5I_INVALID_HID, id = H5I_INVALID_HID;
  pendres_status status = pendres_store_reserve(store, path, &copy);

  if (status) return status;
  if (!*path) {
    id = H5Gopen2(store->h5, "/", H5P_DEFAULT);
  } else {
    creation = H5Pcreate(H5P_GROUP_CREATE);
    if (creation >= 0 && H5Pset_obj_track_times(creation, 0) >= 0 &&
        H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED) >= 0)
      id = H5Gcreate2(store->h5, path, H5P_DEFAULT, creation, H5P_DEFAULT);
  }
  if (id < 0) {
    status = pendres_store_fail_hdf5(store, "cannot make group '%s'", path);
    free(copy);
  } else {
    store->nodes[store->count++] =
      (pendres_store_node){ .path = copy, .kind = PENDRES_STORE_GROUP, .id = id };
  }
  if (creation >= 0) H5Pclose(creation);
  return status;
}

/* Check that every part of the path is a name, and that none is taken by a variable. */
static pendres_status check_group(pendres_store *store, char *path)
{
  char *from = path, *slash;
  const pendres_store_node *node;
  int good = 1;

  while (*from && good) {
    slash = strchr(from, '/');
    if (slash) *slash = '\0';
    good = pendres_store_is_name(from);
    node = good ? pendres_store_find(store, path) : NULL;
    if (node && node->kind != PENDRES_STORE_GROUP)
      return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT,
                                "'%s' is a variable, not a group", path);
    if (slash) *slash = '/';
    from = slash ? slash + 1 : from + strlen(from);
  }
  return good ? PENDRES_OK
         : pendres_store_fail(store, PENDRES_INVALID_ARGUMENT,
                              "'%s' is not a path of names for a group", path);
}

/* Make what is missing of a path that was checked. */
static pendres_status make_groups(pendres_store *store, char *path)
{
  pendres_status status = PENDRES_OK;
  char *slash = path;

  while (slash && !status) {
    slash = strchr(slash, '/');
    if (slash) *slash = '\0';
    if (!pendres_store_find(store, path)) status = make_group(store, path);
    if (slash) *slash++ = '/';
  }
  return status;
}

pendres_status pendres_store_need_group(pendres_store *store, const char *group,
                                        pendres_store_node **out)
{
  char *path = pendres_store_path(group, NULL);
  pendres_status status;

  if (!path) return PENDRES_OUT_OF_MEMORY;
  status = check_group(store, path);
  if (!status) status = make_groups(store, path);
  if (!status && out) *out = pendres_store_find(store, path);
  free(path);
  return status;
}

pendres_status pendres_store_group(pendres_store *store, const char *group)
{
  pendres_status status = pendres_store_enter(store, 1);

  if (!status) status = pendres_store_need_group(store, group, NULL);
  return pendres_store_leave(store, status);
}

/* ---- What dimensions and variables share ----------------------------------------------------- */

/* Check that the name is valid, that the group can be made, and that nothing is there yet. *path is
   the caller's to free. */
static pendres_status check_new(pendres_store *store, const char *group, const char *name,
                                const char *long_name, char **path)
{
  pendres_status status;

  if (!pendres_store_is_name(name))
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "'%s' is not a name for a variable",
                              name ? name : "(null)");
  if (!long_name || !*long_name)
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "'%s' has no long_name", name);
  *path = pendres_store_path(group, NULL);
  if (!*path) return PENDRES_OUT_OF_MEMORY;
  status = check_group(store, *path);
  free(*path);
  *path = NULL;
  if (status) return status;
  *path = pendres_store_path(group, name);
  if (!*path) return PENDRES_OUT_OF_MEMORY;
  if (pendres_store_find(store, *path))
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "'%s' exists already", *path);
  return PENDRES_OK;
}

pendres_status pendres_store_describe(pendres_store *store, hid_t id, const char *long_name,
                                      const char *units)
{
  pendres_status status = pendres_store_set_text(store, id, "long_name", long_name);

  return status ? status : pendres_store_set_text(store, id, "units", units ? units : "1");
}

/* ---- Dimensions ------------------------------------------------------------------------------ */

/* Write 0, 1, ... size - 1, in bounded pieces. */
static pendres_status write_index(pendres_store *store, const pendres_store_node *node)
{
  int64_t index[1024];
  const uint64_t size = node->sizes[0], piece = sizeof index / sizeof index[0];
  pendres_status status = PENDRES_OK;

  for (uint64_t first = 0; first < size && !status; first += piece) {
    const uint64_t rows = size - first < piece ? size - first : piece;

    for (uint64_t i = 0; i < rows; i++) index[i] = (int64_t)(first + i);
    status = pendres_store_node_write(store, node, first, rows, index);
  }
  return status;
}

static pendres_status define_dimension(pendres_store *store, const pendres_store_spec *spec,
                                       uint64_t size, const void *values)
{
  const int given = values || spec->type == PENDRES_STORE_STRING;
  pendres_store_node node = { .kind = PENDRES_STORE_SCALE, .rank = 1,
                              .type = given ? spec->type : PENDRES_STORE_INT64 };
  const pendres_store_node *made;
  char *path = NULL;
  pendres_status status = check_new(store, spec->group, spec->name, spec->long_name, &path);

  for (int k = 0; k < PENDRES_STORE_RANK; k++) node.sizes[k] = 1;
  node.sizes[0] = size;
  if (!status) status = pendres_store_measure(store, &node, path);
  if (!status) status = pendres_store_need_group(store, spec->group, NULL);
  if (!status) status = pendres_store_make(store, path, &node, 0, 0);
  if (!status) {
    made = &store->nodes[store->count - 1];
    if (H5DSset_scale(made->id, spec->name) < 0)
      status = pendres_store_fail_hdf5(store, "cannot make dimension '%s'", path);
    if (!status) status = pendres_store_describe(store, made->id, spec->long_name, spec->units);
    if (!status)
      status = values ? pendres_store_node_write(store, made, 0, size, values)
               : write_index(store, made);
  }
  free(path);
  return status;
}

pendres_status pendres_store_dimension(pendres_store *store, const pendres_store_spec *spec,
                                       uint64_t size, const void *values)
{
  pendres_status status = pendres_store_enter(store, 1);

  if (!status && !spec)
    status = pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "no specification");
  if (!status && ((int)spec->type < 0 || spec->type >= PENDRES_STORE_TYPE_COUNT))
    status =
      pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "dimension '%s': type %d is unknown",
                         spec->name ? spec->name : "(null)", (int)spec->type);
  if (!status && spec->type == PENDRES_STORE_STRING && size && !values)
    status = pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "dimension '%s' has no names",
                                spec->name ? spec->name : "(null)");
  if (!status) status = define_dimension(store, spec, size, values);
  return pendres_store_leave(store, status);
}

/* ---- Variables ------------------------------------------------------------------------------- */

static pendres_status check_flags(pendres_store *store, const pendres_store_spec *spec)
{
  if (!spec->flag_count) return PENDRES_OK;
  if (spec->flag_count < 0 || spec->flag_count > 128 || spec->type != PENDRES_STORE_INT8 ||
      !spec->flag_meanings)
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT,
                              "'%s': flags are 1 to 128 labels of an int8, each with a meaning",
                              spec->name);
  for (int i = 0; i < spec->flag_count; i++)
    if (!pendres_store_is_name(spec->flag_meanings[i]))
      return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT,
                                "'%s': '%s' is not a name for a flag", spec->name,
                                spec->flag_meanings[i] ? spec->flag_meanings[i] : "(null)");
  return PENDRES_OK;
}

/* Set rank and sizes from the dimensions' names, which must exist in the group and differ. */
static pendres_status check_dimensions(pendres_store *store, const pendres_store_spec *spec,
                                       pendres_store_node *node)
{
  for (int k = 0; k < PENDRES_STORE_RANK; k++) node->sizes[k] = 1;
  for (int k = 0; k < PENDRES_STORE_RANK && spec->dimensions[k]; k++) {
    char *path = pendres_store_path(spec->group, spec->dimensions[k]);
    const pendres_store_node *scale = path ? pendres_store_find(store, path) : NULL;

    free(path);
    if (!path) return PENDRES_OUT_OF_MEMORY;
    if (!scale || scale->kind != PENDRES_STORE_SCALE)
      return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT,
                                "'%s': there is no dimension '%s' in group '%s'", spec->name,
                                spec->dimensions[k], spec->group ? spec->group : "");
    for (int j = 0; j < k; j++)
      if (!strcmp(spec->dimensions[j], spec->dimensions[k]))
        return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT,
                                  "'%s': dimension '%s' appears twice", spec->name,
                                  spec->dimensions[k]);
    node->sizes[k] = scale->sizes[0];
    node->rank = k + 1;
  }
  return PENDRES_OK;
}

/* Check everything that can be wrong with a specification. *path is the caller's to free. */
static pendres_status check_spec(pendres_store *store, const pendres_store_spec *spec,
                                 pendres_store_node *node, char **path)
{
  pendres_status status;

  *node = (pendres_store_node){ .kind = PENDRES_STORE_VARIABLE, .id = H5I_INVALID_HID };
  if (!spec) return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "no specification");
  status = check_new(store, spec->group, spec->name, spec->long_name, path);
  if (status) return status;
  if ((int)spec->type < 0 || spec->type >= PENDRES_STORE_TYPE_COUNT)
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "'%s': type %d is unknown", *path,
                              (int)spec->type);
  if (spec->deflate < -1 || spec->deflate > 9)
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT,
                              "'%s': deflate is %d, not -1 to 9", *path, spec->deflate);
  node->type = spec->type;
  status = check_flags(store, spec);
  if (!status) status = check_dimensions(store, spec, node);
  if (!status) status = pendres_store_measure(store, node, *path);
  return status;
}

static pendres_status attach_scales(pendres_store *store, const pendres_store_spec *spec, hid_t id)
{
  for (int k = 0; k < PENDRES_STORE_RANK && spec->dimensions[k]; k++) {
    char *path = pendres_store_path(spec->group, spec->dimensions[k]);
    const pendres_store_node *scale = path ? pendres_store_find(store, path) : NULL;

    free(path);
    if (!scale) return PENDRES_OUT_OF_MEMORY;
    if (H5DSattach_scale(id, scale->id, (unsigned)k) < 0)
      return pendres_store_fail_hdf5(store, "cannot give '%s' the dimension '%s'", spec->name,
                                     spec->dimensions[k]);
  }
  return PENDRES_OK;
}

static pendres_status set_flags(pendres_store *store, const pendres_store_spec *spec, hid_t id)
{
  int8_t values[128], masks[128];
  int8_t all = 0;
  size_t length = 1;
  char *meanings = NULL;
  pendres_status status;

  for (int i = 0; i < spec->flag_count; i++) {
    values[i] = spec->flag_values ? spec->flag_values[i] : (int8_t)i;
    all = (int8_t)(all | values[i]);
    length += strlen(spec->flag_meanings[i]) + 1;
  }
  meanings = calloc(length, 1);
  if (!meanings) return PENDRES_OUT_OF_MEMORY;
  for (int i = 0; i < spec->flag_count; i++) {
    if (i) strcat(meanings, " ");
    strcat(meanings, spec->flag_meanings[i]);
  }
  pendres_store_value value = { H5T_STD_I8LE, H5T_NATIVE_INT8, (size_t)spec->flag_count, values };
  status = pendres_store_set(store, id, "flag_values", &value);
  /* The mask of each flag is its own bit; that of the value 0 has all bits. */
  for (int i = 0; i < spec->flag_count; i++) masks[i] = values[i] ? values[i] : all;
  value.at = masks;
  if (!status && spec->flag_bits) status = pendres_store_set(store, id, "flag_masks", &value);
  if (!status) status = pendres_store_set_text(store, id, "flag_meanings", meanings);
  free(meanings);
  return status;
}

/* Make a variable that check_spec() found good. */
static pendres_status make_variable(pendres_store *store, const pendres_store_spec *spec,
                                    const pendres_store_node *node, const char *path, int *number)
{
  hid_t id;
  pendres_status status = pendres_store_need_group(store, spec->group, NULL);

  if (!status) status = pendres_store_make(store, path, node, spec->deflate, spec->chunk_rows);
  if (status) return status;
  id = store->nodes[store->count - 1].id;
  *number = (int)store->count - 1;
  status = pendres_store_describe(store, id, spec->long_name, spec->units);
  if (!status && spec->comment)
    status = pendres_store_set_text(store, id, "comment", spec->comment);
  if (!status && spec->coordinates)
    status = pendres_store_set_text(store, id, "coordinates", spec->coordinates);
  if (!status && spec->flag_count) status = set_flags(store, spec, id);
  if (!status) status = attach_scales(store, spec, id);
  return status;
}

/* "NAME_error" and "error estimate of LONG NAME"; both malloc'd. */
static pendres_status error_names(const pendres_store_spec *spec, char **name, char **long_name)
{
  const char before[] = "error estimate of ", behind[] = "_error";

  *name = malloc(strlen(spec->name) + sizeof behind);
  *long_name = malloc(strlen(spec->long_name) + sizeof before);
  if (!*name || !*long_name) return PENDRES_OUT_OF_MEMORY;
  strcat(strcpy(*name, spec->name), behind);
  strcat(strcpy(*long_name, before), spec->long_name);
  return PENDRES_OK;
}

/* What the error estimate of a variable is; its names are malloc'd. */
static pendres_status error_of(pendres_store *store, const pendres_store_spec *spec,
                               pendres_store_spec *out)
{
  char *name = NULL, *long_name = NULL;
  if (spec->type == PENDRES_STORE_STRING)
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT,
                              "'%s': a text has no error estimate", spec->name);
  const pendres_status status = error_names(spec, &name, &long_name);
  *out = *spec;
  out->name = name;
  out->long_name = long_name;
  out->type = PENDRES_STORE_DOUBLE;
  out->flag_count = 0;
  out->comment = NULL;
  return status;
}

pendres_status pendres_store_variable(pendres_store *store, const pendres_store_spec *spec, int *id,
                                      int *error_id)
{
  pendres_store_spec error = { 0 };
  pendres_store_node node, error_node;
  char *path = NULL, *error_path = NULL;
  int made = -1, error_made = -1;
  pendres_status status = pendres_store_enter(store, 1);

  if (!status) status = check_spec(store, spec, &node, &path);
  if (!status && error_id) status = error_of(store, spec, &error);
  if (!status && error_id) status = check_spec(store, &error, &error_node, &error_path);
  if (!status) status = make_variable(store, spec, &node, path, &made);
  if (!status && error_id)
    status =
      pendres_store_set_text(store, store->nodes[made].id, "ancillary_variables", error.name);
  if (!status && error_id)
    status = make_variable(store, &error, &error_node, error_path, &error_made);
  status = pendres_store_leave(store, status);
  if (id) *id = status ? -1 : made;
  if (error_id) *error_id = status ? -1 : error_made;
  free(path);
  free(error_path);
  free((char *)error.name);
  free((char *)error.long_name);
  return status;
}
