/*
 * test_budget.c -- points that take long: they are named in messages, ended by their budget and
 * marked, and computed again when a run is resumed. There are no tolerances, only bytes and counts.
 * A budget is a time, but the tests do not depend on how fast the machine is: a point never ends,
 * or is so short that its budget is never looked at, or the budget is so small that the first look
 * ends it.
 */
#include "driver_run.h"
#include "same_results.h"

#include <stdint.h>

#include "engine/context_internal.h"
#include "farm/farm.h"
#include "farm/journal.h"
#include "farm/trial.h"
#include "results/failed.h"

enum { TASKS = 20, ENDLESS = 12 };

/* A pendulum that would keep a thread busy for hours. */
static pendres_status never_end(pendres_context *ctx)
{
  const pendres_pendulum p = { .damping = 0.12, .drive_amplitude = 0.2, .drive_frequency = 0.7 };
  double x = 1.0, v = 0.0;
  return pendres_strobe_advance(ctx, 1, &p, &x, &v, 1000000000L, NULL);
}

/* Two points, the first of which has no end in one task. */
static pendres_status two_points(const void *arg, size_t i, pendres_context *ctx, farm_record *out)
{
  int *marks = out->data;
  char words[200];
  pendres_status status = PENDRES_OK;
  (void)arg;
  farm_point(out, 1, "place %zu", 2 * i);
  if (i == ENDLESS) status = never_end(ctx);
  assert_int_equal(farm_gave_up(out, status), i == ENDLESS);
  if (farm_gave_up(out, status)) {
    marks[0] = 1;
    farm_lost(out, words, sizeof words);
    check_says(words, "ended by its budget after ");
    check_says(words, "--budget=SECONDS");
  }
  farm_point(out, 1, "place %zu", 2 * i + 1);
  assert_false(farm_gave_up(out, PENDRES_OK));
  marks[1] = 2;
  return PENDRES_OK;
}

static pendres_status collect(void *arg, size_t i, const farm_record *in)
{
  const int *marks = in->data;
  assert_int_equal(marks[0], i == ENDLESS);
  assert_int_equal(marks[1], 2);
  ++*(int *)arg;
  return PENDRES_OK;
}

static farm *new_farm(int threads, double budget, progress *p, int (*stop)(void *))
{
  farm *f = NULL;
  const farm_options options = { .threads = threads, .budget = budget, .progress = p, .stop = stop,
                                 .stop_arg = p };
  check_ok(farm_create(&options, &f));
  return f;
}

/* The run goes on, and the journal has all but what was given up, and what may have read it. */
static void ends_at_its_budget(void **state)
{
  char words[JOURNAL_WORDS];
  (void)state;
  for (int threads = 1; threads <= 3; threads += 2) {
    int collected = 0;
    journal *j = NULL;
    farm *f = new_farm(threads, 1e-3, NULL, NULL);
    farm_stage stage = { .what = "tasks", .tasks = TASKS, .record_size = 2 * sizeof(int),
                         .task = two_points, .collect = collect, .arg = &collected };
    check_ok(journal_open("run.journal", "head\n", 0, &j, words));
    farm_set_journal(f, j);
    check_ok(farm_run(f, &stage));
    assert_int_equal(collected, TASKS);
    assert_int_equal(farm_points_lost(f), 1);
    const uint64_t number = journal_stage(0, stage.what, stage.tasks, stage.record_size);
    for (size_t i = 0; i < TASKS; i++) assert_int_equal(journal_has(j, number, i), i != ENDLESS);
    stage.tasks = ENDLESS; /* without the endless one */
    check_ok(farm_run(f, &stage));
    assert_int_equal(journal_count(j), TASKS - 1);
    farm_free(f);
    journal_remove(j);
  }
}

/* ---- what is told ---- */

static pendres_status one_point(const void *arg, size_t i, pendres_context *ctx, farm_record *out)
{
  (void)arg;
  farm_point(out, 1, "place %zu", i);
  return i == ENDLESS ? never_end(ctx) : PENDRES_OK;
}

static size_t read_told(FILE *f, char *text, size_t size)
{
  const ssize_t n = pread(fileno(f), text, size - 1, 0);
  assert_true(n >= 0);
  text[n] = '\0';
  return (size_t)n;
}

/* The run is stopped when the point was told of. */
static int told(void *arg)
{
  char text[4000];
  const progress *p = arg;
  (void)read_told(p->stream, text, sizeof text);
  return strstr(text, "takes long") != NULL;
}

static void costly_points_are_told(void **state)
{
  char text[4000];
  progress p;
  (void)state;
  progress_init(&p, tmpfile(), 0);
  assert_non_null(p.stream);
  p.every = 0.6; /* instead of five minutes, and then 10 ms of work are long */
  farm *f = new_farm(1, 0.0, &p, told);
  const farm_stage stage = { .what = "tasks", .tasks = TASKS, .task = one_point };
  assert_int_equal(farm_run(f, &stage), PENDRES_INTERRUPTED);
  (void)read_told(p.stream, text, sizeof text);
  check_says(text, "place 12 takes long: ");
  check_says(text, " times what points took so far (--budget=SECONDS ends such points)");
  farm_free(f);
  assert_int_equal(fclose(p.stream), 0);
}

