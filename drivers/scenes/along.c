/* along.c -- what scenes share in which parameters move; see along.h. */
#include "scenes/along.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* List the attractors that there are instead, as in "sa, la". */
static void list_labels(const pendres_attractors *set, char *text, size_t size)
{
  text[0] = '\0';
  for (size_t i = 0; i < pendres_attractors_count(set); i++)
    snprintf(text + strlen(text), size - strlen(text), "%s%s", i > 0 ? ", " : "",
             pendres_name_get(PENDRES_NAMES_LABEL, pendres_attractors_get(set, i)->label));
}

/* An attractor that is asked for by its name or number. */
typedef struct request {
  const char *start;
  size_t found; /* how many attractors there are */
  char *why;    /* says what is wrong, in ... */
  size_t size;  /* ... this number of bytes */
} request;

static pendres_status named(pendres_context *ctx, const pendres_pendulum *p, request *r,
                            pendres_attractor *out)
{
  const char *start = r->start;
  pendres_attractors *set = NULL;
  pendres_status status = pendres_attractors_find(ctx, p, 0, NULL, NULL, &set);
  if (status != PENDRES_OK) return status;
  status = PENDRES_NOT_FOUND;
  const long number = strtol(start, NULL, 10); /* 0: a name */
  size_t chosen = 0;
  for (size_t i = 0; i < pendres_attractors_count(set) && status != PENDRES_OK; i++) {
    const pendres_attractor *a = pendres_attractors_get(set, i);
    const char *label = pendres_name_get(PENDRES_NAMES_LABEL, a->label);
    /* A lone orbit is the branch of whatever name. */
    const int lone = pendres_attractors_count(set) == 1 && a->label == PENDRES_LABEL_PERIODIC;
    if (number > 0 ? (long)i + 1 != number : strcmp(label, start) != 0 && !lone) continue;
    *out = *a;
    chosen = i;
    status = PENDRES_OK;
  }
  if (status == PENDRES_OK && out->label == PENDRES_LABEL_CHAOTIC) {
    pendres_state point = {NAN, NAN};
    status = pendres_attractors_point_find(ctx, set, chosen, &point);
    out->orbit.x = point.x;
    out->orbit.v = point.v;
  } else if (status != PENDRES_OK) {
    char list[100];
    list_labels(set, list, sizeof list);
    snprintf(r->why, r->size, "no attractor '%s' is found at these parameters from the starts that "
             "are tried; found: %s. Give a state that leads to it by 'x' and 'v'", start,
             list[0] != '\0' ? list : "none");
  }
  r->found = pendres_attractors_count(set);
  pendres_attractors_free(set);
  return status;
}

pendres_status scene_along_named(pendres_context *ctx, const pendres_pendulum *p, const char *start,
                                 pendres_attractor *out, char *why, size_t size)
{
  request r = {.start = start, .why = why, .size = size};
  return named(ctx, p, &r, out);
}

/* ---- paths --------------------------------------------------------------------------------- */

/* A record: this, the points, the jumps, the steps. */
typedef struct head {
  uint64_t points, jumps, steps;
} head;

typedef struct sweep {
  scene_run *run;
  const scene_along_way *way;
  scene_along_path *path;
} sweep;

/* Whether the path had not reached this value when its budget ended it. */
static int not_reached(const pendres_hysteresis_point *p)
{
  return p->outcome == PENDRES_INTERRUPTED;
}

static size_t size_of(const head *n)
{
  return sizeof *n + n->points * sizeof(pendres_hysteresis_point) +
         n->jumps * sizeof(pendres_jump) + n->steps * sizeof(pendres_step);
}

static pendres_status keep(const pendres_hysteresis *h, farm_record *out)
{
  const head n = { pendres_hysteresis_count(h), pendres_hysteresis_jump_count(h),
                   pendres_hysteresis_step_count(h) };
  unsigned char *to = farm_record_resize(out, size_of(&n));
  if (to == NULL) return PENDRES_OUT_OF_MEMORY;
  memcpy(to, &n, sizeof n);
  to += sizeof n;
  for (size_t i = 0; i < n.points; i++, to += sizeof(pendres_hysteresis_point))
    memcpy(to, pendres_hysteresis_get(h, i), sizeof(pendres_hysteresis_point));
  for (size_t i = 0; i < n.jumps; i++, to += sizeof(pendres_jump))
    memcpy(to, pendres_hysteresis_jump_get(h, i), sizeof(pendres_jump));
  for (size_t i = 0; i < n.steps; i++, to += sizeof(pendres_step))
    memcpy(to, pendres_hysteresis_step_get(h, i), sizeof(pendres_step));
  return PENDRES_OK;
}

