/*
 * check_axes.c -- the axes of a deck: their values as the union of lists and ranges, how many
 * parameters a scene varies and which of them, and the force's coefficients, which may be axes.
 */
#include "deck/table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pendres/sweep.h>

/* ---- values -------------------------------------------------------------------------------- */

/* How many values a range has when each of its steps is divided. */
static size_t count_of(const deck *d, const deck_axis *axis)
{
  const size_t n = axis->range_count;
  if (axis == &d->axis[DECK_AXIS_OUTER]) return n;
  return n > 1 ? (n - 1) * (size_t)d->resolution + 1 : n;
}

static int expand_axis(const deck *d, deck_axis *axis)
{
  const pendres_range range = { axis->range_first, axis->range_last, count_of(d, axis) };
  axis->value = malloc((axis->listed_count + range.count) * sizeof *axis->value);
  if (axis->value == NULL) return 0;
  /* The keys were checked one by one, so that this cannot fail. */
  return pendres_sweep_values(axis->listed_count, axis->listed, NULL, axis->listed,
                              &axis->listed_count) == PENDRES_OK &&
         pendres_sweep_values(axis->listed_count, axis->listed, &range, axis->value,
                              &axis->count) == PENDRES_OK;
}

void deck_expand_axis(deck_builder *b, deck_axis_id id)
{
  deck_axis *axis = &b->d->axis[id];
  if (axis->listed_count + axis->range_count == 0) return;
  if (!expand_axis(b->d, axis)) b->out_of_memory = 1;
}

void deck_expand_axes(deck_builder *b)
{
  for (int i = 0; i < DECK_AXIS_OUTER; i++) {
    deck_axis *axis = &b->d->axis[i];
    if (count_of(b->d, axis) > DECK_MAX_COUNT) {
      deck_complain(b, deck_given_of(b, "sweep", "resolution"), "resolution",
               "'resolution' makes more than 1000000 values of a range: give a smaller number");
      return;
    }
    deck_expand_axis(b, (deck_axis_id)i);
  }
}

static void complain_of_axes(deck_builder *b, const char *words, int n, const deck_axis_id *axis)
{
  static const char advice[] = "give several values of what is an axis in &sweep, and one value of "
                               "each of the others in &pendulum; &outer takes several values of "
                               "one more";
  char message[400], list[4 * DECK_NAME] = "none";
  const char *first = n > 0 ? deck_axis_name(axis[0]) : "";
  const deck_given *at = deck_given_of(b, "sweep", first);
  for (int i = 0, used = 0; i < n && i < DECK_AXES; i++)
    used += snprintf(list + used, sizeof list - (size_t)used, "%s'%s'", i > 0 ? ", " : "",
                     deck_axis_name(axis[i]));
  snprintf(message, sizeof message, "%s, not %s: %s", words, list, advice);
  if (deck_is_there(at)) deck_complain(b, at, first, "%s", message);
  else deck_complain_of_group(b, NULL, message);
}

/* The name of the parameter in which orbits are followed in place of this one, which has no
   derivatives. */
static const char *followed_instead(pendres_parameter parameter)
{
  pendres_pendulum p = { .damping = 0.0 };
  int k = 0;
  pendres_parameter_set(parameter, 1.0, &p);
  while (k + 1 < PENDRES_PARAMETER_FOLLOWED &&
         pendres_parameter_get((pendres_parameter)k, &p) == 0.0)
    k++;
  return pendres_parameter_of((pendres_parameter)k)->name;
}

/* Check that the results have as many axes as the scene takes, and that orbits are followed in
   these where it does so. */
