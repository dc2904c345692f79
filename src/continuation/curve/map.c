/* map.c -- the map whose fixed points are followed; see map.h. */
#include "continuation/curve/map.h"

#include <math.h>

#include "base/angles.h"
#include "continuation/curve/numbers.h"
#include "engine/chain.h"
#include "engine/context_internal.h"
#include "engine/room.h"
#include "engine/kernels/coordinates.h"
#include "engine/steps.h"
#include "model/equation.h"
#include "model/model.h"
#include "model/parameter.h"

pendres_pendulum pendres_map_pendulum(pendres_force force, const pendres_u u)
{
  pendres_pendulum p = {.force = force};
  for (int k = 0; k < PENDRES_PARAMETER_FOLLOWED; k++)
    pendres_parameter_set((pendres_parameter)k, u[PENDRES_U_OMEGA + k], &p);
  return p;
}

/* The point of a pendulum in a state (y, w). */
static void point_of(const pendres_pendulum *p, double y, double w, pendres_u u)
{
  u[PENDRES_U_Y] = y;
  u[PENDRES_U_W] = w;
  for (int k = 0; k < PENDRES_PARAMETER_FOLLOWED; k++)
    u[PENDRES_U_OMEGA + k] = pendres_parameter_get((pendres_parameter)k, p);
}

/* Whether pendulums lose a mirror symmetry about a centre when an unknown changes: a power that is
   not odd about it is added to the force. */
static int breaks_symmetry(int place, double centre)
{
  return place == PENDRES_U_TORQUE ||
         (place == PENDRES_U_OMEGA + (int)PENDRES_NONLINEAR_DAMPING && centre != 0.0) ||
         (place >= PENDRES_U_POWERS && place < PENDRES_U_POWERS + PENDRES_FORCE_POWERS &&
          (centre != 0.0 || (place - PENDRES_U_POWERS) % 2 != 0));
}

static int is_among(int place, int unknowns, const int *unknown)
{
  for (int k = 0; k < unknowns; k++)
    if (unknown[k] == place) return 1;
  return 0;
}

/* Whether a pendulum has a parametric drive alone, or may have one on the way, and a mirror: the
   drive leaves the symmetry only to a force that is odd without a torque. */
static int is_reflected(const pendres_pendulum *p, int unknowns, const int *unknown)
{
  return p->drive_amplitude == 0.0 && p->torque == 0.0 &&
         !is_among(PENDRES_U_DRIVE, unknowns, unknown) &&
         (p->parametric_amplitude != 0.0 || is_among(PENDRES_U_MODULATION, unknowns, unknown));
}

/* Periods after which an orbit may be its own mirror image at the same phase; 0 if it cannot. */
static int reflected_after(int period)
{
  return period == 1 ? 1 : period % 2 == 0 ? period / 2 : 0;
}

/* Whether an orbit is its own mirror image in this way: averaged over its drive cycles it rests at
   the centre; of a pendulum at one of them. */
static int is_own_reflection(const pendres_orbit *o, double centre)
{
  const double nothing =
    orbit_no_harmonic + pendres_several_errors * o->first_harmonic_amplitude_error;
  if (pendres_model_of(o->pendulum.force)->period == 0.0 &&
      !(fabs(o->mean_angle - centre) <= nothing + o->x_error))
    return 0;
  for (int m = 0; m < PENDRES_ORBIT_HARMONICS; m++)
    if (!(hypot(o->cosine[m], o->sine[m]) <= nothing)) return 0;
  return reflected_after(o->period) > 0 && o->winding == 0;
}

