#!/usr/bin/env python3
"""Write docs/results.md: every variable of files of results, as small runs of each kind have it.

    results_list.py PROGRAM DECK.nml ... >docs/results.md
"""
import os
import re
import subprocess
import sys
import tempfile

import h5py

HEAD = """# Results: the variables of files

<!-- Written by `make results-reference` from files that the decks of tests/kinds make: what is said here
     of a variable is what its attributes `long_name`, `units` and `comment` say. -->

Every variable that a file may have, by its name, with the scenes that write it and the dimensions that it is
over, and of angles the unit. Each that has an error has it beside it, as `NAME_error`. Parameters that the
deck holds fixed are coordinates without dimension. `resonance --explain=loop_area` prints what stands here of a
variable, and of those whose names begin with it. Of switching, `..._la_sa` is from LA to SA, `..._1_2` from
attractor 1 to 2, `..._well_sa` from SA to another well. Over an outer axis `NAME_length` is how long dimension
NAME is at each value, and `..._failed` says why there is no whole result.

| result | of | over | what |
|---|---|---|---|
"""

# Labels as many as these are listed once.
LONG_LIST = 6


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def attribute(of, name):
    return text(of.attrs[name]) if name in of.attrs else ""


def meaning(variable):
    said = [attribute(variable, name) for name in ("long_name", "comment")]
    unit = attribute(variable, "units")
    if said[1].startswith(said[0]):  # a definition that begins with the name
        del said[0]
    if unit != "1" and f"in {unit}" not in said[-1]:
        said.append("in " + unit)
    return "; ".join(part for part in said if part)


def values(names, name, listed):
    """The labels of a variable or, of a long list that came before, where it stands."""
    if names not in listed:
        listed[names] = name
    before = listed[names]
    if not names:
        return ""
    if before != name and names.count(" ") + 1 >= LONG_LIST:
        return f"; values as of `{before}`"
    return "; values: " + names.replace(" ", ", ")


def read(path, known):
    """Add the variables of a file to known: (name, meaning, labels) -> dimensions -> kinds."""
    with h5py.File(path, "r") as file:
        kind = attribute(file, "scene")
        outer = attribute(file, "outer_axis")
        fixed = [*attribute(file, "coordinates").split(), outer]
        for name, variable in file.items():
            plain = isinstance(variable, h5py.Dataset) and name not in fixed
            if not plain or name.endswith("_error") or (kind, name) in known["seen"]:
                continue
            known["seen"].add((kind, name))
            is_scale = attribute(variable, "CLASS") == "DIMENSION_SCALE"
            over = () if is_scale else tuple(
                os.path.basename(d[0].name) if len(d) else "" for d in variable.dims)
            over = tuple("outer axis" if name == outer else name for name in over)
            if is_scale and not meaning(variable):
                continue
            row = (name, meaning(variable), attribute(variable, "flag_meanings"))
            known["rows"].setdefault(row, {}).setdefault(over, []).append(kind)


def of_states(said):
    """The same of any state, or of the way from any to another."""
    one = r"(attractor \d|the (large|small)-amplitude state)"
    way = rf"from (the (large|small)- to the (large|small)-amplitude state|{one} to (attractor \d|another well))"
    return re.sub(one, "that state", re.sub(way, "from the one state to the other", said))


def families(rows):
    """Results that differ only in the states that they are of, as one row with all their names."""
    found = {}
    for (name, said, names), places in sorted(rows.items()):
        key = (name, said)
        if of_states(said) != said and all(some == ["switching"] for some in places.values()):
            key = ("", of_states(said))
        elif re.match("(bifurcation|fold|flip|branch|jump|step|attractor|cusp)_", name):
            key = ("", said)  # of each place
        elif name.startswith("bias_cov_"):
            key = ("", re.sub(r"_(xx|xv|vv)\b", "_...", said))
        found.setdefault((*key, names), []).append((name, places))
    rows = []
    for (_, said, names), members in found.items():
        places = {}
        for _, own in members:
            for over, kinds in own.items():
                places.setdefault(over, []).extend(kinds)
        rows.append((members[0][0], [name for name, _ in members], said, names, places))
    return sorted(rows, key=lambda row: row[0])


def main(program, decks):
    known = {"seen": set(), "rows": {}}
    with tempfile.TemporaryDirectory() as folder:
        paths = []
        for deck in decks:
            path = os.path.join(folder, os.path.basename(deck)[:-4] + ".h5")
            run = subprocess.run([program, "--quiet", "-o", path, deck], capture_output=True)
            if run.returncode not in (0, 3):  # 3: some points failed
                sys.exit(f"{deck}: {run.stderr.decode()}")
            with h5py.File(path, "r") as file:
                paths.append(("a1" in file, path))  # words of pendulums before those of others
        for _, path in sorted(paths):
            read(path, known)
    print(HEAD, end="")
    listed = {}
    for name, members, said, names, places in families(known["rows"]):
        if name.endswith("_length") and said.startswith("length of the dimension"):
            continue
        over = sorted({", ".join(dimensions) for dimensions in places})
        kinds = sorted({kind for some in places.values() for kind in some})
        cells = (", ".join(f"`{member}`" for member in members), ", ".join(kinds), " or ".join(o for o in over if o),
                 said + values(names, name, listed))
        print("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
