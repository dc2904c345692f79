/* ranks_serial.c -- one process, without MPI; see ranks.h. */
#include "farm/ranks.h"

#include <stdio.h>

#include "farm/ranks_started.h"

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

int ranks_send(int to, int tag, const void *data, size_t size)
{
  (void)to, (void)tag, (void)data, (void)size;
  return 0;
}

int ranks_receive(int tag, ranks_parcel *out)
{
  (void)tag, (void)out;
  return 0;
}
