/* steps.c -- how many fixed steps a drive period needs; see steps.h. */
#include "engine/steps.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angles.h"
#include "base/grow.h"
#include "engine/context_internal.h"
#include "engine/block.h"
#include "engine/numbers.h"
#include "engine/kernels/tables.h"
#include "model/equation.h"

int pendres_steps_rung(int n)
{
  int rung = STEPS_FEWEST;
  while (rung < n) {
    /* Multiples of 2 up to 24, then eight rungs an octave. */
    int octave = 1;
    while (octave * 16 <= rung) octave *= 2;
    rung += rung < 24 ? 2 : octave;
  }
  return rung;
}

int pendres_steps_rung_of_few(int n)
{
  int rung = STEPS_FEWEST_OF_FEW;
  while (rung < n) rung += (rung & (rung - 1)) == 0 ? rung / 2 : rung / 3;
  return rung;
}

int pendres_steps_finer(const pendres_pendulum *p, int n)
{
  const double times = p->quadratic_damping != 0.0 ? finer_steps_bent : finer_steps;
  return pendres_steps_rung((int)ceil(times * n));
}

/* Index of a logarithmic lattice of the given ratio; everything below `least` shares one cell. */
static int lattice(double value, double least, double ratio)
{
  if (!(value > least)) return 0;
  return 1 + (int)floor(log(fmin(value / least, DBL_MAX)) / log(ratio));
}

static double lattice_upper(int index, double least, double ratio)
{
  return least * pow(ratio, index);
}

/* The index of a term that most pendulums do not have; -1 if it is 0. */
static int lattice_or_none(double value)
{
  return value != 0.0 ? lattice(fabs(value), lattice_drive, lattice_ratio) : -1;
}

static double lattice_or_none_upper(int index)
{
  return index >= 0 ? lattice_upper(index, lattice_drive, lattice_ratio) : 0.0;
}

/* The terms that most pendulums do not have. */
#define TERMS(p) {&(p)->torque, &(p)->parametric_amplitude, &(p)->nonlinear_damping, \
                  &(p)->quadratic_damping, &(p)->cubic_damping}
enum { TERM_COUNT = 5 };

/* A cell of the lattice: indices of damping, frequency, drive, speed, tolerance and terms (-1:
   none); and the pendulum with all that is no index, as it is. */
typedef struct cell {
  int damping, frequency, drive, speed, tolerance, term[TERM_COUNT];
  pendres_pendulum rest;
} cell;

static cell cell_of(const pendres_pendulum *p, double speed, double tolerance)
{
  cell c = {.damping = lattice(p->damping, lattice_damping, lattice_ratio),
            .frequency = lattice(p->drive_frequency, lattice_frequency, lattice_frequency_ratio),
            .drive = lattice(fabs(p->drive_amplitude), lattice_drive, lattice_ratio),
            .speed = lattice(speed, lattice_speed, lattice_speed_ratio),
            .tolerance = lattice(tolerance, lattice_tolerance, lattice_ratio),
            .rest = *p};
  double *const term[TERM_COUNT] = TERMS(&c.rest);
  c.rest.damping = c.rest.drive_frequency = c.rest.drive_amplitude = c.rest.temperature = 0.0;
  for (int i = 0; i < TERM_COUNT; i++) {
    c.term[i] = lattice_or_none(*term[i]);
    *term[i] = 0.0;
  }
  return c;
}

/* The corner of the cell that needs the most steps: a long period, strong drive, high speed. */
static void worst_of(const cell *c, pendres_pendulum *p, double *speed, double *tolerance)
{
  *p = c->rest;
  /* Below the least damping the corner of the cell has none. */
  if (c->damping > 0) p->damping = lattice_upper(c->damping, lattice_damping, lattice_ratio);
  if (c->frequency > 0)
    p->drive_frequency =
      lattice_upper(c->frequency - 1, lattice_frequency, lattice_frequency_ratio);
  p->drive_amplitude = lattice_upper(c->drive, lattice_drive, lattice_ratio);
  double *const term[TERM_COUNT] = TERMS(p);
  for (int i = 0; i < TERM_COUNT; i++) *term[i] = lattice_or_none_upper(c->term[i]);
  *speed = lattice_upper(c->speed, lattice_speed, lattice_speed_ratio);
  *tolerance = lattice_tolerance;
  if (c->tolerance > 0)
    *tolerance = lattice_upper(c->tolerance - 1, lattice_tolerance, lattice_ratio);
}

