/*
 * langevin_internal.h -- what langevin.c and langevin_cloud.c share.
 */
#ifndef PENDRES_LANGEVIN_INTERNAL_H
#define PENDRES_LANGEVIN_INTERNAL_H

#include <pendres/langevin.h>

#include "base/guard.h"
#include "noise/langevin_block.h"

struct pendres_langevin {
  pendres_guard guard;
  pendres_langevin_options options; /* defaults resolved */
  pendres_langevin_block block;
  pendres_langevin_block partner; /* the coarse one of a pair; made when first asked for */
  double spent;
  pendres_cost cost;
  int (*stop)(void *arg);
  void *stop_arg;
};

/* The body of a public function that computes with a handle; see guard.h. */
#define PENDRES_LANGEVIN_CALL(lv, call) \
  PENDRES_GUARD_CALL((lv) != NULL ? &(lv)->guard : NULL, call)

/* Refuse arguments that are NULL; `names` is the sentence's beginning. */
#define PENDRES_LANGEVIN_NULL(lv, names) \
  pendres_langevin_fail(lv, PENDRES_INVALID_ARGUMENT, "%s must not be NULL", names)

/* Keep a sentence, return the status. */
pendres_status pendres_langevin_fail(pendres_langevin *lv, pendres_status status,
                                     const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* PENDRES_INTERRUPTED if the caller wants to stop. */
pendres_status pendres_langevin_poll(pendres_langevin *lv);

/* Count a period of a block's trajectories. */
void pendres_langevin_count(pendres_langevin *lv, const pendres_langevin_block *b);

/* Check one pendulum, its state and the periods asked for; index is for the message. */
pendres_status pendres_langevin_accept(pendres_langevin *lv, const pendres_pendulum *p, double x,
                                       double v, size_t index);
pendres_status pendres_langevin_accept_periods(pendres_langevin *lv, long first, long periods);

#endif
