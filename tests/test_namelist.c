/*
 * test_namelist.c -- the syntax of decks: every form of the standard, the errors with their
 * positions, the bounds, and random damage. No tolerances: what is read is exact.
 */
#define _POSIX_C_SOURCE 200809L /* open_memstream */

#include "namelist_fixture.h"

/* ---- what tests share ---------------------------------------------------------------------- */

/* The tree as text: "g: x=1.5 s='a' xv(2:4:1)=3*1,_,2 / h: /". Free the result. */
static char *show(const namelist *nl)
{
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  assert_non_null(out);
  for (size_t g = 0; g < nl->groups; g++) {
    fprintf(out, "%s%s:", g > 0 ? " " : "", nl->group[g].name);
    for (size_t a = 0; a < nl->group[g].count; a++) {
      const namelist_assignment *as = &nl->assignment[nl->group[g].begin + a];
      fprintf(out, " %s", as->name);
      if (as->subscripted) fprintf(out, "(%ld:%ld:%ld)", as->first, as->last, as->step);
      for (size_t v = 0; v < as->count; v++) {
        const namelist_value *value = &nl->value[as->begin + v];
        fputc(v == 0 ? '=' : ',', out);
        if (value->repeat > 1) fprintf(out, "%d*", value->repeat);
        if (value->form == NAMELIST_NULL) fputc('_', out);
        else fprintf(out, "%.*s", (int)value->length, nl->text + value->begin);
      }
      if (as->count == 0) fputc('=', out);
    }
    fprintf(out, " /");
  }
  fclose(out);
  return text;
}

/* The positions of all errors: "1:5 2:7". */
static const char *positions(const namelist_errors *errors, char *text, size_t size)
{
  text[0] = '\0';
  for (size_t i = 0; i < errors->count; i++)
    snprintf(text + strlen(text), size - strlen(text), "%s%d:%d", i > 0 ? " " : "",
             errors->item[i].at.line, errors->item[i].at.column);
  return text;
}

/* ---- what is read -------------------------------------------------------------------------- */

static void good_text(void **state)
{
  (void)state;
  for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
    namelist nl = { 0 };
    namelist_errors errors = { 0 };
    const pendres_status status = namelist_parse("t", good[i].text, strlen(good[i].text), &nl,
                                                 &errors);
    if (good[i].tree == NULL) {
      assert_int_equal(status, PENDRES_INVALID_ARGUMENT);
    } else {
      char *tree = show(&nl);
      namelist_errors_print(&errors, stderr);
      assert_string_equal(tree, good[i].tree);
      assert_int_equal(status, PENDRES_OK);
      assert_int_equal(errors.count, 0);
      free(tree);
    }
    namelist_free(&nl);
    namelist_errors_free(&errors);
  }
}

