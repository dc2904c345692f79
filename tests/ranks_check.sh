#!/bin/sh
# ranks_check.sh -- the program over MPI: the same bytes of all kinds of scenes (tests/kinds) from 1,
# 2 and 4 ranks of one thread and of two, a point that a budget ends in any of them is told and
# computed later, a rank that is killed, or all of them, cost what was under way and no more, a rank
# without memory holds nobody up, and a program without MPI refuses to be started several times.
# Skipped where there is no MPI, or no h5py to compare with.
set -u
launcher=$(command -v mpirun) && command -v mpicc >/dev/null ||
  { echo "no MPI: make deps-mpi"; exit 77; }
python=${PYTHON:-/usr/bin/python3}
"$python" -c 'import h5py' 2>/dev/null ||
  { echo "no Python with h5py: make deps-plots"; exit 77; }
${MAKE:-make} -s "$BUILD/resonance-mpi" || exit 1
# What is started from here on is nothing of make's: a process that stays must not hold its job
# server, at whose end make would wait for it.
exec 3>&- 4>&-
# Open MPI's launcher may never end, and not heed SIGTERM either, when its ranks were killed while
# they were starting (4.1.4 with PMIx 4.2.2: it waits for itself in PMIx_server_finalize).
mpirun="timeout -s KILL 100 $launcher"
program=$PWD/$BUILD/resonance-mpi
case $BUILD in /*) program=$BUILD/resonance-mpi ;; esac
top=$PWD
same=$PWD/tests/same_bytes.py
kinds=$PWD/tests/kinds
OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
export OMPI_ALLOW_RUN_AS_ROOT OMPI_ALLOW_RUN_AS_ROOT_CONFIRM OMPI_MCA_rmaps_base_oversubscribe
PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe # the same for Open MPI 5
export PRTE_MCA_rmaps_default_mapping_policy

work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failed=0
complain()
{
  echo "ranks_check: $*"
  failed=1
}

# ranks_of PID: the ranks of a $mpirun in the background.
ranks_of()
{
  pgrep -P "$(pgrep -P "$1")"
}

# All kinds, in one run each.
mkdir whole ranks
for kind in $("$RESONANCE" --list | cut -d' ' -f1); do
  [ "$kind" = work_precision ] || grep -q "kind = '$kind'" "$kinds"/*.nml || # times: never the same
    complain "tests/kinds has no deck of kind $kind"
done
(cd whole && "$RESONANCE" -q "$kinds"/*.nml >table.txt 2>err.txt)
[ $? -eq 3 ] || { complain "without MPI:"; cat whole/err.txt; } # a response has points that fail
for shape in "1 2" "2 1" "2 2" "4 1" "4 2"; do
  ranks=${shape% *} threads=${shape#* }
  (cd ranks && rm -f ./* && timeout -s KILL 300 "$launcher" -n $ranks "$program" -q -t$threads \
    "$kinds"/*.nml >table.txt 2>err.txt)
  [ $? -eq 3 ] || { complain "$ranks ranks x $threads threads:"; cat ranks/err.txt; }
  cmp -s whole/table.txt ranks/table.txt || complain "other tables on $ranks ranks x $threads"
  "$python" "$same" whole ranks >same.txt ||
    { complain "$ranks ranks x $threads threads:"; grep -v ': same, ' same.txt; }
done

# All points have no time at all; then those that were given up are computed, and nothing else.
$mpirun -n 2 "$program" -t1 --budget=1e-9 -o budget.h5 "$kinds/curve.nml" >out.txt 2>err.txt
[ $? -eq 3 ] || complain "a budget of nothing is enough"
grep -q "4 points were ended by --budget" err.txt || { complain "not told of a budget"; cat err.txt; }
$mpirun -n 2 "$program" -q -t1 --resume -o budget.h5 "$kinds/curve.nml" >out.txt 2>err.txt
"$python" "$same" whole/curve.h5 budget.h5 >same.txt || { complain "after a budget"; cat same.txt; }

# One of four ranks is killed as soon as some tasks are done (if the run has not ended by then): the
# run ends, and what was finished is gone on from, to the same bytes.
cat >killed.nml <<'DECK'
&scene kind = 'response' /
&pendulum drive_amplitude = 0.2 /
&sweep damping = 0.24, 0.3, 0.5, drive_period_range = 6, 8, 100 /
&ensemble members = 40 /
DECK
"$RESONANCE" -q -o whole.h5 killed.nml >table.txt || complain "killed fails without MPI"
$mpirun -n 4 "$program" -q -t1 -o killed.h5 killed.nml >out.txt 2>err.txt &
running=$!
until [ -e killed.h5.journal ] && [ "$(wc -c <killed.h5.journal)" -gt 20000 ]; do
  kill -0 $running 2>/dev/null || break
  sleep 0.02
done
one=$(ranks_of $running | tail -n 1)
[ -z "$one" ] || kill -9 "$one" 2>/dev/null
wait $running
code=$?
if [ $code -ne 0 ]; then
  [ ! -e killed.h5 ] || complain "a run that lost a rank left results"
  [ -s killed.h5.journal ] || complain "a run that lost a rank left no journal"
fi
$mpirun -n 2 "$program" -t1 -f --resume -o killed.h5 killed.nml >ranks.txt 2>err.txt ||
  { complain "no resuming after a lost rank"; cat err.txt; }
[ $code -eq 0 ] || grep -q "going on from" err.txt || complain "nothing was kept of a lost rank's run"
"$python" "$same" whole.h5 killed.h5 >same.txt || { complain "after a lost rank"; cat same.txt; }

# All four at once, time and again, each time after some more tasks and a part of one. Nothing of
# them stays in the folder for what does not last.
mkdir passing
for kept in 1 20000 45000 70000; do
  $mpirun -n 4 env TMPDIR="$work/passing" "$program" -q -t1 --resume -o all.h5 killed.nml >out.txt 2>err.txt &
  running=$!
  until [ -e all.h5.journal ] && [ "$(wc -c <all.h5.journal)" -gt $kept ]; do
    kill -0 $running 2>/dev/null || break
    sleep 0.01
  done
  sleep "$(awk 'BEGIN { srand(); print 0.05 * rand() }')"
  kill -9 $(ranks_of $running) 2>/dev/null
  wait $running
  [ -e all.h5 ] || [ -s all.h5.journal ] || complain "nothing is left of killed ranks"
done
$mpirun -n 4 "$program" -t1 -f --resume -o all.h5 killed.nml >ranks.txt 2>err.txt ||
  { complain "no resuming after all ranks were killed"; cat err.txt; }
"$python" "$same" whole.h5 all.h5 >same.txt || { complain "after killed ranks"; cat same.txt; }
[ "$(echo all.h5*)" = all.h5 ] || complain "killed ranks leave $(echo all.h5*)"
[ -z "$(ls -A passing)" ] || complain "killed ranks leave $(ls -A passing) in TMPDIR"

# Two decks, stopped at the first: no rank waits for the others at the second.
$mpirun -n 2 "$program" -q -t1 -f killed.nml "$kinds/curve.nml" >out.txt 2>err.txt &
running=$!
until [ -s killed.h5.journal ]; do
  kill -0 $running 2>/dev/null || break
  sleep 0.02
done
kill -TERM $(ranks_of $running) 2>/dev/null
wait $running
code=$?
[ $code -eq 75 ] || [ $code -eq 0 ] || { complain "two decks, stopped: $code"; cat err.txt; }

# Rank 1 without memory, at allocations before the decks, when the run is set up and when its stages
# are: all end, and results are whole where that is said.
cat >poor.nml <<'DECK'
&scene kind = 'branches' /
&pendulum drive_amplitude = 0.2 /
&sweep damping = 0.13, 0.15, drive_frequency_range = 0.7, 0.9, 80 /
&ensemble members = 40 /
DECK
"${CC:-gcc}" -shared -fPIC -o faults.so "$top/tests/faults_preload.c" -ldl 2>/dev/null && at=2 || at=
"$RESONANCE" -q -o whole.h5 poor.nml >table.txt || complain "poor fails without MPI"
# One command for all ranks asks the least of a launcher.
cat >rank.sh <<'SCRIPT'
[ "${OMPI_COMM_WORLD_RANK:-${PMI_RANK:-0}}" = 0 ] && exec "$2" -q -t1 -f -o poor.h5 poor.nml
FAULT_CALL=malloc FAULT_AT=$1 FAULT_BY='' LD_PRELOAD=$PWD/faults.so exec "$2" -q -t1 -f poor.nml
SCRIPT
for at in ${at:+2 20 46 54 60 66 72}; do
  $mpirun -n 2 sh rank.sh "$at" "$program" >out.txt 2>err.txt
  code=$?
  case $code in
  0) "$python" "$same" whole.h5 poor.h5 >same.txt || { complain "rank 1, $at"; cat same.txt; } ;;
  1) grep -q "resonance: error: " err.txt || complain "rank 1 without memory at $at: no message" ;;
  *) complain "rank 1 without memory at $at: $code"; cat err.txt ;;
  esac
done

# What rank 0 refuses ends all; a program without MPI does not start the same run twice.
echo "&scene kind = 'nothing' /" >bad.nml
$mpirun -n 2 "$program" bad.nml >bad.txt 2>&1
grep -c "nothing" bad.txt | grep -qx 2 || complain "a bad deck is told otherwise than once"
$mpirun -n 2 "$RESONANCE" "$kinds/curve.nml" >alone.txt 2>&1 && complain "two single runs went on"
grep -q "built without MPI" alone.txt || complain "two single runs are not told apart"
exit $failed
