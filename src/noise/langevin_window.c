/* langevin_window.c -- how the caller sees trajectories behind the door; see langevin_window.h. */
#include "noise/langevin_window.h"

#include <string.h>

enum { ROWS = 5 /* x, v, cosine, sine and work */ };

/* A row of a strobe in the caller's units. */
static const double *shown(const pendres_noise_window *w, int row, const pendres_dimensions *kind,
                           size_t n, const double *values)
{
  double *to = w->memory + (size_t)row * w->room;
  if (values == NULL) return NULL;
  memcpy(to, values, n * sizeof *to);
  pendres_units_out(&w->door->scales, kind, n, to);
  return to;
}

/* A strobe as the caller sees it; 0: out of memory. */
static int look(pendres_noise_window *w, const pendres_langevin_strobe *strobe,
                pendres_langevin_strobe *out)
{
  const size_t n = strobe->count;
  *out = *strobe;
  out->first += w->door->first;
  if (!pendres_door_changes(w->door)) return 1;
  if (n > w->room) {
    w->memory = pendres_door_memory(w->door, ROWS * n * sizeof *w->memory);
    w->room = w->memory != NULL ? n : 0;
  }
  if (w->memory == NULL) return 0;
  out->x = shown(w, 0, &pendres_dim_length, n, strobe->x);
  out->v = shown(w, 1, &pendres_dim_speed, n, strobe->v);
  out->cosine = shown(w, 2, &pendres_dim_length, n, strobe->cosine);
  out->sine = shown(w, 3, &pendres_dim_length, n, strobe->sine);
  out->work = shown(w, 4, &pendres_dim_energy, n, strobe->work);
  return 1;
}

static pendres_langevin_answer see(void *arg, const pendres_langevin_strobe *strobe)
{
  pendres_noise_window *w = arg;
  pendres_langevin_strobe s;
  if (!look(w, strobe, &s)) return PENDRES_LANGEVIN_STOP;
  return w->observer->see(w->observer->arg, &s);
}

static void leave(void *arg, const pendres_langevin_strobe *strobe, unsigned char *left)
{
  pendres_noise_window *w = arg;
  pendres_langevin_strobe s;
  if (look(w, strobe, &s)) w->request->leave(w->request->arg, &s, left);
}

const pendres_langevin_observer *pendres_noise_observer(pendres_door *d,
                                                        const pendres_langevin_observer *observer,
                                                        pendres_noise_window *window)
{
  if (observer == NULL || observer->see == NULL || (!pendres_door_changes(d) && d->first == 0))
    return observer;
  *window = (pendres_noise_window){.door = d, .observer = observer, .through = *observer};
  window->through.see = see;
  window->through.arg = window;
  return &window->through;
}

const pendres_langevin_request *pendres_noise_request(pendres_door *d,
                                                      const pendres_langevin_request *request,
                                                      pendres_noise_window *window,
                                                      pendres_langevin_request *inside)
{
  if (request == NULL || !pendres_door_changes(d)) return request;
  *window = (pendres_noise_window){.door = d, .request = request};
  *inside = *request;
  pendres_units_in(&d->scales, &pendres_dim_langevin_request, 1, inside);
  if (request->leave != NULL) {
    inside->leave = leave;
    inside->arg = window;
  }
  return inside;
}
