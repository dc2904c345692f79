/*
 * test_scene_sweeps.c -- scenes in which parameters move, run in this process on small decks: what
 * is written is what the library finds, whatever the threads.
 */
#include "scene_fixture.h"

#include <pendres/pendres.h>

#define HYSTERESIS \
  "&scene kind = 'hysteresis' /\n&pendulum drive_amplitude = 0.2, damping = 0.15 /\n"

/* Both jumps of Fig. 9's middle damping: folds, and the ends that the scene `branches` finds. */
static void hysteresis(void **state)
{
  (void)state;
  static const char deck_text[] = HYSTERESIS
    "&sweep drive_frequency_range = 0.65, 0.9, 11 /\n&hysteresis start = 'sa' /\n";
  size_t n = 0;
  scene_run_deck(deck_text, 1, "one");
  scene_run_deck(deck_text, 2, "two");
  scene_check_same_bytes("one", "two");
  pendres_store *store = scene_open("one");
  double *value = scene_values(store, "jump_parameter", &n);
  assert_int_equal(n, 2);
  double *error = scene_values(store, "jump_parameter_error", &n);
  double *from = scene_values(store, "jump_from", &n), *to = scene_values(store, "jump_to", &n);
  double *way = scene_values(store, "jump_direction", &n);
  double *label = scene_values(store, "label", &n);
  assert_int_equal(n, 22);
  double *amplitude = scene_values(store, "amplitude", &n);
  double *period = scene_values(store, "period", &n);
  assert_true(way[0] == 0.0 && way[1] == 1.0);
  assert_true(from[0] == PENDRES_LABEL_SA && to[0] == PENDRES_LABEL_LA);
  assert_true(from[1] == PENDRES_LABEL_LA && to[1] == PENDRES_LABEL_SA);
  for (int i = 0; i < 11; i++) {
    const double frequency = 0.65 + 0.025 * i;
    assert_int_equal(label[i], frequency < value[0] ? PENDRES_LABEL_SA : PENDRES_LABEL_LA);
    assert_int_equal(label[11 + i], frequency < value[1] ? PENDRES_LABEL_SA : PENDRES_LABEL_LA);
    assert_true(period[i] == 1.0 && period[11 + i] == 1.0);
    if (label[i] == label[11 + i]) check_near(amplitude[i], amplitude[11 + i], 1e-7);
  }
  for (int k = 0; k < 2; k++) {
    pendres_context *ctx = NULL;
    pendres_fold fold;
    pendres_attractors *set = NULL;
    /* From the far side of each branch. */
    const pendres_pendulum p = {.damping = 0.15, .drive_amplitude = 0.2,
                                .drive_frequency = k == 0 ? 0.7 : 0.88};
    check_ok(pendres_context_create(NULL, &ctx));
    check_ok(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &set));
    check_ok(pendres_fold_find(ctx, &pendres_attractors_get(set, 0)->orbit, PENDRES_DRIVE_FREQUENCY,
                               &fold));
    check_near(value[k], fold.value, error[k] + fold.value_error);
    pendres_attractors_free(set);
    pendres_context_free(ctx);
  }
  pendres_store_free(store);
  free(value), free(error), free(from), free(to), free(way), free(label), free(amplitude);
  free(period);
}

/* Where rounding chooses between a running orbit and its mirror image, the map says so, as scene
   `orbit` does, and the errors of what the orbit is are not 0; a weakly driven one with more
   friction is sure. */
