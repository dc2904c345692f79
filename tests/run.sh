#!/bin/sh
# run.sh RESULT SECONDS COMMAND...: run a check, keep its output in RESULT.log and its exit code
# and time in RESULT, and print one line. Always succeeds: summary.sh does the counting.
result=$1
limit=$2
shift 2
name=$(basename "$result")
mkdir -p "$(dirname "$result")"
start=$(date +%s.%N)
if command -v timeout >/dev/null 2>&1; then
  timeout -k 20 "$limit" "$@" >"$result.log" 2>&1
else
  "$@" >"$result.log" 2>&1
fi
code=$?
end=$(date +%s.%N)
awk -v name="$name" -v code="$code" -v start="$start" -v end="$end" -v limit="$limit" -v out="$result" '
  BEGIN {
    word = code == 0 ? "ok" : code == 77 ? "skipped" : code == 124 ? "TIMEOUT" : "FAILED"
    printf "  %-8s %s\n", word, name
    printf "%d %.2f\n", code, end - start > out
  }'
[ "$code" -eq 0 ] || [ "$code" -eq 77 ] || sed 's/^/    /' "$result.log"
exit 0
