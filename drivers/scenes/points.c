/* points.c -- the points of a scene, some at a time; see points.h. */
#include "scenes/points.h"

#include <stdlib.h>
#include <string.h>

#include "results/columns.h"
#include "system/grow.h"

/* Of a point that has failed, behind the records of a task's points. */
typedef struct mark {
  uint64_t point;
  int64_t reason;         /* a scene_failure */
  char words[SCENE_TOLD]; /* the library's own; "": those of the list */
} mark;

struct scene_marks {
  mark *list;
  size_t count, room;
  int full; /* there was no memory for one */
};

/* The points of a stage, behind tasks of its own. */
typedef struct stage_points {
  scene_run *run;
  const farm_stage *own;
  scene_points *const *points;
} stage_points;

/* Points of a task: of which kind, number of the first, and how many. */
typedef struct chunk {
  scene_points *of;
  size_t first, n;
} chunk;

static size_t tasks_of(const scene_points *p)
{
  return (p->n + p->chunk - 1) / p->chunk;
}

static chunk chunk_of(const stage_points *s, size_t task)
{
  size_t k = 0;
  task -= s->own->tasks;
  for (; task >= tasks_of(s->points[k]); k++) task -= tasks_of(s->points[k]);
  scene_points *p = s->points[k];
  const size_t first = task * p->chunk, left = p->n - first;
  return (chunk){p, first, left < p->chunk ? left : p->chunk};
}

/* ---- computing ----------------------------------------------------------------------------- */

static void add_mark(struct scene_marks *m, size_t point, scene_failure reason, const char *words)
{
  if (!grow_to(&m->list, m->count + 1, &m->room, sizeof *m->list)) {
    m->full = 1;
    return;
  }
  mark *to = &m->list[m->count++];
  *to = (mark){.point = point, .reason = (int64_t)reason};
  if (words != NULL) snprintf(to->words, sizeof to->words, "%s", words);
}

void scene_mark(const scene_some *some, size_t i, scene_failure reason, const char *words)
{
  add_mark(some->marks, some->first + i, reason, words);
}

pendres_status scene_mark_status(const scene_some *some, size_t i, pendres_status status,
                                 const char *words)
{
  const scene_failure reason = scene_failure_of(status);
  if (reason == SCENE_FAILURE_NONE) return status;
  scene_mark(some, i, reason, words);
  return PENDRES_OK;
}

static void name_point(const scene_run *run, const scene_points *p, size_t point, char *text,
                       size_t size)
{
  if (p->name != NULL) {
    p->name(p, point, text, size);
    return;
  }
  const char *at = p->what != NULL && p->axes > 0 ? " at " : "";
  const int used = snprintf(text, size, "%s%s", p->what != NULL ? p->what : "", at);
  if (p->axes > 0)
    scene_point_name(run->deck, point, p->axes, p->axis, text + used, size - (size_t)used);
}

void scene_points_begin(const scene_run *run, const scene_points *p, size_t first, size_t n,
                        farm_record *out)
{
  char name[SCENE_TOLD], more[40] = "";
  if (p->axes == 0 && p->name == NULL && p->what == NULL) return;
  name_point(run, p, first, name, sizeof name);
  if (n > 1) snprintf(more, sizeof more, " and %zu more", n - 1);
  farm_point(out, scene_find(run->deck->kind)->budget ? n : 0, "%s%s", name, more);
}

/* A task under way. */
typedef struct work {
  const scene_run *run;
  const scene_points *p;
  pendres_context *ctx;
  farm_record *out;
  struct scene_marks marks;
  scene_room room;
} work;

/* Whether one of the points is left out. */
static int too_long(const scene_points *p, size_t first, size_t n, char *words, size_t size)
{
  int any = 0;
  for (size_t i = first; i < first + n && p->too_long != NULL && !any; i++)
    any = p->too_long(p, i, words, size);
  return any;
}

/* Compute points and say why that fails; *status: what it ends with where the reason is none of the
   points'. */