/* A path that its budget has ended keeps the points that it had reached. */
static pendres_status leave_rest(const pendres_hysteresis *h, farm_record *out)
{
  size_t left = 0;
  for (size_t i = 0; i < pendres_hysteresis_count(h); i++)
    left += not_reached(pendres_hysteresis_get(h, i)) != 0;
  farm_lost_some(out, left, NULL, 0);
  return PENDRES_OK;
}

/* The attractor that a path starts on, at its first value at which something settles: the path
   leaves out those before, but where it comes to them soon. */
static pendres_status find_start(const deck *d, const scene_along_way *way, pendres_context *ctx,
                                 char *message, pendres_attractor *start)
{
  pendres_pendulum p = deck_pendulum(d);
  pendres_status status = PENDRES_NOT_FOUND;
  for (size_t i = 0; i < way->n; i++) {
    char why[SCENE_TOLD];
    request r = {.start = d->orbit.start, .why = message, .size = SCENE_MESSAGE};
    pendres_parameter_set(deck_axis_parameter(way->axis), way->value[i], &p);
    if (scene_settling_too_long(d, &p, 1.0, why, sizeof why)) {
      if (i == 0) snprintf(message, SCENE_MESSAGE, "%s", why);
      continue;
    }
    status = named(ctx, &p, &r, start);
    const int nothing = status == PENDRES_NOT_FOUND && r.found == 0;
    if (!nothing && status != PENDRES_TOLERANCE_UNREACHABLE && status != PENDRES_INTEGRATION_FAILED)
      break;
  }
  return status;
}

pendres_status scene_along_start(const deck *d, const scene_along_way *way, pendres_context *ctx,
                                 char *message, pendres_state *out)
{
  pendres_attractor start;
  *out = (pendres_state){d->orbit.x, d->orbit.v};
  if (d->orbit.start[0] == '\0') return PENDRES_OK;
  const pendres_status status = find_start(d, way, ctx, message, &start);
  if (status == PENDRES_OK) *out = (pendres_state){start.orbit.x, start.orbit.v};
  return status;
}

static pendres_status follow(const void *arg, size_t task, pendres_context *ctx, farm_record *out)
{
  const sweep *s = arg;
  const deck *d = s->run->deck;
  const scene_along_way *way = s->way;
  const pendres_pendulum p = deck_pendulum(d);
  const pendres_hysteresis_path path = {deck_axis_parameter(way->axis), way->n, way->value};
  pendres_state from;
  pendres_hysteresis *h = NULL;
  (void)task;
  pendres_status status = scene_along_start(d, way, ctx, out->message, &from);
  if (status != PENDRES_OK) return status;
  farm_point(out, way->n, "the path of %zu values of %s from %.10g on", way->n,
             deck_axis_name(way->axis), way->value[0]);
  status = way->states_only ? pendres_hysteresis_states_find(ctx, &p, &from, &path, &h)
                            : pendres_hysteresis_find(ctx, &p, &from, &path, &h);
  if (farm_gave_up(out, status)) status = leave_rest(h, out);
  if (status == PENDRES_OK) status = keep(h, out);
  pendres_hysteresis_free(h);
  return status;
}

static int point_fits(const pendres_hysteresis_point *p)
{
  return scene_check_attractor(&p->attractor) &&
         scene_check_code((int)p->outcome, PENDRES_STATUS_COUNT) &&
         scene_check_code(p->certain, 2);
}

static int jump_fits(const pendres_jump *j, size_t points)
{
  return j->step < points && (j->direction == 1 || j->direction == -1) &&
         scene_check_code((int)j->kind, PENDRES_JUMP_COUNT) &&
         scene_check_code((int)j->from, PENDRES_LABEL_COUNT) &&
         scene_check_code((int)j->to, PENDRES_LABEL_COUNT) && j->to_period >= 0 &&
         scene_check_code(j->gradual, 2) && scene_check_code(j->certain, 2);
}

static int step_fits(const pendres_step *s)
{
  return s->period > 0 && scene_check_code((int)s->lower_end, PENDRES_STEP_END_COUNT) &&
         scene_check_code((int)s->upper_end, PENDRES_STEP_END_COUNT);
}

