/* stages.c -- which states an oscillator is on along a sweep, and residuals; see internal.h. */
#include "analysis/fit_model/internal.h"

#include <math.h>
#include <string.h>

#include "base/angles.h"

/* The end of a piece that a sweep this way comes to (1) or comes from (0): the number of its fold,
   -1 if there is none. */
static int fold_at(const fit_piece *p, int direction, int end)
{
  return p->fold[(p->way > 0) == (direction > 0) ? end : !end];
}

/* The stable piece that a state jumps to at this value of the axis: the next one along the curve,
   in the sweep's sense. -1: there is none. */
static int next_piece(const fit_curve *c, int from, int direction, double axis)
{
  for (int pass = 0; pass < 2; pass++) {
    const int step = (direction > 0) == (pass == 0) ? 1 : -1;
    for (int k = from + step; k >= 0 && k < (int)c->pieces; k += step)
      if (c->piece[k].stable && c->piece[k].low <= axis && axis <= c->piece[k].high) return k;
  }
  return -1;
}

/* The first stable piece of a sweep: that at the end of the curve where the sweep begins. */
static void set_track(const fit_model *m, fit_track *t)
{
  const fit_curve *c = &m->curve[t->curve];
  int at = t->direction > 0 ? 0 : (int)c->pieces - 1;
  while (at >= 0 && at < (int)c->pieces && !c->piece[at].stable) at += t->direction;
  t->stages = 0;
  while (at >= 0 && at < (int)c->pieces && t->stages < FIT_STAGES) {
    t->piece[t->stages++] = at;
    const int fold = fold_at(&c->piece[at], t->direction, 1);
    if (fold < 0) return;
    at = next_piece(c, at, t->direction, c->fold[fold].u[pendres_fit_place(m)]);
  }
}

/* The lane of a station on a stage: an orbit of its own, that of the fold at which the piece ends
   before it, or none. */
static void set_lane(fit_model *m, const fit_values v, const fit_track *t, fit_station *s,
                     int stage)
{
  const fit_curve *c = &m->curve[t->curve];
  const fit_piece *p = &c->piece[t->piece[stage]];
  const double axis = pendres_fit_in(m, m->axis, v, s->axis);
  s->beyond[stage] = axis < p->low ? -1 : axis > p->high;
  s->lane[stage] = -1;
  if (s->beyond[stage] != 0) {
    const int fold = fold_at(p, s->beyond[stage], 1);
    if (fold >= 0) s->lane[stage] = (long)c->fold[fold].lane;
    return;
  }
  fit_lane *l = &m->lane[m->lanes];
  *l = (fit_lane){.border = {0.0, 0.0, 1.0}};
  if (m->rotates) {
    pendres_fit_point_at(m, c, v, axis, l->u);
    l->u[PENDRES_U_W] = p->state;
  } else {
    pendres_fit_between(m, c, p, axis, l->u);
  }
  s->lane[stage] = (long)m->lanes++;
}

static void set_folds(fit_model *m)
{
  m->lanes = 0;
  for (size_t k = 0; k < m->curves; k++)
    for (size_t f = 0; f < m->curve[k].folds; f++) {
      fit_fold *fold = &m->curve[k].fold[f];
      fit_lane *l = &m->lane[m->lanes];
      *l = (fit_lane){.found = 0};
      memcpy(l->border, fold->tangent, sizeof l->border);
      memcpy(l->u, fold->u, sizeof l->u);
      fold->lane = m->lanes++;
    }
}

/* The most steps that one of the orbits of largest amplitude takes: those of each curve. */
static pendres_status choose_steps(fit_model *m, int *steps)
{
  pendres_status status = PENDRES_OK;
  *steps = 0;
  for (size_t k = 0; k < m->curves && status == PENDRES_OK; k++) {
    const fit_curve *c = &m->curve[k];
    size_t high = 0;
    int some = 0;
    for (size_t i = 1; i < c->nodes; i++)
      if (hypot(c->node[i].u[0], c->node[i].u[1]) > hypot(c->node[high].u[0], c->node[high].u[1]))
        high = i;
    const double enough = fmin(fit_accuracy, m->ctx->options.tolerance * 10.0);
    status = pendres_map_steps(m->ctx, m->base.force, c->node[high].u, enough, &some);
    if (some > *steps) *steps = some;
  }
  return status;
}

