#!/bin/sh
# faults_check.sh -- what the system refuses, call by call: writing, syncing, renaming, opening
# (memory: faults_memory_check.sh); a full disk, a folder that cannot be written, a clock that runs
# backwards, a deck of many megabytes; locks that are denied, and outputs that are open elsewhere.
# Whatever fails, the program ends with 0 or 1 and a message, an output is whole or not there, and
# the same command with --resume then ends well.
# Run by make check, which sets BUILD, CC and RESONANCE.
set -u
[ -n "${RESONANCE:-}" ] || { echo "no program resonance"; exit 77; }
scratch=$(mktemp -d) || exit 1
trap 'umount "$scratch/small" 2>/dev/null; rm -rf "$scratch"' EXIT
preload=$scratch/faults.so
# Names of glibc's own: elsewhere there is nothing to be preloaded.
"${CC:-gcc}" -shared -fPIC -o "$preload" tests/faults_preload.c -ldl 2>/dev/null ||
  { echo "no C library of GNU, which can be preloaded"; exit 77; }
cd "$scratch" || exit 1

cat >d.nml <<'DECK'
&scene kind = 'response' /
&pendulum drive_amplitude = 0.2 /
&sweep damping = 0.24, drive_period = 8 /
&ensemble members = 4 /
DECK

fail()
{
  echo "faults_check: $*"
  sed 's/^/  /' err
  exit 1
}

csv= # or --csv
# run CALL NUMBER [BY]: with that occurrence of the call failing; its exit code is in $code.
run()
{
  rm -f d.h5* d.csv*
  FAULT_CALL=$1 FAULT_AT=$2 FAULT_BY=${3:-} LD_PRELOAD=$preload "$RESONANCE" -q -t 1 $csv d.nml \
    >out 2>err
  code=$?
  case $code in
  0) [ -f d.h5 ] || fail "$*: no output" ;;
  1) grep -q '[a-z]' err || fail "$*: no message" ;;
  2) grep -q 'cannot read the deck: ' err || fail "$*: exit code 2" ;;
  *) fail "$*: exit code $code" ;;
  esac
  [ ! -f d.h5.part ] || grep -q 'results are whole in' err || fail "$*: a part is left"
  [ ! -f d.csv.part ] || fail "$*: the part of a table is left"
}

# How many of a call there are, in $count.
count()
{
  FAULT_CALL=$1 FAULT_AT=0 FAULT_BY=${2:-} FAULT_COUNT=count LD_PRELOAD=$preload \
    "$RESONANCE" -q -t 1 $csv d.nml >out 2>err || fail "$*: a run without faults"
  count=$(cat count)
  [ "$count" -gt 0 ] || fail "$*: never called"
}

# run_without_locks flock|off ARGUMENT...: locks fail, or are switched off.
run_without_locks()
{
  how=$1
  shift
  case $how in
  off) HDF5_USE_FILE_LOCKING=FALSE "$RESONANCE" "$@" >out 2>err ;;
  *) FAULT_CALL=flock FAULT_AT=1 LD_PRELOAD=$preload "$RESONANCE" "$@" >out 2>err ;;
  esac
}

# One call in so many, such that about twelve of each kind are tried; all where that is asked for.
some=${FAULTS:-12}
: >err
for call in write fsync rename open; do
  count $call
  at=1
  while [ "$at" -le "$count" ]; do
    run $call "$at"
    if [ "$at" -eq 1 ]; then
      "$RESONANCE" -q -t 1 --resume d.nml >out 2>err || fail "$call $at: no resuming"
      "$RESONANCE" --verify d.h5 >out 2>err || fail "$call $at: damaged"
    fi
    at=$((at + 1 + count / some))
  done
done
# The program's own memory, and what libraries ask for: they follow null pointers here and there,
# HDF5 with every name that it copies by libc's strdup().
for by in '' libgsl libsundials libhdf5 libc.so; do
  count malloc "$by"
  at=1
  while [ "$at" -le "$count" ]; do
    run malloc "$at" "$by"
    at=$((at + 1 + count / some))
  done
done

# The table beside them, for which HDF5 is asked once more: neither it nor its part is left half done.
for by in '' libhdf5; do
  csv=
  count malloc "$by"
  at=$count
  csv=--csv
  count malloc "$by"
  step=$((1 + (count - at) / some / 5))
  while [ "$at" -le "$count" ]; do
    run malloc "$at" "$by"
    [ -f d.h5 ] || fail "malloc $at $by, with a table: the results are lost"
    at=$((at + step))
  done
