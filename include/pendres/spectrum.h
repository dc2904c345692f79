/**
 * @file spectrum.h
 * @brief Power spectrum of a long record, by Welch's method.
 *
 * Owns: a spectrum that is built up piece by piece, so that a record may be longer than memory.
 *
 * The record is divided into segments that overlap by half; each is multiplied by a Hann window and
 * transformed, and the squares are averaged. Spectral lines of a driven motion are sharp: each is
 * in one frequency bin and its two neighbours if a segment is a whole number of drive periods.
 * Chaos adds a broad background. For pendulums that turn over use the velocity, as the angle grows
 * without bound.
 *
 *     pendres_spectrum *s = NULL;
 *     if (pendres_spectrum_create(4096, interval, &s) == PENDRES_OK &&
 *         pendres_spectrum_add(s, n, v) == PENDRES_OK)
 *       pendres_spectrum_get(s, frequency, density, error);
 *     pendres_spectrum_free(s);
 *
 * Source: Welch, IEEE Transactions on Audio and Electroacoustics 15 (1967) 70. Thread safety: one
 * thread at a time for each spectrum.
 */
#ifndef PENDRES_SPECTRUM_H
#define PENDRES_SPECTRUM_H

#include <stddef.h>

#include <pendres/status.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

enum { PENDRES_SPECTRUM_LONGEST = 1 << 24 /**< samples of a segment at most */ };

/** Opaque: a spectrum that is being built up. */
typedef struct pendres_spectrum pendres_spectrum;

/**
 * Start a spectrum from segments with an even number of samples, at least 4, `interval` of time
 * apart. *out is to be freed by pendres_spectrum_free; NULL on failure. Errors:
 * PENDRES_INVALID_ARGUMENT, PENDRES_OUT_OF_MEMORY.
 */
pendres_status pendres_spectrum_create(size_t segment, double interval, pendres_spectrum **out);

/** Free a spectrum; NULL is allowed. */
void pendres_spectrum_free(pendres_spectrum *s);

/**
 * Add n more samples, in the order of time and in pieces of any length: the spectrum does not
 * depend on how the record is divided. Errors: PENDRES_INVALID_ARGUMENT (also if one is not a
 * number; nothing is added then), PENDRES_INTERNAL.
 */
pendres_status pendres_spectrum_add(pendres_spectrum *s, size_t n, const double *value);

/** Frequencies of the spectrum: half as many as samples of a segment, and one; 0 for NULL. */
size_t pendres_spectrum_count(const pendres_spectrum *s);

/**
 * The spectrum so far. frequency, density and error, each of pendres_spectrum_count() values or
 * NULL, receive angular frequencies from 0 to that of Nyquist; the mean square of the samples that
 * each unit of angular frequency holds (one-sided: the sum of all densities times the distance of
 * frequencies is the mean square, weighted by the squares of the windows); and its standard error
 * from the scatter of segments. Overlapping segments are slightly correlated, which the errors
 * allow for; lines that do not scatter are known to rounding. With one segment errors are infinite;
 * without any, all values are NaN. Errors: PENDRES_INVALID_ARGUMENT (s is NULL).
 */
pendres_status pendres_spectrum_get(const pendres_spectrum *s, double *frequency, double *density,
                                    double *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
