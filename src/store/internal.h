/*
 * internal.h -- what the files of src/store share. The only header that includes hdf5.h.
 *
 * Owns: what a store holds while it is open; functions are declared by the files that define them.
 */
#ifndef PENDRES_STORE_INTERNAL_H
#define PENDRES_STORE_INTERNAL_H

#include <hdf5.h>

#include <pendres/store.h>

#include "store/file.h"

/* Everything that a store made: its groups, dimensions and variables. */
typedef enum pendres_store_kind {
  PENDRES_STORE_GROUP,
  PENDRES_STORE_SCALE,
  PENDRES_STORE_VARIABLE
} pendres_store_kind;

typedef struct pendres_store_node {
  char *path; /* without leading slash; "" is the root */
  pendres_store_kind kind;
  hid_t id;
  pendres_store_type type;
  int rank;
  hsize_t sizes[PENDRES_STORE_RANK]; /* 1 beyond the rank */
  size_t row;                        /* elements a row */
} pendres_store_node;

/* HDF5's error printing as it was before a call. */
typedef struct pendres_store_quiet {
  unsigned is_v2;
  H5E_auto2_t print2;
#ifndef H5_NO_DEPRECATED_SYMBOLS
  H5E_auto1_t print1;
#endif
  void *data;
  int dead; /* HDF5 could not start: nothing of it may be called */
} pendres_store_quiet;

struct pendres_store {
  pendres_store_quiet quiet; /* during a call */
  pendres_store_file file;
  hid_t driver;
  hid_t h5; /* H5I_INVALID_HID once closed */
  int writing;
  int whole; /* the part is complete on disk: never remove it */
  pendres_status failed; /* sticky; PENDRES_OK if none */
  size_t count, room;
  pendres_store_node *nodes;
  char message[PENDRES_STORE_WHY];
};

/* driver.c: HDF5's way to the file. Negative on failure. */
hid_t pendres_store_driver_register(void);
herr_t pendres_store_driver_select(hid_t access, hid_t driver, pendres_store_file *file);

/* store.c: entering and leaving HDF5, and messages. */

/* Call first and, whatever it returned, pendres_store_leave() last. `writing`: the call writes. */
pendres_status pendres_store_enter(pendres_store *store, int writing);
/* Restore HDF5's error printing; turn a refused write into PENDRES_IO; make failures sticky. */
pendres_status pendres_store_leave(pendres_store *store, pendres_status status);
/* Record a message; returns the status. */
pendres_status pendres_store_fail(pendres_store *store, pendres_status status,
                                  const char *format, ...) __attribute__((format(printf, 3, 4)));
/* The same for a failure of HDF5, whose innermost message is appended: PENDRES_IO. */
pendres_status pendres_store_fail_hdf5(pendres_store *store, const char *format, ...)
  __attribute__((format(printf, 2, 3)));

/* text.c: names and text. */

/* 1 if a name is letters, digits and underscores with a letter first. */
int pendres_store_is_name(const char *name);
/* malloc'd copy. NULL: out of memory. */
char *pendres_store_copy(const char *text);
/* malloc'd "group/name" without slashes at its ends; name may be NULL. NULL: out of memory. */
char *pendres_store_path(const char *group, const char *name);
/* malloc'd copy as UTF-8, stray bytes taken for Latin-1. NULL: out of memory. */
char *pendres_store_utf8(const char *text);
/* malloc'd list of n such copies; a NULL among the texts becomes "". Free with the next. */
char **pendres_store_utf8_list(const char *const *texts, size_t n);
void pendres_store_utf8_free(char **list, size_t n);

/* layout.c: what a store made. */

/* Find the node with that path; NULL if there is none. */
pendres_store_node *pendres_store_find(const pendres_store *store, const char *path);
/* Make room for one more node, and a malloc'd copy of its path. */
pendres_status pendres_store_reserve(pendres_store *store, const char *path, char **copy);
/* Find the group with that path, or make it with its parents. Nodes may move: older pointers to
   them are no longer valid. */
pendres_status pendres_store_need_group(pendres_store *store, const char *group,
                                        pendres_store_node **out);

/* The attributes that every variable has. Units NULL: 1. */
pendres_status pendres_store_describe(pendres_store *store, hid_t id, const char *long_name,
                                      const char *units);

/* octave.c: mark the groups with text, for GNU Octave to pass over them. */
pendres_status pendres_store_mark_text(pendres_store *store);

/* sums.c */

/* Bytes. Shorter arrays are neither divided into chunks nor compressed. */
#define PENDRES_STORE_SHORT 4096
/* Add a dataset to the checksum of these, if it is one. Negative on failure. */
herr_t pendres_store_sums_add(hid_t dataset, uint64_t *sum);
/* Keep that of all that the store made, when all is written. */
pendres_status pendres_store_sums_write(pendres_store *store);
/* Compare with the one that the file has, if it has one. */
pendres_status pendres_store_sums_check(pendres_store *store, uint64_t sum);

/* attribute.c: make or replace an attribute of an open object. */

/* The value of an attribute: n numbers, 0 for a scalar, and their types in the file and in
   memory. */
typedef struct pendres_store_value {
  hid_t file_type, memory_type;
  size_t n;
  const void *at;
} pendres_store_value;
pendres_status pendres_store_set(pendres_store *store, hid_t object, const char *name,
                                 const pendres_store_value *value);
pendres_status pendres_store_set_text(pendres_store *store, hid_t object, const char *name,
                                      const char *value);

/* dataset.c */

/* Rows of a variable, and the n elements in memory that are theirs. */
typedef struct pendres_store_piece {
  uint64_t first, rows;
  size_t n;
} pendres_store_piece;
/* Refuse rows beyond the `all` rows of a variable. */
pendres_status pendres_store_check_rows(pendres_store *store, const char *name, uint64_t all,
                                        const pendres_store_piece *piece);

/* A type in memory; close it with the second, since those of strings are made. */
hid_t pendres_store_memory_type(pendres_store_type type);
void pendres_store_type_close(pendres_store_type type, hid_t id);
/* Sizes are set: work out a row, and check that the whole can be counted and addressed. */
pendres_status pendres_store_measure(pendres_store *store, pendres_store_node *node,
                                     const char *path);
/* Make the dataset in a group that exists, and put it on the list, as its last. */
pendres_status pendres_store_make(pendres_store *store, const char *path,
                                  const pendres_store_node *node, int deflate, size_t chunk_rows);
/* Write rows of a variable or scale, in pieces so small that a full disk is noticed in time. */
pendres_status pendres_store_node_write(pendres_store *store, const pendres_store_node *node,
                                        uint64_t first, uint64_t rows, const void *data);

/* Make a group, and those above it. Not an error if it exists. */
pendres_status pendres_store_group(pendres_store *store, const char *group);

/*
 * Give up: stop writing and remove PATH.part, or keep it if keep_part is not 0 (all that was
 * written up to now is then readable in it, provided no earlier call failed with PENDRES_IO).
 * PATH is not touched. As after pendres_store_close(), only message and free remain.
 */
pendres_status pendres_store_abandon(pendres_store *store, int keep_part);

#endif