/* ---- the scale of a force whose coordinate has no period ---- */

static int open_ended(const pendres_pendulum *p)
{
  return !(pendres_model_of(p->force)->period > 0.0);
}

/* The largest distance that a speed can lead to, if all terms of the force had the same sign. */
static double reach_of(const pendres_pendulum *p, double speed)
{
  const double edge = pendres_model_edge(p);
  const double energy = 0.5 * speed * speed;
  double low = 0.0, high = 1.0;
  while (pendres_model_climb(p, high) < energy && high < pendres_farthest) high *= 2.0;
  for (int i = 0; i < 60; i++) {
    const double middle = 0.5 * (low + high);
    if (pendres_model_climb(p, middle) < energy) low = middle;
    else high = middle;
  }
  return fmin(high, edge);
}

/* The frequency of oscillations as fast as the stiffest spring up to `reach`, parametric drive and
   all; where the coordinate has a period the reach is that. Where the force goes up and down along
   the coordinate a fast pendulum feels that as fast as it moves. */
static double pace_of(const pendres_pendulum *p, double speed, double reach)
{
  const double modulation = 1.0 + fabs(p->parametric_amplitude);
  if (p->force == PENDRES_FORCE_PENDULUM) return sqrt(modulation) * fmax(1.0, speed / probe_fast);
  const double stiffest = pendres_model_stiffest(p, open_ended(p) ? reach : PENDRES_PI);
  const double pace = sqrt(modulation * stiffest);
  if (!open_ended(p)) return pace * fmax(1.0, speed / probe_fast);
  return pendres_model_of(p->force)->angle ? fmax(pace, speed / probe_fast) : pace;
}

double pendres_steps_speed(const pendres_pendulum *p, double x, double v)
{
  if (!open_ended(p)) return fabs(v);
  /* At resonance a drive may lead to a speed that is limited by friction; beyond some speed the
     oscillation gets out of phase instead. */
  const double driven = fmin(probe_fast, pendres_equation_speed(p, p->drive_amplitude));
  return fmax(driven, sqrt(fma(v, v, 2.0 * pendres_model_climb(p, x - pendres_model_origin(p)))));
}

double pendres_steps_turning_speed(const pendres_pendulum *p)
{
  const double least = pendres_equation_least_drag(p);
  const double driven = fabs(p->drive_amplitude) / hypot(p->drive_frequency, least);
  return 2.0 + driven + pendres_equation_speed(p, p->torque);
}

/* ---- probes ---- */

/* What is probed, computed once: the distance that the speed leads to takes many values of the
   force. */
typedef struct probed {
  pendres_pendulum pendulum;
  double speed, reach, pace;
} probed;

static void load_probe(pendres_block *b, size_t lane, int i, const probed *of)
{
  /* Half start at rest over the well, half at the largest speed either way. */
  const int half = PROBES / 2, k = i % half;
  const double y = -of->reach + 2.0 * of->reach * k / (half - 1);
  const double v = i < half ? 0.0 : (k % 2 == 0 ? of->speed : -of->speed);
  pendres_block_load(b, lane, &of->pendulum, y, v / of->pendulum.drive_frequency);
}

/*
 * What is seen of the probes: their states at `dense` equally spaced points, and at the period's
 * end. The growth of an error of the start, the largest entry of the derivative of (y, v), is taken
 * from the finer run only.
 */
typedef struct sight {
  int steps, stride, dense, points;
  int growing;
  double edge; /* near a pole of the force: what gets beyond leaves */
  int unbound; /* probes may be on their way to infinity: what is wild from the start is left out */
  size_t first, lanes; /* probes in the block */
  double omega, rate; /* of the drive, and of the unit of time in which errors grow */
  double y[PROBE_POINTS][PROBES], v[PROBE_POINTS][PROBES], growth[PROBE_POINTS][PROBES];
} sight;

