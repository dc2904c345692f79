/* curves.c -- curves of orbits over the axis, moved from one set of values to the next. */
#include "analysis/fit_model/internal.h"

#include <math.h>
#include <string.h>

#include <pendres/attractor.h>

#include "continuation/parameter.h"
#include "model/model.h"
#include "orbits/orbit_pair.h"

static double axis_of(const fit_model *m, const pendres_curve_node *node)
{
  return node->u[pendres_fit_place(m)];
}

/* Curves are moved with the parameters, damping among them: their state counts in a length of the
   curve's, whatever the damping. */
static double scale_at(const fit_curve *c, int place, double value)
{
  if (place < PENDRES_U_OMEGA) return c->kind.system.length;
  return pendres_parameter_scale_at((pendres_parameter)(place - PENDRES_U_OMEGA), value);
}

static double distance(const fit_curve *c, const pendres_u a, const pendres_u b)
{
  double sum = 0.0;
  for (int i = 0; i < PENDRES_U_COUNT; i++)
    sum = hypot(sum, (a[i] - b[i]) / scale_at(c, i, 0.5 * (a[i] + b[i])));
  return sum;
}

/* ---- where a curve begins ---- */

/* The range of the data and its margins in the axis' canonical units. */
typedef struct range {
  double low, high;   /* where the curve begins, and where it is known to the end */
  double least, most; /* beyond which it is not followed */
} range;

static range range_of(const fit_model *m, const fit_curve *c, const fit_values v)
{
  double a = pendres_fit_in(m, m->axis, v, c->from);
  double b = pendres_fit_in(m, m->axis, v, c->to);
  double span = fabs(pendres_fit_in(m, m->axis, v, c->to + c->span) - b);
  if (c->marked && m->axis == PENDRES_DRIVE_FREQUENCY) {
    /* Jumps are on one side of the small resonance, and the range leads to its other one. */
    const double small = sqrt(fmax(0.0, pendres_fit_stiffness(m, v, 0.0)));
    const double wide = fit_resonance_widths * v[PENDRES_DAMPING];
    const double low = fmin(fmin(a, b), small - wide), high = fmax(fmax(a, b), small + wide);
    a = low;
    b = high;
    span = high - low;
  } else if (c->marked) {
    /* Places tell little of how far it is to the next: as far as to 0, perhaps. */
    span = fmax(span, fmax(fabs(a), fabs(b)));
  }
  range r = {.low = fmin(a, b) - fit_margin * span, .high = fmax(a, b) + fit_margin * span,
             .least = fmin(a, b) - fit_outside * span, .most = fmax(a, b) + fit_outside * span};
  if (pendres_parameter_of(m->axis)->positive || m->axis == PENDRES_DRIVE_AMPLITUDE) {
    r.low = fmax(r.low, fit_lowest * fmin(a, b));
    r.least = fmax(r.least, fit_least * fmin(a, b));
  }
  return r;
}

/* The linear response about where the pendulum rests in the well at the origin; its amplitude is
   also what a curve reaches at most, with the drive over the friction. */
static void linear_guess(const pendres_pendulum *p, pendres_orbit_guess *g, double *highest)
{
  double rest = pendres_model_of(p->force)->origin, slope = 1.0;
  pendres_pendulum free_one = {.force = p->force, .drive_frequency = 1.0, .torque = p->torque};
  memcpy(free_one.force_coefficients, p->force_coefficients, sizeof p->force_coefficients);
  for (int round = 0; round < FIT_REST_ROUNDS; round++) {
    const double here = pendres_pendulum_acceleration(&free_one, rest, 0.0, 0.0);
    slope = (pendres_pendulum_acceleration(&free_one, rest - linear_near, 0.0, 0.0) - here) /
            linear_near;
    if (!(slope > 0.0)) break;
    rest += here / slope;
  }
  const double w = p->drive_frequency, d = slope - w * w, e = pendres_pendulum_decay_rate(p) * w;
  /* The parametric drive shakes the force that holds the torque. */
  const double drive = p->drive_amplitude - p->parametric_amplitude * p->torque;
  const double size = drive / (d * d + e * e);
  *g = (pendres_orbit_guess){.pendulum = *p, .x = rest + size * d, .v = w * size * e, .period = 1};
  *highest = fabs(drive) / fmax(e, 1e-300);
}

/* An orbit to begin from: next to the linear response or, failing that, what a pendulum at rest
   settles on. */
