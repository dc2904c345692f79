/**
 * @file store.h
 * @brief Self-describing HDF5 files, written whole or not at all.
 *
 * Owns: the layout rules of a result file. Knows no physics. A store writes to PATH.part and
 * renames it to PATH when it is closed, so that PATH is either what it was before or complete.
 *
 *     pendres_store *store = NULL;
 *     const pendres_store_spec damping = { .name = "damping", .long_name = "damping" };
 *     const pendres_store_spec area = { .name = "loop_area", .dimensions = { "damping" },
 *                                       .long_name = "area of the loop" };
 *
 *     if (pendres_store_create("run.h5", &(pendres_store_options){ .title = "A run" }, &store) ||
 *         pendres_store_dimension(store, &damping, n, gamma) ||
 *         pendres_store_put(store, &area, areas, errors, n) ||
 *         pendres_store_close(store))
 *       fprintf(stderr, "%s\n", pendres_store_message(store));
 *     pendres_store_free(store);
 *
 * Layout (netCDF-4 conventions, so that h5py and xarray with either engine open every group):
 * each dimension of each group has one one-dimensional scale in that group; links keep their
 * order of creation; every variable has `units` and `long_name`; labels are int8 with
 * `flag_values` and `flag_meanings`, without a fill value; doubles that were never written read
 * as NaN; numbers are stored little-endian. No time stamps are stored: the same calls with the
 * same values give the same bytes.
 *
 * Groups are paths such as "paper" or "paper/fig2"; NULL, "" and "/" are the root. They are made
 * when first named. Names are letters, digits and underscores, a letter first. Text is UTF-8;
 * bytes that are not are taken for Latin-1.
 *
 * Failures: PENDRES_INVALID_ARGUMENT changes nothing in the file, and the store can be used
 * further. After PENDRES_IO (for instance a full disk) or PENDRES_OUT_OF_MEMORY all further
 * writing is refused with the same status and message; close, abandon or free it. A process that
 * limits its file sizes must ignore SIGXFSZ to see PENDRES_IO instead of being killed.
 *
 * Two writers: the part file is created exclusively, so that of two runs on one output the later is
 * refused at once, with or without file locks. A part that a killed run has left is taken over: it
 * holds no lock (flock) any more. Where the file system has no locks, or the environment variable
 * HDF5_USE_FILE_LOCKING is FALSE or 0, this is not known: a part that exists is then refused, and
 * the user has to remove it.
 *
 * Thread safety: HDF5 is not thread safe. At most one thread of a process may be inside any
 * function of this header at a time, whatever the stores.
 */
#ifndef PENDRES_STORE_H
#define PENDRES_STORE_H

#include <stddef.h>
#include <stdint.h>

#include <pendres/status.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

enum { PENDRES_STORE_RANK = 8 /**< most dimensions of a variable */ };

/** Opaque: a file that is being written or read. */
typedef struct pendres_store pendres_store;

/** Types of elements, and what a buffer of them holds. */
typedef enum pendres_store_type {
  PENDRES_STORE_DOUBLE = 0, /**< double */
  PENDRES_STORE_INT8,       /**< int8_t */
  PENDRES_STORE_INT32,      /**< int32_t */
  PENDRES_STORE_INT64,      /**< int64_t */
  PENDRES_STORE_STRING,     /**< const char *, zero-terminated, not NULL */
  PENDRES_STORE_TYPE_COUNT  /**< how many there are; not a type */
} pendres_store_type;

/** Attributes of the root group, of which NULL leaves one out, and how the file is made. Of these
 *  only the history may contain the date, as the CF conventions require; whatever else changes from
 *  run to run (hosts, times taken) belongs in the provenance, so that the rest is equal for equal
 *  results. */
typedef struct pendres_store_options {
  size_t size; /**< sizeof this struct, or 0: that of version 1.0 (see pendres.h) */
  const char *title;      /**< what the file holds, in a line (CF conventions, 2.6.2) */
  const char *history;    /**< what was done to the data, and when */
  const char *source;     /**< how the data were made: the program and its version */
  const char *references; /**< publications that describe them */
  int alone; /**< 1: the caller knows that no other process writes this file, for instance by a lock
                  of its own: an existing part file is then a remainder, even where
                  HDF5_USE_FILE_LOCKING has switched off the locks that would show this */
} pendres_store_options;

