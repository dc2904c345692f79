/*
 * parse.c -- a formula's text; see formula.h and <pendres/formula.h>.
 *
 * sum: product { (+|-) product };  product: sign { (*|/) sign };  sign: { +|- } power;
 * power: atom [ (^|**) sign ];  atom: number, name, name ( sum ), ( sum ).
 */
#include "model/formula/formula.h"

#include <ctype.h>
#include <locale.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 60 /* parentheses within parentheses, and signs before signs */ };

typedef struct parser {
  const char *text, *at;
  formula_tree *t;
  char *canonical; /* what was read, without blanks */
  pendres_formula_error *error;
  int depth, failed;
} parser;

static const struct {
  const char *name;
  formula_kind kind;
} functions[] = {{"sin", FORMULA_SIN},   {"cos", FORMULA_COS},   {"exp", FORMULA_EXP},
                 {"log", FORMULA_LOG},   {"tanh", FORMULA_TANH}, {"atan", FORMULA_ATAN},
                 {"sqrt", FORMULA_SQRT}, {"abs", FORMULA_ABS},   {"sign", FORMULA_SIGN},
                 {"tan", FORMULA_DIVIDE} /* of sine and cosine */};
enum { FUNCTIONS = sizeof functions / sizeof functions[0] };

/* What other programs call it. */
static const char *const aliases[][2] = {
  {"ln", "log"},    {"fabs", "abs"},   {"arctan", "atan"}, {"sgn", "sign"}, {"t", "phase"},
  {"theta", "phase"}, {"y", "x"},   {"phi", "x"},       {"q", "x"},
  {"xdot", "v"},    {"dx", "v"},       {"Pi", "pi"},       {"PI", "pi"},    {"X", "x"}};

static int fail(parser *p, const char *from, size_t length, const char *instead,
                const char *format, ...)
{
  if (p->failed) return FORMULA_NONE;
  p->failed = 1;
  va_list words;
  va_start(words, format);
  (void)vsnprintf(p->error->message, sizeof p->error->message, format, words);
  va_end(words);
  p->error->at = (int)(from - p->text);
  p->error->length = (int)length;
  (void)snprintf(p->error->instead, sizeof p->error->instead, "%s", instead);
  return FORMULA_NONE;
}

/* Go on behind what was read, which is kept as `form` in the standard text. */
static void accept(parser *p, size_t length, const char *form)
{
  strcat(p->canonical, form);
  for (p->at += length; isspace((unsigned char)*p->at);) p->at++;
}

static int take(parser *p, char c)
{
  const char form[2] = {c, '\0'};
  if (*p->at != c) return 0;
  accept(p, 1, form);
  return 1;
}

static int parse_sum(parser *p);

static size_t letters(const char *s)
{
  size_t n = 0;
  while (isalnum((unsigned char)s[n]) || s[n] == '_') n++;
  return n;
}

/* ---- names ---- */

static int same(const char *name, size_t n, const char *other)
{
  return strlen(other) == n && strncmp(name, other, n) == 0;
}

/* Letters that differ, of words of the same length or with one letter more or less. */
static int unlike(const char *name, size_t n, const char *other)
{
  const size_t m = strlen(other);
  size_t head = 0, tail = 0;
  while (head < n && head < m && name[head] == other[head]) head++;
  while (tail < n - head && tail < m - head && name[n - 1 - tail] == other[m - 1 - tail]) tail++;
  const size_t left = n - head - tail, right = m - head - tail;
  return (int)(left > right ? left : right);
}

static const char *meant(const char *name, size_t n)
{
  for (size_t i = 0; i < sizeof aliases / sizeof aliases[0]; i++)
    if (same(name, n, aliases[i][0])) return aliases[i][1];
  for (int i = 0; i < FUNCTIONS; i++) {
    const int off = unlike(name, n, functions[i].name);
    if (off == 1 || (off == 2 && n == strlen(functions[i].name) && n > 2))
      return functions[i].name;
  }
  return "";
}

static int parse_call(parser *p, const char *name, size_t n, formula_kind kind)
{
  if (!take(p, '('))
    return fail(p, p->at, 0, "(", "'%.*s' is a function: its argument in parentheses is missing",
                (int)n, name);
  const int a = parse_sum(p);
  if (p->failed) return FORMULA_NONE;
  if (*p->at == ',') return fail(p, p->at, 1, "", "'%.*s' has one argument", (int)n, name);
  if (!take(p, ')')) return fail(p, p->at, *p->at != '\0', ")", "a ')' is missing");
  if (kind != FORMULA_DIVIDE) return pendres_formula_one(p->t, kind, a);
  return pendres_formula_two(p->t, kind, pendres_formula_one(p->t, FORMULA_SIN, a),
                     pendres_formula_one(p->t, FORMULA_COS, a));
}

static int parse_name(parser *p)
{
  const char *name = p->at;
  const size_t n = letters(name);
  char form[32];
  (void)snprintf(form, sizeof form, "%.*s", (int)n, name);
  for (int i = 0; i < FUNCTIONS; i++)
    if (same(name, n, functions[i].name)) {
      accept(p, n, form);
      return parse_call(p, name, n, functions[i].kind);
    }
  int node = FORMULA_NONE;
  if (same(name, n, "x")) node = pendres_formula_leaf(p->t, FORMULA_X, 0);
  else if (same(name, n, "pi")) node = pendres_formula_constant(p->t, PENDRES_PI);
  else if (n == 2 && name[0] == 'a' && name[1] >= '1' &&
           name[1] < '1' + PENDRES_FORCE_POWERS)
    node = pendres_formula_leaf(p->t, FORMULA_COEFFICIENT, name[1] - '1');
  else if (same(name, n, "v"))
    return fail(p, name, n, "", "a formula may not depend on the velocity yet");
  else if (same(name, n, "phase"))
    return fail(p, name, n, "", "a formula may not depend on the phase of the drive yet");
  else if (n > 1 && name[0] == 'a' && strspn(name + 1, "0123456789") == n - 1)
    return fail(p, name, n, "", "there are coefficients a1 to a%d", PENDRES_FORCE_POWERS);
  else
    return fail(p, name, n, meant(name, n), "'%.*s' is no name that formulas have",
                (int)(n < 40 ? n : 40), name);
  accept(p, n, form);
  return node;
}

