/* lanes.c -- the N_Vector of a block of pendulums; see lanes.h. */
#include "lanes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct content {
  pendres_lanes_shape *shape;
  double *data;
} content;

/* The most terms that ARKODE hands over at once: stages of a table, plus one. */
enum { MOST_TERMS = 32 };

static const content *of(N_Vector v)
{
  return (const content *)v->content;
}

double *pendres_lanes_data(N_Vector v)
{
  return of(v)->data;
}

static size_t length(N_Vector v)
{
  return of(v)->shape->rows * of(v)->shape->stride;
}

double *pendres_lanes_allocate(size_t n)
{
  const size_t bytes = (n * sizeof(double) + PENDRES_LANES_ALIGN - 1) / PENDRES_LANES_ALIGN *
                       PENDRES_LANES_ALIGN;
  double *data = aligned_alloc(PENDRES_LANES_ALIGN, bytes > 0 ? bytes : PENDRES_LANES_ALIGN);
  if (data != NULL) memset(data, 0, bytes);
  return data;
}

static void destroy(N_Vector v)
{
  if (v == NULL) return;
  if (v->content != NULL) free(of(v)->data);
  free(v->content);
  v->content = NULL;
  N_VFreeEmpty(v);
}

static N_Vector clone(N_Vector v)
{
  N_Vector w = N_VNewEmpty(v->sunctx);
  if (w == NULL) return NULL;
  content *c = calloc(1, sizeof *c);
  w->content = c;
  if (c == NULL || N_VCopyOps(v, w) != 0) goto fail;
  c->shape = of(v)->shape;
  c->data = pendres_lanes_allocate(c->shape->rows * c->shape->capacity);
  if (c->data == NULL) goto fail;
  return w;
fail:
  destroy(w);
  return NULL;
}

/* z = sum c x; terms with a zero coefficient are left out: a third of a Butcher table is zero. */
static int linear_combination(int n, sunrealtype *c, N_Vector *x, N_Vector z)
{
  double factor[MOST_TERMS];
  const double *term[MOST_TERMS];
  int used = 0;

  if (n > MOST_TERMS) return -1;
  for (int i = 0; i < n; i++) {
    if (c[i] == 0.0) continue;
    factor[used] = c[i];
    term[used++] = of(x[i])->data;
  }
  if (used == 0) {
    memset(of(z)->data, 0, length(z) * sizeof(double));
    return 0;
  }
  of(z)->shape->kernels->combine(length(z), used, factor, term, of(z)->data);
  return 0;
}

static void linear_sum(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z)
{
  const double factor[2] = {a, b};
  const double *const term[2] = {of(x)->data, of(y)->data};
  of(z)->shape->kernels->combine(length(z), 2, factor, term, of(z)->data);
}

static void scale(sunrealtype a, N_Vector x, N_Vector z)
{
  if (a == 1.0) {
    if (x != z) memcpy(of(z)->data, of(x)->data, length(z) * sizeof(double));
    return;
  }
  const double *const term[1] = {of(x)->data};
  of(z)->shape->kernels->combine(length(z), 1, &a, term, of(z)->data);
}

static double lane_sum_of_squares(const pendres_lanes_shape *s, const double *x, const double *w,
                                  size_t lane)
{
  double sum = 0.0;
  for (size_t r = 0; r < s->rows; r++) {
    const double e = x[r * s->stride + lane] * w[r * s->stride + lane];
    sum += e * e;
  }
  return sum;
}

static sunrealtype wrms_norm(N_Vector x, N_Vector w)
{
  const pendres_lanes_shape *s = of(x)->shape;
  if (s->norm_unused) return 0.0;
  double largest = 0.0;
  for (size_t i = 0; i < s->stride; i++) {
    const double sum = lane_sum_of_squares(s, of(x)->data, of(w)->data, i);
    /* A NaN must win, or a failed lane would pass as a perfect one. */
    if (!(sum <= largest)) largest = sum;
  }
  return sqrt(largest / (double)s->rows);
}

static void each(N_Vector x, N_Vector z, double (*map)(double, double), double argument)
{
  const size_t n = length(z);
  for (size_t i = 0; i < n; i++) of(z)->data[i] = map(of(x)->data[i], argument);
}

static double map_absolute(double x, double unused)
{
  (void)unused;
  return fabs(x);
}

static double map_inverse(double x, double unused)
{
  (void)unused;
  return 1.0 / x;
}

static double map_add(double x, double b)
{
  return x + b;
}

static double map_constant(double x, double c)
{
  (void)x;
  return c;
}

static void absolute(N_Vector x, N_Vector z)
{
  each(x, z, map_absolute, 0.0);
}

static void inverse(N_Vector x, N_Vector z)
{
  each(x, z, map_inverse, 0.0);
}

static void add_constant(N_Vector x, sunrealtype b, N_Vector z)
{
  each(x, z, map_add, b);
}

static void constant(sunrealtype c, N_Vector z)
{
  each(z, z, map_constant, c);
}

static void divide(N_Vector x, N_Vector y, N_Vector z)
{
  const size_t n = length(z);
  for (size_t i = 0; i < n; i++) of(z)->data[i] = of(x)->data[i] / of(y)->data[i];
}

static void product(N_Vector x, N_Vector y, N_Vector z)
{
  const size_t n = length(z);
  for (size_t i = 0; i < n; i++) of(z)->data[i] = of(x)->data[i] * of(y)->data[i];
}

static sunrealtype max_norm(N_Vector x)
{
  const size_t n = length(x);
  double largest = 0.0;
  for (size_t i = 0; i < n; i++)
    if (!(fabs(of(x)->data[i]) <= largest)) largest = fabs(of(x)->data[i]);
  return largest;
}

static sunrealtype smallest(N_Vector x)
{
  const size_t n = length(x);
  double least = INFINITY;
  for (size_t i = 0; i < n; i++)
    if (!(of(x)->data[i] >= least)) least = of(x)->data[i];
  return least;
}

static sunindextype get_length(N_Vector v)
{
  return (sunindextype)length(v);
}

static N_Vector_ID get_id(N_Vector v)
{
  (void)v;
  return SUNDIALS_NVEC_CUSTOM;
}

N_Vector pendres_lanes_create(pendres_lanes_shape *shape, SUNContext sun)
{
  N_Vector v = N_VNewEmpty(sun);
  if (v == NULL) return NULL;
  v->ops->nvgetvectorid = get_id;
  v->ops->nvclone = clone;
  v->ops->nvdestroy = destroy;
  v->ops->nvgetlength = get_length;
  v->ops->nvlinearcombination = linear_combination;
  v->ops->nvlinearsum = linear_sum;
  v->ops->nvscale = scale;
  v->ops->nvconst = constant;
  v->ops->nvprod = product;
  v->ops->nvdiv = divide;
  v->ops->nvabs = absolute;
  v->ops->nvinv = inverse;
  v->ops->nvaddconst = add_constant;
  v->ops->nvmaxnorm = max_norm;
  v->ops->nvwrmsnorm = wrms_norm;
  v->ops->nvmin = smallest;

  content *c = calloc(1, sizeof *c);
  v->content = c;
  if (c == NULL) goto fail;
  c->shape = shape;
  c->data = pendres_lanes_allocate(shape->rows * shape->capacity);
  if (c->data == NULL) goto fail;
  return v;
fail:
  destroy(v);
  return NULL;
}
