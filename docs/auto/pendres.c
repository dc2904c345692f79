/*
 * pendres.c -- the numbers of compare.auto by libpendres: name, value, error.
 *
 *   cc pendres.c $(pkg-config --cflags --libs pendres) -o pendres && ./pendres >pendres.txt
 */
#include <stdio.h>
#include <stdlib.h>

#include <pendres/pendres.h>

static pendres_context *ctx;

static void fail_if(pendres_status status)
{
  if (status == PENDRES_OK) return;
  fprintf(stderr, "%s\n", pendres_context_message(ctx));
  exit(1);
}

static void print(const char *name, double value, double error)
{
  printf("%-28s %.14g %.1e\n", name, value, error);
}

/* A name that ends in a number. */
static void print_at(const char *name, double at, const char *end, double value, double error)
{
  char whole[64];
  snprintf(whole, sizeof whole, "%s%g%s", name, at, end);
  print(whole, value, error);
}

static void print_multipliers(const char *name, const pendres_orbit *o)
{
  char whole[64];
  snprintf(whole, sizeof whole, "%s_re", name);
  print(whole, o->multiplier_re[0], o->multiplier_error);
  snprintf(whole, sizeof whole, "%s_im", name);
  if (o->multiplier_im[0] != 0.0) print(whole, o->multiplier_im[0], o->multiplier_error);
}

/* The attractor of the smallest or of the largest amplitude. */
static pendres_orbit orbit(double damping, double drive, double frequency, int largest)
{
  const pendres_pendulum p = {
    .damping = damping, .drive_amplitude = drive, .drive_frequency = frequency};
  pendres_attractors *found = NULL;
  fail_if(pendres_attractors_find(ctx, &p, 0, NULL, NULL, &found));
  const pendres_orbit o =
    pendres_attractors_get(found, largest ? pendres_attractors_count(found) - 1 : 0)->orbit;
  pendres_attractors_free(found);
  return o;
}

static pendres_branches *branch_of(const pendres_orbit *start, pendres_parameter parameter,
                                   double low, double high)
{
  const pendres_branch_options options = {.parameter = parameter, .low = low, .high = high};
  pendres_branches *b = NULL;
  fail_if(pendres_branches_find(ctx, 1, start, &options, &b));
  return b;
}

static const pendres_bifurcation *first_of(const pendres_branch *b, pendres_special kind)
{
  for (size_t i = 0; i < pendres_branch_bifurcation_count(b); i++)
    if (pendres_branch_bifurcation_get(b, i)->kind == kind)
      return pendres_branch_bifurcation_get(b, i);
  fprintf(stderr, "a bifurcation is missing\n");
  exit(1);
}

/* The branch of a small orbit turns back twice. */
static void s_shape(double damping)
{
  static const char *const folds[] = {"fold_sa_", "fold_la_"};
  static const char *const orbits[] = {"orbit_sa", "orbit_saddle", "orbit_la"};
  static const char *const areas[] = {"orbit_sa_area", "orbit_saddle_area", "orbit_la_area"};
  const pendres_orbit start = orbit(damping, 0.2, 0.75, 0);
  pendres_branches *set_b = branch_of(&start, PENDRES_DRIVE_FREQUENCY, 0.6, 0.9);
  const pendres_branch *b = pendres_branches_get(set_b, 0);
  for (size_t i = 0; i < 2 && i < pendres_branch_bifurcation_count(b); i++) {
    const pendres_bifurcation *f = pendres_branch_bifurcation_get(b, i);
    print_at(folds[i], damping, "", f->value, f->value_error);
    print_at(folds[i], damping, "_area", f->orbit.loop_area, f->orbit.loop_area_error);
  }
  if (damping == 0.13) {
    pendres_orbit there[3];
    size_t found = 0;
    fail_if(pendres_branch_cross(ctx, b, 0.8, 3, there, &found));
    for (size_t i = 0; i < found && i < 3; i++) {
      print(areas[i], there[i].loop_area, there[i].loop_area_error);
      print_multipliers(orbits[i], &there[i]);
    }
  }
  pendres_branches_free(set_b);
}

static void fold_and_cusp(double drive, double frequency)
{
  const pendres_orbit start = orbit(0.06, drive, frequency, 0);
  pendres_fold fold;
  pendres_cusp cusp;
  fail_if(pendres_fold_find(ctx, &start, PENDRES_DRIVE_FREQUENCY, &fold));
  fail_if(pendres_cusp_find(ctx, &fold, PENDRES_DAMPING, &cusp));
  print_at("fold_sa_0.06_drive_", drive, "", fold.value, fold.value_error);
  print_at("cusp_damping_drive_", drive, "", cusp.value[1], cusp.value_error[1]);
  print_at("cusp_frequency_drive_", drive, "", cusp.value[0], cusp.value_error[0]);
}

