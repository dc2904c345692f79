/*
 * fuzz_journal.c -- any bytes in the place of a journal are taken over as far as they are whole, or
 * refused with words; what is taken over can be read, is there again the next time, and a run can
 * go on from it. Once as they are, and once with checksums put right, since no mutation finds one.
 */
#include "fuzz/fuzz.h"

#include <zlib.h>

#include "farm/journal.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { STAGES = 4, TASKS = 32 };

static const char head[] = "libpendres 1\n&pendulum\n  damping = 0.1\n/\n";

/* As journal_file.c writes it; the mark of a record is in the bytes already. */
typedef struct file_head {
  char magic[8];
  uint64_t length;
  uint32_t text_sum, sum;
} file_head;

static uint32_t sum_of(const void *data, size_t size)
{
  return (uint32_t)crc32(crc32(0L, Z_NULL, 0), data, (uInt)size);
}

/* Numbers of stages and tasks are made small too, so that they are found again. */
static size_t mend_record(uint8_t *bytes, size_t left)
{
  journal_entry e;
  if (left < sizeof e) return left;
  memcpy(&e, bytes, sizeof e);
  e.stage %= STAGES;
  e.task %= TASKS;
  const size_t stored = e.stored < left - sizeof e ? (size_t)e.stored : left - sizeof e;
  e.data_sum = sum_of(bytes + sizeof e, stored);
  e.sum = sum_of(&e, offsetof(journal_entry, sum));
  memcpy(bytes, &e, sizeof e);
  return sizeof e + stored;
}

static void mend(uint8_t *bytes, size_t size)
{
  file_head h;
  if (size < sizeof h) return;
  memcpy(&h, bytes, sizeof h);
  const size_t length = h.length < size - sizeof h ? (size_t)h.length : size - sizeof h;
  h.text_sum = sum_of(bytes + sizeof h, length);
  h.sum = sum_of(&h, offsetof(file_head, sum));
  memcpy(bytes, &h, sizeof h);
  for (size_t at = sizeof h + length; at < size;) at += mend_record(bytes + at, size - at);
}

/* All records can be read; their number. */
static size_t read_records(journal *j)
{
  size_t n = 0;
  for (size_t stage = 0; stage < STAGES; stage++)
    for (size_t task = 0; task < TASKS; task++) {
      farm_record r = { 0 };
      const pendres_status status = journal_read(j, stage, task, &r);
      REQUIRE(status == (journal_has(j, stage, task) ? PENDRES_OK : PENDRES_NOT_FOUND));
      n += status == PENDRES_OK;
      free(r.data);
    }
  REQUIRE(n == journal_count(j));
  return n;
}

/* Go on from it with one more record: the next run finds all of them and nothing damaged. */
static void go_on(const char *path, journal *j)
{
  char words[JOURNAL_WORDS];
  journal *again = NULL;
  unsigned char byte = 7;
  const farm_record more = { .data = &byte, .size = 1 };
  const size_t n = read_records(j);
  REQUIRE(journal_append(j, STAGES - 1, TASKS - 1, &more, words) == PENDRES_OK);
  const size_t all = read_records(j);
  REQUIRE(all == n || all == n + 1);
  journal_close(j);
  REQUIRE(journal_open(path, head, 1, &again, words) == PENDRES_OK);
  REQUIRE(words[0] == '\0' && read_records(again) == all);
  journal_remove(again);
}

/* As a shard's journal, which is only read. */
static size_t add(const char *path)
{
  char own[64], words[JOURNAL_WORDS];
  journal *j = NULL;
  fuzz_path(own, sizeof own, "own.journal");
  REQUIRE(journal_open(own, head, 0, &j, words) == PENDRES_OK);
  const pendres_status status = journal_add(j, path, words);
  REQUIRE(status == PENDRES_OK || (status == PENDRES_INVALID_ARGUMENT && words[0] != '\0'));
  const size_t n = read_records(j);
  journal_close(j);
  return n;
}

static void try_bytes(const uint8_t *bytes, size_t size)
{
  char path[64], kept[64], words[JOURNAL_WORDS];
  journal *j = NULL;
  fuzz_path(path, sizeof path, "run.journal");
  fuzz_save(path, bytes, size);
  const size_t added = add(path);
  const pendres_status status = journal_open(path, head, 1, &j, words);
  REQUIRE(status == PENDRES_OK || (status == PENDRES_INVALID_ARGUMENT && words[0] != '\0'));
  REQUIRE(added == (status == PENDRES_OK ? journal_count(j) : 0));
  if (status == PENDRES_OK) go_on(path, j);
  else REQUIRE(unlink(path) == 0); /* left alone */
  fuzz_path(kept, sizeof kept, "run.journal.~1~"); /* one whose head is damaged */
  (void)unlink(kept);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  uint8_t *bytes = calloc(size + 1, 1);
  REQUIRE(bytes != NULL);
  memcpy(bytes, size > 0 ? (const char *)data : "", size);
  try_bytes(bytes, size);
  mend(bytes, size);
  try_bytes(bytes, size);
  free(bytes);
  return 0;
}