/* ---- numbers and the rest ---- */

/* A number's characters; 0: it is none. */
static size_t digits(const char *s)
{
  const size_t whole = strspn(s, "0123456789"), point = s[whole] == '.';
  const size_t part = point ? strspn(s + whole + 1, "0123456789") : 0;
  size_t n = whole + point + part;
  if (whole + part == 0) return 0;
  if (strchr("eEdD", s[n]) != NULL && s[n] != '\0') {
    const size_t sign = s[n + 1] == '+' || s[n + 1] == '-';
    const size_t power = strspn(s + n + 1 + sign, "0123456789");
    if (power > 0) n += 1 + sign + power;
  }
  return n;
}

static int parse_number(parser *p, size_t n)
{
  char form[FORMULA_LONGEST + 1];
  const char *from = p->at, *point = localeconv()->decimal_point;
  (void)snprintf(form, sizeof form, "%.*s", (int)n, from);
  for (char *c = form; *c != '\0'; c++)
    if (strchr("EdD", *c) != NULL) *c = 'e';
  char local[FORMULA_LONGEST + 16], *dot;
  (void)snprintf(local, sizeof local, "%s", form);
  dot = strchr(local, '.');
  if (dot != NULL && strcmp(point, ".") != 0) {
    (void)snprintf(dot, sizeof local - (size_t)(dot - local), "%s%s", point,
                   form + (dot - local) + 1);
  }
  const double value = strtod(local, NULL);
  if (!isfinite(value)) return fail(p, from, n, "", "this number is too large");
  accept(p, n, form);
  if (isalpha((unsigned char)*p->at) || *p->at == '(')
    return fail(p, from, (size_t)(p->at - from) + 1, "", "a '*' is missing before '%c'", *p->at);
  return pendres_formula_constant(p->t, value);
}

static int parse_atom(parser *p)
{
  const size_t number = digits(p->at);
  if (number > 0) return parse_number(p, number);
  if (isalpha((unsigned char)*p->at)) return parse_name(p);
  if (take(p, '(')) {
    const int inside = parse_sum(p);
    if (p->failed) return FORMULA_NONE;
    return take(p, ')') ? inside : fail(p, p->at, *p->at != '\0', ")", "a ')' is missing");
  }
  if (*p->at == '\0') return fail(p, p->at, 0, "", "the formula ends where a value is wanted");
  const unsigned char c = (unsigned char)*p->at;
  if (!isprint(c)) return fail(p, p->at, 1, "", "a character that no formula has");
  return fail(p, p->at, 1, "", "'%c' stands where a value is wanted", c);
}

static int parse_sign(parser *p);

static int parse_power(parser *p)
{
  const int base = parse_atom(p);
  const size_t n = *p->at == '^' ? 1 : p->at[0] == '*' && p->at[1] == '*' ? 2 : 0;
  if (p->failed || n == 0) return base;
  accept(p, n, "^");
  return pendres_formula_power(p->t, base, parse_sign(p));
}

static int parse_sign(parser *p)
{
  if (p->depth == DEEPEST) return fail(p, p->at, 1, "", "this formula is nested too deeply");
  p->depth++;
  int node;
  if (take(p, '-')) node = pendres_formula_one(p->t, FORMULA_NEGATIVE, parse_sign(p));
  else node = take(p, '+') ? parse_sign(p) : parse_power(p);
  p->depth--;
  return node;
}

static int parse_product(parser *p)
{
  int node = parse_sign(p);
  while (!p->failed) {
    if (take(p, '*')) node = pendres_formula_two(p->t, FORMULA_MULTIPLY, node, parse_sign(p));
    else if (take(p, '/')) node = pendres_formula_two(p->t, FORMULA_DIVIDE, node, parse_sign(p));
    else break;
  }
  return node;
}

static int parse_sum(parser *p)
{
  int node = parse_product(p);
  while (!p->failed) {
    const char sign = *p->at;
    if (!take(p, '+') && !take(p, '-')) break;
    node = pendres_formula_two(p->t, sign == '+' ? FORMULA_ADD : FORMULA_SUBTRACT, node,
                               parse_product(p));
  }
  return node;
}

int pendres_formula_parse(const char *text, formula_tree *t, char *canonical,
                  pendres_formula_error *error)
{
  parser p = {.text = text, .at = text, .t = t, .canonical = canonical, .error = error};
  canonical[0] = '\0';
  if (strlen(text) > FORMULA_LONGEST)
    return fail(&p, text + FORMULA_LONGEST, 1, "", "a formula has %d characters at most",
                FORMULA_LONGEST);
  accept(&p, 0, "");
  const int node = parse_sum(&p);
  if (!p.failed && *p.at == ')') return fail(&p, p.at, 1, "", "there is no '(' to this ')'");
  if (!p.failed && *p.at == '=')
    return fail(&p, p.at, 1, "", "a formula is the force alone, without '='");
  if (!p.failed && *p.at != '\0')
    return fail(&p, p.at, 1, "", "an operator is missing: + - * / or ^");
  if (!p.failed && node < 0) return fail(&p, text, strlen(text), "", "this formula is too long");
  return p.failed ? FORMULA_NONE : node;
}