static void uncertain_starts(void **state)
{
  static const char pendulum[] = "&pendulum drive_frequency = 2.140092220495635,\n"
    "  parametric_amplitude = -1.1244206502883256";
  char text[500];
  size_t n = 0;
  (void)state;
  snprintf(text, sizeof text, "&scene kind = 'lyapunov_map' /\n%s /\n"
           "&sweep damping = 0.05023358555773262, 0.5,\n"
           "  drive_amplitude = 0.01, 1.4276803210172417 /\n"
           "&lyapunov_map x = 1.731637374106456, v = 0.3141185235724825 /\n", pendulum);
  scene_run_deck(text, 1, "map");
  pendres_store *store = scene_open("map");
  double *uncertain = scene_values(store, "uncertain", &n);
  double *winding = scene_values(store, "winding", &n);
  double *winding_error = scene_values(store, "winding_error", &n);
  double *rotation_error = scene_values(store, "rotation_error", &n);
  assert_true(uncertain[2] == 0.0 && winding[2] == 0.0 && winding_error[2] == 0.0);
  assert_true(uncertain[1] == 1.0 && fabs(winding[1]) == 1.0 && isnan(winding_error[1]));
  check_near(rotation_error[1], 2.0, 1e-12);
  pendres_store_free(store);
  free(uncertain), free(winding), free(winding_error), free(rotation_error);
  snprintf(text, sizeof text, "&scene kind = 'orbit' /\n%s,\n"
           "  damping = 0.05023358555773262, drive_amplitude = 1.4276803210172417 /\n"
           "&orbit x = 1.731637374106456, v = 0.3141185235724825, periods = 1 /\n", pendulum);
  scene_run_deck(text, 1, "orbit");
  store = scene_open("orbit");
  assert_true(scene_scalar(store, "uncertain") == 1.0);
  pendres_store_free(store);
}

/* A small map: what the library finds at a point, parts of it joined in their order. */
static void lyapunov_map(void **state)
{
  (void)state;
  static const char deck_text[] =
    "&scene kind = 'lyapunov_map' /\n&pendulum drive_frequency = 0.66 /\n"
    "&sweep drive_amplitude_range = 0.5, 1.5, 60, damping_range = 0.4, 0.6, 40 /\n"
    "&lyapunov_map x = 1.2, periods = 32, transient = 40 /\n&precision tolerance = 1e-5 /\n";
  size_t n = 0;
  (void)scene_run_marked(NULL, deck_text, 1, "one");
  (void)scene_run_marked(NULL, deck_text, 2, "two");
  scene_check_same_bytes("one", "two");
  pendres_store *store = scene_open("one");
  double *exponent = scene_values(store, "lyapunov", &n);
  double *label = scene_values(store, "label", &n), *period = scene_values(store, "period", &n);
  double *damping = scene_values(store, "damping", &n);
  double *drive = scene_values(store, "drive_amplitude", &n);
  assert_int_equal(n, 60);
  pendres_context *ctx = NULL;
  check_ok(pendres_context_create(&(pendres_options){.tolerance = 1e-5}, &ctx));
  for (size_t i = 0; i < 2400; i += 171) {
    const pendres_pendulum p = {.damping = damping[i / 60], .drive_amplitude = drive[i % 60],
                                .drive_frequency = 0.66};
    const double x = 1.2, v = 0.0;
    const pendres_lyapunov_options options = {.transient = 40, .periods = 32};
    pendres_settled l;
    check_ok(pendres_lyapunov_find(ctx, 1, &p, &x, &v, &options, &l));
    assert_int_equal(label[i], l.label);
    assert_true(exponent[i] == l.exponent);
    assert_true(l.period > 0 ? period[i] == l.period : isnan(period[i]));
  }
  pendres_context_free(ctx);
  pendres_store_free(store);
  free(exponent), free(label), free(period), free(damping), free(drive);
}

/* Torque, parametric amplitude and a polynomial force: keys and axes of maps and responses. */
static void other_forces(void **state)
{
  (void)state;
  size_t n = 0;
  scene_run_deck("&scene kind = 'lyapunov_map' /\n&pendulum drive_frequency = 0.8, damping = 0.3,\n"
                 "drive_amplitude = 0.01, force = 'polynomial', force_coefficients = 1, 0, 0.5 /\n"
                 "&sweep torque = 0, 0.1, 0.2, parametric_amplitude = 0, 0.05 /\n", 1, "map");
  pendres_store *store = scene_open("map");
  double *exponent = scene_values(store, "lyapunov", &n);
  double *torque = scene_values(store, "torque", &n);
  assert_true(n == 3 && torque[1] == 0.1);
  for (int i = 0; i < 6; i++) check_near(exponent[i], -0.15, 1e-7);
  pendres_store_free(store);
  free(exponent), free(torque);
  scene_run_deck("&scene kind = 'response' /\n&pendulum drive_amplitude = 0.001, torque = 0.1 /\n"
                 "&sweep damping = 0.2, drive_frequency = 0.5, 1.1 /\n&ensemble members = 3 /\n",
                 1, "response");
  store = scene_open("response");
  double *lag = scene_values(store, "phase_lag", &n);
  /* What is left out is quadratic in the amplitude. */
  check_near(lag[0], atan2(0.1, sqrt(0.99) - 0.25), 1e-4);
  check_near(lag[1], atan2(0.22, sqrt(0.99) - 1.21), 1e-4);
  pendres_store_free(store);
  free(lag);
}

