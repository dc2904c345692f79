/* block_float.c -- the steps of a period in single precision; see block_internal.h. */
#include "engine/block_internal.h"

#include <math.h>

#include "base/angles.h"
#include "base/grow.h"
#include "engine/tables.h"

static void add_term(pendres_float_sum *q, int stage, double coefficient)
{
  if (coefficient == 0.0) return;
  q->term[q->terms].stage = stage;
  q->term[q->terms++].c = (float)coefficient;
}

int pendres_block_float_prepare(pendres_float_steps *s, int steps)
{
  const pendres_tables_method *m = pendres_tables_get(pendres_tables_float);
  int stages = m->stages;
  if (s->steps == steps) return 0;
  while (m->b[stages - 1] == 0.0) stages--;
  s->steps = 0;
  if (!pendres_regrow(&s->cosine, (size_t)steps * (size_t)stages, sizeof *s->cosine)) return -1;
  const double step = two_pi / steps;
  for (int i = 0; i <= stages; i++) s->sum[i].terms = 0;
  for (int k = 0; k < m->entries; k++)
    if (m->a[k].row < stages)
      add_term(&s->sum[m->a[k].row], m->a[k].column, step * m->a[k].value);
  for (int i = 0; i < stages; i++) add_term(&s->sum[stages], i, step * m->b[i]);
  float *cosine = s->cosine;
  for (int k = 0; k < steps; k++)
    for (int i = 0; i < stages; i++) *cosine++ = (float)cos(step * (k + m->c[i]));
  s->steps = steps;
  s->stages = stages;
  s->step = (float)step;
  return 0;
}
