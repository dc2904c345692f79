#!/bin/sh
# units_check.sh -- every scene gives the same digits in other units (units_check.py).
set -u
top=$(cd "$(dirname "$0")/.." && pwd)
python=${PYTHON:-/usr/bin/python3}
"$python" -c 'import h5py' 2>/dev/null || { echo "no Python with h5py: make deps-plots"; exit 77; }
exec "$python" "$top/tests/units_check.py" "$RESONANCE"
