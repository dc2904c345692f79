/* fit_data.h -- data of a fit from a text file. */
#ifndef SCENE_FIT_DATA_H
#define SCENE_FIT_DATA_H

#include <pendres/fit.h>

#include "scenes/scene.h"

/* What a file holds: data for the library, and whether they have standard errors. */
typedef struct fit_data {
  pendres_fit_data of;
  pendres_fit_datum *datum; /* [of.n], in the run's room: a line's observables in their order */
  char path[DECK_PATH];
} fit_data;

/* Read the deck's file; what is wrong is the run's failure: file, line, and what to do. */
void fit_data_read(scene_run *run, fit_data *out);

#endif
