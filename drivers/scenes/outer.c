/*
 * outer.c -- the scenes of an outer axis, one after another; see outer.h.
 *
 * Scenes that are a single path are first computed side by side, each on one thread, for the
 * records of their tasks alone, which go to the journal. What they write is let go of: the run then
 * takes value after value as always, and finds the records as one does that goes on.
 */
#include "scenes/outer.h"

#include <stdlib.h>
#include <string.h>

#include "results/columns.h"
#include "results/failed.h"
#include "results/stack.h"

typedef struct outer {
  const deck *whole;
  const scene_kind *scene;
  char name[2 * DECK_NAME]; /* of the axis */
  results_stack *stack;
  scene_failed *failed; /* [slices] */
  int left;             /* some tasks of a slice are other shards' */
} outer;

static const deck_axis *axis_of(const deck *d)
{
  return &d->axis[DECK_AXIS_OUTER];
}

/* ---- one slice ----------------------------------------------------------------------------- */

/* Compute one slice; its results go onto the stack, which is the run's while it lasts. */
static pendres_status compute(scene_run *run, outer *o, size_t slice)
{
  const deck one = deck_slice(o->whole, slice);
  snprintf(run->where, sizeof run->where, "%.60s %.10g", o->name, axis_of(o->whole)->value[slice]);
  if (run->table != NULL)
    fprintf(run->table, "%s%s:\n", slice > 0 ? "\n" : "", run->where);
  run->deck = &one;
  run->stack = o->stack;
  results_stack_begin(o->stack, slice);
  const pendres_status status = o->scene->run(run);
  run->stack = NULL;
  run->deck = o->whole;
  scene_room_end(&run->room);
  return status;
}

/* What has become of it: one that fails for reasons of its own is marked, and the others go on. */
static void judge(scene_run *run, outer *o, size_t slice)
{
  const scene_failure reason = scene_failure_of(run->status);
  if (scene_going(run)) return;
  if (run->status == PENDRES_INTERRUPTED && farm_left_to_shards(run->farm)) {
    o->left = 1;
  } else if (reason != SCENE_FAILURE_NONE) {
    o->failed[slice].reason = reason;
    scene_failure_count(run, reason, 1);
    scene_failure_tell(run, reason, run->message[0] != '\0' ? run->message : NULL, "%s",
                       deck_kind_name(o->whole->kind));
  } else {
    return;
  }
  results_stack_forget(o->stack, slice);
  run->status = PENDRES_OK;
  run->message[0] = '\0';
}

/* ---- results ------------------------------------------------------------------------------- */

static void write_axis(scene_run *run, const char *group)
{
  char name[2 * DECK_NAME];
  const deck *d = run->deck;
  scene_put_dimension(run, &(pendres_store_spec){ .group = group,
                                                  .name = deck_outer_name(d, name),
                                                  .long_name = deck_outer_words(d) },
                      axis_of(d)->value, axis_of(d)->count);
}

static void write_failed(scene_run *run, const outer *o)
{
  const scene_table table = { .dimensions = { o->name },
                              SCENE_ROWS(o->failed, deck_slices(o->whole)) };
  scene_columns_write_failed(run, &table, "outer_failed",
                             "why there is no result for a value of the outer axis");
}

static void write_all(scene_run *run, const outer *o)
{
  size_t failed = 0;
  for (size_t i = 0; i < deck_slices(o->whole); i++)
    failed += o->failed[i].reason != SCENE_FAILURE_NONE;
  if (scene_going(run) && failed == deck_slices(o->whole)) {
    (void)scene_fail(run, PENDRES_NOT_FOUND, "there are no results at any value of %s; %s",
                     o->name, run->told_count > 0 ? run->told[0] : "");
    return;
  }
  if (!scene_going(run)) return;
  write_axis(run, "");
  results_attribute(run, "", NULL, "outer_axis", o->name);
  results_stack_write(run, o->stack, o->name, write_axis);
  write_failed(run, o);
}

