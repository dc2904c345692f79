/* equations.c -- folds, flips and cusps as equations; see equations.h. */
#include "continuation/curve/equations.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "continuation/curve/crossing.h"
#include "continuation/curve/numbers.h"
#include "engine/room.h"

enum { STENCIL = 6 };

/* Derivative of the fold's determinant along the null vector, from its stencil's images. */
static double stencil_value(const pendres_image stencil[STENCIL])
{
  static const double weight[STENCIL / 2] = {45.0, -9.0, 1.0};
  double sum = 0.0;
  for (int i = 0; i < STENCIL / 2; i++)
    sum += weight[i] * (pendres_map_fold(&stencil[2 * i]) - pendres_map_fold(&stencil[2 * i + 1]));
  return sum / (60.0 * null_vector_step);
}

static void stencil_points(const pendres_u u, const double v[2], pendres_u *points)
{
  for (int i = 0; i < STENCIL; i++) {
    const double far = null_vector_step * (i / 2 + 1) * (i % 2 == 0 ? 1.0 : -1.0);
    memcpy(points[i], u, sizeof points[i]);
    points[i][PENDRES_U_Y] += far * v[0];
    points[i][PENDRES_U_W] += far * v[1];
  }
}

/* Work space: for each point its image and one for each nudged unknown, and their stencils. */
typedef struct workspace {
  pendres_u *u, *around;
  pendres_image *image, *around_image;
} workspace;

static void plain_rows(const pendres_image *image, pendres_equations *e)
{
  e->equations = 2;
  e->image = *image;
  memcpy(e->r, image->f, sizeof image->f);
  memcpy(e->j, image->j, sizeof image->j);
}

/* Append an equation with the values it has at the point and at each nudged one. */
static void append_row(pendres_equations *e, const pendres_system *s, double value,
                       const double *nudged)
{
  const int row = e->equations++;
  e->r[row] = value;
  for (int k = 0; k < PENDRES_U_COUNT; k++) e->j[row][k] = 0.0;
  for (int k = 0; k < s->unknowns; k++)
    e->j[row][s->unknown[k]] = (nudged[k] - value) / e->nudge;
}

/* Append the equation of a condition's determinant. */
static void determinant_row(const pendres_system *s, const pendres_image *image,
                            pendres_equations *e)
{
  const pendres_condition_rules *rules = pendres_condition_rules_of(s->condition);
  const double value = rules->determinant(image);
  double nudged[PENDRES_U_COUNT];
  for (int k = 0; k < s->unknowns; k++) {
    nudged[k] = rules->determinant(&image[k + 1]);
    /* What a central difference is to the value, if it were one to a side. */
    if (e->central)
      nudged[k] = value + 0.5 * (nudged[k] - rules->determinant(&image[s->unknowns + k + 1]));
  }
  append_row(e, s, value, nudged);
}

static void critical_rows(const pendres_system *s, const pendres_image *image,
                          const pendres_image *along, pendres_equations *e)
{
  (void)along;
  plain_rows(image, e);
  determinant_row(s, image, e);
}

static void cusp_rows(const pendres_system *s, const pendres_image *image,
                      const pendres_image *along, pendres_equations *e)
{
  double nudged[PENDRES_U_COUNT];
  critical_rows(s, image, along, e);
  for (int k = 0; k < s->unknowns; k++) nudged[k] = stencil_value(along + (k + 1) * STENCIL);
  append_row(e, s, stencil_value(along), nudged);
}

/* Of a branch point, all by one pivot. */
static void crossing_rows(const pendres_system *s, const pendres_image *image,
                          const pendres_image *along, pendres_equations *e)
{
  const pendres_crossing_pivot pivot = pendres_crossing_pivot_of(image, s->unknown[2]);
  double rows[PENDRES_U_COUNT + 1][4];
  (void)along;
  for (int k = 0; k <= s->unknowns; k++) pendres_crossing_rows(&pivot, &image[k], rows[k]);
  e->equations = 1;
  e->image = *image;
  e->r[0] = rows[0][0];
  memcpy(e->j[0], image->j[pivot.row], sizeof e->j[0]);
  for (int row = 1; row < 3; row++) {
    double nudged[PENDRES_U_COUNT];
    for (int k = 0; k < s->unknowns; k++) nudged[k] = rows[k + 1][row];
    append_row(e, s, rows[0][row], nudged);
  }
}

/* Of a lag of a quarter of a turn. */
static void lag_rows(const pendres_system *s, const pendres_image *image,
                     const pendres_image *along, pendres_equations *e)
{
  double nudged[PENDRES_U_COUNT];
  (void)along;
  plain_rows(image, e);
  for (int k = 0; k < s->unknowns; k++) nudged[k] = image[k + 1].in_phase;
  append_row(e, s, image->in_phase, nudged);
}

