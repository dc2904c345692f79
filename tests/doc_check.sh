#!/bin/sh
# doc_check.sh -- make doc without a warning: every function, field of a struct and macro of the
# public headers has a comment of its own, and so has every value of an enum, or that of the enum
# names it. Skipped where there is no doxygen.
set -u
command -v doxygen >/dev/null || { echo "no doxygen: apt-get install doxygen"; exit 77; }
export LC_ALL=C
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT

# Doxygen warns of all but the values of enums: these are looked up in what it writes as XML.
{
  cat Doxyfile
  printf '%s\n' "OUTPUT_DIRECTORY = $scratch" 'GENERATE_HTML = NO' 'GENERATE_XML = YES'
} >"$scratch/Doxyfile"
doxygen "$scratch/Doxyfile" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }

awk '
  /<memberdef kind="enum"/ { inside = 1; n = 0; words = "" }
  inside && /<enumvalue/ { value = 1; told = 0; next }
  inside && value && /<name>/ { gsub(/ *<\/?name>/, ""); name = $0; all++ }
  inside && value && /<para>/ { told = 1 }
  inside && /<\/enumvalue>/ { value = 0; if (!told) bare[n++] = name; next }
  inside && !value { words = words " " $0 }
  inside && /<\/memberdef>/ {
    for (i = 0; i < n; i++)
      if (!match(words, bare[i] "[^A-Z_a-z0-9]")) print bare[i] " has no comment"
    inside = 0
  }
  END { if (all < 100) print "only " all + 0 " values of enums were seen" }
' "$scratch"/xml/*_8h.xml >>"$scratch/log"

# What stands in a file without a head of its own is passed over in silence.
for header in include/pendres/*.h; do
  grep -q "^ \* @file ${header##*/}\$" "$header" || echo "$header has no @file" >>"$scratch/log"
done

if [ -s "$scratch/log" ]; then
  cat "$scratch/log"
  echo "doc_check: make doc warns"
  exit 1
fi
