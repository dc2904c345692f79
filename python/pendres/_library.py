"""The shared library: found, opened, and every public function of it made callable with arrays.

Owns: where library and headers are looked for, numpy's view of the library's structures, the
conversion of arguments, and exceptions in place of status codes.
"""
import ctypes.util
import enum
import os
import shutil
import subprocess
import sys

import cffi
import numpy as np

from . import _headers, _shown

HERE = os.path.dirname(os.path.abspath(__file__))
TREE = os.path.dirname(os.path.dirname(HERE))
# Written by setup.py: the headers that an installed package was made from.
INSTALLED_HEADERS = os.path.join(HERE, "headers.txt")


def of_tree(*names):
    """A file of the source tree in which this package stands as python/pendres; None: there is no
    such tree, or the file is another user's, as anybody's may be beside a package in /tmp."""
    path = os.path.join(TREE, *names)
    if os.path.basename(os.path.dirname(HERE)) != "python" or not os.path.exists(path):
        return None
    return path if os.stat(path).st_uid in (0, os.stat(HERE).st_uid) else None


def _pkg_config(variable):
    if not shutil.which("pkg-config"):
        return None
    answer = subprocess.run(["pkg-config", f"--variable={variable}", "pendres"],
                            capture_output=True, text=True, check=False)
    return answer.stdout.strip() if answer.returncode == 0 else None


def headers():
    """The text of the public headers: of the source tree, of this package, or of the system."""
    if of_tree("include", "pendres", "pendres.h"):
        return _headers.folder_text(os.path.join(TREE, "include", "pendres"))
    if os.path.exists(INSTALLED_HEADERS):
        with open(INSTALLED_HEADERS, encoding="utf-8") as text:
            return text.read()
    folder = _pkg_config("includedir")
    if not folder:
        raise ImportError("the headers of libpendres were not found: install the library, and let "
                          "pkg-config know it (PKG_CONFIG_PATH)")
    return _headers.folder_text(os.path.join(folder, "pendres"))


def _candidates(constants):
    """Where the library may be, the likeliest first."""
    name = f"libpendres.so.{constants['PENDRES_VERSION_MAJOR']}"
    yield os.environ.get("PENDRES_LIBRARY")
    yield of_tree("build", "libpendres.so")
    if os.path.exists(os.path.join(HERE, "libpendres.so")):
        yield os.path.join(HERE, "libpendres.so")
    yield name
    yield os.path.join(sys.prefix, "lib", name)
    folder = _pkg_config("libdir")
    if folder:
        yield os.path.join(folder, name)
    program = shutil.which("resonance")  # PREFIX/bin, beside PREFIX/lib
    if program:
        yield os.path.join(os.path.dirname(os.path.dirname(os.path.realpath(program))), "lib", name)
    yield ctypes.util.find_library("pendres")


class Library:
    """The library as cffi has opened it. Its functions are declared once the first of them is
    wanted, which halves the time of an import."""

    def __init__(self, opened):
        self._opened = opened

    def __getattr__(self, name):
        try:
            found = getattr(self._opened, name)
        except AttributeError:
            if name not in declared.calls:
                raise
            ffi.cdef("".join(declared.calls.values()), override=True)
            found = getattr(self._opened, name)
        setattr(self, name, found)
        return found


def _open(ffi, constants):
    tried = []
    for path in _candidates(constants):
        if not path:
            continue
        try:
            found = ffi.dlopen(path)
        except OSError as why:
            tried.append("  " + str(why).split(".  Additionally")[0])  # cffi's guess is no help
            if path == os.environ.get("PENDRES_LIBRARY"):
                break
            continue
        version = ffi.string(found.pendres_version()).decode()
        if version != constants["PENDRES_VERSION"]:
            raise ImportError(f"{path} is version {version}, and this package was made for "
                              f"{constants['PENDRES_VERSION']}: install it anew")
        return Library(found)
    raise ImportError("libpendres was not found. Install it (make install, then ldconfig), put "
                      "PREFIX/bin on PATH, or say where it is: "
                      "PENDRES_LIBRARY=/folder/libpendres.so\n" + "\n".join(tried))


declared = _headers.Declarations(headers())
ffi = cffi.FFI()
ffi.cdef(declared.types + declared.calls["pendres_version"] +
         declared.calls["pendres_status_message"])
lib = _open(ffi, declared.constants)

# ---- Enumerations and exceptions ---------------------------------------------------------------


