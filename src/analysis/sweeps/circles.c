/* circles.c -- the invariant circles that a sweep has met; see circles.h. */
#include "analysis/sweeps/circles.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/grow.h"
#include "base/mix.h"
#include "continuation/parameter.h"
#include "engine/context_internal.h"
#include "engine/coordinates.h"

enum {
  CLOSED_BELOW = 1, CLOSED_ABOVE = 2,
  MOST_BANDS = 4096,
  LOOKS = 60 /* iterations for the end of a lock */
};

/* Widths of bands, in the parameter's scale: of the first, of the widest, and of one so narrow that
   it is not made, since the circle is about to break up. */
static const double first_width = 0.1, widest = 4.0, narrowest = 0.005;
/* Coefficients of a map that are left out, relative to the tolerance. */
static const double negligible = 0.01;
/* The next band is a little narrower than what the last one's coefficients allow. */
static const double careful = 0.8;
/* Gaps between bands that are bridged, in the parameter's scale. Within this distance of a motion
   from which no circle was found none is tried again. */
static const double near_by = 2.0, again = 0.05;

pendres_status pendres_circles_create(pendres_context *ctx, const pendres_circle_family *family,
                                      double low, double high, pendres_circles **out)
{
  pendres_circles *c = calloc(1, sizeof *c);
  *out = c;
  if (c != NULL) c->table = pendres_circle_table_create();
  if (c == NULL || c->table == NULL) {
    pendres_circles_free(c);
    *out = NULL;
    return pendres_context_fail(ctx, PENDRES_OUT_OF_MEMORY, "out of memory for circles");
  }
  c->ctx = ctx;
  c->family = *family;
  c->width = first_width * pendres_parameter_scale(family->parameter);
  c->low = low;
  c->high = high;
  c->failed = NAN;
  return PENDRES_OK;
}

void pendres_circles_free(pendres_circles *c)
{
  if (c == NULL) return;
  pendres_circle_table_free(c->table);
  free(c->band);
  free(c->closed);
  free(c->verdict);
  free(c);
}