/* A bar has the name too, and does not go beyond its line. */
static void a_bar_names_what_is_long(void **state)
{
  char text[4000];
  progress p;
  (void)state;
  progress_init(&p, tmpfile(), 0);
  assert_non_null(p.stream);
  p.terminal = 1;
  progress_start(&p, "dampings", 10, 0);
  progress_tick(&p, 4, "damping 0.1", 400.0);
  (void)read_told(p.stream, text, sizeof text);
  check_says(text, "4 of 10 dampings; damping 0.1 for 400 s");
  progress_tick(&p, 4, "a name that is much longer than what is left of a line of a terminal", 4.0);
  assert_int_equal(p.width, 79);
  progress_end(&p);
  assert_int_equal(fclose(p.stream), 0);
}

/* Before the first tasks, and between stages, it is told for how long nothing has been counted. */
static void waiting_is_shown(void **state)
{
  char text[4000];
  progress p;
  (void)state;
  progress_init(&p, tmpfile(), 0);
  assert_non_null(p.stream);
  p.terminal = 1;
  progress_wait(&p);
  assert_int_equal(p.width, 0); /* not at once */
  p.start -= 7.2;
  progress_wait(&p);
  (void)read_told(p.stream, text, sizeof text);
  check_says(text, "before the next tasks, for 7 s");
  const int width = p.width;
  progress_start(&p, "dampings", 10, 0);
  progress_wait(&p); /* tasks are counted now */
  assert_int_equal(p.width, width);
  progress_end(&p);
  assert_int_equal(p.width, 0);
  p.terminal = 0;
  p.every = 0.0;
  progress_wait(&p);
  (void)read_told(p.stream, text, sizeof text);
  check_says(text, "resonance: before the next tasks, for 0 s\n");
  assert_int_equal(fclose(p.stream), 0);
}

/* What has no count says what it is after ten seconds, and when that time has doubled. */
static void doing_is_told(void **state)
{
  static const double seconds[] = {9.0, 10.5, 19.0, 22.0, 30.0, 46.0};
  static const int told[] = {0, 1, 1, 2, 2, 3};
  char text[4000];
  progress p;
  (void)state;
  progress_init(&p, tmpfile(), 0);
  assert_non_null(p.stream);
  p.terminal = 0;
  progress_doing(&p, "the fit of a.csv has no answer yet");
  for (int i = 0; i < 6; i++) {
    const double later = seconds[i] - (i > 0 ? seconds[i - 1] : 0.0);
    p.start -= later;
    p.spoken -= later;
    progress_wait(&p);
    fflush(p.stream);
    rewind(p.stream);
    int lines = 0;
    while (fgets(text, sizeof text, p.stream) != NULL) lines++;
    assert_int_equal(lines, told[i]);
  }
  check_says(text, "resonance: the fit of a.csv has no answer yet, for 46 s\n");
  progress_doing(&p, "");
  p.spoken -= 100.0;
  progress_wait(&p);
  assert_int_equal(fclose(p.stream), 0);
}

/* ---- the program ---- */

static const struct {
  const char *name, *text;
} decks[] = {
  { "response", "&scene kind = 'response' /\n&pendulum drive_amplitude = 0.2 /\n"
                "&sweep damping = 0.24, 0.5, drive_period_range = 6, 8, 20 /\n"
                "&ensemble members = 8 /\n" },
  { "diagram", "&scene kind = 'phase_diagram' /\n&pendulum drive_amplitude = 0.2 /\n"
               "&sweep damping = 0.10, 0.12, drive_frequency_range = 0.7, 0.9, 4 /\n"
               "&ensemble members = 8 /\n" },
  { "curve", "&scene kind = 'resonance_curve' /\n&pendulum drive_amplitude = 0.2 /\n"
             "&sweep damping = 0.5, 0.9 /\n&ensemble members = 8 /\n" },
  { "switching", "&scene kind = 'switching' /\n"
                 "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 7.7 /\n"
                 "&sweep temperature = 0.02, 0.03 /\n&noise trajectories = 400, periods = 20 /\n" },
  { "map", "&scene kind = 'lyapunov_map' /\n&pendulum drive_frequency = 0.8 /\n"
           "&sweep damping = 0.3, 0.5, drive_amplitude_range = 0.5, 1.5, 6000 /\n"
           "&lyapunov_map transient = 20, periods = 40 /\n" },
};

/* Half of the tasks are there, and the others are given up at the first question; then they are
   computed after all, and the results are those of a run in peace. */
