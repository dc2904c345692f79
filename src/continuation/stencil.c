/* stencil.c -- a curve between two of its points; see stencil.h. */
#include "continuation/stencil.h"

#include <math.h>
#include <string.h>

#include "continuation/arc.h"

enum { PARTS = 16, SAMPLES = 2 * PARTS, BISECTIONS = 40 };

/* Point number k, moved by whole turns next to the point at hand. */
static void next_to(const pendres_continuation_points *p, size_t k,
                    const double here[PENDRES_U_COUNT], double u[PENDRES_U_COUNT])
{
  memcpy(u, p->u[k], PENDRES_U_COUNT * sizeof *u);
  if (p->turn > 0.0)
    u[PENDRES_U_Y] -= p->turn * rint((u[PENDRES_U_Y] - here[PENDRES_U_Y]) / p->turn);
}

/* A third and a fourth node: the first points beyond the chord that are not too close to it. */
static void add_beyond(pendres_continuation_stencil *s, const pendres_continuation_points *p,
                       size_t from, size_t other, int side)
{
  const double least = 0.2 * s->length;
  double away = 0.0, here[PENDRES_U_COUNT], beyond[PENDRES_U_COUNT];
  size_t at = from;
  memcpy(here, s->u[side < 0 ? 0 : 1], sizeof here);
  while (away < least) {
    const int end = side < 0 ? at == 0 : at + 1 == p->count;
    if (end && !p->closed) return;
    at = (at + p->count + (size_t)(side < 0 ? p->count - 1 : 1)) % p->count;
    if (at == other) return;
    next_to(p, at, here, beyond);
    away += pendres_arc_distance(here, beyond);
    memcpy(here, beyond, sizeof here);
  }
  memcpy(s->u[s->nodes], here, sizeof here);
  s->t[s->nodes++] = side < 0 ? -away : s->length + away;
}

void pendres_continuation_stencil_init(pendres_continuation_stencil *s,
                                       const pendres_continuation_points *p, size_t i)
{
  const size_t k = (i + 1) % p->count;
  memcpy(s->u[0], p->u[i], sizeof s->u[0]);
  next_to(p, k, s->u[0], s->u[1]);
  s->length = pendres_arc_distance(s->u[0], s->u[1]);
  s->nodes = 2;
  s->t[0] = 0.0;
  s->t[1] = s->length;
  add_beyond(s, p, i, k, -1);
  add_beyond(s, p, k, i, 1);
}

void pendres_continuation_stencil_at(const pendres_continuation_stencil *s, double t,
                                     double u[PENDRES_U_COUNT])
{
  memset(u, 0, PENDRES_U_COUNT * sizeof *u);
  for (int i = 0; i < s->nodes; i++) {
    double weight = 1.0;
    for (int k = 0; k < s->nodes; k++)
      if (k != i) weight *= (t - s->t[k]) / (s->t[i] - s->t[k]);
    for (int m = 0; m < PENDRES_U_COUNT; m++) u[m] += weight * s->u[i][m];
  }
}

static double off(const pendres_continuation_stencil *s, int place, double value, double t)
{
  double u[PENDRES_U_COUNT];
  pendres_continuation_stencil_at(s, t, u);
  return u[place] - value;
}

/* Samples along the chord, and vertices of parabolas through three: no pair of roots is lost. */
static int sample(const pendres_continuation_stencil *s, int place, double value,
                  double t[SAMPLES], double g[SAMPLES])
{
  const double h = s->length / PARTS;
  double even[PARTS + 1];
  int n = 0;
  for (int j = 1; j < PARTS; j++) even[j] = off(s, place, value, j * h);
  /* The ends are the curve's own points to the last digit, so that neighbouring chords agree. */
  even[0] = s->u[0][place] - value;
  even[PARTS] = s->u[1][place] - value;
  for (int j = 0; j <= PARTS; j++) {
    const double bend = j % PARTS == 0 ? 0.0 : even[j + 1] - 2.0 * even[j] + even[j - 1];
    const double vertex = bend != 0.0 ? 0.5 * (even[j - 1] - even[j + 1]) / bend : 0.0;
    if (vertex < 0.0 && vertex > -0.5) {
      t[n] = (j + vertex) * h;
      g[n] = off(s, place, value, t[n]);
      n++;
    }
    t[n] = j * h;
    g[n++] = even[j];
    if (vertex > 0.0 && vertex <= 0.5) {
      t[n] = (j + vertex) * h;
      g[n] = off(s, place, value, t[n]);
      n++;
    }
  }
  return n;
}

size_t pendres_continuation_stencil_roots(const pendres_continuation_stencil *s, int place,
                                          double value, int last,
                                          double t[PENDRES_STENCIL_ROOTS])
{
  double at[SAMPLES], g[SAMPLES];
  size_t found = 0;
  const int n = sample(s, place, value, at, g);
  for (int j = 0; j + 1 < n && found < PENDRES_STENCIL_ROOTS; j++) {
    if (g[j] == 0.0) {
      t[found++] = at[j];
    } else if (g[j] * g[j + 1] < 0.0) {
      double low = at[j], high = at[j + 1];
      for (int b = 0; b < BISECTIONS; b++) {
        const double middle = 0.5 * (low + high);
        if (off(s, place, value, middle) * g[j] > 0.0)
          low = middle;
        else
          high = middle;
      }
      t[found++] = 0.5 * (low + high);
    }
  }
  if (last && g[n - 1] == 0.0 && found < PENDRES_STENCIL_ROOTS) t[found++] = s->length;
  return found;
}