/* The pair of orbits born where symmetry breaks; it doubles its period. */
static void doubling(const char *name, const pendres_bifurcation *at, double low, double high)
{
  char area[64];
  pendres_orbit born;
  fail_if(pendres_branch_switch(ctx, at, &born));
  pendres_branches *set_b = branch_of(&born, at->parameter, low, high);
  const pendres_branch *b = pendres_branches_get(set_b, 0);
  const pendres_bifurcation *d = first_of(b, PENDRES_PERIOD_DOUBLING);
  print(name, d->value, d->value_error);
  snprintf(area, sizeof area, "%s_area", name);
  print(area, d->orbit.loop_area, d->orbit.loop_area_error);
  print_multipliers(name, &d->orbit);
  pendres_branches_free(set_b);
}

/* Folds along the frequency of an oscillator with a polynomial force, from the orbit at `low` on.
   */
static void polynomial(const char *name, pendres_pendulum p, double low, double high)
{
  char whole[64];
  p.force = PENDRES_FORCE_POLYNOMIAL;
  p.drive_frequency = low;
  pendres_orbit_guess g = {.pendulum = p, .period = 1};
  pendres_orbit o;
  pendres_status outcome = PENDRES_OK;
  fail_if(pendres_strobe_advance(ctx, 1, &p, &g.x, &g.v, 300, NULL));
  fail_if(pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, &o, &outcome));
  pendres_branches *set_b = branch_of(&o, PENDRES_DRIVE_FREQUENCY, 0.9 * low, high);
  const pendres_branch *b = pendres_branches_get(set_b, 0);
  for (size_t i = 0; i < pendres_branch_bifurcation_count(b); i++) {
    const pendres_bifurcation *f = pendres_branch_bifurcation_get(b, i);
    if (f->kind != PENDRES_FOLD) continue;
    snprintf(whole, sizeof whole, "%s_fold_%zu", name, i + 1);
    print(whole, f->value, f->value_error);
    snprintf(whole, sizeof whole, "%s_fold_%zu_area", name, i + 1);
    print(whole, f->orbit.loop_area, f->orbit.loop_area_error);
  }
  pendres_branches_free(set_b);
}

int main(void)
{
  static const double s[] = {0.13, 0.14, 0.15}, breaking[] = {0.06, 0.1, 0.12};
  if (pendres_context_create(&(pendres_options){.tolerance = 1e-10}, &ctx)) return 1;
  for (size_t i = 0; i < 3; i++) s_shape(s[i]);
  fold_and_cusp(0.2, 0.75);
  fold_and_cusp(0.1, 0.85);
  for (size_t i = 0; i < 3; i++) {
    const pendres_orbit la = orbit(breaking[i], 0.2, 0.78, 1);
    pendres_branches *set_b = branch_of(&la, PENDRES_DRIVE_FREQUENCY, 0.4, 0.8);
  const pendres_branch *b = pendres_branches_get(set_b, 0);
    const pendres_bifurcation *at = first_of(b, PENDRES_SYMMETRY_BREAKING);
    print_at("symmetry_", breaking[i], "", at->value, at->value_error);
    if (breaking[i] == 0.12) doubling("doubling_0.12", at, 0.4, 0.8);
    pendres_branches_free(set_b);
  }
  const pendres_orbit start = orbit(0.5, 0.9, 2.0 / 3.0, 0);
  pendres_branches *set_b = branch_of(&start, PENDRES_DRIVE_AMPLITUDE, 0.8, 1.2);
  const pendres_branch *b = pendres_branches_get(set_b, 0);
  const pendres_bifurcation *at = first_of(b, PENDRES_SYMMETRY_BREAKING);
  print("baker_gollub_symmetry", at->value, at->value_error);
  doubling("baker_gollub_doubling", at, 0.8, 1.2);
  pendres_branches_free(set_b);
  const pendres_pendulum duffing = {.drive_amplitude = 0.3, .force_coefficients = {1.0, 0.0, 1.0}};
  const pendres_pendulum helmholtz = {.damping = 0.1, .force_coefficients = {1.0, -1.0}};
  static const double damping[] = {0.1, 0.2}, drive[] = {0.06, 0.07};
  for (int i = 0; i < 2; i++) {
    char name[32];
    pendres_pendulum p = duffing;
    p.damping = damping[i];
    snprintf(name, sizeof name, "duffing_%g", damping[i]);
    polynomial(name, p, 1.0, i == 0 ? 2.0 : 1.6);
    p = helmholtz;
    p.drive_amplitude = drive[i];
    snprintf(name, sizeof name, "helmholtz_%g", drive[i]);
    polynomial(name, p, 0.7, 1.1);
  }
  pendres_context_free(ctx);
  return 0;
}
