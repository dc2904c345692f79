#!/bin/sh
# pages_files_check.sh -- every command of docs/files.md, in its order: the program's, Python's where
# there is xarray, Fortran's where there is netCDF for it, Octave's where there is Octave, R's where
# there is R with rhdf5.
# Run by make check, which sets BUILD and RESONANCE.
set -u
[ -n "${RESONANCE:-}" ] || { echo "no program resonance"; exit 77; }
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
sed '/^```/,/^```/d' "$page" | sed -n 's/^    //p' | grep -v '^gfortran ' >all.sh
sed -n 's/^    \(gfortran .*\)/\1/p' "$page" >fortran.sh
blocks fortran >resonances.f90
blocks python >page.py
blocks octave >page.m
blocks r >page.R
for file in fortran.sh resonances.f90 page.py page.m page.R; do
  [ "$(wc -l <all.sh)" -ge 5 ] && [ -s $file ] || { : >log; fail "commands are missing"; }
done
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
if command -v gfortran >/dev/null && command -v nf-config >/dev/null; then
  sh -e fortran.sh >log 2>&1 && ./a.out >printed 2>log || fail "Fortran's commands failed"
  grep -q '0\.2000000000 *0\.9223' printed || fail "not the resonances: $(cat printed)"
fi
if command -v octave-cli >/dev/null; then
  octave-cli --norc page.m >printed 2>log || fail "Octave's commands failed"
  grep -q '0\.9223' printed && grep -q '^0\.8[0-9]*$' printed && ! grep -q warning log ||
    fail "not the resonances and jumps: $(cat printed)"
fi
if command -v Rscript >/dev/null && Rscript -e 'library(rhdf5)' >/dev/null 2>&1; then
  Rscript page.R >printed 2>log || fail "R's commands failed"
  grep -q '0\.9223' printed && grep -q '"up" *"down"' printed && grep -q 'resonance_curve' printed ||
    fail "R does not read what the page asks for: $(cat printed)"
fi
exit 0
