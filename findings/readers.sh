#!/bin/sh
# readers.sh -- what readers other than HDF5's own library make of layouts and filters of HDF5, on a
# file made by h5py: why the library's files have the layout that they have (src/store/dataset.c).
#
# Observed with the versions of readers/install.sh: arrays stored compact come as NaN from kerchunk
# and VirtualiZarr without a word, jsfive refuses them, hidefix knows none of the file's variables
# that are so; kerchunk leaves out what has Fletcher32, hidefix refuses the whole file; kerchunk's
# whole numbers 0 come as NaN from xarray, since the fill value 0 is taken for a mark of what is
# missing. The table is readers/expected.txt; the exit code is 1 where it has changed (--renew writes
# it anew). Needs the network, for packages; READERS is a folder for them, kept.
set -u
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
readers=${READERS:-$work}
export READERS="$readers"
. "$here/readers/install.sh"

"$readers/venv/bin/python" - "$work/layouts.h5" "$work/fletcher.h5" <<'END' || exit 1
import sys
import h5py
import numpy


def put(file, name, values, layout, filters=""):
    made = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    if layout == "chunked":
        made.set_chunk(values.shape)
        for letter in filters:
            {"s": made.set_shuffle, "d": made.set_deflate, "f": made.set_fletcher32}[letter]()
    else:
        made.set_layout(getattr(h5py.h5d, layout.upper()))
    if values.dtype.kind == "f":
        made.set_fill_value(numpy.array(numpy.nan))
    space = h5py.h5s.create_simple(values.shape) if values.ndim else h5py.h5s.create(h5py.h5s.SCALAR)
    data = h5py.h5d.create(file.id, name.encode(), h5py.h5t.py_create(values.dtype), space, made)
    data.write(h5py.h5s.ALL, h5py.h5s.ALL, values)
    for dimension, scale in zip(file[name].dims, ("row", "column")):
        dimension.attach_scale(file[scale])


kinds = {"scalar": numpy.array(2.5), "array": numpy.arange(1, 244.0).reshape(3, 81),
         "whole": numpy.arange(243).reshape(3, 81)}
for name, filters in (sys.argv[1], ("", "sd")), (sys.argv[2], ("", "sdf")):
    with h5py.File(name, "w") as file:
        for scale, n in ("row", 3), ("column", 81):
            file[scale] = numpy.arange(1.0, n + 1)
            file[scale].make_scale(scale)
        for kind, values in kinds.items():
            if filters[1] == "sd":
                put(file, kind + "_compact", values, "compact")
            put(file, kind + "_contiguous", values, "contiguous")
            for f in filters if values.ndim else ():
                put(file, f"{kind}_chunked{'_' + f if f else ''}", values, "chunked", f)
END

read="$readers/venv/bin/python $here/readers/read.py table"
{
  $read "$work/layouts.h5" scalar_compact scalar_contiguous array_compact array_contiguous \
    array_chunked array_chunked_sd whole_contiguous
  $read "$work/fletcher.h5" array_contiguous array_chunked array_chunked_sdf
} >"$work/found.txt"
case ${1:-} in
  --renew) cp "$work/found.txt" "$here/readers/expected.txt" ;;
esac
cat "$work/found.txt"
if ! diff "$here/readers/expected.txt" "$work/found.txt"; then
  echo "readers.sh: readers do otherwise than they did (<)" >&2
  exit 1
fi
