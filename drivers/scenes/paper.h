/*
 * paper.h -- the group `paper` of a file: values that the paper prints beside those of the run.
 */
#ifndef SCENE_PAPER_H
#define SCENE_PAPER_H

#include "scenes/columns.h"

typedef struct scene_printed {
  const char *name;      /* of the quantity, e.g. "resonance_period_gamma_0.24" */
  double printed;        /* by the paper */
  double computed, error;
  double difference;     /* is set when it is written */
} scene_printed;

/* Write them, if there are any. */
void scene_write_paper(scene_run *run, size_t n, scene_printed *values);

#endif
