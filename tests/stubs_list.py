#!/usr/bin/env python3
"""stubs_list.py -- python/pendres/__init__.pyi: what type checkers and editors know of the package,
from the package itself. Written by `make python-stubs`; python_check.py compares."""
import enum
import inspect
import types

import pendres

ARRAY, DATA = "np.recarray", "xarray.Dataset"
# What functions give, and what objects hold, beyond what their definitions say.
GIVES = {
    "activation": "Any", "array": "np.ndarray", "attractors": "Attractors", "backbone":
    f"tuple[{ARRAY}, np.ndarray, np.ndarray]", "basins": "Basins", "boundary": "Boundary",
    "branches": "list[Branch]", "cloud": "Any", "curves": "list[Curve]", "dtype": "np.dtype",
    "ensemble": ARRAY, "explain": "str", "free_frequency": "Any", "hysteresis": "Hysteresis",
    "kinds": "dict[str, str]", "open": DATA, "pendulum": ARRAY, "phase_line":
    f"tuple[{ARRAY}, list[Branch]]", "pint_units": "str", "resonance": "np.record", "response": ARRAY,
    "run": DATA, "settle": f"tuple[{ARRAY}, {ARRAY}]", "strobe_advance": "Any", "strobe_record":
    "tuple[np.ndarray, np.ndarray]", "table": ARRAY, "options": "np.record", "cost": "np.record",
    "message": "str", "list": "list[Any]", "at": ARRAY}
HOLDS = {
    "Basins": {"x": "np.ndarray", "v": "np.ndarray", "attractors": "Attractors", "state": ARRAY,
               "fraction": "np.ndarray", "fraction_error": "np.ndarray", "statistics": "np.ndarray"},
    "Boundary": {"x": "np.ndarray", "v": "np.ndarray", "error": "np.ndarray", "piece": "np.ndarray",
                 "bound": "float", "complete": "bool"},
    "Branch": {"points": ARRAY, "bifurcations": ARRAY, "ends": "tuple[int, int]"},
    "Curve": {"points": ARRAY, "cusps": ARRAY},
    "Hysteresis": {"points": ARRAY, "jumps": ARRAY, "steps": ARRAY}}


def parameter(its):
    star = {its.VAR_POSITIONAL: "*", its.VAR_KEYWORD: "**"}.get(its.kind, "")
    if star or its.default is its.empty:
        return f"{star}{its.name}: Any" if its.name != "self" else "self"
    kind = type(its.default).__name__ if isinstance(its.default, (float, int, str)) else "Any"
    return f"{its.name}: {kind} = ..."


def call(name, function, indent=""):
    parts, starred = [], False
    for its in inspect.signature(function).parameters.values():
        if its.kind is its.KEYWORD_ONLY and not starred:
            parts.append("*")
        starred |= its.kind in (its.KEYWORD_ONLY, its.VAR_POSITIONAL)
        parts.append(parameter(its))
    gives = "None" if name in ("__init__", "__exit__") else GIVES.get(name, "Any")
    return f"{indent}def {name}({', '.join(parts)}) -> {gives}: ..."


def of_class(name, kind):
    bases = ", ".join("enum.IntEnum" if base is enum.IntEnum else base.__name__
                      for base in kind.__bases__ if base.__module__ in ("builtins", "enum")
                      or base.__name__ in vars(pendres)) or "object"
    lines = [f"    {key}: {what}" for key, what in HOLDS.get(name, {}).items()]
    if issubclass(kind, enum.IntEnum):
        lines = [f"    {member.name} = {int(member)}" for member in kind]
    elif not issubclass(kind, Exception):
        for key, its in sorted(vars(kind).items()):
            if isinstance(its, property):
                lines.append(f"    @property\n    def {key}(self) -> {GIVES.get(key, 'Any')}: ...")
            elif isinstance(its, types.FunctionType) and (
                    not key.startswith("_") or key in ("__init__", "__len__", "__enter__")):
                lines.append(call(key, its, "    "))
    return f"class {name}({bases}):\n" + ("\n".join(lines) or "    ...")


def text():
    names = {name: its for name, its in vars(pendres).items() if not name.startswith("_") and
             not isinstance(its, types.ModuleType) and name not in pendres.kinds()}
    beside = pendres._beside  # pylint: disable=protected-access
    names.update(beside)
    classes = [name for name, its in names.items() if inspect.isclass(its)]
    classes.sort(key=lambda name: (len(names[name].__mro__), name != "Error", name))
    lines = ["# Made by `make python-stubs` from the package itself.", "import enum",
             "from typing import Any, overload", "", "import numpy as np", "import xarray", "", "__version__: str"]
    lines += [of_class(name, names[name]) for name in classes]
    for name, its in sorted(names.items()):
        if name in classes:
            continue
        scene = f"@overload\ndef {name}(**keys: Any) -> {DATA}: ..."
        lines += ["@overload"] * (name in beside)
        lines.append(call(name, its) if inspect.isfunction(its) else f"{name}: Any")
        lines += [scene] * (name in beside)
    for name in sorted(set(pendres.kinds()) - set(names)):
        lines.append(f"def {name}(**keys: Any) -> {DATA}: ...")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(text(), end="")
