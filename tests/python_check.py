#!/usr/bin/env python3
"""Check the Python package: python_check.py SCRATCH. Run by python_check.sh."""
import glob
import inspect
import io
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import warnings

import numpy as np

import pendres
from pendres import _library

SCRATCH = sys.argv[1]
LIBRARY = os.environ["PENDRES_LIBRARY"]
ffi, lib = pendres.ffi, pendres.lib


def run_c(name, body):
    """What a C program with the public headers prints."""
    source, program = (os.path.join(SCRATCH, name + end) for end in (".c", ""))
    with open(source, "w", encoding="utf-8") as out:
        out.write("#include <stddef.h>\n#include <stdio.h>\n#include <pendres/pendres.h>\n"
                  f"int main(void)\n{{\n{body}\n  return 0;\n}}\n")
    folder = os.path.dirname(LIBRARY)
    subprocess.run([*os.environ.get("CC", "cc").split(), "-std=c11", "-Iinclude", source, LIBRARY,
                    f"-Wl,-rpath,{folder}", "-o", program], check=True)
    return subprocess.run([program], check=True, capture_output=True).stdout


def test_symbols():
    """Every function that the library exports can be called, and is told with its words."""
    listed = subprocess.run(["nm", "-D", "--defined-only", LIBRARY], check=True, text=True,
                            capture_output=True).stdout
    names = re.findall(r"\bT (pendres_\w+)", listed)
    assert len(names) > 100 and sorted(names) == sorted(_library.declared.functions), \
        set(names) ^ set(_library.declared.functions)
    for name in names:
        function = getattr(pendres.c, name[len("pendres_"):])
        assert name + "(" in function.__doc__
    assert "replaced in place" in pendres.c.strobe_advance.__doc__


def test_layout():
    """Sizes, places and values as the compiler has them."""
    structs = [n for n in _library.types_of("struct") if ffi.typeof(n).fields]
    lines, wanted = [], []
    for name in structs:
        kind = ffi.typeof(name)
        lines.append(f'printf("%zu\\n", sizeof({name}));')
        wanted.append(ffi.sizeof(kind))
        assert pendres.dtype(name).itemsize == ffi.sizeof(kind)
        for field, place in kind.fields:
            lines.append(f'printf("%zu\\n", offsetof({name}, {field}));')
            wanted.append(place.offset)
            element, offset = pendres.dtype(name).fields[field][:2]
            assert offset == place.offset and element.itemsize == ffi.sizeof(place.type), field
    for constant in sorted(dir(lib)):
        if constant.startswith("PENDRES_"):
            lines.append(f'printf("%lld\\n", (long long){constant});')
            wanted.append(int(getattr(lib, constant)))
    found = [int(line) for line in run_c("layout", "\n".join(lines)).split()]
    assert len(wanted) > 300 and found == wanted


def members(array):
    """The bytes of an array, member by member: what lies between members is nobody's, and compilers
    differ in what they leave there."""
    if array.dtype.names:
        return b"".join(members(array[name]) for name in array.dtype.names)
    return array.tobytes()


def test_same_bytes():
    """A strobe of 600 lanes, a response, a resonance: C's bytes."""
    body = """
  pendres_context *ctx = NULL;
  static pendres_pendulum p[600];
  static double x[600], v[600], e[600];
  static pendres_response response[2];
  static pendres_resonance resonance;
  const pendres_ensemble ensemble = pendres_ensemble_default();
  for (int i = 0; i < 600; i++) {
    p[i] = (pendres_pendulum){.damping = 0.25, .drive_amplitude = 0.2 + i / 1024.0,
                              .drive_frequency = 0.75};
    x[i] = i / 128.0;
  }
  if (pendres_context_create(NULL, &ctx) || pendres_strobe_advance(ctx, 600, p, x, v, 3, e) ||
      pendres_response_find(ctx, 2, p, &ensemble, response) ||
      pendres_resonance_find(ctx, p, 0.5, 1.2, &resonance))
    return 1;
  fwrite(x, sizeof x, 1, stdout);
  fwrite(v, sizeof v, 1, stdout);
  fwrite(e, sizeof e, 1, stdout);
  fwrite(response, sizeof response, 1, stdout);
  fwrite(&resonance, sizeof resonance, 1, stdout);
  pendres_context_free(ctx);"""
    i = np.arange(600)
    p = pendres.pendulum(damping=0.25, drive_amplitude=0.2 + i / 1024, drive_frequency=0.75)
    x, v, e = pendres.strobe_advance(p, i / 128, 0, 3, error=True)
    response = np.asarray(pendres.response(p[:2]))
    resonance = np.asarray(pendres.resonance(p[0], 0.5, 1.2))
    printed = run_c("bytes", body)
    for found in (x, v, e, response, resonance):
        wanted = np.frombuffer(printed[:found.nbytes], found.dtype).reshape(found.shape)
        assert members(found) == members(wanted), found.dtype
        printed = printed[found.nbytes:]
    assert not printed


