/* scene_along.c -- what scenes share in which parameters move; see scene_along.h. */
#include "scenes/scene_along.h"

#include <stdlib.h>
#include <string.h>

static const double two_pi = 6.28318530717958647693;

/* The axes that stand for parameters. */
static const deck_axis_id parameters[] = { DECK_AXIS_DAMPING, DECK_AXIS_DRIVE_AMPLITUDE,
                                           DECK_AXIS_DRIVE_FREQUENCY, DECK_AXIS_DRIVE_PERIOD };
enum { PARAMETERS = sizeof parameters / sizeof *parameters };

void scene_along_set(pendres_pendulum *p, deck_axis_id axis, double value)
{
  switch (axis) {
  case DECK_AXIS_DAMPING: p->damping = value; break;
  case DECK_AXIS_DRIVE_AMPLITUDE: p->drive_amplitude = value; break;
  case DECK_AXIS_DRIVE_FREQUENCY: p->drive_frequency = value; break;
  case DECK_AXIS_DRIVE_PERIOD: p->drive_frequency = two_pi / value; break;
  default: break;
  }
}

pendres_pendulum scene_along_pendulum(const deck *d)
{
  pendres_pendulum p = { .damping = 0.0 };
  for (int i = 0; i < PARAMETERS; i++)
    if (d->axis[parameters[i]].count > 0)
      scene_along_set(&p, parameters[i], d->axis[parameters[i]].value[0]);
  return p;
}

pendres_parameter scene_along_parameter(deck_axis_id axis)
{
  switch (axis) {
  case DECK_AXIS_DAMPING: return PENDRES_DAMPING;
  case DECK_AXIS_DRIVE_AMPLITUDE: return PENDRES_DRIVE_AMPLITUDE;
  default: return PENDRES_DRIVE_FREQUENCY;
  }
}

/* "sa, la": what there is instead. */
static void list_labels(const pendres_attractors *set, char *text, size_t size)
{
  text[0] = '\0';
  for (size_t i = 0; i < pendres_attractors_count(set); i++)
    snprintf(text + strlen(text), size - strlen(text), "%s%s", i > 0 ? ", " : "",
             pendres_label_name(pendres_attractors_get(set, i)->label));
}

pendres_status scene_along_named(pendres_context *ctx, const pendres_pendulum *p, const char *start,
                                 pendres_attractor *out, char *why, size_t size)
{
  pendres_attractors *set = NULL;
  pendres_status status = pendres_attractors_find(ctx, p, 0, NULL, NULL, &set);
  if (status != PENDRES_OK) return status;
  status = PENDRES_NOT_FOUND;
  const long number = strtol(start, NULL, 10); /* 0: a name */
  for (size_t i = 0; i < pendres_attractors_count(set) && status != PENDRES_OK; i++) {
    const pendres_attractor *a = pendres_attractors_get(set, i);
    if (number > 0 ? (long)i + 1 != number : strcmp(pendres_label_name(a->label), start) != 0)
      continue;
    *out = *a;
    status = PENDRES_OK;
  }
  if (status != PENDRES_OK) {
    char list[100];
    list_labels(set, list, sizeof list);
    snprintf(why, size, "there is no attractor '%s' at these parameters; found: %s", start,
             list[0] != '\0' ? list : "none");
  }
  pendres_attractors_free(set);
  return status;
}
