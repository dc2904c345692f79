/**
 * @file names.h
 * @brief What values are called: the words of decks, files and messages.
 *
 * Owns: one list of names for each enum of the other headers. Names are a contract as the values
 * are: words of small letters, digits and underscores, no two of a list the same.
 *
 *     printf("%s\n", pendres_name_get(PENDRES_NAMES_LABEL, attractor->label));
 *
 * Thread safety: all functions are pure.
 */
#ifndef PENDRES_NAMES_H
#define PENDRES_NAMES_H

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/** The enum whose values are named. Of doubts and others each bit has a name. */
typedef enum pendres_names {
  PENDRES_NAMES_METHOD = 0,         /**< pendres_method */
  PENDRES_NAMES_TABLE,              /**< pendres_table */
  PENDRES_NAMES_PARAMETER,          /**< pendres_parameter */
  PENDRES_NAMES_ENSEMBLE_SHAPE,     /**< pendres_ensemble_shape */
  PENDRES_NAMES_LABEL,              /**< pendres_label */
  PENDRES_NAMES_SPECIAL,            /**< pendres_special */
  PENDRES_NAMES_BRANCH_END,         /**< pendres_branch_end */
  PENDRES_NAMES_DOUBT,              /**< pendres_doubt, by its bits */
  PENDRES_NAMES_JUMP,               /**< pendres_jump_kind */
  PENDRES_NAMES_PEAK,               /**< pendres_peak */
  PENDRES_NAMES_REGIME,             /**< pendres_regime */
  PENDRES_NAMES_OTHER,              /**< pendres_other, by its bits */
  PENDRES_NAMES_BASIN_END,          /**< pendres_basin_end */
  PENDRES_NAMES_BASIN_HOW,          /**< pendres_basin_how */
  PENDRES_NAMES_LANGEVIN_ANSWER,    /**< pendres_langevin_answer */
  PENDRES_NAMES_LANGEVIN_STATISTIC, /**< pendres_langevin_statistic */
  PENDRES_NAMES_CLOUD_WAY,          /**< pendres_cloud_way */
  PENDRES_NAMES_CLOUD_VERDICT,      /**< pendres_cloud_verdict */
  PENDRES_NAMES_SWITCHING_WAY,      /**< pendres_switching_way */
  PENDRES_NAMES_SWITCHING_VERDICT,  /**< pendres_switching_verdict */
  PENDRES_NAMES_STORE_TYPE,         /**< pendres_store_type */
  PENDRES_NAMES_STEP_END,           /**< pendres_step_end */
  PENDRES_NAMES_FIT_OBSERVABLE,     /**< pendres_fit_observable */
  PENDRES_NAMES_FIT_QUANTITY,       /**< pendres_fit_quantity */
  PENDRES_NAMES_COUNT               /**< how many lists there are; not a list */
} pendres_names;

/** The name of a value; NULL if it is none, or there is no such list. The string is static. */
const char *pendres_name_get(pendres_names list, int value);

/** The value with a name; -1 if there is none, no such list, or name is NULL. */
int pendres_name_find(pendres_names list, const char *name);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
