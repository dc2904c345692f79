#!/bin/sh
# pendres.3.sh VERSION DATADIR -- the manual page of the library on standard output, from
# man/pendres.3.in, the first sentences of the public headers and the first example.
export LC_ALL=C
awk -v version="$1" -v datadir="$2" '
  function purpose(header,   line, text) {
    getline line <header
    while ((getline line <header) > 0 && line !~ /\*\// && text !~ /[.]$/) {
      gsub(/^ \* ?|@file +[a-z_]+\.h *|@brief */, "", line)
      sub(/^[a-z_]+\.h -- /, "", line)
      text = text (text == "" ? "" : " ") line
    }
    close(header)
    return text
  }
  function copy(file,   line) {
    while ((getline line <file) > 0) { gsub(/\\/, "\\e", line); gsub(/-/, "\\-", line); print line }
  }
  /^@HEADERS@/ {
    command = "ls include/pendres/*.h"
    while ((command | getline header) > 0) {
      name = header
      sub(/.*\//, "", name)
      if (name != "pendres.h") printf ".TP\n.B <pendres/%s>\n%s\n", name, purpose(header)
    }
    next
  }
  /^@EXAMPLE@/ { copy("examples/resonance.c"); next }
  { gsub(/@VERSION@/, version); gsub(/@DATADIR@/, datadir); print }' man/pendres.3.in
