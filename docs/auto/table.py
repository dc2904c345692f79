#!/usr/bin/env python3
"""What compare.auto and pendres.c print, as a table.

    python3 table.py pendres.txt auto_20.txt auto_40.txt ...

The last file's numbers are printed; of every file the difference from libpendres.
"""
import sys


def read(path):
    with open(path) as lines:
        rows = [line.replace("RESULT", "").split() for line in lines]
    return {row[0]: row[1:] for row in rows if len(row) > 1}


ours, *autos = [read(path) for path in sys.argv[1:]]
print("| quantity | AUTO-07p | libpendres | error |" + " difference |" * len(autos))
print("|---|---|---|---|" + "---|" * len(autos))
for name, (value, error) in ours.items():
    if name in autos[-1]:
        away = ["%.0e" % abs(float(auto[name][0]) - float(value)) if name in auto else ""
                for auto in autos]
        print("| " + " | ".join([name, autos[-1][name][0], value, error, *away]) + " |")