def _types():
    """All types by their names. cffi parses each text that it is given beside all names that it
    knows, which takes long, so that it is given one: of a function that takes all as pointers."""
    names = ffi.list_types()[0]
    pointers = ffi.typeof(f"void (*)({', '.join(name + ' *' for name in names)})").args
    return {name: pointer.item for name, pointer in zip(names, pointers) if pointer.kind == "pointer"}


types = _types()


def typeof(name):
    """The type of a name, the library's or another of C's."""
    return types[name] if name in types else ffi.typeof(name)


def types_of(kind):
    """Names of the library's types of a kind, "enum" or "struct"."""
    return [name for name, found in types.items() if found.kind == kind]


def _enumeration(name):
    """An IntEnum of one of the library's: members without what all their names begin with."""
    elements = types[name].relements
    members = {key: value for key, value in elements.items() if not key.endswith("_COUNT")}
    shared = os.path.commonprefix(list(members)) if len(members) > 1 else "PENDRES_"
    shared = shared[:shared.rfind("_") + 1] or "PENDRES_"
    title = "".join(part.title() for part in name.split("_")[1:])
    ordered = sorted(members.items(), key=lambda item: item[1])
    return enum.IntEnum(title, [(key[len(shared):], value) for key, value in ordered],
                        module="pendres")


enumerations = {name: _enumeration(name) for name in types_of("enum")}
Status = enumerations["pendres_status"]


class Error(RuntimeError):
    """The library could not do what was asked; the text is its own sentence. `status` says which
    kind of failure it was; each kind is a class of its own."""

    status = None


_BASES = {"INVALID_ARGUMENT": ValueError, "OUT_OF_MEMORY": MemoryError, "IO": OSError,
          "UNSUPPORTED": NotImplementedError}
errors = {}
for _status in Status:
    if _status != Status.OK:
        _name = "".join(part.title() for part in _status.name.split("_"))
        _words = ffi.string(lib.pendres_status_message(int(_status))).decode()
        _bases = (Error,) + ((_BASES[_status.name],) if _status.name in _BASES else ())
        errors[int(_status)] = type(_name if _name != "Io" else "FileError", _bases, {
            "__doc__": f"{_words[0].upper()}{_words[1:]}.", "__module__": "pendres",
            "status": _status})

# ---- Structures as numpy sees them -------------------------------------------------------------


class Record(np.record):
    """One of the library's structures; its fields are attributes, those of arrays in it too."""

    def __getattribute__(self, name):
        value = super().__getattribute__(name)
        if type(value) is np.ndarray and value.dtype.names:  # pylint: disable=unidiomatic-typecheck
            return value.view(np.recarray)
        return value

    def __repr__(self):
        name = called(self.dtype)
        kinds = {field: enumerations.get(its.type.cname)
                 for field, its in (types[name].fields if name in types else ())}
        return "\n".join([name, *(f"  {n} = {t}" for n, t in _shown.fields(self, kinds))])

    __str__ = __repr__


_PRIMITIVES = {"float": "f4", "double": "f8", "long double": "g", "char": "i1", "_Bool": "?"}
_dtypes = {}


def dtype(name):
    """The numpy type of one of the library's: `dtype("pendres_pendulum")` has its fields."""
    ctype = name
    if isinstance(name, str):
        try:
            ctype = typeof(name)
        except cffi.CDefError:
            raise TypeError(f"the library has no type '{name}'") from None
        if ctype.kind == "struct" and ctype.fields is None:
            raise TypeError(f"{name} has no fields for others: functions give pointers to it")
    if not isinstance(ctype, ffi.CType):
        raise TypeError(f"the name of a type of the library is wanted, not {name!r:.40}")
    if ctype not in _dtypes:
        _dtypes[ctype] = _dtype_of(ctype)
    return _dtypes[ctype]


def _dtype_of(ctype):
    if ctype.kind == "primitive":
        if ctype.cname in _PRIMITIVES:
            return np.dtype(_PRIMITIVES[ctype.cname])
        signed = int(ffi.cast(ctype, -1)) < 0
        return np.dtype(f"{'i' if signed else 'u'}{ffi.sizeof(ctype)}")
    if ctype.kind == "enum":
        return np.dtype(f"i{ffi.sizeof(ctype)}")
    if ctype.kind == "array":
        return np.dtype((dtype(ctype.item), (ctype.length,)))
    if ctype.kind == "struct" and ctype.fields is not None:
        names, fields = zip(*ctype.fields)
        plain = np.dtype({"names": list(names), "formats": [dtype(f.type) for f in fields],
                          "offsets": [f.offset for f in fields], "itemsize": ffi.sizeof(ctype)})
        return np.dtype((Record, plain))
    return np.dtype(np.uintp)


