/*
 * flow_table.h -- Butcher tables in ARKODE's form, and the step controller.
 */
#ifndef PENDRES_FLOW_TABLE_H
#define PENDRES_FLOW_TABLE_H

#include <stdio.h> /* arkode_butcher.h of SUNDIALS 6.4 needs it */

#include <arkode/arkode_butcher.h>

#include <pendres/context.h>

/*
 * A table for ERKStepSetTable, to be freed by ARKodeButcherTable_Free; NULL if out of memory.
 * With fixed_steps, stages that do not contribute to the step (b = 0, at the end) and the
 * embedded weights are left out. *stages is the number of stages left.
 */
ARKodeButcherTable pendres_flow_table(pendres_table table, int fixed_steps, int *stages);

/* All parameters of the step controller set by hand: SUNDIALS' defaults changed in 7.3. */
int pendres_flow_set_controller(void *arkode);

#endif
