/*
 * definitions.c -- what variables of files are, by the library's table of quantities: units, words,
 * and the attribute `comment` that defines them. A laboratory's units are told in units.c.
 */
#include "scenes/scene.h"

#include <string.h>

const pendres_quantity *scene_quantity(scene_run *run, const char *name, const char *own)
{
  const pendres_quantity *q = pendres_quantity_of(name != NULL ? name : own);
  if (q == NULL && name != NULL)
    (void)scene_fail(run, PENDRES_INVALID_ARGUMENT, "'%s': there is no quantity '%s'", own, name);
  return q;
}

pendres_kind scene_define(const scene_run *run, const pendres_quantity *q, pendres_store_spec *spec,
                          char words[SCENE_WORDS])
{
  static const char of_angle[] = "the angle";
  const int angle = pendres_model_of(deck_pendulum(run->deck).force)->angle;
  const pendres_kind kind = q != NULL ? q->kind : PENDRES_KIND_NUMBER;
  const int own = q != NULL && (spec->group == NULL || spec->group[0] == '\0') &&
                  strcmp(q->name, spec->name) == 0;
  if (own && q->definition != NULL)
    spec->comment = angle || q->coordinate == NULL ? q->definition : q->coordinate;
  if (q != NULL && spec->long_name == NULL) spec->long_name = q->words;
  /* A phase is an angle whatever x is. */
  if (kind == PENDRES_KIND_PHASE || (kind == PENDRES_KIND_POSITION && angle)) spec->units = "rad";
  if (angle || spec->type != PENDRES_STORE_DOUBLE || spec->long_name == NULL) return kind;
  const char *at = strstr(spec->long_name, of_angle);
  if (at == NULL) return kind;
  snprintf(words, SCENE_WORDS, "%.*sx%s", (int)(at - spec->long_name), spec->long_name,
           at + sizeof of_angle - 1);
  spec->long_name = words;
  return kind;
}
