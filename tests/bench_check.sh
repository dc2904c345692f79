#!/bin/sh
# bench_check.sh -- what the comparison of `make bench` says of made-up figures: worse either way,
# within its tolerance, better, new, gone, kernels that did not run; and what a renewal keeps.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/then" <<'END'
# a comment
count.up 100 < 0.02
count.same 100 < 0.02
count.down 100 < 0.02
ratio.down 10 > 0.15
ratio.near 10 > 0.15
lost 1 < 0.02
other.avx2 5 > 0.15
END
cat >"$folder/now" <<'END'
count.up 103 < 0.02
count.same 101 < 0.02
count.down 90 < 0.02
ratio.down 8 > 0.15
ratio.near 9 > 0.15
ratio.new.avx512 3 > 0.15
END
failed=0
want()
{
  grep -qE "$1" "$folder/out" || { echo "bench_check: no line like '$1'"; failed=1; }
}
bench/compare.sh "$folder/then" "$folder/now" >"$folder/out"
want '^count\.up .* 1\.030 +WORSE$'
want '^count\.same .* 1\.010 *$'
want '^count\.down .* 0\.900 +better$'
want '^ratio\.down .* 0\.800 +WORSE$'
want '^ratio\.near .* 0\.900 *$'
want '^ratio\.new\.avx512 .* new$'
want '^lost .* gone$'
want '^2 figures got worse'
grep -q 'other' "$folder/out" && { echo 'bench_check: kernels that did not run are compared'; failed=1; }

bench/compare.sh --renew "$folder/then" "$folder/now" >"$folder/out"
want '^count\.up 103 < 0\.02$'
want '^other\.avx2 5 > 0\.15$'
[ "$(wc -l <"$folder/out")" -eq 7 ] || { echo 'bench_check: a renewal keeps or loses lines'; failed=1; }

# A first baseline, and no figures at all.
bench/compare.sh "$folder/none" "$folder/now" >"$folder/out"
want '^ratio\.near .* new$'
if bench/compare.sh "$folder/then" "$folder/none" 2>/dev/null; then
  echo 'bench_check: no figures are no failure'
  failed=1
fi
exit $failed
