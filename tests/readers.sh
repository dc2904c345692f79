#!/bin/sh
# readers.sh [FILE...] -- what readers other than HDF5's own library read of our files, one line for
# each reader: how many of the numbers are right. Not a check of `make check`, since it installs
# packages from PyPI, npm and Maven, in the versions of findings/readers/install.sh, into a temporary
# folder, or READERS. The table in docs/files.md is made from it. Without FILE a few decks are run.
# Exit code 1: a reader that was right is not, which is a fault of ours or a change of theirs.
set -u
top=$(cd "$(dirname "$0")/.." && pwd) || exit 1
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
readers=${READERS:-$work}
export READERS="$readers"
here=$top/findings
. "$here/readers/install.sh"
if [ $# -eq 0 ]; then
  run="${RESONANCE:-$top/resonance} --quiet"
  $run -o "$work/curve.h5" "$top/input/f02.nml" sweep.damping_range=0.2,0.4,5 >/dev/null || exit 1
  $run -o "$work/branches.h5" "$top/input/f09.nml" >/dev/null || exit 1
  $run -o "$work/basins.h5" "$top/input/f07.nml" sweep.x_range=-3,3,64 sweep.v_range=-2,2,64 \
    >/dev/null || exit 1
  set -- "$work/curve.h5" "$work/branches.h5" "$work/basins.h5"
fi
code=0
for file; do
  echo "$(basename "$file")"
  "$readers/venv/bin/python" "$top/findings/readers/read.py" table "$file" | tee "$work/table"
  # kerchunk's whole numbers 0 are NaN in xarray, of anybody's files: findings/readers.sh.
  grep -v '^kerchunk (xarray)' "$work/table" | grep -v -q '^.\{26\} right: [0-9]*$' && code=1
done
exit $code
