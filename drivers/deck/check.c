/*
 * check.c -- what concerns several keys of a deck at once: keys that are missing or exclude
 * each other, the axes as the union of lists and ranges, the size of it all.
 */
#include "deck/table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <pendres/sweep.h>

static namelist_place place_of(const deck_given *at, const char *name)
{
  return (namelist_place){ at->line, at->column, (int)strlen(name) };
}

static void complain(deck_builder *b, const deck_given *at, const char *name, const char *message)
{
  namelist_error_at(at->nl != NULL ? at->nl : b->nl, place_of(at, name), b->errors, "%s", message);
}

/* Complain of a group as a whole or, where the deck has none, of the kind that needs it. */
static void complain_of_group(deck_builder *b, const namelist_group *g, const char *message)
{
  if (g != NULL)
    namelist_error_at(b->nl, (namelist_place){ g->line, g->column, (int)strlen(g->name) + 1 },
                      b->errors, "%s", message);
  else
    namelist_error_at(b->kind_nl, (namelist_place){ b->kind_line, b->kind_column, 1 }, b->errors,
                      "%s", message);
}

/* The state of a key in this scene; never NULL, so that callers need not ask. */
static const deck_given *given(const deck_builder *b, const char *group, const char *name)
{
  static const deck_given absent = { 0 };
  int range = 0;
  const size_t row = deck_table_find(group, name, b->scene, &range);
  return row < deck_table_size ? &b->given[row] : &absent;
}

/* Whether a key is in the deck under its own name, with a good value or a bad one. */
static int is_there(const deck_given *g)
{
  return g->line > 0 && (g->given || g->broken);
}

static int in_scene(const deck_builder *b, const char *group, const char *name)
{
  int range = 0;
  return deck_table_find(group, name, b->scene, &range) < deck_table_size;
}

/* ---- missing keys -------------------------------------------------------------------------- */

/* Whether a key was given, with a good value or a bad one, or the key that may replace it: an axis
   in &sweep and its value in &pendulum replace each other. */
static int was_tried(const deck_builder *b, size_t row)
{
  const deck_key *key = &deck_table[row];
  const int value = strcmp(key->group, "pendulum") == 0;
  if (b->given[row].given || b->given[row].broken) return 1;
  if (!value && key->type != DECK_SWEEP) return 0;
  const deck_given *other = given(b, value ? "sweep" : "pendulum", key->name);
  return other->given || other->broken;
}

/* Report a group that is absent altogether by one message, which names all keys that are
   missing. */
static void report_missing_group(deck_builder *b, size_t row)
{
  const char *group = deck_table[row].group;
  char list[300] = "", message[500];
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    if (strcmp(key->group, group) != 0 || (key->needed & b->scene) == 0 || was_tried(b, i))
      continue;
    if (i < row) return; /* reported before */
    snprintf(list + strlen(list), sizeof list - strlen(list), "%s'%s'", list[0] == '\0' ? "" : ", ",
             key->name);
  }
  snprintf(message, sizeof message, "scene '%s' needs a group &%s with %s",
           deck_kind_name(b->d->kind), group, list);
  complain_of_group(b, NULL, message);
}

static void check_missing(deck_builder *b)
{
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    const namelist_group *group = b->given[i].group;
    if ((key->needed & b->scene) == 0 || was_tried(b, i)) continue;
    if (group == NULL) {
      report_missing_group(b, i);
    } else if (!group->broken) {
      char message[300];
      const int has_range = deck_table_has_range(key);
      snprintf(message, sizeof message,
               has_range ? "scene '%s' needs '%s' or '%s_range' in &%s"
                         : "scene '%s' needs '%s'%.0s in &%s",
               deck_kind_name(b->d->kind), key->name, key->name, key->group);
      complain_of_group(b, group, message);
    }
  }
}

/* ---- keys that exclude or need each other -------------------------------------------------- */

/* Exactly one of drive frequency and drive period, both in the same group. */
static void check_drive(deck_builder *b, const char *group)
{
  const deck_given *w = given(b, group, "drive_frequency"), *t = given(b, group, "drive_period");
  const deck_given *w2 = given(b, "pendulum", "drive_frequency");
  const deck_given *t2 = given(b, "pendulum", "drive_period");
  const deck_given *frequency = w->given || w->broken ? w : w2;
  const deck_given *period = t->given || t->broken ? t : t2;
  const namelist_group *place = w->group;
  const int have_frequency = frequency->given || frequency->broken;
  const int have_period = period->given || period->broken;
  if (is_there(frequency) && is_there(period)) {
    const deck_given *later = frequency->line > period->line ||
                              (frequency->line == period->line &&
                               frequency->column > period->column)
                                  ? frequency : period;
    complain(b, later, later == period ? "drive_period" : "drive_frequency",
             "give either 'drive_frequency' or 'drive_period', not both");
  } else if (!have_frequency && !have_period && (place == NULL || !place->broken)) {
    char message[200];
    snprintf(message, sizeof message, "scene '%s' needs 'drive_frequency' or 'drive_period' in &%s",
             deck_kind_name(b->d->kind), group);
    complain_of_group(b, place, message);
  }
}

