#!/bin/sh
# explorer_check.sh -- the explorer's numbers beside those of scenes, and its page in a real browser.
# Exit code 77 without panel, or without Playwright and Debian's Chromium (make deps-explorer).
# Set SHOTS to a folder to keep what the browser showed.
set -u
BUILD=${BUILD:-build}
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT

for python in "${PYTHON:-python3}" "$BUILD/explorer/bin/python" none; do
  "$python" -c 'import panel, playwright, h5netcdf' 2>/dev/null && break
done
browser=$(command -v chromium || command -v chromium-browser) || browser=
[ "$python" != none ] && [ -n "$browser" ] || {
  echo "skipped: no panel, h5netcdf, Playwright and Chromium: make deps-explorer"
  exit 77
}
PENDRES_LIBRARY=$(cd "$BUILD" && pwd)/libpendres.so
PENDRES_PROGRAM=${RESONANCE:-$PWD/resonance}
PYTHONPATH=$PWD/python
PYTHONDONTWRITEBYTECODE=1
export PENDRES_LIBRARY PENDRES_PROGRAM PYTHONPATH PYTHONDONTWRITEBYTECODE
"$PENDRES_PROGRAM" --quiet -o "$scratch/map.h5" input/f08.nml sweep.damping=0.1,0.15,0.2 \
  'sweep.drive_frequency=0.5,0.6,0.7,0.8,0.9' || exit 1
exec "$python" tests/explorer_check.py "$browser" "$scratch/map.h5" "${SHOTS:-$scratch}"
