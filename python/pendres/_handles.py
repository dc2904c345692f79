"""Contexts, and how pendulums and numbers get into the library."""
import operator
import threading

import numpy as np

from ._library import (Handle, Record, array, assign, c, copied, dtype, enumerations, errors, ffi,
                       lib, structures)

PENDULUM = dtype("pendres_pendulum")


def filled(name, given, made=None):
    """A structure of the library's with these fields. Zero in a field of choices means the
    library's default."""
    made = array(name) if made is None else made
    for key, value in given.items():
        if key not in made.dtype.names:
            raise TypeError(f"there is no '{key}' in {name}, only {', '.join(made.dtype.names)}")
        assign(name, made, key, value)
    return made


class Context(Handle):
    """What a thread computes with: options, workspace, and the message on the last failure.

    Context(tolerance=1e-10, method="block_fixed", steps_per_period=0, block_lanes=512,
    period_budget=0, exponent_error=0.0, threads=1, stop=None)

    tolerance is that of the results, absolute for angles (rad) of order one. Zero in any field
    means the library's default. `stop` is a function without arguments that is asked now and then:
    true ends the computation with pendres.Interrupted. Ctrl-C stops it in any case.

    A context belongs to one thread at a time; another thread that uses it meanwhile gets
    pendres.Busy. `with Context(...)` makes it the one that functions without `context=` use.
    """

    ctype = "pendres_context"

    def __init__(self, stop=None, **chosen):
        out = ffi.new("pendres_context **")
        choice = filled("pendres_options", chosen)
        if stop is not None and not callable(stop):
            raise TypeError(f"stop: a function without arguments is wanted, not {stop!r:.40}")
        wrong = c.options_check(choice)
        if wrong != ffi.NULL:
            raise errors[lib.PENDRES_INVALID_ARGUMENT](ffi.string(wrong).decode())
        c.context_create(choice, out)
        super().__init__(out[0])
        self.interrupt.stop = stop
        self._before = None

    @property
    def options(self):
        """The options in force, defaults resolved."""
        return copied("pendres_options", c.context_options(self))

    @property
    def cost(self):
        """What it has spent: pendulum_periods, rhs_evaluations, steps, ... (see pendres_cost)."""
        spent = array("pendres_cost")
        c.context_cost(self, spent)
        return spent[()]

    def __enter__(self):
        self._before = getattr(_thread, "context", None)
        _thread.context = self
        return self

    def __exit__(self, *_what):
        _thread.context = self._before


_thread = threading.local()


def default_context(context=None):
    """The context given, or this thread's own one."""
    if context is not None:
        if not isinstance(context, Context):
            raise TypeError(f"context: a pendres.Context is wanted, not {context!r:.40}")
        return context
    if getattr(_thread, "context", None) is None:
        _thread.context = Context()
    return _thread.context


def pendulum(**fields):
    """Pendulums by their parameters, dimensionless: damping (1/Q), drive_amplitude (torque over
    m g l), drive_frequency (over that of small oscillations), temperature (kT over m g l), and
    whatever else the library's pendres_pendulum has. force=[a1, a2, ...], five at most, is the
    polynomial a1 x + a2 x^2 + ...; other forces have names, and force_coefficients: force="squid",
    or are formulas: force="x + a1*x**3".

    Arrays are broadcast: pendulum(damping=[0.1, 0.2], drive_amplitude=0.2, drive_frequency=1)
    makes two; so are those of force_coefficients along all but their last dimension. The result is
    a numpy array with the parameters as fields and attributes.
    """
    values = force_and_coefficients(fields)
    if is_formula(values.get("force")):
        values["force"] = _number_of(values["force"])
    if "force_coefficients" in values:
        values["force_coefficients"] = _padded(values["force_coefficients"])
    rows = ("force_coefficients", "spare")
    shapes = [np.shape(value)[:-1] if key in rows else np.shape(value)
              for key, value in values.items()]
    return filled("pendres_pendulum", values, array("pendres_pendulum",
                                                    np.broadcast_shapes(*shapes)))


def force_and_coefficients(fields):
    """Fields, or keys of a deck, in which force=[a1, a2, ...] is the polynomial with these; in a
    deck some may have units. An array of the field's own type holds kinds of forces."""
    force, kinds = fields.get("force"), enumerations["pendres_force"]
    try:
        given = np.asarray(force)
    except ValueError:  # rows of several lengths
        raise TypeError(f"force: as many coefficients in each row are wanted, not {force!r:.40}"
                        ) from None
    several = given.ndim and given.size and given.dtype.kind in "iufU"
    if not several or given.dtype == PENDULUM["force"] or any(
            isinstance(one, kinds) for one in np.asarray(force, dtype=object).flat):
        return dict(fields)
    if fields.get("force_coefficients") is not None:
        raise TypeError("force: coefficients are given here or in force_coefficients, not in both")
    return {**fields, "force": "polynomial", "force_coefficients": force}


