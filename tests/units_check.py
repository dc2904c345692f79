#!/usr/bin/env python3
"""The same oscillator in other units: every scene's results are the same digits.

    units_check.py RESONANCE

Decks of a Duffing oscillator are run in units of length and time that are powers of two, and all
results compared with those of the plain units, bit for bit, each multiplied by what its dimension
makes of them. Dimensions are told here by the names of variables; all others are pure numbers. The
plain ones are in a laboratory's units, too: what files say makes SI of a result is what follows from
its dimension.
"""
import os
import re
import subprocess
import sys
import tempfile

import h5py
import numpy

UNITS = [(2.0**10, 2.0**-7), (2.0**-21, 2.0**-23)]

# Powers of length and time by the first expression that a name, without "_error", matches.
LENGTH, SPEED, RATE, TIME, FORCE, AREA, POWER, PURE = (
    (1, 0), (1, -1), (0, -1), (0, 1), (1, -2), (2, -2), (2, -3), (0, 0))
DIMENSIONS = [
    (r"(.*_)?a1", (0, -2)), (r"a2", (-1, -2)), (r"(.*_)?a3", (-2, -2)), (r"a4", (-3, -2)),
    (r"a5", (-4, -2)),
    (r".*escape_rate_bound", PURE),  # a drive period
    (r".*cov_xx", (2, 0)), (r".*cov_xv", (2, -1)), (r".*cov_vv", AREA),
    (r"power_spectrum", (2, -1)),
    (r".*curvature", (-2, -1)),
    (r".*drive_amplitude|.*torque|drive", FORCE),
    (r"drive_period|resonance_period|.*exposure.*|.*mean_time.*", TIME),
    (r".*mean_power", POWER),
    (r".*(loop_area|dissipation|torque_work|parametric_work|energy.*)", AREA),
    (r"(fit_)?temperature(_.*)?|linear_depth_.*", AREA),
    (r".*(damping|frequency|lyapunov|lyapunov_exponent|rate(_.*)?)", RATE),
    (r".*(amplitude|cosine|sine|mean_angle|(_|^)x|turning_point_.*)", LENGTH),
    (r"distance|.*(velocity|(_|^)v)", SPEED),
]

# The laboratory: natural frequency, mass, length; and k_B. Second derivatives along a curve have no
# unit of SI: arclength is counted in canonical units.
HERTZ, MASS, METRE, BOLTZMANN = 0.7, 3.0, 0.4, 1.380649e-23
LABORATORY = f"&units natural_frequency = {HERTZ}, mass = {MASS}, length = {METRE} /"
WITHOUT_SI = r".*curvature(_error)?"

DUFFING = """&pendulum force = 'polynomial', force_coefficients = <1|0,-2>, 0, <1|-2,-2>"""
SPRING = """&pendulum force = 'polynomial', force_coefficients = <1|0,-2>, damping = <0.2|0,-1>"""
ENSEMBLE = "&ensemble members = 8, x_first = <-1|1,0>, x_last = <1.5|1,0> /"

