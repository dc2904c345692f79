#!/bin/sh
# symbols_check.sh -- what the library exports, keeps and calls.
#
# Exported: exactly the functions that the public headers declare, all of them tried with arguments
# that are none. Kept: no data that can be written, so nothing is shared between contexts, but for
# the table in which formulas are found by number, whose entries never change. Called: nothing that
# prints or ends a program.
# Run by make check, which sets BUILD and CC.
set -u
BUILD=${BUILD:-build}
CC=${CC:-gcc}
export LC_ALL=C
failed=0
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT

fail()
{
  echo "symbols_check: $*"
  failed=1
}

# Names of the functions declared in a header: statements outside braces that are neither
# typedefs nor static, up to the first parenthesis.
declared()
{
  $CC -std=c11 -E -Iinclude "$1" | awk -v own="$1" '
    /^# [0-9]+ / { gsub(/"/, "", $3); here = ($3 == own); next }
    here && !/^#/ { text = text " " $0 }
    END {
      while (sub(/\{[^{}]*\}/, " ", text)) ;
      n = split(text, statement, ";")
      for (i = 1; i <= n; i++) {
        s = statement[i]
        if (s ~ /(^|[^a-z_0-9])(typedef|static)[^a-z_0-9]/) continue
        if (match(s, /[A-Za-z_][A-Za-z_0-9]*[ \t]*\(/)) {
          name = substr(s, RSTART, RLENGTH - 1)
          gsub(/[ \t]/, "", name)
          print name
        }
      }
    }'
}

for header in include/pendres/*.h; do
  echo "#include <pendres/$(basename "$header")>" >"$scratch/alone.c"
  $CC -std=c11 -Wall -Wextra -Wpedantic -Werror -Iinclude -fsyntax-only "$scratch/alone.c" ||
    fail "$header does not compile on its own"
  if command -v g++ >/dev/null 2>&1; then
    g++ -x c++ -std=c++11 -Wall -Wextra -Werror -Iinclude -fsyntax-only "$scratch/alone.c" ||
      fail "$header is not fit for C++"
  fi
  declared "$header"
  [ "$header" = include/pendres/pendres.h ] ||
    grep -q "#include <pendres/$(basename "$header")>" include/pendres/pendres.h ||
    fail "pendres.h lacks $(basename "$header")"
done | sort -u >"$scratch/declared.and.messages"
grep '^symbols_check:' "$scratch/declared.and.messages" && failed=1
grep -v '^symbols_check:' "$scratch/declared.and.messages" >"$scratch/declared"

# Without the names of versions: their own entries are absolute.
nm -D --defined-only "$BUILD/libpendres.so" |
  awk '$2 != "A" { sub(/@.*/, "", $NF); print $NF }' | sort -u >"$scratch/exported"
[ -z "$(nm -D --defined-only "$BUILD/libpendres.so" | awk '$2 != "A" && $NF !~ /@@PENDRES_[0-9]/')" ] ||
  fail "symbols without a version"
[ -s "$scratch/declared" ] && [ -s "$scratch/exported" ] || fail "nothing to compare"

comm -23 "$scratch/declared" "$scratch/exported" >"$scratch/missing"
comm -13 "$scratch/declared" "$scratch/exported" >"$scratch/extra"
[ ! -s "$scratch/missing" ] || fail "declared but not exported:" $(cat "$scratch/missing")
[ ! -s "$scratch/extra" ] || fail "exported but not declared:" $(cat "$scratch/extra")
grep -v '^pendres_' "$scratch/exported" >"$scratch/foreign" &&
  fail "without the prefix:" $(cat "$scratch/foreign")

# Each is called with arguments that are none.
for name in $(cat "$scratch/declared"); do
  cat tests/test_arguments*.c | grep -q "$name(" || echo "$name"
done >"$scratch/untried"
[ ! -s "$scratch/untried" ] || fail "not in tests/test_arguments*.c:" $(cat "$scratch/untried")

# Names that cross files inside the archive carry the prefix too.
nm --defined-only --extern-only "$BUILD/libpendres.a" 2>/dev/null |
  awk 'NF == 3 && $3 !~ /^pendres_/ { print $3 }' >"$scratch/foreign"
[ ! -s "$scratch/foreign" ] || fail "without the prefix in the archive:" $(cat "$scratch/foreign")

size -A "$BUILD/libpendres.a" | awk '
  / : *$|\(ex / { object = $1 }
  ($1 ~ /^\.(data|bss|tdata|tbss)(\.|$)/ && $1 !~ /^\.data\.rel\.ro/) && $2 > 0 {
    print object ":" $1 }' | grep -vx 'defined.o:.bss' >"$scratch/data"
[ ! -s "$scratch/data" ] || fail "data that can be written:" $(cat "$scratch/data")

nm --undefined-only "$BUILD/libpendres.a" 2>/dev/null | awk '
  $1 == "U" && $2 ~ /^_*(exit|_Exit|quick_exit|abort|printf|vprintf|puts|putchar|perror|stdout|stderr|stdin)(_chk)?$/ {
    print $2 }' | sort -u >"$scratch/calls"
[ ! -s "$scratch/calls" ] || fail "a library does not print or exit:" $(cat "$scratch/calls")

echo "$(wc -l <"$scratch/exported") functions exported"
exit $failed
