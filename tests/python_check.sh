#!/bin/sh
# python_check.sh -- the Python package: what it has read from the headers beside what the compiler
# makes of them, its results beside those of C, and every command of its tutorial.
# Exit code 77 where there is no Python with cffi and numpy. Run by make check, which sets BUILD and CC.
set -u
BUILD=${BUILD:-build}
CC=${CC:-gcc}
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT

for python in "${PYTHON:-python3}" /usr/bin/python3 none; do
  "$python" -c 'import cffi, numpy' 2>/dev/null && break
done
[ "$python" != none ] || {
  echo "no Python with cffi and numpy: make deps-python"
  exit 77
}

PENDRES_LIBRARY=$(cd "$BUILD" && pwd)/libpendres.so
PENDRES_PROGRAM=${RESONANCE:-}
PYTHONPATH=$PWD/python
PYTHONDONTWRITEBYTECODE=1
export PENDRES_LIBRARY PENDRES_PROGRAM PYTHONPATH PYTHONDONTWRITEBYTECODE CC
# In a folder of its own, where another run leaves nothing that a test takes for its own.
TMPDIR=$scratch "$python" tests/python_check.py "$scratch" || exit 1

# Installed by pip, away from the tree, without asking the network for anything.
cp -r python include "$scratch" || exit 1
if "$python" -c 'import pip, setuptools' 2>/dev/null; then
  "$python" -m pip install --quiet --no-build-isolation --no-deps --no-index --root-user-action=ignore \
    --target "$scratch/site" "$scratch/python" >"$scratch/log" 2>&1 ||
    { cat "$scratch/log"; echo "python_check: pip install failed"; exit 1; }
  rm -r "$scratch/python" "$scratch/include"
  (cd / && PYTHONPATH=$scratch/site "$python" -c '
import pendres
assert "site" in pendres.__file__
p = pendres.pendulum(damping=0.24, drive_amplitude=0.2)
assert abs(pendres.resonance(p).frequency - 0.9441721) < 1e-7') ||
    { echo "python_check: the installed package does not work"; exit 1; }
  # The library of a prefix of one's own is found beside the program on PATH.
  mkdir "$scratch/bin" "$scratch/lib" && cp "$PENDRES_LIBRARY" "$scratch/lib/libpendres.so.1" &&
    printf '#!/bin/sh\n' >"$scratch/bin/resonance" && chmod +x "$scratch/bin/resonance" || exit 1
  (cd / && unset PENDRES_LIBRARY && PATH=$scratch/bin:$PATH PYTHONPATH=$scratch/site "$python" -c '
import pendres') || { echo "python_check: no library beside the program"; exit 1; }
fi
exit 0
