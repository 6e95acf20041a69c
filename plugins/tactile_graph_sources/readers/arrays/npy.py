"""NumPy ``.npy`` files: one matrix, or matrices along the first axis."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph_sources.readers.arrays.stack import stack_of
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.laid import Laid, laid_in
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat


def recognises(head: Head) -> bool:
    """Return whether the file starts as NumPy's arrays do."""
    return head.raw.startswith(b"\x93NUMPY")


def _words(error: Exception) -> str:
    text = str(error)
    if "mmap length" in text:
        return "the file is cut off: it holds less than its header says"
    if "Python objects" in text:
        return (
            "it holds Python objects, not numbers; save frames of one shape, in Python: "
            "numpy.save('out.npy', numpy.stack(frames))"
        )
    if "max_header_size" in text:
        n = text.partition("(")[2].partition(")")[0]
        return (
            f"its header has {n} letters, of which a matrix needs a hundred: it is damaged, or has "
            "very many fields; save the one with the cells alone"
        )
    if "must be positive" in text:
        return "it is damaged: its header says a shape that no array has"
    return text


def read(reading: Reading) -> Iterator[Any]:
    """Yield the matrices of the array, read from disk as they are asked for.

    Raises
    ------
    DataError
        If the array is damaged, holds objects, or has the wrong number of axes.
    """
    reading.refuse_settings()
    values = _stack(reading)
    reading.report.expect(len(values))
    yield from reading.frames(values)


def _stack(reading: Reading) -> NDArray[Any]:
    try:
        # Mapped, not read: a long recording never stands in memory as a whole; no pickle, ever.
        array = np.load(reading.path, mmap_mode="r", allow_pickle=False)
    except Exception as error:  # NumPy raises a dozen kinds over a damaged header
        raise DataError(str(reading.path), f"its array cannot be read: {_words(error)}") from error
    return stack_of(reading, array, "its array")


def laid(reading: Reading) -> Laid | None:
    """Return how matrices are read without those before them; raises as `read` does."""
    return laid_in(reading, np.asarray(_stack(reading)))


FORMAT = RecordingFormat("NumPy .npy", recognises, read, laid=laid)