static pendres_status first_orbit(fit_model *m, const pendres_orbit_guess *g, pendres_orbit *o)
{
  pendres_status outcome = PENDRES_OK;
  pendres_status status = pendres_orbit_find_points(m->ctx, 1, g, o, &outcome);
  if (status != PENDRES_OK) return status;
  if (outcome == PENDRES_OK || outcome == PENDRES_TOLERANCE_UNREACHABLE) return PENDRES_OK;
  const double x = pendres_model_of(g->pendulum.force)->origin, v = 0.0;
  pendres_attractors *set = NULL;
  status = pendres_attractors_find(m->ctx, &g->pendulum, 1, &x, &v, &set);
  const pendres_attractor *a = pendres_attractors_get(set, 0);
  const int found = status == PENDRES_OK && a != NULL && a->label != PENDRES_LABEL_CHAOTIC &&
                    a->orbit.period == 1 && a->orbit.winding == 0;
  if (found) *o = a->orbit;
  pendres_attractors_free(set);
  if (status != PENDRES_OK || found) return status;
  return pendres_fit_lose(m, "no orbit was found where a sweep begins");
}

/* Whether the pendulum has the mirror symmetry, whatever values the fit's parameters take. */
static int keeps_symmetry(const fit_model *m, const pendres_pendulum *p)
{
  for (int k = 0; k < m->parameters; k++)
    if (m->parameter[k] == PENDRES_TORQUE || m->parameter[k] == PENDRES_PARAMETRIC_AMPLITUDE ||
        m->parameter[k] == PENDRES_A2 || m->parameter[k] == PENDRES_A4 ||
        (m->parameter[k] == PENDRES_NONLINEAR_DAMPING && pendres_model_centre(p, 0.0) != 0.0))
      return 0;
  return pendres_pendulum_symmetric(p);
}

/* What is found coarsely is its own mirror image where it can be: below the first loss of symmetry,
   where curves begin, all orbits of a period are. */
static pendres_status begin(fit_model *m, fit_curve *c, const fit_values v, const range *r,
                            pendres_follower *w)
{
  pendres_u u;
  pendres_orbit o;
  pendres_orbit_guess g;
  double highest = 0.0;
  pendres_fit_point_at(m, c, v, r->low, u);
  const pendres_pendulum p = pendres_map_pendulum(m->base.force, u);
  if (pendres_pendulum_check(&p, NULL) != PENDRES_OK)
    return pendres_fit_lose(m, "the model has no such values");
  linear_guess(&p, &g, &highest);
  pendres_status status = first_orbit(m, &g, &o);
  if (status != PENDRES_OK) return status;
  pendres_fit_point_at(m, c, v, 0.5 * (r->low + r->high), u);
  const pendres_pendulum middle = pendres_map_pendulum(m->base.force, u);
  pendres_orbit_guess unused;
  linear_guess(&middle, &unused, &highest);
  const double scale = pendres_parameter_scale_at(m->axis, r->high);
  const double wide =
    m->axis == PENDRES_DRIVE_FREQUENCY ? pendres_pendulum_decay_rate(&middle) : 0.0;
  const double across = fmax(wide, (r->high - r->low) / fit_steps_across) / scale;
  const double spacing = fmin(0.1, fmax(across, 1e-5));
  /* What softens bends away before it is as large; a barrier at the origin never stiffens. */
  const double half = 0.5 * pendres_fit_stiffness(m, v, 0.0);
  while (half > 0.0 && pendres_fit_stiffness(m, v, highest) < half) highest *= 0.5;
  o.symmetric = keeps_symmetry(m, &p);
  o.mean_angle = 0.0;
  c->kind = pendres_followed_of(&o, PENDRES_CONDITION_NONE, &m->axis, spacing, u);
  c->kind.system.length = highest > 0.0 ? highest / fit_nodes_high / spacing : 1.0;
  return pendres_follow_begin(m->ctx, &c->kind, u, 1.0, w);
}

/* ---- following ---- */

/* Whether a curve has come out of the data's range for good at its last node; *over: it has left
   what is followed. Places alone do not show how far the state leads on which they are: over the
   frequency it is passed where the motion is against the drive. */
static int is_through(const fit_model *m, const fit_curve *c, const range *r, int *over)
{
  const pendres_curve_node *last = &c->node[c->nodes - 1];
  const double s = axis_of(m, last);
  const int passed = !c->marked || m->axis != PENDRES_DRIVE_FREQUENCY ||
                     last->u[PENDRES_U_Y] * last->u[PENDRES_U_DRIVE] < 0.0;
  *over = s < r->least || s > r->most || c->nodes + PENDRES_AHEAD >= FIT_NODES;
  return *over || (s > r->high && last->tangent[2] > 0.0 && passed &&
                   pendres_map_fold(&last->image) > 0.0);
}

