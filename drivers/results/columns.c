/* columns.c -- tables of results from arrays of structs; see columns.h. */
#include "results/columns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Bytes of rows that are gathered at a time, or those of one value of the first dimension. */
enum { PIECE = 1 << 20 };

enum { MOST_STEPS = 100 * DECK_MAX_COUNT }; /* a drive period */

/* Room for a column's values, in the type that is stored, and for its errors. */
typedef struct buffers {
  void *value;
  double *error;
} buffers;

#define NAMES(function, call) \
  const char *function(int value) { return call; }
NAMES(scene_doubt_names, value == 0 ? "no" : value == 1 ? "yes" : NULL)
NAMES(scene_motion_names, pendres_name_get(PENDRES_NAMES_LABEL, value))
NAMES(scene_regime_names, pendres_name_get(PENDRES_NAMES_REGIME, value))
NAMES(scene_special_names, pendres_name_get(PENDRES_NAMES_SPECIAL, value))
NAMES(scene_jump_names, pendres_name_get(PENDRES_NAMES_JUMP, value))
NAMES(scene_cloud_names, pendres_name_get(PENDRES_NAMES_CLOUD_VERDICT, value))
NAMES(scene_switching_names, pendres_name_get(PENDRES_NAMES_SWITCHING_VERDICT, value))

/* All names but those of rotations without a lock and of rest that is unstable: few have these. */
static const char *fate_names(int value)
{
  return value < PENDRES_LABEL_QUASI_PERIODIC ? scene_motion_names(value) : NULL;
}

/* What escapes is on no attractor. */
static const char *label_names(int value)
{
  return value < PENDRES_LABEL_ESCAPE ? fate_names(value) : NULL;
}

scene_names scene_settled_names(const pendres_pendulum *p)
{
  if (pendres_pendulum_rotates(p) || p->drive_amplitude == 0.0) return scene_motion_names;
  return pendres_pendulum_leaves(p) ? fate_names : label_names;
}

/* The names as a list for flag_meanings; how many. */
enum { MOST_NAMES = 32 };
static int meanings_of(scene_names names, const char *meanings[MOST_NAMES])
{
  int n = 0;
  for (; n < MOST_NAMES && names(n) != NULL; n++) meanings[n] = names(n);
  return n;
}

/* Is it one of the codes that a column names or, where codes are sums of bits, a sum of these? */
static int is_code(const scene_column *c, int code)
{
  const char *unused[MOST_NAMES];
  const int n = c->names != NULL ? meanings_of(c->names, unused) : 2;
  int all = 0;
  if (c->codes == NULL) return code >= 0 && code < n;
  for (int k = 0; k < n; k++) all |= c->codes[k];
  return (code & ~all) == 0;
}

int scene_columns_fit(size_t count, const scene_column *columns, const void *row)
{
  int good = 1;
  for (size_t k = 0; good && k < count; k++) {
    int code = 0;
    if (columns[k].type != SCENE_FLAG) continue;
    memcpy(&code, (const char *)row + columns[k].value, sizeof code);
    good = is_code(&columns[k], code);
  }
  return good;
}

static int is_real(scene_column_type type)
{
  return type == SCENE_REAL || type == SCENE_PLAIN;
}

void scene_columns_blank(size_t count, const scene_column *columns, void *row)
{
  static const double none[2] = {NAN, NAN};
  for (size_t k = 0; k < count; k++) {
    const scene_column *c = &columns[k];
    const size_t bytes = (c->pairs ? 2 : 1) * sizeof *none;
    if (is_real(c->type)) memcpy((char *)row + c->value, none, bytes);
    if (c->type == SCENE_REAL) memcpy((char *)row + c->error, none, bytes);
  }
}

static const char *field(const scene_table *t, size_t row, size_t offset)
{
  return (const char *)t->rows + row * t->stride + offset;
}

static int is_count(scene_column_type type)
{
  return type == SCENE_COUNT || type == SCENE_COUNT32;
}

