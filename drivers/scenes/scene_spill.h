/*
 * scene_spill.h -- what tasks find and later tasks read, where it may be more than memory holds.
 *
 * Owns: an array of elements of one size, in memory while it is small, else in a file without a
 * name, in TMPDIR or where the output goes, which is gone with the run however that ends.
 */
#ifndef SCENE_SPILL_H
#define SCENE_SPILL_H

#include "scenes/scene.h"

enum { SCENE_SPILL_MEMORY = 64 << 20 /* bytes: no file up to here */ };

typedef struct scene_spill {
  size_t element;
  char *memory; /* NULL: in the file */
  int file;
} scene_spill;

/* Room for n elements, of which up to `memory` bytes are kept there. PENDRES_IO: run->message has
   the reason. */
pendres_status scene_spill_create(scene_run *run, size_t n, size_t element, size_t memory,
                                  scene_spill *out);
/* One that was not created is zero; nothing is done then. */
void scene_spill_free(scene_spill *s);

/* Elements number first ... first + n - 1. Any thread may read, while none writes the same ones.
   PENDRES_IO: why[size] says the reason. */
pendres_status scene_spill_put(const scene_spill *s, size_t first, size_t n, const void *data,
                               char *why, size_t size);
pendres_status scene_spill_get(const scene_spill *s, size_t first, size_t n, void *data, char *why,
                               size_t size);

#endif