static void resolve_drive(deck_builder *b)
{
  deck *d = b->d;
  if (in_scene(b, "sweep", "drive_period")) {
    check_drive(b, "sweep");
    return;
  }
  if (!in_scene(b, "pendulum", "drive_period")) return;
  check_drive(b, "pendulum");
  d->pendulum.by_period = given(b, "pendulum", "drive_period")->given;
  const double turn = 2.0 * PENDRES_PI;
  if (d->pendulum.by_period) d->pendulum.drive_frequency = turn / d->pendulum.drive_period;
  else d->pendulum.drive_period = turn / d->pendulum.drive_frequency;
}

/* An axis has its values in &sweep, or its only value in &pendulum. */
static void check_axis_sources(deck_builder *b)
{
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    if (strcmp(key->group, "pendulum") != 0 || (key->scenes & b->scene) == 0) continue;
    const deck_given *sweep = given(b, "sweep", key->name);
    if (!is_there(&b->given[i]) || !is_there(sweep)) continue;
    namelist_error_at(b->given[i].nl, place_of(&b->given[i], key->name),
                      b->errors, "'%s' is given in &sweep too (line %d): leave out one of the two",
                      key->name, sweep->line);
  }
}

/* Check keys that have an effect only together with others. */
static void check_idle_keys(deck_builder *b)
{
  static const char *const why[] = {
    [DECK_WITH_NOISE] = "it concerns noise, and there is no 'temperature' above 0",
    [DECK_WITH_RAMP] = "it concerns ramps, and there is no 'rate' or 'protocol'",
    [DECK_WITHOUT_START] = "'start' names an attractor",
    [DECK_OFF_LINE] = "the starts are on a line, see 'shape'",
    [DECK_IN_RECTANGLE] = "'shape' is not 'rectangle'",
    [DECK_AT_RANDOM] = "'shape' is not 'random'",
    [DECK_WITH_SEARCH] = "no resonance is looked for: that takes lines along the drive's "
                         "frequency or period",
  };
  const char *group = b->scene == 1u << DECK_HYSTERESIS            ? "hysteresis"
                      : b->scene == 1u << DECK_BIFURCATION_DIAGRAM ? "bifurcation_diagram"
                                                                   : "orbit";
  const deck_given *start = given(b, group, "start");
  const deck_given *x = given(b, group, "x");
  for (size_t i = 0; i < deck_table_size; i++) {
    const deck_key *key = &deck_table[i];
    if (!b->given[i].given || key->when == DECK_BY_FREQUENCY || key->when == DECK_BY_PERIOD ||
        key->when == DECK_UNLESS_AXIS)
      continue;
    if (key->when == DECK_WITH_NOISE && given(b, "sweep", "temperature")->broken) continue;
    if (key->when == DECK_WITHOUT_START && start->broken) continue;
    if (deck_key_applies(key, b->d)) continue;
    namelist_error_at(b->given[i].nl, place_of(&b->given[i], key->name),
                      b->errors, "'%s' is not used: %s", key->name, why[key->when]);
  }
  if (in_scene(b, group, "start") && b->d->orbit.start[0] == '\0' && !start->broken &&
      !x->given && !x->broken && (x->group == NULL || !x->group->broken)) {
    char message[200];
    snprintf(message, sizeof message,
             "scene '%s' needs 'start' ('sa', 'la' or a number) or 'x' (and 'v') in &%s",
             deck_kind_name(b->d->kind), group);
    complain_of_group(b, x->group, message);
  }
}

/* ---- axes ---------------------------------------------------------------------------------- */

