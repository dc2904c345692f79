/* formula.c -- a force that is given as text; see table.h and <pendres/formula.h>. */
#include <pendres/formula.h>

#include "deck/table.h"

#include <string.h>

/* The words of a mistake, at its place in the value, where the text has quotes or not. */
static void complain(deck_builder *b, const namelist_value *v, const pendres_formula_error *e)
{
  const char quote = b->nl->text[v->begin];
  const int quoted = quote == '\'' || quote == '"';
  const namelist_place at = { v->at.line, v->at.column + quoted + e->at,
                              e->length > 0 ? e->length : 1 };
  if (e->instead[0] != '\0')
    namelist_error_at(b->nl, at, b->errors, "'formula': %s (did you mean '%s'?)", e->message,
                      e->instead);
  else
    namelist_error_at(b->nl, at, b->errors, "'formula': %s", e->message);
}

int deck_formula_read(deck_builder *b, const namelist_value *v, char *formula, size_t size)
{
  pendres_formula_error error;
  if (!namelist_value_string(b->nl, v, "formula", formula, size, b->errors)) return 0;
  const pendres_status status = pendres_force_define(formula, &b->formula, &error);
  if (status == PENDRES_INVALID_ARGUMENT) complain(b, v, &error);
  else if (status != PENDRES_OK) b->out_of_memory = 1;
  else (void)snprintf(formula, size, "%s", pendres_force_text(b->formula));
  return status == PENDRES_OK;
}

void deck_formula_find(deck_builder *b)
{
  deck *d = b->d;
  const deck_given *formula = deck_given_of(b, "pendulum", "formula");
  const deck_given *force = deck_given_of(b, "pendulum", "force");
  if (deck_is_there(formula) && !force->given && !force->broken)
    strcpy(d->force, "formula");
  const int wanted = strcmp(d->force, "formula") == 0;
  if (wanted && !deck_is_there(formula))
    deck_complain(b, force, "force",
                  "force 'formula' needs a 'formula', as in formula = 'x + x^3'");
  if (!wanted && deck_is_there(formula))
    deck_complain(b, formula, "formula", "'formula' goes with force = 'formula'");
  if (wanted && formula->given && !formula->broken) d->pendulum.force = b->formula;
}