def test_no_copies():
    """out= is written in place; a boundary's arrays are the library's memory, and keep it."""
    p = pendres.pendulum(damping=np.full(8, 0.24), drive_amplitude=0.2, drive_frequency=0.9)
    x, v = np.linspace(0, 1, 8), np.zeros(8)
    again = pendres.strobe_advance(p, x, v, 4)
    result = pendres.strobe_advance(p, x, v, 4, out=(x, v))
    assert np.shares_memory(result[0], x) and np.array_equal(x, again[0])
    apart = np.zeros((8, 2))
    for wrong in (apart[:, 0], np.zeros(8, np.float32)):  # strided; of another type
        try:
            pendres.strobe_advance(p, x, v, 4, out=(wrong, v))
            assert False
        except (ValueError, TypeError):
            pass
    assert apart.sum() == 0
    q = pendres.pendulum(damping=0.13, drive_amplitude=0.2, drive_frequency=0.8)
    line = pendres.boundary(pendres.saddle(pendres.attractors(q).table.orbit[0]))
    points, pointer = line.x, line.pointer
    assert points.ctypes.data == int(ffi.cast("uintptr_t", pointer.x))
    total = points.sum()
    del line, pointer
    assert points.sum() == total and not points.flags.writeable


def raised(kind, function, *arguments, **more):
    """The words of an exception that must come."""
    try:
        function(*arguments, **more)
    except kind as why:
        return str(why)
    raise AssertionError(f"no {kind.__name__}")


def test_errors():
    """Exceptions of a class for each status, with the library's sentence; unknown names."""
    p = pendres.pendulum(damping=0.24, drive_amplitude=0.2, drive_frequency=0.9)
    words = raised(pendres.InvalidArgument, pendres.strobe_advance, p, [0, np.nan], 0, 1)
    assert "pendulum 1" in words, words
    raised(ValueError, pendres.strobe_advance, p, np.inf, 0, 1)
    assert "tolerance" in raised(pendres.InvalidArgument, pendres.Context, tolerance=-1)
    assert raised(pendres.NotFound, pendres.resonance, p, 0.5, 0.6)
    assert "drive_amplitude" in raised(TypeError, pendres.pendulum, drive_amplitud=1)
    assert "tolerance" in raised(TypeError, pendres.Context, tolerances=1)
    assert raised(TypeError, pendres.c.strobe_advance, 1)
    raised(TypeError, pendres.resonance, 0.24)
    assert {e.status for e in pendres.Error.__subclasses__()} == set(pendres.Status) - {0}
    assert pendres.Label.SA == 0 and pendres.Peak.EDGE == 1 and pendres.Status.OK == 0


def test_wrong_types():
    """Arguments of a wrong kind, each in the place of a good one, are refused in words of this
    package or of the library: by none of the errors that tell of its own insides."""
    p = pendres.pendulum(damping=0.13, drive_amplitude=0.2, drive_frequency=0.8)
    hot = pendres.pendulum(**{**{n: p[n] for n in p.dtype.names}, "temperature": 0.04})
    found = pendres.attractors(p)
    orbit, request = found.table.orbit[0], pendres.cloud_request(hot, 1.0, 0.0, trajectories=8)
    fold, branch = pendres.fold(orbit), pendres.branches(orbit, 0.7, 0.9)[0]
    tally = pendres.switching(hot, found, 0, trajectories=8, periods=9)
    rate = pendres.rate(tally, 0, 1)
    two = np.array([0.7, 0.8])
    good = {
        pendres.strobe_advance: (p, 1.0, 0.0, 1), pendres.strobe_record: (p, 1.0, 0.0, 1, 8),
        pendres.orbits: (p, orbit.x, orbit.v), pendres.orbit_sample: (orbit, 8),
        pendres.free_frequency: (1.0,), pendres.free_frequency_integrate: (1.0,),
        pendres.attractors: (p, 1.0, 0.0), pendres.settle: (p, 1.0, 0.0),
        found.settle: (1.0, 0.0), pendres.response: (p, pendres.ensemble(members=2)),
        pendres.resonance: (p, 0.5, 1.2, pendres.ensemble(members=2)),
        pendres.phase_line: (p, pendres.ensemble(members=2)), pendres.basins: (p, two, two),
        pendres.branches: (orbit, 0.7, 0.9), pendres.fold: (orbit,), branch.at: (0.8,),
        pendres.curves: (fold, "damping", two, two), pendres.cusp: (fold, "damping"),
        pendres.backbone: (p,), pendres.hysteresis: (p, two, 1.0, 0.0),
        pendres.saddle: (orbit,), pendres.boundary: (orbit,),
        pendres.langevin_advance: (hot, 1.0, 0.0, 1), pendres.cloud_request: (p, 1.0, 0.0),
        pendres.cloud_steps: (request,), pendres.cloud: (request,),
        pendres.switching: (hot, found, 0), pendres.linear_noise: (hot, orbit.x, orbit.v),
        pendres.rate: (tally, 0, 1), pendres.activation: (two, [rate, rate]),
        pendres.words: (), pendres.array: ("pendres_orbit", 3), pendres.dtype: ("pendres_orbit",),
        pendres.c.strobe_advance: (pendres.Context(), 0, None, None, None, 1, None),
        pendres.c.context_cost: (None, None), pendres.Context: (), pendres.pendulum: (),
        pendres.ensemble: ()}
    named = {pendres.switching: {"trajectories": 8, "periods": 9}, pendres.words: {"variable": 1},
             pendres.Context: {"tolerance": 0, "method": 0, "seed": 0, "stop": None},
             pendres.pendulum: {"damping": 0, "force": 0, "force_coefficients": [1]},
             pendres.ensemble: {"members": 2, "shape": "line"}, pendres.phase_line: {"spacing": 0},
             pendres.hysteresis: {"parameter": "damping"}, pendres.branches: {"parameter": 0}}
    wrong = (3, 1.5, -1, "x", [], {}, object(), None, p, orbit, found, two, np.nan, 2**70)
    since, refused = [0.0], 0
    with pendres.Context(stop=lambda: time.process_time() > since[0] + 0.05):
        for function, arguments in good.items():
            for place in (*range(len(arguments)), *named.get(function, {})):
                for bad in wrong:
                    tried, more = list(arguments), dict(named.get(function, {}))
                    (more if isinstance(place, str) else tried)[place] = bad
                    since[0] = time.process_time()
                    try:
                        function(*tried, **more)
                    except (TypeError, ValueError, OverflowError, pendres.Error) as why:
                        assert len(str(why)) > 12, (function, place, bad, why)
                        refused += 1
    assert refused > 700, refused


