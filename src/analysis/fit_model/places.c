/*
 * places.c -- places on the axis that are data: folds, at which the state jumps, and resonances,
 * where the first harmonic lags by a quarter turn; see internal.h.
 */
#include "analysis/fit_model/internal.h"

#include <math.h>
#include <string.h>

/* ---- resonances ---- */

/* The points between neighbouring nodes of a curve whose parts in phase, as the instrument tells
   them, differ in sign: places to begin from. */
static void between_nodes(fit_curve *c, const fit_lane *at, const double turn[2])
{
  double before = NAN;
  c->quarters = 0;
  for (size_t i = 0; i < c->nodes && c->quarters < FIT_FOLDS; i++) {
    const double part = at[i].base[PENDRES_FIT_IN_PHASE] * turn[0] -
                        at[i].base[PENDRES_FIT_QUADRATURE] * turn[1];
    const double here = at[i].found ? part : NAN;
    if (before * here < 0.0) {
      fit_fold *f = &c->quarter[c->quarters++];
      *f = (fit_fold){.after = i - 1, .part = before / (before - here)};
      for (int k = 0; k < PENDRES_U_COUNT; k++)
        f->u[k] = (1.0 - f->part) * c->node[i - 1].u[k] + f->part * c->node[i].u[k];
    }
    before = here;
  }
}

pendres_status pendres_fit_quarters(fit_model *m, const fit_values v, int steps)
{
  const double turn[2] = {cos(v[PENDRES_FIT_PHASE_OFFSET]), sin(v[PENDRES_FIT_PHASE_OFFSET])};
  pendres_status status = PENDRES_OK;
  for (size_t k = 0; k < m->curves && status == PENDRES_OK; k++) {
    fit_curve *c = &m->curve[k];
    c->quarters = 0;
    if (!c->tuned) continue;
    pendres_room room = pendres_room_open(m->ctx, "phases along a curve");
    fit_lane *at = pendres_room_take(&room, c->nodes, sizeof *at);
    status = room.status;
    for (size_t i = 0; i < c->nodes && status == PENDRES_OK; i++) {
      memcpy(at[i].border, c->node[i].tangent, sizeof at[i].border);
      memcpy(at[i].u, c->node[i].u, sizeof at[i].u);
    }
    if (status == PENDRES_OK) status = pendres_fit_orbits(m, steps, c->nodes, at);
    if (status == PENDRES_OK) between_nodes(c, at, turn);
    for (size_t i = 0; i < c->quarters; i++) {
      fit_lane *l = &m->lane[m->lanes];
      *l = (fit_lane){.tuned = 1, .turn = {turn[0], turn[1]}};
      memcpy(l->u, c->quarter[i].u, sizeof l->u);
      c->quarter[i].lane = m->lanes++;
    }
    status = pendres_room_close(&room, status);
  }
  return status;
}

/* ---- which is which ---- */

/* Let a mark be a lane, at which a stage ends, if that is nearer to it than what was before. */
static void consider(const fit_model *m, const fit_values v, fit_mark *mark, size_t lane, int stage,
                     double *nearest)
{
  fit_values unused;
  const fit_lane *l = &m->lane[lane];
  const double observed = m->datum[mark->datum].observed;
  if (!l->found) return;
  const double away = fabs(pendres_fit_place_at(m, v, l, unused) - observed);
  if (!(away < *nearest)) return;
  *nearest = away;
  mark->lane = lane;
  mark->stage = stage;
}

int pendres_fit_find_marks(fit_model *m, const fit_values v)
{
  for (size_t i = 0; i < m->marks; i++) {
    fit_mark *mark = &m->mark[i];
    const fit_track *t = &m->track[mark->track];
    const fit_curve *c = &m->curve[t->curve];
    const int jumps = m->datum[mark->datum].observable == PENDRES_FIT_JUMP;
    double nearest = INFINITY;
    for (int j = 0; jumps && j + 1 < t->stages; j++)
      consider(m, v, mark, (size_t)(pendres_fit_fold_lane(m, t, j) - m->lane), j, &nearest);
    for (size_t k = 0; !jumps && k < c->quarters; k++)
      consider(m, v, mark, c->quarter[k].lane, -1, &nearest);
    if (isfinite(nearest)) continue;
    m->lost = jumps ? "the model has no jump in a sweep in which one was measured"
                    : "the model has no resonance where one was measured";
    return 0;
  }
  return 1;
}