static void check_axes(deck_builder *b)
{
  const deck *d = b->d;
  deck_axis_id axis[DECK_AXES];
  const deck_kind_info *of = deck_kind_of(d->kind);
  const int n = deck_axes(d, axis);
  const int temperatures = of->steady && d->axis[DECK_AXIS_TEMPERATURE].count > 0;
  if (of->layout == DECK_NO_AXES) return;
  if (n < of->least || n + temperatures > of->most) {
    complain_of_axes(b, of->takes, n, axis);
    return;
  }
  for (int k = 0; k < n && of->followed; k++) {
    const pendres_parameter parameter = deck_axis_parameter(axis[k]);
    const char *name = deck_axis_name(axis[k]);
    if ((int)parameter >= PENDRES_PARAMETER_FOLLOWED)
      deck_complain(b, deck_given_of(b, "sweep", name), name,
                    "orbits are not followed in '%s': give '%s'", name,
                    followed_instead(parameter));
  }
}

/* Check that a protocol's values go along the axis. */
static const char *refuse_protocol(const deck_numbers *p, const deck_axis *axis)
{
  if (p->count < 4 || p->count % 2 != 0) return "takes pairs of a time and a value, two or more";
  if (p->number[0] != 0.0) return "starts at time 0";
  if (p->number[1] != axis->value[0] || p->number[p->count - 1] != axis->value[axis->count - 1])
    return "goes from the first value of the sweep to its last";
  for (size_t i = 0; i < p->count; i += 2) {
    if (p->number[i] != rint(p->number[i])) return "has times of whole drive periods";
    if (i > 0 && !(p->number[i] > p->number[i - 2])) return "has times that ascend";
    if (i > 0 && p->number[i + 1] < p->number[i - 1])
      return "has values that ascend: the way down is the same backwards";
  }
  return NULL;
}

static void check_ramp(deck_builder *b)
{
  const deck *d = b->d;
  deck_axis_id axis[DECK_AXES];
  if (!deck_in_scene(b, "hysteresis", "rate") || deck_axes(d, axis) != 1) return;
  const deck_given *rate = deck_given_of(b, "hysteresis", "rate");
  const deck_given *protocol = deck_given_of(b, "hysteresis", "protocol");
  const deck_given *temperature = deck_given_of(b, "pendulum", "temperature");
  if (!temperature->given) temperature = deck_given_of(b, "sweep", "temperature");
  const deck_axis *a = &d->axis[axis[0]], *t = &d->axis[DECK_AXIS_TEMPERATURE];
  const char *why = protocol->given ? refuse_protocol(&d->ramp.protocol, a) : NULL;
  if (rate->given && protocol->given)
    deck_complain(b, protocol, "protocol", "give either 'rate' or 'protocol', not both");
  else if (why != NULL)
    deck_complain(b, protocol, "protocol", "'protocol' %s", why);
  if (rate->given && (a->value[a->count - 1] - a->value[0]) / d->ramp.rate > 1e9)
    deck_complain(b, rate, "rate",
                  "at so small a 'rate' the sweep takes more than 1e9 drive periods: give a larger "
                  "one");
  if (t->count > 1) deck_complain(b, temperature, "temperature", "a ramp has one 'temperature'");
  else if (t->count == 1 && t->value[0] > 0.0 && !deck_has_ramp(d))
    deck_complain(b, temperature, "temperature",
             "noise concerns ramps: 'temperature' goes with 'rate' or 'protocol' in &hysteresis");
}

/* ---- forces -------------------------------------------------------------------------------- */

/* Check a coefficient that is an axis: the force has it, and it is given once. One that is set
   outside of the deck takes the place of the deck's. */
static void check_coefficient(deck_builder *b, deck_axis_id axis)
{
  const char *name = deck_axis_name(axis);
  const int k = pendres_parameter_of(deck_axis_parameter(axis))->coefficient;
  const pendres_model *model = pendres_model_of(b->d->pendulum.force);
  const deck_given *at = deck_given_of(b, "sweep", name);
  double *fixed = &b->d->pendulum.force_coefficients[k - 1];
  if (k > model->coefficients)
    deck_complain(b, at, name, "force '%s' has no coefficient '%s'", model->name, name);
  else if (*fixed != 0.0 && at->nl == b->nl)
    deck_complain(b, at, name, "'%s' is given in 'force_coefficients' too: give 0 there", name);
  *fixed = 0.0;
}

/* Coefficients need a force that takes them, and a polynomial needs coefficients, of which not all
   may be zero at some point. */
