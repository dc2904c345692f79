# Made by `make python-stubs` from the package itself.
import enum
from typing import Any, overload

import numpy as np
import xarray

__version__: str
class Curve(object):
    points: np.recarray
    cusps: np.recarray
    def __init__(self, pointer: Any, owner: Any) -> None: ...
    def at(self, value: Any, *, context: Any = ...) -> np.recarray: ...
class Basins(object):
    x: np.ndarray
    v: np.ndarray
    attractors: Attractors
    state: np.recarray
    fraction: np.ndarray
    fraction_error: np.ndarray
    statistics: np.ndarray
    def __init__(self, x: Any, v: Any, found: Any, state: Any) -> None: ...
class Boundary(object):
    x: np.ndarray
    v: np.ndarray
    error: np.ndarray
    piece: np.ndarray
    bound: float
    complete: bool
    def __init__(self, pointer: Any) -> None: ...
class Branch(object):
    points: np.recarray
    bifurcations: np.recarray
    ends: tuple[int, int]
    def __init__(self, pointer: Any, owner: Any) -> None: ...
    def at(self, value: Any, *, context: Any = ...) -> np.recarray: ...
class Context(object):
    def __enter__(self) -> Any: ...
    def __init__(self, stop: Any = ..., **chosen: Any) -> None: ...
    @property
    def cost(self) -> np.record: ...
    @property
    def options(self) -> np.record: ...
class Attractors(object):
    def __len__(self) -> Any: ...
    def settle(self, x: Any, v: Any, *, context: Any = ...) -> tuple[np.recarray, np.recarray]: ...
    @property
    def table(self) -> np.recarray: ...
class Hysteresis(object):
    points: np.recarray
    jumps: np.recarray
    steps: np.recarray
    def __init__(self, pointer: Any) -> None: ...
class Error(RuntimeError):
    ...
class BasinEnd(enum.IntEnum):
    ATTRACTOR = 0
    WELL = 1
class BasinHow(enum.IntEnum):
    INTEGRATED = 0
    FILLED = 1
    DEFERRED = 2
    UNCERTAIN = 3
class BranchEnd(enum.IntEnum):
    RANGE = 0
    CLOSED = 1
    WILD = 2
    POINTS = 3
    STUCK = 4
class Busy(Error):
    ...
class CloudVerdict(enum.IntEnum):
    AGREES = 0
    TOO_HOT = 1
    NOT_COMPARED = 2
    UNCERTAIN = 3
    BELOW_ROUNDING = 4
    VERDICTS = 5
class CloudWay(enum.IntEnum):
    NONE = 0
    STILL = 1
    NARROW = 2
    FOLLOWED = 3
class Doubt(enum.IntEnum):
    SIGN = 1
    TURN = 2
    BIFURCATION = 4
class EnsembleShape(enum.IntEnum):
    LINE = 0
    RECTANGLE = 1
    RANDOM = 2
class FitObservable(enum.IntEnum):
    AMPLITUDE = 0
    RMS = 1
    FIRST_HARMONIC = 2
    PHASE_LAG = 3
    IN_PHASE = 4
    QUADRATURE = 5
    LOOP_AREA = 6
    DISPLACEMENT = 7
    MEAN_VELOCITY = 8
    JUMP = 9
    RESONANCE = 10
    VELOCITY = 11
    ACCELERATION = 12
    TRANSMISSION_REAL = 13
    TRANSMISSION_IMAGINARY = 14
    NOTCH_REAL = 15
    NOTCH_IMAGINARY = 16
    REFLECTION_REAL = 17
    REFLECTION_IMAGINARY = 18
class FitQuantity(enum.IntEnum):
    PARAMETER_LAST = 12
    FREQUENCY_SCALE = 13
    DRIVE_SCALE = 14
    AMPLITUDE_SCALE = 15
    OFFSET = 16
    PHASE_OFFSET = 17
    BACKGROUND_IN_PHASE = 18
    BACKGROUND_QUADRATURE = 19
    START_DISPLACEMENT = 20
    START_VELOCITY = 21
    TORQUE_SCALE = 22
    INTERNAL_Q = 23
    COUPLING_Q = 24
    COUPLING_PHASE = 25
    DELAY = 26
    BACKGROUND_AMPLITUDE = 27
    BACKGROUND_PHASE = 28