/* A column's values and errors, as they are stored. */
static void gather(const scene_table *t, const scene_column *c, const buffers *b)
{
  const size_t each = c->pairs ? 2 : 1, bytes = each * sizeof(double);
  for (size_t i = 0; i < t->n; i++) {
    const void *from = field(t, i, c->value);
    int number = 0;
    size_t count = 0;
    if (c->type == SCENE_REAL) memcpy(b->error + each * i, field(t, i, c->error), bytes);
    if (is_real(c->type)) memcpy((double *)b->value + each * i, from, bytes);
    else if (is_count(c->type)) memcpy(&count, from, sizeof count);
    else if (c->type != SCENE_TEXT) memcpy(&number, from, sizeof number);
    switch (c->type) {
    case SCENE_REAL:
    case SCENE_PLAIN: break;
    case SCENE_TEXT: ((const char **)b->value)[i] = from; break;
    case SCENE_FLAG: ((int8_t *)b->value)[i] = (int8_t)number; break;
    case SCENE_NUMBER: ((int32_t *)b->value)[i] = (int32_t)number; break;
    case SCENE_COUNT: ((int64_t *)b->value)[i] = (int64_t)count; break;
    case SCENE_COUNT32: ((int32_t *)b->value)[i] = (int32_t)count; break;
    }
  }
}

/* A column as it is described to the store, with room for its words. */
typedef struct variable {
  char name[64], words[200];
  const char *meanings[MOST_NAMES];
  pendres_store_spec spec;
} variable;

static void describe(const scene_run *run, const scene_table *t, const scene_column *c,
                     const pendres_quantity *q, variable *v)
{
  static const pendres_store_type types[] = {[SCENE_REAL] = PENDRES_STORE_DOUBLE,
                                             [SCENE_PLAIN] = PENDRES_STORE_DOUBLE,
                                             [SCENE_NUMBER] = PENDRES_STORE_INT32,
                                             [SCENE_COUNT] = PENDRES_STORE_INT64,
                                             [SCENE_COUNT32] = PENDRES_STORE_INT32,
                                             [SCENE_FLAG] = PENDRES_STORE_INT8,
                                             [SCENE_TEXT] = PENDRES_STORE_STRING};
  v->spec = (pendres_store_spec){
    .group = t->group, .name = v->name, .type = types[c->type], .long_name = v->words,
    .units = c->units, .comment = c->comment, .flag_meanings = v->meanings,
    .flag_values = c->codes, .flag_bits = c->codes != NULL, .deflate = t->deflate};
  const char *words = c->long_name != NULL || q == NULL ? c->long_name : q->words;
  const size_t before = strcspn(c->name, "*");
  const int starred = c->name[before] != '\0';
  (void)snprintf(v->name, sizeof v->name, "%s%s%.*s%s%s", t->prefix != NULL ? t->prefix : "",
                 t->prefix != NULL ? "_" : "", (int)before, c->name,
                 starred && t->star != NULL ? t->star : "", c->name + before + starred);
  (void)snprintf(v->words, sizeof v->words, "%s%s%s", words, t->words != NULL ? " " : "",
                 t->words != NULL ? t->words : "");
  int k = 0;
  for (; k < 3 && t->dimensions[k] != NULL; k++) v->spec.dimensions[k] = t->dimensions[k];
  if (c->pairs) v->spec.dimensions[k] = t->inner;
  const int plain =
    c->names == scene_motion_names && deck_is_plain(run->deck) && !deck_may_rest(run->deck);
  if (c->names != NULL)
    v->spec.flag_count = meanings_of(plain ? label_names : c->names, v->meanings);
}

static pendres_status define(scene_run *run, const scene_table *t, const scene_column *c,
                             scene_variable *out)
{
  variable v;
  char words[SCENE_WORDS];
  if (!scene_going(run)) return run->status;
  const pendres_quantity *q = scene_quantity(run, c->quantity, c->name);
  describe(run, t, c, q, &v);
  const pendres_kind kind = scene_define(run, q, &v.spec, words);
  results_variable(run, &v.spec, &out->value, c->type == SCENE_REAL ? &out->error : NULL);
  scene_mark_units(run, &v.spec, kind, c->type == SCENE_REAL);
  return run->status;
}

/* The rows of some values of the first dimension, or all there is. */
typedef struct piece {
  size_t first, values;
  scene_table table;
} piece;

static void write_one(scene_run *run, const piece *p, int pairs, int id, const void *data)
{
  const size_t n = pairs ? 2 * p->table.n : p->table.n;
  results_write(run, id, p->first, p->table.first > 0 ? p->values : 0, data, n);
}

