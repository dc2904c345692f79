"""What all pictures share: colours, sizes, the file that is drawn, and the axes of frequency.

Colours are those of Okabe and Ito, which the colour-blind tell apart; SA and LA have one each in
every picture. tests/plots_colours.py measures how far apart they are.
"""
import re

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.transforms import ScaledTranslation

SA, LA = "#0072B2", "#D55E00"
COEXISTENCE, OTHER, SINGLE, UNRESOLVED = "#F0E442", "#009E73", "#D9D9D9", "#999999"
MORE = ["#009E73", "#F0E442", "#CC79A7", "#56B4E9", "#E69F00", "#332288", "#117733"]
ESCAPE = "#FFFFFF"
FREE, EXACT = "0.45", "black"
NAMED = ["SA", "LA", "periodic", "running", "chaotic", "unresolved", "escape",
         "quasi_periodic", "unstable"]

SETTINGS = {
    "figure.constrained_layout.use": True, "font.size": 9, "axes.titlesize": 9,
    "axes.formatter.useoffset": False, "axes.formatter.limits": (-4, 7),
    "legend.fontsize": 7.5, "lines.linewidth": 1.2, "savefig.bbox": None,
    "lines.solid_capstyle": "butt", "legend.handlelength": 1.6, "legend.borderpad": 0.3,
    "xtick.direction": "in", "ytick.direction": "in", "axes.labelpad": 2.5,
    "axes.prop_cycle": plt.cycler(color=[SA, LA, "#009E73", "#CC79A7", "#56B4E9", "#E69F00"]),
}


class Run:
    """The variables of a file as arrays, read when they are asked for."""

    def __init__(self, file, options):
        self.file, self.options = file, options

    def __contains__(self, name):
        return name in self.file

    def __getitem__(self, name):
        return self.file[name][()]

    def text(self, attribute):
        value = self.file.attrs.get(attribute, "")
        return value.decode() if isinstance(value, bytes) else str(value)

    def si(self, name):
        """What a variable is to be multiplied by to be in SI, and the unit; 1 and "" where the file
        does not tell."""
        attributes = self.file[name].attrs if name in self.file else {}
        units = attributes.get("si_units", b"")
        units = units.decode() if isinstance(units, bytes) else str(units)
        return (float(attributes["si_factor"]), units) if units else (1.0, "")

    def is_angle(self, name):
        """Whether a variable is one, as its units say."""
        units = self.file[name].attrs.get("units", "")
        return (units.decode() if isinstance(units, bytes) else str(units)) == "rad"

    def natural_frequency(self):
        """The unit of frequencies in Hz: of the command line, or of the file; None: there is
        none."""
        if self.options.unit is not None:
            return self.options.unit
        if "natural_frequency_hz" in self.file:
            return float(self["natural_frequency_hz"])
        for name in self.file:
            factor, units = self.si(name)
            if units == "Hz":
                return factor
            if units == "s":
                return 1 / (2 * np.pi * factor)
        return None

    def scale(self, name):
        """What a variable is multiplied by to be drawn, and the unit behind its label."""
        factor, units = self.si(name)
        label = re.sub(r"\^?(-?[0-9]+)", r"$^{\1}$", units)
        most = np.max(np.abs(self[name]), initial=0, where=np.isfinite(self[name])) * factor
        if units == "s-1" and most >= 1e6:  # below, ms^-1 could be taken for a velocity
            power, prefix = prefix_of(most, -1)
            return factor / power, prefix + label
        if not re.match("(Hz|[msNVAKJW])(?![-^0-9])", units):
            return factor, "" if units == "1" else label
        power, prefix = prefix_of(most) if most > 0 else (1.0, "")
        return factor / power, prefix + label

    def settings(self):
        """Keys that were set on the command line."""
        value = self.file["provenance/settings"][()] if "provenance/settings" in self.file else b""
        return value.decode()

    def axis_of(self, name, dimension):
        """The name of one of a variable's dimensions."""
        dimensions = self.file[name].dims
        return dimensions[dimension % len(dimensions)][0].name.rsplit("/", 1)[-1]


def strings(values):
    return [v.decode() if isinstance(v, bytes) else str(v) for v in np.atleast_1d(values)]


WIDTH, WIDE = 3.4, 7.0                  # inches: a column of print, and a page
NARROW = 4.5
SIZES = {False: (9, 7.5), True: (8, 7)}  # of text and of legends, in points


def page(run, width, height):
    """The size of a picture, by which texts get theirs."""
    size = run.options.size or (width, height)
    text, small = SIZES[size[0] < NARROW]
    plt.rcParams.update({"font.size": text, "axes.titlesize": small, "legend.fontsize": small})
    return size


def figure(run, height, rows=1, columns=1, width=WIDTH, **more):
    """Axes of a column's width and some height in inches, or of the size that the command line asks
    for."""
    size = page(run, width, height)
    fig, axes = plt.subplots(rows, columns, figsize=size, **more)
    if size[0] < NARROW:
        for ax in np.ravel(axes):
            ax.xaxis.set_major_locator(plt.MaxNLocator(6, steps=[1, 2, 2.5, 5, 10]))
    return fig, axes


