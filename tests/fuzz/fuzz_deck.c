/*
 * fuzz_deck.c -- any bytes are a deck or are refused with words; the resolved deck is a deck too,
 * which resolves to itself.
 */
#include "fuzz/fuzz.h"

#include "deck/deck.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int read_text(const char *text, size_t size, deck *d)
{
  namelist_errors errors = { 0 };
  const pendres_status status = deck_read_memory("fuzz.nml", text, size, d, &errors);
  REQUIRE(status == (errors.count > 0 ? PENDRES_INVALID_ARGUMENT : PENDRES_OK));
  REQUIRE(status != PENDRES_OK || (unsigned)d->kind < DECK_KIND_COUNT);
  namelist_errors_free(&errors);
  return status == PENDRES_OK;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  deck d = { 0 }, again = { 0 };
  char *first = NULL, *second = NULL;
  if (!read_text((const char *)data, size, &d)) return 0;
  REQUIRE(deck_resolved(&d, &first) == PENDRES_OK);
  REQUIRE(read_text(first, strlen(first), &again));
  REQUIRE(deck_resolved(&again, &second) == PENDRES_OK);
  REQUIRE(strcmp(first, second) == 0);
  free(first);
  free(second);
  deck_free(&d);
  deck_free(&again);
  return 0;
}
