"""Result files of the program `resonance`, as xarray sees them."""
import numpy as np


def open(path, group=None):  # pylint: disable=redefined-builtin
    """A result file, or one of its groups ("paper", "provenance"), as an xarray Dataset, read into
    memory. Every result stands beside its NAME_error; units and meanings are in attributes."""
    import xarray
    engines = [name for name, module in (("h5netcdf", "h5netcdf"), ("netcdf4", "netCDF4"))
               if _importable(module)]
    if not engines:
        raise ImportError("h5netcdf or netCDF4 is needed to open files (Debian: "
                          "python3-h5netcdf)")
    with xarray.open_dataset(path, engine=engines[0], group=group) as data:
        return data.load()


def words(variable):
    """Labels as words: an array of the flag_meanings of a variable's values, "" for others."""
    if "flag_values" not in getattr(variable, "attrs", {}):
        raise TypeError("a variable of a file that has labels (flag_values) is wanted, not "
                        f"{variable!r:.40}")
    values = np.ravel(variable.attrs["flag_values"])
    meanings = dict(zip(values.tolist(), variable.attrs["flag_meanings"].split()))
    return variable.copy(data=np.vectorize(lambda value: meanings.get(value, ""), otypes=[object])(
        variable.values))


def _importable(name):
    from importlib.util import find_spec
    return find_spec(name) is not None