pendres_map pendres_map_of(const pendres_orbit *o, int unknowns, const int *unknown, pendres_u u)
{
  pendres_map map = {
    .force = o->pendulum.force, .period = o->period, .winding = o->winding};
  const pendres_coordinates s = pendres_coordinates_in_whole(&o->pendulum, o->x, o->v);
  pendres_pendulum still = o->pendulum;
  still.parametric_amplitude = 0.0;
  const double centre = pendres_model_centre(&still, isfinite(o->mean_angle) ? o->mean_angle : s.y);
  int kept = isfinite(centre);
  point_of(&o->pendulum, s.y, s.w, u);
  if (isfinite(o->mean_angle) && o->winding == 0) map.middle = o->mean_angle;
  for (int k = 0; k < unknowns && kept; k++) kept = !breaks_symmetry(unknown[k], centre);
  if (!kept) return map;
  map.reflects = is_reflected(&o->pendulum, unknowns, unknown);
  map.symmetric = o->pendulum.parametric_amplitude == 0.0 &&
                  !is_among(PENDRES_U_MODULATION, unknowns, unknown);
  if (map.symmetric || map.reflects) map.centre = map.middle = centre;
  if (map.symmetric && o->symmetric && o->period % 2 != 0 && o->winding == 0)
    map.mirror = PENDRES_MIRROR_HALF;
  else if (map.reflects && is_own_reflection(o, centre))
    map.mirror = PENDRES_MIRROR_WHOLE;
  /* About the bottom of the well, or about the top of a barrier. A caller's orbit may have any
     number there. */
  if (map.mirror != PENDRES_MIRROR_NONE)
    map.winding = pendres_model_of(map.force)->period > 0.0
                    ? (int)rint(fmin(fmax(o->mean_angle / pi, -1.0), 1.0))
                    : 0;
  return map;
}

pendres_status pendres_map_steps(pendres_context *ctx, pendres_force force,
                                 const pendres_u u, double tolerance, int *steps)
{
  const pendres_pendulum p = pendres_map_pendulum(force, u);
  const char *why = NULL;
  if (pendres_pendulum_check(&p, &why) != PENDRES_OK)
    return pendres_context_fail(ctx, PENDRES_NOT_CONVERGED, "the branch leaves the parameters: %s",
                                why);
  const double speed = pendres_steps_speed(&p, u[PENDRES_U_Y], u[PENDRES_U_W] * u[PENDRES_U_OMEGA]);
  /* A large orbit's resonance is as narrow as its damping: what the steps add must be less. */
  const pendres_map map = {.force = force};
  const double large = pendres_arc_large(&map, u), decay = pendres_equation_shrinking(&p);
  if (large > 1.0 && decay > 0.0) tolerance = fmin(tolerance, map_undamped * large * decay);
  const pendres_status status = pendres_steps_choose(ctx, &p, speed, tolerance, steps);
  *steps += *steps % 2;
  return status;
}

double pendres_map_fold(const pendres_image *i)
{
  return 1.0 - i->trace + i->determinant;
}

double pendres_map_flip(const pendres_image *i)
{
  return 1.0 + i->trace + i->determinant;
}

double pendres_map_growth(const pendres_image *i)
{
  return hypot(hypot(i->n[0][0], i->n[0][1]), hypot(i->n[1][0], i->n[1][1]));
}

void pendres_map_null(const pendres_image *image, double v[2])
{
  /* The larger row of N - I has more digits. */
  const double *row =
    hypot(image->j[0][0], image->j[0][1]) > hypot(image->j[1][0], image->j[1][1]) ? image->j[0]
                                                                                 : image->j[1];
  const double length = hypot(row[0], row[1]);
  v[0] = length > 0.0 ? -row[1] / length : 1.0;
  v[1] = length > 0.0 ? row[0] / length : 0.0;
}

/* ---- distances ---- */

double pendres_arc_least_scale(int i)
{
  if (i < PENDRES_U_OMEGA) return 1.0;
  return i == PENDRES_U_OMEGA ? 0.3 : 0.1;
}

double pendres_arc_large(const pendres_map *map, const pendres_u u)
{
  if (pendres_model_of(map->force)->angle) return 1.0;
  return fmax(1.0, hypot(u[PENDRES_U_Y] - map->middle, u[PENDRES_U_W]) - 1.0);
}

double pendres_arc_damped(pendres_force force, const pendres_u u)
{
  const pendres_pendulum p = pendres_map_pendulum(force, u);
  return scale_weak * fabs(pendres_pendulum_decay_rate(&p));
}

