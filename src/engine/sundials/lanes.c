/* lanes.c -- the N_Vector of a block of pendulums; see lanes.h. */
#include "base/numbers.h"
#include "engine/sundials/lanes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "engine/sundials/lanes_tape.h"

typedef pendres_lanes_shape shape;

/* Strips lie side by side modulo this, or the vectors would push each other out of a cache. */
enum { CACHE_PERIOD = 4096, STRIP_BYTES = 1280 };

static const pendres_lanes_content *of(N_Vector v)
{
  return pendres_lanes_of(v);
}

/* Its numbers, now. */
static double *numbers(N_Vector v)
{
  pendres_lanes_tape_run(of(v)->shape);
  return of(v)->data;
}

static size_t length(N_Vector v)
{
  return of(v)->shape->rows * of(v)->shape->stride;
}

static size_t rounded_up(size_t n, size_t multiple)
{
  return (n + multiple - 1) / multiple * multiple;
}

double *pendres_lanes_allocate(size_t n)
{
  const size_t bytes = rounded_up(n * sizeof(double), PENDRES_ALIGN);
  double *data = aligned_alloc(PENDRES_ALIGN, bytes > 0 ? bytes : PENDRES_ALIGN);
  if (data != NULL) memset(data, 0, bytes);
  return data;
}

int pendres_lanes_open(shape *s, size_t rows, size_t lanes, const pendres_kernels *kernels)
{
  *s = (shape){.rows = rows, .kernels = kernels};
  s->capacity = rounded_up(lanes, PENDRES_LANES_MULTIPLE);
  s->tape = pendres_lanes_tape_create();
  if (s->tape == NULL) return -1;
  pendres_lanes_resize(s, lanes);
  return 0;
}

void pendres_lanes_close(shape *s)
{
  N_Vector spare = s->spare;
  s->spare = NULL;
  N_VDestroy(spare);
  pendres_lanes_tape_free(s->tape);
  s->tape = NULL;
}

void pendres_lanes_resize(shape *s, size_t lanes)
{
  pendres_lanes_tape_run(s);
  pendres_lanes_shape_cut(s, lanes);
}

static void destroy(N_Vector v)
{
  if (v == NULL || (v->content != NULL && v == of(v)->shape->spare)) return;
  if (v->content != NULL) {
    pendres_lanes_tape_forget(of(v)->shape);
    free(of(v)->memory);
  }
  free(v->content);
  v->content = NULL;
  N_VFreeEmpty(v);
}

/* Give v memory of the shape. */
static int fill(N_Vector v, shape *s)
{
  const size_t bytes = rounded_up(s->rows * s->capacity * sizeof(double), CACHE_PERIOD);
  pendres_lanes_content *c = calloc(1, sizeof *c);
  v->content = c;
  if (c == NULL) return -1;
  c->shape = s;
  c->memory = aligned_alloc(CACHE_PERIOD, bytes + CACHE_PERIOD);
  if (c->memory == NULL) return -1;
  memset(c->memory, 0, bytes + CACHE_PERIOD);
  c->data = (double *)((char *)c->memory + s->vectors * STRIP_BYTES % CACHE_PERIOD);
  c->bit = s->vectors < 64 ? UINT64_C(1) << s->vectors : 0;
  s->vectors++;
  return 0;
}

/* Another vector of the shape; NULL if out of memory. */
static N_Vector another(N_Vector v)
{
  N_Vector w = N_VNewEmpty(v->sunctx);
  if (w == NULL) return NULL;
  if (N_VCopyOps(v, w) == 0 && fill(w, of(v)->shape) == 0) return w;
  destroy(w);
  return NULL;
}

static N_Vector clone(N_Vector v)
{
  shape *s = of(v)->shape;
  N_Vector w = another(v);
  if (w != NULL) return w;
  s->starved = 1;
  return s->spare;
}

/* Where a row of a strip starts, for all of them: copy between rows and strips. */
static void copy(N_Vector v, double *rows, int in)
{
  const shape *s = of(v)->shape;
  double *data = numbers(v);
  for (size_t lane = 0, lanes; lane < s->stride; lane += lanes) {
    lanes = pendres_lanes_strip(s, lane);
    for (size_t r = 0; r < s->rows; r++, data += lanes) {
      double *row = rows + r * s->stride + lane;
      if (in)
        memcpy(data, row, lanes * sizeof *data);
      else
        memcpy(row, data, lanes * sizeof *data);
    }
  }
}