const pendres_condition_rules *
pendres_condition_rules_of(pendres_condition condition)
{
  static const pendres_condition_rules rules[PENDRES_CONDITION_COUNT] = {
    [PENDRES_CONDITION_NONE] = {.unknowns = 2},
    [PENDRES_CONDITION_FOLD] = {3, 1, pendres_map_fold, 0, critical_rows},
    [PENDRES_CONDITION_FLIP] = {3, 1, pendres_map_flip, 0, critical_rows},
    [PENDRES_CONDITION_CUSP] = {4, 1, pendres_map_fold, 1, cusp_rows},
    [PENDRES_CONDITION_CROSSING] = {3, 1, NULL, 0, crossing_rows},
    [PENDRES_CONDITION_LAG] = {3, 0, NULL, 0, lag_rows}};
  return &rules[condition];
}

static int is_weak(const pendres_system *s, const pendres_u u)
{
  return pendres_arc_damped(s->map.force, u) < 1.0;
}

/* There the determinant, a product of what multipliers lack, is small in proportion to the damping,
   and its derivative along a branch is what is left where those by the unknowns cancel. */
static double nudge_at(const pendres_system *s, const pendres_u u)
{
  const double weak = pendres_arc_damped(s->map.force, u);
  return weak < 1.0 ? determinant_step / fmax(weak, determinant_weakest) : determinant_step;
}

/* The images at all stencils of the points, each along its null vector. */
static pendres_status look_around(pendres_context *ctx, const pendres_system *s, size_t n,
                                  size_t each, const workspace *w)
{
  for (size_t i = 0; i < n * each; i++) {
    double v[2], first[2];
    pendres_map_null(&w->image[i], v);
    /* One sign for all, or differences of the derivative mean nothing. */
    pendres_map_null(&w->image[i / each * each], first);
    if (v[0] * first[0] + v[1] * first[1] < 0.0) {
      v[0] = -v[0];
      v[1] = -v[1];
    }
    stencil_points(w->u[i], v, w->around + i * STENCIL);
  }
  return pendres_map_states(ctx, &s->map, s->steps, n * each * STENCIL,
                            (const pendres_u *)w->around, w->around_image);
}

pendres_status pendres_equations_at(pendres_context *ctx, const pendres_system *s, size_t n,
                                    const pendres_u *u, pendres_equations *out)
{
  const pendres_condition_rules *rules = pendres_condition_rules_of(s->condition);
  const size_t nudges = (size_t)s->unknowns;
  int weak = 0;
  for (size_t i = 0; i < n; i++) weak |= rules->critical && is_weak(s, u[i]);
  const size_t each = rules->rows == NULL ? 1 : 1 + (weak ? 2 : 1) * nudges;
  const size_t points = n * each, around = rules->stencils ? points * STENCIL : 0;
  pendres_room room = pendres_room_open(ctx, "points");
  const workspace w = {.u = pendres_room_take(&room, points, sizeof *w.u),
                       .image = pendres_room_take(&room, points, sizeof *w.image),
                       .around = pendres_room_take(&room, around, sizeof *w.around),
                       .around_image = pendres_room_take(&room, around, sizeof *w.around_image)};
  if (room.status != PENDRES_OK) return pendres_room_close(&room, room.status);
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < each; k++) {
      memcpy(w.u[i * each + k], u[i], sizeof w.u[0]);
      if (k > 0)
        w.u[i * each + k][s->unknown[(k - 1) % nudges]] +=
          k <= nudges ? nudge_at(s, u[i]) : -nudge_at(s, u[i]);
    }
  pendres_status status = pendres_map_images(ctx, s, points, (const pendres_u *)w.u, w.image);
  if (status == PENDRES_OK && rules->stencils) status = look_around(ctx, s, n, each, &w);
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    const pendres_image *image = w.image + i * each;
    const pendres_image *along = rules->stencils ? w.around_image + i * each * STENCIL : NULL;
    out[i].nudge = nudge_at(s, u[i]);
    out[i].central = rules->critical && is_weak(s, u[i]);
    if (rules->rows != NULL) rules->rows(s, image, along, &out[i]);
    else plain_rows(image, &out[i]);
  }
  return pendres_room_close(&room, status);
}

/* ---- solving ---- */

