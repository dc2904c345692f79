#!/bin/sh
# layers_check.sh -- who may include what. The table in docs says why: one library, one file.
set -u
failed=0

# only PATTERN FILES...: includes that match the pattern stand in these files alone.
only()
{
  pattern=$1
  shift
  for file in $(grep -lE "^ *# *include *[<\"]($pattern)" src/*.[ch] include/pendres/*.h \
    drivers/*.[ch] 2>/dev/null); do
    for allowed in "$@"; do
      case $file in $allowed) continue 2 ;; esac
    done
    echo "layers_check: $file includes $pattern, which is for $* alone"
    failed=1
  done
}

# The shell must not expand the patterns: they are matched against names.
set -f
only 'hdf5|hdf5_hl\.h|H5F|H5D|H5S' 'src/store*'
only 'H5public\.h' 'src/store*' src/version.c
only 'arkode/|cvode/|cvodes/' 'src/flow*' src/compat.h
only 'nvector/|sunmatrix/|sunlinsol/|sunnonlinsol/' 'src/flow*'
only 'sundials/' src/compat.h 'src/flow*' 'src/lanes*' src/version.c
only 'compat\.h' 'src/flow*' src/context.c
only 'gsl/' 'src/*' 'drivers/peer_gsl*'
only 'mpi\.h' 'drivers/*_mpi.c'
only 'omp\.h' 'drivers/*'
set +f

# Public headers lean on the language and on each other.
grep -nE '^ *# *include' include/pendres/*.h | grep -vE '<(pendres/[a-z_]+|stddef|stdint|stdio)\.h>' |
  sed 's/^/layers_check: a public header includes more than it may: /' | grep . && failed=1

# Drivers see the public headers and their own.
for name in $(sed -n 's/^ *# *include "\([^"]*\)".*/\1/p' drivers/*.[ch] 2>/dev/null | sort -u); do
  [ -f "drivers/$name" ] || { echo "layers_check: drivers include $name"; failed=1; }
done
for name in $(sed -n 's/^ *# *include "\([^"]*\)".*/\1/p' src/*.[ch] | sort -u); do
  [ -f "src/$name" ] || { echo "layers_check: src includes $name"; failed=1; }
done
exit $failed
