/*
 * peak.h -- a resonance as a row of results.
 *
 * Owns: what scenes write and print of a resonance, with errors; NaN where there is none.
 */
#ifndef SCENE_PEAK_H
#define SCENE_PEAK_H

#include "results/columns.h"

typedef struct scene_peak {
  double at;     /* the line's parameter, */
  double beside; /* and another one, where lines differ in two */
  double resonance_frequency, resonance_frequency_error, resonance_period, resonance_period_error;
  double mean_loop_area, mean_loop_area_error, mean_loop_amplitude, mean_loop_amplitude_error;
  double mean_amplitude, mean_amplitude_error, phase_lag, phase_lag_error;
  double mean_power, mean_power_error, sa_fraction, sa_fraction_error;
  double free_frequency, free_frequency_error; /* of the free pendulum of that loop amplitude */
  double fold_frequency, fold_frequency_error;
  size_t uncertain;
  int kind; /* a pendres_peak; PENDRES_PEAK_COUNT: none */
  pendres_status outcome;
} scene_peak;

/* What a search came to, into a row whose columns are blank; r is not looked at without a
   resonance. */
void scene_peak_set(scene_peak *p, double at, pendres_status outcome, const pendres_resonance *r);

/*
 * The resonant periods that the paper prints, beside those of the rows: how many of them. Its
 * captions of Figs. 3 and 4 have them, at F0 = 0.2; none where the rows are not over damping.
 */
enum { SCENE_PRINTED_PERIODS = 4 };
size_t scene_peak_printed(const deck *d, size_t n, const scene_peak *rows,
                          scene_printed values[SCENE_PRINTED_PERIODS]);

/* The names of kinds, and "none". */
const char *scene_peak_names(int kind);

/* What a table says of a row without a resonance; NULL: it has one. */
const char *scene_peak_instead(const void *row);

#endif
