#!/usr/bin/env python3
"""What --dry-run predicts beside what runs take: dry_run_decks.py PROGRAM [DECKS [SEED [SECONDS]]].

Draws small decks of many kinds, with dampings over four decades, and compares processor times, which
do not depend on what else the machine does. Prints each deck's ratio of prediction to truth; exit code
1 where a prediction that is not called the least is beyond a factor of 3.5 either way, and by more
than a tenth of a second, or one that is called so is above the truth by half of it. Runs are ended
after SECONDS (default 20) of processor time; what they take is then not known, and no prediction is
too high, but those that are too low for SECONDS are too low. make check runs a few of them.
"""
import os
import random
import re
import resource
import subprocess
import sys
import tempfile

PROGRAM = os.path.abspath(sys.argv[1])
DECKS, SEED, SECONDS = ([int(a) for a in sys.argv[2:]] + [20, 1, 20][len(sys.argv) - 2:])
FACTOR = 3.5
LITTLE = 0.1  # seconds: a start of the program, twice or three times
UNITS = {"s": 1, "min": 60, "h": 3600, "days": 86400}


def deck(draw):
    """A kind, and the text of a deck."""
    damping = 10 ** draw.uniform(-4, -0.3)
    drive, omega = draw.uniform(0.05, 0.5), draw.uniform(0.5, 1.1)
    low = f"&sweep damping_range = {damping:.4g}, {2 * damping:.4g}, {draw.randint(2, 6)} /\n"
    fixed = f"&pendulum damping = {damping:.4g}, drive_amplitude = {drive:.4g}"
    at = f", drive_frequency = {omega:.4g} /\n"
    members = f"&ensemble members = {draw.randint(4, 40)} /\n"
    line = f"&sweep drive_frequency_range = {omega:.4g}, {omega + 0.1:.4g}, {draw.randint(3, 20)} /\n"
    grid = (f"&sweep x_range = -1.5, 4.7, {draw.randint(4, 60)}, "
            f"v_range = -2, 2, {draw.randint(4, 60)} /\n")
    return draw.choice([
        ("resonance_curve", f"&pendulum drive_amplitude = {drive:.4g} /\n{low}{members}"),
        ("response", f"&pendulum drive_amplitude = {drive:.4g}{at}{low}{members}"),
        ("hysteresis", f"{fixed} /\n{line}&hysteresis x = 1.6 /\n"),
        ("bifurcation_diagram", f"{fixed} /\n{line}&bifurcation_diagram x = 1.6 /\n"),
        ("lyapunov_map", f"&pendulum damping = {damping:.4g} /\n&sweep drive_amplitude = {drive}, 1, "
                         f"drive_frequency_range = {omega}, {omega + 0.1}, {draw.randint(2, 9)} /\n"),
        ("basins", f"{fixed}{at}{grid}"),
        ("orbit", f"{fixed}{at}&orbit x = 1.6 /\n"),
        ("switching", f"{fixed}{at}&sweep temperature = 0.02, 0.03 /\n&noise "
                      f"trajectories = {draw.randint(4, 64)}, periods = {draw.randint(10, 500)} /\n"),
    ])


def limit(seconds):
    """No more processor time than this."""
    return lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))


def spent():
    """Processor seconds of all programs that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main():
    """All decks; 1 if one is beyond what is promised."""
    draw, bad, ratios = random.Random(SEED), 0, []
    with tempfile.TemporaryDirectory() as work:
        for number in range(DECKS):
            kind, text = deck(draw)
            path = os.path.join(work, f"d{number}.nml")
            with open(path, "w", encoding="utf-8") as out:
                out.write(f"&scene kind = '{kind}' /\n{text}")
            told = subprocess.run([PROGRAM, "--dry-run", "-t", "1", path], cwd=work, text=True,
                                  capture_output=True, check=False)
            found = re.search(r"time +(about|at least) ([0-9.e+-]+) (\w+)", told.stdout)
            if not found:
                print(f"{number} {kind}: no prediction ({told.returncode}): {told.stderr.strip()}")
                run = subprocess.run([PROGRAM, "-q", "-t", "1", path], cwd=work, check=False,
                                     capture_output=True, preexec_fn=limit(SECONDS))
                bad += run.returncode != told.returncode # what a run fails at, it tells
                continue
            predicted, least = float(found[2]) * UNITS[found[3]], found[1] == "at least"
            before = spent()
            run = subprocess.run([PROGRAM, "-q", "-t", "1", path], cwd=work, capture_output=True,
                                 preexec_fn=limit(SECONDS), check=False)
            truth, ended = spent() - before, run.returncode in (0, 1, 3)
            ratio = predicted / truth
            low = not least and ratio < 1 / FACTOR
            high = ended and ratio > (1.5 if least else FACTOR)
            wrong = (low or high) and abs(predicted - truth) > LITTLE
            bad += wrong
            ratios.append(ratio if ended else None)
            print(f"{number} {kind}: {found[1]} {predicted:.3g} s, took "
                  f"{'' if ended else 'more than '}{truth:.3g} s: {ratio:.2g}"
                  f"{' WRONG' if wrong else ''}", flush=True)
            if wrong:
                print(text)
    known = sorted(r for r in ratios if r is not None)
    if known:
        print(f"{len(known)} ended: ratios {known[0]:.2g} to {known[-1]:.2g}, median "
              f"{known[len(known) // 2]:.2g}; {len(ratios) - len(known)} did not end; {bad} wrong")
    return bad > 0


sys.exit(main())
