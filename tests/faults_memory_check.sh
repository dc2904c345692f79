#!/bin/sh
# faults_memory_check.sh -- memory that is refused, allocation by allocation, of every kind of scene
# (the decks in tests/kinds). Whichever it is, the program ends with a message, or with the results
# of a run that got all of it; nothing is left beside them but a journal. Of each place that asks for
# memory, which is told by the last two of the program's functions, one allocation is refused: some
# 900. FAULTS=6 takes the last six (make faults), FAULTS=all refuses each to the last, which
# takes hours: DECKS='hysteresis fit' tries these alone.
# Run by make check and make faults, which set BUILD, CC and RESONANCE.
set -u
[ -n "${RESONANCE:-}" ] || { echo "no program resonance"; exit 77; }
top=$(cd "$(dirname "$0")/.." && pwd)
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
preload=$scratch/faults.so
"${CC:-gcc}" -shared -fPIC -o "$preload" "$top/tests/faults_preload.c" -ldl 2>/dev/null ||
  { echo "no C library of GNU, which can be preloaded"; exit 77; }
cp -r "$top/tests/kinds" "$top/input" "$scratch" && cd "$scratch" || exit 1
mkdir work tmp tests || exit 1
mv kinds tests && cd work || exit 1
TMPDIR=$scratch/tmp
export TMPDIR
bad=0 tried=0

fail()
{
  echo "$*"
  sed 's/^/  /' err
  bad=$((bad + 1))
}

# run NUMBER BY DECK SETTING...: with that allocation refused.
run()
{
  at=$1
  by=$2
  shift 2
  rm -f ./*.h5* ./*.csv log err out
  tried=$((tried + 1))
  timeout 60 env FAULT_CALL=malloc FAULT_AT="$at" FAULT_BY="$by" LD_PRELOAD="$preload" \
    "$RESONANCE" -q -t 1 -o o.h5 "$@" >out 2>err
  code=$?
  why="allocation $at of '$by', $*: "
  case $code in
  0 | 3)
    # A method that fails in a hard case, for whatever reason, is a figure of that case.
    [ "$name $code" = "hard 3" ] || { cmp -s out ../out && [ $code -eq "$usual" ]; } ||
      fail "$why other results"
    [ -f o.h5 ] || fail "$why no output" ;;
  1) grep -q 'error: .*[a-z]' err || fail "$why no message"
    grep -q 'has crashed\|ended the program' err && [ -z "$by" ] && fail "$why a crash"
    [ ! -f o.h5 ] || grep -q 'are whole in\|cannot save the folder\|no text .*is written' err ||
      fail "$why an output of a failed run" ;;
  2) grep -q 'cannot read the deck: \|out of memory' err || fail "$why exit code 2" ;;
  *) fail "$why exit code $code" ;;
  esac
  left=$(ls -A . ../tmp | grep -v '^\(o\.h5\|o\.h5\.journal\|o\.csv\|log\|out\|err\|\.:\|\.\./tmp:\|\)$')
  [ -z "$left" ] || fail "$why left behind: $left"
  rm -f ../tmp/*
}

# What a deck asks for: of each place that was not tried before, the first.
places()
{
  by=$1
  shift
  rm -f ./*.h5* ./*.csv
  FAULT_CALL=malloc FAULT_AT=0 FAULT_BY=$by FAULT_LIST=../list FAULT_DEPTH="$depth" \
    LD_PRELOAD=$preload "$RESONANCE" -q -t 1 -o o.h5 "$@" >../out 2>err
  usual=$?
  [ $usual -eq 0 ] || [ $usual -eq 3 ] || { fail "$*: a run without faults"; return; }
  if [ "${FAULTS:-2}" = all ]; then cut -d' ' -f1 ../list
  else
    awk -v by="$by" 'BEGIN { while ((getline key < "../seen") > 0) seen[key] = 1 }
         { key = by " " $2 }
         !(key in seen) { seen[key] = 1; print $1; print key >> "../seen" }' ../list
  fi
}

depth=${FAULTS:-2}
[ "$depth" != all ] || depth=1
: >../seen
for deck in "$scratch"/tests/kinds/*.nml; do
  name=$(basename "$deck" .nml)
  case " ${DECKS:-$name} " in *" $name "*) ;; *) continue ;; esac
  set -- "$deck"
  [ "$name" != curve ] || set -- --csv --log=log "$deck" # a log, and the results as text
  for by in '' libgsl libsundials libhdf5 libc.so; do
    places "$by" "$@" >../which
    while read -r at; do run "$at" "$by" "$@"; done <../which
  done
done
echo "$tried refused"
[ $bad -eq 0 ]
