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

const char *pendres_method_name(pendres_method method)
{
  return (unsigned)method < PENDRES_METHOD_COUNT ? methods[method]->name : NULL;
}

pendres_method pendres_method_named(const char *name)
{
  int i = 0;
  if (name == NULL) return PENDRES_METHOD_COUNT;
  while (i < PENDRES_METHOD_COUNT && strcmp(name, methods[i]->name) != 0) i++;
  return (pendres_method)i;
}
