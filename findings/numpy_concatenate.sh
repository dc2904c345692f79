#!/bin/sh
# numpy_concatenate.sh -- arrays of a C structure, put one behind the other by numpy.
#
# Guess: numpy.concatenate of arrays of one and the same dtype gives that dtype.
# Seen with numpy 2.4.6 (1.26.4 as well): it does, unless the structure ends in padding. Then the
# promotion of the dtype with itself packs the fields, and the result has smaller elements at other
# offsets. Whoever hands its memory to C by the structure's size reads wrong numbers from the second
# element on. stack, append, hstack do the same; a copy or an index does not. What helps:
# result.astype(dtype), which numpy calls an equivalent cast.
#
# Exits with 1 if that has changed.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet numpy==2.4.6
"$work/venv/bin/python" - <<'CODE'
import numpy as np
assert np.__version__ == "2.4.6"
padded = np.dtype({"names": ["x", "period"], "formats": ["f8", "i4"], "offsets": [0, 8],
                   "itemsize": 16})       # struct { double x; int period; }
full = np.dtype([("x", "f8"), ("period", "i8")])
a, b = np.zeros(2, padded), np.zeros(2, full)
a["x"], b["x"] = (1.0, 2.0), (1.0, 2.0)
joined = np.concatenate([a, a])
print("padded:", a.dtype.itemsize, "->", joined.dtype.itemsize)
print("full:  ", b.dtype.itemsize, "->", np.concatenate([b, b]).dtype.itemsize)
assert joined.dtype != padded and joined.dtype.itemsize == 12
assert np.concatenate([b, b]).dtype == full
assert a.copy().dtype == padded and a[[0, 1]].dtype == padded
for function in (np.append, lambda p, q: np.stack([p, q]), lambda p, q: np.hstack([p, q])):
    assert function(a, a).dtype.itemsize == 12
# As C would read it: the second element.
as_c = np.frombuffer(joined.tobytes() + bytes(16), padded)
print("x of the second element:", joined["x"][1], "by numpy,", as_c["x"][1], "by C")
assert joined["x"][1] == 2.0 and as_c["x"][1] != 2.0
assert np.array_equal(joined.astype(padded, casting="equiv")["x"], [1, 2, 1, 2])
CODE
