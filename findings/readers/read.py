#!/usr/bin/env python3
"""Read all numbers of an HDF5 file's root with one reader, or with all, beside what h5py reads.

    read.py table FILE NAME...   a line for each reader and each dataset so named; none: all of them
    read.py READER FILE          NAME, a tab and its numbers, or ! and what the reader said

Readers run in processes of their own, since some end the process. $READERS is where install.sh has
put those that are not Python's.
"""
import glob
import importlib.metadata
import os
import pathlib
import subprocess
import sys
import warnings

HERE = pathlib.Path(__file__).parent
WHERE = os.environ.get("READERS", ".")
PYTHONS = {"h5py": "h5py", "pyfive": "pyfive", "h5netcdf": "h5netcdf",
           "netCDF4": "netCDF4", "kerchunk (zarr)": "kerchunk",
           "kerchunk (xarray)": "kerchunk", "VirtualiZarr": "virtualizarr", "hidefix": "hidefix"}
OTHERS = {"h5wasm": ["node", f"{WHERE}/npm/read.mjs", "h5wasm"],
          "jsfive": ["node", f"{WHERE}/npm/read.mjs", "jsfive"],
          "jhdf": ["java", "-cp", f"{WHERE}/jhdf/jars/*", str(HERE / "Read.java")]}


def numbers_of(group):
    import h5py
    return {key: item[()] for key, item in group.items()
            if isinstance(item, h5py.Dataset) and item.dtype.kind in "if"}


def kerchunk_references(name):
    from kerchunk.hdf import SingleHdf5ToZarr
    return SingleHdf5ToZarr(name, inline_threshold=0).translate()


def virtual_store(name):
    from obspec_utils.registry import ObjectStoreRegistry
    from obstore.store import LocalStore
    from virtualizarr.parsers import HDFParser
    # It does not know texts of variable length, of which these groups hold some.
    parser = HDFParser(drop_variables=["paper", "provenance"])
    return parser(url="file://" + name, registry=ObjectStoreRegistry({"file://": LocalStore()}))


def opened(reader, name):
    """A mapping from names to what numpy.asarray makes numbers of."""
    import xarray
    if reader == "h5py":
        import h5py
        return numbers_of(h5py.File(name))
    if reader == "pyfive":
        import pyfive
        file = pyfive.File(name)
        return {key: file[key][()] for key in file if hasattr(file[key], "dtype")}
    if reader == "kerchunk (zarr)":
        import zarr
        return dict(zarr.open_group("reference://", mode="r", zarr_format=2, storage_options={
            "fo": kerchunk_references(name)}).arrays())
    if reader == "kerchunk (xarray)":
        return xarray.open_dataset("reference://", engine="zarr", backend_kwargs={
            "consolidated": False,
            "storage_options": {"fo": kerchunk_references(name)}}).variables
    if reader == "VirtualiZarr":
        return xarray.open_zarr(virtual_store(name), consolidated=False, zarr_format=3).variables
    return xarray.open_dataset(name, engine=reader.lower()).variables


def read(reader, name):
    import numpy
    warnings.simplefilter("ignore")
    variables = opened(reader, name)
    for key in variables:
        try:
            value = variables[key]
            value = numpy.asarray(value[...] if reader == "kerchunk (zarr)" else value)
            print(key, " ".join(repr(float(v)) for v in value.ravel()), sep="\t")
        except Exception as error:
            print(key, "!" + str(error).splitlines()[0], sep="\t")


def version_of(reader):
    if reader in PYTHONS:
        return importlib.metadata.version(PYTHONS[reader])
    if reader == "jhdf":
        return pathlib.Path(glob.glob(f"{WHERE}/jhdf/jars/jhdf-*.jar")[0]).stem.split("-")[1]
    text = pathlib.Path(WHERE, "npm/node_modules", reader, "package.json").read_text()
    return __import__("json").loads(text)["version"]


def answers(reader, name):
    """What it says of each dataset."""
    command = OTHERS.get(reader) or [sys.executable, __file__, reader]
    ran = subprocess.run(command + [name], capture_output=True, text=True, timeout=300,
                         env=os.environ | {"READERS": WHERE})
    said = dict(line.split("\t", 1) for line in ran.stdout.splitlines() if "\t" in line)
    return said, [line for line in ran.stderr.splitlines() if line.strip()][-1:]


def verdict(text, wanted):
    import numpy
    if text is None:
        return "not there"
    if text.startswith("!"):
        return "refused"
    found = numpy.array(text.split(), dtype=float)
    wanted = numpy.asarray(wanted, dtype=float).ravel()
    if numpy.array_equal(found, wanted, equal_nan=True):
        return "right"
    if found.shape == wanted.shape and numpy.isnan(found[found != wanted]).all():
        return "NaN" if numpy.isnan(found).all() else "zeros are NaN"
    return "zeros" if not found.any() else "wrong"


def table(name, names):
    import h5py
    with h5py.File(name) as file:
        wanted = {key: v for key, v in numbers_of(file).items() if v.size}  # others matter to nobody
    there = [r for r in [*PYTHONS, *OTHERS]
             if r in PYTHONS or os.path.isdir(f"{WHERE}/{'jhdf' if r == 'jhdf' else 'npm'}")]
    for reader in there:
        said, last = answers(reader, name)
        found = {key: verdict(said.get(key), wanted[key]) for key in names or wanted}
        title = f"{reader} {version_of(reader)}"
        if names:
            for key in names:
                print(f"{title:26} {key:24} {found[key]}")
        else:
            kinds = sorted(set(found.values()))
            print(f"{title:26} " + ", ".join(
                f"{kind}: {sum(v == kind for v in found.values())}" for kind in kinds))
        if not said:
            print(f"{title:26} the whole file: {' '.join(last)[:120]}", file=sys.stderr)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    if sys.argv[1] == "table":
        table(os.path.abspath(sys.argv[2]), sys.argv[3:])
    else:
        read(sys.argv[1], sys.argv[2])
