/*
 * course.h -- what branches and curves have in common: a trail with the special points
 * that lie on it, bifurcations of a branch or cusps of a curve.
 *
 * Owns: following the trails of one call, locating what zeros of test functions stand for, and
 * measuring all points and putting them in order.
 */
#ifndef PENDRES_CONTINUATION_COURSE_H
#define PENDRES_CONTINUATION_COURSE_H

#include "continuation/locate.h"
#include "continuation/trail.h"

/* A bifurcation or a cusp, and where on the trail it lies. */
typedef struct pendres_course_special {
  pendres_trail_zero at;
  pendres_continuation_condition condition;
  pendres_located located;
} pendres_course_special;

/* A point of a course: one of the trail, or a special one that follows upon it. */
typedef struct pendres_course_point {
  size_t i;         /* number of the trail's point */
  int special;      /* number of the special point, -1: none */
  double arclength; /* from the trail's first point */
} pendres_course_point;

typedef struct pendres_course {
  const pendres_trail *trail;
  size_t specials, room;
  pendres_course_special *special;
  /* For each point of the trail: what it was corrected to, its orbit, and the errors of its
     parameters. */
  pendres_continuation_pair *pair;
  pendres_orbit *orbit;
  double (*error)[2];
  size_t count; /* of all points, in order */
  pendres_course_point *point;
} pendres_course;

/* An empty course along a trail, which is kept and must not change, with room for `room` special
   points. To be freed whether this succeeds or not. */
pendres_status pendres_course_begin(pendres_context *ctx, const pendres_trail *trail, size_t room,
                                    pendres_course *course);
void pendres_course_free(pendres_course *course);

/*
 * A way to locate what a zero of a test function stands for, near u: `out` has its place already.
 * PENDRES_NOT_CONVERGED: it was no zero.
 */
typedef pendres_status pendres_course_locator(pendres_context *ctx, const pendres_trail *trail,
                                              const double u[PENDRES_U_COUNT], double reach,
                                              pendres_course_special *out);

/* Locate n zeros, and add what is there to the special points: each once. */
pendres_status pendres_course_locate(pendres_context *ctx, pendres_course_locator *locate,
                                     size_t n, const pendres_trail_zero *zeros,
                                     pendres_course *course);

/* Put the special points in order, measure the trail's points, and list all of them. */
pendres_status pendres_course_measure(pendres_context *ctx, pendres_course *course);

/*
 * The same for a branch that is only to lead on: its points are left where the arc found them, with
 * errors of the arc's tolerance, but for those next to special points. Of an orbit there are the
 * state, period, winding, multipliers and stability, which agree with the signs of test functions;
 * measures and errors are NaN.
 */
pendres_status pendres_course_outline(pendres_context *ctx, pendres_course *course);

/* What one kind of course, branches or curves, does in its own way; `call` is the caller's. */
typedef struct pendres_course_kind {
  const char *name;  /* "branches" */
  const char *start; /* what a start must be: "orbit" */
  void (*begin)(const void *call, size_t i, pendres_trail_start *start);
  pendres_status (*build)(pendres_context *ctx, void *call, size_t i, pendres_trail *trail);
} pendres_course_kind;

/* Follow the trails of n starts and build from each: i counts them. */
pendres_status pendres_course_follow(pendres_context *ctx, const pendres_course_kind *kind,
                                     size_t n, const pendres_trail_bounds *bounds, void *call);

#endif