static sight sight_of(const probed *of, int steps, int stride, int growing)
{
  const double omega = of->pendulum.drive_frequency;
  const int unbound = open_ended(&of->pendulum);
  sight s = {.steps = steps, .stride = stride, .growing = growing, .unbound = unbound,
             .edge = pendres_model_edge(&of->pendulum),
             .omega = omega, .rate = unbound ? omega / of->pace : omega};
  s.dense = steps / stride < PROBE_POINTS - 1 ? steps / stride : PROBE_POINTS - 1;
  s.points = s.dense + (s.dense * stride < steps);
  return s;
}

/* Steps in half a unit of time, in which errors grow by no more than e^(1/2). */
static int stride_of(const probed *of, int steps)
{
  double period = two_pi / of->pendulum.drive_frequency;
  if (open_ended(&of->pendulum)) period *= of->pace;
  return (int)fmax(1.0, fmin(steps, floor(0.5 * steps / period)));
}

static void look(void *arg, int step, const pendres_rows *rows)
{
  sight *s = arg;
  int k = s->points - 1;
  if (step % s->stride == 0 && step / s->stride <= s->dense) k = step / s->stride - 1;
  else if (step < s->steps) return;
  for (size_t i = 0; i < s->lanes; i++) {
    double *growth = &s->growth[k][s->first + i];
    s->y[k][s->first + i] = pendres_rows_get(rows, PENDRES_ROW_Y, i);
    s->v[k][s->first + i] = s->omega * pendres_rows_get(rows, PENDRES_ROW_W, i);
    if (!s->growing) continue;
    double m[2][2];
    pendres_rows_tangent(rows, i, m);
    *growth = fmax(fabs(m[0][0]), fabs(m[1][1]));
    *growth = fmax(*growth, s->rate * fabs(m[1][0]));
    *growth = fmax(*growth, fabs(m[0][1]) / s->rate);
  }
}

/* All probes over one period, with the points on the way. A cell is probed once, by the first of
   the context's computations that needs it. */
static pendres_status run_probes(pendres_context *ctx, const probed *of, sight *s)
{
  pendres_block *b;
  pendres_status status = pendres_block_open(
    ctx, s->growing ? PENDRES_FLOW_VARIATIONAL : PENDRES_FLOW_STATE, s->steps, &b);
  if (status != PENDRES_OK) return status;
  const size_t capacity = pendres_block_capacity(b);
  const pendres_uncounted work = pendres_uncounted_begin(ctx);
  for (s->first = 0; s->first < PROBES && status == PENDRES_OK; s->first += capacity) {
    s->lanes = PROBES - s->first < capacity ? PROBES - s->first : capacity;
    pendres_block_resize(b, s->lanes);
    for (size_t i = 0; i < s->lanes; i++) load_probe(b, i, (int)(s->first + i), of);
    status = pendres_block_period_sampled(b, look, s);
  }
  pendres_uncounted_end(ctx, &work);
  return status;
}

/*
 * Error of probe i over the period: the largest difference up to the point at which errors have
 * grown `wild`, as if the rest added as much per unit of time. A larger number of steps does not
 * help against the growth of errors of such a pendulum, and is not required.
 */
static double probe_error(const sight *coarse, const sight *fine, size_t i)
{
  double largest = 0.0;
  int k = 0;
  for (; k < coarse->points; k++) {
    if ((k > 0 || coarse->unbound) && !(fine->growth[k][i] <= probe_wild)) break;
    const double dy = fabs(coarse->y[k][i] - fine->y[k][i]);
    const double dv = fabs(coarse->v[k][i] - fine->v[k][i]);
    if (isfinite(coarse->edge) && !(fabs(fine->y[k][i]) <= coarse->edge)) break; /* it left */
    if (!(dy + dv < INFINITY)) return INFINITY;
    largest = fmax(largest, fmax(dy, dv));
  }
  if (k == 0) return 0.0; /* on its way to infinity from the start */
  return k == coarse->points ? largest : largest * coarse->steps / ((double)k * coarse->stride);
}