/* An orbit that was not found between nodes next to a fold is as good as at the fold. */
static int mend(const fit_model *m, const fit_track *t, fit_station *s, int stage)
{
  const fit_curve *c = &m->curve[t->curve];
  const fit_piece *p = &c->piece[t->piece[stage]];
  if (s->lane[stage] < 0 || m->lane[s->lane[stage]].found) return 1;
  const double axis = m->lane[s->lane[stage]].u[pendres_fit_place(m)];
  double nearest = INFINITY;
  for (int end = 0; end < 2; end++) {
    if (p->fold[end] < 0) continue;
    const fit_fold *f = &c->fold[p->fold[end]];
    const double away = fabs(f->u[pendres_fit_place(m)] - axis);
    if (away >= nearest || !m->lane[f->lane].found) continue;
    nearest = away;
    s->lane[stage] = (long)f->lane;
  }
  return nearest < fit_lost_near_fold * (p->high - p->low);
}

const fit_lane *pendres_fit_fold_lane(const fit_model *m, const fit_track *t, int stage)
{
  const fit_curve *c = &m->curve[t->curve];
  const int fold = fold_at(&c->piece[t->piece[stage]], t->direction, 1);
  return fold >= 0 ? &m->lane[c->fold[fold].lane] : NULL;
}

pendres_status pendres_fit_stages(fit_model *m, const fit_values v)
{
  int steps = 0;
  if (m->decays) return pendres_fit_decay(m, v);
  pendres_status status = m->rotates ? PENDRES_OK : choose_steps(m, &steps);
  if (status != PENDRES_OK) return status;
  if (m->usual_steps == 0) m->usual_steps = steps;
  if (steps > FIT_MORE_STEPS * m->usual_steps || steps > FIT_MOST_STEPS)
    return pendres_fit_lose(m, "the values lead to motions far from those of the data");
  set_folds(m);
  for (size_t k = 0; k < m->tracks; k++) {
    fit_track *t = &m->track[k];
    set_track(m, t);
    for (size_t i = t->first; i < t->first + t->count; i++)
      for (int j = 0; j < t->stages; j++) set_lane(m, v, t, &m->station[i], j);
  }
  if (m->rotates) pendres_fit_rotations(m);
  else status = pendres_fit_quarters(m, v, steps);
  if (status == PENDRES_OK && !m->rotates)
    status = pendres_fit_orbits(m, steps, m->lanes, m->lane);
  if (status == PENDRES_OK && !pendres_fit_find_marks(m, v)) return PENDRES_NOT_CONVERGED;
  for (size_t k = 0; k < m->tracks && status == PENDRES_OK; k++) {
    const fit_track *t = &m->track[k];
    for (size_t i = t->first; i < t->first + t->count; i++)
      for (int j = 0; j < t->stages; j++)
        if (!mend(m, t, &m->station[i], j))
          return pendres_fit_lose(m, "an orbit at a datum was not found");
  }
  return status;
}

/* ---- residuals ---- */

static double residual_of(const fit_model *m, const fit_values v, const fit_station *s, int stage,
                          size_t datum, fit_values slope)
{
  const pendres_fit_datum *d = &m->datum[datum];
  const fit_lane *l = &m->lane[s->lane[stage]];
  const int bound = l->border[2] == 1.0;
  double r = d->observed - pendres_fit_observe(m, v, l, d->observable, bound, slope);
  if (d->observable == PENDRES_FIT_PHASE_LAG) r = remainder(r, two_pi);
  return r;
}

static double loss(double r, double huber)
{
  const double a = fabs(r);
  return huber > 0.0 && a > huber ? huber * (2.0 * a - huber) : a * a;
}

/* What the data of a station cost on a stage. */
static double cost_of(const fit_model *m, const fit_values v, const fit_terms *t,
                      const fit_station *s, int stage)
{
  fit_values unused;
  double sum = 0.0;
  if (s->lane[stage] < 0) return INFINITY;
  for (size_t k = s->first; k < s->first + s->count; k++) {
    const size_t datum = m->order[k];
    sum += loss(residual_of(m, v, s, stage, datum, unused) / t->error[datum], t->huber);
  }
  return sum;
}

/* Between which values of the axis the data jump if they do before station i of a track; i may be
   the number of stations. */