/** What a variable is. Zero in any field means its default; nothing is kept after the call. */
typedef struct pendres_store_spec {
  const char *group;       /**< default: the root */
  const char *name;        /**< required */
  pendres_store_type type; /**< default: double */
  const char *dimensions[PENDRES_STORE_RANK]; /**< names of dimensions of the same group, slowest
                              first, up to the first NULL; none: a scalar */
  const char *long_name;   /**< required */
  const char *units;       /**< default "1"; use "s", since xarray turns "seconds" into dates */
  const char *comment;     /**< attribute of that name, if not NULL */
  const char *coordinates; /**< CF: names of auxiliary coordinates, separated by blanks */
  int flag_count;                   /**< int8 only: number of labels */
  const int8_t *flag_values;        /**< their codes; default 0, 1, 2, ... */
  const char *const *flag_meanings; /**< their names, without blanks; required with flag_count */
  int flag_bits;           /**< nonzero: labels are sums of flag_values, each of them a bit, or 0
                                for none of them; flag_masks then stands beside them (CF, 3.5) */
  int deflate;             /**< compression 1 to 9, default 4; -1 for none. Arrays of less than
                                4 KiB, and strings, are never compressed */
  size_t chunk_rows;       /**< rows a chunk; default one, or as many as make 64 KiB; a chunk
                                never exceeds 1 MiB */
} pendres_store_spec;

/** One entry of the provenance. */
typedef struct pendres_store_entry {
  const char *key;       /**< name of the scalar in the group */
  const char *text;      /**< not NULL: the entry is this text, of any length */
  double number;         /**< else it is a double, ... */
  int64_t integer;       /**< ... or this, if is_integer */
  int is_integer;        /**< nonzero: the entry is `integer`, not `number` */
  const char *units;     /**< default "1" */
  const char *long_name; /**< default: the key */
} pendres_store_entry;

/**
 * The file that a path means as an output. Links are followed, to a file that need not exist yet:
 * the results replace what the link points to, and the link stays. Refused with PENDRES_IO and a
 * sentence in why[size] (may be NULL): a link of another user's; a device or a stream, /dev/stdout
 * and the like included, even where it leads to a plain file; a folder; a file that is read-only
 * for this process, or for everybody even if this process is root's; another user's file in a
 * sticky folder, which he alone may replace. *target is to be freed by free(); NULL on failure.
 * Opens and makes nothing. Thread safe.
 */
pendres_status pendres_store_target(const char *path, char **target, char *why, size_t size);

/**
 * Start to write a file: TARGET.part beside the TARGET that path means (pendres_store_target). It
 * is made; of what may stand there, only the part that a killed process of this user has left is
 * emptied, and must have no other name (hard link). An existing TARGET is not touched.
 *
 * options may be NULL. *out receives the store, also when the function fails (unless out of
 * memory: then NULL), so that pendres_store_message() can give the reason; pass it to
 * pendres_store_free() in any case.
 *
 * PENDRES_IO: the folder does not exist or cannot be written, the disk is full, path is refused
 * by pendres_store_target(), another process is writing the same file, or another file stands where
 * the part is to be made.
 */
pendres_status pendres_store_create(const char *path, const pendres_store_options *options,
                                    pendres_store **out);

/**
 * Finish: write everything to the disk, rename PATH.part to PATH. The store is then only good
 * for pendres_store_message() and pendres_store_free(). On PENDRES_IO PATH is what it was.
 */
pendres_status pendres_store_close(pendres_store *store);

/**
 * Remove PATH.part, unless it is whole, and do nothing else: for a program that is ended within a
 * call of the store, as HDF5 does by exit() when it gets no memory for a handle (and it may crash).
 * Only what a signal handler may do. NULL is allowed; a store without a part is left as it is.
 */
void pendres_store_drop_part(const pendres_store *store);

/**
 * Free a store; NULL is allowed. One that was neither closed nor abandoned is abandoned, its part
 * removed. (If closing failed only at the rename, the part is complete and stays.)
 */
void pendres_store_free(pendres_store *store);

/** The message of the last failure; "" if none. Owned by the store, valid until its next use. */
const char *pendres_store_message(const pendres_store *store);

/** Make what was written so far survive the end of the process: PATH.part can be opened up to
 *  here if the process is killed later; until the end its `Conventions` are "(part)". Costs a
 *  rewrite of chunks that are not full. */
pendres_status pendres_store_flush(pendres_store *store);

/**
 * Define a dimension and its scale. Of spec are read: group, name, which must be new, type,
 * long_name and units. values[size] of that type are written at once; NULL: 0, 1, ... size - 1 as
 * int64, but strings, for instance names of methods, must be given. size may be 0.
 */
pendres_status pendres_store_dimension(pendres_store *store, const pendres_store_spec *spec,
                                       uint64_t size, const void *values);

/**
 * Define a variable; *id is what the writing functions take. The name must be new and the
 * dimensions must exist in the same group. Where error_id is not NULL it is a number with an error
 * estimate: the double NAME_error of the same shape and units is defined too, and named in the
 * attribute `ancillary_variables` of the first. Either both are made or none.
 */
pendres_status pendres_store_variable(pendres_store *store, const pendres_store_spec *spec, int *id,
                                      int *error_id);

