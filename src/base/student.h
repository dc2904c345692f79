/*
 * student.h -- errors from the scatter of a few values.
 *
 * Owns: the factor by which an error grows because the scatter from which it is estimated is itself
 * uncertain.
 */
#ifndef PENDRES_STUDENT_H
#define PENDRES_STUDENT_H

/* Share of a Gaussian within one standard deviation of its mean: that of a standard error. */
#define PENDRES_ONE_SIGMA 0.68268949213708585

/*
 * Half the width, in naive standard errors, of the interval around a mean that holds the true
 * value with probability `share` (0 to 1), where the scatter has `freedom` degrees of freedom
 * (taken as 1 if fewer): the quantile of Student's t distribution. For one standard error it is
 * 1.84 from two independent values, 1.06 from ten.
 */
double pendres_student(double share, double freedom);

#endif