static void gap_before(const fit_model *m, const fit_track *t, size_t i, double gap[2])
{
  gap[0] = i > 0 ? m->station[t->first + i - 1].axis : NAN;
  gap[1] = i < t->count ? m->station[t->first + i].axis : NAN;
}

/*
 * The deviation, in gaps, of where data jump that hardly tell a rotation from rest, between station
 * i - 1 and i. A datum on the wrong state costs d^2 of chi-square, where d is by how many errors
 * the data on both sides differ; n of them are exp(-d^2/2)^n as likely as none, on either side.
 * Next to the gap the velocity of a rotation falls steeply: the data there are not read.
 */
static double blur(const fit_model *m, const fit_terms *terms, const fit_track *t, size_t i)
{
  double observed[4];
  if (!m->rotates || i < 2 || i >= t->count) return 0.0;
  const size_t at[4] = {i > 2 ? i - 3 : i - 2, i - 2, i, i + 1 < t->count ? i + 1 : i};
  for (int k = 0; k < 4; k++)
    observed[k] = m->datum[m->order[m->station[t->first + at[k]].first]].observed;
  const double step = 0.5 * (observed[0] + observed[1] - observed[2] - observed[3]);
  const double d = fit_last_voltage * step / terms->error[m->order[m->station[t->first + i].first]];
  const double wrong = exp(-0.5 * d * d);
  return sqrt(2.0 * wrong) / fmax(1.0 - wrong, 1.0 / (double)t->count);
}

/* The residual of a jump of the model from a stage, if the data's is in this gap: from its middle
   in units of the deviation of an even spread over it; beyond the data from their end. *scale is
   that unit. */
static double jump_residual(const fit_model *m, const fit_track *t, const fit_terms *terms,
                            const double gap[2], double fold, double *scale)
{
  const double mean =
    (fabs(m->station[t->first + t->count - 1].axis - m->station[t->first].axis)) /
    (double)(t->count > 1 ? t->count - 1 : 1);
  const int inside = !isnan(gap[0]) && !isnan(gap[1]);
  const double wide = inside ? fabs(gap[1] - gap[0]) : mean;
  *scale = hypot(wide / sqrt(12.0), terms->jump_error);
  if (inside) return (0.5 * (gap[0] + gap[1]) - fold) / *scale;
  /* Nothing was seen: no objection to what lies behind the data, nor to a sweep that began on
     another state. */
  const int seen = isnan(gap[1]) && (fold - gap[0]) * t->direction < 0.0;
  return seen ? (gap[0] - fold) / *scale : 0.0;
}

/* The jumps from each stage to the next, with the data before station i on the one and from there
   on the other: what they cost. */
static double jump_cost(const fit_model *m, const fit_values v, const fit_terms *terms,
                        const fit_track *t, size_t i, int stage)
{
  double gap[2], scale;
  fit_values unused;
  const fit_lane *l = pendres_fit_fold_lane(m, t, stage);
  if (l == NULL || !l->found) return INFINITY;
  if (l->gradual) return 0.0;
  gap_before(m, t, i, gap);
  const double r =
    jump_residual(m, t, terms, gap, pendres_fit_place_at(m, v, l, unused), &scale);
  return loss(r, terms->huber);
}

/*
 * The cheapest way through the stages: cost[j] is that of all stations so far with the last of them
 * on stage j. from[i][j]: the stage of the station before. A state may pass several stages between
 * two data.
 */
static void assign(fit_model *m, const fit_values v, const fit_terms *terms, fit_track *t,
                   signed char (*from)[FIT_STAGES])
{
  double cost[FIT_STAGES];
  for (size_t i = 0; i <= t->count; i++) {
    double reached[FIT_STAGES], jump[FIT_STAGES];
    for (int j = 0; j + 1 < t->stages; j++) jump[j] = jump_cost(m, v, terms, t, i, j);
    for (int j = 0; j < t->stages; j++) {
      reached[j] = i == 0 ? (j == 0 ? 0.0 : INFINITY) : cost[j];
      from[i][j] = (signed char)j;
      double way = 0.0;
      for (int k = j - 1; k >= 0; k--) {
        way += jump[k];
        const double before = i == 0 ? (k == 0 ? 0.0 : INFINITY) : cost[k];
        if (!(before + way < reached[j])) continue;
        reached[j] = before + way;
        from[i][j] = (signed char)k;
      }
    }
    for (int j = 0; j < t->stages; j++)
      cost[j] = i < t->count
                  ? reached[j] + cost_of(m, v, terms, &m->station[t->first + i], j)
                  : reached[j];
  }
  /* Stages that are not reached in the data come behind their end, all with their costs. */
  int at = t->stages - 1;
  for (size_t i = t->count + 1; i-- > 0;) {
    if (i < t->count) m->station[t->first + i].stage = at;
    at = from[i][at];
  }
}