static pendres_status follow(fit_model *m, fit_curve *c, const fit_values v)
{
  const range r = range_of(m, c, v);
  pendres_follower w, *const one = &w;
  int over = 0;
  c->ready = 0;
  c->nodes = 0;
  pendres_status status = begin(m, c, v, &r, &w);
  if (status == PENDRES_NOT_CONVERGED && m->lost == NULL)
    return pendres_fit_lose(m, "a sweep's curve of orbits does not begin");
  if (status != PENDRES_OK) return status;
  c->node[c->nodes++] = w.here;
  while (!is_through(m, c, &r, &over)) {
    status = pendres_follow_advance(m->ctx, 1, &one);
    if (status != PENDRES_OK) return status;
    if (w.stuck) return pendres_fit_lose(m, "a curve of orbits could not be followed on");
    int steps = 0;
    status = pendres_map_steps(m->ctx, m->base.force, w.here.u, c->kind.tolerance, &steps);
    if (status != PENDRES_OK) return status;
    if (steps > FIT_MOST_STEPS)
      return pendres_fit_lose(m, "a curve leads to motions far from the data's");
    for (int k = 0; k < w.found; k++) c->node[c->nodes++] = w.ahead[k];
  }
  if (c->nodes + PENDRES_AHEAD >= FIT_NODES)
    return pendres_fit_lose(m, "a curve of orbits has more points than a fit follows");
  if (over)
    return pendres_fit_lose(m, "a curve of orbits does not lead over the range of the data");
  c->ready = 1;
  return PENDRES_OK;
}

/* ---- moving to other values ---- */

static int describe_moved(const fit_curve *c, const pendres_correction *at,
                          pendres_curve_node *node)
{
  const pendres_followed *kind = &c->kind;
  double r[2][3], t[3], length = 0.0, along = 0.0;
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 3; k++) {
      const int place = kind->system.unknown[k];
      r[i][k] = at->at.j[i][place] * scale_at(c, place, at->u[place]);
    }
  for (int k = 0; k < 3; k++) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    t[k] = r[0][a] * r[1][b] - r[0][b] * r[1][a];
    length = hypot(length, t[k]);
    along += t[k] * at->tangent[k];
  }
  if (at->state != PENDRES_CORRECTION_CONVERGED || !(length > 0.0)) return 0;
  for (int k = 0; k < 3; k++) node->tangent[k] = t[k] / (along < 0.0 ? -length : length);
  memcpy(node->u, at->u, sizeof node->u);
  node->image = at->at.image;
  return fabs(along) > 0.5 * length;
}

/* Whether nodes still follow upon each other, as far apart as before or a little more. */
static int is_whole(const fit_model *m, const fit_curve *c, const range *r, const double *before)
{
  for (size_t i = 1; i < c->nodes; i++) {
    const pendres_curve_node *a = &c->node[i - 1], *b = &c->node[i];
    double ahead = 0.0, turn = 0.0;
    const double way = distance(c, a->u, b->u);
    for (int k = 0; k < 3; k++) {
      const int place = c->kind.system.unknown[k];
      ahead += a->tangent[k] * (b->u[place] - a->u[place]) / scale_at(c, place, b->u[place]);
      turn += a->tangent[k] * b->tangent[k];
    }
    if (way > fit_torn * before[i] + 1e-4 || ahead < 0.5 * way || turn < 0.8) return 0;
  }
  const double inside = 0.5 * (r->high - r->low) * fit_margin / (1.0 + 2.0 * fit_margin);
  return axis_of(m, &c->node[0]) < r->low + inside &&
         axis_of(m, &c->node[c->nodes - 1]) > r->high - inside;
}