static void check_force(deck_builder *b)
{
  const deck *d = b->d;
  int any = 0, fixed = 0;
  for (int i = 0; i < DECK_AXIS_TEMPERATURE; i++) {
    const deck_axis *a = &d->axis[i];
    if (pendres_parameter_of(deck_axis_parameter((deck_axis_id)i))->coefficient == 0) continue;
    if (a->count == 0) continue;
    check_coefficient(b, (deck_axis_id)i);
    int zero = 0;
    for (size_t k = 0; k < a->count; k++) zero |= a->value[k] == 0.0;
    any |= !zero;
  }
  for (int i = 0; i < PENDRES_FORCE_POWERS; i++)
    fixed |= d->pendulum.force_coefficients[i] != 0.0;
  /* A fit may find them. */
  for (size_t i = 0; i < d->fit.free.count; i++)
    any |= d->fit.free.name[i][0] == 'a' && d->fit.free.name[i][2] == '\0';
  if (d->pendulum.force == PENDRES_FORCE_PENDULUM && fixed)
    deck_complain(b, deck_given_of(b, "pendulum", "force_coefficients"), "force_coefficients",
                  "a pendulum's force has no 'force_coefficients': give 'force' as well");
  if (d->pendulum.force == PENDRES_FORCE_POLYNOMIAL && !any && !fixed)
    deck_complain(b, deck_given_of(b, "pendulum", "force"), "force",
                  "a polynomial needs 'force_coefficients', one of them not zero");
}

/* From pi on a pendulum is upright, or goes round. */
static void check_amplitude(deck_builder *b)
{
  const deck_axis *a = &b->d->axis[DECK_AXIS_AMPLITUDE];
  if (a->count == 0 || !deck_is_plain(b->d) || a->value[a->count - 1] < PENDRES_PI) return;
  const char *name = a->range_count > 0 && a->range_last >= PENDRES_PI ? "amplitude_range"
                                                                       : "amplitude";
  deck_complain(b, deck_given_of(b, "sweep", name), name,
                "'%s' of a pendulum must lie between 0 and pi (both excluded)", name);
}

int deck_leaves(const deck *d)
{
  const pendres_pendulum first = deck_pendulum(d);
  int leaves = pendres_pendulum_leaves(&first);
  for (int i = 0; i < DECK_AXIS_TEMPERATURE; i++)
    for (size_t k = 0; k < d->axis[i].count && !leaves; k++) {
      pendres_pendulum p = first;
      pendres_parameter_set(deck_axis_parameter((deck_axis_id)i), d->axis[i].value[k], &p);
      leaves = pendres_pendulum_leaves(&p);
    }
  return leaves;
}

/* Where noise carries a pendulum to infinity there are rates of escape, but no steady clouds and
   responses. Where there are neither wells nor escape, a state is left only for another state. */
static void check_noise(deck_builder *b)
{
  const deck *d = b->d;
  const int leaves = deck_leaves(d);
  const deck_given *temperature = deck_given_of(b, "sweep", "temperature");
  if (!deck_is_there(temperature)) temperature = deck_given_of(b, "pendulum", "temperature");
  if (deck_kind_of(d->kind)->steady && leaves && deck_has_noise(d))
    deck_complain(b, temperature, "temperature",
             "under this force noise carries a pendulum to infinity in the end: there is no steady "
             "state with noise; scene 'switching' tells how soon");
  if (d->switching.from > 0 && d->switching.to == 0 && !leaves &&
      !(pendres_model_of(d->pendulum.force)->period > 0.0))
    deck_complain(b, deck_given_of(b, "switching", "from"), "from",
                  "this force has no wells that are alike: 'from' needs 'to'");
}

void deck_check_axes(deck_builder *b)
{
  static void (*const checks[])(deck_builder *b) = { check_axes, check_ramp, check_force,
                                                     check_amplitude, check_noise };
  for (size_t i = 0; i < sizeof checks / sizeof *checks && b->errors->count == 0; i++) checks[i](b);
}
