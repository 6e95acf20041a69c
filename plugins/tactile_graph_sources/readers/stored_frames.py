"""Zarr stores of ours, which ``record`` and ``convert`` write, as recordings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from tactile_graph.wires import Frame
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.store import read_store
from tactile_graph_sources.stores.layout import JOURNAL, METADATA, is_store


def read(reading: Reading) -> Iterator[Frame]:
    """Yield the frames of a store as far as it is whole; raises what `read_store` raises."""
    reading.recognised(f"by the files in it, {METADATA} or {JOURNAL}")
    yield from as_told(reading, read_store(reading.path, reading.report))


def as_told(reading: Reading, frames: Iterable[Frame]) -> Iterator[Frame]:
    """Yield frames of a store as the settings tell of them; those of other sensors are left out.

    Raises
    ------
    DataError
        If shape, pitch, origin or quantity cannot be true, or are not what the settings say.
    """
    reading.is_own = True
    for stored in frames:
        image = stored.image
        if not reading.wants(stored.label):
            continue
        reading.told.agree(str(reading.path), image.rows, image.columns)
        frame = reading.frame(
            image.values,
            pitch_cm=image.pitch_cm,
            origin_cm=image.origin_cm,
            quantity=image.quantity,
            time_s=stored.time_s,
            sensor=stored.label,
            valid=image.valid,
            truth=stored.truth,
            device_time_s=stored.device_time_s,
            gap=stored.gap,
        )
        yield replace(frame, doubtful=True) if stored.doubtful else frame


STORE = RecordingFormat(
    "Zarr store of ours", lambda head: is_store(head.path), read, of_folders=True
)
