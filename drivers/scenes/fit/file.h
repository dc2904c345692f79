/* file.h -- files of measured data, as texts that are tables. */
#ifndef SCENE_FIT_FILE_H
#define SCENE_FIT_FILE_H

#include "scenes/scene.h"

typedef struct fit_file {
  char path[DECK_PATH];
  char *text; /* to be freed; NULL: the run has failed */
  size_t length;
  size_t *lines; /* to be freed: in the file, of each line of the text; NULL: they are the same */
} fit_file;

/* Read the deck's file, from the deck's folder on: of results their variables, of network
   parameters their matrices. What is wrong is the run's failure. */
void fit_file_read(scene_run *run, fit_file *out);

/* ---- store.c ---- */

/* The variables of a file of results, open as `fd`, that a fit may need, as lines of text with a
   line of names, to be freed. It is read apart, since a damaged one may crash its reader. Returns
   as bytes_text() does; NULL with PENDRES_OK: the run has failed, and why is on record. */
pendres_status fit_store_text(scene_run *run, const char *path, int fd, char **text,
                              size_t *length);

/* ---- touchstone.c ---- */

/* Whether a file is one of network parameters, by its name or its first line. */
int fit_is_touchstone(const char *path, const char *text);

/* Make a table of its text. */
void fit_touchstone(scene_run *run, fit_file *file);

#endif