/* Values of a range whose steps are divided. */
static size_t count_of(const deck *d, const deck_axis *axis)
{
  const size_t n = axis->range_count;
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

static void expand_axes(deck_builder *b)
{
  for (int i = 0; i < DECK_AXIS_COUNT; i++) {
    deck_axis *axis = &b->d->axis[i];
    if (axis->listed_count + axis->range_count == 0) continue;
    if (count_of(b->d, axis) > DECK_MAX_COUNT) {
      complain(b, given(b, "sweep", "resolution"), "resolution",
               "'resolution' makes more than 1000000 values of a range: give a smaller number");
      return;
    }
    if (!expand_axis(b->d, axis)) b->out_of_memory = 1;
  }
}

/* Check that the scene has as many axes with several values as it needs. */
static void check_moving(deck_builder *b)
{
  static const struct {
    deck_kind kind;
    int axes;
    const char *message;
  } wanted[] = {
    { DECK_HYSTERESIS, 1, "one parameter is swept: give two or more values of damping, "
                          "drive_amplitude, drive_frequency, torque or parametric_amplitude, and "
                          "one of each of the others" },
    { DECK_BIFURCATION_DIAGRAM, 1, "one parameter moves: give two or more values of damping, "
                                   "drive_amplitude, drive_frequency, torque or "
                                   "parametric_amplitude, and one of each of the others" },
    { DECK_LYAPUNOV_MAP, 2, "a map has two axes: give two or more values of two of damping, "
                            "drive_amplitude, drive_frequency, torque and parametric_amplitude, "
                            "and one of each of the others" },
  };
  for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++)
    if (b->scene == 1u << wanted[i].kind && deck_moving(b->d, 0, NULL) != wanted[i].axes)
      complain_of_group(b, NULL, wanted[i].message);
  if ((b->scene & (1u << DECK_HYSTERESIS | 1u << DECK_BIFURCATION_DIAGRAM)) != 0 &&
      b->d->axis[DECK_AXIS_DRIVE_PERIOD].count > 1)
    complain(b, given(b, "sweep", "drive_period"), "drive_period",
             "what is swept is the drive's frequency: give 'drive_frequency'");
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
  deck_axis_id axis = DECK_AXIS_COUNT;
  if (b->scene != 1u << DECK_HYSTERESIS || deck_moving(d, 1, &axis) != 1) return;
  const deck_given *rate = given(b, "hysteresis", "rate");
  const deck_given *protocol = given(b, "hysteresis", "protocol");
  const deck_given *temperature = given(b, "pendulum", "temperature");
  if (!temperature->given) temperature = given(b, "sweep", "temperature");
  const deck_axis *a = &d->axis[axis], *t = &d->axis[DECK_AXIS_TEMPERATURE];
  const char *why = protocol->given ? refuse_protocol(&d->ramp.protocol, a) : NULL;
  if (rate->given && protocol->given)
    complain(b, protocol, "protocol", "give either 'rate' or 'protocol', not both");
  else if (why != NULL)
    namelist_error_at(protocol->nl, place_of(protocol, "protocol"), b->errors, "'protocol' %s",
                      why);
  if (rate->given && (a->value[a->count - 1] - a->value[0]) / d->ramp.rate > 1e9)
    complain(b, rate, "rate",
             "at so small a 'rate' the sweep takes more than 1e9 drive periods: give a larger one");
  if (t->count > 1) complain(b, temperature, "temperature", "a ramp has one 'temperature'");
  else if (t->count == 1 && t->value[0] > 0.0 && !deck_has_ramp(d))
    complain(b, temperature, "temperature",
             "noise concerns ramps: 'temperature' goes with 'rate' or 'protocol' in &hysteresis");
}

/* ---- sizes and the rest -------------------------------------------------------------------- */

static void check_size(deck_builder *b)
{
  const deck *d = b->d;
  const int with_members = in_scene(b, "ensemble", "members");
  double points = with_members ? (double)d->ensemble.members : 1.0;
  for (int i = 0; i < DECK_AXIS_COUNT; i++)
    if (d->axis[i].count > 0) points *= (double)d->axis[i].count;
  if (points > 0x1p32 && !d->basins.refine)
    namelist_error_at(b->kind_nl, (namelist_place){ b->kind_line, b->kind_column, 1 }, b->errors,
                      "the axes%s multiply to %.4g pendulums; at most 2^32 are possible%s",
                      with_members ? " and members" : "", points,
                      b->scene == 1u << DECK_BASINS ? " without refine = .true." : "");
  if (in_scene(b, "orbit", "samples") && (double)d->orbit.periods * (double)d->orbit.samples > 1e8)
    complain(b, given(b, "orbit", "periods"), "periods",
             "'periods' times 'samples' must not exceed 1e8: give fewer of one of them");
  if (d->switching.from == 0 && d->switching.to != 0)
    complain(b, given(b, "switching", "to"), "to",
             "'to' needs 'from', the number of the attractor that is left");
  else if (d->switching.from != 0 && d->switching.from == d->switching.to)
    complain(b, given(b, "switching", "to"), "to",
             "'from' and 'to' are the same attractor: give two different numbers");
  if (d->basins.boundary && (d->axis[DECK_AXIS_X].count == 1 || d->axis[DECK_AXIS_V].count == 1))
    complain(b, given(b, "basins", "boundary"), "boundary",
             "'boundary' is looked for in a window: give x and v at least two values");
}

