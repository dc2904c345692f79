"""Result files of the program `resonance`, as xarray sees them."""
import os

import numpy as np


def engine():
    """What reads files for xarray, which there must be."""
    names = [name for name, modules in (("h5netcdf", ("h5netcdf", "h5py")),
                                        ("netcdf4", ("netCDF4",)))
             if all(map(_importable, modules))]
    if not (names and _importable("xarray")):
        raise ImportError("xarray, with h5netcdf or netCDF4, is needed to read files of results "
                          "(Debian: python3-xarray python3-h5netcdf; or pip install xarray "
                          "h5netcdf h5py)")
    return names[0]


def open(path, group=None):  # pylint: disable=redefined-builtin
    """A result file, or one of its groups ("paper", "provenance"), as an xarray Dataset, read into
    memory. Every result stands beside its NAME_error; units and meanings are in attributes. In
    place of a file's name a Dataset will do that came from it."""
    reader = engine()
    import xarray
    if isinstance(path, xarray.Dataset):
        if not os.path.exists(path.encoding.get("source", "")):
            raise FileNotFoundError("the Dataset's file is gone: groups are read from the Dataset "
                                    "that a scene's function or pendres.open gave, while it lives")
        path = path.encoding["source"]
    with xarray.open_dataset(path, engine=reader, group=group) as data:
        found = data.load()
    found.encoding["source"] = os.path.abspath(path)
    return found


def words(variable):
    """Labels as words: an array of the flag_meanings of a variable's values, "" for others."""
    if "flag_values" not in getattr(variable, "attrs", {}):
        raise TypeError("a variable of a file that has labels (flag_values) is wanted, not "
                        f"{variable!r:.40}")
    values = np.ravel(variable.attrs["flag_values"])
    meanings = dict(zip(values.tolist(), variable.attrs["flag_meanings"].split()))
    return variable.copy(data=np.vectorize(lambda value: meanings.get(value, ""), otypes=[object])(
        variable.values))


def si(data):
    """A Dataset of a file's, or a variable of one, in units of SI: what has `si_factor` is
    multiplied by it, coordinates and errors too, and its `units` are `si_units`. That is what a
    deck with &units makes; all else stays as it is."""
    import xarray
    if isinstance(data, xarray.DataArray):
        return si(data.to_dataset(name="its values"))["its values"].rename(data.name)
    if not isinstance(data, xarray.Dataset):
        raise TypeError(f"a Dataset or a variable of one is wanted, not {data!r:.40}")
    made = {}
    for name, variable in data.variables.items():
        factor = variable.attrs.get("si_factor")
        if factor is not None:
            attributes = {**variable.attrs, "units": variable.attrs["si_units"]}
            del attributes["si_factor"], attributes["si_units"]
            made[name] = (variable.dims, variable.values * factor, attributes)
    return data.assign_coords({name: values for name, values in made.items()
                               if name in data.coords}).assign(
        {name: values for name, values in made.items() if name not in data.coords})


def pint_units(units):
    """Units as a file has them, "N m-3", in the form that pint and unyt read, "N*m**-3": powers of
    UDUNITS, which astropy reads too, mean nothing to them. A text, or what has such `units`."""
    import re
    text = units if isinstance(units, str) else units.attrs["units"]
    return re.sub(r"([^\W\d]+)(-?\d+)", r"\1**\2", text).replace(" ", "*")


def _importable(name):
    from importlib.util import find_spec
    return find_spec(name) is not None
