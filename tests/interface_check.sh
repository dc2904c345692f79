#!/bin/sh
# interface_check.sh -- the public interface is the one that was promised: functions with their
# arguments, values of enums, sizes and fields of structs are those of tests/interface.txt, and
# docs/interface.md names every function.
#
# What is new goes into the list by `make interface-list`. What is gone or otherwise breaks programs
# that are linked: it needs a new major version and soname. With abidiff, and LAST=libpendres.so of
# the last release, both libraries are compared as well.
# Run by make check, which sets BUILD and CC.
set -u
BUILD=${BUILD:-build}
CC=${CC:-gcc}
python=${PYTHON:-/usr/bin/python3}
list=tests/interface.txt
failed=0
command -v "$python" >/dev/null || { echo "interface_check: skipped, no $python"; exit 77; }
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT

"$python" -B tests/interface_list.py "$CC" include >"$scratch/now" || exit 1
sed -n 's/^function .*\(pendres_[a-z0-9_]*\)(.*/\1/p' "$scratch/now" | sort -u >"$scratch/functions"
for name in $(cat "$scratch/functions"); do
  grep -q "\`${name#pendres_}\`" docs/interface.md || echo "interface_check: docs/interface.md lacks $name"
done >"$scratch/lacking"
sed -n 's/^| | `[a-z_]*\.h` | \(.*\) |$/\1/p' docs/interface.md | tr -d '` ' | tr , '\n' |
  sed 's/^/pendres_/' | sort -u | comm -23 - "$scratch/functions" |
  sed 's/^/interface_check: docs\/interface.md has too much: /' >>"$scratch/lacking"
cat "$scratch/lacking"
[ ! -s "$scratch/lacking" ] || failed=1

# Sizes are those of machines whose long has 64 bits and whose long double has 16 bytes.
printf 'int a[sizeof(long) == 8 && sizeof(long double) == 16 ? 1 : -1];' >"$scratch/model.c"
if $CC -c -o "$scratch/model.o" "$scratch/model.c" 2>/dev/null; then
  "$python" -B tests/interface_list.py --compare "$list" "$scratch/now"
  case $? in
    0) ;;
    1) echo "interface_check: the interface has grown: renew the list with make interface-list"
      failed=1 ;;
    *) echo "interface_check: the interface is broken: see docs/interface.md on how long it lasts"
      failed=1 ;;
  esac
fi

if [ -n "${LAST:-}" ] && command -v abidiff >/dev/null; then
  abidiff "$LAST" "$BUILD/libpendres.so" || failed=1
fi
echo "$(wc -l <"$scratch/functions") public functions"
exit $failed
