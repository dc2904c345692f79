/*
 * test_units_ensembles.c -- responses, resonances, phase lines, basins and noise of the same
 * oscillator in other units: every number is the same, bit for bit (units_fixture.h).
 */
#include "units_fixture.h"

#include "analysis/phase_diagram/line.h"

static void note_response(notes *to, const pendres_response *r)
{
  NOTE(r->mean_loop_area, 2, -2);
  NOTE(r->mean_loop_area_error, 2, -2);
  NOTE(r->mean_loop_amplitude, 1, 0);
  NOTE(r->mean_loop_amplitude_error, 1, 0);
  NOTE(r->mean_amplitude, 1, 0);
  NOTE(r->mean_amplitude_error, 1, 0);
  NOTE(r->phase_lag, 0, 0);
  NOTE(r->mean_power, 2, -3);
  NOTE(r->mean_power_error, 2, -3);
  NOTE(r->sa_fraction, 0, 0);
  for (size_t i = 0; i < r->states; i++) note_attractor(to, &r->state[i]);
}

static void ask_ensemble(const problem *q)
{
  const double rate = factor(q->u, 0, -1), energy = factor(q->u, 2, -2);
  pendres_response r;
  pendres_response_noise noise;
  pendres_resonance resonance;
  pendres_phase_point point[3];
  pendres_pendulum line[3];
  notes *to = q->to;
  const pendres_ensemble e = {.members = 12, .x_first = -1.0 * q->u.length,
                              .x_last = 1.5 * q->u.length, .v = 0.25 * q->u.length / q->u.time};
  check_ok(pendres_response_find(q->ctx, 1, &q->p, &e, &r));
  note_response(to, &r);
  check_ok(pendres_response_noise_find(q->ctx, &r, 1e-4 * energy, 12, 4, &noise));
  NOTE(noise.temperature, 2, -2);
  NOTE(noise.loop_area.value, 2, -2);
  NOTE(noise.loop_area.bias_error, 2, -2);
  NOTE(noise.amplitude.value, 1, 0);
  NOTE(noise.phase_lag.value, 0, 0);
  NOTE(noise.mean_power.error, 2, -3);
  check_ok(pendres_resonance_find_ensemble(q->ctx, &q->p, 1.2 * rate, 2.2 * rate, &e, &resonance));
  NOTE(resonance.frequency, 0, -1);
  NOTE(resonance.frequency_error, 0, -1);
  NOTE(resonance.loop_area, 2, -2);
  NOTE(resonance.loop_area_error, 2, -2);
  NOTE(resonance.fold_frequency, 0, -1);
  note_response(to, &resonance.response);
  for (int i = 0; i < 3; i++) {
    line[i] = q->p;
    line[i].drive_frequency = (1.2 + 0.2 * i) * rate;
  }
  const pendres_phase_options options = {.ensemble = e, .parameter = PENDRES_DRIVE_FREQUENCY};
  check_ok(pendres_phase_line(q->ctx, 3, line, &options, point, NULL));
  for (int i = 0; i < 3; i++) {
    NOTE(point[i].regime, 0, 0);
    NOTE(point[i].exact, 0, 0);
    NOTE(point[i].mean_loop_area, 2, -2);
    NOTE(point[i].sa_amplitude, 1, 0);
    NOTE(point[i].la_amplitude_error, 1, 0);
    NOTE(point[i].mean_loop_amplitude, 1, 0);
  }
}

static void ask_basin(const problem *q)
{
  enum { SIDE = 24 };
  double x[SIDE], v[SIDE];
  static pendres_basin_state state[SIDE * SIDE];
  pendres_attractors *set = NULL;
  notes *to = q->to;
  for (int i = 0; i < SIDE; i++) {
    x[i] = (0.125 * i - 1.5) * q->u.length;
    v[i] = (0.125 * i - 1.5) * q->u.length / q->u.time;
  }
  const pendres_basin_grid grid = {.nx = SIDE, .nv = SIDE, .x = x, .v = v};
  check_ok(pendres_basin_attractors(q->ctx, &q->p, &grid, &set));
  check_ok(pendres_basin_find(q->ctx, set, &grid, state));
  for (int i = 0; i < SIDE * SIDE; i++) {
    NOTE(state[i].attractor, 0, 0);
    NOTE(state[i].settling_periods, 0, 0);
    NOTE(state[i].how, 0, 0);
  }
  pendres_attractors_free(set);
}

/* A callback that notes what it is shown. */
static pendres_langevin_answer watch(void *arg, const pendres_langevin_strobe *s)
{
  notes *to = arg;
  for (size_t i = 0; i < s->count; i++) {
    NOTE(s->first, 0, 0);
    NOTE(s->x[i], 1, 0);
    NOTE(s->v[i], 1, -1);
    NOTE(s->cosine[i], 1, 0);
    NOTE(s->sine[i], 1, 0);
    NOTE(s->work[i], 2, -2);
  }
  return PENDRES_LANGEVIN_GO_ON;
}

