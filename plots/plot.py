#!/usr/bin/env python3
"""Draw the runs of `resonance` as figures.

    python3 plots/plot.py FILE.h5 ... [-o FOLDER] [-f png|pdf|svg] [--size W,H] [--dpi N]

Each file becomes one picture of the same name, a column of print wide, in a laboratory's units
where its deck has them. A file NAME_inset.h5 beside NAME.h5 is drawn into it as an inset. A file
that cannot be drawn is told on one line, and the others are drawn. Needs h5py and matplotlib
(Debian: python3-h5py python3-matplotlib).
"""
import argparse
import os
import re
import sys

BESIDE = os.path.join(os.path.dirname(os.path.dirname(os.path.realpath(__file__))), "python", "pendres")
try:
    import matplotlib

    matplotlib.use("Agg")
    if os.path.isdir(BESIDE):  # in the source tree, and where make install puts both
        sys.path.insert(0, BESIDE)
        from plots import drawn
    else:  # beside a wheel
        from pendres.plots import drawn
    from matplotlib import pyplot as plt
except ModuleNotFoundError as missing:
    sys.exit(f"plot.py: {sys.executable} has no {missing.name}. On Debian `make deps-plots` installs "
             "what pictures need for /usr/bin/python3; elsewhere `pip install h5py matplotlib`.")


def size(text):
    found = re.fullmatch(r"([0-9.]+)[x,]([0-9.]+)", text)
    if not found or not all(0 < float(side) < 200 for side in found.groups()):
        raise argparse.ArgumentTypeError(f"'{text}' is not WIDTH,HEIGHT in inches, such as 3.4,2.6")
    return tuple(float(side) for side in found.groups())


def hertz(text):
    found = re.fullmatch(r"([0-9.eE+-]+) *(m|k|M|G|T)?Hz", text)
    if not found or not float(found[1]) > 0:
        raise argparse.ArgumentTypeError(f"'{text}' is not a frequency such as 0.83Hz")
    return float(found[1]) * {None: 1.0, "m": 1e-3, "k": 1e3, "M": 1e6, "G": 1e9, "T": 1e12}[found[2]]


def parse():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("files", nargs="+", metavar="FILE.h5")
    parser.add_argument("-o", "--output", default=".", help="folder for the pictures")
    parser.add_argument("-f", "--format", default="png", choices=["png", "pdf", "svg"])
    parser.add_argument("--size", type=size, metavar="W,H",
                        help="size in inches (by default a column of print, 3.4 wide)")
    parser.add_argument("--dpi", type=float, default=300, help="dots an inch (default: 300)")
    parser.add_argument("--no-title", dest="title", action="store_false",
                        help="without the deck's title, as above a caption")
    parser.add_argument("--frequency", action="store_true",
                        help="drive frequencies where a run has drive periods")
    parser.add_argument("--unit", type=hertz, metavar="F0",
                        help="the natural frequency, such as 0.83Hz or 1.2MHz: frequencies are "
                             "drawn in Hz, kHz, MHz or GHz, periods in seconds")
    parser.add_argument("--no-boundary", dest="boundary", action="store_false",
                        help="leave out boundaries of basins and curves of bifurcations")
    parser.add_argument("--ensemble", action="store_true",
                        help="beside branches, the mean amplitude of the ensemble")
    parser.add_argument("--surface", action="store_true",
                        help="draw a phase diagram's loop area as a surface")
    return parser.parse_args()


def main():
    options = parse()
    plt.rcParams.update(drawn.SETTINGS)
    failed = 0
    os.makedirs(options.output, exist_ok=True)
    for path in options.files:
        try:
            figures = drawn.draw(path, options)
        except ValueError as why:
            print(f"{path}: {why}", file=sys.stderr)
            failed = 1
            continue
        name = os.path.splitext(os.path.basename(path))[0]
        for suffix, figure in figures:
            target = os.path.join(options.output, f"{name}{suffix}.{options.format}")
            figure.savefig(target, dpi=options.dpi)
            plt.close(figure)
            print(target)
    return failed


if __name__ == "__main__":
    sys.exit(main())