class Force(enum.IntEnum):
    PENDULUM = 0
    POLYNOMIAL = 1
    SQUID = 2
    FORMULA = 1073741824
class IntegrationFailed(Error):
    ...
class Internal(Error):
    ...
class Interrupted(Error):
    ...
class JumpKind(enum.IntEnum):
    FOLD = 0
    FLIP = 1
    SYMMETRY = 2
    OTHER = 3
    BRANCH_POINT = 4
    CRISIS = 5
    HOMOCLINIC = 6
class Kind(enum.IntEnum):
    NUMBER = 0
    PHASE = 1
    POSITION = 2
    VELOCITY = 3
    RATE = 4
    FREQUENCY = 5
    TIME = 6
    FORCE = 7
    ENERGY = 8
    POWER = 9
    TEMPERATURE = 10
    VARIANCE_X = 11
    COVARIANCE = 12
    VARIANCE_V = 13
    SPECTRUM = 14
    A1 = 15
    A2 = 16
    A3 = 17
    A4 = 18
    A5 = 19
    NONLINEAR_DAMPING = 20
    QUADRATIC_DAMPING = 21
    CUBIC_DAMPING = 22
    SWEPT = 23
class Label(enum.IntEnum):
    SA = 0
    LA = 1
    PERIODIC = 2
    RUNNING = 3
    CHAOTIC = 4
    UNRESOLVED = 5
    ESCAPE = 6
    QUASI_PERIODIC = 7
    UNSTABLE = 8
class LangevinAnswer(enum.IntEnum):
    GO_ON = 0
    ENOUGH = 1
    STOP = 2
class LangevinStatistic(enum.IntEnum):
    MEAN_X = 0
    MEAN_V = 1
    COV_XX = 2
    COV_XV = 3
    COV_VV = 4
    COSINE = 5
    SINE = 6
    LOOP_AREA = 7
    STATISTICS = 8
class Method(enum.IntEnum):
    BLOCK_FIXED = 0
    BLOCK_ADAPTIVE = 1
    SINGLE = 2
    CVODE_ADAMS = 3
    CVODE_BDF = 4
    NAIVE = 5
class Names(enum.IntEnum):
    METHOD = 0
    TABLE = 1
    PARAMETER = 2
    ENSEMBLE_SHAPE = 3
    LABEL = 4
    SPECIAL = 5
    BRANCH_END = 6
    DOUBT = 7
    JUMP = 8
    PEAK = 9
    REGIME = 10
    OTHER = 11
    BASIN_END = 12
    BASIN_HOW = 13
    LANGEVIN_ANSWER = 14
    LANGEVIN_STATISTIC = 15
    CLOUD_WAY = 16
    CLOUD_VERDICT = 17
    SWITCHING_WAY = 18
    SWITCHING_VERDICT = 19
    STORE_TYPE = 20
    STEP_END = 21
    FIT_OBSERVABLE = 22
    FIT_QUANTITY = 23
class NotConverged(Error):
    ...
class NotFound(Error):
    ...
class OrbitWant(enum.IntEnum):
    PLAIN = 0
    FREQUENCY_SLOPE = 1
class Other(enum.IntEnum):
    ASYMMETRIC = 1
    PERIODIC = 2
    RUNNING = 4
    CHAOTIC = 8
    UNRESOLVED = 16
    ESCAPE = 32
    UNSTABLE = 64
class Parameter(enum.IntEnum):
    DRIVE_FREQUENCY = 0
    DAMPING = 1
    DRIVE_AMPLITUDE = 2
    TORQUE = 3
    PARAMETRIC_AMPLITUDE = 4
    A1 = 5
    A2 = 6
    A3 = 7
    A4 = 8
    A5 = 9
    NONLINEAR_DAMPING = 10
    QUADRATIC_DAMPING = 11
    CUBIC_DAMPING = 12
    DRIVE_PERIOD = 13
    TEMPERATURE = 14
    X = 15
    V = 16
