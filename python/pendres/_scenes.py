"""Scenes of the program `resonance` as functions, with results as xarray Datasets.

Owns: where the program is, decks made of keywords, a run of it, and its words as exceptions. Kinds
of scenes, their keys, meanings and checks are the program's, which is asked for them: a new one
needs nothing here.
"""
import base64
import enum
import functools
import hashlib
import inspect
import keyword
import numbers
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import textwrap
import warnings
import weakref

import numpy as np

from . import _files
from ._handles import force_and_coefficients, is_formula
from ._library import HERE, declared, errors, lib, of_tree

# What the program's exit codes mean (docs/files.md).
BAD_DECK, POINTS_FAILED, STOPPED = 2, 3, 75
COLUMNS = 100
TEXT = {"encoding": "utf-8", "errors": "surrogateescape"}  # whatever the environment has


# ---- The program -------------------------------------------------------------------------------


@functools.lru_cache(maxsize=None)
def _of_wheel():
    """The program that pip has put where the record beside this package says, or, by --target, into
    bin/ beside it. Others may write there: it is the one whose checksum the record has, or none."""
    import importlib.metadata  # with all that it loads, for a wheel alone
    site = os.path.dirname(HERE)
    for wheel in importlib.metadata.distributions(name="pendres", path=[site]):
        for file in wheel.files or ():
            if file.parts[-2:] != ("bin", "resonance") or not file.hash:
                continue
            for path in (os.path.normpath(wheel.locate_file(file)),
                         os.path.join(site, "bin", "resonance")):
                if os.path.isfile(path) and _checksum(path, file.hash.mode) == file.hash.value:
                    return path
    return None


def _checksum(path, mode):
    """As a record of files that pip has installed writes it."""
    with open(path, "rb") as file:
        digest = hashlib.new(mode, file.read()).digest()
    return base64.urlsafe_b64encode(digest).rstrip(b"=").decode()


def _candidates():
    """Where the program may be: in the source tree; where pip has put it; or on PATH."""
    yield of_tree("resonance")
    yield _of_wheel()
    yield shutil.which("resonance")


def program():
    """The path of the program, of the library's version."""
    chosen = os.environ.get("PENDRES_PROGRAM")
    for path in [chosen] if chosen else _candidates():
        if path and os.path.isfile(path) and os.access(path, os.X_OK):
            version = _asked(path, "--version").split("\n")[0].split()[-1]
            if version != declared.constants["PENDRES_VERSION"]:
                raise ImportError(f"{path} is version {version}, and the library is "
                                  f"{declared.constants['PENDRES_VERSION']}: install both anew")
            return path
    where = f"PENDRES_PROGRAM is '{chosen}', which is no program" if chosen else (
        "it is in none of the folders of PATH. Install it (make install), or say where it is: "
        "PENDRES_PROGRAM=/folder/resonance")
    raise FileNotFoundError(f"scenes are computed by the program resonance: {where}")


@functools.lru_cache(maxsize=None)
def _asked(path, *options):
    """What the program answers."""
    answer = subprocess.run([path, *options], stdin=subprocess.DEVNULL, capture_output=True,
                            check=False, **TEXT)
    if answer.returncode:
        words = answer.stderr.strip().split("error: ")[-1]
        raise errors[lib.PENDRES_INVALID_ARGUMENT](words or f"{path} does not run")
    return answer.stdout


def explain(word):
    """What the program knows of a kind of scene, a group or a key of decks: meaning, unit, range,
    default. print(pendres.explain("rate"))."""
    return _asked(program(), f"--explain={word}")


def kinds():
    """{kind of scene: what it is}, as the program lists them."""
    lines = _asked(program(), "--list").splitlines()
    return {kind: words for kind, words in (line.split(None, 1) for line in lines)}


