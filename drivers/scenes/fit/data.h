/* data.h -- what the parts of the scene fit share: its data, their units, and its results. */
#ifndef SCENE_FIT_DATA_H
#define SCENE_FIT_DATA_H

#include <string.h>

#include <pendres/fit.h>
#include <pendres/names.h>

#include "scenes/scene.h"

/* What a file holds: data for the library, and whether they have standard errors. */
typedef struct fit_data {
  pendres_fit_data of;
  pendres_fit_datum *datum; /* [of.n], in the run's room: a line's observables in their order */
  size_t *line;             /* [of.n] from where they are */
  char path[DECK_PATH];
  double axis_factor; /* SI of one of the axis in the file, where that tells its unit */
} fit_data;

enum { FIT_MOST = PENDRES_FIT_QUANTITY_COUNT };

typedef struct fit_work {
  scene_run *run;
  const deck *d;
  fit_data data;
  pendres_pendulum model;
  size_t n, free; /* unknowns, of which the first ones are free */
  pendres_fit_unknown unknown[FIT_MOST];
  pendres_fit *fit;
} fit_work;

/* Read the deck's file; what is wrong is the run's failure: file, line, and what to do. */
void fit_data_read(scene_run *run, fit_data *out);

/* Whether the data are over time. */
static inline int fit_is_decay(const deck *d)
{
  return strcmp(d->data.axis, "time") == 0;
}

/* Whether they are mean velocities, of rest and rotations without a drive. */
static inline int fit_is_rotation(const deck *d)
{
  return d->data.observables.count > 0 &&
         strcmp(d->data.observables.name[0], "mean_velocity") == 0;
}

/* The parameter that was swept; PENDRES_PARAMETER_COUNT: time. */
static inline pendres_parameter fit_axis(const deck *d)
{
  if (fit_is_decay(d)) return PENDRES_PARAMETER_COUNT;
  return (pendres_parameter)pendres_name_find(PENDRES_NAMES_PARAMETER, d->data.axis);
}

/* Whether an observable is a value of the axis itself. */
static inline int fit_is_place(pendres_fit_observable o)
{
  return o == PENDRES_FIT_JUMP || o == PENDRES_FIT_RESONANCE;
}

/* Whether they are scattering parameters. */
static inline int fit_is_line(const deck *d)
{
  return d->fit.model[0] != '\0';
}

/* Standard error of unknown number i. */
double fit_error(const fit_work *w, size_t i);

/* Bring data from SI into the model's units, where &units tell these. */
void fit_units_take(fit_work *w);
/* What makes SI of a parameter of the data, the axis or the other one, or of their time; and of an
   observable; 0: &units do not tell. */
int fit_units_of_data(const deck *d, pendres_parameter p, deck_si *out);
int fit_units_of_observable(const deck *d, pendres_fit_observable o, deck_si *out);
/* Mark what the file holds in units of the data. */
void fit_units_mark(const fit_work *w);

/* Write the results. */
void fit_write(const fit_work *w);

#endif
