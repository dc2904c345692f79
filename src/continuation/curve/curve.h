/*
 * curve.h -- a curve of solutions: of orbits in one parameter, which is a branch, or of
 * bifurcations in two.
 *
 * Owns: following curves both ways from a start, within bounds; correcting their nodes to the
 * tolerance; the special points on them, where test functions change their sign: bifurcations of a
 * branch, cusps of a curve of folds.
 */
#ifndef PENDRES_CURVE_H
#define PENDRES_CURVE_H

#include "continuation/curve/follow.h"
#include "continuation/curve/locate.h"

/* An estimate of where a test function vanishes: between nodes i and i + 1 (after the last node of
   a closed curve comes the first), at this share of the chord. */
typedef struct pendres_curve_zero {
  size_t i;
  double part;
  int half; /* of a birth: the number of the half map whose orbits the branch was born from */
} pendres_curve_zero;

/* A bifurcation or a cusp, and where on the curve it lies. */
typedef struct pendres_curve_special {
  pendres_curve_zero at;
  pendres_condition condition;
  int flat; /* a fold that cannot be told from a cusp: the branch goes on through it */
  pendres_located located;
} pendres_curve_special;

/* A point: a node, or the special one of this number that follows upon it (-1: none). */
typedef struct pendres_curve_place {
  size_t i;
  int special;
  double arclength; /* from the first node */
} pendres_curve_place;

/* One way along a curve from its start. */
typedef struct pendres_curve_way {
  pendres_follower at;
  int taken, going; /* of the follower's nodes ahead; whether there may be more */
  size_t count, capacity;
  size_t stretch, counted; /* nodes since the first parameter turned, and those that count */
  size_t unstable; /* the latest nodes that do not attract */
  pendres_curve_node start, *node; /* outwards, without the start */
  pendres_branch_end end;
} pendres_curve_way;

struct pendres_curve {
  pendres_followed kind;
  pendres_branch_end end[2];
  size_t start; /* in a set: the number of the bifurcation that it was followed from */
  size_t count, specials; /* points, special ones included */
  /* Results, in the caller's units. Of a branch: */
  pendres_branch_point *branch_point;
  pendres_bifurcation *bifurcation;
  /* Of a curve of bifurcations, with the unknowns of its points: */
  pendres_curve_point *point;
  pendres_cusp *cusp;
  pendres_u *u;
  /* Working arrays, which are freed once the results have been made, or kept to go on: */
  pendres_curve_way *way; /* [2] */
  size_t nodes, capacity, room;
  pendres_curve_node *node; /* in order, arclength ascending from 0 */
  double round; /* of a closed curve: by how many whole turns, as an angle, y has grown when the
                   curve is back at its first node; it may lead from well to well */
  pendres_curve_special *special;
  pendres_curve_place *place; /* [count] all points, in order */
  /* For each node: what it was corrected to, its orbit, and the errors of its parameters. */
  pendres_solution *pair;
  pendres_orbit *orbit;
  double (*error)[2];
};

/* A branch is a curve of orbits. */
struct pendres_branch {
  pendres_curve curve;
};

static inline pendres_branch *pendres_branch_of(pendres_curve *orbits)
{
  return (pendres_branch *)orbits;
}

/* Sets of curves, and of branches. */
struct pendres_curves {
  size_t count, capacity, skipped;
  pendres_curve **curve;
};

struct pendres_branches {
  pendres_curves set;
};

static inline pendres_branches *pendres_branches_of(pendres_curves *set)
{
  return (pendres_branches *)set;
}

/* NULL: none. */
static inline pendres_curves *pendres_branches_set(pendres_branches *branches)
{
  return branches != NULL ? &branches->set : NULL;
}

static inline int pendres_curve_is_branch(const pendres_curve *c)
{
  return c->kind.system.condition == PENDRES_CONDITION_NONE;
}

static inline int pendres_curve_closed(const pendres_curve *c)
{
  return c->end[0] == PENDRES_END_CLOSED;
}

/* ---- following ---- */

/* A solution to start from, and the curve that it lies on. */
typedef struct pendres_curve_start {
  pendres_followed kind;
  pendres_u u;
} pendres_curve_start;

/* Bounds of the parameters among the unknowns, in their order, and of the way. */
typedef struct pendres_curve_bounds {
  double low[2], high[2];
  double wildest;
  size_t most_points; /* each way; 0: PENDRES_CURVE_POINTS, of long stretches not all counted */
  size_t most_unstable; /* a way ends, as if by points, at so many in turn that do not attract; 0:
                           at none */
} pendres_curve_bounds;

/* Makes the results of a curve whose nodes have been found: special points, measures, errors. */
typedef pendres_status pendres_curve_finisher(pendres_context *ctx, pendres_curve *curve);

/* Begin a curve, follow it, make its results, and free its working arrays. On failure *out is
   NULL. */
pendres_status pendres_curve_make(pendres_context *ctx, const pendres_curve_start *start,
                                  const pendres_curve_bounds *bounds,
                                  pendres_curve_finisher *finish, pendres_curve **out);

/* The same step by step: begin, */
pendres_status pendres_curve_begin(pendres_context *ctx, const pendres_curve_start *start,
                                   pendres_curve **out);
/* and go on with ways that have ended by the number of points alone, or not begun to. */
pendres_status pendres_curve_extend(pendres_context *ctx, pendres_curve *curve,
                                    const pendres_curve_bounds *bounds);

/* The curve of bifurcations in two parameters that one lies on, and its place there. */
pendres_followed pendres_followed_at(const pendres_bifurcation *b, pendres_parameter second,
                                     double spacing, pendres_u u);