def _groups_of(kind):
    """{key: the groups of a deck of that kind in which it may stand}."""
    found, group = {}, None
    for line in explain(kind).splitlines():
        keys = re.match(r"  (\w+(?:, \w+)*) = ", line)
        if line.startswith("&"):
            group = line[1:].strip()
        elif keys and group:
            for key in keys.group(1).split(", "):
                found.setdefault(key, []).append(group)
    return found


# ---- Decks -------------------------------------------------------------------------------------


def _plain(key, value):
    """A value as Python's own: a number, a string, or a list of these."""
    if isinstance(value, enum.Enum):
        return value.name.lower()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "__array__"):  # numpy, pandas, xarray
        value = np.asarray(value).tolist()
    if isinstance(value, (list, tuple, range)):
        several = [_plain(key, one) for one in value]
        if not several or any(isinstance(one, list) for one in several):
            raise ValueError(f"{key}: one value or a plain list of some is wanted, not "
                             f"{value!r:.40}")
        return several
    if isinstance(value, str) and not set(value) & set("\r\n\0"):
        return value
    if isinstance(value, numbers.Real):
        return value if isinstance(value, numbers.Integral) else float(value)
    raise TypeError(f"{key}: a number, a string of one line, or a list of these is wanted, not "
                    f"{value!r:.40}")


def _written(key, value):
    """A value as decks have it; repr gives back the same double."""
    value = _plain(key, value)
    if isinstance(value, list):
        return ", ".join(_written(key, one) for one in value)
    if isinstance(value, str):
        return "'" + value.replace("'", "''") + "'"
    if isinstance(value, bool):
        return ".true." if value else ".false."
    return repr(value)


def _deck(groups):
    """The text of a deck, and the key that each of its lines belongs to."""
    lines, keys = [], []
    for group, values in groups.items():
        lines.append(f"&{group}")
        for key, value in values.items():
            if value is not None:
                keys += [None] * (len(lines) - len(keys))
                # Strings stay on one line: lines are broken behind commas alone, outside of them.
                text = f"{key} = {_written(key, value)}"
                lines += textwrap.wrap(text, COLUMNS - 2, initial_indent="  ",
                                       subsequent_indent="    ", break_long_words=False,
                                       break_on_hyphens=False) if "'" not in text else ["  " + text]
                keys += [key] * (len(lines) - len(keys))
        lines.append("/")
    return "\n".join(lines) + "\n", keys


def _checked_groups(groups):
    for group, values in groups.items():
        if not isinstance(values, dict):
            raise TypeError(f"{group}: a group of a deck is wanted, as in {group}={{'key': value}},"
                            f" not {values!r:.40}")
    return groups


def _sorted_into_groups(kind, given):
    """{group: {key: value}} of keywords. Where &sweep has a key as well as another group, a list is
    &sweep's and one value the other's."""
    given = {key: value for key, value in given.items() if value is not None}
    if "force" in given:
        given = force_and_coefficients(given)
        if is_formula(given["force"]):
            given = given | {"force": "formula", "formula": given["force"]}
    where = {key: its for key, its in _groups_of(kind).items() if key not in ("kind", "output")}
    names = {group for its in where.values() for group in its} | set(kinds())
    groups = {"scene": {"kind": kind}}
    for word, value in given.items():
        key = word[:-1] if word.endswith("_") and keyword.iskeyword(word[:-1]) else word
        if isinstance(value, dict) and key in names:
            groups.setdefault(key, {}).update(value)
            continue
        if key in names and key not in where:
            raise TypeError(f"{key}: a group of a deck is {key}={{'key': value}}; its keys are "
                            f"keywords by themselves, too, as help(pendres.{kind}) tells")
        if key not in where:
            raise TypeError(f"{kind}() has no keyword '{key}'{_instead(kind, key)}")
        fitting = where[key]
        _check_values(key, value, where)
        if "sweep" in fitting and len(fitting) > 1:
            several = isinstance(_plain(key, value), list)
            fitting = ["sweep"] if several else [g for g in fitting if g != "sweep"]
        if len(fitting) > 1:
            raise TypeError(f"'{key}' is a key of " + " and ".join("&" + g for g in fitting) +
                            f": say which, as in {fitting[0]}={{'{key}': {value!r:.40}}}")
        groups.setdefault(fitting[0], {})[key] = value
    return groups


