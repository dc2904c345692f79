/* hard_limits.c -- the ends of what a double can hold. */
#include "hard_cases.h"

#include <math.h>

/* tolerance: what double precision cannot give is refused, not silently missed. */
pendres_status hard_tolerance(hard_sheet *sheet)
{
  double accepted = 0.0;
  for (int k = 14; k <= 17; k++) {
    const pendres_options options = { .tolerance = pow(10.0, -k) };
    accepted += pendres_options_check(&options) == NULL;
  }
  return hard_sheet_add(sheet, "tolerance_refused", "tolerances below 1e-13 that are accepted",
                        accepted, 0.0, NAN);
}
