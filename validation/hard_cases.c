/* hard_cases.c -- the table of cases and the sheet; see hard_cases.h. */
#include "validation/hard_cases.h"
#include "system/grow.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const hard_case cases[] = {
#define HARD_CASE_ENTRY(name) { #name, hard_##name },
  DECK_CASE_LIST(HARD_CASE_ENTRY)
#undef HARD_CASE_ENTRY
};

const hard_case *hard_case_at(size_t index)
{
  return index < sizeof cases / sizeof *cases ? &cases[index] : NULL;
}

const hard_case *hard_case_find(const char *name)
{
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    if (strcmp(cases[i].name, name) == 0) return &cases[i];
  return NULL;
}

pendres_status hard_sheet_add(hard_sheet *sheet, const char *name, const char *quantity,
                              double figure, double bound, double naive)
{
  if (!grow_to(&sheet->row, sheet->count + 1, &sheet->capacity, sizeof *sheet->row))
    return hard_failed(sheet, PENDRES_OUT_OF_MEMORY, NULL);
  hard_row *row = &sheet->row[sheet->count++];
  *row = (hard_row){ .figure = figure, .bound = bound, .naive = naive };
  (void)snprintf(row->name, sizeof row->name, "%s", name);
  (void)snprintf(row->quantity, sizeof row->quantity, "%s", quantity);
  return PENDRES_OK;
}

hard_name hard_at(const char *name, double number)
{
  hard_name full;
  char digits[24];
  const int tiny = number != 0.0 && fabs(number) < 0.01;
  (void)snprintf(digits, sizeof digits, tiny ? "%.0e" : "%g", number);
  /* 1e-9, not 1e-09. */
  char *e = strchr(digits, 'e');
  if (e != NULL && e[2] == '0') memmove(e + 2, e + 3, strlen(e + 3) + 1);
  (void)snprintf(full.text, sizeof full.text, "%.16s_%.14s", name, digits);
  return full;
}

int hard_row_holds(const hard_row *row)
{
  return row->figure <= row->bound; /* not if either is NaN */
}

double hard_larger(double a, double b)
{
  return isnan(a) || a > b ? a : b;
}

double hard_over_claim(double error, double claim, double most)
{
  if (!(claim >= 0.0 && claim <= most && claim < INFINITY)) return NAN;
  if (claim == 0.0) return error == 0.0 ? 0.0 : isnan(error) ? NAN : INFINITY;
  return error / claim;
}

double hard_above_zero(double value, double error)
{
  if (isnan(value) || !(error >= 0.0)) return NAN;
  return value > 0.0 ? 4.0 * error / value : INFINITY;
}

int hard_misplaced(double distance, double claim, double most)
{
  return !(hard_over_claim(distance, claim, most) <= 10.0);
}

void hard_sheet_clear(hard_sheet *sheet)
{
  free(sheet->row);
  sheet->row = NULL;
  sheet->count = sheet->capacity = 0;
  sheet->message[0] = '\0';
}

pendres_status hard_context(hard_sheet *sheet, const pendres_options *options,
                            pendres_context **out)
{
  const char *why = pendres_options_check(options);
  const pendres_status status = pendres_context_create(options, out);
  if (status == PENDRES_OK) pendres_context_set_interrupt(*out, sheet->stop, sheet->stop_arg);
  else
    (void)snprintf(sheet->message, sizeof sheet->message, "%s",
                   why != NULL ? why : "out of memory for a context");
  return status;
}

pendres_status hard_naive_context(hard_sheet *sheet, double tolerance, pendres_context **out)
{
  const pendres_options options = { .tolerance = tolerance, .method = PENDRES_NAIVE };
  return hard_context(sheet, &options, out);
}

pendres_status hard_ways_open(hard_sheet *sheet, const pendres_options *options,
                              double naive_tolerance, hard_ways *out)
{
  *out = (hard_ways){ NULL, NULL };
  const pendres_status status = hard_context(sheet, options, &out->ours);
  if (status != PENDRES_OK) return status;
  return hard_naive_context(sheet, naive_tolerance, &out->naive);
}

void hard_ways_close(hard_ways *ways)
{
  pendres_context_free(ways->naive);
  pendres_context_free(ways->ours);
}

pendres_status hard_orbit(hard_sheet *sheet, pendres_context *ctx, const pendres_pendulum *p,
                          double x, double v, pendres_orbit *out)
{
  const pendres_orbit_guess g = { .pendulum = *p, .x = x, .v = v, .period = 1 };
  pendres_status outcome = PENDRES_OK;
  const pendres_status status =
    pendres_orbit_find(ctx, 1, &g, PENDRES_ORBIT_PLAIN, out, &outcome);
  if (status != PENDRES_OK) return hard_failed(sheet, status, ctx);
  return outcome != PENDRES_NOT_CONVERGED ? PENDRES_OK : hard_failed(sheet, outcome, NULL);
}

pendres_status hard_failed(hard_sheet *sheet, pendres_status status, const pendres_context *ctx)
{
  const char *words = ctx != NULL ? pendres_context_message(ctx) : "";
  (void)snprintf(sheet->message, sizeof sheet->message, "%s",
                 words[0] != '\0' ? words : pendres_status_message(status));
  return status;
}