static double largest_error(const sight *coarse, const sight *fine)
{
  double largest = 0.0;
  for (size_t i = 0; i < PROBES; i++) largest = fmax(largest, probe_error(coarse, fine, i));
  return largest;
}

/* Least steps that resolve the drive's period, the pendulum's own and explicit stability. */
static double least_steps(const probed *of)
{
  const double period = two_pi / of->pendulum.drive_frequency;
  const double drag = pendres_equation_most_drag(&of->pendulum, of->reach, of->speed);
  return fmax(period * drag / step_stable, period * of->pace / step_longest);
}

/* With a drive that moves a pendulum this far in a period there are less than two steps a turn. */
static int shaken(const pendres_pendulum *p)
{
  const double push = fabs(p->drive_amplitude) + fabs(p->torque);
  const double speed = push / fmax(p->drive_frequency, pendres_equation_least_drag(p));
  return speed / p->drive_frequency > 0.5 * PENDRES_MOST_STEPS;
}

/* PENDRES_TOLERANCE_UNREACHABLE, without a message: PENDRES_MOST_STEPS are too few. */
static pendres_status probe(pendres_context *ctx, const cell *c, int *steps)
{
  probed of;
  const pendres_pendulum *const p = &of.pendulum;
  double tolerance;
  int order = pendres_tables_order(ctx->options.table);

  worst_of(c, &of.pendulum, &of.speed, &tolerance);
  if (p->drive_frequency == 0.0 || shaken(p)) return PENDRES_TOLERANCE_UNREACHABLE;
  if (p->quadratic_damping != 0.0) order = ORDER_BENT;
  of.reach = open_ended(p) ? reach_of(p, of.speed) : probe_reach;
  of.pace = pace_of(p, of.speed, of.reach);
  /* Of what leads far out rounding is larger. */
  const double far = open_ended(p) ? fmax(1.0, of.speed / probe_fast) : 1.0;
  double wanted = fmax(STEPS_FEWEST, least_steps(&of)), last_error = INFINITY;
  while (wanted <= PENDRES_MOST_STEPS) {
    const int n = pendres_steps_rung((int)ceil(wanted));
    const int stride = stride_of(&of, n);
    sight coarse = sight_of(&of, n, stride, 0), fine = sight_of(&of, 2 * n, 2 * stride, 1);
    pendres_status status = run_probes(ctx, &of, &coarse);
    if (status == PENDRES_OK) status = run_probes(ctx, &of, &fine);
    if (status != PENDRES_OK) return status;
    const double error = largest_error(&coarse, &fine);
    const int rounding = error < probe_rounding * far && error > 0.5 * last_error;
    if (error <= tolerance || rounding) {
      *steps = n;
      return PENDRES_OK;
    }
    last_error = error;
    const double growth = error < probe_regular
                            ? probe_less * pow(error / tolerance, 1.0 / order)
                            : probe_more;
    /* The next rung at least. */
    wanted = fmax(n + 1.0, n * fmin(growth, probe_most));
  }
  return PENDRES_TOLERANCE_UNREACHABLE;
}

/* Why a pendulum needs too many steps: the friction's stability, a fast start, or the drive. */
static pendres_status too_many(pendres_context *ctx, const cell *c, const pendres_pendulum *p,
                               double speed)
{
  pendres_pendulum worst;
  double fastest, tolerance;
  const double drag = pendres_equation_most_drag(p, reach_of(p, speed), speed);
  worst_of(c, &worst, &fastest, &tolerance);
  const char *why = "the drive frequency at this tolerance";
  if (worst.drive_frequency > 0.0 && shaken(&worst)) why = "the drive amplitude";
  else if (fmax(drag, speed / probe_fast) > 2.0)
    why = drag > speed / probe_fast ? "the damping" : "the speed";
  else if (fabs(p->drive_amplitude) > 2.0) why = "the drive amplitude at this tolerance";
  return pendres_context_fail(
    ctx, PENDRES_TOLERANCE_UNREACHABLE,
    "damping %g, drive amplitude %g, drive frequency %g, speed %g: %s needs more than %d explicit "
    "steps a period. A looser tolerance may do, and method cvode_bdf advances such pendulums "
    "(pendres_strobe_advance); orbits and labels need explicit steps",
    p->damping, p->drive_amplitude, p->drive_frequency, speed, why, PENDRES_MOST_STEPS);
}

