#!/bin/sh
# auto_check.sh -- docs/auto/pendres.c still computes what docs/auto.md tells of libpendres, and each
# of its numbers is AUTO-07p's, which stands there too, as far as AUTO itself claims to know it.
# Run by make check, which sets BUILD and CC. AUTO is not run: its numbers are read from the page.
#
# AUTO's own tolerances, relative to 1 + |value|, from docs/auto/c.pendulum and compare.auto:
#   1e-11  EPSL and EPSU, of Newton's method: parameters at folds, where being off along the branch
#          does not change them;
#   3e-10  for losses of symmetry: five orbits to 1e-11 each, drawn on to where the mean vanishes,
#          which makes up to 31 times as much of it (the binomial weights 5, 10, 10, 5, 1);
#   1e-9   EPSS, of places along a branch: doublings, and areas at all places;
#   1e-8   for cusps, whose curve is followed with that throughout;
# and half a unit of the last digit that AUTO prints, eleven digits, of multipliers six.
set -u
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
fail()
{
  echo "auto_check: $*"
  exit 1
}

libraries=$(cd "$BUILD" && pwd) || exit 1
"${CC:-cc}" -Iinclude -o "$scratch/pendres" docs/auto/pendres.c "$libraries/libpendres.so" \
  -Wl,-rpath,"$libraries" || fail "docs/auto/pendres.c does not compile"
"$scratch/pendres" >"$scratch/ours" || fail "docs/auto/pendres.c does not run"

awk '
  function size(x) { return x < 0 ? -x : x }
  function tolerance_of(name) {
    if (name ~ /_(re|im)$/) return 0
    if (name ~ /^cusp/) return 1e-8
    if (name ~ /area$/ || name ~ /doubling/) return 1e-9
    return name ~ /symmetry/ ? 3e-10 : 1e-11
  }
  # Half a unit of the last of so many digits.
  function printed(x, digits) {
    return x == 0 ? 0 : 0.5 * 10 ^ (int(log(size(x)) / log(10) + 100) - 100 + 1 - digits)
  }
  FNR == NR {
    if (split($0, cell, " *[|] *") > 5 && cell[4] ~ /^-?[0-9]/) {
      auto[cell[2]] = cell[3]
      told[cell[2]] = cell[4]
      error[cell[2]] = cell[5]
      rows++
    }
    next
  }
  !($1 in auto) { print $1 " is not in docs/auto.md"; bad++; next }
  {
    seen++
    digits = $1 ~ /_(re|im)$/ ? 6 : 11
    apart = size($2 - auto[$1])
    within = tolerance_of($1) * (1 + size($2)) + printed(auto[$1], digits) + $3
    if (!(apart <= within)) {
      printf "%s: %s, AUTO %s, %.1e apart, more than %.1e\n", $1, $2, auto[$1], apart, within
      bad++
    }
    # Of multipliers the page tells six digits as well, of others fourteen.
    within = $3 + error[$1] + printed($2, digits == 6 ? 6 : 14) * 2
    if (!(size($2 - told[$1]) <= within)) {
      printf "%s: %s, the page tells %s\n", $1, $2, told[$1]
      bad++
    }
  }
  END {
    printf "%d numbers beside those of AUTO-07p\n", seen
    if (seen != rows || rows < 40) { printf "%d of %d rows\n", seen, rows; bad++ }
    exit bad > 0
  }' docs/auto.md "$scratch/ours" || fail "numbers differ from docs/auto.md"