/* Of y and w. At weak damping branches turn where orbits are small: there these count by their
   ratios. */
static double state_scale(const pendres_map *map, const pendres_u u)
{
  const double least = fmax(scale_least, pendres_arc_damped(map->force, u));
  const double large = pendres_arc_large(map, u);
  if (!(least < 1.0) || large > 1.0) return large;
  const double orbit = hypot(u[PENDRES_U_Y] - map->middle, u[PENDRES_U_W]);
  return fmin(1.0, fmax(least, fmax(orbit, fabs(u[PENDRES_U_DRIVE]))));
}

double pendres_arc_scale(const pendres_map *map, int i, const pendres_u u)
{
  if (i < PENDRES_U_OMEGA) return state_scale(map, u);
  return fmax(pendres_arc_least_scale(i), fabs(u[i]) / scale_logarithmic);
}

double pendres_arc_scale_between(const pendres_map *map, int i, const pendres_u a,
                                 const pendres_u b)
{
  pendres_u middle;
  for (int k = 0; k < PENDRES_U_COUNT; k++) middle[k] = 0.5 * (a[k] + b[k]);
  return pendres_arc_scale(map, i, middle);
}

double pendres_arc_distance(const pendres_map *map, const pendres_u a, const pendres_u b)
{
  double sum = 0.0;
  for (int i = 0; i < PENDRES_U_COUNT; i++)
    if (a[i] != b[i]) sum = hypot(sum, (a[i] - b[i]) / pendres_arc_scale_between(map, i, a, b));
  return sum;
}

/* ---- images ---- */

/* Of a map. */
static int whole_periods(const pendres_map *map)
{
  if (map->mirror == PENDRES_MIRROR_WHOLE) return reflected_after(map->period);
  return map->mirror == PENDRES_MIRROR_HALF ? map->period / 2 : map->period;
}

static void read_image(const pendres_rows *rows, size_t lane, const pendres_map *map,
                       const pendres_u u, int columns, pendres_image *out)
{
  const double sign = map->mirror ? -1.0 : 1.0;
  const double turns = map->mirror ? two_pi * map->winding + 2.0 * map->centre
                                   : -two_pi * map->winding;
  const double time = map->mirror == PENDRES_MIRROR_HALF
                        ? pi * map->period / u[PENDRES_U_OMEGA]
                        : two_pi * whole_periods(map) / u[PENDRES_U_OMEGA];
  out->f[0] = sign * pendres_rows_get(rows, PENDRES_ROW_Y, lane) + turns - u[PENDRES_U_Y];
  out->f[1] = sign * pendres_rows_get(rows, PENDRES_ROW_W, lane) - u[PENDRES_U_W];
  for (int i = 0; i < 2; i++) {
    for (int k = 0; k < PENDRES_U_COUNT; k++)
      out->j[i][k] =
        k < columns ? sign * pendres_rows_get(rows, PENDRES_ROW_BY_Y + 2 * k + i, lane) : NAN;
    for (int k = 0; k < 2; k++) out->n[i][k] = out->j[i][k];
    out->j[i][i] -= 1.0;
  }
  out->trace = out->n[0][0] + out->n[1][1];
  const pendres_pendulum p = pendres_map_pendulum(map->force, u);
  const double computed = out->n[0][0] * out->n[1][1] - out->n[0][1] * out->n[1][0];
  out->determinant = pendres_equation_left(pendres_equation_contraction(&p) * time, computed);
}

/* Points whose images are wanted, few enough for a block. */
typedef struct points {
  const pendres_map *map;
  const pendres_u *u;
  int steps;
  int columns; /* derivatives that the block gives, in the order of u */
  size_t n;
  pendres_image *out;
} points;

static void read_images(const pendres_rows *rows, const points *p)
{
  for (size_t i = 0; i < p->n; i++) read_image(rows, i, p->map, p->u[i], p->columns, &p->out[i]);
}

/* After a step: add to the sums of the first harmonic's cosine, and read the images when their map
   ends. */
