/*
 * references.c -- whose equation a deck's is: a row a model of the literature, as in
 * docs/models.md. The first row that fits is the one.
 */
#include "scenes/scene.h"

#include <string.h>

/* What a model has, of the terms of the equation. */
enum {
  TORQUE = 1,
  PARAMETRIC = 2,
  NEGATIVE = 4, /* a1 < 0 */
  A1 = 8        /* a_k is A1 << (k - 1) */
};
#define A(k) (A1 << ((k) - 1))

/* Terms that a model has, and those that it has not. */
static const struct {
  pendres_force force;
  int has, not_has;
  const char *reference;
} models[] = {
  { PENDRES_FORCE_PENDULUM, TORQUE, 0,
    "W. C. Stewart, Applied Physics Letters 12 (1968) 277; D. E. McCumber, Journal of Applied "
    "Physics 39 (1968) 3113" },
  { PENDRES_FORCE_PENDULUM, PARAMETRIC, 0,
    "P. L. Kapitza, Zhurnal Eksperimentalnoi i Teoreticheskoi Fiziki 21 (1951) 588" },
  { PENDRES_FORCE_SQUID, 0, 0,
    "K. K. Likharev, Dynamics of Josephson Junctions and Circuits (1986), chapter 6" },
  { PENDRES_FORCE_POLYNOMIAL, A(1) | A(3) | NEGATIVE, A(2) | A(4) | A(5) | PARAMETRIC,
    "P. Holmes, Philosophical Transactions of the Royal Society A 292 (1979) 419" },
  { PENDRES_FORCE_POLYNOMIAL, A(1) | A(3), A(2) | A(4) | A(5) | PARAMETRIC,
    "G. Duffing, Erzwungene Schwingungen bei ver\303\244nderlicher Eigenfrequenz (1918)" },
  { PENDRES_FORCE_POLYNOMIAL, A(3), A(1) | A(2) | A(4) | A(5) | PARAMETRIC,
    "Y. Ueda, Journal of Statistical Physics 20 (1979) 181" },
  { PENDRES_FORCE_POLYNOMIAL, A(1) | A(2), A(3) | A(4) | A(5) | PARAMETRIC,
    "J. M. T. Thompson, Proceedings of the Royal Society A 421 (1989) 195" },
  { PENDRES_FORCE_POLYNOMIAL, A(1) | PARAMETRIC, A(2) | A(3) | A(4) | A(5),
    "E. Mathieu, Journal de Math\303\251matiques Pures et Appliqu\303\251es 13 (1868) 137" },
  { PENDRES_FORCE_POLYNOMIAL, 0, 0,
    "A. H. Nayfeh and D. T. Mook, Nonlinear Oscillations (1979)" },
};

static int has(const deck *d, deck_axis_id axis, pendres_parameter parameter)
{
  return d->axis[axis].count > 0 || pendres_parameter_get(parameter, &d->pendulum) != 0.0;
}

static int terms_of(const deck *d)
{
  int terms = has(d, DECK_AXIS_TORQUE, PENDRES_TORQUE) ? TORQUE : 0;
  if (has(d, DECK_AXIS_PARAMETRIC_AMPLITUDE, PENDRES_PARAMETRIC_AMPLITUDE)) terms |= PARAMETRIC;
  for (int k = 0; k < PENDRES_FORCE_POWERS; k++)
    if (has(d, (deck_axis_id)(DECK_AXIS_A1 + k), (pendres_parameter)(PENDRES_A1 + k)))
      terms |= A(k + 1);
  if (deck_pendulum(d).force_coefficients[0] < 0.0) terms |= NEGATIVE;
  return terms;
}

/* That of the plain pendulum is told with the figures. */
static const char *equation_of(const deck *d)
{
  const int terms = terms_of(d);
  for (size_t i = 0; i < sizeof models / sizeof *models; i++)
    if (models[i].force == d->pendulum.force && (terms & models[i].has) == models[i].has &&
        (terms & models[i].not_has) == 0)
      return models[i].reference;
  return "";
}

const char *scene_references(const deck *d, char text[SCENE_REFERENCES])
{
  const scene_kind *scene = scene_find(d->kind);
  const char *methods = scene->references != NULL ? scene->references : "";
  const char *paper = scene->figures == NULL || !deck_is_plain(d) ? NULL : scene->figures;
  const char *equation = equation_of(d);
  if (paper == NULL && equation[0] == '\0') methods += methods[0] != '\0' ? 2 : 0;
  (void)snprintf(text, SCENE_REFERENCES, "%s%s%s%s",
                 paper != NULL ? "D. Kharkongor and M. C. Mahato, Resonance oscillation of a "
                                 "damped driven simple pendulum, " : "",
                 paper != NULL ? paper : "", paper == NULL ? equation : "", methods);
  return text;
}
