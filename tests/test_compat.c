/* test_compat.c -- SUNDIALS 6.4 to 7.x behind one interface; see src/engine/sundials/compat.h. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L /* dup2, fileno */
#endif

#include <string.h>
#include <unistd.h>

#include <nvector/nvector_serial.h>

#include "check.h"
#include "engine/sundials/compat.h"

static int refuse; /* the right-hand side fails on purpose */

/* A free pendulum. */
static int slope(sunrealtype t, N_Vector y, N_Vector out, void *arg)
{
  const double *s = N_VGetArrayPointer(y);
  (void)t;
  (void)arg;
  N_VGetArrayPointer(out)[0] = s[1];
  N_VGetArrayPointer(out)[1] = -sin(s[0]);
  return refuse ? -1 : 0;
}

static N_Vector start(SUNContext sun)
{
  N_Vector y = N_VNew_Serial(2, sun);
  assert_non_null(y);
  N_VGetArrayPointer(y)[0] = 2.0;
  N_VGetArrayPointer(y)[1] = 0.0;
  return y;
}

/* Every way to fail that the library can meet; codes matter, words are unwanted. */
static void provoke(SUNContext sun)
{
  N_Vector y = start(sun);
  sunrealtype t = 0.0;
  void *erk = ERKStepCreate(slope, 0.0, y, sun), *cvode = CVodeCreate(CV_ADAMS, sun);
  assert_non_null(erk);
  assert_non_null(cvode);
  assert_int_equal(pendres_compat_silence(sun, erk, cvode), 0);

  assert_int_not_equal(ERKStepSStolerances(erk, -1.0, 1.0), 0);
  assert_int_equal(ERKStepSStolerances(erk, 1e-12, 1e-12), 0);
  assert_int_equal(ERKStepSetMaxNumSteps(erk, 2), 0);
  assert_true(ERKStepEvolve(erk, 1e6, y, &t, ARK_NORMAL) < 0);
  assert_int_equal(ERKStepReset(erk, 1e20, y), 0);
  assert_int_equal(ERKStepSetInitStep(erk, 1.0), 0); /* lost in rounding: a warning a step */
  (void)ERKStepEvolve(erk, 2e20, y, &t, ARK_ONE_STEP);
  refuse = 1;
  assert_int_equal(ERKStepReset(erk, 0.0, y), 0);
  assert_true(ERKStepEvolve(erk, 1.0, y, &t, ARK_NORMAL) < 0);
  refuse = 0;

  assert_true(CVode(cvode, 1.0, y, &t, CV_NORMAL) < 0); /* not initialised */
  assert_int_equal(CVodeInit(cvode, slope, 0.0, y), 0);
  assert_int_not_equal(CVodeSStolerances(cvode, -1.0, 1.0), 0);
  ERKStepFree(&erk);
  CVodeFree(&cvode);
  N_VDestroy(y);
}

static void test_silence(void **state)
{
  SUNContext sun = NULL;
  FILE *heard = tmpfile();
  (void)state;
  assert_non_null(heard);
  fflush(stdout);
  fflush(stderr);
  const int out = dup(STDOUT_FILENO), err = dup(STDERR_FILENO);
  assert_true(out >= 0 && err >= 0);
  assert_true(dup2(fileno(heard), STDOUT_FILENO) >= 0 && dup2(fileno(heard), STDERR_FILENO) >= 0);

  const int created = pendres_compat_context_create(&sun);
  if (created == 0) provoke(sun);
  if (sun != NULL) SUNContext_Free(&sun);

  fflush(stdout);
  fflush(stderr);
  assert_true(dup2(out, STDOUT_FILENO) >= 0 && dup2(err, STDERR_FILENO) >= 0);
  close(out);
  close(err);
  assert_int_equal(created, 0);
  rewind(heard);
  int words = 0;
  for (int c = fgetc(heard); c != EOF; c = fgetc(heard), words++) print_error("%c", c);
  assert_int_equal(words, 0);
  fclose(heard);
}

/* The free pendulum from the angle 2, where it is at time 50; steps and refused ones. */
static double swing(double tolerance, long *steps, long *fails)
{
  SUNContext sun = NULL;
  sunrealtype t = 0.0;
  assert_int_equal(pendres_compat_context_create(&sun), 0);
  N_Vector y = start(sun);
  void *erk = ERKStepCreate(slope, 0.0, y, sun);
  assert_non_null(erk);
  assert_int_equal(pendres_compat_silence(sun, erk, NULL), 0);
  assert_int_equal(ERKStepSetTableNum(erk, ARKODE_DORMAND_PRINCE_7_4_5), 0);
  assert_int_equal(ERKStepSStolerances(erk, tolerance, tolerance), 0);
  assert_int_equal(ERKStepSetInitStep(erk, 0.01), 0);
  assert_int_equal(pendres_compat_set_pid(erk), 0);
  assert_int_equal(ERKStepSetErrorBias(erk, 1.5), 0);
  assert_int_equal(ERKStepSetSafetyFactor(erk, 0.96), 0);
  assert_int_equal(ERKStepSetFixedStepBounds(erk, 1.0, 1.5), 0);
  assert_int_equal(ERKStepSetMaxGrowth(erk, 20.0), 0);
  assert_int_equal(ERKStepSetMaxNumSteps(erk, 10000), 0);
  assert_int_equal(ERKStepSetStopTime(erk, 50.0), 0);
  /* Which is 0 of 6.4.1 and ARK_TSTOP_RETURN of 7.9.0. */
  assert_true(ERKStepEvolve(erk, 50.0, y, &t, ARK_NORMAL) >= 0);
  assert_int_equal(ERKStepGetNumSteps(erk, steps), 0);
  assert_int_equal(ERKStepGetNumErrTestFails(erk, fails), 0);
  check_near(t, 50.0, 0.0);
  const double x = N_VGetArrayPointer(y)[0];
  ERKStepFree(&erk);
  N_VDestroy(y);
  SUNContext_Free(&sun);
  return x;
}

/*
 * Every parameter of the controller is set. Up to 7.2 all releases then take the same steps. From
 * 7.3 on the controller knows that it has no history: its first two steps are an I controller's and
 * a PI controller's, and one of them is refused. Counts are those of 6.4.1 and of 7.9.0 with
 * Dormand-Prince 5(4); one step more or less is left for a libm that rounds differently. Either way
 * the error is what the tolerance asks for, a unit of time.
 */
static void test_controller(void **state)
{
  long steps = 0, fails = 0, more = 0;
  (void)state;
  const double x = swing(1e-9, &steps, &fails);
  check_near((double)steps, 957.0, 1.0);
  assert_int_equal(fails, PENDRES_COMPAT_SUNDIALS(7, 3) ? 1 : 0);
  check_near(x, swing(1e-12, &more, &fails), 50 * 1e-9);
  assert_true(more > 3 * steps); /* 1000^(1/5), less what the first steps take */
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(test_silence),
    cmocka_unit_test(test_controller),
  };
  return cmocka_run_group_tests_name("compat", tests, NULL, NULL);
}