def test_choices():
    """Names of forces and shapes; coefficients belong to one pendulum; results whose error exceeds
    the tolerance come with a warning."""
    one = pendres.pendulum(force="polynomial", force_coefficients=[1, 0, 0.5], drive_frequency=1)
    assert one.shape == () and one.force == pendres.Force.POLYNOMIAL
    assert list(one.force_coefficients) == [1, 0, 0.5, 0, 0, 0, 0, 0]
    same = pendres.pendulum(force=[1, 0, 0.5], drive_frequency=1)
    assert same.shape == () and np.asarray(same) == np.asarray(one)
    same = pendres.pendulum(force=[[1, 0, 0.5], [1, 0, 0.25]], damping=[0.1, 0.2])
    assert list(same.force) == [pendres.Force.POLYNOMIAL] * 2
    assert list(pendres.pendulum(force=same.force).force) == list(same.force)
    raised(TypeError, pendres.pendulum, force=[1, 0, 1], force_coefficients=[1])
    assert "each row" in raised(TypeError, pendres.pendulum, force=[[1], [1, 2]])
    several = pendres.pendulum(force="polynomial", drive_frequency=1, damping=[0.1, 0.2],
                               force_coefficients=[[1, 0, 0.5], [1, 0, 0.25]])
    assert several.shape == (2,) and list(several.force_coefficients[:, 2]) == [0.5, 0.25]
    assert pendres.ensemble(shape="random")["shape"] == pendres.EnsembleShape.RANDOM
    assert "squid" in raised(ValueError, pendres.pendulum, force="spring")
    raised(TypeError, pendres.pendulum, force_coefficients=np.zeros(9))
    p = pendres.pendulum(damping=0.13, drive_amplitude=0.2, drive_frequency=0.8)
    orbit = pendres.attractors(p).table.orbit[0]
    best = pendres.fold(orbit)
    with pendres.Context(tolerance=1e-10, steps_per_period=8), \
            warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        fold, cusp = pendres.fold(orbit), pendres.cusp(best)
    assert [w.category for w in said] == [RuntimeWarning] * 2 and "known to" in str(said[0].message)
    # The error is estimated from two runs: the truth, known to rounding, is within it.
    assert fold.value_error > 1e-10 and abs(fold.value - best.value) < fold.value_error
    assert all(cusp.value_error > 1e-10)
    assert all(abs(cusp.value - pendres.cusp(best).value) < cusp.value_error)


def test_stops():
    """Ctrl-C ends a computation soon, and so does a function; the context is good afterwards."""
    p = pendres.pendulum(damping=0.24, drive_amplitude=0.2, drive_frequency=0.9)
    context = pendres.Context()
    threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
    start = time.monotonic()
    raised(KeyboardInterrupt, pendres.strobe_advance, p, 1, 0, 10**9, context=context)
    assert time.monotonic() - start < 20
    assert pendres.strobe_advance(p, 1, 0, 5, context=context) == pendres.strobe_advance(p, 1, 0, 5)
    asked = []
    stopping = pendres.Context(stop=lambda: asked.append(0) or len(asked) > 3)
    raised(pendres.Interrupted, pendres.strobe_advance, p, 1, 0, 10**9, context=stopping)
    stopping = pendres.Context(stop=lambda: True)
    raised(pendres.Interrupted, pendres.langevin_advance, p, 1, 0, 10**9, context=stopping)


def test_threads():
    """While the library computes in one thread, another runs, and may ask it to stop."""
    p = pendres.pendulum(damping=0.24, drive_amplitude=0.2, drive_frequency=0.9)
    seen, stop = [], threading.Event()

    def compute():
        with pendres.Context(stop=stop.is_set) as context:
            seen.append(context)
            seen.append(raised(pendres.Interrupted, pendres.strobe_advance, p, 1, 0, 10**9))

    thread = threading.Thread(target=compute)
    thread.start()
    while not seen:
        time.sleep(0.01)
    time.sleep(0.1)
    assert thread.is_alive()
    raised(pendres.Busy, pendres.strobe_advance, p, 1, 0, 1, context=seen[0])
    stop.set()
    thread.join(60)
    assert len(seen) == 2


