/*
 * flow_drive.h -- the drive at the right-hand sides of a flow.
 *
 * Owns: the exact phase of each stage, and the drive's cosine there, remembered from period to
 * period.
 */
#ifndef PENDRES_FLOW_DRIVE_H
#define PENDRES_FLOW_DRIVE_H

#include <stddef.h>

#include "engine/tables.h"

typedef struct pendres_flow_drive {
  int steps;                               /* a period; 0: adaptive */
  int stages;
  double node[PENDRES_TABLES_MOST_STAGES]; /* of the stages of a step */
  double *theta, *cosine; /* at the right-hand sides of a period, in their order, which is the same
                             every period */
  size_t size, next;
} pendres_flow_drive;

/* The exact phase of the stage at which ARKODE's clock shows theta. */
double pendres_flow_drive_phase(const pendres_flow_drive *drive, double theta);

/* cos(theta) at the next right-hand side of a period. */
double pendres_flow_drive_cosine(pendres_flow_drive *drive, double theta);

/* Begin a period. */
void pendres_flow_drive_rewind(pendres_flow_drive *drive);

/* Make room for `steps` steps per period. */
int pendres_flow_drive_resize(pendres_flow_drive *drive, int steps);

void pendres_flow_drive_free(pendres_flow_drive *drive);

#endif
