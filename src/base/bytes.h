/*
 * bytes.h -- records as plain bytes: a function that passes a record's parts along, one after
 * another, writes them or reads them.
 *
 * Bytes have the layout of this build of the library on this kind of machine, and no checksum: who
 * keeps them adds one. Those that are read may come from elsewhere.
 */
#ifndef PENDRES_BYTES_H
#define PENDRES_BYTES_H

#include <stddef.h>

#include <pendres/status.h>

typedef struct pendres_bytes {
  int reads;             /* 0: writes */
  pendres_status status; /* once it is not PENDRES_OK nothing is passed on */
  size_t size, capacity, at;
  char *bytes; /* written: to be freed by free() */
} pendres_bytes;

/* To be read; those to be written are all zero at first. */
pendres_bytes pendres_bytes_read(size_t size, const void *bytes);

/* Pass n elements. PENDRES_INVALID_ARGUMENT: there are fewer to be read; these become 0. */
void pendres_bytes_pass(pendres_bytes *b, size_t n, size_t size, void *elements);

/* The same for the array whose address is stored at `array` (see pendres_regrow()), which reading
   allocates; NULL without elements. */
void pendres_bytes_pass_array(pendres_bytes *b, size_t n, size_t size, void *array);

/* Whether all is well so far; not so where what was read does not fit: PENDRES_INVALID_ARGUMENT. */
int pendres_bytes_fit(pendres_bytes *b, int fits);

/* Whether reading has come to the end, neither before nor behind it. */
int pendres_bytes_end(pendres_bytes *b);

#endif
