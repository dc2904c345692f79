/* decimal.c -- numbers as short as they may be; see table.h. */
#include "deck/table.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/*
 * Every decimal of 15 digits survives the way to a double and back, so if x came from such a one,
 * 15 digits print it, without the zeros at its end. Numbers below DBL_MIN have fewer digits.
 */
const char *deck_decimal(double x, char text[DECK_DECIMAL])
{
  for (int digits = fabs(x) < DBL_MIN ? 1 : DBL_DIG; digits <= DBL_DECIMAL_DIG; digits++) {
    snprintf(text, DECK_DECIMAL, "%.*g", digits, x);
    if (strtod(text, NULL) == x) break;
  }
  if (strpbrk(text, ".en") == NULL) strcat(text, ".0");
  return text;
}