static void the_run_goes_on(void **state)
{
  (void)state;
  for (size_t i = 0; i < sizeof decks / sizeof *decks; i++) {
    write_text("deck.nml", decks[i].text);
    const int code = RUN("-q", "--budget=1e6", "-o", "whole.h5", "deck.nml");
    if (code != 3) check_code(code, DONE);
    if (strcmp(decks[i].name, "map") != 0) check_code(code, DONE);
    check_code(RUN("--shard=1/2", "deck.nml"), DONE);
    check_code(RUN("--merge", "--resume", "--budget=1e-9", "deck.nml"), 3);
    check_says(err, "ended by --budget; ");
    check_says(err, "since all else is kept in ");
    check_says(err, "ended by its budget");
    assert_true(exists("deck.h5") && exists("deck.h5.1-of-2.journal"));
    assert_int_equal(RUN("--merge", "--resume", "deck.nml"), code);
    check_same_results("whole.h5", "deck.h5");
    assert_int_equal(count_names("journal"), 0);
  }
}

static const struct {
  const char *text, *told;
} others[] = {
  { "&scene kind = 'orbit' /\n"
    "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_frequency = 0.8 /\n"
    "&orbit x = 1.0, v = 0.0, periods = 3 /\n", "orbit: ended by its budget" },
  { "&scene kind = 'hysteresis' /\n&pendulum drive_amplitude = 0.2, damping = 0.12 /\n"
    "&sweep drive_frequency_range = 0.80, 0.85, 6 /\n&hysteresis x = 1.0, v = 0.0 /\n",
    "drive_frequency 0.8, upwards: ended by its budget" },
  { "&scene kind = 'bifurcation_diagram' /\n&pendulum drive_frequency = 0.8, damping = 0.3 /\n"
    "&sweep drive_amplitude_range = 0.5, 0.6, 3 /\n"
    "&bifurcation_diagram x = 1.0, v = 0.0, strobes = 4 /\n",
    "attractors at drive_amplitude 0.5: ended by its budget" },
  { "&scene kind = 'basins' /\n"
    "&pendulum drive_amplitude = 0.2, damping = 0.12, drive_period = 8.0 /\n"
    "&sweep x_range = -1.5, 4.7, 8, v_range = -2.0, 2.0, 9 /\n",
    "the state at x -1.5, v -2: ended by its budget" },
};

/* All that a first run could not do is marked, the run that goes on does it, and ends in the bytes
   of a run in peace. */
static void scenes_without_lines(void **state)
{
  (void)state;
  for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
    write_text("deck.nml", others[i].text);
    check_code(RUN("-q", "-f", "--budget=1e6", "-o", "whole.h5", "deck.nml"), DONE);
    check_code(RUN("-f", "--budget=1e-9", "deck.nml"), 3);
    check_says(err, others[i].told);
    check_says(err, " ended by --budget; ");
    check_code(RUN("-f", "--resume", "deck.nml"), DONE);
    check_same_results("whole.h5", "deck.h5");
    assert_int_equal(count_names("journal"), 0);
  }
}

/* A part that has given up something says so. */
static void parts_tell(void **state)
{
  (void)state;
  write_text("deck.nml", decks[0].text);
  check_code(RUN("--shard=1/2", "--budget=1e-9", "deck.nml"), 3);
  check_says(err, "ended by --budget, and are left to --merge --resume");
  check_code(RUN("--budget=0", "deck.nml"), 2);
  check_says(err, "--budget takes seconds, more than 0, not '0'");
  check_code(RUN("--budget=1h", "deck.nml"), 2);
  write_text("free.nml",
             "&scene kind = 'free_oscillation' /\n&sweep amplitude = 0.5, 1.0 /\n");
  check_code(RUN("--budget=2", "free.nml"), DONE);
  check_says(err, "--budget has no effect on scenes of this kind");
}

/* A path that says how much of it is done, and comes to no end. */
static pendres_status path_task(const void *arg, size_t i, pendres_context *ctx, farm_record *out)
{
  (void)arg, (void)out;
  if (i > 0) return PENDRES_OK;
  (void)ctx->keep.due(ctx->keep.arg, 0.125);
  while (!ctx->stop(ctx->stop_arg)) continue;
  return PENDRES_INTERRUPTED;
}

/* Then all of it is known, and the other tasks do not count as such. */
static void tried_by_its_share(void **state)
{
  farm *f = new_farm(1, 0.0, NULL, NULL);
  farm_trial t = { .few = 1e9, .most = 0.1 };
  const farm_stage stage = { .what = "paths", .tasks = 3, .paths = 1, .record_size = 1,
                             .task = path_task };
  (void)state;
  farm_set_trial(f, &t);
  assert_int_equal(farm_run(f, &stage), PENDRES_INTERRUPTED);
  assert_int_equal(t.tried, 3);
  assert_int_equal(t.cut, 0);
  check_near(t.path, 0.125, 0.0);
  check_near(t.seconds, 8.0 * t.spent, 0.1 * t.seconds); /* the others are as good as nothing */
  farm_free(f);
}

int main(void)
{
  const struct CMUnitTest tests[] = { TEST(ends_at_its_budget), TEST(costly_points_are_told),
                                      TEST(a_bar_names_what_is_long), TEST(waiting_is_shown),
                                      TEST(doing_is_told), TEST(the_run_goes_on),
                                      TEST(scenes_without_lines),
                                      TEST(parts_tell), TEST(tried_by_its_share) };
  if (!find_program()) return 77;
  return cmocka_run_group_tests(tests, NULL, NULL);
}
