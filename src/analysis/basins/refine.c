/*
 * refine.c -- which states of a grid must be integrated to know all; see basin.h.
 *
 * Owns: the plan and its stages. A plan never integrates: it hands out numbers of states and takes
 * over their outcomes, so that any number of threads can work between two calls.
 */
#include <pendres/basin.h>

#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/mix.h"

/* What is known of a state; UNSURE: integrated, but it may belong elsewhere. */
typedef enum knowledge { UNKNOWN, FILLED, ASKED, INTEGRATED, UNSURE } knowledge;

typedef enum stage { STAGE_CELLS, STAGE_SCAN, STAGE_FOLLOW } stage;

/* Corners (top, left) and (bottom, right), both included. */
typedef struct cell {
  uint32_t top, bottom, left, right;
} cell;

/* Where a state goes, which is the same all over a basin. */
typedef struct fate {
  int32_t well;
  int16_t attractor;
  int8_t label;
} fate;

struct pendres_basin_plan {
  size_t first, rows, nv;
  size_t stride;         /* of the lattice of states that are integrated everywhere */
  stage stage;
  uint16_t *fate_of;     /* of each state, an index of fates */
  uint8_t *knowledge;
  int32_t *periods;
  fate *fates;
  size_t fate_count, fate_capacity;
  cell *cells;           /* of the present level */
  size_t cell_count, cell_capacity;
  size_t *queue;         /* numbers in the grid; what was asked for, and being collected */
  size_t queued, queue_capacity;
  int asked;             /* the queue has been handed out */
  size_t integrated;
};

static size_t offset_of(const pendres_basin_plan *p)
{
  return p->first * p->nv;
}

/* Ask for a state of these rows, unless it has been integrated or asked for. */
static int ask(pendres_basin_plan *p, size_t k)
{
  if (p->knowledge[k] >= ASKED) return 0;
  size_t *queue = pendres_grow(p->queue, p->queued, &p->queue_capacity, sizeof *queue);
  if (queue == NULL) return -1;
  p->queue = queue;
  p->knowledge[k] = ASKED;
  p->queue[p->queued++] = offset_of(p) + k;
  return 0;
}

static int ask_at(pendres_basin_plan *p, size_t row, size_t column)
{
  return ask(p, row * p->nv + column);
}

static int add_cell(pendres_basin_plan *p, size_t top, size_t bottom, size_t left, size_t right)
{
  cell *cells = pendres_grow(p->cells, p->cell_count, &p->cell_capacity, sizeof *cells);
  if (cells == NULL) return -1;
  p->cells = cells;
  p->cells[p->cell_count++] = (cell){.top = (uint32_t)top, .bottom = (uint32_t)bottom,
                                     .left = (uint32_t)left, .right = (uint32_t)right};
  return 0;
}

/* Next line of the lattice: multiples of the stride, and the last one. */
static size_t next_line(size_t line, size_t stride, size_t count)
{
  return line + stride < count - 1 ? line + stride : count - 1;
}

static int coarse_lattice(pendres_basin_plan *p)
{
  const size_t stride = p->stride;
  for (size_t i = 0;; i = next_line(i, stride, p->rows)) {
    for (size_t j = 0;; j = next_line(j, stride, p->nv)) {
      if (ask_at(p, i, j) != 0) return -1;
      if (i + 1 < p->rows || p->rows == 1)
        if ((j + 1 < p->nv || p->nv == 1) &&
            add_cell(p, i, next_line(i, stride, p->rows), j, next_line(j, stride, p->nv)) != 0)
          return -1;
      if (j == p->nv - 1) break;
    }
    if (i == p->rows - 1) break;
  }
  return 0;
}

pendres_status pendres_basin_plan_create(const pendres_basin_grid *grid, size_t first, size_t rows,
                                         int stride, pendres_basin_plan **out)
{
  enum { STRIDE = 16, WIDEST = 1024 };
  if (out == NULL) return PENDRES_INVALID_ARGUMENT;
  *out = NULL;
  if (stride == 0) stride = STRIDE;
  if (grid == NULL || grid->nv < 1 || rows < 1 || first > grid->nx || rows > grid->nx - first ||
      grid->nv > UINT32_MAX || rows > UINT32_MAX || stride < 1 || stride > WIDEST ||
      (stride & (stride - 1)) != 0)
    return PENDRES_INVALID_ARGUMENT;
  pendres_basin_plan *p = calloc(1, sizeof *p);
  if (p == NULL) return PENDRES_OUT_OF_MEMORY;
  const size_t n = rows * grid->nv;
  *p = (pendres_basin_plan){.first = first, .rows = rows, .nv = grid->nv,
                              .stride = (size_t)stride};
  p->fate_of = calloc(n, sizeof *p->fate_of);
  p->knowledge = calloc(n, sizeof *p->knowledge);
  p->periods = calloc(n, sizeof *p->periods);
  if (p->fate_of == NULL || p->knowledge == NULL || p->periods == NULL ||
      coarse_lattice(p) != 0) {
    pendres_basin_plan_free(p);
    return PENDRES_OUT_OF_MEMORY;
  }
  *out = p;
  return PENDRES_OK;
}

