/*
 * grow.h -- arrays that grow: the driver's only way to enlarge them. No state; any thread may call.
 * And what becomes of memory that is freed.
 */
#ifndef GROW_H
#define GROW_H

#include <stddef.h>

/*
 * Make room for elements of some size in the array whose address is stored at `array`: pass &a for
 * an array a of any type. Where *capacity is less, a larger array takes its place; new elements
 * are zero. 0: out of memory; all is as it was.
 */
int grow_to(void *array, size_t wanted, size_t *capacity, size_t size);

/* From now on memory that is freed stays with the program, for its next arrays. Given back to the
   system and taken again, it would be cleared a page at a time. To be called before there are
   threads. */
void keep_freed_memory(void);

#endif
