/*
 * kernels_nystrom_run.h -- a period of a group of lanes, in one precision; see kernels_nystrom.h.
 *
 * Owns: the loop of kernels_nystrom.c, which includes it for double and for single precision, with
 * REAL the type, VECTOR a vector of it, WIDE how many elements that has, MOST the most vectors of a
 * group, FUSED a fused multiply-add of vectors, FORCES those of all models but the polynomial, with
 * their derivatives unless these are NULL, TO_WHOLE what rounds by being added, and NAME(x) what x
 * is called there.
 */
#define EACH _Pragma("GCC unroll 16") for (int v = 0; v < count; v++)
#define ROW(row) REAL row[MOST * WIDE]
#define AT(row) (*(VECTOR *)((row) + v * WIDE))

/* Lanes of a group that stay in the nearest cache for a period. */
typedef struct NAME(group) {
  ROW(u);
  ROW(p); /* of the step's start: h u' */
  ROW(lost_u); /* what rounding took away from these */
  ROW(lost_p);
  ROW(stiffness); /* h^2 times */
  ROW(drive);
  ROW(torque);
  ROW(modulation);
  REAL power[PENDRES_FORCE_POWERS][MOST * WIDE];
  ROW(square); /* (friction h / 2)^2 */
  ROW(gone);   /* 1 - E(h) */
  REAL less[STAGES][MOST * WIDE], more[STAGES][MOST * WIDE]; /* E and 1/E at the stages */
  REAL slope[STAGES][MOST * WIDE];                           /* h^2 u'' */
  ROW(yy);
  ROW(yw);
  ROW(ww);
  ROW(added);
  ROW(keep);
  ROW(kick);
  ROW(a); /* the tangent of y, and h times that of u' */
  ROW(b);
  REAL bent[STAGES][MOST * WIDE]; /* the slope's */
  double size[MOST * WIDE];       /* of both, of which the rows hold shares */
} __attribute__((aligned(64))) NAME(group);

static const REAL NAME(inner)[STAGES][STAGES] = INNER;
static const REAL NAME(place)[STAGES] = PLACE, NAME(speed)[STAGES] = SPEED;

INLINE VECTOR NAME(set)(REAL a)
{
  return a - (VECTOR){0};
}

/* f at y[v], and unless it is NULL its derivative, of a polynomial force. */
INLINE void NAME(polynomial)(int count, const NAME(group) *g, VECTOR *y, VECTOR *slope)
{
  enum { LAST = PENDRES_FORCE_POWERS - 1 };
  VECTOR t[MOST], by[MOST];
  EACH t[v] = AT(g->power[LAST]);
  EACH by[v] = NAME(set)((REAL)0);
  for (int i = LAST - 1; i >= 0; i--) {
    if (slope != NULL) EACH by[v] = FUSED(by[v], y[v], t[v]);
    EACH t[v] = FUSED(t[v], y[v], AT(g->power[i]));
  }
  if (slope != NULL) EACH slope[v] = FUSED(by[v], y[v], t[v]);
  EACH y[v] = t[v] * y[v];
}

INLINE void NAME(force)(pendres_model_terms model, int count, const source *from,
                        const NAME(group) *g, VECTOR *y, VECTOR *slope)
{
  if (model == PENDRES_MODEL_POLYNOMIAL)
    NAME(polynomial)(count, g, y, slope);
  else
    FORCES(model, count, from, y, slope);
}

/* Sum over the earlier slopes of a stage, from the start and the speed. */
INLINE void NAME(sum)(int count, int j, const REAL *at, const REAL *speed,
                      REAL slope[STAGES][MOST * WIDE], VECTOR *y)
{
  VECTOR f = NAME(set)((REAL)pendres_nystrom_node[j] / (REAL)20);
  EACH y[v] = FUSED(f, AT(speed), AT(at));
  for (int m = 0; m < j; m++) {
    f = NAME(set)(NAME(inner)[j][m]);
    EACH y[v] = FUSED(f, AT(slope[m]), y[v]);
  }
}

