#!/bin/sh
# summary.sh DIRECTORY NAME...: what run.sh left there, and the count. A check without a result
# was never built, and has failed. Exit code 77 of a check means: not possible here; its last line
# says what is missing, and what installs it.
directory=$1
shift
passed=0
failed=0
skipped=0
echo
for name in "$@"; do
  code=
  why=
  seconds=-
  [ -r "$directory/$name" ] && read -r code seconds <"$directory/$name"
  case $code in
    0) word=ok passed=$((passed + 1)) ;;
    77)
      word=skipped skipped=$((skipped + 1))
      why="  $(tail -n 1 "$directory/$name.log")"
      ;;
    '') word='NOT BUILT' failed=$((failed + 1)) ;;
    *) word=FAILED failed=$((failed + 1)) ;;
  esac
  printf '%-10s %-28s %9s s%s\n' "$word" "$name" "$seconds" "$why"
done
echo
[ "$skipped" -eq 0 ] || printf '%s\n\n' 'Skipped checks need what stands beside them.'
echo "$passed passed, $failed failed$([ "$skipped" -eq 0 ] || echo ", $skipped skipped")"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