/* Segments of a spectrum have an even number of samples, 4 or more. */
static void check_spectrum(deck_builder *b)
{
  const deck *d = b->d;
  const int64_t least = deck_spectrum_least(d);
  const char *name = d->orbit.periods < least ? "periods" : "segment";
  const deck_given *at = given(b, "orbit", name);
  char message[160];
  if (!in_scene(b, "orbit", "spectrum") || !d->orbit.spectrum) return;
  if (d->orbit.periods >= least && (d->orbit.segment == 0 || d->orbit.segment >= least)) return;
  snprintf(message, sizeof message,
           "a spectrum takes 4 samples or more, an even number: with samples = %lld give '%s' of "
           "%lld or more", (long long)d->orbit.samples, name, (long long)least);
  if (is_there(at)) complain(b, at, name, message);
  else complain(b, given(b, "orbit", "spectrum"), "spectrum", message);
}

static void check_ensemble(deck_builder *b)
{
  const deck *d = b->d;
  const deck_given *shape = given(b, "ensemble", "shape");
  if (!in_scene(b, "ensemble", "members") || shape->broken) return;
  if (!(d->ensemble.x_first < d->ensemble.x_last)) {
    const deck_given *last = given(b, "ensemble", "x_last");
    complain(b, last->given ? last : given(b, "ensemble", "x_first"), "x_last",
             "'x_first' must be below 'x_last'");
  }
  if (strcmp(d->ensemble.shape, "line") == 0) return;
  const deck_given *v_last = given(b, "ensemble", "v_last");
  if (!v_last->broken && !(d->ensemble.v < d->ensemble.v_last))
    complain(b, v_last->given ? v_last : shape, "v_last",
             "a rectangle of starts goes from 'v' up to 'v_last', which must be above it");
  const deck_given *rows = given(b, "ensemble", "rows");
  if (strcmp(d->ensemble.shape, "rectangle") == 0 && !rows->broken &&
      (d->ensemble.rows < 1 || d->ensemble.members % d->ensemble.rows != 0))
    complain(b, rows->given ? rows : shape, "rows",
             "'members' must make whole 'rows' of a rectangle");
}

/* Check that only one of drive amplitude, torque and parametric amplitude is an axis; 0: more
   are. */
static int one_extra(deck_builder *b, deck_axis_id extra)
{
  static const deck_axis_id extras[] = { DECK_AXIS_DRIVE_AMPLITUDE, DECK_AXIS_TORQUE,
                                         DECK_AXIS_PARAMETRIC_AMPLITUDE };
  char message[160];
  for (size_t i = 0; i < sizeof extras / sizeof *extras; i++) {
    if (extras[i] == extra || b->d->axis[extras[i]].count == 0) continue;
    const char *other = deck_axis_name(extras[i]);
    snprintf(message, sizeof message,
             "results have %s: give '%s' or '%s' in &sweep, and the other in &pendulum",
             b->d->kind == DECK_RESONANCE_CURVE ? "one axis" : "two axes", deck_axis_name(extra),
             other);
    complain(b, given(b, "sweep", other), other, message);
    return 0;
  }
  return 1;
}

/* A resonance curve has one axis. */
static void check_curve(deck_builder *b)
{
  char message[120];
  deck_axis_id extra = DECK_AXIS_DRIVE_AMPLITUDE;
  if (b->d->kind != DECK_RESONANCE_CURVE || !deck_extra_axis(b->d, &extra)) return;
  if (!one_extra(b, extra) || b->d->axis[DECK_AXIS_DAMPING].count < 2) return;
  const char *name = deck_axis_name(extra);
  snprintf(message, sizeof message, "results have one axis: beside '%s' give 'damping' one value",
           name);
  complain(b, given(b, "sweep", name), name, message);
}

/* Results have two axes: where drive amplitude, torque or parametric amplitude is one, another has
   one value; but for a response without noise, which has three then. */