INLINE void NAME(stage)(pendres_model_terms model, int count, int tangents, int j, REAL cosine,
                        const source *from, NAME(group) *g)
{
  VECTOR y[MOST], slope[MOST];
  const VECTOR f = NAME(set)(cosine);
  NAME(sum)(count, j, g->u, g->p, g->slope, y);
  EACH AT(g->slope[j]) = y[v];
  if (j > 0) EACH y[v] = y[v] * AT(g->less[j]);
  NAME(force)(model, count, from, g, y, tangents ? slope : NULL);
  if (model != PENDRES_MODEL_PLAIN)
    EACH
    {
      const VECTOR driven = FUSED(AT(g->modulation), f, NAME(set)((REAL)1));
      y[v] = y[v] * driven;
      if (tangents) slope[v] = slope[v] * driven;
    }
  EACH
  {
    VECTOR rest = f * AT(g->drive);
    if (model != PENDRES_MODEL_PLAIN) rest = rest + AT(g->torque);
    y[v] = FUSED(-AT(g->stiffness), y[v], rest);
  }
  if (j > 0) EACH y[v] = y[v] * AT(g->more[j]);
  EACH AT(g->slope[j]) = FUSED(AT(g->square), AT(g->slope[j]), y[v]);
  if (!tangents) return;
  NAME(sum)(count, j, g->a, g->b, g->bent, y);
  EACH AT(g->bent[j]) = FUSED(-AT(g->stiffness), slope[v], AT(g->square)) * y[v];
}

/* One of both numbers of the state over a step, by its change so far. */
INLINE void NAME(damp)(int count, const REAL *gone, VECTOR *change, REAL *state, REAL *lost)
{
  EACH
  {
    const VECTOR before = AT(state);
    const VECTOR c = FUSED(-AT(gone), before + change[v], change[v]) + AT(lost);
    const VECTOR next = before + c;
    AT(lost) = c - (next - before);
    AT(state) = next;
  }
}

INLINE void NAME(end_sums)(int count, const REAL *speed, REAL slope[STAGES][MOST * WIDE],
                           VECTOR *u, VECTOR *p)
{
  EACH u[v] = AT(speed);
  EACH p[v] = NAME(set)((REAL)0);
  for (int m = 0; m < STAGES; m++) {
    const VECTOR a = NAME(set)(NAME(place)[m]), b = NAME(set)(NAME(speed)[m]);
    EACH u[v] = FUSED(a, AT(slope[m]), u[v]);
    EACH p[v] = FUSED(b, AT(slope[m]), p[v]);
  }
}

INLINE void NAME(end_step)(int count, int tangents, NAME(group) *g)
{
  VECTOR u[MOST], p[MOST];
  NAME(end_sums)(count, g->p, g->slope, u, p);
  NAME(damp)(count, g->gone, u, g->u, g->lost_u);
  NAME(damp)(count, g->gone, p, g->p, g->lost_p);
  if (!tangents) return;
  NAME(end_sums)(count, g->b, g->bent, u, p);
  EACH
  {
    const VECTOR a = AT(g->a) + u[v], b = AT(g->b) + p[v];
    AT(g->a) = FUSED(-AT(g->gone), a, a);
    AT(g->b) = FUSED(-AT(g->gone), b, b);
  }
}

/* cos y within 1e-4, as pendres_kernels_cos_roughly(). */
INLINE VECTOR NAME(cosine_roughly)(VECTOR y)
{
  const VECTOR shift = NAME(set)(TO_WHOLE);
  const VECTOR turns = FUSED(y, NAME(set)((REAL)0.15915494309189535), shift) - shift;
  const VECTOR r = FUSED(-turns, NAME(set)((REAL)6.283185307179586), y), s = r * r;
  VECTOR p = FUSED(s, NAME(set)((REAL)1.87708309275e-05), NAME(set)((REAL)-0.00133885087532));
  p = FUSED(p, s, NAME(set)((REAL)0.0414934583954));
  p = FUSED(p, s, NAME(set)((REAL)-0.499788065521));
  return FUSED(p, s, NAME(set)((REAL)0.99995823162));
}

