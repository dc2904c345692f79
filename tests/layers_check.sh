#!/bin/sh
# layers_check.sh -- who may include what: folders are layers and includes go down, through a
# folder's doors, never in a circle; one library, one place. docs/architecture.md says why.
set -u
failed=0
complain()
{
  echo "layers_check: $*"
  failed=1
}

# layers TOP: "row folder" for every folder of TOP in the picture of docs/architecture.md, rows counted
# from its head. A file includes what is in its own folder or in one of a row below.
layers()
{
  sed -n '/^## Folders are layers/,/^## The/p' docs/architecture.md | awk -F'|' -v top="$1" '
    /^```/ { inside = !inside; next }
    inside && NF > 2 {
      gsub(/ /, "")
      if ($1 != "") of = $1
      for (i = 2; i < NF; i++) if (of == top && $i != "") print NR, $i
    }'
}

# Doors: the headers of a folder that other folders may include.
src_doors='base/angles.h base/bytes.h base/grow.h base/guard.h base/instructions.h base/numbers.h base/mix.h base/sine.h base/sized.h
  base/student.h
  model/equation.h model/forces.h model/formula/formula.h model/model.h model/parameter.h model/rotation_slope.h model/units.h
  engine/kernels/coordinates.h engine/kernels/kernels.h engine/kernels/kernels_chart.h
  engine/kernels/kernels_nystrom.h engine/kernels/kernels_force.h
  engine/kernels/rank.h engine/kernels/tables.h
  engine/sundials/compat.h engine/sundials/flow_table.h engine/sundials/lanes.h
  engine/sundials/lanes_replay.h engine/sundials/lanes_shape.h engine/sundials/lanes_tape.h
  engine/accuracy.h engine/block.h engine/chain.h engine/charts.h engine/context_internal.h
  engine/door.h engine/keep.h engine/room.h engine/steps.h engine/strobe_run.h engine/threads.h
  orbits/free_force.h orbits/label.h orbits/linear.h orbits/mean.h orbits/numbers.h orbits/orbit_error.h
  orbits/orbit_measure.h orbits/orbit_newton.h orbits/orbit_pair.h orbits/orbit_prime.h orbits/orbit_same.h
  orbits/orbit_reading.h orbits/orbit_series.h orbits/orbit_span.h orbits/orbit_table.h orbits/strobe_noise.h
  settling/arrival.h settling/attractor_internal.h settling/attractor_set.h settling/settle.h
  settling/exponents/carried.h settling/exponents/growth.h settling/exponents/lyapunov_move.h
  settling/exponents/lyapunov_caught.h settling/exponents/numbers.h settling/exponents/undriven.h
  settling/exponents/unstable.h
  settling/trapping/annulus.h settling/trapping/escape.h settling/trapping/trapping_ellipse.h
  noise/langevin_internal.h noise/noise_common.h
  continuation/curve/crossing.h continuation/curve/curve.h continuation/curve/equations.h
  continuation/curve/follow.h continuation/curve/map.h continuation/curve/numbers.h
  continuation/numbers.h continuation/parameter.h continuation/part.h continuation/sets.h
  continuation/units.h
  analysis/fit_model/internal.h analysis/line/line.h analysis/resonance/response_parts.h'
drivers_doors='system/apart.h system/bytes.h system/clock.h system/ending.h system/file.h system/grow.h system/text.h terminal/progress.h terminal/safe_text.h terminal/signals.h farm/farm.h farm/journal.h farm/ranks.h
  farm/trial.h deck/deck.h deck/table.h deck/namelist/namelist.h deck/namelist/lex.h deck/si/si.h
  results/columns.h results/failed.h results/results.h results/stack.h
  scenes/along.h scenes/numbers.h scenes/outer.h scenes/points.h scenes/scene.h oracle/reference.h'

# includes TOP: "file header" for every header of TOP itself that a file of TOP includes. What stands
# beside the driver, validation, belongs to it.
includes()
{
  (cd "$1" && for file in *.[ch] */*.[ch] */*/*.[ch]; do named "$file"; done)
  [ "$1" != drivers ] || for file in validation/*.[ch]; do named "$file"; done
}

named()
{
  [ -f "$1" ] && sed -n "s|^ *# *include \"\([^\"]*\)\".*|$1 \1|p" "$1"
}

# check_folders TOP LAYERS DOORS
check_folders()
{
  includes "$1" | awk -v top="$1" -v layers="$2" -v doors="$3" '
    function folder(name) { return name ~ /\// ? substr(name, 1, match(name, /\/[^\/]*$/) - 1) : "." }
    BEGIN {
      n = split(layers, layer); for (i = 1; i < n; i += 2) row[layer[i + 1]] = layer[i]
      n = split(doors, door); for (i = 1; i <= n; i++) open[door[i]] = 1
    }
    {
      from = folder($1); to = folder($2)
      if (!(from in row)) print top "/" from " is not in the picture of docs/architecture.md"
      else if (!(to in row)) print top "/" $1 " includes " $2 ", which is nowhere"
      else if (to != from && row[to] <= row[from])
        print top "/" $1 " includes " $2 ", which is not below it"
      else if (to != from && !($2 in open)) print top "/" $1 " includes " $2 ", which is no door"
      used[$2] = used[$2] || to != from
    }
    END { for (d in open) if (!used[d]) print top "/" d " is a door that nobody uses" }'
}

# check_circles TOP: a module is NAME.c and NAME.h. tsort tells every circle.
check_circles()
{
  includes "$1" | sed 's/\.[ch] / /; s/\.h$//' | awk '$1 != $2' | sort -u |
    tsort 2>&1 >/dev/null | sed -n "s|^tsort: \(-: \)*||p"
}

for top in src drivers; do
  eval "doors=\$${top}_doors"
  found=$(check_folders "$top" "$(layers "$top")" "$doors"; check_circles "$top")
  [ -z "$found" ] || { echo "$found" | sed 's/^/layers_check: /'; failed=1; }
done
[ -z "$(ls src/*.[ch] 2>/dev/null)" ] || complain "every file of src has a folder"

# only PATTERN FILES...: includes that match the pattern stand in these files alone.
only()
{
  pattern=$1
  shift
  for file in $(grep -lE "^ *# *include *[<\"]($pattern)" src/*/*.[ch] src/*/*/*.[ch] include/pendres/*.h \
    drivers/*.[ch] drivers/*/*.[ch] drivers/*/*/*.[ch] validation/*.[ch] 2>/dev/null); do
    for allowed in "$@"; do
      case $file in $allowed) continue 2 ;; esac
    done
    complain "$file includes $pattern, which is for $* alone"
  done
}

# The shell must not expand the patterns: they are matched against names.
set -f
only 'hdf5|hdf5_hl\.h|H5F|H5D|H5S' 'src/store/*'
only 'H5public\.h' 'src/store/*' src/base/version.c
only 'arkode/|cvode/|cvodes/' 'src/engine/block*' 'src/engine/sundials/*' 'src/engine/method_*'
only 'nvector/|sunmatrix/|sunlinsol/|sunnonlinsol/' 'src/engine/method_*'
only 'sundials/' 'src/engine/block*' 'src/engine/sundials/*' 'src/engine/method_*' src/base/version.c
only '.*compat\.h' 'src/engine/block*' 'src/engine/sundials/*' 'src/engine/method_*' src/engine/context.c
only 'gsl/' 'src/*' validation/benchmark.c 'drivers/system/ending.c'
only 'mpi\.h' 'drivers/farm/*_mpi.c'
only 'omp\.h' 'drivers/*'
set +f

# Public headers lean on the language and on each other.
grep -nE '^ *# *include' include/pendres/*.h | grep -vE '<(pendres/[a-z_]+|stddef|stdint|stdio)\.h>' |
  sed 's/^/layers_check: a public header includes more than it may: /' | grep . && failed=1

exit $failed