# Name, deck, dimension of the parameter that moves.
DECKS = [
    ("free", DUFFING + """, torque = <0.1|1,-2> /
      &scene kind = 'free_oscillation' / &sweep amplitude = <0.1|1,0>, <0.7|1,0>, <2|1,0> /""", PURE),
    ("orbit", DUFFING + """, damping = <0.1|0,-1>, drive_amplitude = <0.3|1,-2>,
      drive_frequency = <1.5|0,-1> /
      &scene kind = 'orbit' / &orbit x = <0.2|1,0>, v = <0.1|1,-1>, periods = 2 /""", PURE),
    ("record", DUFFING + """, damping = <0.1|0,-1>, drive_amplitude = <30|1,-2>,
      drive_frequency = <1.5|0,-1> /
      &scene kind = 'orbit' / &orbit x = <0.2|1,0>, v = <0.1|1,-1>, periods = 300, samples = 32,
      transient = .true., spectrum = .true., dimension = .true. /""", PURE),
    ("basins", DUFFING + """, damping = <0.1|0,-1>, drive_amplitude = <0.3|1,-2>,
      drive_frequency = <1.5|0,-1> /
      &scene kind = 'basins' /
      &sweep x = <-1|1,0>, <-0.5|1,0>, <0|1,0>, <0.5|1,0>, <1|1,0>,
      v = <-1|1,-1>, <-0.75|1,-1>, <-0.5|1,-1>, <-0.25|1,-1>, <0|1,-1>, <0.25|1,-1>, <0.5|1,-1>,
      <0.75|1,-1>, <1|1,-1> /
      &basins boundary = .true., statistics = .true. /""", PURE),
    ("clouds", DUFFING + """, damping = <0.25|0,-1>, drive_amplitude = <0.3|1,-2>,
      drive_frequency = <1.5|0,-1> /
      &scene kind = 'basins' /
      &sweep x = <-1|1,0>, <1|1,0>, v = <-1|1,-1>, <0|1,-1>, temperature = 0, <0.001|2,-2> /
      &basins strobes = 100, trajectories = 50 /""", PURE),
    ("response", DUFFING + """, drive_amplitude = <0.3|1,-2> /
      &scene kind = 'response' /
      &sweep damping = <0.2|0,-1>, <0.5|0,-1>, drive_frequency = <1|0,-1>, <1.25|0,-1>, <1.5|0,-1>,
      resonance_range = <1|0,-1>, <2|0,-1> /""" + ENSEMBLE, PURE),
    ("noisy", DUFFING + """, drive_amplitude = <0.3|1,-2> /
      &scene kind = 'response' /
      &sweep damping = <0.5|0,-1>, drive_frequency = <1|0,-1>, <1.5|0,-1>,
      temperature = 0, <0.001|2,-2> /
      &noise trajectories = 16, periods = 5 /""" + ENSEMBLE, PURE),
    ("curve", DUFFING + """, drive_amplitude = <0.3|1,-2> /
      &scene kind = 'resonance_curve' /
      &sweep damping = <0.25|0,-1>, <0.5|0,-1> / &ensemble members = 8 /""", PURE),
    ("branches", DUFFING + """, drive_amplitude = <0.3|1,-2> /
      &scene kind = 'branches' /
      &sweep damping = <0.125|0,-1>, <0.25|0,-1>, drive_frequency = <1|0,-1>, <1.5|0,-1>, <2|0,-1> /
      """ + ENSEMBLE, PURE),
    ("diagram", DUFFING + """, damping = <0.2|0,-1> /
      &scene kind = 'phase_diagram' /
      &sweep drive_amplitude = <0.2|1,-2>, <0.4|1,-2>, drive_frequency = <1.25|0,-1>, <1.5|0,-1> /
      """ + ENSEMBLE, PURE),
    ("hysteresis", DUFFING + """, damping = <0.1|0,-1>, drive_amplitude = <0.3|1,-2> /
      &scene kind = 'hysteresis' /
      &sweep drive_frequency = <1.25|0,-1>, <1.5|0,-1>, <1.75|0,-1>, <2|0,-1> /
      &hysteresis x = <0.2|1,0> /""", RATE),
    ("ramp", DUFFING + """, damping = <0.25|0,-1>, drive_frequency = <1.5|0,-1>,
      temperature = <0.0001|2,-2> /
      &scene kind = 'hysteresis' /
      &sweep drive_amplitude = <0.125|1,-2>, <0.5|1,-2>, <0.75|1,-2> /
      &hysteresis x = <0.2|1,0>, rate = <0.015625|1,-2> / &noise trajectories = 16 /""", FORCE),
    ("cascade", """&pendulum force = 'polynomial', force_coefficients = 0, 0, <1|-2,-2>,
      damping = <0.1|0,-1>, drive_frequency = <1|0,-1> /
      &scene kind = 'bifurcation_diagram' /
      &sweep drive_amplitude = <4.5|1,-2>, <4.75|1,-2>, <5|1,-2> /
      &bifurcation_diagram x = <2.5|1,0>, strobes = 10 /""", FORCE),
    ("map", DUFFING + """ /
      &scene kind = 'lyapunov_map' /
      &sweep damping = <0.125|0,-1>, <0.25|0,-1>, drive_frequency = <0.5|0,-1>, <1|0,-1>,
      drive_amplitude = <16|1,-2> / &lyapunov_map v = <0.5|1,-1> /""", PURE),
    ("stiffened", SPRING + """, drive_amplitude = <0.3|1,-2>, drive_frequency = <1.5|0,-1> /
      &scene kind = 'hysteresis' /
      &sweep a3 = <0.5|-2,-2>, <2|-2,-2>, <4|-2,-2>, <6|-2,-2> /
      &hysteresis x = <0.2|1,0> /""", (-2, -2)),
    ("springs", SPRING + """, drive_amplitude = <0.3|1,-2> /
      &scene kind = 'phase_diagram' /
      &sweep a3 = <0.5|-2,-2>, <2|-2,-2>, drive_frequency = <1.25|0,-1>, <1.5|0,-1> /
      """ + ENSEMBLE, PURE),
    ("plane", """&pendulum force = 'polynomial', damping = <0.2|0,-1>, drive_amplitude = <0.3|1,-2>,
      drive_frequency = <1.25|0,-1> /
      &scene kind = 'response' /
      &sweep a1 = <0.5|0,-2>, <1|0,-2>, a3 = <0.5|-2,-2>, <2|-2,-2> /""" + ENSEMBLE, PURE),
    ("switching", """&pendulum force = 'polynomial', force_coefficients = <-1|0,-2>, 0, <1|-2,-2>,
      damping = <0.3|0,-1>, drive_amplitude = <0.1|1,-2>, drive_frequency = <1.2|0,-1> /
      &scene kind = 'switching' /
      &sweep temperature = <0.03|2,-2>, <0.05|2,-2> / &switching from = 1, to = 2 /
      &noise trajectories = 100, periods = 20 /""", PURE),
]


