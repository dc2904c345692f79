/*
 * test_farm.c -- tasks on threads: each runs once, records are collected in order, a failure or a
 * signal stops the run, costs are added up, and only records are handed over. There are no
 * tolerances: all numbers are counts and sums of integers. The order of events follows from what
 * tasks wait for, never from how long they take, since a loaded machine may delay any thread for
 * any time.
 */
#define _POSIX_C_SOURCE 200809L /* fileno, nanosleep */
#include "check.h"

#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include <sys/resource.h>
#include <sys/stat.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "farm/farm.h"
#include "farm/journal.h"
#include "farm/trial.h"

enum { TASKS = 200 };

/* A scene in small: what its tasks and its collector are to do and have done. */
typedef struct scene {
  atomic_int runs[TASKS];
  size_t collected[TASKS], count;
  size_t failing, failing_too; /* tasks; TASKS: none */
  size_t refused;              /* by the collector */
  atomic_int stop;             /* set by task number stop_at */
  size_t stop_at;
  int deaf;                    /* tasks never look whether to go on; later ones await the stop */
  size_t endless;              /* from here on tasks would take hours, but for those that fail */
  FILE *awaited;               /* the failing task waits until there is a line; NULL: it does not */
  double result[TASKS];
  int sized;                   /* records of sizes of their own */
} scene;

static scene *new_scene(void)
{
  scene *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->failing = s->failing_too = s->refused = s->stop_at = s->endless = TASKS;
  return s;
}

static void nap(void)
{
  const struct timespec t = { 0, 1000000 };
  (void)nanosleep(&t, NULL);
}

static int has_lines(FILE *f)
{
  struct stat info;
  return fstat(fileno(f), &info) != 0 || info.st_size > 0;
}

static pendres_status task(const void *arg, size_t i, pendres_context *ctx, farm_record *out)
{
  scene *s = (scene *)(uintptr_t)arg; /* a scene proper writes to its record alone */
  const pendres_pendulum p = { 0.12, 0.2, 0.6 + 0.001 * (double)i, 0.0 };
  const pendres_pendulum bad = { -1.0, 0.2, 1.0, 0.0 };
  double x = 1.0, v = 0.0;
  atomic_fetch_add(&s->runs[i], 1);
  if (i == s->stop_at) atomic_store(&s->stop, 1);
  while (s->deaf && i > s->stop_at && !atomic_load(&s->stop)) nap();
  if (s->deaf) return PENDRES_OK;
  while (i == s->failing && s->awaited != NULL && !has_lines(s->awaited)) nap();
  if (i >= s->endless && i != s->failing && i != s->failing_too)
    return pendres_strobe_advance(ctx, 1, &p, &x, &v, 1000000000L, NULL);
  if (i == s->failing || i == s->failing_too) {
    double two[2] = { 0.0, (double)i };
    const pendres_pendulum pair[2] = { p, bad };
    /* As a rule the later one fails first then: its message must not win. */
    if (i == s->failing && s->failing_too < TASKS)
      (void)pendres_strobe_advance(ctx, 1, &p, &x, &v, 1000, NULL);
    return pendres_strobe_advance(ctx, i == s->failing ? 2 : 1, i == s->failing ? pair : &bad, two,
                                  two, 1, NULL);
  }
  const pendres_status status = pendres_strobe_advance(ctx, 1, &p, &x, &v, 3, NULL);
  double *to = s->sized ? farm_record_resize(out, (i + 1) * sizeof x) : out->data;
  assert_non_null(to);
  for (size_t k = 0; k < out->size / sizeof x; k++) assert_true(to[k] == 0.0);
  to[out->size / sizeof x - 1] = x;
  return status;
}

static pendres_status collect(void *arg, size_t i, const farm_record *in)
{
  scene *s = arg;
  const double *from = in->data;
  if (i == s->refused) return PENDRES_IO;
  assert_int_equal(in->size, s->sized ? (i + 1) * sizeof *from : sizeof *from);
  s->result[i] = from[in->size / sizeof *from - 1];
  s->collected[s->count++] = i;
  return PENDRES_OK;
}

static int stop(void *arg)
{
  return atomic_load(&((scene *)arg)->stop);
}

static farm *new_farm(int threads, scene *s)
{
  farm *f = NULL;
  const farm_options options = { .threads = threads, .stop = stop, .stop_arg = s };
  check_ok(farm_create(&options, &f));
  assert_int_equal(farm_threads(f), threads);
  return f;
}

static pendres_status run(farm *f, size_t tasks, farm_collect *collector, scene *s)
{
  return farm_run(f, &(farm_stage){ .what = "tasks", .tasks = tasks, .task = task,
                                    .record_size = s->sized ? 0 : sizeof(double),
                                    .collect = collector, .arg = s });
}