/* Up a torque and down: a weak drive moves the pendulum about asin I. The works of the drives and
   of the torque together are what friction takes. */
static void torque_sweep(void **state)
{
  (void)state;
  static const char deck_text[] =
    "&scene kind = 'hysteresis' /\n&pendulum drive_amplitude = 0.001, damping = 1.5,\n"
    "drive_frequency = 0.8 /\n&sweep torque = 0, 0.3, 0.6 /\n&hysteresis x = 1.6 /\n";
  size_t n = 0;
  scene_run_deck(deck_text, 1, "sweep");
  pendres_store *store = scene_open("sweep");
  double *amplitude = scene_values(store, "amplitude", &n);
  double *velocity = scene_values(store, "mean_velocity", &n);
  assert_int_equal(n, 6);
  for (int i = 0; i < 6; i++) {
    const double torque = 0.3 * (i % 3), in = sqrt(1.0 - torque * torque) - 0.64, out = 1.2;
    /* What is left out is quadratic in the amplitude. */
    check_near(amplitude[i], 1e-3 / hypot(in, out), 1e-6);
    assert_true(velocity[i] == 0.0);
  }
  pendres_store_free(store);
  free(amplitude), free(velocity);
  scene_run_deck("&scene kind = 'orbit' /\n&pendulum drive_amplitude = 0.5, damping = 0.5,\n"
                 "drive_frequency = 1.0, torque = 0.8, parametric_amplitude = 0.3 /\n"
                 "&orbit x = 1.6, v = 2.5, periods = 1 /\n", 1, "orbit");
  store = scene_open("orbit");
  double *area = scene_values(store, "loop_area", &n),
    *lost = scene_values(store, "dissipation", &n);
  double *torque = scene_values(store, "torque_work", &n);
  double *drive = scene_values(store, "parametric_work", &n);
  double *winding = scene_values(store, "winding", &n), *period = scene_values(store, "period", &n);
  check_near(area[0] + torque[0] + drive[0], lost[0], 1e-7);
  check_near(torque[0], 0.8 * 2.0 * PENDRES_PI * winding[0] / period[0], 1e-12);
  assert_true(fabs(drive[0]) > 1e-3 && winding[0] != 0.0);
  pendres_store_free(store);
  free(area), free(lost), free(torque), free(drive), free(winding), free(period);
}

/* Up over the end of a junction's second step: what the file says of it is what its jump says. */
static void junction_steps(void **state)
{
  (void)state;
  size_t n = 0, jumps = 0;
  scene_run_deck("&scene kind = 'hysteresis' /\n&pendulum drive_amplitude = 9, damping = 0.3,\n"
                 "drive_frequency = 3 /\n&sweep torque_range = 1.88, 1.94, 4 /\n"
                 "&hysteresis x = 1.6 /\n", 1, "steps");
  pendres_store *store = scene_open("steps");
  double *end = scene_values(store, "jump_parameter", &jumps);
  double *error = scene_values(store, "jump_parameter_error", &jumps);
  double *upper = scene_values(store, "step_upper", &n);
  double *upper_error = scene_values(store, "step_upper_error", &n);
  double *velocity = scene_values(store, "step_mean_velocity", &n);
  double *width = scene_values(store, "step_width", &n);
  double *winding = scene_values(store, "jump_winding", &jumps);
  double *after = scene_values(store, "jump_mean_velocity", &jumps);
  assert_true(n >= 1 && jumps >= 2);
  /* A mean velocity of two turns a period; the lower end is that of the range. */
  check_near(velocity[0], 6.0, 1e-14);
  assert_true(upper[0] == end[0] && upper_error[0] == error[0] && isnan(width[0]));
  assert_true(isnan(winding[0]) && isnan(after[0])); /* it goes to a rotation without a lock */
  for (size_t i = 1; i < jumps; i++)
    if (winding[i] == 2.0) check_near(after[i], 6.0, 1e-14);
  pendres_store_free(store);
  free(end), free(error), free(upper), free(upper_error), free(velocity), free(width);
  free(winding), free(after);
}

