/*
 * results.c -- what variables of files are, by the library's table of quantities: units, words, and
 * the attribute `comment` that defines them; dimensions of axes. A laboratory's units are told in
 * units.c. See results.h.
 */
#include "results/results.h"

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

/* ---- variables and dimensions --------------------------------------------------------------- */

void scene_put_as(scene_run *run, const char *quantity, const pendres_store_spec *spec,
                  const void *values, const double *errors, size_t n)
{
  char words[SCENE_WORDS];
  pendres_store_spec defined = *spec;
  const pendres_kind kind = scene_define(run, scene_quantity(run, quantity, spec->name),
                                         &defined, words);
  int id = -1, error_id = -1;
  results_variable(run, &defined, &id, errors != NULL ? &error_id : NULL);
  results_write(run, id, 0, 0, values, n);
  if (errors != NULL) results_write(run, error_id, 0, 0, errors, n);
  scene_mark_units(run, &defined, kind, errors != NULL);
}

void scene_put(scene_run *run, const pendres_store_spec *spec, const void *values,
               const double *errors, size_t n)
{
  scene_put_as(run, NULL, spec, values, errors, n);
}

void scene_put_dimension_as(scene_run *run, const char *quantity, const pendres_store_spec *spec,
                            const void *values, size_t n)
{
  char words[SCENE_WORDS];
  pendres_store_spec defined = *spec;
  const pendres_kind kind = scene_define(run, scene_quantity(run, quantity, spec->name),
                                         &defined, words);
  if (!scene_going(run)) return;
  results_dimension(run, &defined, n, values);
  if (defined.comment != NULL)
    results_attribute(run, spec->group, spec->name, "comment", defined.comment);
  scene_mark_units(run, &defined, kind, 0);
}

void scene_put_dimension(scene_run *run, const pendres_store_spec *spec, const void *values,
                         size_t n)
{
  scene_put_dimension_as(run, NULL, spec, values, n);
}

/* ---- axes ----------------------------------------------------------------------------------- */

const char *scene_spaced(pendres_parameter parameter, char text[DECK_NAME])
{
  (void)snprintf(text, DECK_NAME, "%s", pendres_parameter_of(parameter)->name);
  for (char *c = text; *c != '\0'; c++)
    if (*c == '_') *c = ' ';
  return text;
}

const char *scene_column_name(pendres_parameter parameter)
{
  return parameter == PENDRES_DRIVE_FREQUENCY ? "frequency" : pendres_parameter_of(parameter)->name;
}

scene_heading scene_heading_of(deck_axis_id axis)
{
  enum { WIDTH = 9 };
  scene_heading h = { .words = "" };
  const char *name = deck_axis_name(axis);
  const size_t n = strlen(name), width = n > WIDTH ? n : WIDTH;
  memset(h.words, ' ', width + 1);
  memcpy(h.words, name, n);
  (void)snprintf(h.format, sizeof h.format, "%%-%d.4g ", (int)width);
  return h;
}

const char *scene_axis_words(deck_axis_id axis)
{
  const pendres_parameter_info *info = pendres_parameter_of(deck_axis_parameter(axis));
  if (info != NULL) return info->words;
  return axis == DECK_AXIS_AMPLITUDE ? "amplitude of the angle" : "tolerance asked for";
}

static void write_dimension(scene_run *run, const char *group, deck_axis_id axis,
                            const char *words)
{
  const deck_axis *a = &run->deck->axis[axis];
  scene_put_dimension(
    run, &(pendres_store_spec){.group = group, .name = deck_axis_name(axis), .long_name = words},
    a->value, a->count);
}

void scene_dimension(scene_run *run, const char *group, deck_axis_id axis)
{
  write_dimension(run, group, axis, scene_axis_words(axis));
}

void scene_dimension_short(scene_run *run, deck_axis_id axis)
{
  /* A short name says too little of a parameter that a plain pendulum does not have. */
  const pendres_parameter parameter = deck_axis_parameter(axis);
  char text[DECK_NAME];
  write_dimension(run, "", axis, pendres_parameter_of(parameter)->plain
                                          ? scene_spaced(parameter, text)
                                          : scene_axis_words(axis));
}

void scene_numbering(scene_run *run, const char *name, size_t n, const char *words)
{
  scene_put_dimension(run, &(pendres_store_spec){.name = name, .long_name = words}, NULL, n);
}
