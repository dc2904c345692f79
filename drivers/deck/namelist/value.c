/*
 * value.c -- from the raw text of values to numbers, logicals, strings and arrays, by
 * the rules of formatted list-directed input (ISO/IEC 1539-1:2018, 13.7.2 and 13.10.3).
 */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L /* uselocale */
#endif
#include "deck/namelist/lex.h"
#include "system/grow.h"

#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *clip(const namelist *nl, const namelist_value *v, char *buffer)
{
  const char *raw = nl->text + v->begin;
  size_t n = v->length;
  if (n > NAMELIST_CLIP) {
    n = NAMELIST_CLIP;
    while (n > 0 && ((unsigned char)raw[n] & 0xC0) == 0x80) n--;
  }
  for (size_t i = 0; i < n; i++) buffer[i] = raw[i] == '\n' || raw[i] == '\r' ? ' ' : raw[i];
  strcpy(buffer + n, n < v->length ? "..." : "");
  return buffer;
}

/* Report `'key' wants WHAT, not RAW`; the value of this function is that of a failed conversion. */
static int refuse(const namelist *nl, const namelist_value *v, const char *key, const char *wants,
                  namelist_errors *errors)
{
  char raw[NAMELIST_CLIP + 4];
  namelist_error_at(nl, v->at, errors, "'%s' wants %s, not %s", key, wants,
                    v->form == NAMELIST_NULL ? "nothing" : clip(nl, v, raw));
  return 0;
}

static size_t count_digits(const char *t, size_t n)
{
  size_t i = 0;
  while (i < n && lex_is_digit(t[i])) i++;
  return i;
}

/* Does t start with word (in lower case)? Returns its length or 0. */
static size_t match_word(const char *t, size_t n, const char *word)
{
  const size_t length = strlen(word);
  if (n < length) return 0;
  for (size_t i = 0; i < length; i++)
    if (lex_lower(t[i]) != word[i]) return 0;
  return length;
}

/* inf, infinity, nan, nan(...) without sign: 1 and the value, or 0. */
static int read_special(const char *t, size_t n, double *out)
{
  size_t length = match_word(t, n, "infinity");
  if (length == 0) length = match_word(t, n, "inf");
  *out = HUGE_VAL;
  if (length > 0) return length == n;
  length = match_word(t, n, "nan");
  *out = NAN;
  if (length == 0) return 0;
  if (length == n) return 1;
  return t[length] == '(' && memchr(t, ')', n) == t + n - 1;
}

/* strtod as if in the C locale, whatever the program has set. */
static int to_double(const char *text, double *out)
{
  const locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
  locale_t before = (locale_t)0;
  char *end = NULL;
  if (c == (locale_t)0) return 0;
  before = uselocale(c);
  *out = strtod(text, &end);
  uselocale(before);
  freelocale(c);
  return *end == '\0';
}

/*
 * A Fortran real constant without sign, rewritten for strtod: the exponent letter may be e or d,
 * or absent before a sign. Returns 0 if the form is another.
 */
static int rewrite_real(const char *t, size_t n, char *out)
{
  size_t i = count_digits(t, n), digits = i, used = 0;
  if (i < n && t[i] == '.') {
    const size_t fraction = count_digits(t + i + 1, n - i - 1);
    digits += fraction;
    i += 1 + fraction;
  }
  if (digits == 0) return 0;
  memcpy(out, t, i);
  used = i;
  if (i < n) {
    const int letter = lex_lower(t[i]);
    const int signed_exponent = t[i] == '+' || t[i] == '-';
    if (letter != 'e' && letter != 'd' && !signed_exponent) return 0;
    out[used++] = 'e';
    if (!signed_exponent) i++;
    if (i < n && (t[i] == '+' || t[i] == '-')) out[used++] = t[i++];
    const size_t exponent = count_digits(t + i, n - i);
    if (exponent == 0 || i + exponent != n) return 0;
    memcpy(out + used, t + i, exponent);
    used += exponent;
  }
  out[used] = '\0';
  return 1;
}

static int mantissa_is_zero(const char *number)
{
  for (; *number != '\0' && *number != 'e'; number++)
    if (*number >= '1' && *number <= '9') return 0;
  return 1;
}

int namelist_value_real(const namelist *nl, const namelist_value *value, const char *key,
                        double *out, namelist_errors *errors)
{
  const char *t = nl->text + value->begin;
  size_t n = value->length;
  char number[NAMELIST_MAX_NUMBER + 3], raw[NAMELIST_CLIP + 4];
  double sign = 1.0, x = 0.0;
  const char *problem = NULL;

  if (value->form != NAMELIST_BARE || n > NAMELIST_MAX_NUMBER)
    return refuse(nl, value, key, "a number", errors);
  if (n > 0 && (*t == '+' || *t == '-')) {
    sign = *t == '-' ? -1.0 : 1.0;
    t++;
    n--;
  }
  if (read_special(t, n, out)) {
    *out *= sign;
    return 1;
  }
  if (!rewrite_real(t, n, number) || !to_double(number, &x))
    return refuse(nl, value, key, *t == '(' ? "a real number" : "a number", errors);
  if (isinf(x)) problem = "is too large for a double";
  else if (x == 0.0 && !mantissa_is_zero(number)) problem = "is too small for a double";
  if (problem != NULL) {
    namelist_error_at(nl, value->at, errors, "'%s': %s %s", key, clip(nl, value, raw),
                      problem);
    return 0;
  }
  *out = sign * x;
  return 1;
}

