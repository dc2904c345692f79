#!/bin/sh
# same_bytes.sh [REVISION [DECK...]] -- are the results of all decks the same bytes as before?
#
# Builds REVISION (default: the last commit, HEAD) in a temporary folder, runs the decks in input/
# with that program and with ./resonance, and compares every dataset and attribute, byte by byte.
# What must differ from run to run is left out: the group `provenance`, the root's `history`, and
# timings. Decks that only time things (workprec*) are compared only if they are named.
#
# Exit code 0: all the same; 1: something differs, or a run failed; 77: h5py is missing.
# Set THREADS to compare on another number of threads, KEEP to a folder to keep the results.
set -u
top=$(cd "$(dirname "$0")/.." && pwd) || exit 1
revision=${1:-HEAD}
[ $# -gt 0 ] && shift
python=${PYTHON:-/usr/bin/python3}
"$python" -c 'import h5py' 2>/dev/null || { echo "same_bytes.sh needs h5py" >&2; exit 77; }

work=$(mktemp -d) || exit 1
trap 'git -C "$top" worktree remove --force "$work/tree" 2>/dev/null; rm -rf "$work"' EXIT
git -C "$top" worktree add --quiet --detach "$work/tree" "$revision" || exit 1
jobs=$(nproc 2>/dev/null || echo 1)
make -C "$work/tree" -j"$jobs" >"$work/make.log" 2>&1 || { tail "$work/make.log" >&2; exit 1; }
make -C "$top" -j"$jobs" >"$work/make.log" 2>&1 || { tail "$work/make.log" >&2; exit 1; }

if [ $# -eq 0 ]; then
  for deck in "$top"/input/*.nml; do
    case $deck in */workprec*) ;; *) set -- "$@" "$deck" ;; esac
  done
fi
mkdir -p "$work/before" "${KEEP:=$work/now}"

# run PROGRAM DECK OUTPUT: with the exit code in OUTPUT.code.
run()
{
  "$1" ${THREADS:+--threads="$THREADS"} --quiet -o "$3" "$2" >"$3.log" 2>&1
  echo $? >"$3.code"
}

different=0
for deck in "$@"; do
  name=$(basename "$deck" .nml)
  run "$work/tree/resonance" "$deck" "$work/before/$name.h5"
  run "$top/resonance" "$deck" "$KEEP/$name.h5"
  if ! cmp -s "$work/before/$name.h5.code" "$KEEP/$name.h5.code"; then
    echo "$name: exit codes $(cat "$work/before/$name.h5.code") and $(cat "$KEEP/$name.h5.code")"
    different=1
  elif ! "$python" "$top/tests/same_bytes.py" "$work/before/$name.h5" "$KEEP/$name.h5"; then
    different=1
  fi
done
exit "$different"