static pendres_status make_room(pendres_circles *c)
{
  if (c->count < c->room) return PENDRES_OK;
  const size_t room = 2 * c->room + 8;
  if (!pendres_regrow(&c->band, room, sizeof *c->band) ||
      !pendres_regrow(&c->closed, room, sizeof *c->closed))
    return pendres_context_fail(c->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for circles");
  c->room = room;
  return PENDRES_OK;
}

/* How much wider a band might have been: the truncation error goes as a power of its width. */
static double fit(const pendres_circles *c, const pendres_circle_band *b)
{
  return careful * pow(c->family.tolerance / fmax(b->missing, 1e-300),
                       1.0 / (PENDRES_CIRCLE_NODES + 1.0));
}

/* The width of the next band to try, after one that failed. */
static double narrower(const pendres_circles *c, const pendres_circle_band *b, double from)
{
  const double width = b->high - b->low, fits = fit(c, b);
  if (b->missing > 0.0) return width * fmax(0.1, fmin(0.6, fits));
  return fmin(0.7 * width, 0.9 * fabs(b->reached - from));
}

/* A band from a start on, as wide as possible; *found is 0 if there is none wide enough. */
static pendres_status grow(pendres_circles *c, const pendres_circle_start *start, int direction,
                           int *found)
{
  const double scale = pendres_parameter_scale(c->family.parameter);
  const double end = direction > 0 ? c->high : c->low, ahead = fabs(end - start->value);
  pendres_status status = PENDRES_OK;
  *found = 0;
  while (c->count < MOST_BANDS && ahead > 0.0 && c->width >= narrowest * scale && !*found) {
    const double width = fmin(c->width, ahead);
    const double to = width < ahead ? start->value + direction * width : end;
    pendres_circle_band *b = &c->band[c->count];
    status = pendres_circle_band_find(c->ctx, &c->family, start, to, b, found);
    if (status != PENDRES_OK) return status;
    if (*found) {
      c->closed[c->count++] = 0;
      c->width = fmin(widest * scale, width * fmax(0.7, fmin(3.0, fit(c, b))));
    } else {
      c->width = narrower(c, b, start->value);
    }
  }
  if (!*found) c->width = first_width * scale;
  return status;
}

pendres_status pendres_circles_begin(pendres_circles *c, double value, double x, double v)
{
  const double scale = pendres_parameter_scale(c->family.parameter);
  pendres_circle_start start = {.value = value};
  pendres_circle_way way;
  int found = 0;
  if (fabs(value - c->failed) < again * scale) return PENDRES_OK;
  pendres_status status = pendres_circle_way_at(c->ctx, &c->family, value, &way);
  if (status == PENDRES_OK)
    status = pendres_circle_guess(c->ctx, &way, x, v, &start.guess, &found);
  for (int direction = 1; direction >= -1 && status == PENDRES_OK && found; direction -= 2) {
    int grown = 0;
    status = make_room(c);
    if (status == PENDRES_OK) status = grow(c, &start, direction, &grown);
    if (grown) return status;
  }
  c->failed = value;
  return status;
}

/* The band that holds a value; NULL if none. */
static const pendres_circle_band *band_of(const pendres_circles *c, double value)
{
  for (size_t i = 0; i < c->count; i++)
    if (c->band[i].low <= value && value <= c->band[i].high) return &c->band[i];
  return NULL;
}

/* The number of the band whose open end is nearest to a value; -1 if none is near. */
static long nearest_end(const pendres_circles *c, double value, int *direction)
{
  double least = near_by * pendres_parameter_scale(c->family.parameter);
  long best = -1;
  for (size_t i = 0; i < c->count; i++) {
    const int up = value > c->band[i].high;
    const double gap = up ? value - c->band[i].high : c->band[i].low - value;
    if (!(gap < least)) continue;
    least = gap;
    best = c->closed[i] & (up ? CLOSED_ABOVE : CLOSED_BELOW) ? -1 : (long)i;
    *direction = up ? 1 : -1;
  }
  return best;
}

/* The band that holds a value. If there is none yet, bands are added from the nearest one on; *out
   is NULL if the circle cannot be followed as far as that. It is valid until the next call. */
static pendres_status seek(pendres_circles *c, double value, const pendres_circle_band **out)
{
  pendres_status status = PENDRES_OK;
  *out = NULL;
  if (value < c->low || value > c->high) return status;
  while (status == PENDRES_OK && (*out = band_of(c, value)) == NULL) {
    int direction = 0, found = 0;
    const long i = nearest_end(c, value, &direction);
    if (i < 0) return status;
    status = make_room(c); /* which moves bands */
    const pendres_circle_band *before = &c->band[i];
    const pendres_circle_start start = {
      .value = direction > 0 ? before->high : before->low, .before = before};
    if (status == PENDRES_OK) status = grow(c, &start, direction, &found);
    if (status == PENDRES_OK && !found)
      c->closed[i] |= direction > 0 ? CLOSED_ABOVE : CLOSED_BELOW;
  }
  return status;
}

static pendres_pendulum pendulum_at(const pendres_circles *c, double value)
{
  return pendres_parameter_with(&c->family.pendulum, c->family.parameter, value);
}

static void judge(pendres_circles *c, const pendres_circle_band *b, double value,
                  pendres_circles_verdict *out)
{
  pendres_circle at;
  const pendres_pendulum p = pendulum_at(c, value);
  pendres_circle_band_at(b, value, &at);
  pendres_trigonometric_trim(&at.move, negligible * c->family.tolerance);
  pendres_circle_table_set(c->table, &at.move, at.error + negligible * c->family.tolerance,
                           &b->wrong);
  out->found = 1;
  out->value = value;
  out->turn = pendres_circle_table_turn(c->table);
  const double y = out->turn.motion == PENDRES_CIRCLE_LOCKED ? out->turn.y : 0.0;
  const pendres_coordinates place = {.y = y, .w = pendres_trigonometric_at(&at.w, y, NULL)};
  pendres_coordinates_out(&p, &place, &out->x, &out->v);
}

/* The place of the verdict on a value among `places`, a power of two: its own or a free one. */
static size_t place_of(const pendres_circles_verdict *verdict, size_t places, double value)
{
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  size_t i = (size_t)pendres_mix(bits) & (places - 1);
  while (verdict[i].found && verdict[i].value != value) i = (i + 1) & (places - 1);
  return i;
}

/* Room for one more, half of the places being free. */
static pendres_status make_places(pendres_circles *c)
{
  if (2 * c->told + 2 <= c->places) return PENDRES_OK;
  const size_t places = c->places > 0 ? 2 * c->places : 256;
  pendres_circles_verdict *verdict = calloc(places, sizeof *verdict);
  if (verdict == NULL)
    return pendres_context_fail(c->ctx, PENDRES_OUT_OF_MEMORY, "out of memory for circles");
  for (size_t i = 0; i < c->places; i++)
    if (c->verdict[i].found)
      verdict[place_of(verdict, places, c->verdict[i].value)] = c->verdict[i];
  free(c->verdict);
  c->verdict = verdict;
  c->places = places;
  return PENDRES_OK;
}

pendres_status pendres_circles_tell(pendres_circles *c, double value,
                                    pendres_circles_verdict *out)
{
  const pendres_circle_band *b = NULL;
  *out = (pendres_circles_verdict){.value = value};
  pendres_status status = make_places(c);
  if (status != PENDRES_OK) return status;
  pendres_circles_verdict *known = &c->verdict[place_of(c->verdict, c->places, value)];
  if (!known->found) {
    status = seek(c, value, &b);
    if (status != PENDRES_OK || b == NULL) return status;
    judge(c, b, value, known);
    c->told++;
  }
  *out = *known;
  return status;
}

/* The least shift of a lock at a value, with the sign that it has outside of the lock. */
static pendres_status edge_at(pendres_circles *c, const pendres_circle_turn *lock, double value,
                              int sign, double *g, double *error)
{
  const pendres_circle_band *b = NULL;
  const pendres_status status = seek(c, value, &b);
  double worth = 0.0;
  *g = NAN;
  if (status != PENDRES_OK || b == NULL) return status;
  pendres_circle at;
  pendres_circle_band_at(b, value, &at);
  pendres_circle_table_set(c->table, &at.move, b->error, &b->wrong);
  *g = sign *
       pendres_circle_table_edge(c->table, lock->period, lock->winding, sign, &worth);
  *error = worth * (b->error + pendres_trigonometric_size(&b->wrong));
  return status;
}

pendres_status pendres_circles_edge(pendres_circles *c, const pendres_circle_turn *lock,
                                    double inside, double outside, pendres_circles_end *out)
{
  double g_in = NAN, g_out = NAN, g = NAN, off = 0.0;
  const pendres_circle_turn *l = lock;
  pendres_circles_verdict beyond;
  *out = (pendres_circles_end){.found = 0};
  pendres_status status = pendres_circles_tell(c, outside, &beyond);
  if (status != PENDRES_OK || !beyond.found) return status;
  const int sign = beyond.turn.turns * l->period > l->winding ? 1 : -1;
  status = edge_at(c, l, inside, sign, &g_in, &off);
  if (status == PENDRES_OK) status = edge_at(c, l, outside, sign, &g_out, &off);
  if (status != PENDRES_OK || !(g_in < 0.0 && g_out > 0.0)) return status;
  double slope = (g_out - g_in) / (outside - inside);
  for (int k = 0, side = 0; k < LOOKS; k++) {
    const double width = outside - inside;
    out->value = inside - width * g_in / (g_out - g_in);
    status = edge_at(c, l, out->value, sign, &g, &off);
    if (status != PENDRES_OK || isnan(g)) return status;
    if (fabs(g) < 0.01 * off || fabs(width) < 1e-14 * fabs(out->value)) break;
    slope = g > 0.0 ? (g - g_in) / (out->value - inside) : (g_out - g) / (outside - out->value);
    /* The Illinois rule: the value at an end that stays is halved. */
    if (g > 0.0) {
      outside = out->value;
      g_out = g;
      if (side > 0) g_in *= 0.5;
      side = 1;
    } else {
      inside = out->value;
      g_in = g;
      if (side < 0) g_out *= 0.5;
      side = -1;
    }
  }
  out->error = (fabs(g) + off) / fabs(slope);
  out->found = isfinite(out->error);
  return status;
}

pendres_status pendres_circles_distance(pendres_circles *c, double value, double x, double v,
                                        double *distance)
{
  const pendres_circle_band *b = NULL;
  const pendres_status status = seek(c, value, &b);
  *distance = INFINITY;
  if (status != PENDRES_OK || b == NULL) return status;
  pendres_circle at;
  const pendres_pendulum p = pendulum_at(c, value);
  const pendres_coordinates place = pendres_coordinates_in(&p, x, v);
  pendres_circle_band_at(b, value, &at);
  *distance = fabs(place.w - pendres_trigonometric_at(&at.w, place.y, NULL));
  return status;
}