static void check_plane(deck_builder *b)
{
  const deck *d = b->d;
  deck_axis_id extra = DECK_AXIS_DRIVE_AMPLITUDE;
  char message[160];
  const deck_axis *frequency = &d->axis[DECK_AXIS_DRIVE_FREQUENCY];
  const deck_axis *period = &d->axis[DECK_AXIS_DRIVE_PERIOD];
  if (d->kind != DECK_RESPONSE && d->kind != DECK_PHASE_DIAGRAM && d->kind != DECK_BRANCHES) return;
  if (!deck_extra_axis(d, &extra) || !one_extra(b, extra)) return;
  const char *name = deck_axis_name(extra);
  if (d->axis[DECK_AXIS_DAMPING].count < 2 || (frequency->count < 2 && period->count < 2)) return;
  if (d->kind == DECK_RESPONSE && d->axis[DECK_AXIS_TEMPERATURE].count == 0) return;
  snprintf(message, sizeof message,
           "results have two axes: beside '%s' give either 'damping' or the "
           "drive one value", name);
  complain(b, given(b, "sweep", name), name, message);
}

/* Coefficients need a force that takes them, and a polynomial needs coefficients. */
static void check_force(deck_builder *b)
{
  const deck *d = b->d;
  int any = 0;
  for (int i = 0; i < PENDRES_FORCE_COEFFICIENTS; i++)
    any |= d->pendulum.force_coefficients[i] != 0.0;
  if (strcmp(d->pendulum.force, "pendulum") == 0 && any)
    complain(b, given(b, "pendulum", "force_coefficients"), "force_coefficients",
             "a pendulum's force has no 'force_coefficients': give 'force' as well");
  if (strcmp(d->pendulum.force, "polynomial") == 0 && !any)
    complain(b, given(b, "pendulum", "force"), "force",
             "a polynomial needs 'force_coefficients', one of them not zero");
}

/* Where noise carries a pendulum to infinity there are rates of escape, but no steady clouds and
   responses. Where there are neither wells nor escape, a state is left only for another state. */
static void check_noise(deck_builder *b)
{
  const deck *d = b->d;
  pendres_pendulum p = deck_pendulum(d);
  if (isnan(p.parametric_amplitude)) p.parametric_amplitude = 0.0; /* an axis */
  const int leaves = pendres_pendulum_leaves(&p);
  const deck_given *temperature = given(b, "sweep", "temperature");
  if (!is_there(temperature)) temperature = given(b, "pendulum", "temperature");
  if ((b->scene & (1u << DECK_RESPONSE | 1u << DECK_BASINS)) != 0 && leaves && deck_has_noise(d))
    complain(b, temperature, "temperature",
             "under this force noise carries a pendulum to infinity in the end: there is no steady "
             "state with noise; scene 'switching' tells how soon");
  if (b->scene == 1u << DECK_SWITCHING && d->switching.from > 0 && d->switching.to == 0 &&
      !leaves && !(pendres_model_of(p.force)->period > 0.0))
    complain(b, given(b, "switching", "from"), "from",
             "this force has no wells that are alike: 'from' needs 'to'");
}

static void check_output(deck_builder *b)
{
  const char *output = b->d->output;
  const deck_given *at = given(b, "scene", "output");
  if (!at->given) return;
  if (output[0] == '\0') complain(b, at, "output", "'output' must not be empty");
  else if (output[strlen(output) - 1] == '/')
    complain(b, at, "output", "'output' must be a file, not a folder");
  else if (strcmp(output, b->nl->name) == 0)
    complain(b, at, "output", "'output' would overwrite the deck");
}

void deck_check(deck_builder *b)
{
  deck *d = b->d;
  if (b->scene == 0) return;
  check_missing(b);
  check_axis_sources(b);
  resolve_drive(b);
  expand_axes(b);
  d->search_given = in_scene(b, "sweep", "resonance_range") &&
                    given(b, "sweep", "resonance_range")->given;
  check_idle_keys(b);
  if (b->errors->count == 0) check_moving(b);
  if (b->errors->count == 0) check_ramp(b);
  check_size(b);
  check_plane(b);
  check_curve(b);
  if (b->errors->count == 0) check_force(b);
  if (b->errors->count == 0) check_noise(b);
  check_output(b);
  deck_check_units(b);
  check_ensemble(b);
  check_spectrum(b);
  if (d->precision.block_lanes % 8 != 0)
    complain(b, given(b, "precision", "block_lanes"), "block_lanes",
             "'block_lanes' must be a multiple of 8");
}
