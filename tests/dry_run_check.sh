#!/bin/sh
# dry_run_check.sh -- what --dry-run predicts beside what runs take, of a few random decks
# (dry_run_decks.py). Those that take longer than two seconds are ended.
set -u
top=$(cd "$(dirname "$0")/.." && pwd)
exec "${PYTHON:-/usr/bin/python3}" "$top/tests/dry_run_decks.py" "$RESONANCE" 6 11 2
