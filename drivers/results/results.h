/*
 * results.h -- what a run writes: variables and dimensions, by the library's table of quantities.
 *
 * Owns: where results go, what they are called in files and tables, and a laboratory's units.
 */
#ifndef RESULTS_H
#define RESULTS_H

#include "results/run.h"

/*
 * Where results go: into the store or, while a scene is computed for one value of an outer axis,
 * beside those of the others (stack.h). They are the functions of <pendres/store.h> of these names;
 * what fails is on record in the run.
 */
void results_dimension(scene_run *run, const pendres_store_spec *spec, uint64_t n,
                       const void *values);
void results_variable(scene_run *run, const pendres_store_spec *spec, int *id, int *error_id);
/* rows 0: all of the variable. */
void results_write(scene_run *run, int id, uint64_t first, uint64_t rows, const void *data,
                   size_t n);
void results_attribute(scene_run *run, const char *group, const char *object, const char *name,
                       const char *text);
void results_number(scene_run *run, const char *group, const char *object, const char *name,
                    double number);
int results_has(scene_run *run, const char *group, const char *name);

/* Write a variable, with its errors unless they are NULL, or a dimension of n values (NULL: numbers
   from 0 on); see pendres/store.h. Units, and words where the spec has none, are those of the
   quantity of its name, or of the one that is named. */
void scene_put(scene_run *run, const pendres_store_spec *spec, const void *values,
               const double *errors, size_t n);
void scene_put_as(scene_run *run, const char *quantity, const pendres_store_spec *spec,
                  const void *values, const double *errors, size_t n);
void scene_put_dimension(scene_run *run, const pendres_store_spec *spec, const void *values,
                         size_t n);
void scene_put_dimension_as(scene_run *run, const char *quantity, const pendres_store_spec *spec,
                            const void *values, size_t n);

/* An axis of the deck as a dimension of a group, with its usual name, words and units. */
void scene_dimension(scene_run *run, const char *group, deck_axis_id axis);

/* A dimension of the root that numbers things from 0 on. */
void scene_numbering(scene_run *run, const char *name, size_t n, const char *words);

/* Where a deck has &units: mark a variable that was just defined, and its errors if it has any,
   with the attributes si_factor and si_units, by its kind; one whose unit is another; and print
   short results in SI behind the table. */
void scene_mark_si(scene_run *run, const char *group, const char *name, const deck_si *si);
void scene_mark_units(scene_run *run, const pendres_store_spec *spec, pendres_kind kind,
                      int errors);
void scene_tell_units(scene_run *run);

/* The quantity of that name, which is on record as a failure if there is none; if no name is given
   (NULL), that of the variable's own, or NULL. */
const pendres_quantity *scene_quantity(scene_run *run, const char *name, const char *own);

/* Describe a variable as files do, by its quantity (NULL: a number), whose kind is returned: its
   units, its words where it gives none, its definition as its `comment` where it has the quantity's
   own name; and nothing is called an angle where x is none. words: room for its long_name. For what
   writes variables, as the functions above and columns do. */
enum { SCENE_WORDS = 300 };
pendres_kind scene_define(const scene_run *run, const pendres_quantity *q, pendres_store_spec *spec,
                          char words[SCENE_WORDS]);

/* A parameter's name in words, "drive amplitude", in `text`, which is returned; and in columns of
   tables, where the frequency is the drive's. */
const char *scene_spaced(pendres_parameter parameter, char text[DECK_NAME]);
const char *scene_column_name(pendres_parameter parameter);

/* What the values of an axis are, in words. */
const char *scene_axis_words(deck_axis_id axis);

/* What stands above the values of an axis in a short table, and their format. */
typedef struct scene_heading {
  char words[DECK_NAME], format[16];
} scene_heading;
scene_heading scene_heading_of(deck_axis_id axis);

/* The dimension of a parameter in scenes that call it by its short name. */
void scene_dimension_short(scene_run *run, deck_axis_id axis);

#endif
