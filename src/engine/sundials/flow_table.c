/* flow_table.c -- Butcher tables in ARKODE's form; see flow_table.h. */
#include "engine/sundials/flow_table.h"

#include <stddef.h>

#include <arkode/arkode_butcher_erk.h>
#include <arkode/arkode_erkstep.h>

#include "engine/sundials/compat.h"
#include "engine/kernels/tables.h"

/* Stages without the trailing ones that carry no weight. */
static int stages_needed(const pendres_tables_method *m)
{
  int stages = m->stages;
  while (stages > 1 && m->b[stages - 1] == 0.0) stages--;
  return stages;
}

ARKodeButcherTable pendres_flow_table(pendres_table table, int fixed_steps, int *stages)
{
  const pendres_tables_method *m = pendres_tables_get(table);
  sunrealtype a[PENDRES_TABLES_MOST_STAGES * PENDRES_TABLES_MOST_STAGES] = {0};
  sunrealtype b[PENDRES_TABLES_MOST_STAGES], c[PENDRES_TABLES_MOST_STAGES],
    d[PENDRES_TABLES_MOST_STAGES];

  if (m == NULL) {
    ARKodeButcherTable t = ARKodeButcherTable_LoadERK(ARKODE_DORMAND_PRINCE_7_4_5);
    if (t != NULL) *stages = t->stages;
    return t;
  }
  const int s = fixed_steps ? stages_needed(m) : m->stages;
  for (int k = 0; k < m->entries; k++)
    if (m->a[k].row < s) a[m->a[k].row * s + m->a[k].column] = m->a[k].value;
  for (int i = 0; i < s; i++) {
    b[i] = m->b[i];
    c[i] = m->c[i];
    d[i] = m->d[i];
  }
  *stages = s;
  return ARKodeButcherTable_Create(s, m->order, fixed_steps ? 0 : m->embedded_order, c, a, b,
                                   fixed_steps ? NULL : d);
}

int pendres_flow_set_controller(void *arkode)
{
  int bad = pendres_compat_set_pid(arkode);
  bad |= ERKStepSetSafetyFactor(arkode, 0.96);
  bad |= ERKStepSetErrorBias(arkode, 1.5);
  bad |= ERKStepSetMaxGrowth(arkode, 20.0);
  bad |= ERKStepSetMaxFirstGrowth(arkode, 10000.0);
  bad |= ERKStepSetFixedStepBounds(arkode, 1.0, 1.5);
  bad |= ERKStepSetMaxErrTestFails(arkode, 20);
  return bad;
}
