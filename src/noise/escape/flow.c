/* flow.c -- Hamilton's equations of the least action, and their derivative; see path.h. */
#include "noise/escape/path.h"

#include <math.h>
#include <string.h>

#include "base/angles.h"
#include "engine/kernels/tables.h"
#include "model/model.h"

/* What is integrated, component by component: the state and the derivative's four columns, and the
   action. */
enum { ACTION = PATH_SIZE * PATH_COLUMNS, SIZE = ACTION + 1 };

/* The equation's terms at one point. */
typedef struct terms {
  double push, slope, bend; /* g, and its derivatives by x */
} terms;

static terms look(const pendres_pendulum *p, double cosine, double x, int bends)
{
  const double y = x - pendres_model_origin(p), by = 1.0 + p->parametric_amplitude * cosine;
  double f, df;
  pendres_model_force(p, y, &f, &df);
  return (terms){by * f - p->torque - p->drive_amplitude * cosine, by * df,
                 bends ? by * pendres_model_bend(p, y) : 0.0};
}

void pendres_way_slope(const pendres_pendulum *p, double cosine, const double z[PATH_SIZE],
                        double slope[PATH_SIZE])
{
  const terms t = look(p, cosine, z[PATH_X], 0);
  slope[PATH_X] = z[PATH_V];
  slope[PATH_V] = p->damping * (2.0 * z[PATH_Q] - z[PATH_V]) - t.push;
  slope[PATH_P] = t.slope * z[PATH_Q];
  slope[PATH_Q] = p->damping * z[PATH_Q] - z[PATH_P];
}

/* Of all `columns` of what is integrated: [component][column]. */
static void slopes(const pendres_pendulum *p, double cosine, int columns, const double *y,
                   double *d)
{
  const double *x = y, *v = x + PATH_COLUMNS, *pp = v + PATH_COLUMNS, *q = pp + PATH_COLUMNS;
  double *dx = d, *dv = dx + PATH_COLUMNS, *dp = dv + PATH_COLUMNS, *dq = dp + PATH_COLUMNS;
  const terms t = look(p, cosine, x[0], columns > 1);
  const double bent = t.bend * q[0];
  dx[0] = v[0];
  dv[0] = p->damping * (2.0 * q[0] - v[0]) - t.push;
  dp[0] = t.slope * q[0];
  dq[0] = p->damping * q[0] - pp[0];
  for (int k = 1; k < columns; k++) {
    dx[k] = v[k];
    dv[k] = p->damping * (2.0 * q[k] - v[k]) - t.slope * x[k];
    dp[k] = t.slope * q[k] + bent * x[k];
    dq[k] = p->damping * q[k] - pp[k];
  }
  d[ACTION] = p->damping * q[0] * q[0];
}

void pendres_way_flow_make(const pendres_pendulum *p, pendres_way_grid grid, double *cosine,
                            pendres_way_flow *out)
{
  const pendres_tables_method *table = pendres_tables_get(PENDRES_TABLE_TP8);
  const int steps = grid.pieces * grid.steps;
  *out = (pendres_way_flow){*p, grid, two_pi / p->drive_frequency / steps, cosine};
  for (int k = 0; k < steps; k++)
    for (int i = 0; i < table->stages; i++)
      cosine[k * PATH_STAGES + i] = cos(two_pi * (k + table->c[i]) / steps);
}

/* One step of the method of order eight. */
static void step(const pendres_way_flow *f, const double *cosine, int columns, double y[SIZE])
{
  const pendres_tables_method *table = pendres_tables_get(PENDRES_TABLE_TP8);
  double k[PATH_STAGES][SIZE] = {{0}};
  const pendres_tables_entry *a = table->a, *end = a + table->entries;
  const int skip = columns > 1 ? 1 : PATH_COLUMNS;
  for (int i = 0; i < table->stages; i++) {
    double at[SIZE];
    memcpy(at, y, sizeof at);
    for (; a < end && a->row == i; a++)
      for (int j = 0; j < ACTION; j += skip) at[j] += f->step * a->value * k[(int)a->column][j];
    slopes(&f->p, cosine[i], columns, at, k[i]);
  }
  for (int i = 0; i < table->stages; i++)
    for (int j = 0; j < SIZE; j++) y[j] += f->step * table->b[i] * k[i][j];
}

void pendres_way_piece(const pendres_way_flow *f, int piece, double z[PATH_SIZE],
                        double derivative[PATH_SIZE * PATH_SIZE], double *action)
{
  double y[SIZE] = {0.0};
  for (int i = 0; i < PATH_SIZE; i++) {
    y[i * PATH_COLUMNS] = z[i];
    y[i * PATH_COLUMNS + 1 + i] = 1.0;
  }
  for (int k = 0; k < f->grid.steps; k++)
    step(f, f->cosine + (size_t)(piece * f->grid.steps + k) * PATH_STAGES,
         derivative != NULL ? PATH_COLUMNS : 1, y);
  for (int i = 0; i < PATH_SIZE; i++) {
    z[i] = y[i * PATH_COLUMNS];
    for (int j = 0; derivative != NULL && j < PATH_SIZE; j++)
      derivative[i * PATH_SIZE + j] = y[i * PATH_COLUMNS + 1 + j];
  }
  if (action != NULL) *action += y[ACTION];
}