void pendres_basin_plan_free(pendres_basin_plan *plan)
{
  if (plan == NULL) return;
  free(plan->fate_of);
  free(plan->knowledge);
  free(plan->periods);
  free(plan->fates);
  free(plan->cells);
  free(plan->queue);
  free(plan);
}

/* ---- taking over what states are ---- */

/* Number of a fate; UINT16_MAX: out of memory, or of numbers. */
static uint16_t number_of(pendres_basin_plan *p, const pendres_basin_state *s)
{
  for (size_t i = p->fate_count; i-- > 0;)
    if (p->fates[i].attractor == s->attractor && p->fates[i].well == s->well) return (uint16_t)i;
  if (p->fate_count == UINT16_MAX) return UINT16_MAX;
  fate *fates = pendres_grow(p->fates, p->fate_count, &p->fate_capacity, sizeof *fates);
  if (fates == NULL) return UINT16_MAX;
  p->fates = fates;
  p->fates[p->fate_count] =
    (fate){.well = s->well, .attractor = s->attractor, .label = s->label};
  return (uint16_t)p->fate_count++;
}

static int take(pendres_basin_plan *p, size_t k, const pendres_basin_state *s)
{
  const uint16_t number = number_of(p, s);
  if (number == UINT16_MAX) return -1;
  p->fate_of[k] = number;
  p->periods[k] = s->settling_periods;
  p->knowledge[k] = s->how == PENDRES_BASIN_UNCERTAIN ? UNSURE : INTEGRATED;
  p->integrated++;
  return 0;
}

/* ---- cells ---- */

static int corners_alike(const pendres_basin_plan *p, const cell *c)
{
  const uint16_t *top = p->fate_of + (size_t)c->top * p->nv;
  const uint16_t *bottom = p->fate_of + (size_t)c->bottom * p->nv;
  return top[c->left] == top[c->right] && top[c->left] == bottom[c->left] &&
         top[c->left] == bottom[c->right];
}

static void fill_cell(pendres_basin_plan *p, const cell *c)
{
  const uint16_t fate = p->fate_of[(size_t)c->top * p->nv + c->left];
  for (size_t i = c->top; i <= c->bottom; i++)
    for (size_t j = c->left; j <= c->right; j++) {
      const size_t k = i * p->nv + j;
      if (p->knowledge[k] != UNKNOWN) continue;
      p->knowledge[k] = FILLED;
      p->fate_of[k] = fate;
    }
}

static size_t middle(size_t a, size_t b)
{
  return a + (b - a) / 2;
}

/* Divide a cell into up to four parts, and ask for their new corners. */
static int halve_cell(pendres_basin_plan *p, cell c)
{
  const size_t row[3] = {c.top, middle(c.top, c.bottom), c.bottom};
  const size_t column[3] = {c.left, middle(c.left, c.right), c.right};
  if (c.bottom - c.top < 2 && c.right - c.left < 2) return 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      if (ask_at(p, row[i], column[j]) != 0) return -1;
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      const size_t high = row[i + 1] - row[i], wide = column[j + 1] - column[j];
      /* Parts without extent only where the cell has none: a grid of one row or column. */
      if (high == 0 && (c.bottom > c.top || i > 0)) continue;
      if (wide == 0 && (c.right > c.left || j > 0)) continue;
      if (add_cell(p, row[i], row[i + 1], column[j], column[j + 1]) != 0) return -1;
    }
  return 0;
}

static int next_cells(pendres_basin_plan *p)
{
  cell *old = p->cells;
  const size_t count = p->cell_count;
  int bad = 0;
  p->cells = NULL;
  p->cell_count = p->cell_capacity = 0;
  for (size_t i = 0; i < count && !bad; i++) {
    if (corners_alike(p, &old[i]))
      fill_cell(p, &old[i]);
    else
      bad = halve_cell(p, old[i]);
  }
  free(old);
  return bad ? -1 : 0;
}

/* ---- following the boundary ---- */

