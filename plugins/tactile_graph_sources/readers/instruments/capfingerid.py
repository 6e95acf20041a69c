"""CapFingerId recordings: ``participant;hand;finger;task;-1;sec,nsec,values`` a line."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from tactile_graph.wires import Frame
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.words.dialect import floats, refuse_underscore

SHAPE = (27, 15)
DEVICE = "the CapFingerId phone"
PITCH_CM = (0.41, 0.41)
"""Of the phone used: 27 x 15 sensors of 4.1 mm (Le, Mayer, Henze, 2019)."""
_LINE = re.compile(r"[^;,]*;[^;,]*;[^;,]*;[^;,]*;[^;,]*;\s*\d+,\d+,")


def recognises(head: Head) -> bool:
    """Return whether some of the first lines are such records."""
    return any(_LINE.match(line) for line in head.first(20))


def read(reading: Reading) -> Iterator[Frame]:
    """Yield a frame for each whole record, labelled with participant, hand, finger and task.

    Times count from the first record; the phone's own time stamp is kept as device time.
    """
    reading.refuse_settings()
    rows, columns = reading.told.rows or SHAPE[0], reading.told.columns or SHAPE[1]
    reading.told.agree(str(reading.path), rows, columns)
    reading.recognised("lines of participant;hand;finger;task;-1;sec,nsec,values")
    own = reading.published(PITCH_CM, DEVICE) if (rows, columns) == SHAPE else None
    reading.report.expect(reading.count_bytes(b"\n"))
    started: int | None = None
    for number, line in reading.text():
        if not line.strip():
            continue
        who, record, cells = _split(line)
        try:
            refuse_underscore(line.rpartition(";")[2])
            time_ns, values = _values(record, cells, rows * columns)
        except ValueError as error:
            reading.damaged(number, str(error))
            continue
        started = time_ns if started is None else started
        if reading.wants(who):
            yield reading.frame(
                values.reshape(rows, columns),
                pitch_cm=own,
                time_s=(time_ns - started) * 1e-9,
                device_time_s=time_ns * 1e-9,
                sensor=who,
            )


def _split(line: str) -> tuple[str, list[str], list[str]]:
    """Return the label, the time stamp and the cells of a line, as texts."""
    fields = line.split(";")
    texts = fields[-1].strip().removesuffix(",").split(",")
    who = " ".join(f.strip() for f in fields[:4]) if len(fields) == 6 else ""
    return who, texts[:2], texts[2:] if len(fields) == 6 else []


def _values(record: list[str], cells: list[str], n: int) -> tuple[int, np.ndarray[tuple[int]]]:
    if not (len(record) == 2 and all(t.isdecimal() and len(t) < 12 for t in record)):
        raise ValueError("no record: expected participant;hand;finger;task;-1;sec,nsec,values")
    if len(cells) != n:
        raise ValueError(f"{len(cells)} values, not {n}")
    return int(record[0]) * 10**9 + int(record[1]), np.array(floats(cells))


FORMAT = RecordingFormat("CapFingerId .txt", recognises, read)