/* The rows of a track's jumps. */
static void take_jumps(const fit_model *m, const fit_values v, const fit_terms *terms, size_t track,
                       fit_rows *rows)
{
  const fit_track *t = &m->track[track];
  for (int j = 0; j + 1 < FIT_STAGES; j++) {
    const size_t row = m->data + track * (FIT_STAGES - 1) + (size_t)j;
    size_t i = 0;
    double gap[2], scale = 1.0;
    rows->used[row - m->data] = 0;
    rows->residual[row] = 0.0;
    memset(rows->slope[row], 0, sizeof rows->slope[row]);
    if (t->count == 0 || j + 1 >= t->stages || pendres_fit_fold_lane(m, t, j)->gradual) continue;
    while (i < t->count && m->station[t->first + i].stage <= j) i++;
    gap_before(m, t, i, gap);
    const double fold = pendres_fit_place_at(m, v, pendres_fit_fold_lane(m, t, j),
                                             rows->slope[row]);
    const double sharp = jump_residual(m, t, terms, gap, fold, &scale);
    const double before = scale, wide = blur(m, terms, t, i);
    if (wide > 0.0) scale = hypot(scale, wide * fabs(gap[1] - gap[0]));
    rows->residual[row] = wide > 0.0 ? sharp * before / scale : sharp;
    rows->used[row - m->data] = isnan(gap[0]) || isnan(gap[1]) ? 2 : 1;
    const int free_of = rows->residual[row] == 0.0 && rows->used[row - m->data] == 2;
    for (int q = 0; q < FIT_QUANTITIES; q++)
      rows->slope[row][q] *= free_of ? 0.0 : -1.0 / scale;
  }
}

/* Whether a station is one of the last two before a rotation ends, where its velocity falls like
   one over a logarithm: what noise does to it is no small change of the torque, and the place of
   the jump says as much. */
static int is_left(const fit_model *m, const fit_track *t, size_t i)
{
  const fit_station *s = &m->station[i];
  const size_t last = t->first + t->count - 1;
  if (!m->rotates || m->station[i + 2 < last ? i + 2 : last].stage == s->stage) return 0;
  return m->curve[t->curve].piece[t->piece[s->stage]].state != 0 &&
         !pendres_fit_fold_lane(m, t, s->stage)->gradual;
}

void pendres_fit_residuals(fit_model *m, const fit_values v, const fit_terms *terms, fit_rows *rows)
{
  m->left = 0;
  for (size_t k = 0; k < m->tracks; k++) {
    fit_track *t = &m->track[k];
    if (t->count > 0) assign(m, v, terms, t, rows->from);
    for (size_t i = t->first; i < t->first + t->count; i++) {
      const fit_station *s = &m->station[i];
      for (size_t n = s->first; n < s->first + s->count; n++) {
        const size_t datum = m->order[n];
        const double error = terms->error[datum];
        rows->residual[datum] = residual_of(m, v, s, s->stage, datum, rows->slope[datum]) / error;
        for (int q = 0; q < FIT_QUANTITIES; q++) rows->slope[datum][q] /= -error;
        const int left = is_left(m, t, i);
        m->left += (size_t)left;
        if (!left && (!m->decays || i < m->active)) continue;
        rows->residual[datum] = 0.0;
        memset(rows->slope[datum], 0, sizeof rows->slope[datum]);
      }
    }
    take_jumps(m, v, terms, k, rows);
  }
  for (size_t i = 0; i < m->marks; i++) {
    const fit_mark *mark = &m->mark[i];
    const size_t datum = mark->datum;
    const fit_lane *l = &m->lane[mark->lane];
    const double value = pendres_fit_place_at(m, v, l, rows->slope[datum]);
    rows->residual[datum] = (m->datum[datum].observed - value) / terms->error[datum];
    for (int q = 0; q < FIT_QUANTITIES; q++) rows->slope[datum][q] /= -terms->error[datum];
  }
}
