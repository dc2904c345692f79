/* check.c -- whether the points and the bifurcations of a branch agree; see branch.h. */
#include "continuation/branch.h"

#include <math.h>

#include "continuation/numbers.h"

/*
 * Along a branch the product (1 - m1)(1 - m2) of its multipliers changes its sign at folds and at
 * losses of mirror symmetry, (1 + m1)(1 + m2) at period doublings, and neither does anywhere else:
 * so an orbit cannot become stable or unstable otherwise. (Since the product of the multipliers is
 * below 1, a complex pair does not leave the unit circle.) At a fold the parameter turns, and it
 * turns nowhere else but where the branch was born from another, of half its map.
 */

/* A point that is no bifurcation. */
static int regular(const pendres_curve *b, size_t i)
{
  return b->branch_point[i].bifurcation < 0;
}

/* Sign of (s - m1)(s - m2), s = 1 or -1; 0 where the sign is not known: right at a bifurcation, or
   within the error. */
static int sign_of(const pendres_orbit *o, double s)
{
  if (fabs(o->multiplier_im[0]) > 0.0) return 1;
  const double first = s - o->multiplier_re[0], second = s - o->multiplier_re[1];
  const double least = curve_untold + pendres_several_errors * o->multiplier_error;
  if (!(fmin(fabs(first), fabs(second)) > least)) return 0;
  return (first > 0.0) == (second > 0.0) ? 1 : -1;
}

/* Whether a bifurcation is of the branch itself, not of the other that it was born from there. */
static int own(const pendres_curve *b, const pendres_bifurcation *f)
{
  if (f->kind == PENDRES_SYMMETRY_BREAKING) return b->kind.system.map.mirror;
  return f->orbit.period == b->kind.system.map.period;
}

/* Whether the sign changes at a bifurcation. At a cusp, a fold without curvature, it does not. */
static int changes(const pendres_curve *b, const pendres_bifurcation *f, double s)
{
  return own(b, f) && (f->kind == PENDRES_PERIOD_DOUBLING) == (s < 0.0) && f->curvature != 0.0;
}

/* From one point that tells to the next an odd number of bifurcations changes the sign. */
static void check_signs(pendres_curve *b, double s)
{
  const size_t round = pendres_curve_closed(b) ? 2 * b->count : b->count;
  size_t last = 0;
  int sign = 0, met = 0;
  for (size_t k = 0; k < round; k++) {
    const size_t i = k % b->count;
    if (!regular(b, i)) {
      met += changes(b, &b->bifurcation[b->branch_point[i].bifurcation], s);
      continue;
    }
    const int here = sign_of(&b->branch_point[i].orbit, s);
    if (here == 0) continue;
    if (sign != 0 && (here != sign) != (met % 2 != 0))
      b->branch_point[last].doubt |= PENDRES_DOUBT_SIGN;
    sign = here;
    met = 0;
    last = i;
    if (k >= b->count) break;
  }
}

/* ---- turns ---- */

/* Which way the parameter goes from point i to the next that differs in it by more than the errors,
   forwards or backwards, but not beyond a bifurcation; 0 if that does not tell. */
static int side_of(const pendres_curve *b, size_t i, int step)
{
  const double from = pendres_branch_value(b, i), error = b->branch_point[i].parameter_error;
  const int closed = pendres_curve_closed(b);
  size_t k = i;
  for (size_t n = 1; n < b->count; n++) {
    if (!closed && (step > 0 ? k + 1 == b->count : k == 0)) return 0;
    k = step > 0 ? (k + 1) % b->count : (k + b->count - 1) % b->count;
    const double apart = pendres_branch_value(b, k) - from;
    const double known = 2.0 * (error + b->branch_point[k].parameter_error);
    if (fabs(apart) > known) return apart > 0.0 ? 1 : -1;
    if (!regular(b, k)) return 0;
  }
  return 0;
}

static void check_turns(pendres_curve *b)
{
  for (size_t i = 0; i < b->count; i++) {
    const int before = side_of(b, i, -1), behind = side_of(b, i, 1);
    if (before == 0 || behind == 0) continue;
    const int turns = before == behind;
    if (regular(b, i)) {
      if (turns) b->branch_point[i].doubt |= PENDRES_DOUBT_TURN;
      continue;
    }
    const pendres_bifurcation *f = &b->bifurcation[b->branch_point[i].bifurcation];
    if (f->kind == PENDRES_FOLD && f->curvature != 0.0
          ? !turns || (f->curvature > 0.0) != (before > 0)
          : own(b, f) && turns)
      b->branch_point[i].doubt |= PENDRES_DOUBT_BIFURCATION;
  }
}

void pendres_branch_check(pendres_curve *b)
{
  for (size_t i = 0; i < b->count; i++) b->branch_point[i].doubt = 0;
  check_signs(b, 1.0);
  check_signs(b, -1.0);
  check_turns(b);
}
