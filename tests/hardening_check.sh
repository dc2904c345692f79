#!/bin/sh
# hardening_check.sh -- program and shared library are built with Debian's protections by default:
# relocations read-only once it has started (full RELRO, BIND_NOW), arrays on the stack guarded, and
# functions of the C library that know the size of what they write. Skipped where the builder has
# flags of his own. Run by make check, which sets BUILD and RESONANCE.
set -u
export LC_ALL=C
[ -z "${CFLAGS+set}${LDFLAGS+set}" ] || { echo "hardening_check: skipped, own flags"; exit 77; }
command -v readelf >/dev/null || { echo "hardening_check: skipped, no readelf"; exit 77; }
failed=0
for file in "${RESONANCE:-./resonance}" "${BUILD:-build}"/libpendres.so; do
  told=$(readelf -lWd "$file" && readelf -W --dyn-syms "$file") || exit 1
  # Each with a pattern: GNU_RELRO is a segment, BIND_NOW a flag in one of two forms.
  while read -r what pattern; do
    printf '%s\n' "$told" | grep -q -e "$pattern" ||
      { echo "hardening_check: $file: no $what"; failed=1; }
  done <<END
RELRO GNU_RELRO
BIND_NOW (FLAGS.*\\(BIND_NOW\\|NOW\\)
stack-protector __stack_chk_fail
FORTIFY __[a-z]*_chk@
position-independence DYN
END
done
exit $failed
