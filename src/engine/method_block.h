/*
 * method_block.h -- lanes of a block, retired and refilled at the strobe.
 */
#ifndef PENDRES_METHOD_BLOCK_H
#define PENDRES_METHOD_BLOCK_H

#include "engine/context_internal.h"
#include "engine/method.h"

/*
 * Run lanes as pendres_method_functions says, in a block of states: with each lane's own steps if
 * they are fixed. Lanes with the same number of steps share blocks; a lane that is done is replaced
 * immediately. Errors are propagated if steps are fixed and the first lane has `added` > 0.
 */
pendres_status pendres_method_block_run(pendres_context *ctx, pendres_flow *flow, int fixed,
                                        const pendres_strobe_job *job);

#endif
