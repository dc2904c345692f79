/*
 * pendres.c -- the numbers of compare.auto by libpendres.
 *
 *   cc pendres.c $(pkg-config --cflags --libs pendres) -lm -o pendres && ./pendres
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

/* The attractor of the largest amplitude, or of the smallest. */
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

static void print_multipliers(const pendres_orbit *o)
{
  printf("  multipliers %.6g%+.6gi %.6g%+.6gi\n", o->multiplier_re[0], o->multiplier_im[0],
         o->multiplier_re[1], o->multiplier_im[1]);
}

/* Follow the branch of an orbit, and that of the pair born where its symmetry breaks. */
static void symmetry_breaking(const char *where, const pendres_orbit *start,
                              const pendres_branch_options *options)
{
  pendres_branch *b = NULL, *pair = NULL;
  fail_if(pendres_branch_follow(ctx, 1, start, options, &b));
  for (size_t i = 0; i < pendres_branch_bifurcations(b); i++) {
    const pendres_bifurcation *f = pendres_branch_bifurcation(b, i);
    pendres_orbit born;
    if (f->kind != PENDRES_SYMMETRY_BREAKING) continue;
    printf("symmetry breaking, %-18s %.12f +- %.0e\n", where, f->value, f->value_error);
    fail_if(pendres_branch_switch(ctx, f, &born));
    fail_if(pendres_branch_follow(ctx, 1, &born, options, &pair));
    for (size_t k = 0; k < pendres_branch_bifurcations(pair); k++) {
      const pendres_bifurcation *d = pendres_branch_bifurcation(pair, k);
      if (d->kind != PENDRES_PERIOD_DOUBLING) continue;
      printf("period doubling, %-20s %.12f +- %.0e\n", where, d->value, d->value_error);
      print_multipliers(&d->orbit);
    }
    pendres_branch_free(pair);
    break;
  }
  pendres_branch_free(b);
}

int main(void)
{
  if (pendres_context_create(&(pendres_options){.tolerance = 1e-10}, &ctx)) return 1;
  const pendres_branch_options frequency = {.low = 0.42, .high = 1.0};
  const pendres_branch_options drive = {
    .parameter = PENDRES_DRIVE_AMPLITUDE, .low = 0.8, .high = 1.2};
  const pendres_curve_options both = {
    .second = PENDRES_DAMPING, .low = {0.6, 0.05}, .high = {1.0, 0.5}};
  pendres_orbit start = orbit(0.13, 0.2, 0.8, 0), there[4];
  pendres_branch *b = NULL;
  pendres_curve *c = NULL;
  pendres_fold fold;
  size_t found = 0;

  fail_if(pendres_branch_follow(ctx, 1, &start, &frequency, &b));
  for (size_t i = 0; i < pendres_branch_bifurcations(b); i++)
    printf("fold at damping 0.13                  %.12f +- %.0e\n",
           pendres_branch_bifurcation(b, i)->value, pendres_branch_bifurcation(b, i)->value_error);
  fail_if(pendres_branch_cross(ctx, b, 0.8, 4, there, &found));
  for (size_t i = 0; i < found && i < 4; i++) {
    printf("orbit at frequency 0.8                amplitude %.10f\n", there[i].amplitude);
    print_multipliers(&there[i]);
  }
  fail_if(pendres_fold_find(ctx, &start, &fold));
  fail_if(pendres_curve_follow(ctx, 1, &fold, &both, &c));
  printf("cusp                                  damping %.12f frequency %.12f\n",
         pendres_curve_cusp(c, 0)->value[1], pendres_curve_cusp(c, 0)->value[0]);
  /* The dampings that AUTO stopped at, exactly. */
  static const double dampings[] = {0.1400000019, 0.1500000011, 0.1599999888, 0.1600000003,
                                    0.1499971257, 0.1399988730, 0.1295510089, 0.0999734524,
                                    0.0599919596};
  for (size_t i = 0; i < sizeof dampings / sizeof *dampings; i++) {
    pendres_bifurcation at[4];
    fail_if(pendres_curve_cross(ctx, c, dampings[i], 4, at, &found));
    for (size_t k = 0; k < found && k < 4; k++)
      printf("fold at damping %.10f          %.12f +- %.0e\n", dampings[i], at[k].value,
             at[k].value_error);
  }
  start = orbit(0.12, 0.2, 0.78, 1);
  symmetry_breaking("damping 0.12", &start, &frequency);
  start = orbit(0.5, 0.9, 2.0 / 3.0, 0);
  symmetry_breaking("Baker and Gollub", &start, &drive);
  pendres_curve_free(c);
  pendres_branch_free(b);
  pendres_context_free(ctx);
  return 0;
}