def in_units(deck, unit):
    """The deck with its values in these units; doubles are written with all their digits."""
    def value(match):
        number, length, time = match.group(1), int(match.group(2)), int(match.group(3))
        return repr(float(number) * unit[0]**length * unit[1]**time)
    return re.sub(r"<([-0-9.]+)\|(-?\d+),(-?\d+)>", value, deck)


def dimension(name, moved):
    base = re.sub(r"_(error|lower|upper)$", "", name.split("/")[-1])
    if re.fullmatch(r"(jump|ramp|bifurcation|cascade).*_(parameter|delay|mean|deviation|limit)", base):
        return moved
    for pattern, dims in DIMENSIONS:
        if re.fullmatch(pattern, base):
            return dims
    return PURE


def results(program, folder, name, text):
    deck = os.path.join(folder, name + ".nml")
    with open(deck, "w") as f:
        f.write(text + "\n")
    out = os.path.join(folder, name + ".h5")
    done = subprocess.run([program, "--quiet", "--force", "-o", out, deck], capture_output=True,
                          text=True)
    if done.returncode not in (0, 3):
        return done.stderr or done.stdout
    found = {}

    def look(path, item):
        if isinstance(item, h5py.Dataset) and not path.startswith("provenance/"):
            found[path] = item[()]
    with h5py.File(out) as f:
        f.visititems(look)
    return found


def compare_si(name, path, moved):
    """What the file of a laboratory's deck says of the dimensions of its variables."""
    faults, second = [], 2 * numpy.pi * HERTZ

    def look(variable, item):
        if (not isinstance(item, h5py.Dataset) or item.dtype.kind != "f"
                or variable.startswith("provenance/") or re.fullmatch(WITHOUT_SI, variable)):
            return
        length, time = dimension(variable, moved)
        said = item.attrs.get("si_units", "")
        said = said.decode() if isinstance(said, bytes) else str(said)
        factor = item.attrs.get("si_factor", 1.0)
        want = METRE**length * second**-time
        if re.search("[NJW]", said):
            want *= MASS
        elif said == "K":
            want *= MASS / BOLTZMANN
        elif said == "Hz":
            want /= 2 * numpy.pi
        elif "Hz-1" in said:
            want *= 2 * numpy.pi
        if (said == "") != (length == 0 and time == 0) or abs(factor / want - 1) > 1e-12:
            faults.append(f"{name}: {variable} has si_factor {factor:.6g} {said}, where its dimension "
                          f"makes {want:.6g}")
    with h5py.File(path) as f:
        f.visititems(look)
    return faults


def compare(name, plain, other, unit, moved):
    faults = []
    for path in sorted(set(plain) | set(other)):
        if path not in plain or path not in other:
            faults.append(f"{path} is in one file alone")
            continue
        a, b = numpy.asarray(plain[path]), numpy.asarray(other[path])
        if a.shape != b.shape or a.dtype != b.dtype:
            faults.append(f"{path}: other shape or type, {a.shape} and {b.shape}")
            continue
        if a.dtype.kind != "f":
            if a.tolist() != b.tolist():
                faults.append(f"{path}: {a.ravel()[:6]} and {b.ravel()[:6]}")
            continue
        dims = dimension(path, moved)
        want = a * unit[0]**dims[0] * unit[1]**dims[1]
        wrong = numpy.flatnonzero(~((want == b) | (numpy.isnan(want) & numpy.isnan(b))).ravel())
        if len(wrong):
            w, g = want.ravel()[wrong[0]], b.ravel()[wrong[0]]
            faults.append(f"{path}: {len(wrong)} of {a.size} differ, {g!r} where {w!r} is wanted "
                          f"({g / w if w else g:.6g})")
    return [f"{name}, length {unit[0]:g}, time {unit[1]:g}: {fault}" for fault in faults]


def main():
    program, only = sys.argv[1], sys.argv[2:]
    failed = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, deck, moved in DECKS:
            if only and name not in only:
                continue
            plain = results(program, folder, name, in_units(deck, (1.0, 1.0)) + LABORATORY)
            if isinstance(plain, str):
                print(f"{name}: {plain}")
                failed = 1
                continue
            faults = compare_si(name, os.path.join(folder, name + ".h5"), moved)
            print("\n".join(faults), end="\n" if faults else "")
            failed |= bool(faults)
            for unit in UNITS:
                other = results(program, folder, name, in_units(deck, unit))
                faults = [f"{name}: {other}"] if isinstance(other, str) else \
                    compare(name, plain, other, unit, moved)
                for fault in faults:
                    print(fault)
                failed |= bool(faults)
    sys.exit(failed)


if __name__ == "__main__":
    main()
