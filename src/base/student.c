/* student.c -- errors from the scatter of a few values; see student.h. */
#include "base/student.h"

#include <math.h>

#include <gsl/gsl_cdf.h>

double pendres_student(double share, double freedom)
{
  return gsl_cdf_tdist_Pinv(0.5 * (1.0 + share), fmax(freedom, 1.0));
}
