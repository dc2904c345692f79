/* orbit_reading.c -- runs of orbits, measured; see orbit_reading.h. */
#include "orbits/orbit_reading.h"

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "engine/context_internal.h"
#include "engine/threads.h"
#include "model/equation.h"
#include "orbits/orbit_table.h"

/* Memory for samples and what measuring them takes. */
typedef struct room {
  pendres_orbit_tables tables;
  double *work;
  size_t size;
} room;

static pendres_status read_one(const pendres_orbit_reader *reader,
                               const pendres_newton_samples *taken, room *r,
                               pendres_newton_candidate *c)
{
  const size_t n = taken->count;
  double *y = r->work, *w = r->work + n;
  pendres_orbit_computed *out = &reader->out[c->index];
  *out = (pendres_orbit_computed){.y = c->y, .w = c->w};
  memcpy(out->m, c->m, sizeof out->m);
  memcpy(out->m_by, c->m_by, sizeof out->m_by);
  if (!taken->bends) out->noise = pendres_newton_noise_of(c, taken);
  if (!reader->take(reader->arg, c, taken, y, w, out)) {
    c->state = PENDRES_NEWTON_FAILED;
    return PENDRES_OK;
  }
  /* Without samples: as far as it is the same at all states. */
  out->measures.contraction.value = pendres_equation_contraction(&c->guess->pendulum);
  if (reader->points) return PENDRES_OK;
  const pendres_orbit_samples samples = {
    .n = n, .period = c->guess->period, .winding = c->guess->winding, .y = y, .w = w,
    .tables = &r->tables};
  return pendres_orbit_table_measure(&c->guess->pendulum, &samples, r->work + 2 * n,
                                     &out->measures);
}

static pendres_status provide(pendres_context *ctx, size_t samples, room *r)
{
  const size_t need = 2 * samples + pendres_orbit_measure_work(samples);
  if (need <= r->size) return PENDRES_OK;
  if (!pendres_regrow(&r->work, need, sizeof *r->work))
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for samples");
  r->size = need;
  return PENDRES_OK;
}

/* Candidates in the order in which they share blocks, some on each thread. */
typedef struct reading {
  const pendres_orbit_reader *reader;
  pendres_newton_candidate *c;
} reading;

static pendres_status read_some(pendres_context *ctx, size_t begin, size_t n, void *arg)
{
  const reading *of = arg;
  const pendres_orbit_reader *reader = of->reader;
  pendres_newton_candidate *c = of->c + begin;
  pendres_newton_samples taken = {.bends = reader->bends, .none = reader->points};
  room r = {.work = NULL};
  pendres_status status = PENDRES_OK;
  for (size_t first = 0, count; first < n && status == PENDRES_OK; first += count) {
    status = pendres_newton_pass(ctx, n - first, c + first, reader->want, &taken, &count);
    if (status == PENDRES_OK) status = provide(ctx, taken.count, &r);
    if (status != PENDRES_OK) break;
    for (size_t i = first; i < first + count && status == PENDRES_OK; i++) {
      if (c[i].state != PENDRES_NEWTON_CONVERGED) continue;
      status = read_one(reader, &taken, &r, &c[i]);
      if (status != PENDRES_OK)
        (void)pendres_context_fail(ctx, status, "the samples of an orbit could not be measured");
    }
  }
  pendres_newton_samples_free(&taken);
  pendres_orbit_tables_free(&r.tables);
  free(r.work);
  return status;
}

pendres_status pendres_orbit_read(pendres_context *ctx, const pendres_orbit_reader *reader,
                                  size_t n, pendres_newton_candidate *c)
{
  reading of = {.reader = reader, .c = c};
  pendres_newton_order(n, c);
  return pendres_threads_run(ctx, n, pendres_newton_each(ctx, n, c), read_some, &of);
}
