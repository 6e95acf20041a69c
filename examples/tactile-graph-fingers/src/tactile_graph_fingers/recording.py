"""Recordings of fingers: ``FINGERS rows columns pitch_cm``, then grams, a frame a line."""

from collections.abc import Iterator

import numpy as np
from tactile_graph import Frame
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat


def recognises(head: Head) -> bool:
    """Return whether a file begins as recordings of fingers do."""
    return head.raw.startswith(b"FINGERS ")


def read(reading: Reading) -> Iterator[Frame]:
    """Yield a frame for each line."""
    lines = reading.text()
    rows, columns, pitch_cm = next(lines)[1].split()[1:4]
    pitch = (float(pitch_cm), float(pitch_cm))
    for number, line in lines:
        values = np.array(line.split(), dtype=np.float64)
        if values.size != int(rows) * int(columns):
            reading.damaged(number, f"{values.size} values are no {rows} x {columns} cells")
            continue
        cells = values.reshape(int(rows), int(columns))
        yield reading.frame(cells, pitch_cm=pitch, quantity="gram")


FINGERS = RecordingFormat("fingers' recording", recognises, read)