static scene_failure attempt(work *w, size_t first, size_t n, void *rows, char words[SCENE_TOLD],
                             pendres_status *status)
{
  const scene_some some = {w->p, w->ctx, first, n, rows, w->out->message, &w->marks,
                           &w->room};
  *status = PENDRES_OK;
  if (too_long(w->p, first, n, words, SCENE_TOLD)) return SCENE_FAILURE_TOO_LONG;
  scene_points_begin(w->run, w->p, first, n, w->out);
  *status = w->p->compute(&some);
  scene_room_end(&w->room);
  if (farm_gave_up(w->out, *status)) {
    if (n == 1) farm_lost(w->out, words, SCENE_TOLD);
    return SCENE_FAILURE_OUT_OF_TIME;
  }
  const int ends_the_run = w->p->unmarked || w->out->message[0] != '\0';
  const scene_failure reason = ends_the_run ? SCENE_FAILURE_NONE : scene_failure_of(*status);
  if (reason != SCENE_FAILURE_NONE)
    snprintf(words, SCENE_TOLD, "%s", pendres_context_message(w->ctx));
  return reason;
}

static void make_blank(const work *w, size_t n, char *rows)
{
  const scene_points *p = w->p;
  memset(rows, 0, n * p->size);
  for (size_t i = 0; i < n; i++)
    scene_columns_blank(p->column_count, p->columns, rows + i * p->size);
}

static pendres_status find(work *w, size_t first, size_t n, char *rows)
{
  char words[SCENE_TOLD] = "";
  const size_t before = w->marks.count, half = n / 2;
  pendres_status status;
  make_blank(w, n, rows);
  const scene_failure reason = attempt(w, first, n, rows, words, &status);
  if (reason == SCENE_FAILURE_NONE) return status;
  w->marks.count = before;
  if (n > 1) {
    status = find(w, first, half, rows);
    return status == PENDRES_OK ? find(w, first + half, n - half, rows + half * w->p->size)
                                : status;
  }
  if (w->p->none != NULL) memcpy(rows, w->p->none, w->p->size);
  else make_blank(w, 1, rows);
  if (w->p->leave_out != NULL) w->p->leave_out(w->p, first, rows);
  if (!w->p->unmarked) add_mark(&w->marks, first, reason, w->p->words == NULL ? words : NULL);
  return PENDRES_OK;
}

static pendres_status compute(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const stage_points *s = arg;
  if (task < s->own->tasks) return s->own->task(s->own->arg, task, ctx, out);
  const chunk t = chunk_of(s, task);
  const size_t bytes = t.n * t.of->size;
  work w = {.run = s->run, .p = t.of, .ctx = ctx, .out = out};
  pendres_status status = PENDRES_OUT_OF_MEMORY;
  if (farm_record_resize(out, bytes) != NULL) status = find(&w, t.first, t.n, out->data);
  const size_t more = w.marks.count * sizeof *w.marks.list;
  if (status == PENDRES_OK && (w.marks.full || farm_record_resize(out, bytes + more) == NULL))
    status = PENDRES_OUT_OF_MEMORY;
  if (status == PENDRES_OK && more > 0) memcpy((char *)out->data + bytes, w.marks.list, more);
  free(w.marks.list);
  return status;
}

/* ---- records ------------------------------------------------------------------------------- */

/* Number k of the marks behind the records of a task; 0: there are no more. */
static int mark_at(const chunk *t, const farm_record *in, size_t k, mark *out)
{
  const size_t at = t->n * t->of->size + k * sizeof *out;
  if (at >= in->size) return 0;
  memcpy(out, (const char *)in->data + at, sizeof *out);
  return 1;
}

