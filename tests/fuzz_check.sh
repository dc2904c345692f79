#!/bin/sh
# fuzz_check.sh -- the harnesses of tests/fuzz for readers, by clang's libFuzzer: they link, and some
# seconds of mutations of the corpus break nothing (FUZZ_SECONDS each, 10 by default; `make fuzz`
# takes a minute each). What is collected is left to test_fuzz_corpus, which needs no clang. Skipped
# where there is no clang with libFuzzer. Run by make check, which sets MAKE.
set -u
MAKE=${MAKE:-make}
for clang in clang clang-19 clang-17 clang-16 clang-15 clang-14 ''; do
  command -v "$clang" >/dev/null 2>&1 && break
done
[ -n "$clang" ] || exit 77
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
echo 'int LLVMFuzzerTestOneInput(const char *d, long n); int LLVMFuzzerTestOneInput(const char *d,
long n) { return d == 0 && n > 0; }' >"$scratch/none.c"
"$clang" -fsanitize=fuzzer,address "$scratch/none.c" -o "$scratch/none" 2>/dev/null || exit 77
# A build of its own: the variables of an outer command line come along in MAKEFLAGS. All at once, for
# so many seconds of the clock.
exec env FUZZ_SECONDS="${FUZZ_SECONDS:-10}" $MAKE -j4 fuzz CLANG="$clang" WERROR=0 CFLAGS=-O1 \
  FUZZ_NAMES='deck journal namelist verify'