class Peak(enum.IntEnum):
    SMOOTH = 0
    EDGE = 1
    RAGGED = 2
class PhaseWork(enum.IntEnum):
    DONE = 0
    LINES = 1
    CURVES = 2
    COMPLETION = 3
class Regime(enum.IntEnum):
    SA = 0
    LA = 1
    COEXISTENCE = 2
    SINGLE = 3
    OTHER = 4
class RotationEnd(enum.IntEnum):
    HOMOCLINIC = 0
    SADDLE_NODE = 1
class Special(enum.IntEnum):
    REGULAR = 0
    FOLD = 1
    PERIOD_DOUBLING = 2
    SYMMETRY_BREAKING = 3
    BRANCH_POINT = 4
class Status(enum.IntEnum):
    OK = 0
    INVALID_ARGUMENT = 1
    OUT_OF_MEMORY = 2
    INTEGRATION_FAILED = 3
    TOLERANCE_UNREACHABLE = 4
    NOT_CONVERGED = 5
    NOT_FOUND = 6
    UNRESOLVED = 7
    INTERRUPTED = 8
    IO = 9
    UNSUPPORTED = 10
    INTERNAL = 11
    BUSY = 12
class StepEnd(enum.IntEnum):
    LEFT = 0
    SEEN = 1
    RANGE = 2
class StoreType(enum.IntEnum):
    DOUBLE = 0
    INT8 = 1
    INT32 = 2
    INT64 = 3
    STRING = 4
class SwitchingVerdict(enum.IntEnum):
    STRAIGHT = 0
    BENT = 1
    UNCHECKED = 2
    TOO_FEW = 3
    NO_STATE = 4
    NO_BARRIER = 5
    UNBALANCED = 6
    VERDICTS = 7
class SwitchingWay(enum.IntEnum):
    FORTH = 0
    BACK = 1
    FIRST_WELL = 2
    SECOND_WELL = 3
    WAYS = 4
class Table(enum.IntEnum):
    DEFAULT = 0
    TP8 = 1
    TSIT5 = 2
    VERN9 = 3
    DP5 = 4
class ToleranceUnreachable(Error):
    ...
class Unresolved(Error):
    ...
class FileError(Error, OSError):
    ...
class InvalidArgument(Error, ValueError):
    ...
class OutOfMemory(Error, MemoryError):
    ...
class Unsupported(Error, NotImplementedError):
    ...
