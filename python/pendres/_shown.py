"""How results are shown: numbers with their errors, and objects as short tables."""
import html

import numpy as np

HIDDEN = {"unused", "spare"}
MOST = 12  # rows of a table
LONGEST = 110  # characters of what is within a record


def told(value, error):
    """A number with as many digits as its error leaves."""
    if not np.isfinite(value):
        return "–"
    if not np.isfinite(error) or error < 0:
        return f"{value:.3g} (error unknown)"
    if error == 0:
        return f"{value:.12g}"
    places = 1 - int(np.floor(np.log10(error)))
    if places > 12 and 0 < abs(value) < 1e-3:  # beyond what is written out
        digits = int(np.clip(places + np.floor(np.log10(abs(value))), 0, 12))
        return f"{value:.{digits}e} ± {error:.0e}"
    return f"{value:.{min(max(places, 0), 12)}f} ± {error:.0e}"


def word(kind, value):
    """A member of an enumeration in the words of files."""
    try:
        return kind(int(value)).name.lower()
    except ValueError:
        return str(int(value))


def fields(record, kinds=None):
    """(name, text) of a record's fields, each with its error; of records in it what is not 0.
    kinds: {name: enumeration} of those that are choices."""
    names = record.dtype.names
    for name in names:
        value, error = record[name], name + "_error"
        if name in HIDDEN or name.endswith("_error") and name[:-len("_error")] in names:
            continue
        if getattr(value, "dtype", None) is not None and value.dtype.names:
            inner = fields(value) if value.shape == () else ()
            text = ", ".join(f"{n} {t}" for n, t in inner if t.strip("[0. ]")) or f"{value.shape}"
            text = text if len(text) <= LONGEST else text[:LONGEST] + " ..."
        elif kinds and kinds.get(name):
            text = word(kinds[name], value)
        elif np.ndim(value):
            text = np.array2string(np.asarray(value), precision=6, threshold=6, edgeitems=2)
        elif error in names and not np.ndim(record[error]):
            text = told(value, record[error])
        else:
            text = f"{value:.12g}"
        yield name, " ".join(text.split())


class Shown:
    """An object that is shown as a sentence, `_sentence()`, and a table, `_rows()`: its first row
    names the columns."""

    def _sentence(self):
        raise NotImplementedError

    def _rows(self):
        return []

    def _cut(self):
        rows = [[str(cell) for cell in row] for row in self._rows()]
        more = len(rows) - 1 - MOST
        return rows[:MOST + 1], f"... and {more} more" if more > 0 else ""

    def __repr__(self):
        rows, more = self._cut()
        widths = [max(map(len, column)) for column in zip(*rows)]
        lines = ["  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip()
                 for row in rows]
        return "\n".join([self._sentence(), *lines, *([f"  {more}"] if more else [])])

    def _repr_html_(self):
        rows, more = self._cut()
        cells = [("th" if i == 0 else "td", row) for i, row in enumerate(rows)]
        table = "".join("<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in row)
                        + "</tr>" for tag, row in cells)
        return (f"<p>{html.escape(self._sentence())}</p>"
                + (f"<table>{table}</table>" if rows else "") + html.escape(more))
