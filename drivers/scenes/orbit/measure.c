/*
 * measure.c -- what the scene `orbit` measures of a whole record while it goes by:
 * dimensions of a chaotic attractor and the power spectrum.
 */
#include <math.h>

#include "results/columns.h"
#include "scenes/numbers.h"
#include "scenes/orbit/orbit.h"

/* Drive periods of a segment: what the deck says, as far as the record goes. */
static long segment_of(const deck *d)
{
  const long all = (long)d->orbit.periods, samples = (long)d->orbit.samples;
  const long longest = PENDRES_SPECTRUM_LONGEST / samples;
  long segment = (long)d->orbit.segment;
  if (segment == 0)
    for (segment = 1; 2 * segment * ORBIT_SEGMENTS <= all; segment *= 2) continue;
  segment = segment < deck_spectrum_least(d) ? (long)deck_spectrum_least(d) : segment;
  if (segment > all) segment = all;
  if (segment > longest) segment = longest;
  return segment - (segment * samples % 2);
}

void scene_orbit_measure_begin(orbit_work *w)
{
  orbit_measures *m = &w->measures;
  const deck *d = w->d;
  if (!scene_going(w->run)) return;
  if (d->orbit.spectrum && (w->transient || w->found.of.label != PENDRES_LABEL_UNRESOLVED)) {
    const size_t length = (size_t)segment_of(d) * (size_t)d->orbit.samples;
    const double interval =
      2.0 * PENDRES_PI / (w->pendulum.drive_frequency * (double)d->orbit.samples);
    const pendres_status status = pendres_spectrum_create(length, interval, &m->spectrum);
    if (status != PENDRES_OK)
      scene_fail(w->run, status, "no spectrum of segments of %zu samples: 4 or more, an even "
                 "number, and what memory has room for", length);
  }
  if (d->orbit.dimension && w->found.of.label == PENDRES_LABEL_CHAOTIC) {
    m->room = d->orbit.periods < ORBIT_POINTS ? (size_t)d->orbit.periods : ORBIT_POINTS;
    m->stride = ((long)d->orbit.periods + ORBIT_POINTS - 1) / ORBIT_POINTS;
    m->x = scene_array(w->run, 2 * m->room, sizeof *m->x);
    if (m->x != NULL) m->v = m->x + m->room;
  }
}

void scene_orbit_measure_add(orbit_work *w, long first, long periods, const double *samples)
{
  orbit_measures *m = &w->measures;
  const size_t each = (size_t)w->d->orbit.samples;
  const double *x = samples, *v = samples + w->room;
  for (long k = 0; k < periods && m->x != NULL; k++) {
    const long period = first + k;
    if (period % m->stride != 0 || (w->transient && period < ORBIT_SETTLING)) continue;
    m->x[m->points] = x[(size_t)k * each];
    m->v[m->points++] = v[(size_t)k * each];
  }
  if (m->spectrum == NULL) return;
  const pendres_status status =
    pendres_spectrum_add(m->spectrum, (size_t)periods * each, v);
  if (status != PENDRES_OK) scene_fail(w->run, status, "the spectrum cannot be measured");
}

void scene_orbit_measure_free(orbit_work *w)
{
  pendres_spectrum_free(w->measures.spectrum);
}

/* The correlation dimension of strobe points; that of closed orbits, which are points, is 0. */
static void measure_correlation(orbit_work *w)
{
  orbit_measures *m = &w->measures;
  pendres_correlation *c = &m->correlation;
  pendres_context *ctx = scene_context(w->run);
  *c = (pendres_correlation){ .dimension = NAN, .dimension_error = NAN };
  if (w->found.closed) c->dimension = c->dimension_error = 0.0;
  if (m->points < 2 || ctx == NULL) return;
  /* Distances are of x and of v times the unit of time. */
  const double time = pendres_units_of(&w->pendulum).time;
  for (size_t k = 0; k < m->points; k++) m->v[k] *= time;
  const pendres_section section = { m->points, m->x, m->v,
                                    pendres_model_of(w->pendulum.force)->period };
  scene_asked(w->run, pendres_correlation_find(ctx, &section,
                                               ORBIT_RESOLUTION * w->d->precision.tolerance, c));
}

typedef struct dimensions {
  double lyapunov_dimension, lyapunov_dimension_error;
  double correlation_dimension, correlation_dimension_error;
} dimensions;

static const scene_column of_dimensions[] = {
  SCENE_COLUMN(dimensions, lyapunov_dimension, NULL),
  SCENE_COLUMN(dimensions, correlation_dimension, NULL),
};

/* What stands at each distance, or at each frequency. */
typedef struct row {
  double value, error;
} row;

static const scene_column of_distances[] = {
  {.name = "correlation_sum", .long_name = "share of pairs of strobe points that are closer",
   .value = offsetof(row, value), .error = offsetof(row, error)},
};
static const scene_column of_frequencies[] = {
  {.name = "power_spectrum",
   .value = offsetof(row, value), .error = offsetof(row, error)},
};

/* A result over a dimension of its own. */
static void put_over(scene_run *run, const scene_table *table, const char *words, const double *at,
                     const scene_column *column)
{
  const pendres_store_spec spec = {.name = table->dimensions[0], .long_name = words};
  scene_put_dimension(run, &spec, at, table->n);
  scene_columns_write(run, table, 1, column);
}

static void put_dimensions(orbit_work *w)
{
  const pendres_correlation *c = &w->measures.correlation;
  row rows[PENDRES_CORRELATION_SCALES];
  dimensions d = {.lyapunov_dimension_error = NAN};
  measure_correlation(w);
  d.lyapunov_dimension = pendres_lyapunov_dimension(
    &w->pendulum, w->found.of.lyapunov, w->found.of.lyapunov_error, &d.lyapunov_dimension_error);
  d.correlation_dimension = c->dimension;
  d.correlation_dimension_error = c->dimension_error;
  const scene_table table = {SCENE_ROWS(&d, 1)};
  SCENE_WRITE(w->run, &table, of_dimensions);
  if (c->scales == 0) return;
  for (int k = 0; k < c->scales; k++) rows[k] = (row){c->sum[k], c->sum_error[k]};
  const scene_table scales = {.dimensions = {"distance"}, SCENE_ROWS(rows, (size_t)c->scales)};
  put_over(w->run, &scales, "distance of strobe points", c->distance, of_distances);
}

static void put_spectrum(orbit_work *w)
{
  const pendres_spectrum *s = w->measures.spectrum;
  const size_t n = pendres_spectrum_count(s);
  double *frequency = scene_array(w->run, 3 * n, sizeof *frequency);
  row *rows = scene_array(w->run, n, sizeof *rows);
  const scene_table table = {.dimensions = {"frequency"}, SCENE_ROWS(rows, n)};
  if (rows == NULL) return;
  const pendres_status status =
    pendres_spectrum_get(s, frequency, frequency + n, frequency + 2 * n);
  if (status != PENDRES_OK) scene_fail(w->run, status, "%s", pendres_status_message(status));
  for (size_t k = 0; k < n; k++) rows[k] = (row){frequency[n + k], frequency[2 * n + k]};
  put_over(w->run, &table, "angular frequency", frequency, of_frequencies);
}

void scene_orbit_measure_put(orbit_work *w)
{
  if (!scene_going(w->run)) return;
  if (w->d->orbit.dimension) put_dimensions(w);
  if (w->measures.spectrum != NULL) put_spectrum(w);
}
