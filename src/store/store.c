/*
 * store.c -- the life of a store: create, open, flush, close, abandon; and its messages.
 *
 * Owns: the HDF5 file handle, the way into and out of each public call, and the root attributes.
 * A file is complete or absent: HDF5 writes PATH.part through driver.c, file.c makes
 * it PATH. HDF5 prints errors by itself unless told not to: each call silences that and puts the
 * setting of the caller back.
 * Source of the layout: CF Conventions 1.8; HDF5 Dimension Scale specification 1.0.
 */
#include "store/internal.h"
#include "base/sized.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Messages -------------------------------------------------------------------------------- */

pendres_status pendres_store_fail(pendres_store *store, pendres_status status, const char *format,
                                  ...)
{
  va_list args;

  va_start(args, format);
  vsnprintf(store->message, sizeof store->message, format, args);
  va_end(args);
  return status;
}

/* Keep the first entry of HDF5's list of errors, which is the one where the error arose. */
static herr_t first_words(unsigned n, const H5E_error2_t *error, void *to)
{
  if (n == 0)
    snprintf(to, PENDRES_STORE_WHY / 2, "%s: %s", error->func_name ? error->func_name : "HDF5",
             error->desc && *error->desc ? error->desc : "no description");
  return 0;
}

pendres_status pendres_store_fail_hdf5(pendres_store *store, const char *format, ...)
{
  char words[PENDRES_STORE_WHY / 2] = "";
  size_t used;
  va_list args;

  if (H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, first_words, words) < 0) words[0] = '\0';
  va_start(args, format);
  vsnprintf(store->message, sizeof store->message, format, args);
  va_end(args);
  used = strlen(store->message);
  if (*words) snprintf(store->message + used, sizeof store->message - used, " (%s)", words);
  return PENDRES_IO;
}

const char *pendres_store_message(const pendres_store *store)
{
  return store ? store->message : "out of memory, or no store";
}

/* ---- Into and out of HDF5 -------------------------------------------------------------------- */

/* Silence HDF5's messages. Negative if HDF5 could not start. */
static int quiet_begin(pendres_store_quiet *quiet)
{
  /* Called again, an HDF5 that could not start would crash. */
  quiet->dead = H5open() < 0;
  if (quiet->dead) return -1;
  quiet->is_v2 = 1;
  quiet->print2 = NULL;
  quiet->data = NULL;
#ifndef H5_NO_DEPRECATED_SYMBOLS
  quiet->print1 = NULL;
  H5Eauto_is_v2(H5E_DEFAULT, &quiet->is_v2);
  if (!quiet->is_v2) {
    H5Eget_auto1(&quiet->print1, &quiet->data);
    H5Eset_auto1(NULL, NULL);
    return 0;
  }
#endif
  H5Eget_auto2(H5E_DEFAULT, &quiet->print2, &quiet->data);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  return 0;
}

static void quiet_end(const pendres_store_quiet *quiet)
{
  if (quiet->dead) return;
  H5Eclear2(H5E_DEFAULT);
#ifndef H5_NO_DEPRECATED_SYMBOLS
  if (!quiet->is_v2) {
    H5Eset_auto1(quiet->print1, quiet->data);
    return;
  }
#endif
  H5Eset_auto2(H5E_DEFAULT, quiet->print2, quiet->data);
}

static pendres_status no_hdf5(pendres_store *store)
{
  return pendres_store_fail(store, PENDRES_OUT_OF_MEMORY, "HDF5 cannot start: out of memory?");
}

pendres_status pendres_store_enter(pendres_store *store, int writing)
{
  if (!store) return PENDRES_INVALID_ARGUMENT;
  const int dead = quiet_begin(&store->quiet) < 0;
  if (store->failed) return store->failed; /* the message is still that of the failure */
  if (dead) return no_hdf5(store);
  store->message[0] = '\0';
  if (store->h5 < 0)
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "the store is closed");
  if (writing && !store->writing)
    return pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "'%s' is open for reading only",
                              store->file.path);
  return PENDRES_OK;
}

