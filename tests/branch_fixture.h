/* branch_fixture.h -- what tests of branches look for on them. */
#ifndef PENDRES_TESTS_BRANCH_FIXTURE_H
#define PENDRES_TESTS_BRANCH_FIXTURE_H

#include <stddef.h>

#include <pendres/continuation.h>

#include "check.h"

/* The only bifurcation of a kind on a branch; NULL: there is none. */
static inline const pendres_bifurcation *only(const pendres_branch *b, pendres_special kind)
{
  const pendres_bifurcation *found = NULL;
  for (size_t i = 0; i < pendres_branch_bifurcation_count(b); i++) {
    const pendres_bifurcation *f = pendres_branch_bifurcation_get(b, i);
    if (f->kind != kind) continue;
    assert_null(found);
    found = f;
  }
  return found;
}

#endif
