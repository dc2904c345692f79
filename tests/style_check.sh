#!/bin/sh
# style_check.sh -- no lines over 100 columns, tabs, blanks at line ends, no file of more than 500
# lines, so that each fits in a head, and in the library and the driver no function of more than 60
# lines or 6 parameters. `make style`.
set -u
export LC_ALL=C.UTF-8
files=$(ls src/*/*.[ch] src/*/*/*.[ch] include/pendres/*.h drivers/*.[ch] drivers/*/*.[ch] drivers/*/*/*.[ch] \
  validation/*.[ch] tests/*.[ch] tests/accuracy/*.[ch] bench/*.[ch] examples/*.c 2>/dev/null)
# Data, which nobody reads from top to bottom: coefficients of Butcher tables as they were
# published, and numbers that tests/make_golden.c has printed.
data='src/engine/kernels/tables.c tests/golden.h'

# Functions that may have more parameters, and how many.
more='
  # As callers have them: n pendulums and their states in arrays side by side, and what is asked.
  # The second of each two is the first, behind the guard of a context.
  strobe.c:pendres_strobe_advance 7     strobe.c:strobe_advance 7
  attractor.c:pendres_settle 7          attractor.c:settle_all 7
  lyapunov.c:pendres_lyapunov_find 7    lyapunov.c:lyapunov_find 7
  # Inlined into loops over lanes: in a struct the numbers would go through memory.
  kernels.c:accelerate 8    kernels.c:derive 8    kernels.c:rhs_terms 7
  kernels_langevin.c:force 7    kernels_langevin.c:kick_by 8    kernels_langevin.c:sample 7
  # The type is that of CVODE.
  method_cvode.c:jacobian 8
'

# FILE:LINE: what is wrong with the functions of some files, which begin and end with a brace in
# column 1.
functions()
{
  awk -v more="$(echo "$more" | sed 's/#.*//')" '
    BEGIN {
      n = split(more, word)
      for (i = 1; i < n; i += 2) most[word[i]] = word[i + 1]
    }
    FNR == 1 { head = ""; first = 0 }
    first {
      if (/^\}/) {
        if (FNR - first - 1 > 60) print FILENAME ":" first ": " name "() has " FNR - first - 1 " lines"
        first = 0
      }
      next
    }
    /^\{/ && head ~ /\) *$/ {
      first = FNR
      gsub(/\/\*[^*]*\*\//, "", head)
      match(head, /[A-Za-z_0-9]+\(/)
      name = substr(head, RSTART, RLENGTH - 1)
      parameters = 1
      depth = 0
      for (i = RSTART + RLENGTH; i <= length(head) && depth >= 0; i++) {
        letter = substr(head, i, 1)
        depth += (letter == "(") - (letter == ")")
        parameters += letter == "," && depth == 0
      }
      n = split(FILENAME, part, "/")
      key = part[n] ":" name
      if (parameters > (key in most ? most[key] : 6))
        print FILENAME ":" first ": " name "() has " parameters " parameters"
      head = ""
      next
    }
    /^[A-Za-z_]/ { head = $0; next }
    /^[ \t]/ && head != "" { head = head " " $0; next }
    { head = "" }' "$@"
}

found=$(
  functions $(ls src/*/*.[ch] src/*/*/*.[ch] include/pendres/*.h drivers/*.[ch] drivers/*/*.[ch] drivers/*/*/*.[ch] \
    validation/*.[ch])
  {
    grep -nHE '^.{101,}' $files | sed -E 's/^([^:]*:[0-9]*):.*/\1: over 100 columns/'
    grep -nHP '\t' $files | sed -E 's/^([^:]*:[0-9]*):.*/\1: tab/'
    grep -nHE ' +$' $files | sed -E 's/^([^:]*:[0-9]*):.*/\1: blank at the end/'
  } | sort -t: -k1,1 -k2,2n
  wc -l $files | awk -v data="$data" '
    BEGIN { n = split(data, name); for (i = 1; i <= n; i++) excepted[name[i]] = 1 }
    $1 > 500 && $2 != "total" && !($2 in excepted) { print $2 ": " $1 " lines" }'
)
[ -z "$found" ] || { echo "$found"; exit 1; }
