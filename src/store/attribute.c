/*
 * attribute.c -- attributes of groups and variables, and the provenance group.
 *
 * Owns: how text and numbers become attributes. Text is a string of variable length in UTF-8:
 * h5py and both engines of xarray give it back as str, where those of fixed length come as bytes.
 */
#include "store/internal.h"

#include <stdlib.h>

pendres_status pendres_store_set(pendres_store *store, hid_t object, const char *name,
                                 const pendres_store_value *value)
{
  const hsize_t size = value->n;
  hid_t space = size ? H5Screate_simple(1, &size, NULL) : H5Screate(H5S_SCALAR);
  hid_t attribute = H5I_INVALID_HID;
  pendres_status status = PENDRES_OK;
  const htri_t exists = H5Aexists(object, name);

  if (space < 0 || exists < 0 || (exists && H5Adelete(object, name) < 0) ||
      (attribute = H5Acreate2(object, name, value->file_type, space, H5P_DEFAULT,
                              H5P_DEFAULT)) < 0 ||
      H5Awrite(attribute, value->memory_type, value->at) < 0)
    status = pendres_store_fail_hdf5(store, "cannot write attribute '%s'", name);
  if (attribute >= 0 && H5Aclose(attribute) < 0 && !status)
    status = pendres_store_fail_hdf5(store, "cannot write attribute '%s'", name);
  if (space >= 0) H5Sclose(space);
  return status;
}

pendres_status pendres_store_set_text(pendres_store *store, hid_t object, const char *name,
                                      const char *value)
{
  char *text = pendres_store_utf8(value);
  const hid_t type = pendres_store_memory_type(PENDRES_STORE_STRING);
  pendres_status status;

  if (!text)
    status = PENDRES_OUT_OF_MEMORY;
  else if (type < 0)
    status = pendres_store_fail_hdf5(store, "cannot write attribute '%s'", name);
  else
    status = pendres_store_set(store, object, name,
                               &(pendres_store_value){ type, type, 0, &text });
  pendres_store_type_close(PENDRES_STORE_STRING, type);
  free(text);
  return status;
}

/* The open HDF5 object that an attribute is meant for. */
static pendres_status target(pendres_store *store, const char *group, const char *object,
                             const char *name, hid_t *id)
{
  pendres_store_node *node = NULL;
  pendres_status status = PENDRES_OK;
  char *path = NULL;

  if (!pendres_store_is_name(name))
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT,
                              "'%s' is not a name for an attribute", name ? name : "(null)");
  if (!object) {
    status = pendres_store_need_group(store, group, &node);
    if (!status) *id = node->id;
    return status;
  }
  path = pendres_store_path(group, object);
  if (!path) return PENDRES_OUT_OF_MEMORY;
  node = pendres_store_find(store, path);
  if (node)
    *id = node->id;
  else
    status = pendres_store_fail(store, PENDRES_INVALID_ARGUMENT,
                                "attribute '%s': there is no variable '%s'", name, path);
  free(path);
  return status;
}

pendres_status pendres_store_attribute(pendres_store *store, const char *group,
                                       const char *object, const char *name, const char *value)
{
  pendres_status status = pendres_store_enter(store, 1);
  hid_t id = H5I_INVALID_HID;

  if (!status && !value)
    status = pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "an attribute needs a text");
  if (!status) status = target(store, group, object, name, &id);
  if (!status) status = pendres_store_set_text(store, id, name, value);
  return pendres_store_leave(store, status);
}

pendres_status pendres_store_attribute_number(pendres_store *store, const char *group,
                                              const char *object, const char *name, double value)
{
  pendres_status status = pendres_store_enter(store, 1);
  hid_t id = H5I_INVALID_HID;

  if (!status) status = target(store, group, object, name, &id);
  if (!status)
    status = pendres_store_set(store, id, name,
                               &(pendres_store_value){ H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 0,
                                                       &value });
  return pendres_store_leave(store, status);
}

pendres_status pendres_store_provenance(pendres_store *store, const pendres_store_entry *entries,
                                        size_t n)
{
  const char group[] = "provenance";
  if (!store) return PENDRES_INVALID_ARGUMENT;
  if (n && !entries)
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "provenance without entries");
  pendres_status status = pendres_store_group(store, group);

  for (size_t i = 0; i < n && !status; i++) {
    const pendres_store_entry *entry = &entries[i];
    const pendres_store_spec spec = {
      .group = group,
      .name = entry->key,
      .type = entry->text ? PENDRES_STORE_STRING
              : entry->is_integer ? PENDRES_STORE_INT64 : PENDRES_STORE_DOUBLE,
      .long_name = entry->long_name ? entry->long_name : entry->key,
      .units = entry->units
    };

    status = pendres_store_put(store, &spec, entry->text ? (const void *)&entry->text
                               : entry->is_integer ? (const void *)&entry->integer
                               : (const void *)&entry->number, NULL, 1);
  }
  return status;
}
