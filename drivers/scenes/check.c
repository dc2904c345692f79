/* check.c -- whether records can be what a task has written; see check.h. */
#include "scenes/check.h"

#include <string.h>

enum { MOST_STEPS = 100 * DECK_MAX_COUNT }; /* a drive period */

int scene_check_code(int code, int count)
{
  return code >= 0 && code < count;
}

int scene_check_text(const char *text, size_t room)
{
  return memchr(text, '\0', room) != NULL;
}

int scene_check_attractor(const pendres_attractor *a)
{
  const pendres_orbit *o = &a->orbit;
  return scene_check_code((int)a->label, PENDRES_LABEL_COUNT) &&
         scene_check_code((int)o->pendulum.force, PENDRES_FORCE_COUNT) &&
         scene_check_code(o->period, DECK_MAX_COUNT + 1) && scene_check_code(o->symmetric, 2) &&
         scene_check_code(o->stable, 2) && scene_check_code(o->steps, MOST_STEPS);
}

int scene_check_response(const pendres_response *r)
{
  int good = r->states <= PENDRES_RESPONSE_STATES &&
             scene_check_code((int)r->pendulum.force, PENDRES_FORCE_COUNT);
  for (size_t i = 0; good && i < r->states; i++) good = scene_check_attractor(&r->state[i]);
  return good;
}

int scene_check_basin_state(const pendres_basin_state *state, size_t attractors)
{
  const int number = state->attractor;
  return (number == PENDRES_ATTRACTOR_UNKNOWN || number == PENDRES_ATTRACTOR_ESCAPED ||
          (number >= 0 && (size_t)number < attractors)) &&
         scene_check_code(state->label, PENDRES_LABEL_COUNT) &&
         scene_check_code(state->how, PENDRES_BASIN_HOW_COUNT);
}
