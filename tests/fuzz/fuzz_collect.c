/*
 * fuzz_collect.c -- journals with other numbers in their records, and checksums that fit: what a
 * scene collects is refused with words, or it writes results of it, and nothing crashes. The
 * records are those of the decks in tests/kinds, all of which are computed once; the bytes say
 * which of them is tried, and which places are changed.
 */
#include "fuzz/fuzz.h"

#include <glob.h>
#include <time.h>

#include "farm/journal.h"
#include "scenes/scene.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MOST_DECKS = 64, MOST_RECORDS = 4096, PATIENCE = 20 /* seconds */ };

static const char collect_head[] = "a deck of tests/kinds\n";

typedef struct kept_record {
  journal_entry entry;
  char *data;
} kept_record;

typedef struct collected {
  deck deck;
  size_t records;
  kept_record *record; /* NULL: not computed yet */
} collected;

static collected collected_decks[MOST_DECKS];
static size_t collected_count;

static int collect_stop(void *arg)
{
  return time(NULL) > *(const time_t *)arg;
}

/* Run a deck's scene with a journal; results go to a file that is thrown away. */
static pendres_status collect_run(const deck *d, journal *j, char *words, size_t room)
{
  char output[64];
  const char *why = NULL;
  const time_t end = time(NULL) + PATIENCE;
  farm_options options = { .threads = 1, .stop = collect_stop, .stop_arg = (void *)&end };
  scene_run run = { .deck = d, .table = fopen("/dev/null", "w") };
  fuzz_path(output, sizeof output, "collect.h5");
  REQUIRE(scene_precision(d, &options.library, &why) == PENDRES_OK && run.table != NULL);
  REQUIRE(farm_create(&options, &run.farm) == PENDRES_OK);
  REQUIRE(pendres_store_create(output, NULL, &run.store) == PENDRES_OK);
  farm_set_journal(run.farm, j);
  const pendres_status status = scene_find(d->kind)->run(&run);
  snprintf(words, room, "%s", run.message);
  scene_room_end(&run.room);
  farm_dismiss(run.farm, NULL);
  farm_free(run.farm);
  pendres_store_free(run.store);
  REQUIRE(fclose(run.table) == 0);
  return status;
}

/* The records of a journal that was closed; where there are none it has gone. */
static void collect_load(const char *path, collected *c)
{
  FILE *f = fopen(path, "rb");
  uint64_t length = 0;
  c->record = calloc(MOST_RECORDS, sizeof *c->record);
  REQUIRE(c->record != NULL);
  if (f == NULL) return;
  REQUIRE(fseek(f, 8, SEEK_SET) == 0 && fread(&length, sizeof length, 1, f) == 1);
  REQUIRE(fseek(f, (long)(JOURNAL_HEAD + length), SEEK_SET) == 0);
  for (kept_record *r = c->record; fread(&r->entry, sizeof r->entry, 1, f) == 1; r++) {
    REQUIRE(++c->records < MOST_RECORDS);
    r->data = calloc(r->entry.size + 1, 1);
    REQUIRE(r->data != NULL && fread(r->data, 1, r->entry.stored, f) == r->entry.stored);
  }
  REQUIRE(fclose(f) == 0);
}

static void collect_prepare(collected *c)
{
  char path[64], words[JOURNAL_WORDS];
  journal *j = NULL;
  fuzz_path(path, sizeof path, "kept.journal");
  REQUIRE(journal_open(path, collect_head, 0, &j, words) == PENDRES_OK);
  REQUIRE(collect_run(&c->deck, j, words, sizeof words) == PENDRES_OK);
  journal_close(j);
  collect_load(path, c);
  REQUIRE(unlink(path) == 0 || c->records == 0);
}

/* Not work_precision, which has no journal. Called at the top of the tree. */
static void collect_find(void)
{
  glob_t found;
  REQUIRE(glob("tests/kinds/*.nml", 0, NULL, &found) == 0 && found.gl_pathc <= MOST_DECKS);
  for (size_t i = 0; i < found.gl_pathc; i++) {
    namelist_errors errors = { 0 };
    deck *d = &collected_decks[collected_count].deck;
    REQUIRE(deck_read_set(found.gl_pathv[i], NULL, 0, d, &errors) == PENDRES_OK);
    namelist_errors_free(&errors);
    collected_count++;
  }
  globfree(&found);
}

/* Change a place of a record as eight bytes say: which record, where in it, how wide, and what is
   written: a number of theirs or one that breaks things. Or cut the record. */
static void collect_change(const uint8_t *say, size_t records, kept_record *changed)
{
  static const uint64_t numbers[] = { 0, 1, 8, 127, 1u << 20, INT32_MAX, UINT32_MAX,
                                      (uint64_t)1 << 40, UINT64_MAX, 0x7ff8000000000000u };
  enum { NUMBERS = sizeof numbers / sizeof *numbers };
  kept_record *r = &changed[(say[0] + 256u * say[1]) % records];
  const size_t width = (size_t)1 << (say[4] >> 4) % 4;
  const size_t places = (size_t)r->entry.size / width;
  const size_t said = (size_t)say[2] + 256u * say[3] + 65536u * (say[4] % 16);
  const size_t place = places > 0 ? said % places : 0;
  const uint64_t value = say[5] < 128 ? numbers[say[5] % NUMBERS] : (uint64_t)say[6];
  if (say[7] >= 250) r->entry.size = place * width;
  else if (places > 0) memcpy(r->data + place * width, &value, width);
}

static void collect_copy(const collected *c, kept_record *changed)
{
  for (size_t i = 0; i < c->records; i++) {
    const size_t size = (size_t)c->record[i].entry.size;
    changed[i] = c->record[i];
    changed[i].data = malloc(size + 1);
    REQUIRE(changed[i].data != NULL);
    memcpy(changed[i].data, c->record[i].data, size + 1);
  }
}

/* A journal of these records, which are freed. */
static journal *collect_write(size_t n, kept_record *r, const char *path)
{
  char words[JOURNAL_WORDS];
  journal *j = NULL;
  REQUIRE(journal_open(path, collect_head, 0, &j, words) == PENDRES_OK);
  for (size_t i = 0; i < n; i++) {
    const farm_record record = { .data = r[i].data, .size = (size_t)r[i].entry.size };
    REQUIRE(journal_append(j, r[i].entry.stage, (size_t)r[i].entry.task, &record, words) ==
            PENDRES_OK);
    free(r[i].data);
  }
  free(r);
  return j;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char path[64], words[JOURNAL_WORDS];
  if (size < 1) return 0;
  if (collected_count == 0) collect_find();
  collected *c = &collected_decks[data[0] % collected_count];
  if (c->record == NULL) collect_prepare(c);
  kept_record *changed = calloc(c->records + 1, sizeof *changed);
  REQUIRE(changed != NULL);
  collect_copy(c, changed);
  for (size_t at = 1; at + 8 <= size && c->records > 0; at += 8)
    collect_change(data + at, c->records, changed);
  fuzz_path(path, sizeof path, "changed.journal");
  journal *j = collect_write(c->records, changed, path);
  const pendres_status status = collect_run(&c->deck, j, words, sizeof words);
  REQUIRE(status == PENDRES_OK || words[0] != '\0');
  journal_remove(j);
  return 0;
}
