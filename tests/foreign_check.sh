#!/bin/sh
# foreign_check.sh -- what stands under the names that the program opens: pipes, links, hard links,
# devices, files without an end or larger than memory, files of another user, in folders where only he
# may remove them. Each is refused before anything is computed, with its name and the reason, and is
# as it was; nothing waits, nothing is left. Another user is tried where root runs this.
# Run by make check, which sets RESONANCE.
set -u
[ -n "${RESONANCE:-}" ] || { echo "no program resonance"; exit 77; }
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
data=$PWD/input/fit.csv
program=$(cd "$(dirname "$RESONANCE")" && pwd)/$(basename "$RESONANCE")
cd "$scratch" || exit 1

cat >d.nml <<'DECK'
&scene kind = 'response' /
&pendulum drive_amplitude = 0.2 /
&sweep damping = 0.24, drive_period = 8 /
&ensemble members = 4 /
DECK
cat >fit.nml <<'DECK'
&scene kind = 'fit' /
&pendulum force = 'polynomial', force_coefficients = 1, 0, 1 /
&data file = 'fit.csv'
  columns = 'frequency', 'volts', 'error', 'direction', 'drive_amplitude=drive'
  observable = 'first_harmonic_amplitude' /
&fit free = 'damping', 'frequency_scale', 'drive_scale', 'amplitude_scale', 'offset' /
DECK
cp "$data" fit.csv

fail()
{
  echo "foreign_check: $*"
  sed 's/^/  /' err
  exit 1
}

# run ARGUMENT...: its exit code is in $code; what waits for ever is ended.
run()
{
  timeout -k 5 60 "$program" -t 1 "$@" >out 2>err
  code=$?
}

# refused NAME REASON ARGUMENT...: with 1 or 2, the name and the reason, and nothing made.
refused()
{
  name=$1
  reason=$2
  shift 2
  run "$@"
  case $code in 1 | 2) ;; *) fail "$*: exit code $code instead of a refusal" ;; esac
  grep -e "$name" out err | grep -q -e "$reason" || fail "$*: no '$reason' of $name"
  [ ! -s d.h5 ] || fail "$*: computed nevertheless"
}

# ---- pipes and devices: nothing waits --------------------------------------------------------

for name in d.csv d.h5 d.h5.journal d.h5.part log pipe.nml; do
  mkfifo $name || exit 77
  case $name in
  d.csv) refused d.csv 'regular file' --csv d.nml ;;
  d.h5) refused d.h5 'regular file' --verify d.h5; refused d.h5 'regular file' d.nml ;;
  log) refused log 'regular file but a pipe' --log log d.nml ;;
  pipe.nml) refused pipe.nml 'regular file but a pipe' pipe.nml ;;
  *) refused $name 'regular file' d.nml ;;
  esac
  rm $name d.h5.journal d.h5.part 2>/dev/null
done
rm fit.csv
mkfifo fit.csv
refused fit.csv 'regular file but a pipe' fit.nml
mv fit.csv fit.h5 # as results, for a reader of HDF5
refused fit.h5 'regular file' --verify fit.h5
rm -f fit.h5*
refused /dev/zero 'regular file but a device' fit.nml data.file=/dev/zero
refused /dev/zero 'regular file but a device' /dev/zero
refused /dev/null 'regular file but a device' --log /dev/null d.nml
refused "'/'" 'regular file but a folder' fit.nml data.file=/

# ---- data: whole or not at all ----------------------------------------------------------------

# A line that memory has no room for, in the middle: no fit of the data before it. The limit is such
# that the data alone are fitted.
limit=100000
cp "$data" fit.csv
until [ $limit -gt 1000000 ] || (ulimit -v $limit && run -q fit.nml && exit $code); do
  limit=$((limit + 50000))
done
{ head -120 "$data"; printf '#'; head -c 240000000 /dev/zero | tr '\0' 'x'; echo; tail -n +121 "$data"; } >fit.csv
rm -f fit.h5*
if [ $limit -le 1000000 ]; then # a sanitizer needs more
  (ulimit -v $limit && refused fit.csv 'out of memory' fit.nml) || exit 1
  [ ! -e fit.h5 ] || fail "data that are cut off: fitted"