pendres_status pendres_store_leave(pendres_store *store, pendres_status status)
{
  if (!store) return status;
  if (!store->failed) {
    if (store->file.error && store->writing)
      status = pendres_store_fail(store, PENDRES_IO, "cannot write '%s': %s", store->file.part,
                                  strerror(store->file.error));
    if (store->writing && (status == PENDRES_IO || status == PENDRES_OUT_OF_MEMORY))
      store->failed = status;
    if (status == PENDRES_OUT_OF_MEMORY && !store->message[0])
      pendres_store_fail(store, status, "out of memory");
  }
  quiet_end(&store->quiet);
  return status;
}

/* ---- Creation -------------------------------------------------------------------------------- */

static pendres_store *store_new(void)
{
  pendres_store *store = calloc(1, sizeof *store);

  if (!store) return NULL;
  store->file.fd = -1;
  store->driver = store->h5 = H5I_INVALID_HID;
  return store;
}

/*
 * The new HDF5 file, by our driver, its links in order of creation, without time stamps, in the
 * format of HDF5 1.8, the first whose headers have checksums. That of 1.10 marks a file as being
 * written, and what a killed run has left could not be opened.
 */
static pendres_status create_h5(pendres_store *store)
{
  hid_t creation = H5Pcreate(H5P_FILE_CREATE);
  hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  pendres_status status = PENDRES_OK;

  store->driver = pendres_store_driver_register();
  if (creation < 0 || access < 0 || store->driver < 0 ||
      H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED) < 0 ||
      H5Pset_obj_track_times(creation, 0) < 0 ||
      H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST) < 0 ||
      H5Pset_fclose_degree(access, H5F_CLOSE_STRONG) < 0 ||
      pendres_store_driver_select(access, store->driver, &store->file) < 0 ||
      (store->h5 = H5Fcreate(store->file.part, H5F_ACC_TRUNC, creation, access)) < 0)
    status = pendres_store_fail_hdf5(store, "cannot create '%s'", store->file.part);
  if (creation >= 0) H5Pclose(creation);
  if (access >= 0) H5Pclose(access);
  return status;
}

static pendres_status set_root(pendres_store *store, const pendres_store_options *options)
{
  const char *const names[] = { "Conventions", "title", "history", "source", "references" };
  const char *values[] = { PENDRES_STORE_MARK, NULL, NULL, NULL, NULL };
  pendres_store_node *root = NULL;
  pendres_status status = pendres_store_need_group(store, "", &root);

  if (options) {
    values[1] = options->title;
    values[2] = options->history;
    values[3] = options->source;
    values[4] = options->references;
  }
  for (size_t i = 0; i < sizeof names / sizeof names[0] && !status; i++)
    if (values[i]) status = pendres_store_set_text(store, root->id, names[i], values[i]);
  return status;
}

pendres_status pendres_store_create(const char *path, const pendres_store_options *options,
                                    pendres_store **out)
{
  pendres_store *store = NULL;
  pendres_status status;

  if (!out) return PENDRES_INVALID_ARGUMENT;
  *out = store = store_new();
  if (!store) return PENDRES_OUT_OF_MEMORY;
  store->writing = 1;
  if (quiet_begin(&store->quiet) < 0) {
    status = no_hdf5(store);
    goto leave;
  }
  if (!path || !*path) {
    status = store->failed =
      pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "a store needs the path of its file");
    goto leave;
  }
  if (options && PENDRES_SIZED_REFUSES(options)) {
    status = store->failed = pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "%s",
                                                PENDRES_SIZED_REFUSES(options));
    goto leave;
  }
  status = pendres_store_file_create(&store->file, path, options && options->alone);
  if (status == PENDRES_IO) pendres_store_fail(store, status, "%s", store->file.why);
  if (!status) status = create_h5(store);
  if (!status) status = set_root(store, options);
  /* A first write to the disk tells whether it is full before any work is done. */
  if (!status && H5Fflush(store->h5, H5F_SCOPE_LOCAL) < 0)
    status = pendres_store_fail_hdf5(store, "cannot write '%s'", store->file.part);
leave:
  return pendres_store_leave(store, status);
}