/* Errors over the step from half a step before a state to half a step after it: carry() of
   kernels.c. */
INLINE void NAME(carry)(pendres_model_terms model, int count, REAL step, REAL cosine,
                        const source *from, NAME(group) *g)
{
  VECTOR at[MOST], y[MOST];
  const VECTOR half = NAME(set)((REAL)0.5 * step);
  const VECTOR weight = NAME(set)((REAL)1 / (step * step));
  EACH at[v] = AT(g->u);
  if (model < PENDRES_MODEL_POLYNOMIAL)
    EACH y[v] = NAME(cosine_roughly)(at[v]);
  else
    NAME(force)(model, count, from, g, at, y);
  if (model != PENDRES_MODEL_PLAIN)
    EACH y[v] = y[v] * FUSED(AT(g->modulation), NAME(set)(cosine), NAME(set)((REAL)1));
  EACH
  {
    const VECTOR pull = AT(g->kick) * y[v], left = AT(g->keep);
    VECTOR b = FUSED(half, AT(g->ww), AT(g->yw));
    VECTOR a = FUSED(half, AT(g->yw) + b, AT(g->yy));
    const VECTOR mixed = FUSED(left, b, -(pull * a));
    const VECTOR c = FUSED(left, FUSED(left, AT(g->ww), -(pull * b)), -(pull * mixed));
    b = FUSED(half, c, mixed);
    a = FUSED(half, mixed + b, a);
    AT(g->yy) = a + AT(g->added);
    AT(g->yw) = b;
    AT(g->ww) = FUSED(AT(g->stiffness) * weight, AT(g->added), c);
  }
}

/* e to the powers of the stages' places, from e of a twentieth of a step. */
INLINE void NAME(powers)(double e, size_t i, REAL at[STAGES][MOST * WIDE])
{
  const double e2 = e * e, e4 = e2 * e2, e6 = e4 * e2, e10 = e6 * e4, e14 = e10 * e4;
  const double e18 = e14 * e4;
  at[1][i] = (REAL)e;
  at[2][i] = (REAL)e2;
  at[3][i] = (REAL)e6;
  at[4][i] = (REAL)e10;
  at[5][i] = (REAL)e14;
  at[6][i] = (REAL)e18;
  at[7][i] = (REAL)(e18 * e2);
}

INLINE void NAME(load)(pendres_model_terms model, double step, const pendres_nystrom_lanes *b,
                       size_t lane, size_t lanes, NAME(group) *g)
{
  const pendres_coefficients k = b->k;
  const double square = step * step;
  _Pragma("omp simd") for (size_t i = 0; i < lanes; i++)
  {
    const size_t at = lane + i;
    const double half = 0.5 * step * k.friction[at], y = b->y[at];
    const double p = fma_one(half, y, step * b->w[at]), x = half / 20.0;
    g->u[i] = (REAL)y;
    g->p[i] = (REAL)p;
    g->lost_u[i] = (REAL)(y - g->u[i]);
    g->lost_p[i] = (REAL)(p - g->p[i]);
    g->stiffness[i] = (REAL)(square * k.stiffness[at]);
    g->drive[i] = (REAL)(square * k.drive[at]);
    g->square[i] = (REAL)(half * half);
    g->gone[i] = (REAL)(half * mean_decay_far(half));
    NAME(powers)(fma_one(-x, mean_decay_near(x), 1.0), i, g->less);
    NAME(powers)(fma_one(x, mean_decay_near(-x), 1.0), i, g->more);
    if (model != PENDRES_MODEL_PLAIN) {
      g->torque[i] = (REAL)(square * k.torque[at]);
      g->modulation[i] = (REAL)k.modulation[at];
      for (int c = 0; c < PENDRES_FORCE_POWERS; c++)
        g->power[c][i] = (REAL)k.power[c][at];
    }
  }
}