/* Position of every error, and the tree that is understood nevertheless. */
static const struct { const char *text, *where, *tree; } bad[] = {
  { "&g x=1\n", "1:1", "g: x=1 /" },                                /* no slash */
  { "&g x=1\n&h y=2 /", "1:1", "g: x=1 / h: y=2 /" },
  { "x=1\n&g y=2 /", "1:1", "g: y=2 /" },                           /* outside */
  { "&g y=2 /\n\n  # text\nmore\n&h /\nagain", "3:3 6:1", "g: y=2 / h: /" },
  { "&g x=1/2 /", "1:8", "g: x=1 /" },
  { "& g x=1 /", "1:1", "" },
  { "&end", "1:1", "" },
  { "&g,x=1 /", "1:3", "g: x=1 /" },
  { "&1g x=1 /", "1:1", "" },
  { "&g x=1 /\n&G y=2 /", "2:1", "g: x=1 / g: y=2 /" },             /* twice */
  { "&g x=1 X=2 /", "1:8", "g: x=1 x=2 /" },
  { "&g x=1;2 /", "1:7", "g: x=1,2 /" },
  { "&g x==2 /", "1:6", "g: x=2 /" },
  { "&g x 2 y=3 /", "1:4", "g: y=3 /" },
  { "&g 2 'a=b' y=3 /", "1:4", "g: y=3 /" },
  { "&g , y=3 /", "1:4", "g: y=3 /" },
  { "&g x=1 # text / &\n y=3 /", "1:8", "g: x=1 y=3 /" },
  { "&g # text y=2\n y=3 /", "1:4", "g: y=3 /" },
  { "&g x=3 *1 /", "1:8", "g: x=3 /" },
  { "&g x=0*1 y=2 /", "1:6", "g: x= y=2 /" },
  { "&g x=1000001*1 y=2 /", "1:6", "g: x= y=2 /" },
  { "&g x=99999999999999999999999*1 y=2 /", "1:6", "g: x= y=2 /" },
  { "&g x=1000000*1 y=2 /", "1:19", "g: x=1000000*1 y= /" },
  { "&g s='abc\n y=2 /", "1:6", "g: s= y=2 /" },                    /* strings */
  { "&g s='abc /\n&h z=3 /", "1:6", "g: s= / h: z=3 /" },
  { "&g s='abc", "1:1 1:6", "g: s= /" },
  { "&g s='a'b y=2\n z=3 /", "1:9", "g: s= z=3 /" },
  { "&g s='it's' y=2 /", "1:10", "g: s= /" },
  { "&g s=a'b' /", "1:6", "g: s= /" },
  { "&g s=\xE2\x80\x98" "a\xE2\x80\x99 y=1\n z=2 /", "1:6", "g: s= z=2 /" },
  { "&g x(0)=1 y(2:1)=1 z()=1 u(1,2)=1 v(a)=1 w(-1)=2 /", "1:5 1:12 1:21 1:27 1:36 1:43",
    "g: x(1:0:1)=1 y(2:1:1)=1 z(1:0:1)=1 u(1:1:1)=1 v(1:0:1)=1 w(1:0:1)=2 /" },
  { "&g x(9999999)=1 y(1:2:0)=2 /", "1:5 1:18", "g: x(1:0:1)=1 y(1:2:1)=2 /" },
  { "&g x(1:3:-1)=1 y(3::-1)=1 z(3:1:- 2)=1 u(-1:2)=1 v(3:1:-0)=2 /", "1:5 1:17 1:28 1:41 1:51",
    "g: x(1:3:-1)=1 y(3:0:-1)=1 z(3:1:1)=1 u(1:0:1)=1 v(3:1:1)=2 /" },
  { "&g x (2)=1 y%z=3 /", "1:6 1:13", "g: x(2:2:1)=1 y=3 /" },
  { "&g \xCE\xB3\xCE\xB3=1 x=;/", "1:4 1:11", "g: x= /" },          /* columns count characters */
  { "\xEF\xBB\xBF x", "1:2", "" },
  { "&g s='\xE9' /", "1:7", "g: s='\xE9' /" },                      /* Latin-1 */
  { "&g s='\xC0\x80' /", "1:7", "g: s='\xC0\x80' /" },
  { "&g s='\x1B[2J' /", "1:7", "" },
  { "&g x=1 &2 y=2 /", "1:10", NULL },
};

static void bad_text(void **state)
{
  char where[300];
  (void)state;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    namelist nl = { 0 };
    namelist_errors errors = { 0 };
    const pendres_status status = namelist_parse("t", bad[i].text, strlen(bad[i].text), &nl,
                                                 &errors);
    char *tree = show(&nl);
    namelist_errors_sort(&errors);
    if (bad[i].tree != NULL) {
      if (strcmp(positions(&errors, where, sizeof where), bad[i].where) != 0) {
        print_error("in \"%s\"\n", bad[i].text);
        namelist_errors_print(&errors, stderr);
      }
      assert_string_equal(where, bad[i].where);
      assert_string_equal(tree, bad[i].tree);
      assert_int_equal(status, PENDRES_INVALID_ARGUMENT);
    }
    free(tree);
    namelist_free(&nl);
    namelist_errors_free(&errors);
  }
}

