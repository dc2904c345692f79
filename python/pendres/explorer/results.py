"""A file of results: which of its variables can be drawn, their pictures, and the parameters at a
point of it."""
import numpy as np

from .. import _files
from .settings import ABSENT, KNOBS, Settings
from .views import Picture


class Results:
    """A file, read once."""

    def __init__(self, path):
        self.data = _files.open(path)
        self.names = [name for name, variable in self.data.data_vars.items()
                      if 0 < variable.ndim <= 2 and variable.dtype.kind in "fiu"
                      and not name.endswith("_error") and variable.size > 1]
        if not self.names:
            raise ValueError(f"{path}: no variable of one or two dimensions")

    def _variable(self, name):
        """With x across, as basins are drawn."""
        variable = self.data[name]
        return variable.T if variable.dims == ("x", "v") else variable

    def words(self, name):
        """A title, and what its axes are called."""
        variable = self._variable(name)
        its = _axis(variable)
        across = [_axis(self.data[d]) if d in self.data.coords else d for d in variable.dims]
        return (name, across[0], its) if variable.ndim == 1 else (name, across[1], across[0])

    def _along(self, name):
        return np.asarray(self.data[name].values, dtype=float) if name in self.data.coords else (
            np.arange(self.data.sizes[name], dtype=float))

    def picture(self, name):
        """A variable over its axes; with the largest of its errors."""
        variable = self._variable(name)
        values = np.asarray(variable.values, dtype=float)
        error = self._variable(name + "_error") if name + "_error" in self.data else None
        missing = int(np.count_nonzero(~np.isfinite(values)))
        note = (f"{variable.attrs.get('long_name', name)}; {missing} of {values.size} values are "
                "missing")
        rows = [(f"{what}", float(f(values)), float("nan") if error is None else float(
            np.asarray(error.values).ravel()[getattr(np, "nanarg" + what)(values)]))
            for what, f in (("min", np.nanmin), ("max", np.nanmax)) if np.isfinite(values).any()]
        if variable.ndim == 1:
            return Picture({"result": (self._along(variable.dims[0]), values)}, rows=rows, note=note)
        names = None
        if "flag_values" in variable.attrs:
            known = np.ravel(variable.attrs["flag_values"]).astype(float)
            names = variable.attrs["flag_meanings"].split()
            values = np.select([values == k for k in known], range(known.size), np.nan)
            rows = [(word, float(np.mean(values == k)), float("nan"))
                    for k, word in enumerate(names) if np.any(values == k)]
        y, x = (self._along(d) for d in variable.dims)
        return Picture({}, (values, names, _ends(x), _ends(y)), rows, note)

    def at(self, name, x, y):
        """The knobs at a place of a picture, as far as the file tells them, and its model."""
        dims = self._variable(name).dims
        here = dict(zip(dims, (x,) if len(dims) == 1 else (y, x)))
        given = {k: float(v) for k, v in self.data.variables.items()
                 if v.ndim == 0 and v.dtype.kind == "f"} | here
        found = {k: float(given[k]) for k in KNOBS if k in given}
        found |= {k: float(here[k]) for k in ("x", "v") if k in here}
        found = {k: value for k, value in found.items() if np.isfinite(value)}
        found = {k: 0.0 for k in ABSENT if k not in self.data.variables} | found
        return found | Settings.model_of([given.get(f"a{k}", 0.0) for k in range(1, 6)])


def _axis(variable):
    unit = variable.attrs.get("units", "1")
    return variable.attrs.get("long_name", variable.name) + ("" if unit in ("", "1") else f" ({unit})")


def _ends(along):
    """From where to where cells around these places reach."""
    if along.size < 2:
        return float(along[0]) - 0.5, float(along[0]) + 0.5
    return (float(1.5 * along[0] - 0.5 * along[1]), float(1.5 * along[-1] - 0.5 * along[-2]))
