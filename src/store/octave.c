/*
 * octave.c -- lets GNU Octave's `load` read the numbers of a store.
 *
 * Owns: the mark by which Octave skips a group. Octave reads only text in ASCII of fixed length,
 * and stops at the first that is not. No single form works for all readers: netCDF-C 4.9
 * overruns its memory at arrays of text of fixed length, h5netcdf gives bytes instead of str, and
 * decks may hold letters beyond ASCII. Text therefore has variable length, and groups with text are
 * skipped: Octave takes a group with the attribute OCTAVE_NEW_FORMAT for one of its own values,
 * whose kind is given by the text `type` in it, and silently skips those whose `type` is not a
 * text. Source: Octave's libinterp/corefcn/ls-hdf5.cc, hdf5_read_next_data_internal(), the same in
 * versions 3 to 9. Text beside the numbers of the root cannot be skipped in this way.
 */
#include "store/internal.h"

#include <stdlib.h>
#include <string.h>

/* The group holds text itself, not only in groups within. */
static int holds_text(const pendres_store *store, const char *group)
{
  const size_t length = strlen(group);

  for (size_t i = 0; i < store->count; i++) {
    const pendres_store_node *node = &store->nodes[i];

    if (node->kind != PENDRES_STORE_GROUP && node->type == PENDRES_STORE_STRING &&
        !strncmp(node->path, group, length) && node->path[length] == '/' &&
        !strchr(node->path + length + 1, '/'))
      return 1;
  }
  return 0;
}

static pendres_status mark(pendres_store *store, const char *group, hid_t id)
{
  pendres_store_node sign = { .kind = PENDRES_STORE_VARIABLE, .type = PENDRES_STORE_INT8 };
  const uint8_t one = 1;
  const int8_t zero = 0;
  char *path = pendres_store_path(group, "type");
  pendres_status status = path ? PENDRES_OK : PENDRES_OUT_OF_MEMORY;

  /* A variable of that name belongs to the caller. If it is a number it has the same effect. */
  if (!status && !pendres_store_find(store, path)) {
    for (int k = 0; k < PENDRES_STORE_RANK; k++) sign.sizes[k] = 1;
    status = pendres_store_measure(store, &sign, path);
    if (!status) status = pendres_store_make(store, path, &sign, 0, 0);
    if (!status) {
      const pendres_store_node *made = &store->nodes[store->count - 1];

      status = pendres_store_describe(store, made->id,
                                      "sign for GNU Octave's load to pass over this group, whose "
                                      "text it cannot read", "1");
      if (!status) status = pendres_store_node_write(store, made, 0, 1, &zero);
    }
  }
  if (!status)
    status = pendres_store_set(store, id, "OCTAVE_NEW_FORMAT",
                               &(pendres_store_value){ H5T_STD_U8LE, H5T_NATIVE_UINT8, 0, &one });
  free(path);
  return status;
}

pendres_status pendres_store_mark_text(pendres_store *store)
{
  pendres_status status = PENDRES_OK;

  /* The list moves as it grows; the paths stay where they are. */
  for (size_t i = 0; i < store->count && !status; i++)
    if (store->nodes[i].kind == PENDRES_STORE_GROUP && *store->nodes[i].path &&
        holds_text(store, store->nodes[i].path))
      status = mark(store, store->nodes[i].path, store->nodes[i].id);
  return status;
}
