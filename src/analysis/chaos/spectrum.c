/* spectrum.c -- power spectra of long records; see spectrum.h. */
#include <pendres/spectrum.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_fft_real.h>

#include "analysis/chaos/numbers.h"
#include "base/angles.h"
#include "base/student.h"

struct pendres_spectrum {
  size_t length;   /* of a segment */
  double interval;
  double weight;   /* sum of the squares of the window */
  double shared;   /* what the squares of two segments that overlap have in common, 0 to 1 */
  size_t segments;
  size_t filled;   /* samples that wait in `piece` */
  double *piece, *window, *transform;   /* [length] */
  double *mean, *square;                /* [length / 2 + 1]: of densities, and about their mean */
  gsl_fft_real_wavetable *table;
  gsl_fft_real_workspace *work;
};

size_t pendres_spectrum_count(const pendres_spectrum *s)
{
  return s != NULL ? s->length / 2 + 1 : 0;
}

void pendres_spectrum_free(pendres_spectrum *s)
{
  if (s == NULL) return;
  if (s->table != NULL) gsl_fft_real_wavetable_free(s->table);
  if (s->work != NULL) gsl_fft_real_workspace_free(s->work);
  free(s->piece);
  free(s);
}

static void open_window(pendres_spectrum *s)
{
  const size_t half = s->length / 2;
  double both = 0.0;
  for (size_t i = 0; i < s->length; i++) {
    const double sine = sin(0.5 * two_pi * (double)i / (double)s->length);
    s->window[i] = sine * sine;
    s->weight += s->window[i] * s->window[i];
  }
  for (size_t i = 0; i < half; i++) both += s->window[i] * s->window[i + half];
  s->shared = both / s->weight * (both / s->weight);
}

pendres_status pendres_spectrum_create(size_t segment, double interval, pendres_spectrum **out)
{
  if (out == NULL) return PENDRES_INVALID_ARGUMENT;
  *out = NULL;
  if (segment < 4 || segment > PENDRES_SPECTRUM_LONGEST || segment % 2 != 0 ||
      !(interval > 0.0) || !isfinite(interval))
    return PENDRES_INVALID_ARGUMENT;
  const size_t lines = segment / 2 + 1;
  pendres_spectrum *s = calloc(1, sizeof *s);
  if (s == NULL) return PENDRES_OUT_OF_MEMORY;
  s->length = segment;
  s->interval = interval;
  s->piece = calloc(3 * segment + 2 * lines, sizeof *s->piece);
  if (s->piece != NULL) s->table = gsl_fft_real_wavetable_alloc(segment);
  if (s->table != NULL) s->work = gsl_fft_real_workspace_alloc(segment);
  if (s->work == NULL) {
    pendres_spectrum_free(s);
    return PENDRES_OUT_OF_MEMORY;
  }
  s->window = s->piece + segment;
  s->transform = s->window + segment;
  s->mean = s->transform + segment;
  s->square = s->mean + lines;
  open_window(s);
  *out = s;
  return PENDRES_OK;
}

/* The piece is full: its spectrum enters the means, and its second half begins the next. */
static pendres_status take_segment(pendres_spectrum *s)
{
  const size_t n = s->length, half = n / 2;
  double *t = s->transform;
  for (size_t i = 0; i < n; i++) t[i] = s->window[i] * s->piece[i];
  if (gsl_fft_real_transform(t, 1, n, s->table, s->work) != GSL_SUCCESS) return PENDRES_INTERNAL;
  s->segments++;
  for (size_t k = 0; k <= half; k++) {
    /* GSL's order: 0, then real and imaginary parts, the last real one alone. */
    const int single = k == 0 || k == half;
    const double re = t[k == 0 ? 0 : 2 * k - 1], im = single ? 0.0 : t[2 * k];
    const double density =
      (single ? 1.0 : 2.0) * (re * re + im * im) * s->interval / (two_pi * s->weight);
    const double off = density - s->mean[k];
    s->mean[k] += off / (double)s->segments;
    s->square[k] += off * (density - s->mean[k]);
  }
  memmove(s->piece, s->piece + half, half * sizeof *s->piece);
  s->filled = half;
  return PENDRES_OK;
}

pendres_status pendres_spectrum_add(pendres_spectrum *s, size_t n, const double *value)
{
  pendres_status status = PENDRES_OK;
  if (s == NULL || (n > 0 && value == NULL)) return PENDRES_INVALID_ARGUMENT;
  for (size_t i = 0; i < n; i++)
    if (!isfinite(value[i])) return PENDRES_INVALID_ARGUMENT;
  for (size_t i = 0; i < n && status == PENDRES_OK;) {
    const size_t room = s->length - s->filled, some = n - i < room ? n - i : room;
    memcpy(s->piece + s->filled, value + i, some * sizeof *value);
    s->filled += some;
    i += some;
    if (s->filled == s->length) status = take_segment(s);
  }
  return status;
}

/* The standard errors of means, and rounding, which counts most far below the highest line. */
static void errors(const pendres_spectrum *s, double *error)
{
  const double k = (double)s->segments;
  const double wider = k > 1.0 ? pendres_student(PENDRES_ONE_SIGMA, k - 1.0) : NAN;
  const double overlap = 1.0 + 2.0 * s->shared * (k - 1.0) / k;
  double peak = 0.0;
  for (size_t i = 0; i < pendres_spectrum_count(s); i++) peak = fmax(peak, s->mean[i]);
  const double least = spectrum_rounding * sqrt(peak);
  for (size_t i = 0; i < pendres_spectrum_count(s); i++) {
    const double scatter = sqrt(s->square[i] / (k - 1.0) / k * overlap);
    error[i] = k > 1.0 ? wider * scatter + least * (2.0 * sqrt(s->mean[i]) + least) : INFINITY;
  }
}

pendres_status pendres_spectrum_get(const pendres_spectrum *s, double *frequency, double *density,
                                    double *error)
{
  if (s == NULL) return PENDRES_INVALID_ARGUMENT;
  const size_t n = pendres_spectrum_count(s);
  for (size_t k = 0; k < n; k++) {
    if (frequency != NULL)
      frequency[k] = two_pi * (double)k / ((double)s->length * s->interval);
    if (density != NULL) density[k] = s->segments > 0 ? s->mean[k] : NAN;
    if (error != NULL) error[k] = NAN;
  }
  if (error != NULL && s->segments > 0) errors(s, error);
  return PENDRES_OK;
}
