"""Tables with one frame a line, a time or a frame number before the values or not."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.quantities import is_quantity
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.choice import SeveralSensorsError
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.tables import labview
from tactile_graph_sources.readers.tables.layout import Layout, of_sensor, refuse_other_unit
from tactile_graph_sources.readers.tables.sides import of_side
from tactile_graph_sources.readers.tables.table import OWN, is_blank, is_comment
from tactile_graph_sources.readers.text.stamps import Stamps
from tactile_graph_sources.readers.words.dialect import floats, is_row, refuse_underscore
from tactile_graph_sources.readers.words.own_number import number_text
from tactile_graph_sources.readers.words.told import Told


class _Lines(NamedTuple):
    """How a line becomes a frame; ``own`` is what a table of the project's own says of itself."""

    layout: Layout
    shape: tuple[int, int]
    pick: Callable[[list[str]], Sequence[str]]
    stamps: Stamps
    own: Told


def recognises(head: Head) -> bool:
    """Return whether the file is such a table."""
    return head.layout is not None and head.layout.kind in ("flat", "unclear")


def read(reading: Reading) -> Iterator[Frame]:
    """Yield a frame for each line that holds the right number of numbers.

    Raises
    ------
    DataError
        If rows and columns are needed and not told, or do not fit.
    """
    layout = reading.head.layout or Layout("unclear")
    if layout.sensors:
        raise SeveralSensorsError(str(reading.path), layout.trouble, layout.sensors)
    if layout.trouble:
        raise DataError(str(reading.path), layout.trouble)
    own = _own_word(reading.head, len(layout.cells))
    reading.is_own = own.rows is not None
    shape = _shape(reading, layout, own)
    lines = _Lines(layout, shape, _picker(layout.cells), Stamps(reading, layout), own)
    reading.recognised(layout.why, layout.assumed)
    reading.report.expect(reading.count_bytes(b"\n"))
    text = of_side(reading.text(), layout.side, str(reading.path))
    if labview.is_labview(reading.head.lines):
        text = labview.without_headers(text)
    for number, line in text:
        if is_blank(line) or is_comment(line):
            continue
        if number < layout.first_line:
            if is_row(line) and (n := len(layout.dialect.fields(line))) != layout.width:
                what = f"{n} values, not {layout.width}"
                # A few numbers say a shape or a range, as others write them before the frames.
                reading.damaged(number, what, n_frames=int(2 * n >= layout.width))
            continue
        frame = _frame(reading, lines, number, line) if of_sensor(layout, line) else None
        if frame is not None:
            yield frame


def _picker(cells: tuple[int, ...]) -> Callable[[list[str]], Sequence[str]]:
    """Return what takes a line's cells out of its fields: a slice where they stand together."""
    first, last = cells[0], cells[-1] + 1
    if cells == tuple(range(first, last)):
        return lambda fields: fields[first:last]
    return lambda fields: [fields[k] for k in cells]


def _own_word(head: Head, n_values: int) -> Told:
    """Return what a table of the project's own says of itself; of any other, nothing."""
    found = OWN.fullmatch(head.lines[0].strip()) if head.lines else None
    if found is None:
        return Told()
    rows, columns, quantity = int(found[1]), int(found[2]), found[7]
    try:
        x, y = (float(w or 1) for w in found.group(3, 4))
        left, top = (float(w or 0) for w in found.group(5, 6))
    except ValueError:
        return Told()
    true = rows * columns == n_values and is_quantity(quantity) and min(x, y) > 0
    if not true or not np.isfinite([x, y, left, top]).all():
        return Told()  # somebody changed the table, so its comment may be wrong in all
    return Told(rows, columns, (x, y) if found[3] else None, (left, top), quantity)


def _shape(reading: Reading, layout: Layout, own: Told) -> tuple[int, int]:
    shape = layout.shape
    if own.rows is not None and own.columns is not None:
        shape = own.rows, own.columns
    if shape is not None:
        reading.told.agree(str(reading.path), *shape)
        return shape
    raise DataError(str(reading.path), reading.told.misfit(len(layout.cells)))


def _frame(reading: Reading, lines: _Lines, number: int, line: str) -> Frame | None:
    """Return the frame of one line; None where it is damaged or was there before."""
    layout, shape, pick, stamps, own = lines
    try:
        fields = layout.dialect.texts(line, layout.width)
        refuse_other_unit(layout, reading.at(number), fields)
        texts = pick(fields)
        if "_" in line:
            refuse_underscore(" ".join(texts))
        cells = np.array(floats(texts))
        index, time_s = stamps.of(fields)
    except ValueError as error:
        # Words among the frames are what a device had to say, and no frame.
        reading.damaged(number, str(error), n_frames=int(is_row(line)))
        return None
    if index is not None and reading.is_repeat(number, index, f"frame {number_text(index)}"):
        return None
    said = layout.said
    return reading.frame(
        _matrix(reading.told, layout, cells, shape),
        pitch_cm=own.pitch_cm or said.pitch_cm,
        origin_cm=own.origin_cm,
        quantity=own.quantity or said.quantity,
        factor=1.0 if own.quantity else said.factor,
        time_s=time_s,
        own_number=index,
    )


def _matrix(
    told: Told, layout: Layout, cells: NDArray[Any], shape: tuple[int, int]
) -> NDArray[Any]:
    if not layout.places:
        return told.laid_out(cells, *shape)
    matrix = np.full(shape[0] * shape[1], np.nan)
    matrix[list(layout.places)] = cells
    return matrix.reshape(shape)


FORMAT = RecordingFormat("table, one frame a line", recognises, read, plain=True)