static void ask_noise(const problem *q)
{
  const double energy = factor(q->u, 2, -2);
  double x[2] = {0.1 * q->u.length, 0.2 * q->u.length}, v[2] = {0.0, 0.0};
  pendres_pendulum p[2] = {q->p, q->p};
  pendres_attractors *set = NULL;
  pendres_langevin_linear linear;
  pendres_cloud cloud;
  pendres_switching_rates rates[2];
  pendres_switching_activation activation[PENDRES_SWITCHING_WAYS];
  notes *to = q->to;
  p[0].temperature = p[1].temperature = 0.001 * energy;
  const pendres_langevin_observer observer = {watch, to, 1};
  const pendres_langevin_run run = {.n = 2, .pendulums = p, .periods = 3, .observer = &observer};
  check_ok(pendres_langevin_advance(q->ctx, &run, x, v));
  note_arrays(to, 2, x, v);
  check_ok(pendres_attractors_find(q->ctx, &q->p, 0, NULL, NULL, &set));
  const pendres_orbit *o = &pendres_attractors_get(set, 0)->orbit;
  p[0].temperature = 1e-5 * energy;
  check_ok(pendres_langevin_linear_find(&p[0], o->x, o->v, o->period, &linear));
  NOTE(linear.covariance.xx, 2, 0);
  NOTE(linear.covariance.xv, 2, -1);
  NOTE(linear.covariance.vv, 2, -2);
  NOTE(linear.monodromy[1], 0, 1);
  NOTE(linear.monodromy[2], 0, -1);
  pendres_escapes *ways = NULL;
  if (pendres_escapes_find(q->ctx, set, 0, &ways) == PENDRES_OK) {
    const pendres_escape *w = pendres_escapes_get(ways, 0);
    const size_t m = w->points / 2;
    NOTE(w->saddle_x, 1, 0);
    NOTE(w->saddle.x, 1, 0);
    NOTE(w->action, 2, -2);
    NOTE(w->action_error, 2, -2);
    NOTE(w->phase[m], 0, 0);
    NOTE(w->x[m], 1, 0);
    NOTE(w->v[m], 1, -1);
    NOTE(w->momentum_x[m], 1, -2);
    NOTE(w->momentum_v[m], 1, -1);
    NOTE(w->noise[m], 1, -2);
  }
  pendres_escapes_free(ways);
  const pendres_cloud_request request = {.set = set, .temperature = 1e-5 * energy,
                                         .trajectories = 16, .record = 4};
  check_ok(pendres_cloud_find(q->ctx, &request, &cloud, NULL, NULL));
  NOTE(cloud.measured.statistics[PENDRES_LANGEVIN_MEAN_X].value, 1, 0);
  NOTE(cloud.measured.statistics[PENDRES_LANGEVIN_COV_XV].value, 2, -1);
  NOTE(cloud.measured.statistics[PENDRES_LANGEVIN_COV_VV].error, 2, -2);
  NOTE(cloud.measured.statistics[PENDRES_LANGEVIN_LOOP_AREA].value, 2, -2);
  NOTE(cloud.bias.statistics[PENDRES_LANGEVIN_COV_XX].value, 2, 0);
  NOTE(cloud.bias.steps_per_period, 0, 0);
  NOTE(cloud.escape_exposure, 0, 1);
  NOTE(cloud.escape_rate.upper, 0, -1);
  NOTE(cloud.verdict, 0, 0);
  const pendres_switching_survey survey = {.set = set, .state = {0, 1}, .trajectories = 16,
                                           .periods = 100, .steps_per_period = 24};
  const double warm[2] = {0.02 * energy, 0.03 * energy};
  if (pendres_attractors_count(set) > 1) {
    check_ok(pendres_switching_find(q->ctx, &survey, 2, warm, rates, activation));
    for (int i = 0; i < 2; i++)
      for (int w = 0; w < PENDRES_SWITCHING_WAYS; w++) {
        NOTE(rates[i].way[w].value, 0, -1);
        NOTE(rates[i].way[w].error, 0, -1);
        NOTE(rates[i].way[w].mean_time, 0, 1);
        NOTE(rates[i].way[w].exposure, 0, 1);
      }
    NOTE(activation[0].energy, 2, -2);
    NOTE(activation[0].verdict, 0, 0);
  }
  pendres_attractors_free(set);
}

static void ask_ensembles(const problem *q)
{
  ask_ensemble(q);
  ask_basin(q);
  ask_noise(q);
}

static void every_question(void **state)
{
  (void)state;
  in_all_units("ensembles", &duffing, 1e-9, ask_ensembles);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_question)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