static pendres_status run_slices(scene_run *run, outer *o, size_t first, size_t last)
{
  for (size_t i = first; i <= last && scene_going(run); i++) {
    farm_begin_slice(run->farm, i, i < last);
    (void)compute(run, o, i);
    judge(run, o, i);
  }
  run->where[0] = '\0';
  return run->status;
}

static int begin(scene_run *run, const scene_kind *scene, outer *o)
{
  const size_t n = deck_slices(run->deck);
  *o = (outer){ .whole = run->deck, .scene = scene, .failed = calloc(n, sizeof *o->failed) };
  (void)deck_outer_name(run->deck, o->name);
  o->stack = o->failed != NULL ? results_stack_create(run, n) : NULL;
  if (o->stack != NULL) return 1;
  free(o->failed);
  if (scene_going(run)) (void)scene_fail(run, PENDRES_OUT_OF_MEMORY, "out of memory");
  return 0;
}

static void end(outer *o)
{
  results_stack_free(o->stack);
  free(o->failed);
}

/* A task: compute the records of one slice. Why that fails is found again, and told, afterwards. */
static pendres_status compute_aside(const void *arg, size_t slice, pendres_context *ctx,
                                    farm_record *record)
{
  const scene_run *whole = arg;
  scene_run run = { .deck = whole->deck, .store = whole->store, .farm = farm_aside(whole->farm) };
  outer o;
  (void)ctx, (void)record;
  if (run.farm == NULL) return PENDRES_OK;
  farm_begin_slice(run.farm, slice, 0);
  if (begin(&run, scene_find(run.deck->kind), &o)) {
    (void)compute(&run, &o, slice);
    end(&o);
  }
  farm_free(run.farm);
  return run.status == PENDRES_INTERRUPTED && farm_stopped(whole->farm) ? run.status : PENDRES_OK;
}

static void compute_ahead(scene_run *run, size_t slices)
{
  char name[2 * DECK_NAME], what[3 * DECK_NAME];
  snprintf(what, sizeof what, "values of %s", deck_outer_name(run->deck, name));
  farm_begin_slice(run->farm, slices, 1);
  (void)farm_run(run->farm, &(farm_stage){ .what = what, .tasks = slices, .record_size = 1,
                                           .cheap = 1, .task = compute_aside, .arg = run });
}

pendres_status scene_run_all(scene_run *run, const scene_kind *scene)
{
  outer o;
  const size_t n = deck_slices(run->deck);
  if (n == 0) return scene->run(run);
  if (!begin(run, scene, &o)) return run->status;
  if (scene->path && n > 1 && farm_sides(run->farm) > 1) compute_ahead(run, n);
  (void)run_slices(run, &o, 0, n - 1);
  if (o.left && scene_going(run))
    (void)scene_fail(run, PENDRES_INTERRUPTED, "the rest is other shards'");
  write_all(run, &o);
  end(&o);
  return run->status;
}

/* ---- --dry-run ----------------------------------------------------------------------------- */

void scene_describe_all(const deck *d, const scene_kind *scene, FILE *out)
{
  char name[2 * DECK_NAME];
  const deck_axis *a = axis_of(d);
  if (deck_slices(d) == 0) {
    scene->describe(d, out);
    return;
  }
  fprintf(out, "for each of %zu values of %s, %g to %g; at the first of them:\n", a->count,
          deck_outer_name(d, name), a->value[0], a->value[a->count - 1]);
  const deck one = deck_slice(d, 0);
  scene->describe(&one, out);
}

size_t scene_trials(const deck *d)
{
  const size_t n = deck_slices(d);
  return n == 0 ? 1 : n < 3 ? n : 3;
}

pendres_status scene_try(scene_run *run, const scene_kind *scene, size_t i)
{
  outer o;
  const size_t n = deck_slices(run->deck), tried = scene_trials(run->deck);
  if (n == 0) return scene->run(run);
  if (!begin(run, scene, &o)) return run->status;
  const size_t slice = tried > 1 ? i * (n - 1) / (tried - 1) : 0;
  farm_begin_slice(run->farm, slice, 0);
  (void)compute(run, &o, slice);
  judge(run, &o, slice);
  const pendres_status status = run->status;
  run->status = PENDRES_OK;
  end(&o);
  return status;
}