/* All nodes at once, each across its tangent. */
static pendres_status move(fit_model *m, fit_curve *c, const fit_values v)
{
  pendres_room room = pendres_room_open(m->ctx, "points of a curve");
  pendres_correction *at = pendres_room_take(&room, c->nodes, sizeof *at);
  double *before = pendres_room_take(&room, c->nodes, sizeof *before);
  int steps = 0;
  size_t highest = 0;
  pendres_status status = room.status;
  if (status != PENDRES_OK) return pendres_room_close(&room, status);
  for (size_t i = 0; i < c->nodes; i++) {
    const pendres_curve_node *n = &c->node[i];
    at[i] = (pendres_correction){.kind = &c->kind};
    memcpy(at[i].tangent, n->tangent, sizeof at[i].tangent);
    pendres_fit_point_at(m, c, v, axis_of(m, n), at[i].u);
    at[i].u[PENDRES_U_Y] = n->u[PENDRES_U_Y];
    at[i].u[PENDRES_U_W] = n->u[PENDRES_U_W];
    if (i > 0) before[i] = distance(c, c->node[i - 1].u, n->u);
    if (hypot(n->u[0], n->u[1]) > hypot(c->node[highest].u[0], c->node[highest].u[1])) highest = i;
  }
  status = pendres_map_steps(m->ctx, m->base.force, at[highest].u, c->kind.tolerance, &steps);
  for (size_t i = 0; i < c->nodes; i++) at[i].steps = steps;
  if (status == PENDRES_OK) status = pendres_follow_correct(m->ctx, c->nodes, at);
  int whole = status == PENDRES_OK;
  for (size_t i = 0; i < c->nodes && whole; i++)
    whole = describe_moved(c, &at[i], &c->node[i]);
  const range r = range_of(m, c, v);
  c->ready = whole && is_whole(m, c, &r, before);
  return pendres_room_close(&room, status);
}

/* ---- pieces ---- */

static void set_pieces(const fit_model *m, fit_curve *c)
{
  c->folds = c->pieces = 0;
  size_t first = 0;
  for (size_t i = 0; i < c->nodes; i++) {
    const int turns = i + 1 < c->nodes && c->node[i].tangent[2] * c->node[i + 1].tangent[2] < 0.0 &&
                      c->folds < FIT_FOLDS;
    if (!turns && i + 1 < c->nodes) continue;
    fit_piece *p = &c->piece[c->pieces++];
    const pendres_image *image = &c->node[(first + i) / 2].image;
    *p = (fit_piece){.first = first, .last = i, .way = c->node[i].tangent[2] > 0.0 ? 1 : -1,
                     .stable = pendres_map_fold(image) > 0.0,
                     .fold = {c->folds > 0 ? (int)c->folds - 1 : -1, turns ? (int)c->folds : -1}};
    const double a = axis_of(m, &c->node[first]), b = axis_of(m, &c->node[i]);
    p->low = fmin(a, b);
    p->high = fmax(a, b);
    if (turns) {
      const double t = c->node[i].tangent[2], s = c->node[i + 1].tangent[2];
      c->fold[c->folds++] = (fit_fold){.after = i, .part = t / (t - s)};
    }
    first = i + 1;
  }
}

/* A point between two nodes at this share of the chord, by the cubic with their tangents; and the
   tangent there. */
static void cubic(const fit_curve *c, const pendres_curve_node *a, const pendres_curve_node *b,
                  double t, pendres_u u, double *tangent)
{
  const double way = distance(c, a->u, b->u);
  double length = 0.0, along[3];
  memcpy(u, a->u, sizeof(pendres_u));
  for (int k = 0; k < 3; k++) {
    const int place = c->kind.system.unknown[k];
    const double scale = scale_at(c, place, 0.5 * (a->u[place] + b->u[place]));
    const double d = (b->u[place] - a->u[place]) / scale;
    const double p = way * a->tangent[k], q = way * b->tangent[k];
    const double e = 3.0 * d - 2.0 * p - q, f = p + q - 2.0 * d;
    u[place] = a->u[place] + scale * t * (p + t * (e + t * f));
    along[k] = p + t * (2.0 * e + 3.0 * t * f);
    length = hypot(length, along[k]);
  }
  for (int k = 0; k < 3 && tangent != NULL; k++) tangent[k] = along[k] / length;
}

void pendres_fit_between(const fit_model *m, const fit_curve *c, const fit_piece *piece,
                         double axis, pendres_u u)
{
  const int place = pendres_fit_place(m);
  size_t low = piece->first, high = piece->last;
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    if ((axis_of(m, &c->node[middle]) < axis) == (piece->way > 0)) low = middle;
    else high = middle;
  }
  const double at_low = axis_of(m, &c->node[low]), at_high = axis_of(m, &c->node[high]);
  /* Next to a fold the chord leads over it. */
  if ((axis - at_low) * piece->way < 0.0 && low > 0) low--;
  else if ((axis - at_high) * piece->way > 0.0 && high + 1 < c->nodes) low = high;
  high = low + 1 < c->nodes ? low + 1 : low;
  double from = 0.0, to = 1.0;
  if (low + 1 == piece->first && piece->fold[0] >= 0) from = c->fold[piece->fold[0]].part;
  if (low == piece->last && piece->fold[1] >= 0) to = c->fold[piece->fold[1]].part;
  for (int i = 0; i < 40; i++) {
    const double t = 0.5 * (from + to);
    cubic(c, &c->node[low], &c->node[high], t, u, NULL);
    if ((u[place] < axis) == (piece->way > 0)) from = t;
    else to = t;
  }
  u[place] = axis;
}