/* Ask for the filled neighbours of state k that are unlike it. */
static int ask_unlike(pendres_basin_plan *p, size_t k)
{
  const size_t row = k / p->nv, column = k % p->nv;
  const size_t top = row > 0 ? row - 1 : 0, bottom = row + 1 < p->rows ? row + 1 : row;
  const size_t left = column > 0 ? column - 1 : 0, right = column + 1 < p->nv ? column + 1 : column;
  for (size_t i = top; i <= bottom; i++)
    for (size_t j = left; j <= right; j++) {
      const size_t m = i * p->nv + j;
      if (p->knowledge[m] == FILLED && p->fate_of[m] != p->fate_of[k] && ask(p, m) != 0) return -1;
    }
  return 0;
}

/* Mark the columns of a row at which it differs from the rows above and below, or from the next
   column. */
static void find_edges(const pendres_basin_plan *p, size_t row, uint8_t *edge)
{
  const uint16_t *here = p->fate_of + row * p->nv;
  const uint16_t *above = row > 0 ? here - p->nv : here;
  const uint16_t *below = row + 1 < p->rows ? here + p->nv : here;
  const size_t n = p->nv; /* bytes that are written might be anything, also p's */
  for (size_t j = 0; j < n; j++) edge[j] = (here[j] != above[j]) | (here[j] != below[j]);
  for (size_t j = 0; j + 1 < n; j++) edge[j] |= here[j] != here[j + 1];
}

/* Ask for states around those that differ from a neighbour; most states differ from none. */
static int scan(pendres_basin_plan *p)
{
  int bad = 0;
  uint8_t *edge = malloc(p->nv + 1);
  if (edge == NULL) return -1;
  edge[p->nv] = 0;
  for (size_t i = 0; i < p->rows && !bad; i++) {
    find_edges(p, i, edge);
    for (size_t j = 0; j < p->nv && !bad; j++) {
      const size_t k = i * p->nv + j;
      if ((edge[j] | edge[j + 1] | edge[j > 0 ? j - 1 : 0]) != 0 && p->knowledge[k] != ASKED)
        bad = ask_unlike(p, k) != 0;
    }
  }
  free(edge);
  return bad ? -1 : 0;
}

/* ---- what was filled in wrongly ---- */

/* Ask for all that was filled in around state k, as far as the lattice is wide. */
static int ask_around(pendres_basin_plan *p, size_t k)
{
  const size_t row = k / p->nv, column = k % p->nv, far = p->stride;
  const size_t top = row > far ? row - far : 0, left = column > far ? column - far : 0;
  const size_t bottom = row + far < p->rows ? row + far : p->rows - 1;
  const size_t right = column + far < p->nv ? column + far : p->nv - 1;
  for (size_t i = top; i <= bottom; i++)
    for (size_t j = left; j <= right; j++)
      if (ask_at(p, i, j) != 0) return -1;
  return 0;
}

/* Halve the width of the lattice everywhere: where one piece of a basin slipped through it, others
   may have. */
static int finer_lattice(pendres_basin_plan *p)
{
  if (p->stride > 1) p->stride /= 2;
  for (size_t i = 0; i < p->rows; i += p->stride)
    for (size_t j = 0; j < p->nv; j += p->stride)
      if (ask_at(p, i, j) != 0) return -1;
  return 0;
}

/* ---- stages ---- */

pendres_status pendres_basin_plan_next(pendres_basin_plan *p, size_t *n, const size_t **index)
{
  if (p == NULL || n == NULL || index == NULL) return PENDRES_INVALID_ARGUMENT;
  while (p->queued == 0 && p->stage != STAGE_FOLLOW) {
    int bad = 0;
    if (p->stage == STAGE_CELLS && p->cell_count > 0) {
      bad = next_cells(p);
    } else if (p->stage == STAGE_CELLS) {
      p->stage = STAGE_SCAN;
    } else {
      bad = scan(p);
      p->stage = STAGE_FOLLOW;
    }
    if (bad) return PENDRES_OUT_OF_MEMORY;
  }
  *n = p->queued;
  *index = p->queue;
  p->asked = p->queued > 0;
  return PENDRES_OK;
}

/* Whether a state of a sample goes where what had been filled in says. */
static int is_as_filled(const pendres_basin_plan *p, size_t k, const pendres_basin_state *state)
{
  const fate *f = &p->fates[p->fate_of[k]];
  return f->attractor == state->attractor && f->well == state->well;
}

/* Take over the outcomes of the queue. More states are asked for around those that differ from
   their surroundings, and around those that a sample shows to have been filled in wrongly. */
