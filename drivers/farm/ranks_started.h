/* ranks_started.h -- what launchers tell the processes that they start, in the environment. */
#ifndef RANKS_STARTED_H
#define RANKS_STARTED_H

#include <stdlib.h>

/* How many processes a launcher has started together; 1: no launcher, or a single one. */
static inline long ranks_started(void)
{
  static const char *const names[] = { "OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE",
                                       "SLURM_STEP_NUM_TASKS" };
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    const char *text = getenv(names[i]);
    const long n = text != NULL ? strtol(text, NULL, 10) : 0;
    if (n > 1) return n;
  }
  return 1;
}

#endif
