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
if "$python" -c 'import setuptools, pip' 2>/dev/null; then
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
  # A program that happens to stand near the package may be anybody's, and is not run; that of the wheel
  # is told by its checksum in the wheel's record.
  mkdir -p "$scratch/a/b" "$scratch/a/bin" && cp -r "$scratch/site" "$scratch/a/b/site" || exit 1
  mkdir "$scratch/a/b/site/bin" "$scratch/a/b/bin" || exit 1
  for folder in a/bin a/b/bin a/b/site/bin a/b; do
    printf '#!/bin/sh\n: >%s/ran\n' "$scratch" >"$scratch/$folder/resonance"
    chmod +x "$scratch/$folder/resonance"
  done
  mkdir -p "$scratch/a/b/include/pendres" && : >"$scratch/a/b/include/pendres/pendres.h"
  for wheel in none own; do
    (cd / && unset PENDRES_PROGRAM && python=$(command -v "$python") &&
      PATH=/nowhere PYTHONPATH=$scratch/a/b/site "$python" - "$wheel" "$scratch/a/b/site" <<'CODE'
import base64, glob, hashlib, sys
import pendres
wheel, site = sys.argv[1:]
if wheel == "own":
    path = site + "/bin/resonance"
    with open(path, "w") as program:
        program.write(f"#!/bin/sh\necho resonance {pendres._library.declared.constants['PENDRES_VERSION']}\n")
    code = base64.urlsafe_b64encode(hashlib.sha256(open(path, "rb").read()).digest()).decode().rstrip("=")
    with open(glob.glob(site + "/pendres-*.dist-info/RECORD")[0], "a") as record:
        record.write(f"../../bin/resonance,sha256={code},1\n")
try:
    found = pendres._scenes.program()
except FileNotFoundError:
    found = None
assert found == (path if wheel == "own" else None), found
CODE
    ) || { echo "python_check: another program than the wheel's ($wheel)"; exit 1; }
    [ ! -e "$scratch/ran" ] || { echo "python_check: another's program is run"; exit 1; }
  done
  # The library of a prefix of one's own is found beside the program on PATH.
  mkdir "$scratch/bin" "$scratch/lib" && cp "$PENDRES_LIBRARY" "$scratch/lib/libpendres.so.1" &&
    printf '#!/bin/sh\n' >"$scratch/bin/resonance" && chmod +x "$scratch/bin/resonance" || exit 1
  (cd / && unset PENDRES_LIBRARY && PATH=$scratch/bin:$PATH PYTHONPATH=$scratch/site "$python" -c '
import pendres') || { echo "python_check: no library beside the program"; exit 1; }
fi
exit 0