static pendres_status accept(pendres_basin_plan *p, const pendres_basin_state *state,
                             size_t *missed)
{
  const size_t n = p->queued;
  size_t *done = p->queue;
  int bad = 0;
  if (!p->asked || (n > 0 && state == NULL)) return PENDRES_INVALID_ARGUMENT;
  p->queue = NULL;
  p->queued = p->queue_capacity = 0;
  p->asked = 0;
  for (size_t i = 0; i < n && !bad; i++) {
    const size_t k = done[i] - offset_of(p);
    const int right = missed != NULL && is_as_filled(p, k, &state[i]);
    if (right && state[i].how != PENDRES_BASIN_UNCERTAIN)
      p->knowledge[k] = FILLED; /* as before: a sample is not to be seen in what is stored */
    else
      bad = take(p, k, &state[i]) != 0;
    if (missed != NULL && !right && !bad) done[(*missed)++] = done[i]; /* done with those before */
  }
  for (size_t i = 0; i < n && missed == NULL && p->stage == STAGE_FOLLOW && !bad; i++)
    bad = ask_unlike(p, done[i] - offset_of(p)) != 0;
  for (size_t i = 0; missed != NULL && i < *missed && !bad; i++)
    bad = ask_around(p, done[i] - offset_of(p)) != 0;
  if (missed != NULL && *missed > 0 && !bad) bad = finer_lattice(p) != 0;
  free(done);
  return bad ? PENDRES_OUT_OF_MEMORY : PENDRES_OK;
}

pendres_status pendres_basin_plan_accept(pendres_basin_plan *plan, const pendres_basin_state *state)
{
  return plan != NULL ? accept(plan, state, NULL) : PENDRES_INVALID_ARGUMENT;
}

pendres_status pendres_basin_plan_sample(pendres_basin_plan *p, size_t n, uint64_t seed,
                                         size_t *drawn, const size_t **index)
{
  if (p == NULL || drawn == NULL || index == NULL || p->stage != STAGE_FOLLOW || p->queued > 0)
    return PENDRES_INVALID_ARGUMENT;
  const size_t states = p->rows * p->nv;
  /* Where few states were filled in, most draws miss them: there is a limit to the draws. */
  for (uint64_t draw = 0; p->queued < n && draw < 100 * (uint64_t)n; draw++) {
    const size_t k = (size_t)(pendres_mix(pendres_mix(seed) + draw) % states);
    if (p->knowledge[k] == FILLED && ask(p, k) != 0) return PENDRES_OUT_OF_MEMORY;
  }
  *drawn = p->queued;
  *index = p->queue;
  p->asked = 1;
  return PENDRES_OK;
}

pendres_status pendres_basin_plan_verify(pendres_basin_plan *p, const pendres_basin_state *state,
                                         size_t *missed)
{
  if (p == NULL || missed == NULL) return PENDRES_INVALID_ARGUMENT;
  *missed = 0;
  return accept(p, state, missed);
}

pendres_status pendres_basin_plan_rows(const pendres_basin_plan *p, size_t first, size_t rows,
                                       pendres_basin_state *state)
{
  if (p == NULL || state == NULL || p->queued > 0 || p->stage != STAGE_FOLLOW ||
      first > p->rows || rows > p->rows - first)
    return PENDRES_INVALID_ARGUMENT;
  const size_t at = first * p->nv, n = rows * p->nv;
  for (size_t i = 0; i < n; i++) {
    const size_t k = at + i;
    const fate *f = &p->fates[p->fate_of[k]];
    const int filled = p->knowledge[k] == FILLED;
    state[i] = (pendres_basin_state){
      .well = f->well,
      .attractor = f->attractor,
      .label = f->label,
      .settling_periods = filled ? -2 : p->periods[k],
      .how = filled                        ? PENDRES_BASIN_FILLED
             : p->knowledge[k] == UNSURE ? PENDRES_BASIN_UNCERTAIN
                                           : PENDRES_BASIN_INTEGRATED};
  }
  return PENDRES_OK;
}

pendres_status pendres_basin_plan_states(const pendres_basin_plan *p, pendres_basin_state *state)
{
  return pendres_basin_plan_rows(p, 0, p != NULL ? p->rows : 0, state);
}

size_t pendres_basin_plan_filled(const pendres_basin_plan *p)
{
  size_t filled = 0;
  for (size_t k = 0; p != NULL && k < p->rows * p->nv; k++) filled += p->knowledge[k] == FILLED;
  return filled;
}

double pendres_basin_plan_suspected(size_t filled, size_t drawn)
{
  const double all = (double)filled;
  return drawn > 3 ? all * 3.0 / (double)drawn : all;
}

size_t pendres_basin_plan_integrated(const pendres_basin_plan *p)
{
  return p != NULL ? p->integrated : 0;
}
