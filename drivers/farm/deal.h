/*
 * deal.h -- tasks dealt to the ranks of a run.
 *
 * Owns: what ranks tell each other. All ranks run the same stages. Rank 0 knows which tasks are
 * done and has the journal; its own threads and those of the others ask it for tasks and hand it
 * their records. Records that later stages read are then sent to all ranks, which collect them as
 * rank 0 does. With one rank all of this is crew_take() and crew_finish().
 */
#ifndef DEAL_H
#define DEAL_H

#include "farm/crew_internal.h"

/* Before and after the work on a stage. */
pendres_status deal_begin(crew *c);
void deal_end(crew *c);

/* As crew_take and crew_finish. */
int deal_take(crew *c, int thread, size_t *task);
void deal_finish(crew *c, size_t task, pendres_status status, farm_record *record);

/* A line for the user, from any rank. */
void deal_tell(crew *c, const char *words);

/* Before rank 0 collects a record: the others get it too, if they need it. */
void deal_share(crew *c, size_t task, const farm_record *record);

/* What farm_run returns on another rank than 0. */
pendres_status deal_outcome(crew *c);

#endif