pendres_status pendres_store_open(const char *path, pendres_store **out)
{
  pendres_store *store = NULL;
  pendres_status status = PENDRES_OK;

  if (!out) return PENDRES_INVALID_ARGUMENT;
  *out = store = store_new();
  if (!store) return PENDRES_OUT_OF_MEMORY;
  if (quiet_begin(&store->quiet) < 0) {
    status = no_hdf5(store);
  } else if (!path || !*path) {
    status = pendres_store_fail(store, PENDRES_INVALID_ARGUMENT, "no path of a file given");
  } else {
    store->file.path = pendres_store_copy(path);
    status = store->file.path ? pendres_store_file_look(path, store->message)
                              : PENDRES_OUT_OF_MEMORY;
    if (!status && (store->h5 = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT)) < 0)
      status = pendres_store_fail_hdf5(store, "cannot read '%s'", path);
  }
  store->failed = status;
  return pendres_store_leave(store, status);
}

/* ---- End ------------------------------------------------------------------------------------- */

/* Close all that HDF5 holds. A file that HDF5 cannot close stays in store->h5. */
static pendres_status close_h5(pendres_store *store)
{
  pendres_status status = PENDRES_OK;

  for (size_t i = store->count; i-- > 0;) {
    pendres_store_node *node = &store->nodes[i];

    if (node->id >= 0 && (node->kind == PENDRES_STORE_GROUP ? H5Gclose : H5Dclose)(node->id) < 0)
      status = PENDRES_IO;
    free(node->path);
  }
  free(store->nodes);
  store->nodes = NULL;
  store->count = store->room = 0;
  if (store->h5 >= 0 && H5Fclose(store->h5) < 0)
    status = PENDRES_IO;
  else
    store->h5 = H5I_INVALID_HID;
  if (status) pendres_store_fail_hdf5(store, "cannot close '%s'", store->file.path);
  if (store->driver >= 0) H5FDunregister(store->driver);
  store->driver = H5I_INVALID_HID;
  return status;
}

pendres_status pendres_store_flush(pendres_store *store)
{
  pendres_status status = pendres_store_enter(store, 1);

  if (!status && H5Fflush(store->h5, H5F_SCOPE_LOCAL) < 0)
    status = pendres_store_fail_hdf5(store, "cannot write '%s'", store->file.part);
  return pendres_store_leave(store, status);
}

pendres_status pendres_store_close(pendres_store *store)
{
  pendres_status status = pendres_store_enter(store, 1);

  if (!status) status = pendres_store_mark_text(store);
  if (!status) status = pendres_store_sums_write(store);
  if (!status) status = close_h5(store);
  if (!status) {
    status = pendres_store_file_finish(&store->file, &store->whole);
    if (status) pendres_store_fail(store, status, "%s", store->file.why);
  }
  return pendres_store_leave(store, status);
}

void pendres_store_drop_part(const pendres_store *store)
{
  if (store && store->writing && !store->whole) pendres_store_file_unlink(&store->file);
}

pendres_status pendres_store_abandon(pendres_store *store, int keep_part)
{
  pendres_status status = PENDRES_OK;

  if (!store) return PENDRES_INVALID_ARGUMENT;
  (void)quiet_begin(&store->quiet);
  /* This comes first, since an HDF5 that is short of memory may crash when it closes. */
  if (!keep_part) pendres_store_drop_part(store);
  if (store->h5 >= 0) status = close_h5(store);
  pendres_store_file_abandon(&store->file, keep_part || store->whole);
  /* Failures do not matter if the file is discarded. */
  return pendres_store_leave(store, keep_part ? status : PENDRES_OK);
}

void pendres_store_free(pendres_store *store)
{
  if (!store) return;
  pendres_store_abandon(store, 0);
  /* HDF5 closes at exit what it could not close, through our file, which must still be there: it is
     leaked. */
  if (store->h5 >= 0) return;
  pendres_store_file_destroy(&store->file);
  free(store);
}

void pendres_store_hdf5_version(unsigned *major, unsigned *minor, unsigned *release)
{
  unsigned version[3] = { 0, 0, 0 };

  if (H5get_libversion(&version[0], &version[1], &version[2]) < 0)
    version[0] = version[1] = version[2] = 0;
  if (major) *major = version[0];
  if (minor) *minor = version[1];
  if (release) *release = version[2];
}
