/*
 * test_resume.c -- runs that are killed at any moment and resumed end in the same bytes as a run
 * that was not interrupted; another deck is refused.
 */
#include "driver_run.h"
#include "kinds_fixture.h"
#include "same_results.h"

#include <math.h>
#include <signal.h>
#include <time.h>

static double now(void)
{
  struct timespec t = { 0 };
  assert_int_equal(clock_gettime(CLOCK_MONOTONIC, &t), 0);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void wait_seconds(double seconds)
{
  const struct timespec t = { (time_t)seconds, (long)(1e9 * (seconds - (double)(long)seconds)) };
  (void)nanosleep(&t, NULL);
}

/* Numbers from 0 to 1, the same in every run of the test. */
static double some_share(void)
{
  static unsigned long state = 20;
  state = (state * 1103515245ul + 12345ul) & 0x7ffffffful;
  return (double)state / (double)0x7ffffffful;
}

/* A run that is resumed ends well, or was killed if it may have been. Whether it went on from
   something. */
static int check_resumed(const char *deck, int code, int killed)
{
  const int as_wanted = code == DONE || code == 3 || (killed && code == 1000 + SIGKILL);
  if (!as_wanted) print_error("%s: code %d: %s\n", deck, code, err);
  assert_true(as_wanted);
  return strstr(err, "going on from") != NULL;
}

/* Kill runs at some moments of their time, then let one end. How many of them went on from
   something. */
static int kill_and_resume(const char *deck, double takes)
{
  const char *const go_on[] = { "--resume", "-t2", "-o", "killed.h5", deck, NULL };
  int went_on = 0;
  for (int k = 0; k < 3; k++) {
    const pid_t pid = start("stdout.txt", 0, go_on);
    wait_seconds(1.1 * takes * some_share());
    (void)kill(pid, SIGKILL);
    went_on += check_resumed(deck, finish(pid), 1);
  }
  return went_on + check_resumed(deck, run_list(go_on), 0);
}

static void killed_at_any_moment(void **state)
{
  const char *decks[MOST_ARGUMENTS + 1];
  int went_on = 0;
  (void)state;
  add_kinds(decks, 0);
  for (size_t i = 0; decks[i] != NULL; i++) {
    const double begin = now();
    const int code = RUN("-q", "-t1", "-o", "whole.h5", decks[i]);
    if (code != DONE && code != 3) check_code(code, DONE);
    went_on += kill_and_resume(decks[i], now() - begin);
    check_same_results("whole.h5", "killed.h5");
    assert_int_equal(count_names("journal"), 0);
  }
  assert_true(went_on > 5);
}

/* Bytes of a file; 0 if it is not there. */
static long long bytes(const char *path)
{
  struct stat s;
  return stat(path, &s) == 0 ? (long long)s.st_size : 0;
}

/* A path is one task: a run that is killed whenever it has kept another state of it comes to its
   end all the same, in the same bytes. The states follow each other by half a second at least, and
   each run adds one. */
static void makes_headway(const char *deck, const char *kind)
{
  enum { MOST_RUNS = 100 };
  const char *const go_on[] = { "--resume", "-t1", "-o", "killed.h5", deck, NULL };
  int runs = 0, killed = 1, went_on = 0;
  write_text(deck, kind);
  check_code(RUN("-q", "-t1", "-o", "whole.h5", deck), DONE);
  for (; killed && runs < MOST_RUNS; runs++) {
    int ended = 0, code = 0;
    const long long before = bytes("killed.h5.journal");
    const pid_t pid = start("stdout.txt", 0, go_on);
    while (!ended && !(bytes("killed.h5.journal") > before + 20000)) {
      wait_seconds(0.01);
      ended = exists("killed.h5");
    }
    if (!ended) (void)kill(pid, SIGKILL);
    code = finish(pid);
    killed = code == 1000 + SIGKILL;
    went_on += strstr(err, "the states of unfinished ones") != NULL;
    assert_true(killed || code == DONE);
  }
  assert_true(went_on > 0 && !killed);
  check_same_results("whole.h5", "killed.h5");
  assert_int_equal(count_names("journal"), 0);
  assert_int_equal(remove("killed.h5"), 0);
}

static void paths_make_headway(void **state)
{
  (void)state;
  makes_headway("deck.nml", "&scene kind = 'hysteresis' /\n"
                "&pendulum damping = 0.5, drive_frequency = 0.66666666666666667 /\n"
                "&sweep drive_amplitude_range = 1.06, 1.083, 24 /\n&hysteresis x = 1.6 /\n");
  makes_headway("deck.nml", "&scene kind = 'bifurcation_diagram' /\n"
                "&pendulum damping = 0.5, drive_frequency = 0.66666666666666667 /\n"
                "&sweep drive_amplitude_range = 1.06, 1.09, 31 /\n"
                "&bifurcation_diagram x = 1.6, strobes = 20 /\n");
}

/* Where no state of a path can be written that is said at once, with the reason. */
static void states_that_cannot_be_kept(void **state)
{
  const char *const arguments[] = { "-q", "-t1", "-o", "tight.h5", "deck.nml", NULL };
  (void)state;
  write_text("deck.nml", "&scene kind = 'hysteresis' /\n"
             "&pendulum damping = 0.5, drive_frequency = 0.66666666666666667 /\n"
             "&sweep drive_amplitude_range = 1.06, 1.083, 24 /\n&hysteresis x = 1.6 /\n");
  const pid_t pid = start("stdout.txt", 8192, arguments); /* a state is larger */
  assert_int_equal(finish(pid), 1);
  check_says(err, "cannot write the journal");
  check_says(err, "is not kept if the run is stopped");
  (void)remove("tight.h5.journal");
}

/* A fit is a search, and its state where that is: of a linear decay, whose scale nothing tells, the
   model is computed at some thousand values. */
static void fits_make_headway(void **state)
{
  (void)state;
  FILE *f = fopen("decay.csv", "w");
  assert_non_null(f);
  fprintf(f, "time, volts\n");
  for (int i = 0; i < 12000; i++)
    fprintf(f, "%.17g, %.17g\n", 0.05 * i,
            exp(-0.005 * i * 0.05) * cos(0.05 * i) + 0.02 * cos(1e3 * i * i));
  assert_int_equal(fclose(f), 0);
  makes_headway("deck.nml", "&scene kind = 'fit' /\n&pendulum force = 'polynomial', "
                "force_coefficients = 1 /\n&data file = 'decay.csv', axis = 'time', columns = "
                "'time', 'volts', error = 0.0141 /\n&fit free = 'damping', 'a1', "
                "'amplitude_scale' /\n");
}

/* Stopped by a signal: said so, with the way to go on. */
static void stopped_by_signal(void **state)
{
  (void)state;
  write_text("deck.nml", "&scene kind = 'resonance_curve' /\n&pendulum drive_amplitude = 0.2 /\n"
                         "&sweep damping_range = 0.5, 1.5, 2000 /\n&ensemble members = 8 /\n");
  const pid_t pid = start("stdout.txt", 0, (const char *const[]){ "deck.nml", "-t2", NULL });
  /* Until tasks are finished, however busy the machine: the head has 645 bytes, a task 61 kB. */
  for (int k = 0; k < 6000 && bytes("deck.h5.journal") < 4096; k++) wait_seconds(0.01);
  assert_int_equal(kill(pid, SIGTERM), 0);
  const double sent = now();
  check_code(finish(pid), 75);
  assert_true(now() - sent < 5.0); /* a second, on a machine that does other things as well */
  check_says(err, "stopped by SIGTERM; ");
  check_says(err, "finished tasks are kept in ");
  check_says(err, "--resume");
  assert_true(exists("deck.h5.journal") && !exists("deck.h5") && count_names(".part") == 0);
  /* Of another deck it is refused with the difference, which is not the output's name. */
  write_text("deck.nml", "&scene kind = 'resonance_curve' /\n&pendulum drive_amplitude = 0.2 /\n"
                         "&sweep damping_range = 0.5, 1.5, 2000 /\n&ensemble members = 9 /\n");
  check_code(RUN("--resume", "deck.nml"), 2);
  check_says(err, "'members = 8'");
  check_says(err, "'members = 9'");
  assert_true(exists("deck.h5.journal"));
}

/* A journal is not gone on with where the C library rounds otherwise: here glibc, which is told to
   do without FMA. */
static void other_roundings_are_told(void **state)
{
  (void)state;
#if defined(__x86_64__) && defined(__GLIBC__)
  if (!__builtin_cpu_supports("fma")) skip();
  write_text("deck.nml", "&scene kind = 'phase_diagram' /\n&pendulum drive_amplitude = 0.2 /\n"
                         "&sweep damping = 0.1, 0.2, drive_frequency_range = 0.7, 0.9, 3 /\n"
                         "&ensemble members = 4 /\n");
  check_code(RUN("-o", "run.h5", "--shard=1/2", "deck.nml"), DONE);
  assert_int_equal(rename("run.h5.1-of-2.journal", "run.h5.journal"), 0);
  assert_int_equal(setenv("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4", 1), 0);
  check_code(RUN("-o", "run.h5", "--resume", "deck.nml"), 2);
  check_says(err, "it has 'roundings of the C library ");
  assert_int_equal(unsetenv("GLIBC_TUNABLES"), 0);
  check_code(RUN("-o", "run.h5", "--resume", "deck.nml"), DONE);
#else
  skip();
#endif
}

/* What a killed run has left, where HDF5's own variable switches its locks off: that nobody writes
   the part is known from the journal's lock. Without a journal nobody knows, and it is refused. */
static void killed_without_locks(void **state)
{
  const char *const arguments[] = { "-o", "one.h5", "long.nml", NULL };
  (void)state;
  assert_int_equal(setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1), 0);
  const pid_t pid = start("stdout.txt", 0, arguments);
  for (int k = 0; k < 1000 && !exists("one.h5.part"); k++) wait_seconds(0.01);
  assert_int_equal(kill(pid, SIGKILL), 0);
  check_code(finish(pid), 1000 + SIGKILL);
  assert_true(exists("one.h5.part"));
  check_code(RUN("-o", "one.h5", "--no-journal", "small.nml"), 1);
  check_says(err, "one.h5.part");
  /* Another deck. */
  check_code(RUN("-o", "one.h5", "--resume", "long.nml", "pendulum.damping=0.01"), 2);
  if (exists("one.h5.journal")) assert_int_equal(remove("one.h5.journal"), 0);
  check_code(RUN("-o", "one.h5", "--resume", "small.nml"), DONE);
  assert_true(exists("one.h5") && !exists("one.h5.part"));
  assert_int_equal(unsetenv("HDF5_USE_FILE_LOCKING"), 0);
}

