/* method_cvode.c -- what the CVODE methods share; see method_cvode.h. */
#include "engine/method_cvode.h"

#include <stdlib.h>

#include <cvode/cvode.h>

#include "engine/compat.h"

pendres_cvode *pendres_cvode_open(pendres_one *b, int multistep)
{
  pendres_cvode *c = calloc(1, sizeof *c);
  b->memory = c;
  if (c == NULL) return NULL;
  c->cvode = CVodeCreate(multistep, b->ctx->sun);
  if (c->cvode == NULL || pendres_compat_silence(b->ctx->sun, NULL, c->cvode) != 0 ||
      CVodeInit(c->cvode, pendres_one_slope, 0.0, b->state) != 0 ||
      CVodeSetUserData(c->cvode, b) != 0 ||
      CVodeWFtolerances(c->cvode, pendres_one_weights) != 0 ||
      CVodeSetMaxNumSteps(c->cvode, 100000000L) != 0)
    return NULL;
  return c;
}

/* Not stopped at the strobes: shortening a step there costs a multistep method its history, and
   CVODE's own interpolant is as accurate as its steps. */
int pendres_cvode_advance(pendres_one *b, double theta)
{
  const pendres_cvode *c = b->memory;
  sunrealtype reached = 0.0;
  return CVode(c->cvode, theta, b->state, &reached, CV_NORMAL);
}

int pendres_cvode_steps(const pendres_one *b, long *steps)
{
  const pendres_cvode *c = b->memory;
  return c->cvode != NULL ? CVodeGetNumSteps(c->cvode, steps) : -1;
}

void pendres_cvode_close(pendres_one *b)
{
  pendres_cvode *c = b->memory;
  if (c == NULL) return;
  if (c->cvode != NULL) CVodeFree(&c->cvode);
  if (c->fixed_point != NULL) (void)SUNNonlinSolFree(c->fixed_point);
  if (c->linear != NULL) (void)SUNLinSolFree(c->linear);
  if (c->matrix != NULL) SUNMatDestroy(c->matrix);
  free(c);
  b->memory = NULL;
}
