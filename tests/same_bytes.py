#!/usr/bin/env python3
"""Compare the results in two files byte by byte.

    same_bytes.py BEFORE NOW

Both may be folders: then each file of BEFORE that ends in .h5 is compared with that of its name.
Datasets and attributes of all groups but `provenance`, without what tells a run's date or time, or
the version of the program.
Prints a line a difference. Exit code 0: the same; 1: not.
"""
import os
import sys

import h5py
import numpy

LEFT_OUT_GROUPS = {"provenance"}
LEFT_OUT_ATTRIBUTES = {"history", "source"}
# Object references are addresses in the file, not results.
SCALES = {"DIMENSION_LIST", "REFERENCE_LIST"}
TIMINGS = {"seconds", "throughput"}


def contents(name):
    """Every dataset and attribute: path -> (type, shape, bytes)."""
    found = {}

    def add(path, value):
        value = numpy.asarray(value)
        raw = repr(value.tolist()).encode() if value.dtype.kind == "O" else value.tobytes()
        found[path] = (str(value.dtype), value.shape, raw)

    def attributes(path, item):
        for key, value in item.attrs.items():
            if key not in LEFT_OUT_ATTRIBUTES | SCALES:
                add(f"{path}@{key}", value)

    def look(path, item):
        parts = path.split("/")
        if parts[0] in LEFT_OUT_GROUPS or parts[-1] in TIMINGS:
            return
        attributes(path, item)
        if isinstance(item, h5py.Dataset):
            add(path, item[()])

    with h5py.File(name, "r") as f:
        attributes("", f)
        f.visititems(look)
    return found


def size_of(before, now):
    """How far two arrays of numbers are apart, in words."""
    a, b = (numpy.frombuffer(v[2], dtype=v[0]) for v in (before, now))
    different = numpy.flatnonzero(~((a == b) | ((a != a) & (b != b))))
    if len(different) == 0:
        return "signs of zero or of NaN"
    furthest = numpy.nanmax(numpy.abs(a[different].astype(float) - b[different].astype(float)))
    return f"{len(different)} of {len(a)} values, by up to {furthest:.2g}"


def main(before_name, now_name):
    label = os.path.splitext(os.path.basename(now_name))[0]
    if not (os.path.exists(before_name) and os.path.exists(now_name)):
        print(f"{label}: no file")
        return 1
    before, now = contents(before_name), contents(now_name)
    lines = [f"{path}: gone" for path in before if path not in now]
    lines += [f"{path}: new" for path in now if path not in before]
    for path in before:
        if path in now and before[path] != now[path]:
            a, b = before[path], now[path]
            how = "other type or shape"
            if a[:2] == b[:2]:
                how = size_of(a, b) if numpy.dtype(a[0]).kind in "fiu" else "other text"
            lines.append(f"{path}: {how}")
    for line in lines:
        print(f"{label}: {line}")
    if not lines:
        print(f"{label}: same, {len(now)} datasets and attributes")
    return 1 if lines else 0


def compare(before, now):
    if not os.path.isdir(before):
        return main(before, now)
    names = sorted(n for n in os.listdir(before) if n.endswith(".h5"))
    if not names:
        print(f"{before}: no files")
        return 1
    return max([main(os.path.join(before, n), os.path.join(now, n)) for n in names])


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(compare(sys.argv[1], sys.argv[2]))