def test_overhead():
    """512 lanes through twenty drive periods cost less than 5 % more than by C's own call. A period
    takes a quarter of a millisecond, and a call from Python 15 us more than one from C where the
    interpreter is in the processor's caches, and up to 100 us where it has to be fetched again."""
    n = 512
    p = pendres.pendulum(damping=np.full(n, 0.24), drive_amplitude=0.2, drive_frequency=0.9)
    x, v = np.linspace(-1, 4, n), np.zeros(n)
    bare = ffi.new("pendres_context **")
    assert lib.pendres_context_create(ffi.NULL, bare) == 0
    pointers = (ffi.from_buffer("pendres_pendulum[]", p), ffi.from_buffer("double[]", x),
                ffi.from_buffer("double[]", v))
    context, times = pendres.Context(), ([], [])
    # The fastest of each, since a busy machine slows single calls of either kind; where it is so busy
    # that none of forty is undisturbed, of more.
    for _ in range(1000):
        start = time.process_time()
        pendres.strobe_advance(p, x, v, 20, out=(x, v), context=context)
        middle = time.process_time()
        lib.pendres_strobe_advance(bare[0], n, *pointers, 20, ffi.NULL)
        times[0].append(middle - start)
        times[1].append(time.process_time() - middle)
        if len(times[0]) >= 40 and min(times[0]) < 1.05 * min(times[1]):
            break
    lib.pendres_context_free(bare[0])
    python, c = (min(t) for t in times)
    print(f"twenty drive periods of {n} lanes: {1e6 * c:.0f} us in C, {100 * (python / c - 1):.1f} "
          "% more from Python")
    assert python < 1.05 * c


def test_functions():
    """Each function once, with results that others know or that the theory gives."""
    q = pendres.pendulum(damping=0.13, drive_amplitude=0.2, drive_frequency=0.8)
    found = pendres.attractors(q)
    table = found.table
    assert list(table.label) == [pendres.Label.SA, pendres.Label.LA] and len(found) == 2
    orbits, outcome = pendres.orbits(q, table.orbit.x, table.orbit.v)
    assert all(outcome == 0) and np.allclose(orbits.loop_area, table.orbit.loop_area, atol=1e-8)
    x, v = pendres.orbit_sample(orbits[1], 8)
    recorded = pendres.strobe_record(q, orbits.x[1], orbits.v[1], 1, 8, error=True)
    # Both to 1e-8, the context's tolerance, and each with its error.
    assert np.allclose(recorded[0][:8], x, atol=1e-7) and np.allclose(recorded[1][:8], v, atol=1e-7)
    outcome, others = pendres.settle(q, orbits.x, orbits.v)
    assert list(outcome.label) == [0, 1] and len(others) == 2
    assert list(found.settle(orbits.x, orbits.v).attractor) == [0, 1]
    response = pendres.response(q, pendres.ensemble(members=16))
    assert list(response.state.label[:2]) == [0, 1] and response.state_members.sum() == 16
    fold = pendres.fold(orbits[0])
    branch, = pendres.branches(orbits, 0.5, 1.0)
    # numpy packs a structure that ends in padding when it joins arrays of it.
    joined = np.concatenate([orbits[:1], orbits[1:]])
    again, = pendres.branches(joined, 0.5, 1.0)
    assert np.array_equal(again.points.arclength, branch.points.arclength)
    # What is shown has errors, and words instead of numbers.
    for what, has in ((found, ["attractors: 2", "sa", "± "]), (branch, ["fold", "ends: range"]),
                      (pendres.resonance(q), ["pendres_resonance", "peak = ", "frequency = 0."])):
        assert all(text in repr(what) for text in has), repr(what)
        assert "unused" not in repr(what) and "spare" not in repr(what)
    assert "<table>" in found._repr_html_() and "<th>loop area</th>" in found._repr_html_()
    assert min(abs(branch.bifurcations.value - fold.value)) < 1e-7
    assert len(branch.at(0.8)) == 3 and branch.ends == (0, 0)
    path = np.linspace(0.7, 0.9, 5)
    sweep = pendres.hysteresis(q, np.append(path, path[::-1]), 1.6)
    assert len(sweep.points) == 10 and list(sweep.jumps.direction) == [1, -1]
    assert abs(sweep.jumps.value[0] - fold.value) < 1e-7
    cusp = pendres.cusp(fold)
    curve, = pendres.curves(branch.bifurcations, "damping", [0.5, 0.05], [1.0, 0.3])
    assert np.allclose(curve.cusps.value[0], cusp.value, atol=1e-7)
    assert min(abs(curve.at(0.13).value - fold.value)) < 1e-7
    grid = pendres.basins(q, np.linspace(-1.5, 4.7, 24), np.linspace(-2, 2, 24))
    assert grid.state.shape == (24, 24) and abs(grid.fraction.sum() - 1) < 1e-12
    line = pendres.pendulum(damping=0.13, drive_amplitude=0.2, drive_frequency=[0.7, 0.8])
    points, branches = pendres.phase_line(line, pendres.ensemble(members=16))
    assert points.exact[1] == pendres.Regime.COEXISTENCE and len(branches) >= 1
    backbone, error, outcome = pendres.backbone(pendres.pendulum(
        damping=[0.3, 0.2], drive_amplitude=0.2, drive_frequency=1))
    assert np.allclose(backbone.phase_lag, np.pi / 2, atol=1e-7) and all(error < 1e-6)
    weak = pendres.pendulum(damping=[0.3, 0.01], drive_amplitude=0.2, drive_frequency=1)
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        assert np.isnan(pendres.backbone(weak)[1]).tolist() == [False, True] and len(told) == 1
    try:
        pendres.backbone(weak[1])
        raise AssertionError("a backbone that there is not")
    except pendres.NotFound as why:
        assert "too weak a damping" in str(why)
    exact = pendres.free_frequency(1.0)
    assert abs(pendres.free_frequency_integrate(1.0)[0] - exact) < 1e-8
    hot = pendres.pendulum(damping=0.13, drive_amplitude=0.2, drive_frequency=0.8,
                           temperature=1e-4)
    request = pendres.cloud_request(hot, orbits[1].x, orbits[1].v, trajectories=64, record=20)
    with pendres.Context(seed=5):
        assert pendres.cloud_steps(request).steps_per_period >= 2
        cloud, xs, _ = pendres.cloud(request, points=True)
        linear = pendres.linear_noise(hot, orbits[1].x, orbits[1].v)
        variance = cloud.statistics[pendres.LangevinStatistic.COV_XX]
        # Linear theory is exact to first order in T; five standard errors.
        assert xs.shape == (64, 20)
        assert abs(variance.value - linear.covariance.xx) < 5 * variance.error
        rates = []
        for temperature in (0.04, 0.05):
            hot["temperature"] = temperature
            tally = pendres.switching(hot, found, 0, trajectories=64, periods=100)
            rates.append(pendres.rate(tally, 0, 1))
            assert 0 < rates[-1].lower < rates[-1].value < rates[-1].upper
        assert pendres.activation([0.04, 0.05], rates, fewest=1).points == 2


