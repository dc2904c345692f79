/* paper.c -- see paper.h. */
#include "scenes/paper.h"

static const scene_column of_paper[] = {
  SCENE_COLUMN_OF(SCENE_PLAIN, scene_printed, printed, "value printed in the paper"),
  {.name = "computed", .long_name = "value of this run", .value = offsetof(scene_printed, computed),
   .error = offsetof(scene_printed, error)},
  {.name = "difference", .long_name = "computed less printed",
   .value = offsetof(scene_printed, difference), .error = offsetof(scene_printed, error)},
};

void scene_write_paper(scene_run *run, size_t n, scene_printed *values)
{
  const char **name = scene_array(run, n, sizeof *name);
  const scene_table table = {.group = "paper", .dimensions = {"quantity"}, .n = n,
                             .stride = sizeof *values, .rows = values};
  const pendres_store_spec quantity = {.group = "paper", .name = "quantity",
                                       .type = PENDRES_STORE_STRING, .long_name = "quantity"};
  if (n == 0 || name == NULL) return;
  for (size_t i = 0; i < n; i++) {
    name[i] = values[i].name;
    values[i].difference = values[i].computed - values[i].printed;
  }
  scene_put_dimension(run, &quantity, name, n);
  SCENE_WRITE(run, &table, of_paper);
}