def called(kind):
    """What a type of numpy's is called: by the library's name, if it is one of its structures."""
    known = (ctype.cname for ctype, its in _dtypes.items() if kind.names and its == kind)
    return next(known, str(kind))


def structures(name, values):
    """An array of one of the library's structures, as a caller gives it: also one of them, or a
    list."""
    given, wanted = np.asarray(values), dtype(name)
    if given.dtype != wanted and given.dtype.names == wanted.names and np.can_cast(
            given.dtype, wanted, "equiv"):
        given = given.astype(wanted)  # numpy's concatenate leaves out what C pads structures with
    if given.dtype != wanted:
        raise TypeError(f"{name} is wanted, not {called(given.dtype)} as of {values!r:.40}")
    return given


def assign(name, made, key, value):
    """Set a field of a structure by a number, an array, or the name of an enum's value. What the
    field cannot hold is refused."""
    kind = enumerations.get(dict(types[name].fields)[key].type.cname)
    if isinstance(value, str) and kind is not None:
        value = member(kind, key, value)
    given, wanted = np.asarray(value), made.dtype[key].base
    if given.dtype != wanted and (wanted.names or given.dtype.kind not in "biuf"):
        raise TypeError(f"{key}: {called(wanted) if wanted.names else 'a number'} is wanted, "
                        f"not {value!r:.40}")
    if wanted.kind in "iu" and given.size and not _fits(given, np.iinfo(wanted)):
        raise ValueError(f"{key}: a whole number from {np.iinfo(wanted).min} to "
                         f"{np.iinfo(wanted).max} is wanted, not {value!r:.40}")
    made[key] = given


def _fits(given, bounds):
    if given.dtype.kind == "f" and not np.all(np.isfinite(given) & (given == np.floor(given))):
        return False
    return bounds.min <= int(given.min()) and int(given.max()) <= bounds.max


def member(kind, key, name):
    """The value of an enumeration that a name, in letters of any size, stands for."""
    if name.upper() not in kind.__members__:
        raise ValueError(f"{key} is one of {', '.join(m.lower() for m in kind.__members__)}, "
                         f"not '{name}'")
    return int(kind[name.upper()])


def array(name, shape=()):
    """Zeros of one of the library's types."""
    zeros = np.zeros(shape, dtype(name))
    return zeros.view(np.recarray) if zeros.dtype.names else zeros


def copied(name, pointer):
    """What a pointer of the library's points to, as a record of our own."""
    raw = bytearray(ffi.buffer(pointer, ffi.sizeof(typeof(name))))
    return np.frombuffer(raw, dtype(name))[0]


def stacked(name, pointers):
    """An array of what each pointer points to."""
    size = ffi.sizeof(typeof(name))
    raw = bytearray().join(ffi.buffer(p, size) for p in pointers)
    return np.frombuffer(raw, dtype(name)).view(np.recarray)


def viewed(name, pointer, count, owner):
    """An array on memory of the library's, without a copy; the owner lives as long as it."""
    if not count:
        return np.zeros(0, dtype(name))
    memory = ffi.gc(pointer, lambda _memory, owner=owner: None)
    values = np.frombuffer(ffi.buffer(memory, count * ffi.sizeof(typeof(name))), dtype(name))
    values.flags.writeable = False
    return values


# ---- Handles -----------------------------------------------------------------------------------


def kept(thing):
    """Refuse to pickle or copy what is the library's."""
    name = type(thing).__name__
    raise TypeError(f"a {name} is kept in the library and can be neither pickled nor copied: take "
                    "its arrays, which can, or compute it where it is wanted")


class Handle:
    """An object of the library's, freed with the last name for it."""

    ctype = None  # such as "pendres_attractors"

    def __init__(self, pointer):
        if not isinstance(pointer, ffi.CData):
            raise TypeError(f"{type(self).__name__} is made by the functions of this package, not "
                            f"from {pointer!r:.40}")
        self.pointer = ffi.gc(pointer, getattr(lib, self.ctype + "_free"))
        self.interrupt = None
        if self.ctype + "_set_interrupt" in declared.functions:
            self.interrupt = Interrupt()
            getattr(lib, self.ctype + "_set_interrupt")(self.pointer, self.interrupt.callback,
                                                        ffi.NULL)

    def __reduce__(self):
        return kept(self)

    def message(self):
        """The library's sentence on the last failure; "" if there was none."""
        if self.ctype + "_message" not in declared.functions:
            return ""
        return ffi.string(getattr(lib, self.ctype + "_message")(self.pointer)).decode()


