/* hysteresis_state.c -- a path on its way as plain bytes; see hysteresis_state.h. */
#include "analysis/sweeps/hysteresis_state.h"

#include <stdint.h>
#include <string.h>

#include "analysis/sweeps/hysteresis_crisis.h"
#include "analysis/sweeps/hysteresis_unlocked.h"
#include "model/parameter.h"
#include "orbits/numbers.h"

pendres_bytes pendres_path_question(const pendres_path *w, double x, double v)
{
  struct {
    double x, v, most_slopes, parameter[PENDRES_PARAMETER_FOLLOWED];
    uint64_t n, force, moved, states_only;
  } q = {x, v, w->most_slopes, {0.0}, w->n, (uint64_t)w->pendulum.force, (uint64_t)w->parameter,
         (uint64_t)w->states_only};
  pendres_bytes b = {.reads = 0};
  for (int k = 0; k < PENDRES_PARAMETER_FOLLOWED; k++) /* what moves has no value of its own */
    if (k != (int)w->parameter)
      q.parameter[k] = pendres_parameter_get((pendres_parameter)k, &w->pendulum);
  pendres_bytes_pass(&b, 1, sizeof q, &q);
  for (size_t i = 0; i < w->n; i++) {
    double value = w->all[i];
    pendres_bytes_pass(&b, 1, sizeof value, &value);
  }
  return b;
}

int pendres_path_keeps(const pendres_path *w)
{
  return w->part.branch == NULL || w->part.way.extended >= 0;
}

/* ---- whether bytes can be what they seem: they may come from elsewhere ---- */

static int orbit_fits(const pendres_path *w, const pendres_orbit *o)
{
  return o->pendulum.force == w->pendulum.force && o->period >= 0 &&
         o->period <= ORBIT_LONGEST_PERIOD;
}

static int attractor_fits(const pendres_path *w, const pendres_attractor *a)
{
  return (unsigned)a->label < PENDRES_LABEL_COUNT && orbit_fits(w, &a->orbit);
}

static int way_fits(const pendres_path *w, const pendres_part *s)
{
  const struct pendres_part_way *way = &s->way;
  return orbit_fits(w, &s->at) && s->at.period > 0 && way->extended >= 0 &&
         (size_t)way->extended <= sizeof way->to / sizeof *way->to &&
         (!s->born || ((unsigned)way->birth.kind < PENDRES_SPECIAL_COUNT &&
                       way->birth.parameter == w->parameter && way->birth.orbit.period > 0 &&
                       orbit_fits(w, &way->birth.orbit)));
}

static int results_fit(const pendres_path *w, size_t at)
{
  const pendres_hysteresis *h = w->h;
  int good = 1;
  for (size_t i = 0; i < at && good; i++) {
    const pendres_hysteresis_point *p = &h->point[i];
    good = attractor_fits(w, &p->attractor) && p->outcome == PENDRES_OK &&
           (unsigned)p->certain < 2 && p->value == w->value[i] && h->part[i] <= h->parts;
  }
  for (size_t i = 0; i < h->jumps && good; i++) {
    const pendres_jump *j = &h->jump[i];
    good = j->step < w->n && (j->direction == 1 || j->direction == -1) &&
           (unsigned)j->kind < PENDRES_JUMP_COUNT && (unsigned)j->from < PENDRES_LABEL_COUNT &&
           (unsigned)j->to < PENDRES_LABEL_COUNT && j->to_period >= 0 &&
           (unsigned)j->gradual < 2 && (unsigned)j->certain < 2 && h->jump_from[i] <= h->parts &&
           h->jump_to[i] <= h->parts + 1;
  }
  return good;
}

/* ---- parts of a state ---- */

/* Of a path itself, without what it points to. */
typedef struct standing {
  double at, end;
  uint64_t n, done, jumps, parts, tried;
  int32_t settled, known, certain, beyond, tries, follows;
} standing;

static int standing_fits(const standing *s, const pendres_path_left *left)
{
  return s->n <= left->all && s->done <= s->n && s->settled == (s->done > 0) &&
         (uint32_t)s->known < 2 && (uint32_t)s->certain < 2 && (uint32_t)s->follows < 2 &&
         s->beyond >= -1 && s->beyond <= 1 && s->tries >= 0;
}

/* Which values are left out, and why. */
static void pass_left(pendres_bytes *b, pendres_path *w, pendres_path_left *left)
{
  pendres_bytes_pass(b, w->n, sizeof *left->index, left->index);
  pendres_bytes_pass(b, left->all, sizeof *left->outcome, left->outcome);
  if (!b->reads) return;
  for (size_t i = 0; i < left->all; i++)
    (void)pendres_bytes_fit(b, (unsigned)left->outcome[i] < PENDRES_STATUS_COUNT);
  for (size_t i = 0; i < w->n; i++) {
    const size_t least = i > 0 ? left->index[i - 1] + 1 : 0;
    if (!pendres_bytes_fit(b, left->index[i] >= least && left->index[i] < left->all)) return;
    left->value[i] = w->all[left->index[i]];
  }
}

static void pass_results(pendres_bytes *b, pendres_path *w, size_t at)
{
  pendres_hysteresis *h = w->h;
  pendres_bytes_pass(b, at, sizeof *h->point, h->point);
  pendres_bytes_pass(b, at, sizeof *h->part, h->part);
  pendres_bytes_pass_array(b, h->jumps, sizeof *h->jump, &h->jump);
  pendres_bytes_pass_array(b, h->jumps, sizeof *h->jump_from, &h->jump_from);
  pendres_bytes_pass_array(b, h->jumps, sizeof *h->jump_to, &h->jump_to);
  h->jump_room = h->jumps;
}

void pendres_path_pass(pendres_bytes *b, pendres_path *w, pendres_path_left *left, size_t *at,
                       int *follows)
{
  pendres_hysteresis *h = w->h;
  pendres_arrival *state = &w->state;
  standing s = {.at = w->at, .end = w->end, .n = w->n, .done = *at, .jumps = h->jumps,
                .parts = h->parts, .tried = w->tried, .settled = w->settled, .known = w->known,
                .certain = w->certain, .beyond = w->beyond, .tries = w->tries,
                .follows = w->part.branch != NULL};
  pendres_bytes_pass(b, 1, sizeof s, &s);
  if (!pendres_bytes_fit(b, standing_fits(&s, left))) return;
  w->at = s.at;
  w->end = s.end;
  w->n = s.n;
  *at = s.done;
  h->jumps = s.jumps;
  h->parts = s.parts;
  w->tried = s.tried;
  w->settled = s.settled;
  w->known = s.known;
  w->certain = s.certain;
  w->beyond = s.beyond;
  w->tries = s.tries;
  *follows = s.follows;
  pass_left(b, w, left);
  pass_results(b, w, *at);
  pendres_bytes_pass(b, 1, sizeof *state, state);
  if (s.follows) {
    pendres_bytes_pass(b, 1, sizeof w->part.born, &w->part.born);
    pendres_bytes_pass(b, 1, sizeof w->part.at, &w->part.at);
    pendres_bytes_pass(b, 1, sizeof w->part.way, &w->part.way);
  }
  pendres_crisis_seen_pass(b, w);
  pendres_path_unlocked_pass(b, w);
  if (b->reads)
    (void)(pendres_bytes_end(b) &&
           pendres_bytes_fit(b, results_fit(w, *at) && attractor_fits(w, &state->attractor) &&
                                  state->pendulum.force == w->pendulum.force &&
                                  (!s.follows || way_fits(w, &w->part))));
}
