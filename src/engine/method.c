/* method.c -- methods by value and by name; see method.h. */
#include "engine/method.h"

#include <string.h>

#include "engine/context_internal.h"

#define PLACE(value, name) [value] = &pendres_method_##name,
static const pendres_method_functions *const methods[PENDRES_METHOD_COUNT] = {
  PENDRES_METHODS(PLACE)};
#undef PLACE

const pendres_method_functions *pendres_method_of(const pendres_context *ctx)
{
  return methods[ctx->options.method];
}