static void write_piece(scene_run *run, const piece *p, const scene_column *c,
                        const scene_variable *v, const buffers *b)
{
  gather(&p->table, c, b);
  write_one(run, p, c->pairs, v->value, b->value);
  if (c->type == SCENE_REAL) write_one(run, p, c->pairs, v->error, b->error);
}

/* A column, `most` values of the first dimension at a time. */
static void write_column(scene_run *run, const scene_table *t, size_t most, const scene_column *c,
                         const buffers *b)
{
  const size_t all = t->first > 0 ? t->first : 1, each = t->n / all;
  scene_variable v = {-1, -1};
  if (c->when != NULL && !c->when(run->deck)) return;
  define(run, t, c, &v);
  for (size_t at = 0; at < all && scene_going(run); at += most) {
    piece p = {.first = at, .values = all - at < most ? all - at : most, .table = *t};
    p.table.n = p.values * each;
    p.table.rows = field(t, at * each, 0);
    write_piece(run, &p, c, &v, b);
  }
}

/* Pairs of doubles are the largest of what is stored. */
static void reserve(scene_run *run, size_t n, buffers *b)
{
  const size_t most = (n + 1) * 2 * sizeof(double);
  *b = (buffers){ malloc(most), malloc(most) };
  if (b->value == NULL || b->error == NULL)
    scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory for %zu results", n);
}

static void release(buffers *b)
{
  free(b->value);
  free(b->error);
}

void scene_columns_write(scene_run *run, const scene_table *t, size_t count,
                         const scene_column *columns)
{
  if (!scene_going(run)) return;
  const size_t each = t->first > 0 ? t->n / t->first : t->n, bytes = each * t->stride;
  const size_t most = bytes > 0 && bytes < PIECE ? PIECE / bytes : 1;
  const size_t room = most * each < t->n ? most * each : t->n;
  buffers b;
  reserve(run, room, &b);
  for (size_t k = 0; k < count && scene_going(run); k++)
    write_column(run, t, most, &columns[k], &b);
  release(&b);
}

void scene_columns_write_failed(scene_run *run, const scene_table *table, const char *name,
                                const char *long_name)
{
  const scene_column column = {
    SCENE_TYPED(SCENE_FLAG, name, scene_failed, reason, long_name), .names = scene_failure_names};
  scene_columns_write(run, table, 1, &column);
}

void scene_columns_write_orbits(scene_run *run, const scene_table *t, size_t orbit)
{
  const pendres_orbit_quantity *q;
  for (size_t k = 0; (q = pendres_orbit_quantity_get(k)) != NULL; k++) {
    const int exact = q->error == PENDRES_ORBIT_EXACT;
    const scene_column column = {.name = q->name,
                                 .type = exact ? SCENE_PLAIN : SCENE_REAL,
                                 .value = orbit + q->value,
                                 .error = exact ? 0 : orbit + q->error};
    if (q->principal) scene_columns_write(run, t, 1, &column);
  }
}

void scene_columns_define(scene_run *run, const scene_table *t, const scene_variables *of)
{
  for (size_t k = 0; k < of->count; k++) define(run, t, &of->column[k], &of->variable[k]);
}

void scene_columns_write_rows(scene_run *run, const scene_table *t, size_t first, size_t rows,
                              const scene_variables *of)
{
  buffers b;
  piece p = {.first = first, .values = rows, .table = *t};
  if (!scene_going(run)) return;
  p.table.first = rows;
  reserve(run, t->n, &b);
  for (size_t k = 0; k < of->count && scene_going(run); k++)
    write_piece(run, &p, &of->column[k], &of->variable[k], &b);
  release(&b);
}

/* ---- the short table ----------------------------------------------------------------------- */

