"""Result files of the program `resonance`, as xarray sees them."""
import functools
import os

import numpy as np


# What is called otherwise in these units: {unit: (in the model's, in the laboratory's words)}.
SAID = {"Hz": ("angular frequency", "frequency"), "A": ("constant torque", "current"),
        "V": ("mean velocity of x", "mean voltage")}


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
    path = _source_of(path)
    with xarray.open_dataset(path, engine=reader, group=group) as data:
        found = data.load()
    found.encoding.update(source=os.path.abspath(path), group=group)
    _accessor()
    return found


@functools.lru_cache(maxsize=None)
def _accessor():
    """Datasets get `dataset.pendres.plot()`."""
    import xarray

    @xarray.register_dataset_accessor("pendres")
    class Results:  # pylint: disable=unused-variable
        """What is asked of a Dataset that holds results."""

        def __init__(self, data):
            self._data = data

        def plot(self, **chosen):
            """As pendres.plot(dataset)."""
            return plot(self._data, **chosen)


def plot(data, **chosen):
    """The picture of a scene's results, as plots/plot.py draws it: a matplotlib Figure, of an outer
    axis a list of them if they are not one picture. data is what a scene's function or
    pendres.open gave, or the name of a file.

    Choices: size=(width, height) in inches, title=False, frequency=True (in place of periods),
    unit (the natural frequency in Hz), boundary=False, ensemble=True, surface=True.
    """
    try:
        from .plots.drawn import figures
    except ImportError as why:
        raise ImportError(f"pictures need {why.name}: pip install 'pendres[plots]' (Debian: "
                          "python3-h5py python3-matplotlib)") from None
    return figures(_whole(data), **chosen)


def _whole(data):
    """The file of what is all that it holds: a selection would be drawn as if it were none."""
    path = _source_of(data)
    named = isinstance(data, (str, os.PathLike))
    if not named and not open(path, data.encoding.get("group")).equals(data):
        raise ValueError("a picture is that of a whole file, and this is no longer what the file "
                         "holds: draw parts of it by data.NAME.plot(), as xarray does")
    return path


def _source_of(data):
    """The file that a Dataset came from, or that is named."""
    if isinstance(data, (str, os.PathLike)):
        return os.fspath(data)
    source = getattr(data, "encoding", {}).get("source", "")
    if not os.path.exists(source):
        raise FileNotFoundError("the Dataset's file is gone, or it has none: what a scene's function "
                                "or pendres.open gave is wanted, while it lives")
    return source


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
            model, laboratory = SAID.get(attributes["units"], ("", ""))
            if model and model in attributes.get("long_name", ""):
                attributes["long_name"] = attributes["long_name"].replace(model, laboratory)
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