class Interrupt:
    """What the library asks now and then, whether to go on. Python looks for signals whenever it
    runs code of its own, so that Ctrl-C raises here; the exception is kept, and raised again when
    the library has come back."""

    def __init__(self):
        self.stop = None    # a function without arguments; true: stop
        self.caught = None

        def ask(_argument):
            return 1 if self.stop is not None and self.stop() else 0

        def keep(_kind, value, _traceback):
            self.caught = value

        self.callback = ffi.callback("int(void *)", ask, error=1, onerror=keep)


def make(kind, function, *arguments):
    """The handle that a function gives by its last argument, `pendres_... **out`."""
    out = ffi.new(kind.ctype + " **")
    function(*arguments, out)
    return kind(out[0])


# ---- Functions ---------------------------------------------------------------------------------


class Function:
    """A public function of the library. Arrays of the right type go in as they are, without a
    copy; None is NULL; a status that is not PENDRES_OK is raised as an exception."""

    def __init__(self, name):
        self.constant, self.declaration, words = declared.functions[name]
        self.__name__ = self.__qualname__ = name
        self.__doc__ = f"{self.declaration}\n\n{words}"
        self._call = getattr(lib, name)
        kind = ffi.typeof(self._call)
        self._status = kind.result is types["pendres_status"]
        self._count = len(kind.args)
        self._converters = [(i, self._converter(a, constant)) for i, (a, constant) in
                            enumerate(zip(kind.args, self.constant)) if a.kind == "pointer"]

    def __repr__(self):
        return f"<{self.declaration}>"

    def __call__(self, *arguments):
        if len(arguments) != self._count:
            raise TypeError(f"{self.__name__} takes {self._count} arguments, not "
                            f"{len(arguments)}: {self.declaration}")
        converted = list(arguments)
        for i, convert in self._converters:
            converted[i] = convert(converted[i])
        result = self._call(*converted)
        handle = arguments[0] if arguments and isinstance(arguments[0], Handle) else None
        if handle is not None and handle.interrupt is not None and handle.interrupt.caught:
            why, handle.interrupt.caught = handle.interrupt.caught, None
            raise why
        if not self._status:
            return result
        if result:
            words = handle.message() if handle is not None else ""
            raise errors[result](words or ffi.string(lib.pendres_status_message(result)).decode())
        return None

    def _converter(self, ctype, constant):
        item = ctype.item
        if item.kind == "primitive" and item.cname == "char" and constant:
            return _text
        if item.kind == "void":
            return lambda a: ffi.from_buffer(a) if isinstance(a, np.ndarray) else self._pointer(a)
        if item.kind in ("primitive", "enum") or (item.kind == "struct" and item.fields):
            return self._array_converter(item, dtype(item), constant)
        return lambda a: self._pointer(a, item.cname)

    def _pointer(self, a, wanted="an array"):
        if a is None:
            return ffi.NULL
        pointer = a.pointer if isinstance(a, Handle) else a
        if not isinstance(pointer, ffi.CData):
            raise TypeError(f"{self.__name__}: {wanted} is wanted, not {a!r:.40}")
        return pointer

    def _array_converter(self, item, wanted, constant):
        many = ffi.typeof(ffi.getctype(item, "[]"))

        def convert(a):
            if isinstance(a, np.generic):
                a = np.asarray(a)
            elif not isinstance(a, np.ndarray):
                return self._pointer(a, f"an array of {item.cname}")
            if a.dtype != wanted:
                raise TypeError(f"{self.__name__}: an array of {item.cname} is wanted, not of "
                                f"{called(a.dtype)}")
            return ffi.from_buffer(many, a, not constant)
        return convert


def _text(a):
    if a is None or isinstance(a, ffi.CData):
        return ffi.NULL if a is None else a
    return ffi.new("char[]", os.fsencode(a))


class Functions:
    """All public functions, by their names without `pendres_`: `c.strobe_advance`."""

    def __dir__(self):
        return [name[len("pendres_"):] for name in declared.functions]

    def __getattr__(self, name):
        if "pendres_" + name not in declared.functions:
            raise AttributeError(f"libpendres has no function pendres_{name}")
        setattr(self, name, Function("pendres_" + name))
        return getattr(self, name)


c = Functions()