/* The whole message, with a tab before the caret and a line that is too long to show. */
static void message_form(void **state)
{
  static const char text[] = "&g\n\tx = 1;2\n/\n";
  char line[400] = "&g ";
  namelist nl = { 0 };
  namelist_errors errors = { 0 };
  (void)state;

  namelist_parse("a/b.nml", text, strlen(text), &nl, &errors);
  assert_int_equal(errors.count, 1);
  assert_string_equal(errors.item[0].text,
                      "a/b.nml:2:7: error: ';' separates nothing here; use a comma or a blank\n"
                      "  \tx = 1;2\n"
                      "  \t     ^");
  namelist_free(&nl);
  namelist_errors_free(&errors);

  for (int i = 0; i < 60; i++) strcat(line, "x = 1");
  strcat(line, " /");
  namelist_parse("t", line, strlen(line), &nl, &errors);
  for (size_t i = 0; i < errors.count; i++) {
    const char *source = strchr(errors.item[i].text, '\n') + 1;
    const char *caret = strchr(source, '\n') + 1;
    assert_true(caret - source < 120);
    /* What the caret points at is what stands at that column. */
    assert_int_equal(source[strchr(caret, '^') - caret], line[errors.item[i].at.column - 1]);
  }
  assert_true(errors.count > 20);
  namelist_free(&nl);
  namelist_errors_free(&errors);
}

/* ---- values -------------------------------------------------------------------------------- */

static const struct { const char *text; double value; int good; } reals[] = {
  { "0", 0, 1 },          { "1", 1, 1 },           { "-1.", -1, 1 },       { "+.5", 0.5, 1 },
  { "1.5", 1.5, 1 },      { "1e3", 1e3, 1 },       { "1E+3", 1e3, 1 },     { "1d-3", 1e-3, 1 },
  { "1.D3", 1e3, 1 },     { ".5d0", 0.5, 1 },      { "1+3", 1e3, 1 },      { "1.5-3", 1.5e-3, 1 },
  { "-0.", -0.0, 1 },     { "007", 7, 1 },         { "0.1", 0.1, 1 },      { "1e308", 1e308, 1 },
  { "1.7976931348623157e308", 1.7976931348623157e308, 1 },
  { "4.9406564584124654e-324", 4.9406564584124654e-324, 1 },
  { "0e999", 0, 1 },      { "0.0d-999", 0, 1 },    { "inf", HUGE_VAL, 1 },
    { "-Infinity", -HUGE_VAL, 1 },
  { "NaN", NAN, 1 },      { "nan(12)", NAN, 1 },
  { "1e400", 0, 0 },      { "-1d400", 0, 0 },      { "1e-400", 0, 0 },     { "1.8e308", 0, 0 },
  { "", 0, 0 },           { ".", 0, 0 },           { "e5", 0, 0 },         { "1e", 0, 0 },
  { "1e+", 0, 0 },        { "1+", 0, 0 },          { "1.5.2", 0, 0 },      { "1e5.", 0, 0 },
  { "0x10", 0, 0 },       { "1_8", 0, 0 },         { "1q3", 0, 0 },        { "--1", 0, 0 },
  { "1e5e5", 0, 0 },      { "infinite", 0, 0 },    { "nanny", 0, 0 },      { "nan(", 0, 0 },
  { "in", 0, 0 },         { "(1,2)", 0, 0 },       { "'1'", 0, 0 },        { "T", 0, 0 },
  { "1f", 0, 0 },         { "1e99999999999999999999", 0, 0 },
};

/* Parse "&g x=TEXT /" and convert its value. */
static void check_real(size_t i)
{
  char text[100];
  namelist nl = { 0 };
  namelist_errors errors = { 0 };
  double x = 12345;
  int converted = 0;
  snprintf(text, sizeof text, "&g x=%s /", reals[i].text);
  assert_int_equal(namelist_parse("t", text, strlen(text), &nl, &errors), PENDRES_OK);
  if (nl.values == 1) converted = namelist_value_real(&nl, only_value(&nl), "x", &x, &errors);
  if (converted != reals[i].good) print_error("'%s'\n", reals[i].text);
  assert_int_equal(converted, reals[i].good);
  assert_int_equal(errors.count, reals[i].good || nl.values == 0 ? 0 : 1);
  if (converted && isnan(reals[i].value)) assert_true(isnan(x));
  else if (converted) assert_memory_equal(&x, &reals[i].value, sizeof x); /* to the bit */
  namelist_free(&nl);
  namelist_errors_free(&errors);
}