def test_file():
    """A file of the program's, where xarray is."""
    program = os.environ.get("RESONANCE")
    try:
        import h5netcdf  # noqa: F401, pylint: disable=unused-import
        import xarray  # noqa: F401, pylint: disable=unused-import
    except ImportError:
        program = None
    if not program:
        print("files: skipped, no xarray with h5netcdf")
        return
    deck, out = os.path.join(SCRATCH, "one.nml"), os.path.join(SCRATCH, "one.h5")
    with open(deck, "w", encoding="utf-8") as text:
        text.write("&scene kind = 'resonance_curve' /\n&pendulum drive_amplitude = 0.2 /\n"
                   "&sweep damping = 0.13, 0.24 /\n")
    subprocess.run([program, "-o", out, deck], check=True, capture_output=True)
    data = pendres.open(out)
    p = pendres.pendulum(damping=[0.13, 0.24], drive_amplitude=0.2)
    again = [pendres.resonance(one) for one in p]
    assert list(data.resonance_frequency.values) == [r.frequency for r in again]
    assert list(pendres.words(data.peak).values) == ["edge", "smooth"]
    assert "deck" in pendres.open(out, group="provenance")


DUFFING = {"damping": 0.1, "drive_amplitude": 0.3, "drive_frequency_range": (1, 2, 21), "x": 0}


def has_files():
    """Whether scenes can be computed, and their files read."""
    import importlib.util
    return bool(os.environ.get("RESONANCE")) and all(
        importlib.util.find_spec(name) for name in ("xarray", "h5netcdf"))


def imagined(name, body):
    """A program in place of the real one, as pendres.run would start it."""
    path = os.path.join(SCRATCH, name)
    with open(path, "w", encoding="utf-8") as script:
        script.write(f"#!/bin/sh\nreal='{os.path.abspath(os.environ['RESONANCE'])}'\n{body}\n")
    os.chmod(path, 0o700)
    return path


def test_scenes():
    """A scene by keywords is the program's own file, to the bit, however its deck is given."""
    if not has_files():
        print("scenes: skipped, no xarray with h5netcdf")
        return
    deck, out = os.path.join(SCRATCH, "up.nml"), os.path.join(SCRATCH, "up.h5")
    text = ("&scene kind = 'hysteresis' /\n&pendulum damping = 0.1, drive_amplitude = 0.3, "
            "force = 'polynomial', force_coefficients = 1, 0, 1 /\n"
            "&sweep drive_frequency_range = 1, 2, 21 /\n&hysteresis x = 0 /\n")
    with open(deck, "w", encoding="utf-8") as file:
        file.write(text)
    subprocess.run([os.environ["RESONANCE"], "-o", out, deck], check=True, capture_output=True)
    wanted = pendres.open(out)
    groups = {"scene": {"kind": "hysteresis"}, "sweep": {"drive_frequency_range": (1, 2, 21)},
              "pendulum": {"force": pendres.Force.POLYNOMIAL, "damping": np.float64(0.1),
                           "force_coefficients": np.array([1, 0, 1]), "drive_amplitude": 0.3},
              "hysteresis": {"x": 0}}
    for found in (pendres.hysteresis(**DUFFING, force=[1, 0, 1]), pendres.run(deck),
                  pendres.run(text), pendres.run(groups), pendres.run(groups, threads=1),
                  pendres.run(text.replace("0.3", "0.2"), pendulum={"drive_amplitude": 0.3})):
        assert found.attrs["scene"] == "hysteresis"
        for one in (found, wanted):
            for name in ("history", "deck", "title"):
                one.attrs.pop(name, None)
        assert found.identical(wanted), found
    assert wanted.amplitude.attrs["units"] and "amplitude_error" in wanted
    # In SI, scales and numbers as keywords: lengths are in units of 2 m.
    beam = pendres.hysteresis(**{**DUFFING, "x": "0 m"}, mass="1 kg",
                              force=["1 N/m", 0, "0.25 N/m^3"])
    real = pendres.si(beam)
    assert real.amplitude.units == "m" and "si_factor" not in real.amplitude.attrs
    assert np.allclose(real.amplitude, 2 * wanted.amplitude, rtol=1e-15, atol=0)
    assert real.amplitude_error.units == "m"
    assert np.allclose(real.drive_frequency, wanted.drive_frequency / (2 * np.pi), rtol=1e-15)
    assert pendres.si(beam.amplitude).identical(real.amplitude)
    assert pendres.si(wanted).identical(wanted)
    # What pint 0.25 and unyt 3.2 read; blanks and powers without a sign they refuse.
    assert pendres.pint_units(real.amplitude) == "m"
    for text, form in {"N m-1": "N*m**-1", "kg m-2 s-2": "kg*m**-2*s**-2", "m2 s-1": "m**2*s**-1",
                       "1": "1", "V": "V", "ohm": "ohm", "s-1": "s**-1"}.items():
        assert pendres.pint_units(text) == form
    # The library's function of the same name, with the same jumps.
    p = pendres.pendulum(force=[1, 0, 1], damping=0.1, drive_amplitude=0.3, drive_frequency=1)
    path = wanted.drive_frequency.values
    jumps = pendres.hysteresis(p, np.append(path, path[::-1]), 0.0).jumps
    assert list(jumps.value) == list(wanted.jump_parameter.values)
    # Groups of the file, while there is one; none is left behind.
    data, home = pendres.free_oscillation(amplitude=[0.5, 1.0]), os.getcwd()
    assert "0.5, 1.0" in pendres.open(data, "provenance").deck.item()
    where, copy = data.encoding["source"], data.copy()
    del data
    assert "gone" in raised(FileNotFoundError, pendres.open, copy, "provenance")
    assert not os.path.exists(os.path.dirname(where))
    os.chdir(SCRATCH)
    try:
        data = pendres.free_oscillation(amplitude=0.5, output="kept.h5", resume=True)
        assert data.identical(pendres.open("kept.h5")) and not os.path.exists("resonance.h5")
    finally:
        os.chdir(home)


