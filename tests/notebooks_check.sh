#!/bin/sh
# notebooks_check.sh -- the notebooks of docs/notebooks run from first cell to last, and what they claim
# holds. Exit code 77 without a Python that has matplotlib, xarray and h5netcdf.
set -u
for python in "${PYTHON:-python3}" /usr/bin/python3 none; do
  "$python" -c 'import cffi, h5netcdf, h5py, matplotlib, numpy, xarray' 2>/dev/null && break
done
[ "$python" != none ] || { echo "skipped: make deps-python deps-plots"; exit 77; }
PENDRES_LIBRARY=$(cd "$BUILD" && pwd)/libpendres.so
PENDRES_PROGRAM=${RESONANCE:-$PWD/resonance}
PYTHONPATH=$PWD/python
PYTHONDONTWRITEBYTECODE=1
export PENDRES_LIBRARY PENDRES_PROGRAM PYTHONPATH PYTHONDONTWRITEBYTECODE
exec "$python" tests/notebooks_check.py docs/notebooks/*.ipynb
