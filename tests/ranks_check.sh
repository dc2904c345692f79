#!/bin/sh
# ranks_check.sh -- the program over MPI: the same bytes from 1, 2 and 4 ranks of one thread and of
# two, a point that a budget ends in any of them is told and computed later, a rank that is killed
# costs what was under way and no more, and a program without MPI refuses to be started several times. Skipped where there is no MPI, or no h5py to compare with.
set -u
mpirun=$(command -v mpirun) && command -v mpicc >/dev/null || { echo "no MPI here"; exit 77; }
python=${PYTHON:-/usr/bin/python3}
"$python" -c 'import h5py' 2>/dev/null || { echo "no h5py here"; exit 77; }
${MAKE:-make} -s "$BUILD/resonance-mpi" || exit 1
program=$PWD/$BUILD/resonance-mpi
case $BUILD in /*) program=$BUILD/resonance-mpi ;; esac
same=$PWD/tests/same_bytes.py
OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
export OMPI_ALLOW_RUN_AS_ROOT OMPI_ALLOW_RUN_AS_ROOT_CONFIRM OMPI_MCA_rmaps_base_oversubscribe

work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failed=0
complain()
{
  echo "ranks_check: $*"
  failed=1
}

# A stage whose records later ones read, and one whose records are only written.
cat >lines.nml <<'DECK'
&scene kind = 'phase_diagram' /
&pendulum drive_amplitude = 0.2 /
&sweep damping_range = 0.10, 0.16, 4, drive_frequency_range = 0.7, 0.9, 4 /
&ensemble members = 8 /
DECK
cat >curve.nml <<'DECK'
&scene kind = 'resonance_curve' /
&pendulum drive_amplitude = 0.2 /
&sweep damping = 0.3, 0.5, 0.9, 1.5 /
&ensemble members = 8 /
DECK
for deck in lines curve; do
  "$RESONANCE" -q -o whole.h5 $deck.nml >table.txt || complain "$deck fails without MPI"
  for shape in "1 1" "1 2" "2 1" "2 2" "4 1"; do
    ranks=${shape% *} threads=${shape#* }
    timeout 100 "$mpirun" -n $ranks "$program" -q -t$threads -o ranks.h5 $deck.nml >ranks.txt \
      2>err.txt || { complain "$deck fails on $ranks ranks:"; cat err.txt; continue; }
    cmp -s table.txt ranks.txt || complain "another table of $deck on $ranks ranks x $threads"
    "$python" "$same" whole.h5 ranks.h5 >same.txt ||
      { complain "$deck, $ranks ranks x $threads threads"; cat same.txt; }
  done
done

# All points have no time at all; then those that were given up are computed, and nothing else.
timeout 100 "$mpirun" -n 2 "$program" -t1 --budget=1e-9 -o budget.h5 curve.nml >out.txt 2>err.txt
[ $? -eq 3 ] || complain "a budget of nothing is enough"
grep -q "4 points were ended by --budget" err.txt || { complain "not told of a budget"; cat err.txt; }
timeout 100 "$mpirun" -n 2 "$program" -q -t1 --resume -o budget.h5 curve.nml >out.txt 2>err.txt
"$python" "$same" whole.h5 budget.h5 >same.txt || { complain "after a budget"; cat same.txt; }

# One of four ranks is killed as soon as some tasks are done (if the run has not ended by then): the
# run ends, and what was finished is gone on from, to the same bytes.
cat >killed.nml <<'DECK'
&scene kind = 'response' /
&pendulum drive_amplitude = 0.2 /
&sweep damping = 0.24, 0.3, 0.5, drive_period_range = 6, 8, 100 /
&ensemble members = 40 /
DECK
"$RESONANCE" -q -o whole.h5 killed.nml >table.txt || complain "killed fails without MPI"
"$mpirun" -n 4 "$program" -q -t1 -o killed.h5 killed.nml >out.txt 2>err.txt &
launcher=$!
until [ -e killed.h5.journal ] && [ "$(wc -c <killed.h5.journal)" -gt 20000 ]; do
  kill -0 $launcher 2>/dev/null || break
  sleep 0.02
done
one=$(pgrep -P $launcher | tail -n 1)
[ -z "$one" ] || kill -9 "$one" 2>/dev/null
wait $launcher
code=$?
if [ $code -ne 0 ]; then
  [ ! -e killed.h5 ] || complain "a run that lost a rank left results"
  [ -s killed.h5.journal ] || complain "a run that lost a rank left no journal"
fi
timeout 100 "$mpirun" -n 2 "$program" -t1 -f --resume -o killed.h5 killed.nml >ranks.txt 2>err.txt ||
  { complain "no resuming after a lost rank"; cat err.txt; }
[ $code -eq 0 ] || grep -q "going on from" err.txt || complain "nothing was kept of a lost rank's run"
"$python" "$same" whole.h5 killed.h5 >same.txt || { complain "after a lost rank"; cat same.txt; }

# What rank 0 refuses ends all; a program without MPI does not start the same run twice.
echo "&scene kind = 'nothing' /" >bad.nml
timeout 100 "$mpirun" -n 2 "$program" bad.nml >bad.txt 2>&1
grep -c "nothing" bad.txt | grep -qx 2 || complain "a bad deck is told otherwise than once"
timeout 100 "$mpirun" -n 2 "$RESONANCE" curve.nml >alone.txt 2>&1 && complain "two single runs went on"
grep -q "built without MPI" alone.txt || complain "two single runs are not told apart"
exit $failed
