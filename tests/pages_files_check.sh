#!/bin/sh
# pages_files_check.sh -- every command of docs/files.md, in its order: the program's, h5copy's where
# it is installed, Python's where there is xarray, Octave's where there is Octave.
# Run by make check, which sets BUILD and RESONANCE.
set -u
[ -n "${RESONANCE:-}" ] || exit 77
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
page=$PWD/docs/files.md
ln -s "$PWD/input" "$RESONANCE" "$scratch"

fail()
{
  cat log
  echo "pages_files_check: $*"
  exit 1
}

# blocks LANGUAGE: what stands between ```LANGUAGE and ```.
blocks()
{
  sed -n "/^\`\`\`$1\$/,/^\`\`\`\$/{/^\`\`\`/!p}" "$page"
}

cd "$scratch" || exit 1
sed '/^```/,/^```/d' "$page" | sed -n 's/^    //p' >all.sh
blocks python >page.py
blocks octave >page.m
[ "$(wc -l <all.sh)" -ge 6 ] && [ -s page.py ] && [ -s page.m ] || { : >log; fail "commands are missing"; }
command -v h5copy >/dev/null || sed -i '/^h5copy/d' all.sh
e='ensemble.members=8'
{
  ./resonance -q input/f02.nml sweep.damping=0.2,0.3 $e &&
    ./resonance -q input/f03.nml sweep.damping=0.3 sweep.drive_period=6.5,7 $e &&
    ./resonance -q input/hysteresis.nml sweep.drive_frequency_range=0.83,0.85,3
} >log 2>&1 || fail "no files to try the commands on"
sh -e all.sh >printed 2>log || fail "a command failed"
grep -q 'f02.h5: whole' printed && grep -q '^damping,resonance_frequency' curve.csv || fail "no results"

for candidate in "${PYTHON:-python3}" /usr/bin/python3; do
  "$candidate" -c 'import xarray, h5netcdf' 2>/dev/null || continue
  "$candidate" page.py >printed 2>log || fail "Python's commands failed"
  grep -q '^0\.94' printed || fail "not the resonance that the page asks for: $(cat printed)"
  break
done
if command -v octave-cli >/dev/null; then
  octave-cli --norc page.m >printed 2>log || fail "Octave's commands failed"
  grep -q '0\.9223' printed || fail "not the resonances: $(cat printed)"
fi
exit 0
