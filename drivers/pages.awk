# pages.awk -- pages in Markdown as strings of C for pages.c: '@' is a page, '#' a heading, 'H' the
# head of a table, 'R' a row of it, 'P' a paragraph. A paragraph or an item of a list that begins with
# words in bold is a row, too. Code is left out, and marks are.
function emit(line)
{
  gsub(/\\\|/, bar, line)  # a bar within a cell
  while (match(line, /!?\[[^]]*\]\([^)]*\)/)) {
    link = substr(line, RSTART, RLENGTH)
    text = substr(link, index(link, "[") + 1)
    sub(/\].*/, "", text)
    line = substr(line, 1, RSTART - 1) text substr(line, RSTART + RLENGTH)
  }
  gsub(/`|\*\*/, "", line)
  gsub(/\\/, "\\\\", line)
  gsub(/"/, "\\\"", line)
  print "\"" line "\","
}
function flush(mark)
{
  if (held != "") emit(mark held)
  held = ""
}
BEGIN { bar = "\302\246" }
FNR == 1 { flush(kind); code = 0; emit("@" FILENAME) }
/^```/ { code = !code; flush(kind) }
code || /^    |^<!--|^```/ { next }
/^\|[-| :]*$/ { flush("H"); next }
/^\|/ { flush(kind); kind = "R"; held = substr($0, 2); next }
/^(- )?\*\*[^*]*([:.]\*\*|\*\*[:.]) / {
  flush(kind)
  emit("H")
  gsub(/\|/, bar)
  held = $0
  sub(/^- /, "", held)
  sub(/([:.]\*\*|\*\*[:.]) /, "** | ", held)
  kind = "R"
  next
}
/^#/ { flush(kind); sub(/^#+ */, ""); emit("#" $0); next }
/^$|^- / { flush(kind); kind = "P" }
/[^ ]/ {
  sub(/^ +/, "")
  if (held == "") kind = "P"
  held = held (held != "" ? " " : "") $0
}
END { flush(kind) }
