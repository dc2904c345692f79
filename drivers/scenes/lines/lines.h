/*
 * lines.h -- points over two parameters, line by line, with the branches that they lie on:
 * what phase_diagram and branches both compute, with pendres_phase_diagram.
 *
 * Owns: the deck's axes as the diagram's, its lines as tasks, which points failed, and what both
 * scenes write and print of the whole.
 */
#ifndef SCENE_LINES_H
#define SCENE_LINES_H

#include <pendres/phase_diagram.h>

#include "results/columns.h"
#include "scenes/points.h"

typedef struct scene_lines {
  scene_run *run;
  pendres_phase_grid grid;
  pendres_phase_diagram *diagram;
  scene_points points; /* [lines][values] of pendres_phase_point */
} scene_lines;

/* Compute the diagram, which is there if the run goes on. spacing: of the points of branches, see
   phase_diagram.h. Free l in any case. */
void scene_lines_compute(scene_run *run, double spacing, scene_lines *l);

void scene_lines_free(scene_lines *l);

/* Define the dimensions of the points, and write columns of pendres_phase_point, how many members
   are uncertain, and which points failed: `uncertain_members`, `failed`. */
void scene_lines_write(const scene_lines *l, size_t count, const scene_column *columns);

/* Print lines of the short table: the cusp, if there is one, and what branches do that their
   bifurcations do not explain, if there is anything. */
void scene_lines_print(const scene_lines *l, FILE *out);

/* Write `branch_doubts`: at how many points branches and bifurcations disagree. */
void scene_lines_write_doubts(const scene_lines *l);

/* The parameters of an orbit with their errors, by number: how rows of such
   tables begin. */
typedef struct scene_place {
  double value[PENDRES_PARAMETER_FOLLOWED], error[PENDRES_PARAMETER_FOLLOWED];
} scene_place;

/* error: of the parameter along the lines [0], and of the one across them [1]. */
scene_place scene_lines_place(const scene_lines *l, const pendres_pendulum *p,
                              const double error[2]);

/* Write a table whose rows begin with a scene_place: damping and drive frequency, the given
   columns, and the other parameters that are axes of the diagram. words (may be NULL) stand behind
   the long names of parameters. */
void scene_lines_write_places(const scene_lines *l, const scene_table *table, const char *words,
                              size_t count, const scene_column *columns);

/* The parameters of a point. */
pendres_pendulum scene_lines_pendulum(const scene_lines *l, size_t point);

/* Whether a parameter is one of the diagram's two. */
int scene_lines_changes(const scene_lines *l, pendres_parameter parameter);

/* curves.c: write the bifurcations of the diagram, dimensions `fold`, `flip` and `bifurcation` with
   their arrays, and the cusp; and what the paper prints of these, where the deck has it. */
void scene_curves_write(const scene_lines *l);
void scene_curves_write_paper(const scene_lines *l);

/* One line on what is computed, for --dry-run: axes and what is fixed. */
void scene_lines_describe(const deck *d, FILE *out);

#endif