static void real_values(void **state)
{
  (void)state;
  for (size_t i = 0; i < sizeof reals / sizeof *reals; i++) check_real(i);
}

/* Where there is a locale with decimal commas, reading does not change. */
static void other_locale(void **state)
{
  static const char *const names[] = { "de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8" };
  const char *set = NULL;
  (void)state;
  for (size_t i = 0; set == NULL && i < sizeof names / sizeof *names; i++)
    set = setlocale(LC_ALL, names[i]);
  if (set == NULL) skip();
  for (size_t i = 0; i < sizeof reals / sizeof *reals; i++) check_real(i);
  setlocale(LC_ALL, "C");
}

static void integer_values(void **state)
{
  static const struct { const char *text; int64_t value; int good; } cases[] = {
    { "0", 0, 1 }, { "-12", -12, 1 }, { "+7", 7, 1 }, { "007", 7, 1 },
    { "9223372036854775807", INT64_MAX, 1 }, { "-9223372036854775808", INT64_MIN, 1 },
    { "9223372036854775808", 0, 0 }, { "3.0", 0, 0 }, { "3.", 0, 0 }, { "1e3", 0, 0 },
    { "3_4", 0, 0 }, { "-", 0, 0 }, { "abc", 0, 0 }, { "'3'", 0, 0 }, { "0x1", 0, 0 },
      { "T", 0, 0 },
  };
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char text[100];
    namelist nl = { 0 };
    namelist_errors errors = { 0 };
    int64_t n = 0;
    snprintf(text, sizeof text, "&g i=%s /", cases[i].text);
    assert_int_equal(namelist_parse("t", text, strlen(text), &nl, &errors), PENDRES_OK);
    assert_int_equal(namelist_value_integer(&nl, only_value(&nl), "i", &n, &errors), cases[i].good);
    assert_int_equal(errors.count, !cases[i].good);
    if (cases[i].good) assert_true(n == cases[i].value);
    namelist_free(&nl);
    namelist_errors_free(&errors);
  }
}

static void logical_values(void **state)
{
  static const struct { const char *text; int value, good; } cases[] = {
    { "T", 1, 1 }, { ".true.", 1, 1 }, { "true", 1, 1 }, { ".T", 1, 1 }, { "tomato", 1, 1 },
    { "F", 0, 1 }, { ".FALSE.", 0, 1 }, { "f", 0, 1 },
    { "1", 0, 0 }, { "yes", 0, 0 }, { ".", 0, 0 }, { "'T'", 0, 0 }, { "..t", 0, 0 },
  };
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char text[100];
    namelist nl = { 0 };
    namelist_errors errors = { 0 };
    int l = -1;
    snprintf(text, sizeof text, "&g l=%s /", cases[i].text);
    assert_int_equal(namelist_parse("t", text, strlen(text), &nl, &errors), PENDRES_OK);
    assert_int_equal(namelist_value_logical(&nl, only_value(&nl), "l", &l, &errors), cases[i].good);
    if (cases[i].good) assert_int_equal(l, cases[i].value);
    namelist_free(&nl);
    namelist_errors_free(&errors);
  }
}

static void string_values(void **state)
{
  static const struct { const char *text, *value; } cases[] = {
    { "'abc'", "abc" }, { "\"abc\"", "abc" }, { "''", "" }, { "'it''s'", "it's" },
    { "''''", "'" }, { "\"\"\"\"", "\"" }, { "'a\"b'", "a\"b" }, { "\"it''s\"", "it''s" },
    { "'ab\ncd'", "abcd" }, { "'ab\r\n cd'", "ab cd" }, { "'1234567'", "1234567" },
    { "'12345678'", NULL }, { "abc", NULL }, { "3", NULL },
  };
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char text[100], s[8];
    namelist nl = { 0 };
    namelist_errors errors = { 0 };
    snprintf(text, sizeof text, "&g s=%s /", cases[i].text);
    assert_int_equal(namelist_parse("t", text, strlen(text), &nl, &errors), PENDRES_OK);
    assert_int_equal(namelist_value_string(&nl, only_value(&nl), "s", s, sizeof s, &errors),
                     cases[i].value != NULL);
    if (cases[i].value != NULL) assert_string_equal(s, cases[i].value);
    namelist_free(&nl);
    namelist_errors_free(&errors);
  }
}

