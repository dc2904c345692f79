#!/bin/sh
# style_check.sh -- no lines over 100 columns, tabs, blanks at line ends, and no file of more than
# 500 lines, so that each fits in a head. `make style`.
set -u
export LC_ALL=C.UTF-8
files=$(ls src/*/*.[ch] include/pendres/*.h drivers/*.[ch] drivers/*/*.[ch] tests/*.[ch] \
  tests/accuracy/*.[ch] bench/*.[ch] examples/*.c 2>/dev/null)
# Data, which nobody reads from top to bottom: coefficients of Butcher tables as they were
# published, and numbers that tests/make_golden.c has printed.
data='src/engine/tables.c tests/golden.h'

found=$(
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