static int check(const void *arg, size_t task, const farm_record *in)
{
  const farm_stage *own = ((const stage_points *)arg)->own;
  if (task < own->tasks) return own->check(own->arg, task, in);
  const chunk t = chunk_of(arg, task);
  const scene_points *p = t.of;
  const size_t bytes = t.n * p->size;
  mark m;
  if (in->size < bytes || (in->size - bytes) % sizeof m != 0) return 0;
  for (size_t k = 0; mark_at(&t, in, k, &m); k++)
    if (p->unmarked || m.point < t.first || m.point >= t.first + t.n ||
        m.reason < 0 || m.reason >= SCENE_FAILURE_COUNT || !scene_check_text(m.words, SCENE_TOLD))
      return 0;
  int good = 1;
  for (size_t i = 0; good && i < t.n; i++) {
    const char *row = (const char *)in->data + i * p->size;
    good = p->check != NULL ? p->check(p, row)
                            : scene_columns_fit(p->column_count, p->columns, row);
  }
  return good;
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  const stage_points *s = arg;
  if (task < s->own->tasks) return s->own->collect(s->own->arg, task, in);
  const chunk t = chunk_of(s, task);
  scene_points *p = t.of;
  mark m;
  for (size_t k = 0; mark_at(&t, in, k, &m); k++)
    scene_failure_mark(s->run, &p->failed[m.point], (scene_failure)m.reason, m.words);
  if (p->collect != NULL) return p->collect(p, t.first, t.n, in->data);
  memcpy((char *)p->rows + t.first * p->size, in->data, t.n * p->size);
  return PENDRES_OK;
}

void scene_points_compute(scene_run *run, const farm_stage *stage, size_t count,
                          scene_points *const *points)
{
  stage_points s = {run, stage, points};
  farm_stage whole = *stage;
  for (size_t k = 0; k < count; k++) {
    scene_points *p = points[k];
    if (p->collect == NULL && p->rows == NULL)
      p->rows = scene_array(run, p->n, p->size);
    if (!p->unmarked) p->failed = scene_array(run, p->n, sizeof *p->failed);
    whole.tasks += tasks_of(p);
  }
  if (stage->tasks == 0) whole.record_size = points[0]->size;
  whole.task = compute;
  whole.check = check;
  whole.collect = collect;
  whole.arg = &s;
  scene_compute(run, &whole);
}

/* ---- what has come of it ------------------------------------------------------------------- */

void scene_points_over(scene_points *p, const deck *d, int axes, const deck_axis_id *axis)
{
  p->axes = axes;
  p->n = 1;
  for (int i = 0; i < axes; i++) {
    p->axis[i] = axis[i];
    p->n *= d->axis[axis[i]].count;
  }
}

void scene_points_tell(scene_run *run, const scene_points *p)
{
  char name[SCENE_TOLD];
  run->points += p->n;
  for (size_t i = 0; i < p->n && scene_going(run); i++) {
    const scene_failure reason = p->failed[i].reason;
    const char *words = p->failed[i].words;
    if (reason == SCENE_FAILURE_NONE) continue;
    if (words == NULL && p->words != NULL) words = p->words(reason);
    name_point(run, p, i, name, sizeof name);
    scene_failure_count(run, reason, 1);
    scene_failure_tell(run, reason, words, "%s", name);
  }
}

void scene_points_write_failed(scene_run *run, const scene_points *p, const char *name,
                               const char *long_name)
{
  scene_table table = scene_points_table(p, run->deck);
  table.rows = p->failed;
  table.stride = sizeof *p->failed;
  scene_columns_write_failed(run, &table, name, long_name);
  scene_points_tell(run, p);
}

scene_table scene_points_table(const scene_points *p, const deck *d)
{
  scene_table table = {.n = p->n, .stride = p->size, .rows = p->rows,
                       .first = d->axis[p->axis[0]].count};
  for (int i = 0; i < p->axes; i++) table.dimensions[i] = deck_axis_name(p->axis[i]);
  return table;
}

void scene_points_write(scene_run *run, const scene_points *p)
{
  const scene_table table = scene_points_table(p, run->deck);
  scene_columns_write(run, &table, p->column_count, p->columns);
}
