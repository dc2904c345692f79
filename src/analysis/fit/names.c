/* names.c -- names of observables and quantities: apart from the model, so that what reads decks
   can be linked without it. */
#include "analysis/fit/internal.h"

static const char *const observables[] = {
#define OBSERVABLE_NAME(code, name) name,
  PENDRES_FIT_OBSERVABLE_LIST(OBSERVABLE_NAME)
#undef OBSERVABLE_NAME
};

static const char *const scales[] = {
#define SCALE_NAME(code, name, neutral) name,
  PENDRES_FIT_SCALE_LIST(SCALE_NAME)
#undef SCALE_NAME
};

const char *pendres_fit_observable_name(int observable)
{
  return observable >= 0 && observable < FIT_BASES ? observables[observable] : NULL;
}

const char *pendres_fit_quantity_name(int quantity)
{
  if (quantity < 0 || quantity >= FIT_QUANTITIES) return NULL;
  return quantity < PENDRES_PARAMETER_FOLLOWED
           ? pendres_parameter_of((pendres_parameter)quantity)->name
           : scales[quantity - PENDRES_PARAMETER_FOLLOWED];
}
