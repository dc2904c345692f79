/* refused_fixture.h -- calls that a context must refuse. */
#ifndef REFUSED_FIXTURE_H
#define REFUSED_FIXTURE_H

#include "check.h"

#include <string.h>

#include <pendres/context.h>
#include <pendres/status.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

/* A failure with a sentence of its own. */
#define REFUSED(call)                                                  \
  do {                                                                 \
    assert_int_equal((call), PENDRES_INVALID_ARGUMENT);                \
    const char *said = pendres_context_message(ctx);                   \
    assert_true(strlen(said) >= 8);                                    \
    assert_string_not_equal(said, pendres_status_message(PENDRES_INVALID_ARGUMENT)); \
  } while (0)

#endif
