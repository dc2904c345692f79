/*
 * grow.h -- arrays that grow: the driver's only way to enlarge them. No state; any thread may call.
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

#endif