int namelist_value_integer(const namelist *nl, const namelist_value *value, const char *key,
                           int64_t *out, namelist_errors *errors)
{
  const char *t = nl->text + value->begin;
  const size_t n = value->length;
  const size_t sign = n > 0 && (*t == '+' || *t == '-');
  char number[NAMELIST_MAX_NUMBER + 1], raw[NAMELIST_CLIP + 4];
  long long x = 0;

  if (value->form != NAMELIST_BARE || n == sign || n > NAMELIST_MAX_NUMBER)
    return refuse(nl, value, key, "a whole number", errors);
  if (count_digits(t + sign, n - sign) != n - sign)
    return refuse(nl, value, key, "a whole number, without point and exponent", errors);
  memcpy(number, t, n);
  number[n] = '\0';
  errno = 0;
  x = strtoll(number, NULL, 10);
  if (errno == ERANGE || x > INT64_MAX || x < INT64_MIN) {
    namelist_error_at(nl, value->at, errors, "'%s': %s does not fit into 64 bits", key,
                      clip(nl, value, raw));
    return 0;
  }
  *out = x;
  return 1;
}

int namelist_value_logical(const namelist *nl, const namelist_value *value, const char *key,
                           int *out, namelist_errors *errors)
{
  const char *t = nl->text + value->begin;
  size_t n = value->length;
  if (value->form != NAMELIST_BARE) return refuse(nl, value, key, ".true. or .false.", errors);
  if (n > 0 && *t == '.') {
    t++;
    n--;
  }
  /* Fortran looks no further than the first letter. */
  if (n == 0 || (lex_lower(*t) != 't' && lex_lower(*t) != 'f'))
    return refuse(nl, value, key, ".true. or .false.", errors);
  *out = lex_lower(*t) == 't';
  return 1;
}

int namelist_value_string(const namelist *nl, const namelist_value *value, const char *key,
                          char *text, size_t size, namelist_errors *errors)
{
  const char *t = nl->text + value->begin;
  size_t used = 0, first = 1, end = value->length - 1;
  const int bare = value->form == NAMELIST_BARE && nl->order > 0;
  if (value->form != NAMELIST_STRING && !bare)
    return refuse(nl, value, key, "a string in quotes", errors);
  if (bare) {
    first = 0;
    end = value->length;
  }
  for (size_t i = first; i < end; i++) {
    if (t[i] == '\n' || (t[i] == '\r' && t[i + 1] == '\n')) continue; /* record ends vanish */
    if (used + 1 >= size) {
      namelist_error_at(nl, value->at, errors,
                        "'%s': this string is too long (at most %zu bytes)", key, size - 1);
      return 0;
    }
    text[used++] = t[i];
    if (!bare && t[i] == t[0]) i++; /* of a doubled quote the second is skipped */
  }
  text[used] = '\0';
  return 1;
}

/* ---- arrays -------------------------------------------------------------------------------- */

/* An array that is being filled. */
typedef struct filling {
  namelist_array *array;
  size_t capacity;
  long next; /* element, from 1 on */
} filling;

/* Make room for element n; those before it that are not given stay NULL. */
static int reach(filling *f, size_t n)
{
  namelist_array *array = f->array;
  if (!grow_to(&array->item, n, &f->capacity, sizeof *array->item)) return 0;
  if (array->count < n) array->count = n;
  return 1;
}

/* Put one value, as often as it is repeated, from the next element on. 0: out of memory. */
static int place(const namelist *nl, const namelist_assignment *a, const namelist_value *v,
                 filling *f, namelist_errors *errors)
{
  namelist_array *out = f->array;
  for (int i = 0; i < v->repeat; i++, f->next += a->step) {
    const char *problem = NULL;
    if (a->subscripted && a->last != 0 &&
        (a->step > 0 ? f->next > a->last : f->next < a->last))
      problem = "more values than the subscript selects";
    else if (f->next > NAMELIST_MAX_VALUES)
      problem = "more than a million elements";
    else if (v->form != NAMELIST_NULL && (size_t)f->next <= out->count &&
             out->item[f->next - 1] != NULL)
      problem = "an element is given twice";
    if (problem != NULL) {
      namelist_error_at(nl, v->at, errors, "'%s': %s", a->name, problem);
      out->broken = 1;
      return 1;
    }
    if (v->form == NAMELIST_NULL) continue;
    if (!reach(f, (size_t)f->next)) return 0;
    out->item[f->next - 1] = v;
  }
  return 1;
}

pendres_status namelist_array_get(const namelist *nl, const namelist_group *group, const char *name,
                                  namelist_array *out, namelist_errors *errors)
{
  filling f = { .array = out };
  *out = (namelist_array){ 0 };
  for (size_t i = 0; i < group->count; i++) {
    const namelist_assignment *a = &nl->assignment[group->begin + i];
    if (strcmp(a->name, name) != 0) continue;
    f.next = a->subscripted ? a->first : 1;
    if (!out->given) out->at = a->at;
    out->given = 1;
    if (a->broken) out->broken = 1;
    for (size_t k = 0; k < a->count && !out->broken; k++) {
      if (place(nl, a, &nl->value[a->begin + k], &f, errors)) continue;
      errors->out_of_memory = 1;
      return PENDRES_OUT_OF_MEMORY;
    }
  }
  return out->broken ? PENDRES_INVALID_ARGUMENT : PENDRES_OK;
}

void namelist_array_free(namelist_array *array)
{
  if (array == NULL) return;
  free(array->item);
  *array = (namelist_array){ 0 };
}
