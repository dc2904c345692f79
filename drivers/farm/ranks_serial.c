/* ranks_serial.c -- one process, without MPI; see ranks.h. */
#include "farm/ranks.h"

#include <stdio.h>
#include <stdlib.h>

int ranks_start(int *argc, char ***argv, char words[RANKS_WORDS])
{
  const long n = ranks_started();
  (void)argc, (void)argv;
  if (n == 1) return 1;
  snprintf(words, RANKS_WORDS, "a launcher has started this program %ld times, and it was built "
           "without MPI: all of them would compute the same (make MPI=1, or --shard)", n);
  return 0;
}

void ranks_end(void)
{
}

int ranks_own(void)
{
  return 0;
}

int ranks_count(void)
{
  return 1;
}

void ranks_broadcast(void *data, size_t size)
{
  (void)data, (void)size;
}

int ranks_all(int yes)
{
  return yes;
}

int ranks_send(int to, int tag, void *data, size_t size)
{
  (void)to, (void)tag, (void)size;
  free(data);
  return 0;
}

void ranks_flush(void)
{
}

int ranks_receive(int tag, ranks_parcel *out)
{
  (void)tag, (void)out;
  return 0;
}

void ranks_nap(int *idle, long most)
{
  (void)idle, (void)most;
}