/* Up to the fourth doubling: points come back after the period, and the ends are the cascade's. */
static void bifurcation_diagram(void **state)
{
  (void)state;
  static const char deck_text[] =
    "&scene kind = 'bifurcation_diagram' /\n&pendulum damping = 0.5, drive_period = 9.42477796 /\n"
    "&sweep drive_amplitude = 1.05, 1.07, 1.0822 /\n"
    "&bifurcation_diagram x = 1.6, strobes = 16 /\n&precision tolerance = 1e-9 /\n";
  static const int periods[3] = {1, 2, 8};
  size_t n = 0;
  scene_run_deck(deck_text, 1, "one");
  scene_run_deck(deck_text, 2, "two");
  scene_check_same_bytes("one", "two");
  pendres_store *store = scene_open("one");
  double *x = scene_values(store, "strobe_x", &n), *period = scene_values(store, "period", &n);
  double *error = scene_values(store, "strobe_x_error", &n);
  double *ends = scene_values(store, "bifurcation_parameter", &n);
  double *cascade = scene_values(store, "cascade_parameter", &n);
  assert_int_equal(n, 3);
  for (int i = 0; i < 3; i++) {
    assert_true(period[i] == periods[i]);
    check_near(ends[i], cascade[i], 1e-9);
    for (int k = 0; k + periods[i] < 16; k++)
      check_near(x[16 * i + k + periods[i]], x[16 * i + k], 2.0 * error[16 * i]);
  }
  pendres_store_free(store);
  free(x), free(period), free(error), free(ends), free(cascade);
}

/* What is not asked for is not in the file, and what is has the same bytes. */
static void only_what_is_asked(void **state)
{
#define DIAGRAM(more)                                                                            \
  "&scene kind = 'bifurcation_diagram' /\n&pendulum damping = 0.5, drive_period = 9.42477796 /\n" \
  "&sweep drive_amplitude = 1.05, 1.07, 1.0822 /\n"                                              \
  "&bifurcation_diagram x = 1.6, strobes = 16 " more "/\n&precision tolerance = 1e-9 /\n"
  static const struct {
    const char *name, *deck, *variable[3];
  } left_out[] = {
    {"no_count", DIAGRAM(", attractors = F"), {"attractors", "attractors", "attractors"}},
    {"no_ends", DIAGRAM(", bifurcations = F"),
     {"bifurcation_parameter", "cascade_parameter", "cascade_limit"}},
    {"no_exponents", DIAGRAM(", exponents = F"), {"lyapunov", "lyapunov_error", "lyapunov"}},
  };
  size_t n = 0, m = 0;
  (void)state;
  scene_run_deck(DIAGRAM(""), 1, "all");
  pendres_store *all = scene_open("all");
  double *whole = scene_values(all, "strobe_x", &n);
  for (size_t i = 0; i < sizeof left_out / sizeof *left_out; i++) {
    scene_run_deck(left_out[i].deck, 1, left_out[i].name);
    pendres_store *some = scene_open(left_out[i].name);
    double *x = scene_values(some, "strobe_x", &m);
    assert_int_equal(m, n);
    assert_memory_equal(x, whole, n * sizeof *x);
    for (int k = 0; k < 3; k++) {
      assert_true(pendres_store_has(all, "", left_out[i].variable[k]));
      assert_false(pendres_store_has(some, "", left_out[i].variable[k]));
    }
    free(x);
    pendres_store_free(some);
  }
  free(whole);
  pendres_store_free(all);
#undef DIAGRAM
}