static int check(const void *arg, size_t task, const farm_record *in)
{
  const size_t points = ((const sweep *)arg)->way->n;
  head n;
  (void)task;
  if (in->size < sizeof n) return 0;
  memcpy(&n, in->data, sizeof n);
  /* None of the numbers is so large that their sizes' sum overflows. */
  if (n.points != points || n.jumps > in->size || n.steps > in->size || size_of(&n) != in->size)
    return 0;
  const pendres_hysteresis_point *point = (const void *)((const char *)in->data + sizeof n);
  const pendres_jump *jump = (const void *)(point + n.points);
  const pendres_step *step = (const void *)(jump + n.jumps);
  int good = 1;
  for (size_t i = 0; good && i < n.points; i++) good = point_fits(&point[i]);
  for (size_t i = 0; good && i < n.jumps; i++) good = jump_fits(&jump[i], points);
  for (size_t i = 0; good && i < n.steps; i++) good = step_fits(&step[i]);
  return good;
}

static pendres_status collect(void *arg, size_t task, const farm_record *in)
{
  const sweep *s = arg;
  scene_along_path *path = s->path;
  head n;
  (void)task;
  memcpy(&n, in->data, sizeof n);
  scene_along_path whole = {.axis = s->way->axis, .points = n.points, .jumps = n.jumps,
                            .steps = n.steps};
  whole.point = scene_array(s->run, n.points, sizeof *whole.point);
  whole.jump = scene_array(s->run, n.jumps, sizeof *whole.jump);
  whole.step = scene_array(s->run, n.steps, sizeof *whole.step);
  if (!scene_going(s->run)) return s->run->status; /* and *path holds nothing */
  *path = whole;
  const char *from = (const char *)in->data + sizeof n;
  memcpy(path->point, from, n.points * sizeof *path->point);
  from += n.points * sizeof *path->point;
  memcpy(path->jump, from, n.jumps * sizeof *path->jump);
  from += n.jumps * sizeof *path->jump;
  memcpy(path->step, from, n.steps * sizeof *path->step);
  return PENDRES_OK;
}

void scene_along_compute(scene_run *run, const scene_along_way *way, scene_along_path *path,
                         size_t beside, scene_points *const *points)
{
  sweep s = {run, way, path};
  const size_t one = beside > 0 && points[0]->n == 1; /* as a cascade, which is a path, too */
  scene_points_compute(run, &(farm_stage){.what = "sweeps", .tasks = 1, .record_size = 1,
                                          .paths = 1 + one,
                                          .task = follow, .check = check, .collect = collect,
                                          .arg = &s},
                       beside, points);
}

/* Why a point has no attractor; SCENE_FAILURE_NONE: it has one. */
static scene_failure failure_of(const pendres_hysteresis_point *point)
{
  if (point->attractor.label != PENDRES_LABEL_UNRESOLVED) return SCENE_FAILURE_NONE;
  if (not_reached(point)) return SCENE_FAILURE_OUT_OF_TIME;
  if (point->outcome == PENDRES_OK) return SCENE_FAILURE_UNRESOLVED;
  return point->outcome == PENDRES_UNRESOLVED ? SCENE_FAILURE_TOO_LONG
                                              : scene_failure_of(point->outcome);
}

static int is_doubtful(const pendres_hysteresis_point *p)
{
  return p->attractor.label != PENDRES_LABEL_UNRESOLVED && !p->certain;
}

int scene_along_closed(const pendres_hysteresis_point *point)
{
  return point->attractor.orbit.period > 0;
}

scene_along_row *scene_along_rows(scene_run *run, const scene_along_path *path)
{
  scene_along_row *rows = scene_array(run, path->points, sizeof *rows);
  for (size_t i = 0; i < path->points && rows != NULL; i++) {
    const pendres_hysteresis_point *p = &path->point[i];
    const pendres_orbit *o = &p->attractor.orbit;
    const double closed = scene_along_closed(p) ? 0.0 : NAN;
    rows[i] = (scene_along_row){.of = *p, .period = o->period + closed, .period_error = closed,
                                .winding = o->winding + closed, .winding_error = closed,
                                .uncertain = is_doubtful(p), .failed = (int)failure_of(p)};
  }
  return rows;
}

int scene_along_turns(const deck *d)
{
  return pendres_model_of(d->pendulum.force)->period > 0.0;
}

