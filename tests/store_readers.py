#!/usr/bin/env python3
"""Check that h5py and xarray, with both of its engines, open every group of a result file; that
h5dump, where it is installed, reads all of it, and GNU Octave and R's rhdf5 the numbers of its root.

    store_readers.py FILE...

Exit code 0: all is well; 1: it is not, and stderr says what; 77: a module is missing.
"""
import os
import shutil
import subprocess
import sys

ATTRIBUTES = ("Conventions",)
MODULES = ("h5py", "numpy", "xarray", "h5netcdf", "netCDF4")


def groups_of(name):
    """Paths of all groups, the root first."""
    import h5py
    with h5py.File(name, "r") as f:
        found = ["/"]
        f.visititems(lambda path, item: found.append("/" + path)
                     if isinstance(item, h5py.Group) else None)
    return found


def check_h5py(name):
    """Each dimension has one scale in its own group; units and long_name everywhere."""
    import h5py
    wrong = []

    def look(path, item):
        if isinstance(item, h5py.Group):
            if not item.id.get_create_plist().get_link_creation_order():
                wrong.append(f"{path}: link creation order is not tracked")
            return
        for attribute in ("units", "long_name"):
            if not isinstance(item.attrs.get(attribute), str):
                wrong.append(f"{path}: no text '{attribute}'")
        if item.dtype.kind == "i" and item.dtype.itemsize == 1 and "_FillValue" in item.attrs:
            wrong.append(f"{path}: labels have a fill value")
        if "flag_values" in item.attrs:
            values, meanings = item.attrs["flag_values"], item.attrs["flag_meanings"].split()
            if values.dtype != item.dtype or len(values) != len(meanings):
                wrong.append(f"{path}: flag_values and flag_meanings do not fit")
            masks = item.attrs.get("flag_masks", None)
            if masks is not None and (len(masks) != len(values) or
                                      any(m == 0 or v & ~m for m, v in zip(masks, values))):
                wrong.append(f"{path}: flag_masks and flag_values do not fit")
        if h5py.h5ds.is_scale(item.id):
            if item.ndim != 1 or item.shape is None:
                wrong.append(f"{path}: a scale must be one-dimensional")
            return
        for k, dimension in enumerate(item.dims):
            if len(dimension) != 1:
                wrong.append(f"{path}: dimension {k} has {len(dimension)} scales")
            elif dimension[0].parent != item.parent:
                wrong.append(f"{path}: the scale of dimension {k} is in another group")
            elif dimension[0].shape != (item.shape[k],):
                wrong.append(f"{path}: the scale of dimension {k} has another size")

    with h5py.File(name, "r") as f:
        for attribute in ATTRIBUTES:
            if not isinstance(f.attrs.get(attribute), str):
                wrong.append(f"/: no text '{attribute}'")
        look("/", f[b"/"])  # as a group: as a file it knows nothing of its links
        f.visititems(look)
    return wrong


def check_xarray(name, engine):
    """Each group opens, without invented dimensions, with the values that h5py reads."""
    import h5py
    import numpy
    import xarray
    wrong = []
    for group in groups_of(name):
        with xarray.open_dataset(name, engine=engine, group=group) as data:
            for dimension in data.sizes:
                if dimension not in data.coords:
                    wrong.append(f"{engine} {group}: dimension {dimension} has no coordinate")
            with h5py.File(name, "r") as f:
                wanted = {key: item[()] for key, item in f[group].items()
                          if isinstance(item, h5py.Dataset)}
            if set(wanted) != set(data.variables):
                differing = sorted(set(wanted) ^ set(data.variables))
                wrong.append(f"{engine} {group}: variables differ: {differing}")
                continue
            for key, values in wanted.items():
                variable = data[key].values
                if "phony" in " ".join(map(str, data[key].dims)):
                    wrong.append(f"{engine} {group}: {key} has invented dimensions")
                if getattr(values, "dtype", None) is not None and values.dtype.kind in "if":
                    same = numpy.array_equal(values, variable, equal_nan=values.dtype.kind == "f")
                    if variable.dtype != values.dtype or not same:
                        wrong.append(f"{engine} {group}: {key} differs ({variable.dtype})")
                else:
                    texts = [t.decode() for t in numpy.ravel(numpy.array(values, dtype=object))]
                    if texts != [str(t) for t in numpy.ravel(variable)]:
                        wrong.append(f"{engine} {group}: text {key} differs")
    return wrong


