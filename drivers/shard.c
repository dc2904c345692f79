/* shard.c -- which part of a run is computed here; see shard.h. */
#include "shard.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A whole number from `least` on that is all of the text up to `end`; 0: it is none. */
static int number_of(const char *text, char end, long least, size_t *number, const char **rest)
{
  char *stop = NULL;
  if (text == NULL || *text < '0' || *text > '9') return 0;
  errno = 0;
  const long n = strtol(text, &stop, 10);
  if (errno != 0 || n < least || n > SHARD_MOST || *stop != end) return 0;
  *number = (size_t)n;
  if (rest != NULL) *rest = stop + 1;
  return 1;
}

static int from_environment(const char *name, size_t *number)
{
  return number_of(getenv(name), '\0', 0, number, NULL);
}

/* Jobs first, first + step, ... last: which of how many is this one? */
static int place_of(size_t id, size_t first, size_t last, size_t step, size_t *shard,
                    size_t *shards)
{
  if (step == 0 || id < first || id > last || (id - first) % step != 0) return 0;
  *shard = (id - first) / step + 1;
  *shards = (last - first) / step + 1;
  return 1;
}

/* The variables of Slurm and of Grid Engine say which job of which array this is. 0: there is none,
   or *gaps is its last job: which jobs there are before that is not told. */
static int ask_scheduler(size_t *shard, size_t *shards, size_t *gaps)
{
  static const char *const variables[][5] = {
    { "SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_MAX",
      "SLURM_ARRAY_TASK_STEP", "SLURM_ARRAY_TASK_COUNT" },
    { "SGE_TASK_ID", "SGE_TASK_FIRST", "SGE_TASK_LAST", "SGE_TASK_STEPSIZE", "" /* no gaps */ },
  };
  *gaps = 0;
  for (size_t k = 0; k < sizeof variables / sizeof *variables; k++) {
    size_t id, first, last, step = 1, count;
    if (!from_environment(variables[k][0], &id) || !from_environment(variables[k][1], &first) ||
        !from_environment(variables[k][2], &last))
      continue;
    (void)from_environment(variables[k][3], &step);
    const int placed = place_of(id, first, last, step, shard, shards);
    if (from_environment(variables[k][4], &count) && (!placed || count != *shards)) *gaps = last;
    else if (placed) return 1;
  }
  return 0;
}

/* The number alone, where the array is 1 to N: PBS does not tell N. */
static int ask_for_number(size_t *shard)
{
  static const char *const variables[] = { "PBS_ARRAY_INDEX", "PBS_ARRAYID", "SLURM_ARRAY_TASK_ID",
                                           "SGE_TASK_ID", "LSB_JOBINDEX" };
  for (size_t k = 0; k < sizeof variables / sizeof *variables; k++)
    if (from_environment(variables[k], shard)) return 1;
  return 0;
}

int shard_parse(const char *text, size_t *shard, size_t *shards, char *words, size_t size)
{
  const char *rest = NULL;
  size_t gaps;
  if (strcmp(text, "auto") == 0) {
    if (ask_scheduler(shard, shards, &gaps)) return 1;
    if (gaps > 0)
      snprintf(words, size, "auto cannot tell parts in an array of jobs with gaps, as Slurm does "
               "not say which there are: number the jobs from 1 to N, or give auto/%zu if the job "
               "with the number I is to compute part I of %zu", gaps, gaps);
    else
      snprintf(words, size, "auto finds no array of jobs of Slurm or Grid Engine; PBS tells only "
               "the number of a job: give auto/N, where N is the number of parts");
    return 0;
  }
  if (strncmp(text, "auto/", 5) == 0 && number_of(text + 5, '\0', 1, shards, NULL)) {
    if (ask_for_number(shard) && *shard >= 1 && *shard <= *shards) return 1;
    snprintf(words, size, "no array of jobs from 1 to %zu is found in the environment", *shards);
    return 0;
  }
  if (number_of(text, '/', 1, shard, &rest) && number_of(rest, '\0', 1, shards, NULL) &&
      *shard <= *shards)
    return 1;
  snprintf(words, size, "'%.60s' is not I/N with I from 1 to N, auto or auto/N", text);
  return 0;
}

void shard_suffix(size_t shard, size_t shards, char suffix[SHARD_NAME])
{
  snprintf(suffix, SHARD_NAME, ".%zu-of-%zu", shard, shards);
}

int shard_is_journal(const char *name, const char *base)
{
  static const char of[] = "of-";
  const size_t length = strlen(base);
  size_t shard, shards;
  const char *rest = NULL;
  if (strncmp(name, base, length) != 0 || name[length] != '.') return 0;
  if (!number_of(name + length + 1, '-', 1, &shard, &rest)) return 0;
  if (strncmp(rest, of, sizeof of - 1) != 0) return 0;
  return number_of(rest + sizeof of - 1, '.', 1, &shards, &rest) && strcmp(rest, "journal") == 0;
}