static void print_cell(FILE *out, const char *at, const scene_cell *cell)
{
  double value = 0.0;
  size_t count = 0;
  int number = 0;
  if (is_real(cell->type)) memcpy(&value, at, sizeof value);
  else if (is_count(cell->type)) memcpy(&count, at, sizeof count);
  else if (cell->type != SCENE_TEXT) memcpy(&number, at, sizeof number);
  if (is_real(cell->type) && isnan(value) && cell->none != NULL) fputs(cell->none, out);
  else if (is_real(cell->type)) fprintf(out, cell->format, value);
  else if (is_count(cell->type)) fprintf(out, cell->format, count);
  else if (cell->type == SCENE_TEXT) fprintf(out, cell->format, at);
  else if (cell->names != NULL) fprintf(out, cell->format, cell->names(number));
  else fprintf(out, cell->format, number);
}

void scene_columns_print(FILE *out, const scene_table *t, size_t lines, size_t count,
                         const scene_cell *cells, const char *(*instead)(const void *row))
{
  const size_t step = t->n > lines + lines / 5 ? t->n / lines + 1 : 1;
  size_t shown = 0;
  for (size_t k = 0; k < count; k++) fputs(cells[k].heading, out);
  fputc('\n', out);
  for (size_t i = 0; i < t->n; i++) {
    if (i % step != 0 && i + 1 != t->n) continue;
    const char *words = instead != NULL ? instead(field(t, i, 0)) : NULL;
    for (size_t k = 0; k < (words == NULL ? count : 1); k++)
      print_cell(out, field(t, i, cells[k].value), &cells[k]);
    if (words != NULL) fputs(words, out);
    fputc('\n', out);
    shown++;
  }
  if (shown < t->n)
    fprintf(out, "(%zu of %zu rows; the file has all, and --csv writes them)\n", shown, t->n);
}

/* ---- records that come from elsewhere ---- */

int scene_check_code(int code, int count)
{
  return code >= 0 && code < count;
}

int scene_check_text(const char *text, size_t room)
{
  return memchr(text, '\0', room) != NULL;
}

int scene_check_attractor(const pendres_attractor *a)
{
  const pendres_orbit *o = &a->orbit;
  return scene_check_code((int)a->label, PENDRES_LABEL_COUNT) &&
         pendres_model_of(o->pendulum.force) != NULL &&
         scene_check_code(o->period, DECK_MAX_COUNT + 1) && scene_check_code(o->symmetric, 2) &&
         scene_check_code(o->stable, 2) && scene_check_code(o->steps, MOST_STEPS);
}

int scene_check_response(const pendres_response *r)
{
  int good = r->states <= PENDRES_RESPONSE_STATES &&
             pendres_model_of(r->pendulum.force) != NULL;
  for (size_t i = 0; good && i < r->states; i++) good = scene_check_attractor(&r->state[i]);
  return good;
}

int scene_check_basin_state(const pendres_basin_state *state, size_t attractors)
{
  const int number = state->attractor;
  return (number == PENDRES_ATTRACTOR_UNKNOWN || number == PENDRES_ATTRACTOR_ESCAPED ||
          number == PENDRES_ATTRACTOR_UNSTABLE ||
          (number >= 0 && (size_t)number < attractors)) &&
         scene_check_code(state->label, PENDRES_LABEL_COUNT) &&
         scene_check_code(state->how, PENDRES_BASIN_HOW_COUNT);
}

/* ---- what the paper prints ---- */

static const scene_column of_paper[] = {
  SCENE_COLUMN_OF(SCENE_PLAIN, scene_printed, printed, "value printed in the paper"),
  {.name = "computed", .long_name = "value of this run", .value = offsetof(scene_printed, computed),
   .error = offsetof(scene_printed, error)},
  {.name = "difference", .long_name = "computed less printed",
   .value = offsetof(scene_printed, difference), .error = offsetof(scene_printed, error)},
};

void scene_write_paper(scene_run *run, size_t n, scene_printed *values)
{
  const char **name = scene_array(run, n, sizeof *name);
  const scene_table table = {.group = "paper", .dimensions = {"quantity"}, SCENE_ROWS(values, n)};
  const pendres_store_spec quantity = {.group = "paper", .name = "quantity",
                                       .type = PENDRES_STORE_STRING, .long_name = "quantity"};
  if (n == 0 || name == NULL) return;
  for (size_t i = 0; i < n; i++) {
    name[i] = values[i].name;
    values[i].difference = values[i].computed - values[i].printed;
  }
  scene_put_dimension(run, &quantity, name, n);
  SCENE_WRITE(run, &table, of_paper);
}
