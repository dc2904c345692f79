#!/bin/sh
# valgrind.sh PROGRAM...: a test program, and what it starts, under memcheck. Memory alone is
# judged: valgrind rounds long doubles, and so the reference, to 53 bits; values may fail, and a
# test that cmocka has broken off keeps what it held. Valgrind hides AVX-512: AVX2 is looked at.
set -u
command -v valgrind >/dev/null 2>&1 || { echo "no valgrind: apt-get install valgrind"; exit 77; }
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
# Threads of tests that spin while they wait would take the time of the one that runs.
export OMP_WAIT_POLICY=passive
valgrind -q --fair-sched=yes --leak-check=full --errors-for-leak-kinds=none --error-exitcode=99 \
  --trace-children=yes --trace-children-skip='*/sh,*python*' --log-file="$folder/%p" \
  --suppressions="$PWD/tests/valgrind.supp" "$@"
code=$?
cat "$folder"/*
# FATAL: valgrind did not even start, as in a child where it finds a file of its own no more.
if grep -q 'Invalid\|ninitialised\|Mismatched\|overlap\|FATAL' "$folder"/*; then exit 99; fi
if [ "$code" -eq 77 ] || [ "$code" -ge 99 ]; then exit "$code"; fi
if [ "$code" -ne 0 ]; then
  echo "values differ; no error of memory"
  exit 0
fi
! grep -q 'lost in loss record' "$folder"/*