/* One parameter is swept, no more and no less; a start is needed. */
static void wrong_decks(void **state)
{
  static const struct {
    const char *text, *message;
  } wrong[] = {
    {HYSTERESIS "&sweep drive_frequency = 0.7 /\n&hysteresis x = 1 /\n", "one parameter is swept"},
    {HYSTERESIS "&hysteresis x = 1 /\n", "needs 'drive_frequency' or 'drive_period'"},
    {HYSTERESIS "&sweep drive_frequency = 0.7, 0.8 /\n", "needs 'start'"},
    {HYSTERESIS "&sweep drive_frequency = 0.7, 0.8 /\n&hysteresis start = 'sa', x = 1 /\n",
     "'x' is not used"},
    {HYSTERESIS "&sweep drive_period = 7, 8 /\n&hysteresis x = 1 /\n", "give 'drive_frequency'"},
    {"&scene kind = 'lyapunov_map' /\n&pendulum damping = 0.1, drive_frequency = 1 /\n"
     "&sweep drive_amplitude = 0.7 /\n", "a map has two axes"},
    {"&scene kind = 'response' /\n&pendulum damping = 0.1, drive_frequency = 1 /\n"
     "&sweep drive_amplitude = 0.7, 0.8, torque = 0, 1, a1 = 1, 2 /\n", "has no coefficient 'a1'"},
    {"&scene kind = 'response' /\n&pendulum drive_amplitude = 1 /\n"
     "&sweep damping = 0.1, 0.2, drive_period = 7, 8, torque = 0, 1, temperature = 0.01 /\n",
     "with temperatures two, not 'torque', 'damping', 'drive_period'"},
    {"&scene kind = 'hysteresis' /\n&pendulum damping = 0.1 /\n"
     "&sweep drive_frequency = 0.7, 0.8 /\n&hysteresis x = 1 /\n", "needs 'drive_amplitude'"},
  };
  (void)state;
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    scene_check_refused(wrong[i].text, wrong[i].message);
}

/* n values of two files from some place on, which must be the same bytes. */
static void check_same_part(pendres_store *one, pendres_store *two, const char *name, size_t from,
                            size_t n)
{
  size_t a = 0, b = 0;
  double *x = scene_values(one, name, &a), *y = scene_values(two, name, &b);
  assert_true(a >= from + n);
  assert_int_equal(b, n);
  assert_memory_equal(x + from, y, n * sizeof *x);
  free(x);
  free(y);
}

/* A response over three parameters: the plane of each drive amplitude is what a deck with this one
   computes, resonances too. */
static void volume(void **state)
{
  static const char rest[] = "damping = 0.3, 0.4, drive_frequency_range = 0.7, 1.1, 3,\n"
                             "  resolution = 2 /\n&ensemble members = 8 /\n";
  static const struct {
    const char *name;
    size_t n; /* of a plane */
  } some[] = {{"mean_loop_area", 10}, {"phase_lag_error", 10}, {"la_fraction", 10}, {"failed", 10},
              {"resonance_period", 2}, {"resonance_frequency_error", 2},
              {"resonance_phase_lag", 2}, {"resonance_failed", 2}};
  char text[400];
  uint64_t sizes[PENDRES_STORE_RANK];
  int rank = 0;
  (void)state;
  snprintf(text, sizeof text, "&scene kind = 'response' /\n&sweep drive_amplitude = 0.1, 0.2,\n"
           "  %s", rest);
  scene_run_deck(text, 2, "volume");
  pendres_store *all = scene_open("volume");
  check_ok(pendres_store_shape(all, "", "mean_loop_area", &rank, sizes));
  assert_int_equal(rank, 3);
  assert_true(sizes[0] == 2 && sizes[1] == 2 && sizes[2] == 5);
  for (int i = 0; i < 2; i++) {
    snprintf(text, sizeof text, "&scene kind = 'response' /\n&pendulum drive_amplitude = 0.%d /\n"
             "&sweep %s", i + 1, rest);
    scene_run_deck(text, 1, "plane");
    pendres_store *plane = scene_open("plane");
    for (size_t k = 0; k < sizeof some / sizeof *some; k++)
      check_same_part(all, plane, some[k].name, (size_t)i * some[k].n, some[k].n);
    pendres_store_free(plane);
  }
  pendres_store_free(all);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(hysteresis),
    cmocka_unit_test(lyapunov_map),
    cmocka_unit_test(uncertain_starts),
    cmocka_unit_test(other_forces),
    cmocka_unit_test(torque_sweep),
    cmocka_unit_test(junction_steps),
    cmocka_unit_test(bifurcation_diagram),
    cmocka_unit_test(only_what_is_asked),
    cmocka_unit_test(volume),
    cmocka_unit_test(wrong_decks),
  };
  return cmocka_run_group_tests(tests, scene_enter, scene_leave);
}
