/*
 * shard.h -- the part of a run that this program computes.
 *
 * Owns: what --shard means, with the variables of arrays of jobs (Slurm, Grid Engine, PBS), and the
 * names of the parts' files.
 */
#ifndef SHARD_H
#define SHARD_H

#include <stddef.h>

enum { SHARD_MOST = 1000000, SHARD_NAME = 32 };

/* Read "3/8", "auto" or "auto/8" as number *shard, from 1, of *shards. 0, with a message in
   words[size], if it has none of these forms, or there is no array of jobs. */
int shard_parse(const char *text, size_t *shard, size_t *shards, char *words, size_t size);

/* ".3-of-8": what the names of a part's files end in, before ".journal" or ".part". */
void shard_suffix(size_t shard, size_t shards, char suffix[SHARD_NAME]);

/* Whether `name` is the journal of a part beside the file `base`; both without a folder. */
int shard_is_journal(const char *name, const char *base);

#endif
