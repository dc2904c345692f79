/* attractor_fixture.h -- what the tests of attractors share. */
#ifndef ATTRACTOR_FIXTURE_H
#define ATTRACTOR_FIXTURE_H

#include "context_fixture.h"

#include <stdlib.h>
#include <string.h>

#include <pendres/pendres.h>
#include "oracle/reference.h"

#include "golden.h"

static const double pi = 3.14159265358979323846;

enum { MEMBERS = 200 };

typedef struct ensemble {
  pendres_pendulum p[MEMBERS];
  double x[MEMBERS], v[MEMBERS];
  pendres_settled outcome[MEMBERS];
  pendres_attractors *set;
} ensemble;

/* The paper's ensemble, or any other row of starts at rest. */
static inline void settle_row(pendres_context *ctx, const pendres_pendulum *p, double first,
                              double last,
                              ensemble *e)
{
  for (int i = 0; i < MEMBERS; i++) {
    e->p[i] = *p;
    e->x[i] = first + (last - first) * ((double)(i + 1) / MEMBERS);
    e->v[i] = 0.0;
  }
  check_ok(pendres_settle(ctx, MEMBERS, e->p, e->x, e->v, e->outcome, &e->set));
}

static inline int count_label(const ensemble *e, pendres_label label)
{
  int n = 0;
  for (int i = 0; i < MEMBERS; i++) n += e->outcome[i].label == label;
  return n;
}

#endif