static void add_step(void *arg, int step, const pendres_rows *rows)
{
  const points *p = arg;
  const double weight = 2.0 / p->steps * cos(two_pi * step / p->steps);
  const int last = p->map->mirror == PENDRES_MIRROR_HALF ? p->steps / 2 : p->steps;
  for (size_t i = 0; i < p->n; i++) {
    p->out[i].in_phase += weight * pendres_rows_get(rows, PENDRES_ROW_Y, i);
    if (step == last) read_image(rows, i, p->map, p->u[i], p->columns, &p->out[i]);
  }
}

/* Run a block of orbits of period 1 through the whole of it, that of a half map too. */
static pendres_status run_in_phase(pendres_block *b, const points *p)
{
  for (size_t i = 0; i < p->n; i++) p->out[i].in_phase = 0.0;
  return pendres_block_period_sampled(b, add_step, (void *)p);
}

/* Points as the lanes of a block, over whole periods and a half one. */
static pendres_status run_block(pendres_block *b, pendres_condition condition, const points *p)
{
  const pendres_map *map = p->map;
  pendres_status status = PENDRES_OK;
  pendres_block_resize(b, p->n);
  for (size_t i = 0; i < p->n; i++) {
    const pendres_pendulum one = pendres_map_pendulum(map->force, p->u[i]);
    pendres_block_load(b, i, &one, p->u[i][PENDRES_U_Y], p->u[i][PENDRES_U_W]);
  }
  if (condition == PENDRES_CONDITION_LAG) return run_in_phase(b, p);
  const int whole = whole_periods(map);
  for (int k = 0; k < whole && status == PENDRES_OK; k++) status = pendres_block_period(b);
  if (map->mirror == PENDRES_MIRROR_HALF && status == PENDRES_OK)
    status = pendres_block_half_period(b);
  const pendres_rows rows = pendres_block_rows(b);
  if (status == PENDRES_OK) read_images(&rows, p);
  return status;
}

/* The same where their periods are the lanes. */
static pendres_status run_chain(pendres_context *ctx, pendres_flow_kind kind, const points *p)
{
  pendres_room room = pendres_room_open(ctx, "images");
  pendres_chain_start *from = pendres_room_take(&room, p->n, sizeof *from);
  double *at = pendres_room_take(&room, pendres_flow_kind_rows(kind) * p->n, sizeof *at);
  const pendres_rows rows = {.at = at, .stride = p->n};
  for (size_t i = 0; i < p->n && room.status == PENDRES_OK; i++)
    from[i] = (pendres_chain_start){pendres_map_pendulum(p->map->force, p->u[i]),
                                    p->u[i][PENDRES_U_Y], p->u[i][PENDRES_U_W]};
  pendres_status status = room.status;
  if (status == PENDRES_OK)
    status = pendres_chain_run(
      ctx, &(pendres_chain){.kind = kind, .steps = p->steps, .periods = whole_periods(p->map),
                            .n = p->n, .from = from, .rows = at});
  if (status == PENDRES_OK) read_images(&rows, p);
  return pendres_room_close(&room, status);
}

/* How many derivatives, in the order of u, blocks of a kind give. */
static int columns_of(pendres_flow_kind kind)
{
  return kind == PENDRES_FLOW_VARIATIONAL   ? PENDRES_U_OMEGA
         : kind == PENDRES_FLOW_SENSITIVITY ? PENDRES_U_TORQUE
         : kind == PENDRES_FLOW_DRIVES      ? PENDRES_U_POWERS
         : kind == PENDRES_FLOW_FORCE       ? PENDRES_U_POWERS + PENDRES_FORCE_POWERS
                                            : PENDRES_U_COUNT;
}

/* The blocks with the fewest rows that give derivatives by some unknowns. */
static pendres_flow_kind kind_of(int unknowns, const int *unknown)
{
  static const pendres_flow_kind kinds[] = {PENDRES_FLOW_VARIATIONAL, PENDRES_FLOW_SENSITIVITY,
                                            PENDRES_FLOW_DRIVES, PENDRES_FLOW_FORCE,
                                            PENDRES_FLOW_ALL};
  int last = 0, k = 0;
  for (int i = 0; i < unknowns; i++) last = unknown[i] > last ? unknown[i] : last;
  while (columns_of(kinds[k]) <= last) k++;
  return kinds[k];
}