/* ---- folds ---- */

/* Correct the folds' places by secants of the tangent's part along the axis, all side by side. */
static pendres_status place_folds(fit_model *m)
{
  pendres_room room = pendres_room_open(m->ctx, "folds");
  pendres_correction *at = pendres_room_take(&room, m->curves * FIT_FOLDS, sizeof *at);
  pendres_curve_node *ends = pendres_room_take(&room, m->curves * FIT_FOLDS * 2, sizeof *ends);
  pendres_status status = room.status;
  for (int round = 0; round < FIT_FOLD_ROUNDS && status == PENDRES_OK; round++) {
    size_t n = 0;
    for (size_t k = 0; k < m->curves; k++) {
      fit_curve *c = &m->curve[k];
      for (size_t f = 0; f < c->folds; f++, n++) {
        pendres_curve_node *e = &ends[2 * n];
        if (round == 0) memcpy(e, &c->node[c->fold[f].after], 2 * sizeof *e);
        const double t = e[0].tangent[2] / (e[0].tangent[2] - e[1].tangent[2]);
        at[n] = (pendres_correction){.kind = &c->kind};
        cubic(c, &e[0], &e[1], fmin(fmax(t, 0.0), 1.0), at[n].u, at[n].tangent);
        status = pendres_map_steps(m->ctx, m->base.force, at[n].u, c->kind.tolerance, &at[n].steps);
        if (status != PENDRES_OK) return pendres_room_close(&room, status);
      }
    }
    status = pendres_follow_correct(m->ctx, n, at);
    n = 0;
    for (size_t k = 0; k < m->curves && status == PENDRES_OK; k++)
      for (size_t f = 0; f < m->curve[k].folds; f++, n++) {
        fit_fold *fold = &m->curve[k].fold[f];
        pendres_curve_node *e = &ends[2 * n], new = e[0];
        if (at[n].state != PENDRES_CORRECTION_CONVERGED ||
            !describe_moved(&m->curve[k], &at[n], &new))
          return pendres_room_close(&room, pendres_fit_lose(m, "a fold was not found"));
        memcpy(fold->u, new.u, sizeof fold->u);
        memcpy(fold->tangent, new.tangent, sizeof fold->tangent);
        e[(new.tangent[2] < 0.0) == (e[1].tangent[2] < 0.0)] = new;
      }
  }
  return pendres_room_close(&room, status);
}

/* Where they end on a fold pieces reach up to that. */
static void widen_pieces(const fit_model *m, fit_curve *c)
{
  for (size_t k = 0; k < c->pieces; k++)
    for (int end = 0; end < 2; end++) {
      fit_piece *p = &c->piece[k];
      if (p->fold[end] < 0) continue;
      fit_fold *f = &c->fold[p->fold[end]];
      const double s = f->u[pendres_fit_place(m)];
      p->low = fmin(p->low, s);
      p->high = fmax(p->high, s);
      const pendres_curve_node *a = &c->node[f->after], *b = a + 1;
      const double before = distance(c, a->u, f->u);
      f->part = before / (before + distance(c, f->u, b->u));
    }
}

pendres_status pendres_fit_curves(fit_model *m, const fit_values v)
{
  pendres_status status = PENDRES_OK;
  if (m->rotates) return pendres_fit_rotation_curves(m, v);
  m->lost = NULL;
  for (size_t k = 0; k < m->curves && status == PENDRES_OK; k++) {
    fit_curve *c = &m->curve[k];
    if (c->ready) status = move(m, c, v);
    if (status == PENDRES_OK && !c->ready) status = follow(m, c, v);
    if (status == PENDRES_OK) set_pieces(m, c);
  }
  if (status == PENDRES_OK) status = place_folds(m);
  for (size_t k = 0; k < m->curves && status == PENDRES_OK; k++) widen_pieces(m, &m->curve[k]);
  return status;
}
