/*
 * sized.h -- options whose first field is their size: which ones this version of the library knows.
 *
 * Version 1.0 knows its own. A later one that has appended fields takes those of programs that were
 * compiled before, whose size is smaller, and finds zero in the fields that these do not have.
 */
#ifndef PENDRES_SIZED_H
#define PENDRES_SIZED_H

/* NULL, or what is wrong with the size of *options; 0 stands for that of version 1.0. */
#define PENDRES_SIZED_REFUSES(options)                                 \
  ((options)->size == 0 || (options)->size == sizeof *(options)        \
     ? NULL                                                            \
     : "the size of the options is none of this version of the library")

#endif