/* The elements of x in a group, as text: "1 _ 3"; "!" after an error. */
static void arrays(void **state)
{
  static const struct { const char *text, *elements; } cases[] = {
    { "x=1,2,3", "1 2 3" },
    { "x=1,,3", "1 _ 3" },
    { "x=1,2,", "1 2" },
    { "x=2*1, 2*, 5, 3*", "1 1 _ _ 5" },
    { "x=", "" },
    { "y=2", "absent" },
    { "x(3)=1", "_ _ 1" },
    { "x(2:3)=1,2", "_ 1 2" },
    { "x(2:)=1,2,3", "_ 1 2 3" },
    { "x(1:5:2)=1,2,3", "1 _ 2 _ 3" },
    { "x(3:1:-2)=0.5,1", "1 _ 0.5" }, /* as gfortran and flang */
    { "x(4:2:-1)=2*5,6", "_ 6 5 5" },
    { "x(+1:+5:+2)=1,2,3", "1 _ 2 _ 3" },
    { "x(3:1:-2)=1,2,3", "!" },
    { "x(4:1:-2)=1,2,3", "!" },
    { "x(2:2:-1)=1", "_ 1" },
    { "x(2)=2 y=1 x(1)=1", "1 2" },
    { "x=1,,3 x(2)=2", "1 2 3" },
    { "x(2:3)=1", "_ 1" },
    { "x=1,2 x(2)=2", "!" },
    { "x(2)=1 x(2)=1", "!" },
    { "x(2)=1,2", "!" },
    { "x(2:3)=1,2,3", "!" },
    { "x(1000000)=1,", "far" },
    { "x(1000000:)=1,2", "!" },
    { "x(999999:1000000:1000000)=2*1", "!" },
  };
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char text[100], shown[200] = "";
    namelist nl = { 0 };
    namelist_errors errors = { 0 };
    namelist_array array = { 0 };
    snprintf(text, sizeof text, "&g %s /", cases[i].text);
    assert_int_equal(namelist_parse("t", text, strlen(text), &nl, &errors), PENDRES_OK);
    const pendres_status status =
        namelist_array_get(&nl, namelist_group_find(&nl, "g"), "x", &array, &errors);
    if (status != PENDRES_OK) strcpy(shown, "!");
    else if (!array.given) strcpy(shown, "absent");
    else if (array.count > 20) strcpy(shown, "far");
    for (size_t k = 0; status == PENDRES_OK && k < array.count && array.count < 20; k++) {
      const namelist_value *v = array.item[k];
      snprintf(shown + strlen(shown), sizeof shown - strlen(shown), "%s%.*s", k > 0 ? " " : "",
               v == NULL ? 1 : (int)v->length, v == NULL ? "_" : nl.text + v->begin);
    }
    if (strcmp(shown, cases[i].elements) != 0) print_error("in '%s'\n", cases[i].text);
    assert_string_equal(shown, cases[i].elements);
    assert_int_equal(errors.count > 0, status != PENDRES_OK);
    namelist_array_free(&array);
    namelist_free(&nl);
    namelist_errors_free(&errors);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(good_text),
    cmocka_unit_test(bad_text),
    cmocka_unit_test(message_form),
    cmocka_unit_test(real_values),
    cmocka_unit_test(other_locale),
    cmocka_unit_test(integer_values),
    cmocka_unit_test(logical_values),
    cmocka_unit_test(string_values),
    cmocka_unit_test(arrays),
  };
  return cmocka_run_group_tests_name("namelist", tests, NULL, NULL);
}
