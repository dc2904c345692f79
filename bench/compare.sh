#!/bin/sh
# compare.sh -- figures of the benchmarks beside those of the last release.
#
#   compare.sh BASELINE NOW            a table; what got worse by more than its tolerance is marked
#   compare.sh --renew BASELINE NOW    the new baseline, to standard output
#
# Lines: name value better tolerance; see figures.h. Names that end in .avx512, .avx2 or .base are
# of these kernels alone: a renewed baseline keeps those of kernels that did not run.
set -eu
export LC_ALL=C
renew=0
[ "$1" = --renew ] && renew=1 && shift
[ -f "$1" ] && then=$1 || then=/dev/null
[ -s "$2" ] || { echo "compare.sh: no figures in $2" >&2; exit 1; }
awk -v renew=$renew '
  function kernels(name) { return match(name, /\.(avx512|avx2|base)$/) ? substr(name, RSTART) : "" }
  /^#/ || NF < 4 { next }
  FILENAME != now { old[$1] = $2; line[$1] = $0; names[++count] = $1; next }
  { new[$1] = $2; better[$1] = $3; tolerance[$1] = $4; ran[kernels($1)] = 1 }
  !($1 in line) { names[++count] = $1 }
  { line[$1] = $0 }
  END {
    if (!renew) printf "%-40s %12s %12s %9s\n", "figure", "then", "now", "now/then"
    for (i = 1; i <= count; i++) {
      n = names[i]
      if (!(n in new)) {
        if (ran[kernels(n)]) { if (!renew) printf "%-40s %12g %12s %9s  gone\n", n, old[n], "", "" }
        else if (renew) print line[n]
        continue
      }
      if (renew) { print line[n]; continue }
      if (!(n in old)) { printf "%-40s %12s %12g %9s  new\n", n, "", new[n], ""; continue }
      ratio = old[n] != 0 ? new[n] / old[n] : new[n] == 0 ? 1 : 1e9
      loss = better[n] == "<" ? ratio : ratio > 0 ? 1 / ratio : 1e9
      verdict = loss > 1 + tolerance[n] ? "WORSE" : loss < 1 / (1 + tolerance[n]) ? "better" : ""
      if (verdict == "WORSE") worse++
      printf "%-40s %12g %12g %9.3f  %s\n", n, old[n], new[n], ratio, verdict
    }
    if (!renew && worse > 0) printf "%d figures got worse by more than their tolerance\n", worse
    if (!renew && worse == 0) print "nothing got worse by more than its tolerance"
  }' now="$2" "$then" "$2"