def legend(ax, handles=None, under=None, **more):
    """A legend beside the curves, or where a picture is too narrow for both below the axes, or
    below those `under` them."""
    texts = [handle.get_label() for handle in handles or []]
    if handles is None:
        handles, texts = ax.get_legend_handles_labels()
    once = dict(zip(texts, zip(handles, texts)))  # each text once
    if not once:
        return
    if ax.figure.get_size_inches()[0] < NARROW:
        longest = max(len(re.sub(r"\\[a-z]+", "x", text).replace("$", "")) for text in once)
        under, points = under or ax, ScaledTranslation(0, -0.42, ax.figure.dpi_scale_trans)
        more.update(loc="upper center", bbox_to_anchor=(0.5, 0), borderaxespad=0, frameon=False,
                    bbox_transform=under.transAxes + points,
                    ncol=3 if longest <= 13 else 2 if longest <= 22 else 1)
        more["title_fontsize"] = plt.rcParams["legend.fontsize"]
        ax = under
    ax.legend(*zip(*once.values()), **more)


PREFIXES = {12: "T", 9: "G", 6: "M", 3: "k", 0: "", -3: "m", -6: "µ", -9: "n", -12: "p", -15: "f",
            -18: "a", -21: "z"}


def prefix_of(value, exponent=1):
    """The power of ten that a value in SI is divided by for a label, with the prefix of a unit that
    stands there with this exponent, 1 or -1."""
    ten = 3 * int(np.floor(np.log10(value) / 3 + 1e-9))
    ten = min(max(ten, min(PREFIXES)), max(PREFIXES))
    return 10.0 ** ten, PREFIXES[exponent * ten]


def drive_axis(run, values, name):
    """Values of an axis of drive frequencies or periods in the quantity and unit asked for."""
    unit, periods = run.natural_frequency(), name == "drive_period" and not run.options.frequency
    values = np.asarray(values, dtype=float)
    omega = values if name == "drive_frequency" else 2 * np.pi / values
    if unit is None:
        return (values, r"drive period $\tau$") if periods else (omega, r"drive frequency $\omega$")
    power, prefix = prefix_of(1 / unit if periods else unit)
    if not periods and 0.1 <= unit < 1:  # as of a pendulum: 0.8 Hz, and not 800 mHz
        power, prefix = 1.0, ""
    if periods:
        return 2 * np.pi / omega / (2 * np.pi * unit) / power, f"drive period ({prefix}s)"
    return omega * unit / power, f"drive frequency ({prefix}Hz)"


def frequency(run, omega):
    """Drive frequencies in the unit asked for, with a label."""
    return drive_axis(run, omega, "drive_frequency")


def words(name):
    """A label for an axis by its name in the file."""
    symbols = {"damping": r"damping $\gamma$", "drive_amplitude": "drive amplitude $F_0$",
               "torque": "torque $I$", "parametric_amplitude": "parametric amplitude $b$",
               "temperature": "temperature $T$"}
    coefficient = re.fullmatch("a([1-9])", name)
    if coefficient:
        return f"coefficient $a_{coefficient[1]}$"
    return symbols.get(name, name.replace("_", " "))


def parameter_axis(run, values, name):
    """Values and label of an axis of any parameter."""
    if name in ("drive_frequency", "drive_period"):
        return drive_axis(run, values, name)
    factor, unit = run.scale(name)
    label = "current $I$" if name == "torque" and unit.endswith("A") else words(name)
    return np.asarray(values, dtype=float) * factor, label + (f" ({unit})" if unit else "")


def parameter_text(run, value, name):
    """A parameter with one of its values, as legends have it."""
    shown, label = parameter_axis(run, value, name)
    symbol, _, unit = label.partition(" (")
    symbol = symbol.split()[-1] if "$" in symbol else symbol
    return f"{symbol} = {shown:.6g} {unit.rstrip(')')}".rstrip()


def amplitude_axis(run, name, label):
    """What amplitudes are multiplied by to be drawn, and the label of their axis."""
    factor, unit = run.scale(name)
    unit = unit or ("rad" if run.is_angle(name) else "")
    return factor, label + (f" ({unit})" if unit else "")


def around(values, share=0.06):
    """Limits that leave none of the values out, with a margin."""
    values = np.asarray(values, dtype=float)
    values = values[np.isfinite(values)]
    if len(values) == 0:
        return 0.0, 1.0
    low, high = values.min(), values.max()
    margin = share * (high - low) if high > low else 0.5 * abs(high) or 0.5
    return low - margin, high + margin


def free_frequency(amplitude):
    """Exact frequency of the free undamped pendulum, by the arithmetic-geometric mean."""
    a, b = np.ones_like(amplitude), np.cos(amplitude / 2)
    for _ in range(20):
        a, b = (a + b) / 2, np.sqrt(a * b)
    return a


def colours_of(numbers):
    """A colour for each of a row of values, from dark to light."""
    return plt.cm.viridis(np.linspace(0, 0.85, max(len(numbers), 1)))