SWITCHING_WELL: Any
def activation(temperature: Any, rates: Any, *, fewest: float = ...) -> Any: ...
def array(name: Any, shape: Any = ...) -> np.ndarray: ...
def attractors(p: Any, x: Any = ..., v: Any = ..., *, context: Any = ...) -> Attractors: ...
def backbone(p: Any, *, context: Any = ...) -> tuple[np.recarray, np.ndarray, np.ndarray]: ...
@overload
def basins(p: Any, x: Any, v: Any, *, context: Any = ...) -> Basins: ...
@overload
def basins(**keys: Any) -> xarray.Dataset: ...
def boundary(saddle_orbit: Any, *, context: Any = ..., **more: Any) -> Boundary: ...
@overload
def branches(orbits: Any, low: Any, high: Any, *, parameter: str = ..., context: Any = ..., **more: Any) -> list[Branch]: ...
@overload
def branches(**keys: Any) -> xarray.Dataset: ...
c: Any
def cloud(request: Any, *, points: bool = ..., context: Any = ...) -> Any: ...
def cloud_request(p: Any, x: Any, v: Any, *, trajectories: int = ..., settle: int = ..., record: int = ..., **more: Any) -> Any: ...
def cloud_steps(request: Any, *, tolerance: float = ..., context: Any = ...) -> Any: ...
def curves(bifurcations: Any, second: Any, low: Any, high: Any, *, context: Any = ..., **more: Any) -> list[Curve]: ...
def cusp(near: Any, second: str = ..., *, context: Any = ...) -> Any: ...
def dtype(name: Any) -> np.dtype: ...
def ensemble(**fields: Any) -> np.recarray: ...
def explain(word: Any) -> str: ...
ffi: Any
def fold(orbit: Any, *, context: Any = ...) -> Any: ...
def free_frequency(amplitude: Any) -> Any: ...
def free_frequency_integrate(amplitude: Any, *, context: Any = ...) -> Any: ...
@overload
def hysteresis(p: Any, values: Any, x: float = ..., v: float = ..., *, parameter: str = ..., context: Any = ...) -> Hysteresis: ...
@overload
def hysteresis(**keys: Any) -> xarray.Dataset: ...
def kinds() -> dict[str, str]: ...
def langevin_advance(p: Any, x: Any, v: Any, periods: Any, *, first_period: int = ..., ids: Any = ..., steps_per_period: int = ..., context: Any = ...) -> Any: ...
lib: Any
def linear_noise(p: Any, x: Any, v: Any, *, cycle: int = ...) -> Any: ...
def open(path: Any, group: Any = ...) -> xarray.Dataset: ...
def orbit_sample(orbit: Any, count: Any, *, error: bool = ..., context: Any = ...) -> Any: ...
def orbits(p: Any, x: Any, v: Any, *, period: int = ..., winding: int = ..., slopes: bool = ..., context: Any = ...) -> Any: ...
def pendulum(**fields: Any) -> np.recarray: ...
def phase_line(p: Any, ensemble: Any = ..., *, parameter: str = ..., spacing: float = ..., context: Any = ...) -> tuple[np.recarray, list[Branch]]: ...
def pint_units(units: Any) -> str: ...
def plot(data: Any, **chosen: Any) -> Any: ...
def ramp(**keys: Any) -> Any: ...
def rate(tally: Any, start: Any, end: Any, *, level: float = ...) -> Any: ...
def resonance(p: Any, lowest: float = ..., highest: float = ..., ensemble: Any = ..., *, context: Any = ...) -> np.record: ...
@overload
def response(p: Any, ensemble: Any = ..., *, context: Any = ...) -> np.recarray: ...
@overload
def response(**keys: Any) -> xarray.Dataset: ...
def run(deck: Any, *, output: Any = ..., threads: Any = ..., budget: Any = ..., resume: bool = ..., **groups: Any) -> xarray.Dataset: ...
def saddle(attractor: Any, *, context: Any = ...) -> Any: ...
def settle(p: Any, x: Any, v: Any, *, context: Any = ...) -> tuple[np.recarray, np.recarray]: ...
def si(data: Any) -> Any: ...
def strobe_advance(p: Any, x: Any, v: Any, periods: Any, *, error: bool = ..., out: Any = ..., context: Any = ...) -> Any: ...
def strobe_record(p: Any, x0: Any, v0: Any, periods: Any, samples: Any, *, error: bool = ..., context: Any = ...) -> tuple[np.ndarray, np.ndarray]: ...
@overload
def switching(p: Any, attractors: Any, start: Any, *, trajectories: Any, periods: Any, context: Any = ..., **more: Any) -> Any: ...
@overload
def switching(**keys: Any) -> xarray.Dataset: ...
def words(variable: Any) -> Any: ...
def bifurcation_diagram(**keys: Any) -> xarray.Dataset: ...
def escape(**keys: Any) -> xarray.Dataset: ...
def fit(**keys: Any) -> xarray.Dataset: ...
def free_oscillation(**keys: Any) -> xarray.Dataset: ...
def hard_cases(**keys: Any) -> xarray.Dataset: ...
def lyapunov_map(**keys: Any) -> xarray.Dataset: ...
def orbit(**keys: Any) -> xarray.Dataset: ...
def phase_diagram(**keys: Any) -> xarray.Dataset: ...
def resonance_curve(**keys: Any) -> xarray.Dataset: ...
def work_precision(**keys: Any) -> xarray.Dataset: ...
