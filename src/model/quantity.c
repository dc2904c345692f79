/* quantity.c -- the tables of kinds and of quantities; see <pendres/quantity.h>. */
#include <pendres/quantity.h>

#include <string.h>

#include <pendres/parameter.h>

static const pendres_kind_info kinds[PENDRES_KIND_COUNT] = {
#define KIND(code, length, time, unit) {unit, length, time},
  PENDRES_KIND_LIST(KIND)
};

/* Parameters that are results as well, x, v and the temperature, have their rows in the list. */
static const pendres_quantity table[] = {
#define QUANTITY(name, kind, words, definition, coordinate) \
  {#name, words, definition, coordinate, PENDRES_KIND_##kind},
#include "model/quantity_list.h"
#define PARAMETER(code, number, name, field, over, positive, kind, words, brief) \
  {name, brief, NULL, NULL, PENDRES_KIND_##kind},
  PENDRES_PARAMETERS_PLAIN(PARAMETER) PENDRES_PARAMETERS_OTHER(PARAMETER)
};
enum { ROWS = sizeof table / sizeof *table };

const pendres_kind_info *pendres_kind_of(pendres_kind kind)
{
  return (unsigned)kind < PENDRES_KIND_COUNT ? &kinds[kind] : NULL;
}

const pendres_quantity *pendres_quantity_get(size_t number)
{
  return number < ROWS ? &table[number] : NULL;
}

const pendres_quantity *pendres_quantity_of(const char *name)
{
  for (size_t i = 0; name != NULL && i < ROWS; i++)
    if (strcmp(table[i].name, name) == 0) return &table[i];
  return NULL;
}
