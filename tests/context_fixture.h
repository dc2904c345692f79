/* context_fixture.h -- a context for each test; setup() and teardown() make it and take it back. */
#ifndef CONTEXT_FIXTURE_H
#define CONTEXT_FIXTURE_H

#include "check.h"

#include <pendres/context.h>

static inline pendres_context *context_with(const pendres_options *o)
{
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(o, &ctx));
  return ctx;
}

static inline int setup(void **state)
{
  *state = context_with(NULL);
  return 0;
}

static inline int teardown(void **state)
{
  pendres_context_free(*state);
  return 0;
}

#endif
