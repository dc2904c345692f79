/*
 * fuzz_formula.c -- any bytes are a formula or are refused with words at a place within them; the
 * standard form of a formula is that formula.
 */
#include "fuzz/fuzz.h"

#include "model/formula/formula.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int parse(const char *text, formula_tree *t, char *canonical, pendres_formula_error *error)
{
  t->count = 0;
  memset(error, 0, sizeof *error);
  return pendres_formula_parse(text, t, canonical, error);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  formula_tree t = { .node = malloc(FORMULA_MOST_NODES * sizeof *t.node) };
  char *text = malloc(size + 1), canonical[FORMULA_LONGEST + 1], again[FORMULA_LONGEST + 1];
  pendres_formula_error error;
  REQUIRE(text != NULL && t.node != NULL);
  memcpy(text, size > 0 ? (const char *)data : "", size);
  text[size] = '\0';
  const int node = parse(text, &t, canonical, &error);
  if (node >= 0) {
    const int within = pendres_formula_within(&t, node);
    const int slope = pendres_formula_derivative(&t, within, FORMULA_X, 0);
    REQUIRE(slope >= 0 || t.count == FORMULA_MOST_NODES);
    REQUIRE(parse(canonical, &t, again, &error) >= 0 && strcmp(canonical, again) == 0);
  } else {
    REQUIRE(error.message[0] != '\0' && error.at >= 0 && error.length >= 0);
    REQUIRE((size_t)error.at + (size_t)error.length <= strlen(text));
  }
  free(text);
  free(t.node);
  return 0;
}
