#!/bin/sh
# accuracy_check.sh -- a short `make accuracy` with a fixed seed: all goals are met.
# Run by make check, which sets BUILD and has built the program.
set -u
program=${BUILD:-build}/tests/accuracy/accuracy
failed=0
for seed in 1; do
  "$program" --seed=$seed --orbits=400 --points=2 || failed=1
done
exit $failed