fi
# With memory all of it is read: a comment changes nothing.
run -q fit.nml
[ $code -eq 0 ] || fail "a long comment: exit code $code"
mv out long.txt
cp "$data" fit.csv
run -q fit.nml
cmp -s out long.txt || fail "a long comment changes the fit"
rm -f fit.h5*
truncate -s 257M fit.csv
refused fit.csv 'more than 256 MiB' fit.nml
# Results that HDF5 does not get through, in the program or in its child.
head -c 3000 /dev/zero | tr '\0' 'y' >fit.csv
printf '\211HDF\r\n\032\n' | dd of=fit.csv conv=notrunc 2>/dev/null
refused fit.csv 'cannot be read' fit.nml
rm -f fit.*

# ---- links and hard links ---------------------------------------------------------------------

echo precious >precious
for name in d.h5.part d.h5.journal log d.csv.part; do
  for how in 'link' 'hard link'; do
    if [ "$how" = link ]; then ln -s precious $name; else ln precious $name; fi
    case $name in
    log) refused log "$how" --log log d.nml ;;
    d.csv.part) run --csv d.nml
      [ $code -eq 1 ] || fail "a $how for d.csv.part: exit code $code"
      grep -q "d.csv.part' .*$how" err || fail "a $how for d.csv.part: other words" ;;
    *) refused $name "$how" d.nml ;;
    esac
    [ "$(cat precious)" = precious ] || fail "a $how for $name: what it led to is changed"
    [ -e $name ] || fail "a $how for $name is removed"
    rm -f $name d.h5 d.csv d.h5.journal
  done
done
# Through a link of one's own results reach what it points to, and the link stays.
mkdir there
ln -s there/meant.h5 d.h5
run -q d.nml
if [ $code -ne 0 ] || [ ! -h d.h5 ]; then fail "a link of one's own: exit code $code"; fi
"$program" --verify there/meant.h5 >out 2>err || fail "a link of one's own: not whole"
rm d.h5

# ---- what a run has left, and what it has not -------------------------------------------------

# Any file of HDF5, and the whole results of another deck, whose title has the mark of a part.
run -q d.nml ensemble.members=5 "scene.title=A (part)"
mv d.h5 d.h5.part
cp d.h5.part kept.h5
refused d.h5.part 'was not left by a run that was killed' d.nml
refused d.h5.part 'was not left by a run that was killed' --resume d.nml
cmp -s d.h5.part kept.h5 || fail "whole results in the place of a part are changed"
# Those of this deck, as after a kill just before they are renamed, are at hand.
run -q d.nml ensemble.members=5 "scene.title=A (part)"
[ $code -eq 0 ] || fail "whole results of this deck in the place of a part: exit code $code"
rm -f d.h5*
# A killed run leaves its part, which the next one takes over, and a killed shard leaves none.
kill_run()
{
  "$program" -q -t 1 "$@" ensemble.members=4000 sweep.drive_period_range=7,9,400 2>/dev/null >&2 &
  pid=$!
  n=0
  while [ ! -s "$journal" ] && [ $n -lt 200 ]; do sleep 0.05; n=$((n + 1)); done
  sleep 0.2
  kill -9 $pid
  wait $pid 2>/dev/null
}
sed -i 's/, drive_period = 8//' d.nml
journal=d.h5.journal
kill_run d.nml
[ -e d.h5.part ] || fail "a killed run: no part to be taken over"
rm -f d.h5.journal
run -q d.nml sweep.drive_period=8
[ $code -eq 0 ] || fail "the part of a killed run: exit code $code"
rm -f d.h5*
journal=d.h5.1-of-2.journal
kill_run --shard=1/2 d.nml
ls d.h5.*.part >/dev/null 2>&1 && fail "a killed shard leaves a part"
rm -f d.h5*
sed -i 's/damping = 0.24/damping = 0.24, drive_period = 8/' d.nml

# ---- another user -----------------------------------------------------------------------------

