#!/bin/sh
# bench_check.sh -- the benchmarks compile, which make sees to before this runs, and what is
# compared with the last release's figures is told: the same, worse, better, gone and new ones.
set -u
export LC_ALL=C
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
failed=0

# expect WORDS NOW: the table of these figures beside those of `then` has the words.
expect()
{
  bench/compare.sh "$scratch/then" "$2" >"$scratch/table"
  grep -qE "$1" "$scratch/table" && return
  echo "bench_check: no '$1' in:"
  cat "$scratch/table"
  failed=1
}

printf 'a.seconds 2.0 < 0.1\nb.ratio 0.5 > 0.1\nc.avx512 1 < 0.1\n' >"$scratch/then"
expect '^nothing got worse' "$scratch/then"
printf 'a.seconds 2.1 < 0.1\nb.ratio 0.4 > 0.1\n' >"$scratch/now"
expect '^b.ratio .*WORSE' "$scratch/now"
expect '^1 figures got worse' "$scratch/now"
printf 'a.seconds 1.0 < 0.1\nd.seconds 1 < 0.1\n' >"$scratch/now"
expect '^a.seconds .*better' "$scratch/now"
expect '^b.ratio .*gone' "$scratch/now"
expect '^d.seconds .*new' "$scratch/now"
# Figures of kernels that did not run here stay in a renewed baseline.
bench/compare.sh --renew "$scratch/then" "$scratch/now" >"$scratch/renewed"
grep -q '^c.avx512 1 ' "$scratch/renewed" || { echo "bench_check: c.avx512 is lost"; failed=1; }
bench/compare.sh bench/baseline.txt bench/baseline.txt | grep -q '^nothing got worse' ||
  { echo "bench_check: the baseline differs from itself"; failed=1; }
exit "$failed"
