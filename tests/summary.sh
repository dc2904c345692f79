#!/bin/sh
# summary.sh DIRECTORY NAME...: what run.sh left there, and the count. A check without a result
# was never built, and has failed. Exit code 77 of a check means: not possible here, not counted.
directory=$1
shift
passed=0
failed=0
echo
for name in "$@"; do
  code=
  seconds=-
  [ -r "$directory/$name" ] && read -r code seconds <"$directory/$name"
  case $code in
    0) word=ok passed=$((passed + 1)) ;;
    77) word=skipped ;;
    '') word='NOT BUILT' failed=$((failed + 1)) ;;
    *) word=FAILED failed=$((failed + 1)) ;;
  esac
  printf '%-10s %-28s %9s s\n' "$word" "$name" "$seconds"
done
echo
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