done
csv=

run clock 3
[ "$code" -eq 0 ] || fail "a clock that runs backwards"

# Locks are denied, as on some network disks, or switched off by HDF5's own variable: a run does
# without, and what has to read its output says so. What was there before is another deck's for all
# one knows, and is kept.
for denied in flock off; do
  rm -f d.h5*
  for again in 1 2; do
    run_without_locks $denied -q -t 1 d.nml || fail "locks ($denied), run $again"
  done
  cp d.h5 kept.h5
  run_without_locks $denied --verify d.h5
  told=$?
  if [ $denied = off ]; then
    [ $told -eq 0 ] || fail "locks are off: no verifying"
  else
    [ $told -eq 1 ] || fail "locks are denied: not told"
    grep -q 'cannot be locked: .*HDF5_USE_FILE_LOCKING' out || fail "locks are denied: other words"
    "$RESONANCE" --verify d.h5 d.h5.~1~ >out 2>err || fail "locks are denied: damaged"
  fi
done

# The output is open elsewhere: for reading, in a program that goes on to see what it had opened;
# then for writing, under the lock of which HDF5 makes use, by a program that nobody takes it from.
exec 9<d.h5
"$RESONANCE" -q -t 1 d.nml ensemble.members=5 >out 2>err 9<&- || fail "an output that is read"
cmp -s kept.h5 - <&9 || fail "an output changes under its reader"
exec 9<&-
rm -f d.h5*
"$RESONANCE" -q -t 1 d.nml >out 2>err || fail "an output that is to be held"
cp d.h5 kept.h5
flock d.h5 "$RESONANCE" --verify d.h5 >out 2>err && fail "an output that is written: verified"
grep -q 'cannot be read: .* is open for writing in another process' out ||
  fail "an output that is written: other words"
flock d.h5 "$RESONANCE" -t 1 d.nml >out 2>err || fail "an output that is written elsewhere"
grep -q 'is kept as d.h5.~1~' err || fail "an output that is written elsewhere: not told"
cmp -s kept.h5 d.h5.~1~ || fail "an output that is written elsewhere is lost"
"$RESONANCE" --verify d.h5 >out 2>err || fail "an output that was written elsewhere: damaged"

# The part is being written by another run: this one says so, and leaves it alone.
: >e.h5.part
flock e.h5.part "$RESONANCE" -q -t 1 -o e.h5 d.nml >out 2>err
[ $? -eq 1 ] || fail "a part of another run: taken"
grep -q 'is being written by another process' err || fail "a part of another run: other words"
[ -e e.h5.part ] || fail "a part of another run: gone"

# A deck of a hundred megabytes (a hole in the file) is refused, without being read.
cp d.nml long.nml
truncate -s 100M long.nml
"$RESONANCE" --dump-namelist long.nml >out 2>err
[ $? -eq 2 ] || fail "a long deck is not refused"
grep -q 'the deck is larger than' err || fail "a long deck: in other words"

# A disk of 100 kilobytes, for whoever may mount one.
mkdir small
if [ "$(id -u)" -eq 0 ] && mount -t tmpfs -o size=100k tmpfs small 2>/dev/null; then
  "$RESONANCE" -q -o small/d.h5 d.nml >out 2>err || fail "a small disk"
  cp small/d.h5 before.h5
  head -c 90000 /dev/zero >small/filler 2>/dev/null
  "$RESONANCE" -o small/d.h5 d.nml >out 2>err
  [ $? -eq 1 ] || fail "a full disk: not told"
  grep -q 'only .* are free' err || fail "a full disk is not told before the run"
  cmp -s small/d.h5 before.h5 || fail "a full disk: the earlier output is lost"
  "$RESONANCE" -q --journal=small d.nml -o d.h5 >out 2>err
  [ $? -eq 1 ] || fail "a full disk for the journal: not told"
  grep -q 'cannot write the journal' err || fail "a full disk for the journal: in other words"
  mount -o remount,ro small
  "$RESONANCE" -q -o small/e.h5 d.nml >out 2>err
  [ $? -eq 1 ] || fail "a read-only disk: not told"
  grep -qi 'read-only' err || fail "a read-only disk: in other words"
fi
exit 0
