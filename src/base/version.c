/* version.c -- version of the library and of what it was built with; see version.h. */
#include <pendres/version.h>

#include <gsl/gsl_version.h>
#include <sundials/sundials_config.h>

#include <H5public.h> /* its version numbers alone */

#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)

#if defined(__clang__)
#define COMPILER "" /* its version string begins with its name */
#elif defined(__GNUC__)
#define COMPILER "gcc "
#else
#define COMPILER "compiler "
#define __VERSION__ "unknown"
#endif

const char *pendres_version(void)
{
  return PENDRES_VERSION;
}

const char *pendres_build_info(void)
{
  return "SUNDIALS " SUNDIALS_VERSION ", GSL " GSL_VERSION ", HDF5 " TEXT(H5_VERS_MAJOR) "." TEXT(
    H5_VERS_MINOR) "." TEXT(H5_VERS_RELEASE) ", " COMPILER __VERSION__;
}