double scene_along_velocity(const deck *d, deck_axis_id axis, double value, int winding,
                            int period)
{
  pendres_pendulum p = deck_pendulum(d);
  pendres_parameter_set(deck_axis_parameter(axis), value, &p);
  const double turn = pendres_model_of(p.force)->period;
  return period > 0 ? p.drive_frequency * turn / (2.0 * PENDRES_PI) * winding / period : NAN;
}

double scene_along_velocity_error(deck_axis_id axis, double velocity, double value, double error)
{
  const double relative = deck_is_clock(axis) ? error / fabs(value) : 0.0;
  return fabs(velocity) * (relative + 2.0 * DBL_EPSILON);
}

static scene_along_jump jump_row(const deck *d, deck_axis_id axis, const pendres_jump *j)
{
  const double closed = j->to_period > 0 ? 0.0 : NAN;
  const double v = scene_along_velocity(d, axis, j->value, j->to_winding, j->to_period);
  return (scene_along_jump){
    .parameter = j->value, .parameter_error = j->value_error, .period = j->to_period + closed,
    .period_error = closed, .share = j->share, .share_error = j->share_error,
    .direction = j->direction < 0, .kind = (int)j->kind, .from = (int)j->from,
    .winding = j->to_winding + closed, .winding_error = closed, .mean_velocity = v,
    .mean_velocity_error = scene_along_velocity_error(axis, v, j->value, j->value_error),
    .to = (int)j->to, .gradual = j->gradual, .certain = j->certain, .to_period = j->to_period};
}

void scene_along_write_jumps(scene_run *run, const scene_along_path *path, const char *what,
                             size_t count, const scene_column *columns)
{
  char words[60];
  scene_along_jump *rows = scene_array(run, path->jumps, sizeof *rows);
  for (size_t i = 0; rows != NULL && i < path->jumps; i++)
    rows[i] = jump_row(run->deck, path->axis, &path->jump[i]);
  const scene_table table = {.dimensions = {what}, .prefix = what, SCENE_ROWS(rows, path->jumps)};
  snprintf(words, sizeof words, "number of the %s", what);
  scene_numbering(run, what, table.n, words);
  scene_columns_write(run, &table, count, columns);
}

static const scene_column verdicts[] = {
  {SCENE_TYPED(SCENE_FLAG, "label", scene_along_row, of.attractor.label,
               "kind of attractor that the pendulum is on"), .names = scene_motion_names},
  SCENE_CODE(scene_along_row, failed, "why there is no attractor", scene_failure_names),
};

/* Only where it is: files of starts that are sure have none. */
static const scene_column doubts[] = {
  {SCENE_TYPED(SCENE_FLAG, "uncertain", scene_along_row, uncertain, "whether errors that the "
               "start amplifies may have chosen the state on which the path begins"),
   .names = scene_doubt_names},
};

int scene_along_uncertain(const scene_along_path *path)
{
  for (size_t i = 0; i < path->points; i++)
    if (is_doubtful(&path->point[i])) return 1;
  return 0;
}

void scene_along_write_verdicts(scene_run *run, const scene_along_path *path,
                                const scene_table *table)
{
  SCENE_WRITE(run, table, verdicts);
  if (scene_along_uncertain(path)) SCENE_WRITE(run, table, doubts);
}

/* Of values that a path has left out; NULL: what is said of all. */
static const char *remedy_of(scene_failure failed)
{
  if (failed == SCENE_FAILURE_TOO_LONG)
    return "left out: following the state there takes too much work; smaller steps of the "
           "parameter on the way may do";
  if (failed == SCENE_FAILURE_TOLERANCE)
    return "left out: more steps a period are needed there than are taken; a looser "
           "precision.tolerance may do";
  return NULL;
}

void scene_along_tell(scene_run *run, deck_axis_id axis, const scene_along_path *path, int ways)
{
  static const char *const words[] = { "upwards", "downwards" };
  const size_t values = path->points / (size_t)ways;
  run->points += path->points;
  for (size_t i = 0; i < path->points && scene_going(run); i++) {
    const scene_failure failed = failure_of(&path->point[i]);
    if (failed == SCENE_FAILURE_NONE) continue;
    scene_failure_count(run, failed, 1);
    scene_failure_tell(run, failed, remedy_of(failed), "%s %.10g, %s", deck_axis_name(axis),
                       path->point[i].value, words[i / values]);
  }
}