# Name, sizes in the order of the file (Octave's is the other way round), and numbers of all but
# structs, as groups of numbers become. Text in the root stops load unless variables are named.
OCTAVE = """
names = strsplit(getenv("NAMES"), " ");
if isempty(names{1}) names = {}; end
s = load(getenv("FILE"), names{:});
for [value, key] = s
  if isstruct(value) continue; end
  printf("%s", key);
  printf(" %d", fliplr(size(value)));
  printf(" :");
  printf(" %.17g", double(value(1:min(1000, end))));
  printf("\\n");
end
"""


# The same of R, whose order is that of Octave.
R = """
suppressPackageStartupMessages(library(rhdf5))
file <- Sys.getenv("FILE")
for (name in strsplit(Sys.getenv("NAMES"), " ")[[1]]) {
  value <- h5read(file, name, bit64conversion = "double")
  values <- as.numeric(value)
  cat(name, rev(dim(value)), ":", sprintf("%.17g", values[seq_len(min(1000, length(values)))]))
  cat("\\n")
}
"""


def root_of(name):
    """What stands in the root, and the names of the numbers in it."""
    import h5py
    with h5py.File(name, "r") as f:
        root = {key: item[()] for key, item in f.items() if isinstance(item, h5py.Dataset)}
        return root, [key for key in root if f[key].dtype.kind != "O"]


def check_printed(who, command, name, names, wanted):
    """What another program prints of a file, given what to read, beside what h5py reads."""
    import numpy
    ran = subprocess.run(command, capture_output=True, text=True,
                         env=os.environ | {"FILE": name, "NAMES": " ".join(names)})
    wrong = [f"{who}: {line}" for line in ran.stderr.splitlines()
             if not line.startswith("error: ignoring")]  # how Octave ends without a terminal
    found = {}
    for line in ran.stdout.splitlines():
        sizes, numbers = line.split(" :")
        key, *sizes = sizes.split()
        found[key] = [int(s) for s in sizes], numpy.array(numbers.split(), dtype=float)
    if set(found) != set(wanted):
        wrong.append(f"{who}: variables differ: {sorted(set(found) ^ set(wanted))}")
    for key in sorted(set(found) & set(wanted)):
        values = numpy.array(wanted[key], dtype=float)
        sizes, numbers = found[key]
        while len(sizes) > values.ndim:  # Octave's have two at least
            sizes.remove(1)
        if sizes != list(values.shape) or \
                not numpy.array_equal(numbers, values.ravel()[:1000], equal_nan=True):
            wrong.append(f"{who}: {key} differs")
    return wrong


def check_octave(name):
    """load reads every number of the root, and passes over groups with text."""
    root, numbers = root_of(name)
    names = numbers if len(numbers) < len(root) else []
    return check_printed("Octave", ["octave-cli", "--norc", "--eval", OCTAVE], name, names,
                         {key: root[key] for key in numbers})


def check_r(name):
    """h5read reads every number of the root."""
    root, numbers = root_of(name)
    return check_printed("R", ["Rscript", "-e", R], name, numbers,
                         {key: root[key] for key in numbers})


def check_h5dump(name):
    """All of the file is readable for HDF5's own tool."""
    ran = subprocess.run(["h5dump", name], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                         text=True)
    return ([] if ran.returncode == 0 else ["h5dump failed"]) + ran.stderr.splitlines()


def check_one(how, name):
    own = {"h5py": check_h5py, "octave": check_octave, "r": check_r, "h5dump": check_h5dump}
    wrong = own[how](name) if how in own else check_xarray(name, how)
    for line in wrong:
        print(line, file=sys.stderr)
    return 1 if wrong else 0


def readers():
    """All that this machine has."""
    yield from ("h5py", "h5netcdf", "netcdf4")
    if shutil.which("h5dump"):
        yield "h5dump"
    if shutil.which("octave-cli"):
        yield "octave"
    if shutil.which("Rscript") and subprocess.run(
            ["Rscript", "-e", "library(rhdf5)"], capture_output=True).returncode == 0:
        yield "r"


def main(arguments):
    if not arguments or arguments[0] in ("-h", "--help"):
        print(__doc__)
        return 0 if arguments else 2
    if arguments[0] == "--one":
        return check_one(*arguments[1:])
    import importlib.util
    missing = [m for m in MODULES if importlib.util.find_spec(m) is None]
    if missing:
        print("skipped, missing: " + ", ".join(missing))
        return 77
    failed = 0
    for how in readers():
        for name in arguments:
            # Of its own, since a library may take the whole process with it.
            code = subprocess.run([sys.executable, __file__, "--one", how, name]).returncode
            print(f"{'ok' if code == 0 else 'FAILED'} {how} {name}")
            failed += code != 0
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
