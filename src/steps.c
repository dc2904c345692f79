/* steps.c -- how many fixed steps a drive period needs; see steps.h. */
#include "steps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "context_internal.h"

enum {
  PROBES = 16,          /* initial states a cell is probed with, two vectors of eight */
  FEWEST_STEPS = 8,
  MOST_STEPS = 1000000,
  FIRST_SIZE = 64       /* of the memo, doubled as it fills */
};

/* A cell of the lattice: indices of damping, frequency, drive, speed and tolerance. */
typedef struct cell {
  int damping, frequency, drive, speed, tolerance;
} cell;

typedef struct entry {
  cell key;
  int steps;
} entry;

struct pendres_steps_memo {
  entry *entries;
  size_t used, size;
};

pendres_status pendres_steps_create(pendres_steps_memo **out)
{
  *out = calloc(1, sizeof **out);
  return *out != NULL ? PENDRES_OK : PENDRES_OUT_OF_MEMORY;
}

void pendres_steps_free(pendres_steps_memo *memo)
{
  if (memo == NULL) return;
  free(memo->entries);
  free(memo);
}

int pendres_steps_rung(int n)
{
  int rung = FEWEST_STEPS;
  while (rung < n) {
    /* Multiples of 2 up to 24, then eight rungs an octave. */
    int octave = 1;
    while (octave * 16 <= rung) octave *= 2;
    rung += rung < 24 ? 2 : octave;
  }
  return rung;
}

/* Index of a logarithmic lattice of the given ratio; everything below `least` shares one cell. */
static int lattice(double value, double least, double ratio)
{
  if (!(value > least)) return 0;
  return 1 + (int)floor(log(value / least) / log(ratio));
}

static double lattice_upper(int index, double least, double ratio)
{
  return least * pow(ratio, index);
}

static const double damping_least = 0.05, damping_ratio = 1.25;
static const double frequency_least = 1e-4, frequency_ratio = 1.06;
static const double drive_least = 0.25, drive_ratio = 1.25;
static const double speed_least = 2.0, speed_ratio = 1.5;

static cell cell_of(const pendres_pendulum *p, double speed, double tolerance)
{
  return (cell){.damping = lattice(p->damping, damping_least, damping_ratio),
                .frequency = lattice(p->drive_frequency, frequency_least, frequency_ratio),
                .drive = lattice(fabs(p->drive_amplitude), drive_least, drive_ratio),
                .speed = lattice(speed, speed_least, speed_ratio),
                .tolerance = lattice(tolerance, 1e-18, 1.25)};
}

/* The corner of the cell that needs the most steps: a long period, strong drive, high speed. */
static void worst_of(const cell *c, pendres_pendulum *p, double *speed, double *tolerance)
{
  *p = (pendres_pendulum){
    .damping = lattice_upper(c->damping, damping_least, damping_ratio),
    .drive_frequency =
      c->frequency > 0 ? lattice_upper(c->frequency - 1, frequency_least, frequency_ratio) : 0.0,
    .drive_amplitude = lattice_upper(c->drive, drive_least, drive_ratio)};
  /* Up to the least damping the cell has none. */
  if (c->damping == 0) p->damping = 0.0;
  *speed = lattice_upper(c->speed, speed_least, speed_ratio);
  *tolerance = c->tolerance > 0 ? lattice_upper(c->tolerance - 1, 1e-18, 1.25) : 1e-18;
}

static void load_probe(pendres_flow *flow, size_t lane, int i, const pendres_pendulum *p,
                       double speed)
{
  /* Half start at rest over the well, half at the largest speed either way. */
  const int half = PROBES / 2, k = i % half;
  const double y = -2.75 + 5.5 * k / (half - 1);
  const double v = i < half ? 0.0 : (k % 2 == 0 ? speed : -speed);
  pendres_flow_set_lane(flow, lane, p, y, v / p->drive_frequency);
}

/* All probes over one period; end[2 i], end[2 i + 1] are y and w of probe i. */
static pendres_status run_probes(pendres_context *ctx, pendres_flow *flow,
                                 const pendres_pendulum *p, double speed, int steps,
                                 double end[2 * PROBES])
{
  const size_t capacity = pendres_flow_capacity(flow);
  pendres_status status = pendres_flow_set_steps(flow, steps);
  if (status != PENDRES_OK) return pendres_context_flow_failed(ctx, flow, status);
  for (size_t first = 0; first < PROBES; first += capacity) {
    const size_t lanes = PROBES - first < capacity ? PROBES - first : capacity;
    pendres_flow_resize(flow, lanes);
    for (size_t i = 0; i < lanes; i++) load_probe(flow, i, (int)(first + i), p, speed);
    status = pendres_flow_period(flow);
    if (status != PENDRES_OK) return pendres_context_flow_failed(ctx, flow, status);
    const double *state = pendres_flow_state(flow);
    for (size_t i = 0; i < lanes; i++) {
      end[2 * (first + i)] = state[i];
      end[2 * (first + i) + 1] = state[pendres_flow_stride(flow) + i];
    }
  }
  ctx->cost.pendulum_periods += PROBES;
  return PENDRES_OK;
}

