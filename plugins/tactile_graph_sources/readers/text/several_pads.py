"""Tables with one cell a line in which cells of several pads lie over each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError, one_of
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.tables.layout import Layout
from tactile_graph_sources.readers.tables.sensors import MOST_SENSORS
from tactile_graph_sources.readers.words.dialect import unquoted

Numbers = NDArray[np.intp]
OFTEN = 0.5
"""Share of the frames in which cells come again if it is no damage."""


def refuse_several_pads(
    reading: Reading, layout: Layout, frame: Numbers, place: Numbers, lines: Numbers
) -> None:
    """Refuse cells that come again in most frames where a column left out tells them apart.

    Parameters
    ----------
    reading : Reading
    layout : Layout
    frame, place, lines : ndarray, shape (n,)
        Of each cell: which frame it is of, from 0, where it lies, and its line's number.

    Raises
    ------
    DataError
        If there is such a column, of words or small whole numbers.
    """
    if not layout.others:
        return
    key = frame * (place.max() + 1) + place
    _, which, n = np.unique(key, return_inverse=True, return_counts=True)
    again = n[which] > 1
    if len(np.unique(frame[again])) <= OFTEN * (frame.max() + 1):
        return
    wanted = dict(zip(lines[again].tolist(), which[again].tolist(), strict=True))
    fields = {
        number: layout.dialect.fields(line) for number, line in reading.text() if number in wanted
    }
    for column, name in layout.others:
        said = {k: unquoted(f[column]) if column < len(f) else "" for k, f in fields.items()}
        labels = sorted(set(said.values()))
        if not 1 < len(labels) <= MOST_SENSORS or not all(map(_is_label, labels)):
            continue
        if len({(wanted[k], label) for k, label in said.items()}) == len(said):
            raise DataError(
                str(reading.path),
                f"{len(said)} cells come again in the same frame, and its column {name!r} tells "
                f"them apart ({one_of(labels)}): are they of several sensors? Call that column "
                "sensor, and each of them can be read; or leave out the lines of the others",
            )


def _is_label(text: str) -> bool:
    """Return whether a text is a word or a whole number, as names of sensors are."""
    try:
        return float(text) % 1 == 0
    except ValueError:
        return True