def deck_of(kind, keywords):
    """The text of the deck that a scene's function makes of its keywords."""
    return _deck(_sorted_into_groups(kind, keywords))[0]


def _instead(kind, key):
    """Which key may have been meant, or which scenes have it."""
    try:
        scenes = ", ".join(re.findall(r"scenes: (.*)", explain(key)))
    except errors[lib.PENDRES_INVALID_ARGUMENT] as why:
        meant = re.search(r"\(did you mean '.*?'\?\)", str(why))
        return (" " + meant.group() if meant else "") + f"; help(pendres.{kind}) tells those it has"
    if scenes:
        return f", which is for {scenes}" if scenes != "all" else ""
    # A word of the docs, as a symbol of the literature: the reader of decks knows what stands for it.
    answer = subprocess.run([program(), "--dump-namelist", "-"], capture_output=True, check=False,
                            input=f"&scene kind='{kind}' /\n&pendulum {key}=1 /\n", **TEXT)
    meant = re.search(rf"'{key}' is not a key of &pendulum( \(did you mean .*?\))", answer.stderr)
    return (meant.group(1) if meant else "") + f"; help(pendres.{kind}) tells those it has"


def _check_values(key, value, its):
    """A range that was meant is not taken for three values."""
    if not (isinstance(value, tuple) and len(value) == 3 and f"{key}_range" in its):
        return
    first, last, count = value
    whole = isinstance(count, numbers.Integral) and not isinstance(count, bool) and count > 1
    if whole and not (isinstance(first, numbers.Integral) and isinstance(last, numbers.Integral)):
        raise TypeError(f"{key}={value!r:.60}: a range is {key}_range=(first, last, count), and "
                        "values are a list")


def _as_keywords(complaints, keys):
    """The program's complaints on a deck that was made of keywords: they name these, not lines."""
    lines, shown = [], True
    for line in complaints.splitlines():
        where = re.match(r"-:(\d+):\d+: error: (.*)", line)
        if where:
            number = int(where.group(1))
            key = keys[number - 1] if number <= len(keys) else None
            shown = key not in (None, "kind")  # the line and the place in it
            words = where.group(2)
            lines.append(words if not shown or f"'{key}'" in words else f"{key}: {words}")
        elif shown:
            lines.append(line)
    if "&sweep" in complaints:
        lines.append("(&sweep has what is given as a list, or as NAME_range=(first, last, count))")
    return "\n".join(lines)


# ---- Runs --------------------------------------------------------------------------------------


def run(deck, *, output=None, threads=None, budget=None, resume=False, **groups):
    """Compute the scene that a deck describes, by the program `resonance`: an xarray.Dataset with
    all that its file of results holds, bytes and units and all; every result has its NAME_error.

    deck is a file's name, a deck's text, or a dict of groups {"scene": {"kind": ...}, ...}; groups
    as keywords set keys beside it, as in run("f02.nml", sweep={"damping": [0.2, 0.3]}).

    output names a file that is left (the deck's own `output` is not heeded); without it there is
    none, and pendres.open(dataset, "provenance") reads groups of the file while the Dataset lives.
    threads and budget (seconds a point) are the program's. resume=True goes on where a run into the
    same output was stopped. Ctrl-C stops it.

    A deck that is wrong is InvalidArgument, with all mistakes. Where points failed, which `failed`
    marks, a RuntimeWarning says so.
    """
    groups = _checked_groups(groups)
    options = {"output": output, "threads": threads, "budget": budget, "resume": resume}
    if isinstance(deck, dict):
        options["output"] = output or _checked_groups(deck).get("scene", {}).get("output")
        text, keys = _deck(deck)
    elif isinstance(deck, (str, os.PathLike)):
        text, keys = deck if re.search(r"\n|^\s*[&$!]", os.fspath(deck)) else None, None
    else:
        raise TypeError("a deck's file, its text, or a dict of its groups is wanted, not "
                        f"{deck!r:.40}")
    settings = [f"{group}.{key}={_written(key, value)}" for group, values in groups.items()
                for key, value in values.items() if value is not None]
    return _computed(["-" if text else os.fspath(deck), *settings], text, keys, options)