/* A run of another deck, and the same command without --resume, leave what a stopped run has
   computed, and say so. A run that nobody else may read stays so. */
static void kept_for_others(void **state)
{
  struct stat info;
  (void)state;
  write_text("deck.nml", "&scene kind = 'phase_diagram' /\n&pendulum drive_amplitude = 0.2 /\n"
                         "&sweep damping = 0.1, 0.2, drive_frequency_range = 0.7, 0.9, 3 /\n"
                         "&ensemble members = 4 /\n");
  check_code(RUN("-o", "run.h5", "--shard=1/2", "deck.nml"), DONE);
  assert_int_equal(rename("run.h5.1-of-2.journal", "run.h5.journal"), 0);
  const long long whole = bytes("run.h5.journal");
  check_code(RUN("-o", "run.h5", "orbit.nml"), DONE);
  check_says(err, "the journal of another deck or build is kept as 'run.h5.journal.~1~'");
  assert_int_equal(bytes("run.h5.journal.~1~"), whole);
  assert_int_equal(rename("run.h5.journal.~1~", "run.h5.journal"), 0);
  write_text("run.h5.journal~", "poems");
  assert_int_equal(chmod("run.h5", 0600), 0);
  check_code(RUN("-q", "-f", "-o", "run.h5", "deck.nml"), DONE);
  check_says(err, "is kept as 'run.h5.journal.~1~'");
  check_says(err, "--resume");
  assert_int_equal(bytes("run.h5.journal.~1~"), whole);
  assert_int_equal(bytes("run.h5.journal~"), 5);
  assert_int_equal(stat("run.h5", &info), 0);
  assert_int_equal(info.st_mode & 0777, 0600);
  /* And it is of use: the same bytes come from it. */
  assert_int_equal(rename("run.h5.journal.~1~", "again.h5.journal"), 0);
  check_code(RUN("-o", "again.h5", "--resume", "deck.nml"), DONE);
  check_says(err, "going on from ");
  check_same_results("run.h5", "again.h5");
}

/* In a folder of the user's choice, or not at all. */
static void place_of_journal(void **state)
{
  (void)state;
  check_code(RUN("--journal=nowhere", "orbit.nml"), 1);
  check_says(err, "nowhere/orbit.h5.journal");
  assert_false(exists("orbit.h5"));
  check_code(RUN("--no-journal", "orbit.nml"), DONE);
  check_code(RUN("--resume", "--journal=.", "orbit.nml"), DONE);
  assert_int_equal(count_names("journal"), 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = { TEST(killed_at_any_moment), TEST(stopped_by_signal),
                                      TEST(paths_make_headway), TEST(fits_make_headway),
                                      TEST(states_that_cannot_be_kept),
                                      TEST(place_of_journal), TEST(other_roundings_are_told),
                                      TEST(killed_without_locks),
                                      TEST(kept_for_others) };
  if (!find_program()) return 77;
  return cmocka_run_group_tests(tests, NULL, NULL);
}