if [ "$(id -u)" -ne 0 ] || ! setpriv --reuid 65534 --regid 65534 --clear-groups true 2>/dev/null; then
  echo "no other user: root may try one"
  exit 0
fi
# Files of root, and the program run by nobody, in a folder as /tmp is.
mkdir sticky mine || exit 1
chmod 755 . && chmod 1777 sticky && chmod 777 mine && cp "$program" sticky/program && cp d.nml sticky/
program="setpriv --reuid 65534 --regid 65534 --clear-groups $scratch/sticky/program"
other=65534
run()
{
  # shellcheck disable=SC2086
  (cd "$scratch/sticky" && timeout -k 5 60 $program -t 1 "$@") >out 2>err
  code=$?
}
run --version
[ $code -eq 0 ] || { echo "no other user can run the program"; exit 0; }
whole()
{
  [ -s sticky/d.h5 ] || [ -s mine/d.h5 ]
}
# theirs NAME ARGUMENT...: a file of root under that name, which anybody may write.
theirs()
{
  name=$1
  shift
  chown 0:0 sticky/"$name" && chmod 666 sticky/"$name"
  cp sticky/"$name" kept
  refused "$name" 'another user' "$@"
  whole && fail "$name of another user: computed nevertheless"
  cmp -s kept sticky/"$name" || fail "$name of another user is changed"
  rm -f sticky/d.h5* sticky/log sticky/d.csv*
}
: >sticky/d.h5.part && theirs d.h5.part d.nml
printf '(part)' >sticky/d.h5.part && theirs d.h5.part d.nml
printf '(part)' >sticky/d.h5.part && chmod 600 sticky/d.h5.part
refused d.h5.part 'another user' d.nml # one that cannot even be read
rm sticky/d.h5.part
: >sticky/log && theirs log --log log d.nml
: >sticky/d.h5.journal && theirs d.h5.journal d.nml
: >sticky/d.h5.journal && theirs d.h5.journal --resume d.nml
echo results >sticky/d.h5 && chmod 666 sticky/d.h5
run d.nml
if [ $code -ne 1 ] || ! grep -q 'd.h5.* another user' err; then
  fail "results of another user that he alone may replace: exit code $code"
fi
rm sticky/d.h5
ln -s ../mine/d.h5 sticky/d.h5 # of root's
refused d.h5 "link of another user" d.nml
chown -h $other:$other sticky/d.h5
run -q d.nml
if [ $code -ne 0 ] || [ ! -h sticky/d.h5 ] || [ ! -s mine/d.h5 ]; then fail "a link of one's own"; fi
rm -f sticky/d.h5 mine/d.h5
printf '# resonance: ' >sticky/d.csv.part
run -q --csv d.nml
if [ $code -ne 1 ] || ! grep -q "d.csv.part' belongs to another user" err; then
  fail "a table's part of another user: exit code $code"
fi
rm -f sticky/d.h5* sticky/d.csv*

# A journal of another user, whole and of the same deck: it is not gone on from without --resume, nor
# with it, unless its folder is named, and then that is said.
(cd sticky && ./program -q -t 1 --shard=1/1 d.nml && mv d.h5.1-of-1.journal d.h5.journal) || exit 1
cp sticky/d.h5.journal journal
theirs d.h5.journal d.nml
cp journal sticky/d.h5.journal && theirs d.h5.journal --resume d.nml
cp journal sticky/d.h5.journal && chmod 666 sticky/d.h5.journal
run --resume --journal=. d.nml
[ $code -eq 0 ] || fail "a journal in a folder that is named: exit code $code"
grep -q 'd.h5.journal. belongs to another user .*since its folder was named' err ||
  fail "a journal of another user is used without a word"
rm -f sticky/d.h5*
cp journal sticky/d.h5.1-of-1.journal && theirs d.h5.1-of-1.journal --merge d.nml
cp journal sticky/d.h5.1-of-1.journal && chmod 644 sticky/d.h5.1-of-1.journal
run --merge --journal=. d.nml
[ $code -eq 0 ] || fail "the journal of a part in a folder that is named: exit code $code"
grep -q 'belongs to another user' err || fail "a part of another user is used without a word"
exit 0
