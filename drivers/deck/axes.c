/*
 * axes.c -- which parameters a deck varies, and what it holds fixed: all from the list of
 * <pendres/parameter.h>.
 */
#include "deck/table.h"

#include <math.h>
#include <string.h>

static const pendres_parameter parameters[] = {
#define AXIS_PARAMETER(code, ...) PENDRES_##code,
  PENDRES_PARAMETER_LIST(AXIS_PARAMETER)
#undef AXIS_PARAMETER
};

pendres_parameter deck_axis_parameter(deck_axis_id axis)
{
  return (unsigned)axis < DECK_AXIS_AMPLITUDE ? parameters[axis] : PENDRES_PARAMETER_COUNT;
}

const char *deck_axis_name(deck_axis_id axis)
{
  if (axis == DECK_AXIS_AMPLITUDE) return "amplitude";
  if (axis == DECK_AXIS_TOLERANCE) return "tolerance";
  const pendres_parameter_info *info = pendres_parameter_of(deck_axis_parameter(axis));
  return info != NULL ? info->name : NULL;
}

pendres_kind deck_axis_kind(deck_axis_id axis)
{
  const pendres_parameter_info *info = pendres_parameter_of(deck_axis_parameter(axis));
  if (info != NULL) return info->kind;
  return axis == DECK_AXIS_AMPLITUDE ? PENDRES_KIND_POSITION : PENDRES_KIND_NUMBER;
}

int deck_is_clock(deck_axis_id axis)
{
  return axis == DECK_AXIS_DRIVE_FREQUENCY || axis == DECK_AXIS_DRIVE_PERIOD;
}

/* ---- the axes of results ------------------------------------------------------------------- */

static deck_axis_id clock_of(const deck *d)
{
  return d->axis[DECK_AXIS_DRIVE_PERIOD].count > 0 ? DECK_AXIS_DRIVE_PERIOD
                                                   : DECK_AXIS_DRIVE_FREQUENCY;
}

/* The parameters that have several values; damping is the slowest. */
static int find_moving(const deck *d, deck_axis_id *axis)
{
  int n = 0;
  if (d->axis[DECK_AXIS_DAMPING].count > 1) axis[n++] = DECK_AXIS_DAMPING;
  for (int i = 0; i < DECK_AXIS_TEMPERATURE; i++)
    if (i != DECK_AXIS_DAMPING && d->axis[i].count > 1) axis[n++] = (deck_axis_id)i;
  return n;
}

/* A map over one parameter: damping, or the drive's amplitude, is an axis with its one value. */
static int add_single(const deck *d, deck_axis_id *axis)
{
  const int of_damping = axis[0] == DECK_AXIS_DAMPING;
  const deck_axis_id other = of_damping ? DECK_AXIS_DRIVE_AMPLITUDE : DECK_AXIS_DAMPING;
  if (d->axis[other].count != 1) return 1;
  axis[1] = axis[0];
  axis[of_damping] = other;
  return 2;
}

/*
 * The parameters in &sweep other than damping and the drive's frequency or period (the clock),
 * then damping, then the clock. Where the clock has a single value, the last of the other
 * parameters varies fastest in its place. There are at least two axes; where nothing else is
 * given these are damping and the clock. A resonance is searched for over the clock, so that one
 * axis is enough there.
 */
static int find_plane(const deck *d, deck_axis_id *axis)
{
  const deck_axis_id clock = clock_of(d);
  const int curve = deck_kind_of(d->kind)->layout == DECK_RESONANCES;
  int n = 0;
  for (int i = 0; i < DECK_AXIS_TEMPERATURE; i++)
    if (i != DECK_AXIS_DAMPING && !deck_is_clock((deck_axis_id)i) && d->axis[i].count > 0)
      axis[n++] = (deck_axis_id)i;
  const deck_axis_id last = n == 0 || d->axis[clock].count > 1 ? clock : axis[n - 1];
  if (!curve && n > 0 && last != clock) n--;
  if (n == 0 || d->axis[DECK_AXIS_DAMPING].count > 1) axis[n++] = DECK_AXIS_DAMPING;
  if (!curve) axis[n++] = last;
  return n;
}

