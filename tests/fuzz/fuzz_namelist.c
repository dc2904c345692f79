/*
 * fuzz_namelist.c -- any bytes are a namelist or are refused with words, and so is whatever is
 * asked of its values; the same for a setting, if they have the form of one.
 */
#include "fuzz/fuzz.h"

#include "deck/deck.h"
#include "deck/namelist/namelist.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void ask_value(const namelist *nl, const namelist_value *v, namelist_errors *errors)
{
  double x;
  int64_t i;
  int l;
  char s[20];
  REQUIRE(v->begin <= nl->length && v->length <= nl->length - v->begin && v->repeat >= 1);
  REQUIRE(v->at.line >= 1 && v->at.line <= nl->lines && v->at.column >= 1);
  (void)namelist_value_real(nl, v, "x", &x, errors);
  (void)namelist_value_integer(nl, v, "i", &i, errors);
  (void)namelist_value_logical(nl, v, "l", &l, errors);
  if (namelist_value_string(nl, v, "s", s, sizeof s, errors)) REQUIRE(strlen(s) < sizeof s);
}

static void ask_group(const namelist *nl, const namelist_group *g, namelist_errors *errors)
{
  REQUIRE(g->begin <= nl->assignments && g->count <= nl->assignments - g->begin);
  for (size_t a = g->begin; a < g->begin + g->count; a++) {
    namelist_array array = { 0 };
    (void)namelist_array_get(nl, g, nl->assignment[a].name, &array, errors);
    REQUIRE(array.count <= NAMELIST_MAX_VALUES);
    for (size_t v = 0; v < array.count && v < 100; v++)
      if (array.item[v] != NULL) ask_value(nl, array.item[v], errors);
    namelist_array_free(&array);
  }
}

static void ask(pendres_status status, namelist *nl, namelist_errors *errors)
{
  REQUIRE(status == (errors->count > 0 ? PENDRES_INVALID_ARGUMENT : PENDRES_OK));
  for (size_t g = 0; g < nl->groups; g++) ask_group(nl, &nl->group[g], errors);
  namelist_errors_sort(errors);
  REQUIRE(errors->count <= NAMELIST_MAX_ERRORS && !errors->out_of_memory);
  for (size_t i = 0; i < errors->count; i++) REQUIRE(errors->item[i].text[0] != '\0');
  namelist_errors_free(errors);
  namelist_free(nl);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  namelist nl = { 0 };
  namelist_errors errors = { 0 };
  char *text = malloc(size + 1); /* exactly: what is read behind it is met */
  REQUIRE(text != NULL);
  memcpy(text, size > 0 ? (const char *)data : "", size);
  text[size] = '\0';
  const pendres_status status = namelist_parse("fuzz.nml", text, size, &nl, &errors);
  ask(status, &nl, &errors);
  for (int whole = 0; whole < 2 && deck_is_setting(text); whole++) {
    const pendres_status set = namelist_parse_setting(text, 1, whole, &nl, &errors);
    ask(set, &nl, &errors);
  }
  free(text);
  return 0;
}