int pendres_equations_linear(int n, double a[][PENDRES_U_COUNT], double *b)
{
  double dense[PENDRES_U_COUNT * PENDRES_U_COUNT];
  size_t order[PENDRES_U_COUNT];
  gsl_permutation permutation = {.size = (size_t)n, .data = order};
  int sign = 0;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < n; k++) {
      if (!isfinite(a[i][k])) return 0;
      dense[i * n + k] = a[i][k];
    }
  gsl_matrix_view m = gsl_matrix_view_array(dense, (size_t)n, (size_t)n);
  gsl_vector_view x = gsl_vector_view_array(b, (size_t)n);
  gsl_permutation_init(&permutation);
  if (gsl_linalg_LU_decomp(&m.matrix, &permutation, &sign) != 0) return 0;
  /* GSL's own check of this calls its error handler, which ends the program. */
  for (int i = 0; i < n; i++)
    if (!(fabs(dense[i * n + i]) > 1e-300)) return 0;
  return gsl_linalg_LU_svx(&m.matrix, &permutation, &x.vector) == 0;
}

pendres_system pendres_system_of(const pendres_map *map, pendres_condition condition,
                                 const int *unknown)
{
  pendres_system system = {.map = *map, .condition = condition};
  system.unknowns = pendres_condition_rules_of(condition)->unknowns;
  for (int k = 0; k < system.unknowns; k++) system.unknown[k] = unknown[k];
  return system;
}

/* Go to the nearest orbit, in the scale of arclength. */
static pendres_status approach_orbit(pendres_context *ctx, const pendres_system *s, pendres_u u)
{
  pendres_system orbits = *s;
  orbits.condition = PENDRES_CONDITION_NONE;
  for (int i = 0; i < NEWTON_APPROACH; i++) {
    pendres_equations e;
    double a[2][PENDRES_UNKNOWNS], scale[PENDRES_UNKNOWNS], b[3] = {0.0}, length = 0.0;
    const pendres_status status = pendres_equations_at(ctx, &orbits, 1, (const pendres_u *)u, &e);
    if (status != PENDRES_OK) return status;
    for (int k = 0; k < s->unknowns; k++) {
      scale[k] = pendres_arc_scale(&s->map, s->unknown[k], u);
      for (int r = 0; r < 2; r++) a[r][k] = e.j[r][s->unknown[k]] * scale[k];
      b[0] += a[0][k] * a[0][k];
      b[1] += a[0][k] * a[1][k];
      b[2] += a[1][k] * a[1][k];
    }
    const double det = b[0] * b[2] - b[1] * b[1];
    if (!(det > 0.0)) return PENDRES_NOT_CONVERGED;
    const double x = (b[2] * e.r[0] - b[1] * e.r[1]) / det;
    const double y = (b[0] * e.r[1] - b[1] * e.r[0]) / det;
    for (int k = 0; k < s->unknowns; k++) {
      const double d = -(a[0][k] * x + a[1][k] * y);
      u[s->unknown[k]] += scale[k] * d;
      length = hypot(length, d);
    }
    const pendres_pendulum p = pendres_map_pendulum(s->map.force, u);
    if (!(length < newton_lost) || pendres_pendulum_check(&p, NULL) != PENDRES_OK)
      return PENDRES_NOT_CONVERGED;
    if (length < follow_last_step) break;
  }
  return PENDRES_OK;
}

pendres_status pendres_equations_solve(pendres_context *ctx, const pendres_system *s,
                                       double longest, pendres_u u, pendres_equations *at)
{
  const int n = s->unknowns, critical = pendres_condition_rules_of(s->condition)->critical;
  double last = INFINITY;

  for (int i = 0; i < NEWTON_STEPS; i++) {
    double a[PENDRES_U_COUNT][PENDRES_U_COUNT], d[PENDRES_U_COUNT] = {0.0}, length = 0.0;
    pendres_status status = PENDRES_OK;
    /* At weak damping a determinant says something only where there is an orbit. */
    if (critical && is_weak(s, u)) status = approach_orbit(ctx, s, u);
    if (status == PENDRES_OK) status = pendres_equations_at(ctx, s, 1, (const pendres_u *)u, at);
    if (status != PENDRES_OK) return status;
    for (int r = 0; r < n; r++) {
      d[r] = -at->r[r];
      for (int k = 0; k < n; k++) a[r][k] = at->j[r][s->unknown[k]];
    }
    if (!pendres_equations_linear(n, a, d)) return PENDRES_NOT_CONVERGED;
    const double large = pendres_arc_large(&s->map, u);
    for (int k = 0; k < n; k++) length = hypot(length, k < 2 ? d[k] / large : d[k]);
    if (!(length < newton_lost)) return PENDRES_NOT_CONVERGED;
    const double part = length > longest ? longest / length : 1.0;
    for (int k = 0; k < n; k++) u[s->unknown[k]] += part * d[k];
    const pendres_pendulum p = pendres_map_pendulum(s->map.force, u);
    if (pendres_pendulum_check(&p, NULL) != PENDRES_OK) return PENDRES_NOT_CONVERGED;
    if (length < newton_always_rounding || (length < newton_stalled && length > 0.5 * last))
      return PENDRES_OK;
    last = length;
  }
  return PENDRES_NOT_CONVERGED;
}