int deck_axes(const deck *d, deck_axis_id axis[DECK_AXES])
{
  const deck_layout layout = deck_kind_of(d->kind)->layout;
  deck_axis_id all[DECK_AXIS_COUNT];
  int n = 0;
  if (layout == DECK_MOVING) n = find_moving(d, all);
  if (layout == DECK_MOVING && n == 1 && deck_kind_of(d->kind)->least > 1) n = add_single(d, all);
  if (layout != DECK_MOVING && layout != DECK_NO_AXES) n = find_plane(d, all);
  for (int i = 0; i < n && i < DECK_AXES; i++) axis[i] = all[i];
  return n;
}

int deck_has_axis(const deck *d, deck_axis_id axis)
{
  deck_axis_id axes[DECK_AXES];
  const int n = deck_axes(d, axes);
  for (int i = 0; i < n && i < DECK_AXES; i++)
    if (axes[i] == axis) return 1;
  return 0;
}

int deck_searches(const deck *d)
{
  deck_axis_id axis[DECK_AXES];
  const int n = deck_axes(d, axis);
  int range = 0;
  if (deck_kind_of(d->kind)->layout == DECK_RESONANCES) return 1;
  const size_t key = deck_table_find("sweep", "resonance_range", 1u << d->kind, &range);
  if (key == deck_table_size) return 0;
  return (deck_is_plain(d) || d->search_given) && (n > DECK_AXES || deck_is_clock(axis[n - 1]));
}

/* ---- pendulums ----------------------------------------------------------------------------- */

pendres_pendulum deck_pendulum(const deck *d)
{
  pendres_pendulum p = d->pendulum;
  for (int i = 0; i < DECK_AXIS_TEMPERATURE; i++)
    if (d->axis[i].count > 0) pendres_parameter_set(parameters[i], d->axis[i].value[0], &p);
  return p;
}

double deck_axis_largest(const deck_axis *a)
{
  double most = 0.0;
  for (size_t k = 0; k < a->count; k++)
    if (fabs(a->value[k]) > fabs(most)) most = a->value[k];
  return most;
}

/* With the largest value of each axis. */
static pendres_pendulum largest(const deck *d)
{
  pendres_pendulum p = d->pendulum;
  for (int i = 0; i < DECK_AXIS_TEMPERATURE; i++)
    if (d->axis[i].count > 0)
      pendres_parameter_set(parameters[i], deck_axis_largest(&d->axis[i]), &p);
  return p;
}

pendres_units deck_pendulum_units(const deck *d)
{
  const pendres_pendulum p = largest(d);
  return pendres_units_of(&p);
}

pendres_ensemble deck_starts(const deck *d)
{
  pendres_pendulum p = largest(d);
  const deck_axis *damping = &d->axis[DECK_AXIS_DAMPING];
  if (damping->count > 0) p.damping = damping->value[0];
  return pendres_ensemble_of(&p);
}

int deck_may_rest(const deck *d)
{
  const deck_axis *a = &d->axis[DECK_AXIS_DRIVE_AMPLITUDE];
  for (size_t k = 0; k < a->count; k++)
    if (a->value[k] == 0.0) return 1;
  return a->count == 0 && d->pendulum.drive_amplitude == 0.0;
}

int deck_is_plain(const deck *d)
{
  if (d->pendulum.force != PENDRES_FORCE_PENDULUM) return 0;
  for (int i = 0; i < DECK_AXIS_TEMPERATURE; i++) {
    if (pendres_parameter_of(parameters[i])->plain) continue;
    if (pendres_parameter_get(parameters[i], &d->pendulum) != 0.0) return 0;
    for (size_t k = 0; k < d->axis[i].count; k++)
      if (d->axis[i].value[k] != 0.0) return 0;
  }
  return 1;
}

int deck_has_noise(const deck *d)
{
  const deck_axis *t = &d->axis[DECK_AXIS_TEMPERATURE];
  return t->count > 0 && t->value[t->count - 1] > 0.0;
}

int deck_has_ramp(const deck *d)
{
  return d->ramp.rate > 0.0 || d->ramp.protocol.count > 0;
}

void deck_derive_clock(deck *d)
{
  const double turn = 2.0 * PENDRES_PI;
  if (d->by_period) d->pendulum.drive_frequency = turn / d->drive_period;
  else d->drive_period = turn / d->pendulum.drive_frequency;
}
