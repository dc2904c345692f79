/* crossing.c -- branch points; see crossing.h. */
#include "continuation/curve/crossing.h"

#include <math.h>
#include <string.h>

#include "continuation/curve/numbers.h"

/* The place in a point of column k of B. */
static int place_of(int parameter, int k)
{
  return k < 2 ? k : parameter;
}

pendres_crossing_pivot pendres_crossing_pivot_of(const pendres_image *image, int parameter)
{
  pendres_crossing_pivot pivot = {.parameter = parameter};
  double most = -1.0;
  for (int row = 0; row < 2; row++)
    for (int k = 0; k < 3; k++) {
      const double size = fabs(image->j[row][place_of(parameter, k)]);
      if (!(size > most)) continue;
      most = size;
      pivot.row = row;
      pivot.column = k;
    }
  return pivot;
}

void pendres_crossing_rows(const pendres_crossing_pivot *pivot, const pendres_image *image,
                           double rows[4])
{
  const double *largest = image->j[pivot->row], *other = image->j[1 - pivot->row];
  const int place = place_of(pivot->parameter, pivot->column);
  const double times = other[place] / largest[place];
  int n = 0;
  rows[n++] = image->f[pivot->row];
  for (int k = 0; k < 3; k++) {
    const int at = place_of(pivot->parameter, k);
    if (k != pivot->column) rows[n++] = other[at] - times * largest[at];
  }
  rows[n] = image->f[1 - pivot->row] - times * image->f[pivot->row];
}

int pendres_crossing_closes(const pendres_image *image, int parameter, int steps, double error)
{
  const pendres_crossing_pivot pivot = pendres_crossing_pivot_of(image, parameter);
  double rows[4];
  pendres_crossing_rows(&pivot, image, rows);
  return fabs(rows[3]) <=
         crossing_rounding * sqrt(steps) * fmax(1.0, pendres_map_growth(image)) + error;
}

/* ---- directions ---- */

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static int normalise(double a[3])
{
  const double length = sqrt(dot(a, a));
  for (int k = 0; k < 3; k++) a[k] /= length;
  return length > 0.0 && isfinite(length);
}

/* Row i of B. */
static void row_of(const pendres_image *image, int parameter, int i, double out[3])
{
  for (int k = 0; k < 3; k++) out[k] = image->j[i][place_of(parameter, k)];
}

/* The scales of y, w and p at a place. */
static void scales_at(const pendres_system *s, const pendres_u u, double out[3])
{
  for (int k = 0; k < 3; k++) {
    const int place = place_of(s->unknown[2], k);
    out[k] = pendres_arc_scale(&s->map, place, u);
  }
}

static void cross(const double a[3], const double b[3], double out[3])
{
  for (int k = 0; k < 3; k++) {
    const int i = (k + 1) % 3, m = (k + 2) % 3;
    out[k] = a[i] * b[m] - a[m] * b[i];
  }
}

double pendres_crossing_bordered(const pendres_image *image, int parameter, const double tangent[3])
{
  double rows[2][3], along[3];
  for (int r = 0; r < 2; r++) row_of(image, parameter, r, rows[r]);
  cross(rows[0], rows[1], along);
  return dot(tangent, along);
}

/* The plane of null vectors of B at a branch point: along a direction, and across. */
static int plane_of(const double row[3], const double along[3], double plane[2][3])
{
  double normal[3] = {row[0], row[1], row[2]};
  if (!normalise(normal)) return 0;
  const double off = dot(along, normal);
  for (int k = 0; k < 3; k++) plane[0][k] = along[k] - off * normal[k];
  if (!normalise(plane[0])) return 0;
  cross(normal, plane[0], plane[1]);
  return 1;
}

/* l D2F in a plane in the scale of arclength, by central differences of l B. */
static pendres_status bend_of(pendres_context *ctx, const pendres_system *system, const pendres_u u,
                              const double l[2], double plane[2][3], double bend[2][2])
{
  const double h = pendres_central_step; /* its errors only steer a direction */
  const int parameter = system->unknown[2];
  pendres_image image[4];
  double points[4][PENDRES_U_COUNT], scale[3], way[2][3];
  scales_at(system, u, scale);
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 3; k++) way[i][k] = plane[i][k] * scale[k];
  for (int i = 0; i < 4; i++) {
    memcpy(points[i], u, sizeof points[i]);
    for (int k = 0; k < 3; k++)
      points[i][place_of(parameter, k)] += (i % 2 == 0 ? h : -h) * way[i / 2][k];
  }
  const pendres_status status = pendres_map_images(
    ctx, system, 4, (const pendres_u *)points, image);
  if (status != PENDRES_OK) return status;
  for (int i = 0; i < 2; i++)
    for (int m = 0; m < 2; m++) {
      double sum = 0.0, above[3], below[3];
      for (int r = 0; r < 2; r++) {
        row_of(&image[2 * i], parameter, r, above);
        row_of(&image[2 * i + 1], parameter, r, below);
        sum += l[r] * (dot(above, way[m]) - dot(below, way[m])) / (2.0 * h);
      }
      bend[i][m] = sum;
    }
  return PENDRES_OK;
}

pendres_status pendres_crossing_direction(pendres_context *ctx, const pendres_system *system,
                                          const pendres_u u, const double own[3],
                                          double crossing[3])
{
  const int parameter = system->unknown[2];
  pendres_image image;
  double plane[2][3], row[3], scale[3], bend[2][2], l[2];
  pendres_status status = pendres_map_images(ctx, system, 1, (const pendres_u *)u, &image);
  if (status != PENDRES_OK) return status;
  const pendres_crossing_pivot pivot = pendres_crossing_pivot_of(&image, parameter);
  const int place = place_of(parameter, pivot.column);
  l[1 - pivot.row] = 1.0;
  l[pivot.row] = -image.j[1 - pivot.row][place] / image.j[pivot.row][place];
  row_of(&image, parameter, pivot.row, row);
  scales_at(system, u, scale);
  for (int k = 0; k < 3; k++) row[k] *= scale[k];
  if (!plane_of(row, own, plane)) return PENDRES_NOT_CONVERGED;
  status = bend_of(ctx, system, u, l, plane, bend);
  if (status != PENDRES_OK) return status;
  /* Of the two solutions in the plane the first is about (1, 0), this is the other. */
  const double mixed = 0.5 * (bend[0][1] + bend[1][0]);
  const double root = sqrt(mixed * mixed - bend[0][0] * bend[1][1]);
  const double across = mixed + copysign(root, mixed);
  for (int k = 0; k < 3; k++) crossing[k] = across * plane[1][k] - bend[1][1] * plane[0][k];
  return normalise(crossing) && fabs(across) > curve_untold * fabs(bend[1][1]) ? PENDRES_OK
                                                                    : PENDRES_NOT_CONVERGED;
}