static pendres_status images(pendres_context *ctx, const pendres_system *s, size_t n,
                             const pendres_u *u, pendres_flow_kind kind, pendres_image *out)
{
  pendres_block *b;
  const int chained =
    s->map.mirror != PENDRES_MIRROR_HALF && pendres_chain_worth(whole_periods(&s->map));
  pendres_status status = pendres_block_open(ctx, kind, s->steps, &b);
  if (status != PENDRES_OK) return status;
  const size_t capacity = pendres_block_capacity(b);
  for (size_t first = 0; first < n && status == PENDRES_OK; first += capacity) {
    const points p = {&s->map, u + first, s->steps, columns_of(kind),
                      n - first < capacity ? n - first : capacity, out + first};
    status = chained ? run_chain(ctx, kind, &p) : run_block(b, s->condition, &p);
    if (status == PENDRES_OK) ctx->cost.newton_steps += (double)p.n;
  }
  return status;
}

pendres_status pendres_map_images(pendres_context *ctx, const pendres_system *s, size_t n,
                                  const pendres_u *u, pendres_image *out)
{
  return images(ctx, s, n, u, kind_of(s->unknowns, s->unknown), out);
}

pendres_status pendres_map_states(pendres_context *ctx, const pendres_map *map, int steps, size_t n,
                                  const pendres_u *u, pendres_image *out)
{
  const pendres_system s = {.map = *map, .steps = steps};
  return images(ctx, &s, n, u, PENDRES_FLOW_VARIATIONAL, out);
}

/* ---- half maps ---- */

void pendres_map_unfold(pendres_map *map)
{
  if (map->mirror != PENDRES_MIRROR_NONE) map->winding = 0;
  map->mirror = PENDRES_MIRROR_NONE;
}

int pendres_map_half(const pendres_map *map, int which, pendres_map *half)
{
  /* Most orbits of one or two periods are born of rest, or of orbits that are their own image. */
  const int reflects = map->reflects && map->winding == 0 && reflected_after(map->period) > 0;
  *half = *map;
  if (reflects && which == (map->period > 2) && map->mirror == PENDRES_MIRROR_NONE) {
    half->mirror = PENDRES_MIRROR_WHOLE;
    return 1;
  }
  if (map->mirror == PENDRES_MIRROR_WHOLE) {
    pendres_map_unfold(half);
    half->period = 1;
    return which == 0 && map->period <= 2;
  }
  const int first = reflects && map->period == 2 ? 1 : 0;
  if (map->mirror != PENDRES_MIRROR_NONE || which != first) return 0;
  if (map->period % 2 != 0) {
    half->mirror = PENDRES_MIRROR_HALF;
    return map->symmetric && map->winding == 0;
  }
  half->period /= 2;
  half->winding /= 2;
  return map->winding % 2 == 0;
}

pendres_status pendres_map_closes(pendres_context *ctx, const pendres_map *half, int steps,
                                  size_t n, const pendres_u *u, pendres_map_miss *miss)
{
  pendres_room room = pendres_room_open(ctx, "images");
  pendres_image *image = pendres_room_take(&room, n, sizeof *image);
  pendres_status status = room.status;
  if (status == PENDRES_OK) status = pendres_map_states(ctx, half, steps, n, u, image);
  const double period = pendres_model_of(half->force)->period;
  const double turn = period > 0.0 ? period : INFINITY;
  for (size_t i = 0; i < n && status == PENDRES_OK; i++) {
    /* The reflection of an angle may be about any multiple of pi. */
    const double turns = half->mirror ? -rint(image[i].f[0] / turn) : 0.0;
    miss[i] = (pendres_map_miss){{image[i].f[0] + two_pi * turns, image[i].f[1]},
                                          half->winding + (int)turns};
  }
  return pendres_room_close(&room, status);
}