def test_scenes_outer():
    """Any scene at several values of one of its numbers, in one Dataset."""
    if not has_files():
        return
    data = pendres.hysteresis(damping=0.15, drive_frequency=[0.75, 0.8], start="sa",
                              outer={"key": "drive_amplitude", "values": [0.1, 0.2]})
    alone = pendres.hysteresis(damping=0.15, drive_frequency=[0.75, 0.8], start="sa",
                               drive_amplitude=0.2)
    assert data.amplitude.dims == ("drive_amplitude", "direction", "drive_frequency")
    assert (data.amplitude.sel(drive_amplitude=0.2).values == alone.amplitude.values).all()
    assert data.attrs["outer_axis"] == "drive_amplitude"


def test_kept():
    """Records are pickled; what is the library's is refused with a sentence. What is not needed by an
    import waits."""
    import copy
    import pickle
    p = pendres.pendulum(damping=0.13, drive_amplitude=0.2, drive_frequency=0.8)
    found = pendres.attractors(p)
    assert pickle.loads(pickle.dumps(found.table)).tobytes() == found.table.tobytes()
    assert pickle.loads(pickle.dumps(pendres.NotFound("no"))).args == ("no",)
    branch, = pendres.branches(found.table.orbit, 0.7, 0.9)
    grid = pendres.basins(p, np.array([0.0, 1.0]), np.array([0.0]))
    for thing in (found, branch, grid, pendres.Context()):
        for way in (pickle.dumps, copy.deepcopy):
            words = raised(TypeError, way, thing)
            assert "kept in the library" in words, words
    code = ("import pendres, sys; from pendres._library import declared; "
            "assert 'functions' not in vars(declared); late = {'xarray', 'matplotlib', "
            "'importlib.metadata'} & set(sys.modules); assert not late, late")
    subprocess.run([sys.executable, "-S", "-c", "import sys; sys.path[:] = " + repr(sys.path) +
                    "; " + code], check=True)


def test_stubs():
    """What type checkers are told is what there is."""
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    import stubs_list
    with open(os.path.join(os.path.dirname(pendres.__file__), "__init__.pyi"),
              encoding="utf-8") as file:
        assert file.read() == stubs_list.text(), "make python-stubs"