/* What lanes carry. */
INLINE void NAME(load_more)(double step, const pendres_nystrom_lanes *b, size_t lane, size_t lanes,
                            NAME(group) *g)
{
  const pendres_carried off = b->off;
  if (b->tangent_y != NULL)
    for (size_t i = 0; i < lanes; i++) {
      const double y = b->tangent_y[lane + i], w = step * b->tangent_w[lane + i];
      g->size[i] = fmax(fabs(y) + fabs(w), DBL_MIN);
      g->a[i] = (REAL)(y / g->size[i]);
      g->b[i] = (REAL)(w / g->size[i]);
    }
  if (off.yy == NULL) return;
  _Pragma("omp simd") for (size_t i = 0; i < lanes; i++)
  {
    const size_t at = lane + i;
    g->yy[i] = (REAL)off.yy[at];
    g->yw[i] = (REAL)off.yw[at];
    g->ww[i] = (REAL)off.ww[at];
    g->added[i] = (REAL)off.added[at];
    g->keep[i] = (REAL)off.keep[at];
    g->kick[i] = (REAL)off.kick[at];
  }
}

INLINE void NAME(store)(double step, const pendres_nystrom_lanes *b, size_t lane, size_t lanes,
                        const NAME(group) *g)
{
  const double *friction = b->k.friction, each = 1.0 / step;
  _Pragma("omp simd") for (size_t i = 0; i < lanes; i++)
  {
    const size_t at = lane + i;
    const double y = (double)g->u[i] + g->lost_u[i], p = (double)g->p[i] + g->lost_p[i];
    b->y[at] = y;
    b->w[at] = fma_one(-0.5 * friction[at], y, p * each);
  }
  if (b->tangent_y != NULL)
    for (size_t i = 0; i < lanes; i++) {
      b->tangent_y[lane + i] = g->size[i] * g->a[i];
      b->tangent_w[lane + i] = g->size[i] * g->b[i] * each;
    }
  if (b->off.yy == NULL) return;
  _Pragma("omp simd") for (size_t i = 0; i < lanes; i++)
  {
    const size_t at = lane + i;
    b->off.yy[at] = g->yy[i];
    b->off.yw[at] = g->yw[i];
    b->off.ww[at] = g->ww[i];
  }
}

/* The lanes of a block from one on that `count` vectors hold. */
INLINE void NAME(run_group)(pendres_model_terms model, int count, int tangents,
                            const pendres_nystrom_steps *s, const pendres_nystrom_lanes *b,
                            size_t lane)
{
  NAME(group) g;
  source from;
  pendres_kernels_formula formula[2]; /* of one alone */
  const double step = two_pi / s->steps, *cosine = s->cosine;
  size_t lanes = (size_t)count * WIDE;
  if (lane + lanes > b->lanes) {
    /* Fewer than a vector has: what is left of it is at rest. */
    memset(&g, 0, sizeof g);
    lanes = b->lanes - lane;
  }
  /* In double precision of as many lanes as the vectors have, which may be more than the block
     has. */
  for (int c = 0; c < PENDRES_FORCE_POWERS; c++) from.power[c] = (const void *)g.power[c];
  NAME(load)(model, step, b, lane, lanes, &g);
  NAME(load_more)(step, b, lane, lanes, &g);
  if (model == PENDRES_MODEL_FORMULA) {
    from.force = &formula[0];
    from.slope = &formula[1];
    pendres_kernels_formula_open(from.force, b->k.formula, FORMULA_FORCES, from.power, 0);
    pendres_kernels_formula_open(from.slope, b->k.formula, FORMULA_SLOPES, from.power, 0);
  }
  for (int n = 0; n < s->steps; n++, cosine += STAGES) {
    for (int j = 0; j < STAGES; j++)
      NAME(stage)(model, count, tangents, j, (REAL)cosine[j], &from, &g);
    NAME(end_step)(count, tangents, &g);
    if (b->off.yy != NULL)
      NAME(carry)(model, count, (REAL)step, (REAL)cosine[STAGES - 1], &from, &g);
  }
  NAME(store)(step, b, lane, lanes, &g);
}

#undef EACH
#undef ROW
#undef AT
