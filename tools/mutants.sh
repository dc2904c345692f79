#!/bin/sh
# mutants.sh FILE [TEST...]: is each number of FILE, a numbers.h or engine/accuracy.c, pinned? It is
# multiplied by three and divided by three, one at a time, and the tests of its folder run until one
# fails: those that are named, or whose names have that of the folder or of a file in it. A line a
# number: what each of the two did. One that survives both is to be derived from another, merged,
# tested, or is speed only: then a row of `make bench` should move.
#
# Works in a copy of the tree, with its build, so that little is compiled; FACTOR=3 is the factor.
set -u
top=$(cd "$(dirname "$0")/.." && pwd)
[ $# -ge 1 ] && [ -r "$top/$1" ] || { echo "mutants.sh FILE [TEST...]" >&2; exit 2; }
file=$1
shift
factor=${FACTOR:-3}

# tests_of FOLDER: by the names of its files.
tests_of()
{
  for source in "$top/$1" "$top/$1"/*.c; do
    stem=$(basename "$source" .c)
    for test in "$top"/tests/test_*.c; do
      name=$(basename "$test" .c)
      case "${name}_" in *_"${stem}"_*) echo "$name" ;; esac
    done
  done | sort -u
}
tests=${*:-$(tests_of "$(dirname "$file")")}
[ -n "$tests" ] || { echo "mutants.sh: no test has the name of a file beside $file" >&2; exit 2; }

scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
trap 'exit 1' INT TERM
(cd "$top" && tar cf - --exclude=.git --exclude='*.h5' .) | (cd "$scratch" && tar xf -)
cd "$scratch" || exit 1
cp "$file" original

# run WHAT: builds, and runs the tests until one fails.
run()
{
  for test in $tests; do
    if ! make -j2 "build/tests/$test" >log 2>&1; then
      verdict="does not compile"
      return
    fi
    rm -f "build/results/$test"
    make "run/$test" >log 2>&1
    read -r code _ <"build/results/$test"
    [ "$code" = 0 ] || [ "$code" = 77 ] || { verdict="$test"; return; }
  done
  verdict=survives
}

verdict=
run
[ "$verdict" = survives ] || { echo "mutants.sh: without a change: $verdict" >&2; exit 1; }

# "LINE NAME NUMBER" of each number with a name, comments apart.
awk '{
  line = $0
  gsub(/\/\*.*\*\//, "", line)
  if (inside) { if (line !~ /\*\//) next; inside = 0; next }
  if (line ~ /\/\*/) { inside = 1; sub(/\/\*.*/, "", line) }
  while (match(line, /[A-Za-z_][A-Za-z_0-9]*( =|\[\] = \{)? -?[0-9][0-9.]*([eE][-+]?[0-9]+)?/)) {
    word = substr(line, RSTART, RLENGTH)
    line = substr(line, RSTART + RLENGTH)
    if (word !~ /=/ && $1 != "#define") continue
    n = split(word, part, " ")
    print FNR, part[1], part[n]
  }
}' original >numbers
printf '%-40s %-12s %-28s %s\n' number value "times $factor" "divided by $factor"
survivors=0
count=0
while read -r line name value <&9; do
  words=
  for way in '*' '/'; do
    changed=$(awk -v x="$value" -v way="$way" -v f="$factor" 'BEGIN {
      y = way == "*" ? x * f : x / f
      if (x ~ /^-?[0-9]+$/) printf "%d", way == "/" && y < 1 ? 1 : y
      else printf "%.17g%s", y, y == int(y) && y < 1e15 ? ".0" : ""
    }')
    verdict="the same"
    if [ "$changed" != "$value" ]; then
      awk -v at="$line" -v name="$name" -v old="$value" -v new="$changed" '
        FNR == at {
          i = match($0, name "( =|\\[\\] = \\{)? ")
          tail = substr($0, i)
          j = index(tail, old)
          $0 = substr($0, 1, i - 1) substr(tail, 1, j - 1) new substr(tail, j + length(old))
        }
        { print }' original >"$file"
      run
    fi
    words="$words|$verdict"
  done
  cp original "$file"
  count=$((count + 1))
  case $words in '|survives|survives' | '|survives|the same') survivors=$((survivors + 1)) ;; esac
  rest=${words#|}
  printf '%-40s %-12s %-28s %s\n' "$name" "$value" "${rest%%|*}" "${rest#*|}"
done 9<numbers
echo "$survivors of $count survive both ways, by: $(echo $tests)"
