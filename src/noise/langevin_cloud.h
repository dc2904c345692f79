/*
 * langevin_cloud.h -- sums over the trajectories of a cloud, shared by langevin_cloud.c and
 * langevin_bias.c.
 *
 * Each trajectory has sums over its strobes that count. Means over all strobe points are ratios of
 * totals, and their errors come from what each trajectory contributes to the deviation (the
 * trajectories are independent; strobes of one trajectory are not). Totals are taken in the
 * order of trajectories, whatever blocks they ran in.
 */
#ifndef PENDRES_LANGEVIN_CLOUD_H
#define PENDRES_LANGEVIN_CLOUD_H

#include "noise/langevin_internal.h"

/* Sums over the strobes of one trajectory that count; x and v relative to the starting point. */
typedef struct pendres_sums {
  double strobes, x, v, xx, xv, vv, cosine, sine, work;
} pendres_sums;

/* A run of one request: its trajectories and their sums. */
typedef struct pendres_sums_run {
  pendres_context *ctx;
  const pendres_langevin_request *request;
  size_t trajectories;
  uint64_t first_id;
  pendres_sums *all;     /* [trajectories] */
  pendres_sums *coarse;  /* [trajectories] of the coarse partners, or NULL */
  unsigned char *left;         /* [trajectories] */
  double *strobe_x, *strobe_v; /* [trajectories][record] or NULL */
  double exposure;
} pendres_sums_run;

/* Check a request that is to run with `steps` steps a period. */
pendres_status pendres_sums_accept(pendres_context *ctx, const pendres_langevin_request *q,
                                   int steps);

/* Memory for a run whose request, trajectories and first id are set. Clear it in any case. */
pendres_status pendres_sums_run_make(pendres_sums_run *r, int pairs);
void pendres_sums_run_clear(pendres_sums_run *r);

/* Follow all trajectories of a run in block b, with their partners in block coarse if that is not
 * NULL. */
pendres_status pendres_sums_follow(pendres_sums_run *r, pendres_langevin_block *b,
                                   pendres_langevin_block *coarse);

/* The sums over all n trajectories. */
pendres_sums pendres_sums_total(const pendres_sums *all, size_t n);

/* The statistics that follow from totals; means are relative to the starting point. */
void pendres_sums_statistics(const pendres_sums *t,
                             double out[PENDRES_LANGEVIN_STATISTICS]);

/* The statistics of a run with their standard errors or, if it has coarse partners, their
 * differences from those of the partners. */
pendres_status pendres_sums_estimate(const pendres_sums_run *r, pendres_langevin_estimate *out);

#endif
