"""Contexts, and how pendulums and numbers get into the library."""
import threading

import numpy as np

from ._library import Handle, Record, array, c, copied, dtype, enumerations, errors, ffi, lib

PENDULUM = dtype("pendres_pendulum")


def options(name, given):
    """A structure of choices: zero in a field means the library's default."""
    chosen = array(name)
    for key, value in given.items():
        if key not in chosen.dtype.names:
            raise TypeError(f"there is no option '{key}', only {', '.join(chosen.dtype.names)}")
        chosen[key] = named(value)
    return chosen


def named(value):
    """The number of a method or table that is given by its name."""
    if not isinstance(value, str):
        return value
    for kind in ("pendres_method", "pendres_table", "pendres_parameter"):
        for member in enumerations[kind]:
            if member.name.lower() == value.lower():
                return int(member)
    raise ValueError(f"'{value}' is not the name of a method, a table or a parameter")


class Context(Handle):
    """What a thread computes with: options, workspace, and the message on the last failure.

    Context(tolerance=1e-10, method="block_fixed", steps_per_period=0, block_lanes=512,
    period_budget=0, stop=None)

    tolerance is that of the results, absolute for angles (rad) of order one. Zero in any field
    means the library's default. `stop` is a function without arguments that is asked now and then:
    true ends the computation with pendres.Interrupted. Ctrl-C stops it in any case.

    A context belongs to one thread at a time; another thread that uses it meanwhile gets
    pendres.Busy. `with Context(...)` makes it the one that functions without `context=` use.
    """

    ctype = "pendres_context"

    def __init__(self, stop=None, **chosen):
        out = ffi.new("pendres_context **")
        choice = options("pendres_options", chosen)
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
        return context
    if getattr(_thread, "context", None) is None:
        _thread.context = Context()
    return _thread.context


def pendulum(**fields):
    """Pendulums by their parameters, dimensionless: damping (1/Q), drive_amplitude (torque over
    m g l), drive_frequency (over that of small oscillations), temperature (kT over m g l), and
    whatever else the library's pendres_pendulum has.

    Arrays are broadcast: pendulum(damping=[0.1, 0.2], drive_amplitude=0.2, drive_frequency=1)
    makes two. The result is a numpy array with the parameters as fields and attributes.
    """
    unknown = set(fields) - set(PENDULUM.names)
    if unknown:
        raise TypeError(f"a pendulum has no '{sorted(unknown)[0]}', only "
                        f"{', '.join(PENDULUM.names)}")
    values = {key: np.asarray(value) for key, value in fields.items()}
    made = array("pendres_pendulum", np.broadcast_shapes(*(v.shape for v in values.values())))
    for key, value in values.items():
        made[key] = value
    return made


def as_pendulums(p):
    """What a caller gives as pendulums, as an array of the library's type."""
    if isinstance(p, dict):
        return pendulum(**p)
    given = np.asarray(p)
    if given.dtype != PENDULUM:
        raise TypeError("pendulums are wanted, as pendres.pendulum(damping=..., ...) makes them")
    return given


def one_pendulum(p):
    """The same, of a single pendulum."""
    given = as_pendulums(p)
    if given.size != 1:
        raise ValueError(f"a single pendulum is wanted, not {given.size}")
    return np.ascontiguousarray(given.reshape(1))


def spread(p, *values):
    """Pendulums and numbers of one shape, contiguous; copies only of what is not so already."""
    pendulums = as_pendulums(p)
    numbers = [np.asarray(value, dtype=float) for value in values]
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
    for key, value in fields.items():
        if key not in chosen.dtype.names:
            raise TypeError(f"an ensemble has no '{key}', only {', '.join(chosen.dtype.names)}")
        chosen[key] = value
    return chosen.view(np.recarray)


def record(values):
    """An array of structures whose fields are attributes; of none, a record."""
    if values.shape:
        return values.view(np.recarray)
    plain = values.view(np.ndarray)  # numpy's recarray knows numpy's own records alone
    return plain.view(np.dtype((Record, plain.dtype)))[()]