def _computed(arguments, text, keys, options):
    """The Dataset that a run of the program leaves."""
    _files.engine()  # before what may take hours
    if options.get("resume") and not options.get("output"):
        raise ValueError("resume: a run goes on into the 'output' that it was stopped at")
    command = [program(), *arguments]
    command += [f"--{name}={options[name]}" for name in ("threads", "budget")
                if options.get(name) is not None]
    wrong = subprocess.run([*command, "--dump-namelist"], input=text or "", capture_output=True,
                           check=False, **TEXT)
    if wrong.returncode:
        said = re.sub(r"^\S*resonance: |^Try .*$", "", wrong.stderr, flags=re.M).strip()
        raise errors[lib.PENDRES_INVALID_ARGUMENT](
            _of_table(_as_keywords(said, keys)) if keys else re.sub(r"^-:", "deck:", said, flags=re.M))
    folder = tempfile.mkdtemp(prefix="pendres-")
    try:
        kept = options.get("output")
        path = os.path.abspath(kept or os.path.join(folder, "scene.h5"))
        # Values of an outer axis are computed side by side where there is a journal.
        aside = kept or "&outer" in (text or "")
        journal = "--resume" if options.get("resume") else "" if aside else "--no-journal"
        code, said = _followed([*command, f"--output={path}", *journal.split()], text)
        if code not in (0, POINTS_FAILED):
            raise _failure(code, said)
        data = _files.open(path)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    weakref.finalize(data, shutil.rmtree, folder, ignore_errors=True)
    if code == POINTS_FAILED:
        told = said[-1:] + said[:-1][:3]
        warnings.warn("\n  ".join(told).replace(f", as marked in {path}", ", as `failed` marks") +
                      ("\n  ..." if len(said) > 4 else ""), RuntimeWarning, stacklevel=3)
    return data


def _followed(command, text):
    """Run the program to its end: (exit code, its errors). How far it is, on a terminal, and
    signals to it: Python's handlers run here, and what they raise stops it."""
    terminal, said = sys.stderr is not None and sys.stderr.isatty(), []
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, **TEXT) as running:
        try:
            try:
                running.stdin.write(text or "")
                running.stdin.close()
            except BrokenPipeError:  # it says why
                pass
            for line in running.stderr:
                line = line.rstrip().replace("resonance: ", "", 1)
                if re.match(r"\d+ % of ", line):
                    if terminal:
                        print(f"\r\033[K{line}", end="", file=sys.stderr, flush=True)
                elif said or "error: " in line:
                    said.append(line.replace("error: ", "", 1) if line.startswith("error") else line)
            if terminal:
                print("\r\033[K", end="", file=sys.stderr, flush=True)
            return running.wait(), said
        except BaseException:
            running.send_signal(signal.SIGINT)
            try:
                running.stderr.read()
                running.wait()
            except BaseException:  # a second Ctrl-C
                running.kill()
                raise
            raise


def _of_table(words):
    """Words on the text file that stands for a table of the caller's: of its rows, from 0 on."""
    path = r"[^\s'\"]*pendres-\w+/table\.csv"
    words = re.sub(path + r":(\d+)", lambda line: f"file, row {int(line.group(1)) - 2}", words)
    return re.sub(path, "file", words)


def _failure(code, said):
    """The exception for an exit code."""
    words = _of_table("\n".join(said))
    if code == BAD_DECK:
        return errors[lib.PENDRES_INVALID_ARGUMENT](words or "resonance: bad usage")
    if code == STOPPED or code < 0:
        how = "was stopped" if code == STOPPED else f"was ended by signal {-code}"
        return errors[lib.PENDRES_INTERRUPTED](f"resonance {how}. {words}".strip())
    return errors[lib.PENDRES_IO](words or f"resonance ended with exit code {code}")


