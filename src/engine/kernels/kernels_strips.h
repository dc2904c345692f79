/*
 * kernels_strips.h -- operations on states under a formula, which does each of its own on all lanes
 * of a strip: sums, then the force, then slopes. Part of kernels.c, whose functions it calls.
 */
/* Vectors whose sums, or slopes, are in registers at once; the rest of a strip goes by REST. */
enum { SIDE_BY_SIDE = 4 };
#define FORMULA_VECTORS(DO, ...)                                                                 \
  do {                                                                                          \
    size_t lane = 0;                                                                            \
    for (; lane + SIDE_BY_SIDE * LANES <= s->lanes; lane += SIDE_BY_SIDE * LANES)               \
      DO(SIDE_BY_SIDE, s, lane, __VA_ARGS__);                                                   \
    for (; lane < s->lanes; lane += REST * LANES) DO(REST, s, lane, __VA_ARGS__);               \
  } while (0)

/* The sums of a stage, y of each lane to a place of its own. */
PENDRES_VECTOR_INLINE void formula_sums(int count, const pendres_strip *s, size_t lane,
                                        const pendres_operation *o, double *to)
{
  vec y[GROUP];
  stage_sums(count, s, lane, o, o->keep || s->drags, y);
  PENDRES_VECTOR_EACH pendres_vector_store(to + lane + v * LANES, y[v]);
}

/* Forces that were computed, as slopes of w. */
PENDRES_VECTOR_INLINE void formula_push(int count, const pendres_strip *s, size_t lane,
                                        const pendres_operation *o, const double *force)
{
  vec y[GROUP];
  PENDRES_VECTOR_EACH y[v] = pendres_vector_load(force + lane + v * LANES);
  push(PENDRES_MODEL_FORMULA, count, s, lane, o, y);
}

static void formula_carry(pendres_kernels_formula *f, const pendres_strip *s,
                          const pendres_operation *o)
{
  pendres_strip own = *s;
  own.k.value = f->value;
  pendres_kernels_formula_at(f, s->lanes, o->from + s->at);
  if (s->off.yy != NULL) carry(PENDRES_MODEL_FORMULA, s->drags, &own, o);
  else turn(PENDRES_MODEL_FORMULA, o->second, s->drags, &own, o);
}

static void run_state_formula(const pendres_strip *s, const pendres_operation *o, size_t n)
{
  const size_t size = PENDRES_ROWS_STATE * s->lanes;
  pendres_kernels_formula forces, slopes;
  pendres_kernels_formula_open(&forces, s->k.formula, FORMULA_FORCES, s->k.power, 0);
  if (s->off.yy != NULL || s->tangent.keep != NULL)
    pendres_kernels_formula_open(&slopes, s->k.formula, FORMULA_SLOPES, s->k.power, 0);
  for (const pendres_operation *end = o + n; o < end; o++) {
    if (o->slope != NULL) {
      if (o->sum != NULL) FORMULA_VECTORS(formula_sums, o, forces.y);
      else memcpy(o->slope + s->at, o->from + s->at + s->lanes, s->lanes * sizeof *o->slope);
      pendres_kernels_formula_at(&forces, s->lanes, o->sum != NULL ? forces.y : o->from + s->at);
      FORMULA_VECTORS(formula_push, o, forces.value[FORMULA_OUT_FORCE]);
      if (s->drags) resist(s, o->sum != NULL ? o->sum->z : o->from, o->slope);
    } else if (o->sum != NULL) {
      sum(o->sum, s->at, size);
    } else if (o->carry != 0.0) {
      formula_carry(&slopes, s, o);
    } else {
      set(o, s->at, size);
    }
  }
}

static void run_rows_formula(size_t rows, const pendres_strip *s, const pendres_operation *o,
                             size_t n)
{
  pendres_kernels_formula slopes;
  pendres_strip own = *s;
  pendres_kernels_formula_open(&slopes, s->k.formula,
                               rows >= PENDRES_ROWS_FORCE ? FORMULA_SENSITIVITIES : FORMULA_SLOPES,
                               s->k.power, 0);
  own.k.value = slopes.value;
  run_rows(PENDRES_MODEL_FORMULA, rows, &own, o, n, &slopes);
}