def test_plot():
    """The picture of a Dataset is that of its file."""
    import importlib.util
    if not importlib.util.find_spec("matplotlib"):
        return
    import matplotlib
    matplotlib.use("Agg")
    before = dict(matplotlib.rcParams)
    data = pendres.hysteresis(damping=0.12, drive_amplitude=0.2, start="sa",
                              drive_frequency_range=(0.7, 0.9, 5))
    figure = pendres.plot(data, title=False)
    assert figure.axes and not matplotlib.pyplot.get_fignums()
    assert [a.get_ylabel() for a in figure.axes] == [
        a.get_ylabel() for a in data.pendres.plot().axes]
    assert dict(matplotlib.rcParams) == before
    assert "no 'sise'" in raised(TypeError, pendres.plot, data, sise=1)
    assert "file is gone" in raised(FileNotFoundError, pendres.plot, 3)
    away = pendres.escape(damping=0.5, drive_amplitude=0, drive_frequency=1, torque=0.8, x=2.5)
    assert abs(float(away.action[0]) - 0.1703982259307) < 1e-11
    for part in (data.isel(drive_frequency=slice(2)), data * 2, data[list(data.data_vars)[0]]):
        assert "no longer what the file holds" in raised(ValueError, pendres.plot, part)
    line = pendres.lyapunov_map(damping=[0.5], drive_amplitude=[1.0, 1.15], drive_frequency=2 / 3)
    assert line.lyapunov.dims == ("damping", "drive_amplitude") and line.lyapunov.shape == (1, 2)
    assert len(pendres.plot(line).axes) == 1
    words = raised(TypeError, pendres.hysteresis, precision=1e-6, damping=0.1)
    assert "a group of a deck" in words and len(words) < 200, words
    words = raised(OSError, pendres.fit, free=["damping"], error=0.1, axis="drive_frequency",
                   observable="amplitude", drive_amplitude=0.1, columns=["w", "a"],
                   file={"w": [0.8, 0.9, 1.0], "a": [0.5, "x", 0.5]})
    assert "row 1" in words and "/tmp" not in words and "table.csv" not in words, words
    for start in ("sa", "la"):  # where one state exists it is meant
        lone = pendres.hysteresis(force=[1, 0, 1], damping=0.1, drive_amplitude=0.3, start=start,
                                  drive_frequency=[1.2, 1.21])
        assert abs(lone.amplitude.values[0, 0] - 0.994) < 1e-2
    laboratory = pendres.si(pendres.hysteresis(
        units={"critical_current": "10 uA", "resistance": "10 ohm", "capacitance": "0.5 pF"},
        drive_amplitude=0, drive_frequency=1, torque_range=("0 uA", "5 uA", 3), x=1.6))
    assert laboratory.mean_velocity.attrs["long_name"] == "mean voltage"
    assert laboratory.torque.attrs["long_name"] == "current I"


def test_scenes_known():
    """Functions of scenes, their keywords and their words are the program's: also of a kind, in a
    group, with a key, that this package has never heard of."""
    if not has_files():
        return
    for kind in pendres.kinds():
        function = getattr(pendres, kind)
        keys = set(inspect.signature(function).parameters) - {"arguments"}
        assert kind in dir(pendres) and function.__name__ == kind and "threads" in keys, kind
        assert "&scene" in function.__doc__, kind
        assert all(re.search(rf"\b{key.rstrip('_')}\b", function.__doc__) for key in keys), kind
    assert "rate = a number" in pendres.explain("rate")
    known = os.environ["PENDRES_PROGRAM"]
    try:
        os.environ["PENDRES_PROGRAM"] = imagined("newer", """case $1 in
  --list) "$real" --list; echo 'springs  how springs age' ;;
  --explain=springs) printf '%s\\n' 'springs: age' '' '&ageing' '  years, years_range = numbers' \\
    '  from = a year' ;;
  -) [ "$2" = --dump-namelist ] && cat >&2 && exit 2 ;;
  *) exec "$real" "$@" ;;
esac""")
        said = raised(pendres.InvalidArgument, pendres.springs, years=[0.5, 3], from_=1,
                      ageing={"of": "it's"})
        assert said.split() == ("&scene kind = 'springs' / &ageing years = 0.5, 3 from = 1 "
                                "of = 'it''s' /").split(), said
        assert "how springs age" in pendres.springs.__doc__
        os.environ["PENDRES_PROGRAM"] = imagined("older", "echo resonance 0.0.1")
        assert "0.0.1" in raised(ImportError, pendres.run, "&scene /")
        os.environ["PENDRES_PROGRAM"] = os.path.join(SCRATCH, "none")
        assert "no program" in raised(OSError, pendres.run, "&scene /")
        assert "no program" in raised(AttributeError, getattr, pendres, "lyapunov")
        pendres.basins(pendres.pendulum(damping=0.3, drive_frequency=1), [0, 1], [0, 1])
        # How far a run is, on a terminal; and its ends.
        for end, kind, words in (("exit 1", pendres.FileError, "no room\n  a.csv:2:1: error: x"),
                                 ("exit 75", pendres.Interrupted, "was stopped"),
                                 ("kill -9 $$", pendres.Interrupted, "signal 9"), ("", None, "")):
            os.environ["PENDRES_PROGRAM"] = imagined("ending" + end[:6].replace(" ", ""), f"""
case $* in *--output*) printf 'resonance: %s\\n' '4 % of 9 parts after 2.0 s' >&2
  [ '{end}' = '' ] || printf 'resonance: %s\\n' 'error: no room' '  a.csv:2:1: error: x' >&2
  {end} ;; esac
exec "$real" "$@\"""")
            sys.stderr, shown = io.StringIO(), sys.stderr
            sys.stderr.isatty = lambda: True
            try:
                if kind:
                    assert words in raised(kind, pendres.free_oscillation, amplitude=0.5), end
                else:
                    pendres.free_oscillation(amplitude=0.5)
                told = sys.stderr.getvalue()
            finally:
                sys.stderr = shown
            assert told == "\r\033[K4 % of 9 parts after 2.0 s\r\033[K", told
    finally:
        os.environ["PENDRES_PROGRAM"] = known
    assert "no scene" in raised(AttributeError, getattr, pendres, "lyapunov")