# ---- Functions ---------------------------------------------------------------------------------


def _written_columns(table, folder):
    """A text file in the folder with the columns of a table, {name: values} or pandas' or xarray's."""
    if hasattr(table, "to_dataframe"):
        table = table.to_dataframe().reset_index()
    columns = {name: np.asarray(table[name]).ravel().tolist() for name in table}
    if len({len(values) for values in columns.values()}) != 1:
        raise ValueError("file: the columns of a table have one length, not " + ", ".join(
            f"{name} {len(values)}" for name, values in columns.items()))
    path = os.path.join(folder, "table.csv")
    with open(path, "w", **TEXT) as out:
        for row in (columns, *zip(*columns.values())):
            out.write(";".join(one if isinstance(one, str) else repr(one) for one in row) + "\n")
    return path


WORDS = """\
An xarray.Dataset, with the variables of the program's files: every result has its NAME_error
beside it, units and meanings are in attributes. Keywords are the keys of decks, as told below:
drive_amplitude=0.2, damping=[0.1, 0.2], drive_frequency_range=(0.5, 1, 101). Of a key in &sweep and
another group, a list is &sweep's, one value the other's; noise={"seed": 2} names a group, and from_
stands for `from`. force=[a1, a2, ...] is the polynomial's. file may be a table, {column: values},
a DataFrame or a Dataset. output, threads, budget, resume: as of pendres.run.
"""
RUN = ("output", "threads", "budget", "resume")


def scene(kind, beside=None):
    """The function that computes scenes of a kind; `beside` is one of the library's with the same
    name, which is called where there are arguments without keywords, or its first one."""
    first = next(iter(inspect.signature(beside).parameters)) if beside else None

    def compute(*arguments, **keys):
        if beside and (arguments or first in keys):
            return beside(*arguments, **keys)
        if arguments:
            raise TypeError(f"{kind}() takes keywords: damping=0.1, not {arguments[0]!r:.40}")
        options = {key: keys.pop(key) for key in RUN if key in keys}
        with tempfile.TemporaryDirectory(prefix="pendres-") as folder:
            if hasattr(keys.get("file"), "keys"):
                keys["file"] = _written_columns(keys["file"], folder)
            return _computed(["-"], *_deck(_sorted_into_groups(kind, keys)), options)

    compute.__name__ = compute.__qualname__ = kind
    compute.__module__ = "pendres"
    own = f"{kind}{inspect.signature(beside)}\n\n{beside.__doc__}" if beside else ""
    try:
        keys, about = list(_groups_of(kind)), explain(kind).partition("\n")[2]
    except (OSError, ImportError, errors[lib.PENDRES_INVALID_ARGUMENT]):  # a call says why
        compute.__doc__ = own
        return compute
    compute.__doc__ = f"{kinds()[kind]}\n\n{WORDS}\n{about.strip()}\n" + (
        f"\nWith {first} before all else, the library's function:\n\n{own}" if own else "")
    compute.__signature__ = inspect.Signature(
        [inspect.Parameter("arguments", inspect.Parameter.VAR_POSITIONAL)] * bool(beside) +
        [inspect.Parameter(key + "_" * keyword.iskeyword(key), inspect.Parameter.KEYWORD_ONLY,
                           default=None)
         for key in (*(key for key in keys if key not in ("kind", *RUN)), *RUN)])
    return compute


def ramp(**keys):
    """A parameter that moves in real time, by `rate` a drive period or along a `protocol`, and what
    the pendulum does meanwhile: pendres.hysteresis with one of these, whose keywords it takes."""
    if keys.get("rate") is None and keys.get("protocol") is None:
        raise TypeError("ramp() needs 'rate', what the parameter moves by in a drive period, or "
                        "'protocol'")
    return scene("hysteresis")(**keys)
