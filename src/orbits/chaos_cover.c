/* chaos_cover.c -- cells that a chaotic attractor visits; see chaos_cover.h. */
#include "orbits/chaos_cover.h"

#include <math.h>

#include "base/angles.h"

static int cell_of(const pendres_cover *cover, double y, double w, int *row, int *column)
{
  const double span = cover->span > 0.0 ? cover->span : two_pi;
  const double a = y / span + 0.5, b = 0.5 * (w / cover->w_most + 1.0);
  /* Neither NaN nor what no int holds. */
  if (!(isfinite(a) && b >= 0.0 && b < 1.0)) return 0;
  if (cover->span > 0.0 && !(a >= 0.0 && a < 1.0)) return 0;
  *row = (int)floor((a - floor(a)) * PENDRES_COVER_CELLS);
  *column = (int)floor(b * PENDRES_COVER_CELLS);
  if (*row == PENDRES_COVER_CELLS) *row = 0;
  return 1;
}

int pendres_cover_holds(const pendres_cover *cover, double y, double w)
{
  int row, column;
  return cell_of(cover, y, w, &row, &column) && cover->cell[row][column];
}

void pendres_cover_add(pendres_cover *cover, double y, double w)
{
  int row, column;
  if (!cell_of(cover, y, w, &row, &column)) return;
  for (int i = -1; i <= 1; i++)
    for (int j = -1; j <= 1; j++) {
      const int r = (row + i + PENDRES_COVER_CELLS) % PENDRES_COVER_CELLS, s = column + j;
      if (s >= 0 && s < PENDRES_COVER_CELLS) cover->cell[r][s] = 1;
    }
}