/* Largest difference over the probes, in y and in v; infinite where a run left all bounds. */
static double difference(const double a[2 * PROBES], const double b[2 * PROBES])
{
  double largest = 0.0;
  for (int i = 0; i < 2 * PROBES; i++) {
    const double d = fabs(a[i] - b[i]);
    if (!(d <= largest)) largest = isnan(d) ? INFINITY : d;
  }
  return largest;
}

/* Least steps that resolve the drive's period, the pendulum's own and explicit stability. */
static double least_steps(const pendres_pendulum *p, double speed)
{
  const double two_pi = 6.28318530717958647693;
  const double period = two_pi / p->drive_frequency;
  /* The real stability interval of the order-8 tables is about 4 to 5. */
  return fmax(period * p->damping / 4.0, period * fmax(1.0, speed / 4.0) / 1.5);
}

static pendres_status probe(pendres_context *ctx, const cell *c, int *steps)
{
  pendres_flow *flow = NULL;
  pendres_pendulum p;
  double speed, tolerance, coarse[2 * PROBES], fine[2 * PROBES];
  const int order = pendres_table_order(ctx->options.table);

  worst_of(c, &p, &speed, &tolerance);
  if (p.drive_frequency == 0.0) goto too_slow;
  pendres_status status = pendres_context_flow(ctx, PENDRES_FLOW_STATE, &flow);
  if (status != PENDRES_OK) return status;

  double wanted = fmax(FEWEST_STEPS, least_steps(&p, speed)), last_error = INFINITY;
  while (wanted <= MOST_STEPS) {
    const int n = pendres_steps_rung((int)ceil(wanted));
    status = run_probes(ctx, flow, &p, speed, n, coarse);
    if (status == PENDRES_OK) status = run_probes(ctx, flow, &p, speed, 2 * n, fine);
    if (status != PENDRES_OK) return status;
    const double error = difference(coarse, fine);
    /* Where the error no longer falls it is rounding alone: more steps would not help. */
    const int rounding = error < 1e-9 && error > 0.5 * last_error;
    if (error <= tolerance || rounding) {
      *steps = n;
      return PENDRES_OK;
    }
    last_error = error;
    /* Not yet in the asymptotic regime: climb; there: go where the order says, one rung short. */
    const double growth =
      error < 1e-2 ? pow(error / tolerance, 1.0 / order) * 0.95 : 1.5;
    wanted = n * fmax(1.01, fmin(growth, 4.0));
  }
too_slow:
  return pendres_context_fail(
    ctx, PENDRES_TOLERANCE_UNREACHABLE,
    "damping %g at drive frequency %g needs more than %d explicit steps a period: "
    "use method cvode_bdf, or a looser tolerance",
    p.damping, p.drive_frequency, MOST_STEPS);
}

static int same_cell(const cell *a, const cell *b)
{
  return a->damping == b->damping && a->frequency == b->frequency && a->drive == b->drive &&
         a->speed == b->speed && a->tolerance == b->tolerance;
}

static pendres_status remember(pendres_context *ctx, const cell *key, int steps)
{
  pendres_steps_memo *m = ctx->steps;
  if (m->used == m->size) {
    const size_t size = m->size > 0 ? 2 * m->size : FIRST_SIZE;
    entry *entries = realloc(m->entries, size * sizeof *entries);
    if (entries == NULL)
      return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for the step memo");
    m->entries = entries;
    m->size = size;
  }
  m->entries[m->used++] = (entry){.key = *key, .steps = steps};
  return PENDRES_OK;
}

pendres_status pendres_steps_choose(pendres_context *ctx, const pendres_pendulum *p, double speed,
                                    double tolerance, int *steps)
{
  if (ctx->options.steps_per_period > 0) {
    *steps = ctx->options.steps_per_period;
    return PENDRES_OK;
  }
  const cell key = cell_of(p, speed, tolerance);
  const pendres_steps_memo *m = ctx->steps;
  /* The latest cells first: neighbours in a list of pendulums share a cell. */
  for (size_t i = m->used; i-- > 0;)
    if (same_cell(&m->entries[i].key, &key)) {
      *steps = m->entries[i].steps;
      return PENDRES_OK;
    }
  int chosen = 0;
  pendres_status status = probe(ctx, &key, &chosen);
  if (status == PENDRES_OK) status = remember(ctx, &key, chosen);
  if (status == PENDRES_OK) *steps = chosen;
  return status;
}