def test_scenes_wrong():
    """What is wrong with keywords is told by their names; failed points are a warning."""
    if not has_files():
        return
    wrong, deck = pendres.InvalidArgument, {**DUFFING, "force": [1, 0, 1]}
    assert "did you mean 'damping'" in raised(TypeError, pendres.hysteresis, dampng=1)
    assert "did you mean 'drive_frequency'" in raised(TypeError, pendres.hysteresis, omega=1)
    assert "did you mean 'damping'" in raised(TypeError, pendres.hysteresis, gamma=1)
    assert "drive_frequency_range=(first" in raised(TypeError, pendres.hysteresis, damping=0.1,
                                                    drive_frequency=(0.5, 1.0, 11))
    assert "for basins" in raised(TypeError, pendres.hysteresis, refine=1)
    assert "no keyword 'kind'" in raised(TypeError, lambda: pendres.hysteresis(kind="orbit"))
    assert "&noise" in raised(TypeError, pendres.response, seed=1)
    assert "keywords" in raised(TypeError, pendres.lyapunov_map, 0.1)
    assert "rate" in raised(TypeError, pendres.ramp, damping=0.1)
    assert "force" in raised(TypeError, pendres.hysteresis, **deck, force_coefficients=[1])
    assert "output" in raised(ValueError, pendres.hysteresis, **deck, resume=True)
    assert "--threads" in raised(wrong, pendres.hysteresis, **deck, threads=0)
    assert "dmping" in raised(wrong, pendres.run, "&scene kind='orbit' /\n&pendulum dmping=1 /")
    assert "none.nml" in raised(wrong, pendres.run, "none.nml")
    assert "group" in raised(TypeError, pendres.run, {"scene": 1})
    assert "such folder" in raised(pendres.FileError, pendres.hysteresis, **deck,
                                   output="/none/such folder/a.h5")
    said = raised(wrong, pendres.hysteresis, **{**deck, "damping": -0.1, "x": None})
    assert "'damping' must be positive\n    damping = -0.1\n" in said and "'start'" in said
    assert ":" not in said.split("\n")[0], said
    frequencies = [*np.linspace(1, 2, 40), np.nan]
    said = raised(wrong, pendres.hysteresis, **{**deck, "drive_frequency_range": None},
                  drive_frequency=frequencies)
    assert "nan" in said and "^" in said and "'drive_frequency'" in said, said
    for bad in ([], {}, object(), 1j, "a\nb", [[1, 2]], np.zeros((2, 2)), np.nan, 2**70, b"x"):
        for key in ("damping", "drive_frequency_range", "start", "force", "title"):
            try:
                pendres.hysteresis(**{**deck, "x": None, "damping": -1, key: bad})
                raise AssertionError((key, bad))
            except (TypeError, ValueError) as why:
                assert len(str(why)) > 12, (key, bad, why)
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        data = pendres.resonance_curve(damping=[0.1, 0.2], drive_amplitude=0.3,
                                       drive_frequency_range=(0.4, 0.5))  # the second is above
    assert list(data.failed.values > 0) == [False, True] and len(told) == 1, (data.failed, told)
    assert told[0].category is RuntimeWarning and told[0].filename.endswith("python_check.py")
    assert "1 point failed" in str(told[0].message) and "damping 0.2" in str(told[0].message)
    known = pendres._files._importable  # pylint: disable=protected-access
    pendres._files._importable = lambda name: name != "xarray"
    try:
        assert "python3-xarray" in raised(ImportError, pendres.hysteresis, **deck)
    finally:
        pendres._files._importable = known


def test_scenes_stop():
    """Ctrl-C ends the program, too, and leaves nothing; with an output it can go on."""
    if not has_files():
        return
    out = os.path.join(SCRATCH, "stopped.h5")
    before = set(glob.glob(os.path.join(tempfile.gettempdir(), "pendres-*")))
    start = time.monotonic()
    for more in ({}, {"output": out}):
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        raised(KeyboardInterrupt, pendres.run, "input/lyapunov.nml", **more)
    assert time.monotonic() - start < 40 and not os.path.exists(out)
    assert before == set(glob.glob(os.path.join(tempfile.gettempdir(), "pendres-*")))


def test_tutorial():
    """Every command of docs/python.md, in its order, as it stands; the figure's numbers are the
    program's, and pictures are drawn where there is matplotlib."""
    import contextlib
    import importlib.util
    with open("docs/python.md", encoding="utf-8") as page:
        text = page.read()
    program = os.environ.get("RESONANCE")
    drawn = importlib.util.find_spec("matplotlib") is not None
    os.symlink(os.path.abspath("input"), os.path.join(SCRATCH, "input"))
    names, done, printed, home = {}, 0, io.StringIO(), os.getcwd()
    os.chdir(SCRATCH)
    try:
        for block in re.findall(r"^```python\n(.*?)^```$|^    (resonance [^\n]*)$", text,
                                flags=re.M | re.S):
            if block[1] and program:
                subprocess.run([program, *block[1].split()[1:]], check=True, capture_output=True)
            files = re.search(r"pendres\.(open|run|ramp)|_range=", block[0])
            if ("matplotlib" in block[0] and not drawn) or (files and not has_files()):
                continue
            with contextlib.redirect_stdout(printed):
                exec(compile(block[0], "docs/python.md", "exec"), names)  # pylint: disable=exec-used
            done += 1
    finally:
        os.chdir(home)
    assert done > 10 and "True\n" in printed.getvalue() or not has_files(), printed.getvalue()
    # Fig. 2 as the paper has it: edges at weak damping, and smooth peaks at strong.
    assert not names["smooth"][:8].any() and names["smooth"][-80:].all()
    print(printed.getvalue())


def main():
    """All of them; the first that fails ends the program with its traceback."""
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            start = time.monotonic()
            test()
            print(f"{name}: ok, {time.monotonic() - start:.1f} s", flush=True)


main()