static void check_collected(const scene *s, size_t count)
{
  assert_int_equal(s->count, count);
  for (size_t i = 0; i < count; i++) assert_int_equal(s->collected[i], i);
}

static void test_all(void **state)
{
  double first[TASKS];
  (void)state;
  for (int threads = 1; threads <= 7; threads += 2) {
    scene *s = new_scene();
    farm *f = new_farm(threads, s);
    pendres_cost cost;
    s->sized = threads == 3;
    check_ok(run(f, TASKS, collect, s));
    check_collected(s, TASKS);
    for (size_t i = 0; i < TASKS; i++) assert_int_equal(atomic_load(&s->runs[i]), 1);
    if (threads == 1) memcpy(first, s->result, sizeof first);
    assert_memory_equal(first, s->result, sizeof first);
    farm_cost(f, &cost);
    assert_true(cost.pendulum_periods >= 3.0 * TASKS);
    /* By task and by context are the same sum, of whole numbers, whoever did what. */
    check_ok(run(f, TASKS, NULL, s));
    pendres_cost twice;
    farm_cost(f, &twice);
    assert_true(twice.pendulum_periods > cost.pendulum_periods);
    assert_string_equal(farm_message(f), "");
    /* Again with the same farm, and without a collector. */
    check_ok(run(f, 3, NULL, s));
    check_ok(run(f, 0, NULL, s));
    farm_free(f);
    free(s);
  }
}

/* Each task reads what was collected of the one before, whatever the threads. */
static pendres_status next_task(const void *arg, size_t i, pendres_context *ctx, farm_record *out)
{
  const scene *s = arg;
  (void)ctx;
  *(double *)out->data = i == 0 ? 1.0 : 0.5 * s->result[i - 1] + (double)i;
  return PENDRES_OK;
}

