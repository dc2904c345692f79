/* work_unit.c -- pendulums to measure methods with; see work_unit.h. */
#include "validation/work_unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pendres/reference.h>

#include "validation/exact.h"

const long work_unit_periods[WORK_UNIT_MARKS] = { 10, 100 };

enum { CHUNK = 8 /* pendulums a task */ };

static void place(work_unit *w, int sweep)
{
  const double two_pi = 2.0 * pi, plastic = 1.32471795724474602596;
  const double n = (double)w->n;
  for (size_t i = 0; i < w->n; i++) {
    const double k = (double)(i + 1);
    pendres_pendulum *p = &w->pendulum[i];
    *p = (pendres_pendulum){ .damping = 0.12, .drive_amplitude = 0.2,
                             .drive_frequency = two_pi / 8.0 };
    if (sweep) {
      p->drive_frequency = 0.6 + 0.6 * fmod(k / plastic, 1.0);
      p->damping = 0.06 + 0.94 * fmod(k / (plastic * plastic), 1.0);
    }
    w->x[i] = -0.25 * two_pi + two_pi * k / n;
  }
}

pendres_status work_unit_make(const char *name, work_unit *w)
{
  const int sweep = strcmp(name, "sweep") == 0;
  w->n = sweep ? 1000 : 200;
  w->pendulum = calloc(w->n, sizeof *w->pendulum);
  w->x = calloc(w->n, sizeof *w->x);
  int good = w->pendulum != NULL && w->x != NULL;
  for (int m = 0; m < WORK_UNIT_MARKS; m++) {
    w->angle[m] = calloc(w->n, sizeof *w->angle[m]);
    w->velocity[m] = calloc(w->n, sizeof *w->velocity[m]);
    w->growth[m] = calloc(w->n, sizeof *w->growth[m]);
    good = good && w->angle[m] != NULL && w->velocity[m] != NULL && w->growth[m] != NULL;
  }
  if (!good) {
    work_unit_free(w);
    return PENDRES_OUT_OF_MEMORY;
  }
  place(w, sweep);
  return PENDRES_OK;
}

void work_unit_free(work_unit *w)
{
  free(w->pendulum);
  free(w->x);
  for (int m = 0; m < WORK_UNIT_MARKS; m++) {
    free(w->angle[m]);
    free(w->velocity[m]);
    free(w->growth[m]);
  }
  memset(w, 0, sizeof *w);
}

/* Where a pendulum is at each mark. */
typedef struct marks {
  long double angle[WORK_UNIT_MARKS], velocity[WORK_UNIT_MARKS];
  double growth[WORK_UNIT_MARKS];
} marks;

/* From mark to mark, with the product of the derivatives. */
static pendres_status refer_one(const work_unit *w, size_t i, marks *out)
{
  long double y = (long double)w->x[i] - half_pi_exact, v = 0.0L;
  long double growth[2][2] = { { 1.0L, 0.0L }, { 0.0L, 1.0L } };
  long turns = 0, done = 0;
  for (int m = 0; m < WORK_UNIT_MARKS; m++) {
    pendres_reference_image to;
    const pendres_status status =
      pendres_reference_map(&w->pendulum[i], y, v, work_unit_periods[m] - done, &to);
    if (status != PENDRES_OK) return status;
    long double product[2][2], largest = 0.0L;
    for (int a = 0; a < 2; a++)
      for (int b = 0; b < 2; b++) {
        product[a][b] = to.monodromy[a][0] * growth[0][b] + to.monodromy[a][1] * growth[1][b];
        largest = fmaxl(largest, fabsl(product[a][b]));
      }
    memcpy(growth, product, sizeof growth);
    y = to.y, v = to.v, turns += to.turns, done = work_unit_periods[m];
    out->angle[m] = y + 2.0L * pi_exact * (long double)turns;
    out->velocity[m] = v;
    out->growth[m] = (double)largest;
  }
  return PENDRES_OK;
}

static pendres_status refer_chunk(const void *arg, size_t task, pendres_context *ctx,
                                  farm_record *out)
{
  const work_unit *w = arg;
  marks *m = out->data;
  (void)ctx;
  for (size_t i = task * CHUNK; i < w->n && i < (task + 1) * CHUNK; i++) {
    const pendres_status status = refer_one(w, i, &m[i - task * CHUNK]);
    if (status != PENDRES_OK) return status;
  }
  return PENDRES_OK;
}

static pendres_status keep_chunk(void *arg, size_t task, const farm_record *in)
{
  work_unit *w = arg;
  const marks *of = in->data;
  for (size_t i = task * CHUNK; i < w->n && i < (task + 1) * CHUNK; i++, of++)
    for (int m = 0; m < WORK_UNIT_MARKS; m++) {
      w->angle[m][i] = of->angle[m];
      w->velocity[m][i] = of->velocity[m];
      w->growth[m][i] = of->growth[m];
    }
  return PENDRES_OK;
}

pendres_status work_unit_refer(work_unit *w, farm *f)
{
  return farm_run(f, &(farm_stage){ .what = "reference", .tasks = (w->n + CHUNK - 1) / CHUNK,
                                    .record_size = CHUNK * sizeof(marks), .task = refer_chunk,
                                    .collect = keep_chunk, .arg = w });
}

size_t work_unit_pick(const work_unit *w, size_t some, size_t k)
{
  return some >= w->n ? k : (2 * k + 1) * w->n / (2 * some);
}

double work_unit_error(const work_unit *w, size_t i, int mark, double x, double v)
{
  const double dx = (double)((long double)x - half_pi_exact - w->angle[mark][i]);
  const double dv = (double)((long double)v - w->velocity[mark][i]);
  if (isnan(dx) || isnan(dv)) return INFINITY;
  return fmax(fabs(dx), fabs(dv));
}
