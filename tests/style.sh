#!/bin/sh
# style.sh -- lines over 100 columns, tabs, blanks at line ends, files over 500 lines. `make style`.
files=$(ls src/*/*.[ch] include/pendres/*.h drivers/*.[ch] drivers/*/*.[ch] tests/*.[ch] tests/accuracy/*.[ch] bench/*.[ch] 2>/dev/null)
export LC_ALL=C.UTF-8
{
  grep -nHE '^.{101,}' $files | sed 's/:[^:]*$/: over 100 columns/' | cut -d: -f1,2,4-
  grep -nHP '\t' $files | cut -d: -f1,2 | sed 's/$/: tab/'
  grep -nHE ' +$' $files | cut -d: -f1,2 | sed 's/$/: blank at the end/'
} | sort -t: -k1,1 -k2,2n | grep . && found=1
wc -l $files | awk '$1 > 500 && $2 != "total" { print $2 ": " $1 " lines" }'
[ -z "$found" ]