void pendres_lanes_write(N_Vector v, const double *rows)
{
  copy(v, (double *)rows, 1);
}

void pendres_lanes_read(N_Vector v, double *rows)
{
  copy(v, rows, 0);
}

static int linear_combination(int n, sunrealtype *c, N_Vector *x, N_Vector z)
{
  if (n > PENDRES_KERNELS_TERMS) return -1;
  pendres_lanes_tape_sum(n, c, x, z);
  return 0;
}

static void linear_sum(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z)
{
  const double c[2] = {a, b};
  const N_Vector terms[2] = {x, y};
  pendres_lanes_tape_sum(2, c, terms, z);
}

static void scale(sunrealtype a, N_Vector x, N_Vector z)
{
  if (a == 1.0)
    pendres_lanes_tape_copy(x, z);
  else
    pendres_lanes_tape_sum(1, &a, &x, z);
}

static double sum_of_squares(const double *x, const double *w, size_t rows, size_t lanes)
{
  double sum = 0.0;
  for (size_t r = 0; r < rows; r++) {
    const double e = x[r * lanes] * w[r * lanes];
    sum += e * e;
  }
  return sum;
}

static sunrealtype wrms_norm(N_Vector x, N_Vector w)
{
  const shape *s = of(x)->shape;
  if (s->norm_unused) return 0.0;
  double largest = 0.0;
  const double *px = numbers(x), *pw = numbers(w);
  for (size_t lane = 0, lanes; lane < s->stride; lane += lanes) {
    lanes = pendres_lanes_strip(s, lane);
    for (size_t i = 0; i < lanes; i++) {
      const double sum = sum_of_squares(px + i, pw + i, s->rows, lanes);
      if (isnan(sum)) return sum; /* otherwise a lane that is no number would pass as a perfect one
                                     */
      if (sum > largest) largest = sum;
    }
    px += s->rows * lanes;
    pw += s->rows * lanes;
  }
  return sqrt(largest / (double)s->rows);
}

/* z, number by number, from a of one vector and b of another. */
#define EACH(name, arguments, first, second, value)                     \
  static void name arguments                                            \
  {                                                                     \
    const size_t n = length(z);                                         \
    const double *const of_first = numbers(first), *const of_second = numbers(second); \
    double *const to = numbers(z);                                      \
    for (size_t i = 0; i < n; i++) {                                    \
      const double a = of_first[i], b = of_second[i];                   \
      (void)a, (void)b;                                                 \
      to[i] = value;                                                    \
    }                                                                   \
  }
EACH(absolute, (N_Vector x, N_Vector z), x, x, fabs(a))
EACH(inverse, (N_Vector x, N_Vector z), x, x, 1.0 / a)
EACH(add_constant, (N_Vector x, sunrealtype c, N_Vector z), x, x, a + c)
EACH(constant, (sunrealtype c, N_Vector z), z, z, c)
EACH(divide, (N_Vector x, N_Vector y, N_Vector z), x, y, a / b)
EACH(product, (N_Vector x, N_Vector y, N_Vector z), x, y, a * b)
#undef EACH

static sunrealtype max_norm(N_Vector x)
{
  const size_t n = length(x);
  const double *data = numbers(x);
  double largest = 0.0;
  for (size_t i = 0; i < n; i++) {
    if (isnan(data[i])) return data[i];
    largest = fmax(largest, fabs(data[i]));
  }
  return largest;
}

static sunrealtype smallest(N_Vector x)
{
  const size_t n = length(x);
  const double *data = numbers(x);
  double least = INFINITY;
  for (size_t i = 0; i < n; i++) {
    if (isnan(data[i])) return data[i];
    least = fmin(least, data[i]);
  }
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

N_Vector pendres_lanes_create(shape *s, SUNContext sun)
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

  int bad = fill(v, s);
  if (bad == 0 && s->spare == NULL) bad = (s->spare = another(v)) == NULL;
  if (!bad) return v;
  destroy(v);
  return NULL;
}