static void test_chained(void **state)
{
  (void)state;
  for (int threads = 1; threads <= 4; threads += 3) {
    scene *s = new_scene();
    farm *f = new_farm(threads, s);
    double want = 1.0;
    check_ok(farm_run(f, &(farm_stage){ .what = "tasks", .tasks = TASKS, .task = next_task,
                                        .record_size = sizeof want, .chained = 1,
                                        .collect = collect, .arg = s }));
    check_collected(s, TASKS);
    for (size_t i = 0; i < TASKS; i++) {
      want = i == 0 ? 1.0 : 0.5 * want + (double)i;
      assert_true(s->result[i] == want);
    }
    farm_free(f);
    free(s);
  }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/* The stacks of so many threads do not fit: fewer are enough, and nothing ends the program. */
static void test_few_threads(void **state)
{
  const rlim_t room = (rlim_t)1 << 30;
  struct rlimit space;
  scene *s = new_scene();
  farm *f = new_farm(TASKS, s);
  (void)state;
  assert_true((rlim_t)TASKS * FARM_STACK > room);
#ifdef __GLIBC__ /* whose heaps, one for some threads each, take address space by the 64 MiB */
  assert_int_equal(mallopt(M_ARENA_MAX, 1), 1);
#endif
  assert_int_equal(getrlimit(RLIMIT_AS, &space), 0);
  assert_int_equal(setrlimit(RLIMIT_AS, &(struct rlimit){ room, space.rlim_max }), 0);
  const pendres_status status = run(f, TASKS, collect, s);
  const pendres_status again = run(f, TASKS, NULL, s);
  assert_int_equal(setrlimit(RLIMIT_AS, &space), 0);
  check_ok(status);
  check_ok(again);
  check_collected(s, TASKS);
  farm_free(f);
  free(s);
}
#endif

/* Of two failures the one with the lower number is reported, whichever came first. */
static void test_failure(void **state)
{
  (void)state;
  for (int threads = 1; threads <= 4; threads++) {
    scene *s = new_scene();
    farm *f = new_farm(threads, s);
    s->failing = 20;
    s->failing_too = 21;
    s->endless = 22;
    assert_int_equal(run(f, TASKS, collect, s), PENDRES_INVALID_ARGUMENT);
    assert_non_null(strstr(farm_message(f), "pendulum 1"));
    check_collected(s, 20);
    int taken = 0;
    for (size_t i = 0; i < TASKS; i++) taken += atomic_load(&s->runs[i]);
    assert_true(taken <= 22 + threads);
    /* The farm can be used further. */
    s->failing = s->failing_too = s->endless = TASKS;
    s->count = 0;
    check_ok(run(f, TASKS, collect, s));
    check_collected(s, TASKS);
    farm_free(f);
    free(s);
  }
}

/* A failure ends later tasks that are under way; without that this test would take hours. */
static void test_failure_ends_others(void **state)
{
  scene *s = new_scene();
  farm *f = new_farm(2, s);
  (void)state;
  s->failing = 3;
  s->failing_too = 5; /* makes task 3 wait a little */
  s->endless = 4;
  assert_int_equal(run(f, TASKS, collect, s), PENDRES_INVALID_ARGUMENT);
  assert_non_null(strstr(farm_message(f), "pendulum 1"));
  check_collected(s, 3);
  farm_free(f);
  free(s);
}

static void test_collector_refuses(void **state)
{
  (void)state;
  for (int threads = 1; threads <= 3; threads++) {
    scene *s = new_scene();
    farm *f = new_farm(threads, s);
    s->refused = 7;
    assert_int_equal(run(f, TASKS, collect, s), PENDRES_IO);
    check_collected(s, 7);
    farm_free(f);
    free(s);
  }
}

/* A signal in the middle: what is collected is a beginning, and no more tasks are taken. */
static void test_stop(void **state)
{
  (void)state;
  for (int threads = 1; threads <= 6; threads++) {
    scene *s = new_scene();
    farm *f = new_farm(threads, s);
    s->stop_at = 50;
    s->endless = 51;
    s->deaf = threads > 3;
    assert_int_equal(run(f, TASKS, collect, s), PENDRES_INTERRUPTED);
    assert_true(s->count <= 50 + (size_t)threads);
    check_collected(s, s->count);
    int taken = 0;
    for (size_t i = 0; i < TASKS; i++) taken += atomic_load(&s->runs[i]);
    assert_true(taken <= 50 + threads);
    /* Once stopped nothing starts. */
    assert_int_equal(run(f, TASKS, collect, s), PENDRES_INTERRUPTED);
    farm_free(f);
    free(s);
  }
}

/* What was written to a stream, which is closed. */
static void read_lines(FILE *f, char *text, size_t size)
{
  rewind(f);
  const size_t n = fread(text, 1, size - 1, f);
  assert_true(n > 0);
  text[n] = '\0';
  fclose(f);
}

/* A progress that speaks whenever somebody looks, which is each millisecond then. */
static progress talkative(void)
{
  progress p;
  progress_init(&p, tmpfile(), 0);
  assert_non_null(p.stream);
  p.every = 0.0;
  return p;
}

/* Whether the last lines of a stream tell how many drive periods a task has taken. */
static int told_of_periods(void *stream)
{
  char text[1000];
  struct stat info;
  const int file = fileno(stream);
  if (fstat(file, &info) != 0) return 1;
  const off_t from = info.st_size < (off_t)sizeof text ? 0 : info.st_size - (off_t)sizeof text + 1;
  const ssize_t n = pread(file, text, sizeof text - 1, from);
  text[n > 0 ? n : 0] = '\0';
  return strstr(text, " drive periods), for ") != NULL;
}

/* A task of hours tells how far it is: this one ends when it has. */
static void test_periods_told(void **state)
{
  scene *s = new_scene();
  farm *f = NULL;
  progress p = talkative();
  const farm_options options = {
    .threads = 1, .stop = told_of_periods, .stop_arg = p.stream, .progress = &p };
  (void)state;
  s->endless = 0;
  check_ok(farm_create(&options, &f));
  assert_int_equal(run(f, 1, collect, s), PENDRES_INTERRUPTED);
  farm_free(f);
  free(s);
  fclose(p.stream);
}

/* Where there is no line for long, one says what is being worked on. */
static void test_long_task(void **state)
{
  char text[1000];
  scene *s = new_scene();
  farm *f = NULL;
  progress p = talkative();
  const farm_options options = { .threads = 2, .stop = stop, .stop_arg = s, .progress = &p };
  (void)state;
  check_ok(farm_create(&options, &f));
  s->failing = 0; /* as soon as the endless ones were told of */
  s->endless = 1;
  s->awaited = p.stream;
  assert_int_equal(run(f, TASKS, collect, s), PENDRES_INVALID_ARGUMENT);
  farm_free(f);
  free(s);
  read_lines(p.stream, text, sizeof text);
  assert_non_null(strstr(text, "0 of 200 tasks after "));
  assert_non_null(strstr(text, " s; the longest at work is number "));

  p = talkative();
  progress_start(&p, "things", 10, 0);
  progress_tick(&p, 4, "damping 0.1", 400.0);
  progress_end(&p);
  read_lines(p.stream, text, sizeof text);
  assert_non_null(strstr(text, "4 of 10 things after "));
  assert_non_null(strstr(text, " s; the longest at work is damping 0.1, for 400 s"));
}

/* A trial computes some tasks, and concludes from them; all of them, if there is time. */
static void test_trial(void **state)
{
  (void)state;
  for (int all = 0; all < 2; all++) {
    scene *s = new_scene();
    farm *f = new_farm(3, s);
    farm_trial t = { .few = all ? 1e9 : 0.0, .most = 1e9 };
    farm_set_trial(f, &t);
    assert_int_equal(run(f, TASKS, collect, s), all ? PENDRES_OK : PENDRES_INTERRUPTED);
    assert_int_equal(t.tasks, TASKS);
    assert_int_equal(t.tried, all ? TASKS : 1); /* a second one is not begun after no time at all */
    assert_int_equal(atomic_load(&s->runs[TASKS / 2]), 1);
    check_collected(s, all ? TASKS : 0);
    if (all) assert_null(t.what);
    else assert_string_equal(t.what, "tasks");
    /* A record is a number. */
    check_near(t.journal, TASKS * (double)(sizeof(double) + sizeof(journal_entry)), 0.0);
    assert_true(t.seconds > 0.0 && t.cost.pendulum_periods >= 3.0 * TASKS);
    assert_true(farm_trial_outside(&t) >= 0.0);
    farm_free(f);
    free(s);
  }
}

enum { ROW = 5, CHAIN = 6 };

/* A head, and a row of numbers of which two differ from the one before. */
static pendres_status row_task(const void *arg, size_t i, pendres_context *ctx, farm_record *out)
{
  static const int row[ROW] = { 7, 7, 8, 8, 9 };
  const double head = 1.0 / (double)(i + 2);
  char *to = farm_record_resize(out, sizeof head + sizeof row);
  (void)ctx;
  assert_int_equal(*(const size_t *)arg, i); /* of a chain: so many were collected */
  if (to == NULL) return PENDRES_OUT_OF_MEMORY;
  memcpy(to, &head, sizeof head);
  memcpy(to + sizeof head, row, sizeof row);
  return PENDRES_OK;
}

static pendres_status count_rows(void *arg, size_t i, const farm_record *in)
{
  (void)i, (void)in;
  ++*(size_t *)arg;
  return PENDRES_OK;
}

/* A chain is tried from its beginning on, each task after the one before was collected; what
   differs between neighbours is counted, and stands for all. */
static void test_trial_of_a_chain(void **state)
{
  (void)state;
  for (int all = 0; all < 2; all++) {
    size_t collected = 0;
    scene *s = new_scene();
    farm *f = new_farm(1, s);
    farm_trial t = { .few = all ? 1e9 : 0.0, .most = 1e9 };
    const farm_stage stage = { .what = "rows", .tasks = CHAIN, .chained = 1, .record_size = 1,
                               .element = sizeof(int), .task = row_task, .collect = count_rows,
                               .arg = &collected };
    farm_set_trial(f, &t);
    assert_int_equal(farm_run(f, &stage), all ? PENDRES_OK : PENDRES_INTERRUPTED);
    assert_int_equal(t.tried, all ? CHAIN : 2);
    assert_int_equal(collected, t.tried);
    /* Two in the row, and the halves of the head: from one another and from the row. */
    check_near(t.changes, CHAIN * 4.0, 0.0);
    farm_free(f);
    free(s);
  }
}

/* Whatever takes too long is stopped, and nothing is concluded from it. */
static void test_trial_of_long_tasks(void **state)
{
  scene *s = new_scene();
  farm *f = new_farm(1, s);
  farm_trial t = { .few = 0.0, .most = 0.01 };
  (void)state;
  s->endless = 0;
  farm_set_trial(f, &t);
  assert_int_equal(run(f, TASKS, collect, s), PENDRES_INTERRUPTED);
  assert_int_equal(t.tried, 0);
  assert_string_equal(t.what, "tasks");
  farm_free(f);
  free(s);
}

/* The context outside of tasks stops at a signal as well. */
static void test_context(void **state)
{
  scene *s = new_scene();
  farm *f = new_farm(2, s);
  const pendres_pendulum p = { 0.12, 0.2, 0.8, 0.0 };
  pendres_context *ctx = farm_context(f);
  double x = 1.0, v = 0.0;
  (void)state;
  assert_non_null(ctx);
  check_ok(pendres_strobe_advance(ctx, 1, &p, &x, &v, 3, NULL));
  atomic_store(&s->stop, 1);
  assert_int_equal(pendres_strobe_advance(ctx, 1, &p, &x, &v, 3, NULL), PENDRES_INTERRUPTED);
  farm_free(f);
  free(s);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_all),
    cmocka_unit_test(test_chained),
    cmocka_unit_test(test_failure),
    cmocka_unit_test(test_failure_ends_others),
    cmocka_unit_test(test_collector_refuses),
    cmocka_unit_test(test_stop),
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) /* need terabytes themselves */
    cmocka_unit_test(test_few_threads),
#endif
    cmocka_unit_test(test_context),
    cmocka_unit_test(test_long_task),
    cmocka_unit_test(test_periods_told),
    cmocka_unit_test(test_trial),
    cmocka_unit_test(test_trial_of_a_chain),
    cmocka_unit_test(test_trial_of_long_tasks),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
