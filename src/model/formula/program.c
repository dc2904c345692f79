/* program.c -- the operations of a formula in their order; see program.h. */
#include "model/formula/program.h"

#include <stdlib.h>
#include <string.h>

typedef struct making {
  const formula_tree *t;
  formula_program *p;
  int uses[FORMULA_MOST_NODES];  /* that are still to come; of outputs one more */
  int place[FORMULA_MOST_NODES]; /* of nodes that were made */
  char taken[FORMULA_MOST_SLOTS];
  int full; /* there are too many of something */
} making;

/* Count what needs each node; outputs are needed to the end. */
static void count_uses(making *m, const int *node)
{
  int last = FORMULA_NONE;
  for (int k = 0; k < FORMULA_OUTPUTS; k++) {
    if (node[k] < 0) continue;
    m->uses[node[k]]++;
    if (node[k] > last) last = node[k];
  }
  for (int i = last; i >= 0; i--) {
    const formula_node *n = &m->t->node[i];
    const int operands = m->uses[i] > 0 ? formula_operands(n->kind) : 0;
    if (operands > 0) m->uses[n->a]++;
    if (operands > 1) m->uses[n->b]++;
    if (operands > 2) m->uses[n->c]++;
  }
}

/* The places of what is only read. */
static void place_leaves(making *m)
{
  formula_program *p = m->p;
  int constants = 0;
  for (int i = 0; i < m->t->count; i++) {
    const formula_node *n = &m->t->node[i];
    if (m->uses[i] == 0) continue;
    if (n->kind == FORMULA_X) m->place[i] = FORMULA_AT_X;
    if (n->kind == FORMULA_V) m->place[i] = FORMULA_AT_V;
    if (n->kind == FORMULA_COEFFICIENT) m->place[i] = FORMULA_AT_COEFFICIENTS + n->which;
    if (n->kind == FORMULA_CONSTANT) constants++;
    if (n->kind != FORMULA_PHASE_COSINE && n->kind != FORMULA_PHASE_SINE) continue;
    if (p->phases == FORMULA_MOST_PHASES) {
      m->full = 1;
      return;
    }
    m->place[i] = FORMULA_AT_PHASES + p->phases;
    p->phase[p->phases++] = (signed char)(n->kind == FORMULA_PHASE_SINE ? -n->which : n->which);
  }
  const size_t room = (size_t)(constants > 0 ? constants : 1) * FORMULA_LANES * sizeof(double);
  p->constant = aligned_alloc(64, room);
  for (int i = 0; i < m->t->count && p->constant != NULL; i++) {
    if (m->uses[i] == 0 || m->t->node[i].kind != FORMULA_CONSTANT) continue;
    m->place[i] = formula_at_constants(p) + p->constants;
    for (int k = 0; k < FORMULA_LANES; k++)
      p->constant[p->constants * FORMULA_LANES + k] = m->t->node[i].value;
    p->constants++;
  }
}

static int take_slot(making *m)
{
  for (int s = 0; s < FORMULA_MOST_SLOTS; s++) {
    if (m->taken[s]) continue;
    m->taken[s] = 1;
    if (s >= m->p->slots) m->p->slots = s + 1;
    return s;
  }
  m->full = 1;
  return 0;
}

/* An operand's place; its slot is free again after its last use. */
static unsigned char use(making *m, int node)
{
  const int place = m->place[node], first = formula_at_slots(m->p);
  if (place >= FORMULA_MOST_PLACES) m->full = 1;
  if (--m->uses[node] == 0 && place >= first) m->taken[place - first] = 0;
  return (unsigned char)place;
}

/* The sine to a cosine of the same argument, and the other way round, if it is needed as well. */
static int partner_of(const making *m, int i)
{
  const formula_node *n = &m->t->node[i];
  const formula_kind other = n->kind == FORMULA_SIN ? FORMULA_COS : FORMULA_SIN;
  if (n->kind != FORMULA_SIN && n->kind != FORMULA_COS) return FORMULA_NONE;
  for (int k = i + 1; k < m->t->count; k++)
    if (m->uses[k] > 0 && m->t->node[k].kind == other && m->t->node[k].a == n->a) return k;
  return FORMULA_NONE;
}

static void put_step(making *m, int i)
{
  const formula_node *n = &m->t->node[i];
  const int operands = formula_operands(n->kind), first = formula_at_slots(m->p);
  const int partner = partner_of(m, i);
  formula_step s = {.kind = (unsigned char)n->kind};
  s.a = use(m, n->a);
  if (operands > 1) s.b = use(m, n->b);
  if (operands > 2) s.c = use(m, n->c);
  if (partner >= 0) (void)use(m, n->a);
  s.to = (unsigned char)take_slot(m);
  m->place[i] = first + s.to;
  if (partner >= 0) {
    s.kind = FORMULA_BOTH;
    s.other = (unsigned char)take_slot(m);
    m->place[partner] = first + s.other;
    if (n->kind == FORMULA_COS) {
      const unsigned char sine = s.other;
      s.other = s.to;
      s.to = sine;
    }
  }
  m->p->step[m->p->steps++] = s;
}

int pendres_formula_program_make(const formula_tree *t, const int *node, formula_program *out)
{
  making *m = calloc(1, sizeof *m);
  *out = (formula_program){.steps = 0};
  out->step = calloc((size_t)t->count + 1, sizeof *out->step);
  if (m != NULL && out->step != NULL) {
    *m = (making){.t = t, .p = out};
    memset(m->place, -1, sizeof m->place);
    count_uses(m, node);
    place_leaves(m);
    for (int i = 0; i < t->count && out->constant != NULL && !m->full; i++)
      if (m->uses[i] > 0 && m->place[i] < 0) put_step(m, i);
    for (int k = 0; k < FORMULA_OUTPUTS; k++)
      out->output[k] = node[k] < 0 ? FORMULA_NONE : m->place[node[k]];
  }
  const int bad = m == NULL || out->step == NULL || out->constant == NULL || m->full;
  free(m);
  if (bad) pendres_formula_program_free(out);
  return bad ? -1 : 0;
}

void pendres_formula_program_free(formula_program *p)
{
  free(p->step);
  free(p->constant);
  *p = (formula_program){.steps = 0};
}