def is_formula(force):
    """Whether a force is a formula, and no name: it has more than letters, or is x."""
    return (isinstance(force, str) and force.upper() not in enumerations["pendres_force"].__members__
            and (force == "x" or not force.replace("_", "").isalpha()))


def _number_of(formula):
    out, error = ffi.new("pendres_force *"), ffi.new("pendres_formula_error *")
    status = lib.pendres_force_define(formula.encode(), out, error)
    if status != lib.PENDRES_OK:
        words = ffi.string(error.message).decode() or "out of memory"
        raise errors[status](f"force: {words}\n  {formula}\n  {' ' * error.at}^")
    return int(out[0])


def _padded(coefficients):
    """Coefficients of forces, those that are left out as zeros."""
    given, most = np.atleast_1d(coefficients), lib.PENDRES_FORCE_COEFFICIENTS
    if given.dtype.kind not in "biuf" or given.shape[-1] > most:
        raise TypeError(f"force_coefficients: {most} numbers at most are wanted, not "
                        f"{coefficients!r:.40}")
    return np.pad(given, [(0, 0)] * (given.ndim - 1) + [(0, most - given.shape[-1])])


def as_pendulums(p):
    """What a caller gives as pendulums, as an array of the library's type."""
    if isinstance(p, dict):
        return pendulum(**p)
    try:
        return structures("pendres_pendulum", p)
    except TypeError:
        raise TypeError("pendulums are wanted, as pendres.pendulum(damping=..., ...) makes them"
                        ) from None


def one_pendulum(p):
    """The same, of a single pendulum."""
    return one("pendres_pendulum", as_pendulums(p))


def one(name, value):
    """One of the library's structures, as an array of one."""
    given = structures(name, value)
    if given.size != 1:
        raise ValueError(f"a single {name} is wanted, not {given.size}")
    return np.ascontiguousarray(given.reshape(1))


def as_ensemble(given, p):
    """An ensemble of the caller's, or the one that the response of these pendulums spans: of the
    one that is driven most."""
    if given is not None:
        return one("pendres_ensemble", given)
    several = np.ravel(p)
    most = several[np.argmax(np.abs(several["drive_amplitude"]) /
                             np.maximum(several["damping"], 1e-300))] if several.size else None
    found = c.ensemble_of(None if most is None else most.reshape(1))
    return np.asarray(copied("pendres_ensemble", ffi.new("pendres_ensemble *", found)))


def as_numbers(value):
    """An array of doubles."""
    try:
        return np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise TypeError(f"numbers are wanted, not {value!r:.40}") from None


def whole(what, number, least=0):
    """A count, as an int."""
    wrong = f"{what}: a whole number of {least} or more is wanted, not {number!r:.40}"
    try:
        count = operator.index(number)
    except TypeError:
        raise TypeError(wrong) from None
    if count < least:
        raise ValueError(wrong)
    return count


def spread(p, *values):
    """Pendulums and numbers of one shape, contiguous; copies only of what is not so already."""
    pendulums = as_pendulums(p)
    numbers = [as_numbers(value) for value in values]
    arrays, shape = (pendulums, *numbers), pendulums.shape
    for a in arrays:
        if a.shape != shape or not shape or not a.flags.c_contiguous:
            break
    else:
        return shape, arrays
    shape = np.broadcast_shapes(pendulums.shape, *(n.shape for n in numbers))
    # ascontiguousarray makes one dimension at least of none.
    return shape, [np.ascontiguousarray(a if a.shape == shape else np.broadcast_to(a, shape))
                   for a in arrays]


def ensemble(**fields):
    """An ensemble of starts: members k = 1 .. members at x_first + (x_last - x_first) k / members
    (rad) with velocity v; with shape, v_last and rows or seed in a rectangle (struct
    pendres_ensemble tells how). Without fields the paper's 200 at rest over -pi/2 < x <= 3 pi/2."""
    chosen = np.asarray(copied("pendres_ensemble", ffi.new("pendres_ensemble *",
                                                           c.ensemble_default())))
    filled("pendres_ensemble", fields, chosen)
    return chosen.view(np.recarray)


def record(values):
    """An array of structures whose fields are attributes; of none, a record."""
    if values.shape:
        return values.view(np.recarray)
    plain = values.view(np.ndarray)  # numpy's recarray knows numpy's own records alone
    return plain.view(np.dtype((Record, plain.dtype)))[()]
