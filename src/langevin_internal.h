/*
 * langevin_internal.h -- what langevin.c and langevin_cloud.c share.
 */
#ifndef PENDRES_LANGEVIN_INTERNAL_H
#define PENDRES_LANGEVIN_INTERNAL_H

#include <pendres/langevin.h>

#include "langevin_block.h"

struct pendres_langevin {
  pendres_langevin_options options; /* defaults resolved */
  pendres_langevin_block block;
  pendres_langevin_block partner; /* the coarse one of a pair; made when first asked for */
  double spent;
  int (*stop)(void *arg);
  void *stop_arg;
  char message[256];
};

/* Keep a sentence, return the status. */
pendres_status pendres_langevin_fail(pendres_langevin *lv, pendres_status status,
                                     const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* PENDRES_INTERRUPTED if the caller wants to stop. */
pendres_status pendres_langevin_poll(pendres_langevin *lv);

/* Check one pendulum, its state and the periods asked for; index is for the message. */
pendres_status pendres_langevin_accept(pendres_langevin *lv, const pendres_pendulum *p, double x,
                                       double v, size_t index);
pendres_status pendres_langevin_accept_periods(pendres_langevin *lv, long first, long periods);

#endif
