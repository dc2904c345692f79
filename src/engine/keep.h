/*
 * keep.h -- how a long computation keeps what it has done; see pendres_keep in context.h.
 *
 * Owns: what states have in common: the name of the function, options, the cost so far, and the
 * question.
 * A function takes a context's keep for itself while it works, so that those that it calls keep
 * nothing:
 *
 *   pendres_keeping k = pendres_keeping_begin(ctx, "function", question);
 *   if (pendres_keeping_found(&k)) pass_state(&k.state, ...);    // and pendres_bytes_end(&k.state)
 *   for (...) {
 *     if (pendres_keeping_due(&k, done)) pass_state(pendres_keeping_write(&k), ...);
 *     ...
 *   }
 *   pendres_keeping_end(&k);
 */
#ifndef PENDRES_KEEP_H
#define PENDRES_KEEP_H

#include "base/bytes.h"
#include "engine/context_internal.h"

typedef struct pendres_keeping {
  pendres_context *ctx;
  pendres_keep to;
  pendres_cost before;    /* of the context, when the function began */
  pendres_bytes question; /* what states begin with */
  pendres_bytes state;    /* the one found, behind the question, or the one that is written */
} pendres_keeping;

/* Begin, with the bytes of the question, which are freed in the end. It has a name in front. */
pendres_keeping pendres_keeping_begin(pendres_context *ctx, const char *name,
                                      pendres_bytes question);

/* Whether there is a state of this question. Who cannot read it from k->state begins anew; who has
   read it calls _taken: what it has cost is the context's cost. */
int pendres_keeping_found(pendres_keeping *k);
void pendres_keeping_taken(pendres_keeping *k);

/* Whether a state is wanted. It is written to what _write gives, and put by _put. Without memory
   there is none. */
int pendres_keeping_due(pendres_keeping *k, double done);
pendres_bytes *pendres_keeping_write(pendres_keeping *k);
void pendres_keeping_put(pendres_keeping *k);

void pendres_keeping_end(pendres_keeping *k);

#endif