/* ---- The steps that were chosen for cells ---------------------------------------------------- */

typedef struct entry {
  cell of;
  int steps; /* more than PENDRES_MOST_STEPS: these are too few */
} entry;

struct pendres_steps_memo {
  entry *entries;
  size_t used, size;
  /* What was asked last: of most pendulums that are asked for in a row the speed alone differs. */
  pendres_pendulum pendulum;
  double tolerance; /* 0: nothing was asked */
  cell last;
};

pendres_status pendres_steps_memo_create(pendres_steps_memo **out)
{
  *out = calloc(1, sizeof **out);
  return *out != NULL ? PENDRES_OK : PENDRES_OUT_OF_MEMORY;
}

void pendres_steps_memo_free(pendres_steps_memo *memo)
{
  if (memo == NULL) return;
  free(memo->entries);
  free(memo);
}

static int same(const cell *a, const cell *b)
{
  return a->damping == b->damping && a->frequency == b->frequency && a->drive == b->drive &&
         a->speed == b->speed && a->tolerance == b->tolerance &&
         memcmp(a->term, b->term, sizeof a->term) == 0 && pendres_model_same(&a->rest, &b->rest);
}

/* The steps of a cell, 0 if they are not known. */
static int find_steps(const pendres_steps_memo *memo, const cell *c)
{
  /* The latest cells first: neighbours in a list of pendulums share a cell. */
  for (size_t i = memo->used; i-- > 0;)
    if (same(&memo->entries[i].of, c)) return memo->entries[i].steps;
  return 0;
}

static pendres_status keep_steps(pendres_steps_memo *memo, const cell *c, int steps)
{
  entry *entries = pendres_grow(memo->entries, memo->used, &memo->size, sizeof *entries);
  if (entries == NULL) return PENDRES_OUT_OF_MEMORY;
  memo->entries = entries;
  memo->entries[memo->used++] = (entry){.of = *c, .steps = steps};
  return PENDRES_OK;
}

/* The cell of a pendulum at a speed. */
static cell look_up(pendres_steps_memo *memo, const pendres_pendulum *p, double speed,
                    double tolerance)
{
  if (memo->tolerance != tolerance || memcmp(&memo->pendulum, p, sizeof *p) != 0) {
    memo->pendulum = *p;
    memo->tolerance = tolerance;
    memo->last = cell_of(p, speed, tolerance);
  }
  memo->last.speed = lattice(speed, lattice_speed, lattice_speed_ratio);
  return memo->last;
}

/* ---- The choice ------------------------------------------------------------------------------ */

pendres_status pendres_steps_choose(pendres_context *ctx, const pendres_pendulum *p, double speed,
                                    double tolerance, int *steps)
{
  if (ctx->options.steps_per_period > 0) {
    *steps = ctx->options.steps_per_period;
    return PENDRES_OK;
  }
  const cell key = look_up(ctx->steps, p, speed, tolerance);
  pendres_status status = PENDRES_OK;
  int chosen = find_steps(ctx->steps, &key);
  if (chosen == 0) {
    status = probe(ctx, &key, &chosen);
    if (status == PENDRES_TOLERANCE_UNREACHABLE) chosen = PENDRES_MOST_STEPS + 1;
    else if (status != PENDRES_OK) return status;
    status = keep_steps(ctx->steps, &key, chosen);
    if (status != PENDRES_OK)
      return pendres_context_fail(ctx, status, "out of memory for the step memo");
  }
  if (chosen > PENDRES_MOST_STEPS) return too_many(ctx, &key, p, speed);
  *steps = chosen;
  return status;
}