/** Write a whole variable of n elements; n must be its size (1 for a scalar). data holds
 *  elements of its type, the last dimension fastest. */
pendres_status pendres_store_write(pendres_store *store, int id, const void *data, size_t n);

/** Write rows first, ... first + rows - 1 along the first dimension, in any order and as often
 *  as wanted; n elements in all. */
pendres_status pendres_store_write_rows(pendres_store *store, int id, uint64_t first,
                                        uint64_t rows, const void *data, size_t n);

/** Define a variable and write all of it in one call: with its error estimates error[n], if these
 *  are not NULL. */
pendres_status pendres_store_put(pendres_store *store, const pendres_store_spec *spec,
                                 const void *data, const double *error, size_t n);

/**
 * Set a text attribute of `object` (a variable or dimension of the group), or of the group itself
 * if object is NULL. An attribute that exists is replaced. Those that make the layout
 * (DIMENSION_LIST and the like) are not to be touched.
 */
pendres_status pendres_store_attribute(pendres_store *store, const char *group,
                                       const char *object, const char *name, const char *value);

/** The same with a number. */
pendres_status pendres_store_attribute_number(pendres_store *store, const char *group,
                                              const char *object, const char *name, double value);

/** Write n entries as scalars of the group "provenance". May be called more than once. */
pendres_status pendres_store_provenance(pendres_store *store, const pendres_store_entry *entries,
                                        size_t n);

/* ---- Reading back: for resuming a run and for tests ------------------------------------------ */

/** Open a file, finished or a part, for reading. *out and failures as in pendres_store_create(),
 *  for a pipe or a device as well; PENDRES_BUSY: HDF5 cannot lock the file, which another process
 *  has open for writing, or locks are denied. Free with pendres_store_free(). */
pendres_status pendres_store_open(const char *path, pendres_store **out);

/**
 * Read everything: each attribute and dataset of a file that pendres_store_open() has opened, in
 * pieces. HDF5 verifies its checksums on the way: numbers and headers have them, texts and the
 * indices of chunks do not. *datasets (may be NULL) is how many were read. PENDRES_IO: the
 * message names what cannot be read. A damaged file may make HDF5 itself crash: read a doubtful one
 * in a process of its own. Thread safety: that of all functions of a store.
 */
pendres_status pendres_store_verify(pendres_store *store, uint64_t *datasets);

/** 1 if the group holds an object of that name (NULL: if the group exists), else 0. */
int pendres_store_has(pendres_store *store, const char *group, const char *name);

/** Rank and sizes of a variable; sizes beyond the rank are set to 1. PENDRES_NOT_FOUND. */
pendres_status pendres_store_shape(pendres_store *store, const char *group, const char *name,
                                   int *rank, uint64_t sizes[PENDRES_STORE_RANK]);

/**
 * Name of member number `index` of a group, in the order in which they were made. *name is the
 * caller's, to be freed by free(). *type (may be NULL) is that of its elements, or
 * PENDRES_STORE_TYPE_COUNT if it is a group or of another type. PENDRES_NOT_FOUND: there are no
 * more.
 */
pendres_status pendres_store_member(pendres_store *store, const char *group, uint64_t index,
                                    pendres_store_type *type, char **name);

/** Name of dimension number `axis` of a variable, 0 for the slowest; that of a dimension is itself.
 *  *dimension is the caller's, to be freed by free(). PENDRES_NOT_FOUND: it has none such. */
pendres_status pendres_store_dimension_of(pendres_store *store, const char *group,
                                          const char *name, int axis, char **dimension);

/** Read a whole variable of numbers, n elements, converted to `type` (not a string). */
pendres_status pendres_store_read(pendres_store *store, const char *group, const char *name,
                                  pendres_store_type type, void *data, size_t n);

/** Read rows first, ... first + rows - 1 along the first dimension; n elements in all. Of spec are
 *  read: group, name and type, to which they are converted (not a string). */
pendres_status pendres_store_read_rows(pendres_store *store, const pendres_store_spec *spec,
                                       uint64_t first, uint64_t rows, void *data, size_t n);

/** Read element `index` of a variable of strings. *text is the caller's, to be freed by free(). */
pendres_status pendres_store_read_text(pendres_store *store, const char *group, const char *name,
                                       uint64_t index, char **text);

/** Read a text attribute (object as above). *text is the caller's, to be freed by free(). */
pendres_status pendres_store_read_attribute_text(pendres_store *store, const char *group,
                                                 const char *object, const char *name,
                                                 char **text);

/** Read a scalar attribute that is a number. */
pendres_status pendres_store_read_attribute_double(pendres_store *store, const char *group,
                                                   const char *object, const char *name,
                                                   double *value);

/** Version of the HDF5 library that is linked. */
void pendres_store_hdf5_version(unsigned *major, unsigned *minor, unsigned *release);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
