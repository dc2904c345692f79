/**
 * @file version.h
 * @brief The version of the library, at compile time and at run time.
 */
#ifndef PENDRES_VERSION_H
#define PENDRES_VERSION_H

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/** Grows when the interface breaks; the number in the soname. See pendres.h. */
#define PENDRES_VERSION_MAJOR 1
/** Grows when something is added. */
#define PENDRES_VERSION_MINOR 0
/** Grows when something is mended and nothing is added. */
#define PENDRES_VERSION_PATCH 0
/** Version of the headers, "MAJOR.MINOR.PATCH". */
#define PENDRES_VERSION "1.0.0"

/** Version of the library that was linked, "MAJOR.MINOR.PATCH". Static string. */
const char *pendres_version(void);

/** Versions of SUNDIALS, GSL and HDF5 in use and of the compiler, one line. Static string. */
const char *pendres_build_info(void);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
