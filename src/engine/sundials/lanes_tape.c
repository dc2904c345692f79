/* lanes_tape.c -- deferred operations on vectors of a block; see lanes_tape.h. */
#include "engine/sundials/lanes_tape.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum {
  MOST_OPERATIONS = 1024, /* some 60 steps of an order-8 table */
  MOST_SUMS = 128         /* several steps' worth: the last of a period may differ by rounding */
};

/* A sum as it was requested. */
typedef struct request {
  N_Vector z, x[PENDRES_KERNELS_TERMS];
  double c[PENDRES_KERNELS_TERMS];
  const pendres_sum *sum;      /* what is left of it without zero coefficients */
  uint64_t reads;              /* the set of these vectors */
  const struct request *older; /* of the same number of terms */
} request;

struct pendres_lanes_tape {
  size_t operations, requests;
  uint64_t unread; /* vectors written and not read since; by whom: */
  pendres_operation *writer[64];
  const request *latest[PENDRES_KERNELS_TERMS + 1]; /* by the number of terms */
  pendres_operation operation[MOST_OPERATIONS];
  pendres_sum sum[MOST_SUMS];
  pendres_lanes_replays *record; /* the record of what is done, not owned; NULL: there is none */
  request request[MOST_SUMS];
};

static double *data_of(N_Vector v)
{
  return pendres_lanes_of(v)->data;
}

pendres_lanes_tape *pendres_lanes_tape_create(void)
{
  return calloc(1, sizeof(pendres_lanes_tape));
}

void pendres_lanes_tape_free(pendres_lanes_tape *tape)
{
  free(tape);
}

void pendres_lanes_tape_run(pendres_lanes_shape *s)
{
  pendres_lanes_tape *t = s->tape;
  if (t->operations == 0) return;
  pendres_lanes_shape_run(s, t->operation, t->operations);
  if (t->record != NULL) pendres_lanes_replays_add(t->record, t->operation, t->operations);
  t->operations = 0;
  t->unread = 0;
}

void pendres_lanes_tape_record(pendres_lanes_shape *s, pendres_lanes_replays *record)
{
  pendres_lanes_tape_run(s);
  s->tape->record = record;
}

void pendres_lanes_tape_forget(pendres_lanes_shape *s)
{
  pendres_lanes_tape_run(s);
  memset(s->tape->latest, 0, sizeof s->tape->latest);
  s->tape->requests = 0;
}

static pendres_operation *next(pendres_lanes_shape *s)
{
  if (s->tape->operations == MOST_OPERATIONS) pendres_lanes_tape_run(s);
  return &s->tape->operation[s->tape->operations++];
}

/* Note that o reads some vectors and then writes v, and which earlier operation becomes unnecessary
   by this. */
static void note(pendres_lanes_tape *t, pendres_operation *o, uint64_t reads, N_Vector v)
{
  const uint64_t bit = pendres_lanes_of(v)->bit;
  t->unread &= ~reads;
  if (bit == 0) return;
  pendres_operation **writer = &t->writer[__builtin_ctzll(bit)];
  if ((t->unread & bit) != 0) {
    if ((*writer)->slope == NULL)
      **writer = (pendres_operation){0};
    else
      (*writer)->keep = 0;
  }
  *writer = o;
  t->unread |= bit;
}

/* Not memcmp: calls into other libraries cost more than this. */
static int equal(const request *q, int n, const double *c, const N_Vector *x, N_Vector z)
{
  if (q->z != z) return 0;
  for (int i = 0; i < n; i++) {
    uint64_t a, b; /* bits, for the sign of zero */
    memcpy(&a, &q->c[i], sizeof a);
    memcpy(&b, &c[i], sizeof b);
    if (a != b || q->x[i] != x[i]) return 0;
  }
  return 1;
}

static const request *find(const pendres_lanes_tape *t, int n, const double *c, const N_Vector *x,
                           N_Vector z)
{
  const request *q = t->latest[n];
  while (q != NULL && !equal(q, n, c, x, z)) q = q->older;
  return q;
}

static const request *learn(pendres_lanes_shape *s, int n, const double *c, const N_Vector *x,
                            N_Vector z)
{
  pendres_lanes_tape *t = s->tape;
  if (t->requests == MOST_SUMS) pendres_lanes_tape_forget(s);
  pendres_sum *sum = &t->sum[t->requests];
  request *q = &t->request[t->requests++];
  *q = (request){.z = z, .sum = sum, .older = t->latest[n]};
  *sum = (pendres_sum){.z = data_of(z)};
  for (int i = 0; i < n; i++) {
    q->c[i] = c[i];
    q->x[i] = x[i];
    if (c[i] == 0.0) continue;
    q->reads |= pendres_lanes_of(x[i])->bit;
    sum->term[sum->terms].c = c[i];
    sum->term[sum->terms++].x = data_of(x[i]);
  }
  t->latest[n] = q;
  return q;
}

void pendres_lanes_tape_sum(int n, const double *c, const N_Vector *x, N_Vector z)
{
  pendres_lanes_shape *s = pendres_lanes_of(z)->shape;
  const request *q = find(s->tape, n, c, x, z);
  if (q == NULL) q = learn(s, n, c, x, z);
  pendres_operation *o = next(s);
  *o = (pendres_operation){.sum = q->sum->terms > 0 ? q->sum : NULL, .to = data_of(z)};
  note(s->tape, o, q->reads, z);
}

void pendres_lanes_tape_copy(N_Vector from, N_Vector to)
{
  pendres_lanes_shape *s = pendres_lanes_of(to)->shape;
  if (from == to) return;
  pendres_operation *o = next(s);
  *o = (pendres_operation){.from = data_of(from), .to = data_of(to)};
  note(s->tape, o, pendres_lanes_of(from)->bit, to);
}

void pendres_lanes_tape_carry(N_Vector y, double step, double cos_theta, int second)
{
  pendres_lanes_shape *s = pendres_lanes_of(y)->shape;
  pendres_operation *o = next(s);
  *o = (pendres_operation){.from = data_of(y), .cos_theta = cos_theta, .carry = step,
                             .second = second};
  s->tape->unread &= ~pendres_lanes_of(y)->bit;
}

/*
 * The deferred sum whose result is y, if the slope at y may be computed together with it: only
 * propagated errors and an unrelated copy may have followed it.
 */
static pendres_operation *made_by(pendres_lanes_tape *t, const double *y, const double *slope)
{
  pendres_operation *o = t->operation + t->operations;
  if (t->operations > 1 && o[-1].from != NULL && o[-1].to != NULL && o[-1].to != y &&
      o[-1].to != slope && o[-1].from != slope)
    o--;
  if (o > t->operation && o[-1].carry != 0.0) o--;
  if (o == t->operation || o[-1].sum == NULL || o[-1].slope != NULL || o[-1].to != y) return NULL;
  return o - 1;
}

void pendres_lanes_tape_slope(N_Vector y, N_Vector slope, double cos_theta)
{
  pendres_lanes_shape *s = pendres_lanes_of(y)->shape;
  double *const from = data_of(y), *const to = data_of(slope);
  pendres_operation *o = made_by(s->tape, from, to);
  uint64_t reads = 0;
  if (o == NULL) {
    o = next(s);
    *o = (pendres_operation){.from = from};
    reads = pendres_lanes_of(y)->bit;
  }
  o->slope = to;
  o->cos_theta = cos_theta;
  o->keep = 1;
  s->tape->unread &= ~reads;
}