/* ---- special points ---- */

/*
 * A test for special points of one kind: a function of nodes that vanishes at them, or another way
 * to find candidates; and a function that locates the special point near a candidate u, whose place
 * on the curve is already in *out. PENDRES_NOT_CONVERGED: there is none.
 */
enum { PENDRES_CURVE_ZEROS = 256 /* at most, of one function */ };
typedef struct pendres_curve_test {
  pendres_curve_function *function;
  int refine; /* whether it may touch 0, or have two zeros between nodes: these are added then */
  int touch;  /* whether a minimum of about 0 counts: where a branch is born from another det(N - I)
                 touches 0. At weak damping det(N + I) comes close to it without a flip */
  pendres_status (*find)(pendres_context *ctx, const pendres_curve *curve,
                         pendres_curve_zero zeros[PENDRES_CURVE_ZEROS], size_t *count);
  pendres_status (*locate)(pendres_context *ctx, const pendres_curve *curve, const pendres_u u,
                           double reach, pendres_curve_special *out);
} pendres_curve_test;

/* Find the special points of a curve by n tests, one after another, each point once. */
pendres_status pendres_curve_find_specials(pendres_context *ctx, pendres_curve *curve, size_t n,
                                           const pendres_curve_test *tests);

/* The functions whose zeros are folds of a branch and cusps of a curve of folds. */
double pendres_curve_fold(const pendres_curve_node *node);
double pendres_curve_bending(const pendres_curve_node *node);

/* Solve for a condition near u, on the curve's map. As pendres_locate(). */
pendres_status pendres_curve_locate(pendres_context *ctx, const pendres_followed *kind,
                                    pendres_condition condition, const pendres_u u,
                                    double reach, pendres_located *out);

/* Where a branch passes branch points, or places where branches come so close that its nodes have
   led from one to another, in order. Births are among them. */
pendres_status pendres_curve_find_crossings(pendres_context *ctx, const pendres_curve *curve,
                                            pendres_curve_zero zeros[PENDRES_CURVE_ZEROS],
                                            size_t *count);

/* Where a branch that keeps apart from orbits that close by a half map passes one: the orbit was
   born there, and beyond it is its own image. In order. */
pendres_status pendres_curve_find_births(pendres_context *ctx, const pendres_curve *curve,
                                         pendres_curve_zero zeros[PENDRES_CURVE_ZEROS],
                                         size_t *count);

/* Add nodes where a function comes close to 0 without changing its sign from one to the next, until
   it does or is known not to: two folds may be close together. */
pendres_status pendres_curve_refine(pendres_context *ctx, pendres_curve *curve,
                                    pendres_curve_function *function);

/* Find the zeros of a test's function, in order; returns their number. */
size_t pendres_curve_zeros(const pendres_curve *curve, const pendres_curve_test *of,
                           pendres_curve_zero zeros[PENDRES_CURVE_ZEROS]);

/* The point at a zero, by linear interpolation, and the length of the chord. */
double pendres_curve_between(const pendres_curve *curve, const pendres_curve_zero *zero,
                             pendres_u u);

/* The point of the curve itself where a function changes its sign between two nodes, by the rule of
   false position, the value at the end that stays halved; u stays what it is where it does not. */
pendres_status pendres_curve_close_in(pendres_context *ctx, const pendres_curve *curve,
                                      pendres_curve_function *function,
                                      const pendres_curve_zero *zero, pendres_u u);

/* ---- to the tolerance ---- */

/*
 * Correct n nodes of these numbers (NULL: the first n) at coarse and fine steps so that errors come
 * down to the tolerance where they can: sets their pairs, and the errors of their unknown
 * parameters, error[i][0..1]. Each stays in the plane across its tangent.
 */
pendres_status pendres_curve_polish(pendres_context *ctx, pendres_curve *curve, size_t n,
                                    const size_t *index);

/* Measure the orbits of all nodes, and list all points in order. */
pendres_status pendres_curve_measure(pendres_context *ctx, pendres_curve *curve);

/*
 * The same for a branch that is only to lead on: its nodes are left where the follower found them,
 * with errors of its tolerance, but for those next to special points. Of an orbit there are the
 * state, period, winding, multipliers and stability, which agree with the signs of test functions;
 * measures and errors are NaN.
 */
pendres_status pendres_curve_leave_coarse(pendres_context *ctx, pendres_curve *curve);

/*
 * Follow the branch of an orbit, both ways, stable and unstable parts; with its folds, period
 * doublings and symmetry breakings located to the tolerance.
 *
 * *out is to be freed by pendres_branch_free; NULL on failure. Errors: PENDRES_INVALID_ARGUMENT,
 * PENDRES_NOT_CONVERGED (the start is no orbit), those of the integration. PENDRES_OK also where
 * some point's error exceeds the tolerance: the errors say so.
 */
pendres_status pendres_branch_follow(pendres_context *ctx, const pendres_orbit *start,
                                     const pendres_branch_options *options, pendres_branch **out);

/* NULL is allowed. */
void pendres_branch_free(pendres_branch *branch);

/* Follow the curve of a bifurcation, both ways from it. *out is to be freed by pendres_curve_free;
   NULL on failure. Errors as for pendres_branch_follow. */
pendres_status pendres_curve_follow(pendres_context *ctx, const pendres_bifurcation *start,
                                    const pendres_curve_options *options, pendres_curve **out);

/* NULL is allowed. */
void pendres_curve_free(pendres_curve *curve);

/* The parameter that the curve's starts were found in (which = 0), and the second (1). */
pendres_parameter pendres_curve_parameter(const pendres_curve *curve, int which);

#endif
