#!/bin/sh
# faults_memory_check.sh -- memory that is refused, allocation by allocation, of every kind of scene
# (the decks in tests/kinds). Whichever it is, the program ends with a message, or with the results
# of a run that got all of it; nothing is left beside them but a journal. Of each place that asks for
# memory, which is told by the last two of the program's functions, one allocation is refused: some
# 900. FAULTS=6 takes the last six (make faults), FAULTS=all refuses each to the last, which
# takes hours: DECKS='hysteresis fit' tries these alone. So it is with a part of one (--shard), with
# --merge, and with --resume.
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
  printf '%s\n' "$said" | sed 's/^/  /'
  bad=$((bad + 1))
}

says() # PATTERN: of the shell's
{
  # shellcheck disable=SC2254 # it is a pattern
  case $said in *$1*) return 0 ;; esac
  return 1
}

# Programs that are started for it take longer than the run: hence what a shell can do by itself.
clear()
{
  rm -f ./*.h5* ./*.csv log out ../tmp/*
  [ -z "$kept" ] || cp ../kept/* .
}

# Nothing is left but results, journals and what the run was given.
check_left()
{
  for left in * .[!.]* ../tmp/*; do
    case $left in
    o.h5 | o.h5*.journal | o.csv | log | out | '*' | '.[!.]*' | '../tmp/*') ;;
    *) fail "$why left behind: $left" ;;
    esac
  done
}

# run NUMBER BY DECK SETTING...: with that allocation refused.
run()
{
  at=$1
  by=$2
  shift 2
  clear
  tried=$((tried + 1))
  said=$(ulimit -t 60 # processor seconds of this run: the script may take hours
    FAULT_CALL=malloc FAULT_AT="$at" FAULT_BY="$by" LD_PRELOAD="$preload" \
      "$RESONANCE" -q -t 1 -o o.h5 "$@" 2>&1 >out)
  code=$?
  why="allocation $at of '$by', $*: "
  case $code in
  0 | 3)
    # A method that fails in a hard case, for whatever reason, is a figure of that case.
    [ "$name $code" = "hard 3" ] || { cmp -s out ../out && [ $code -eq "$usual" ]; } ||
      fail "$why other results"
    [ -f "$result" ] || fail "$why no output" ;;
  1) says 'error: *[a-z]' || fail "$why no message"
    { says 'has crashed' || says 'ended the program'; } && [ -z "$by" ] && fail "$why a crash"
    [ ! -f o.h5 ] || says 'are whole in' || says 'cannot save the folder' ||
      says 'no text *is written' || fail "$why an output of a failed run" ;;
  2) says 'cannot read the deck: ' || says 'out of memory' || fail "$why exit code 2" ;;
  *) fail "$why exit code $code" ;;
  esac
  check_left
}

# What a deck asks for: of each place that was not tried before, the first.
places()
{
  by=$1
  shift
  clear
  said=$(FAULT_CALL=malloc FAULT_AT=0 FAULT_BY=$by FAULT_LIST=../list FAULT_DEPTH="$depth" \
    LD_PRELOAD=$preload "$RESONANCE" -q -t 1 -o o.h5 "$@" 2>&1 >../out)
  usual=$?
  [ $usual -eq 0 ] || [ $usual -eq 3 ] || { fail "$*: a run without faults"; return; }
  if [ "${FAULTS:-2}" = all ]; then cut -d' ' -f1 ../list
  else
    awk -v by="$by" 'BEGIN { while ((getline key < "../seen") > 0) seen[key] = 1 }
         { key = by " " $2 }
         !(key in seen) { seen[key] = 1; print $1; print key >> "../seen" }' ../list
  fi
}

# try OPTION... DECK: refuse all of its places.
try()
{
  for by in '' libgsl libsundials libhdf5 libc.so; do
    places "$by" "$@" >../which
    while read -r at; do run "$at" "$by" "$@"; done <../which
  done
}

# The journals that parts of a deck leave, for runs that go on from them.
keep_parts()
{
  kept=
  clear
  mkdir -p ../kept
  rm -f ../kept/*
  for part in 1 2; do "$RESONANCE" -q -t 1 -o o.h5 --shard=$part/2 "$1" >out 2>&1; done
  mv o.h5.?-of-2.journal ../kept || fail "$1: no journals of parts"
  kept=1
}

depth=${FAULTS:-2}
[ "$depth" != all ] || depth=1
: >../seen
result=o.h5 kept=
# The shortest first, of which most places are.
for name in free orbit response cascade curve_torque escape escaping refined atlas clouds tongue \
            $(cd "$scratch/tests/kinds" && ls -Sr | sed 's/\.nml$//'); do
  deck=$scratch/tests/kinds/$name.nml
  case " ${DECKS:-$name} " in *" $name "*) ;; *) continue ;; esac
  case " ${done-} " in *" $name "*) continue ;; esac
  done="${done-} $name"
  set -- "$deck"
  [ "$name" != curve ] || set -- --csv --log=log "$deck" # a log, and the results as text
  try "$@"
done

# What runs in parts, and those that go on from journals, ask for beside that.
name=${DECKS:-tongue}
name=${name%% *}
deck=$scratch/tests/kinds/$name.nml
result=o.h5.1-of-2.journal
try --shard=1/2 "$deck"
result=o.h5
keep_parts "$deck"
try --merge "$deck"
mv ../kept/o.h5.1-of-2.journal ../kept/o.h5.journal
rm -f ../kept/o.h5.2-of-2.journal
try --resume "$deck"
echo "$tried refused"
[ $bad -eq 0 ]
