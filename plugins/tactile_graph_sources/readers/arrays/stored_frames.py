"""Zarr stores of ours, which ``record`` and ``convert`` write, as recordings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

from tactile_graph.steps.ranges import Irregular
from tactile_graph.wires import Frame
from tactile_graph.wires.frame_stack import MOST_FRAMES, FrameStack
from tactile_graph_sources.readers.laid import Laid
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.store import frames_of
from tactile_graph_sources.stores.layout import JOURNAL, METADATA, is_store
from tactile_graph_sources.stores.stored import Lost, Stored, open_stored

BY_FILES = f"by the files in it, {METADATA} or {JOURNAL}"


def read(reading: Reading) -> Iterator[Any]:
    """Yield the frames of a store as far as it is whole; raises what `read_store` raises."""
    reading.pass_settings()
    reading.recognised(BY_FILES)
    stored = open_stored(reading.path)
    frames = frames_of(stored, reading.path, reading.report, in_stacks=reading.in_stacks)
    yield from as_told(reading, frames, stored.pitch_told)


def as_told(
    reading: Reading, frames: Iterable[Frame | FrameStack], pitch_told: bool
) -> Iterator[Any]:
    """Yield frames of a store as the settings tell of them; those of other sensors are left out.

    Parameters
    ----------
    reading : Reading
    frames : iterable of Frame or FrameStack
    pitch_told : bool
        Whether anybody said the pitch that they have.

    Raises
    ------
    DataError
        If shape, pitch, origin or quantity cannot be true, or are not what the settings say.
    """
    reading.is_own = True
    due = reading.place
    for stored in _joined(frames):
        first = int(stored.index[0]) if isinstance(stored, FrameStack) else stored.index
        if not reading.told.sensor:  # or it is not known whose the lost ones were
            reading.place += max(first - due, 0)
        due = first + (len(stored) if isinstance(stored, FrameStack) else 1)
        if isinstance(stored, FrameStack):
            yield from _stack_as_told(reading, stored, pitch_told)
            continue
        image = stored.image
        if not reading.wants(stored.label):
            continue
        reading.told.agree(str(reading.path), image.rows, image.columns)
        frame = reading.frame(
            image.values,
            pitch_cm=image.pitch_cm if pitch_told else None,
            origin_cm=image.origin_cm,
            quantity=image.quantity,
            time_s=stored.time_s,
            sensor=stored.label,
            valid=image.valid,
            truth=stored.truth,
            device_time_s=stored.device_time_s,
            gap=stored.gap,
            own_number=stored.own_number,
        )
        frame = reading.of_state(frame, stored.state_of)
        yield replace(frame, doubtful=True) if stored.doubtful else frame


def _joined(frames: Iterable[Frame | FrameStack]) -> Iterator[Frame | FrameStack]:
    """Yield short stacks, as chunks may be, as longer ones; all are on one grid."""
    held: list[FrameStack] = []
    try:
        for some in frames:
            if held and not _goes_with(some, held):
                yield FrameStack.joined(held)
                held = []
            if isinstance(some, FrameStack):
                held.append(some)
            else:
                yield some
    except Exception:
        yield from [FrameStack.joined(held)] if held else []
        raise
    yield from [FrameStack.joined(held)] if held else []


def _goes_with(some: Frame | FrameStack, held: Sequence[FrameStack]) -> bool:
    if isinstance(some, Frame) or (some.time_s is None) != (held[0].time_s is None):
        return False
    return sum(map(len, held)) + len(some) <= MOST_FRAMES


def _stack_as_told(
    reading: Reading, stored: FrameStack, pitch_told: bool
) -> Iterator[Frame | FrameStack]:
    images = stored.images
    _, rows, columns = images.shape
    if not reading.wants(""):
        return
    reading.told.agree(str(reading.path), rows, columns)
    yield from reading.frames(
        images.values,
        stored.time_s,
        pitch_cm=images.pitch_cm if pitch_told else None,
        origin_cm=images.origin_cm,
        quantity=images.quantity,
    )


def laid(reading: Reading) -> Laid | None:
    """Return how the chunks of a store are read in any order; None where something is damaged."""
    stored = open_stored(reading.path)
    if reading.told.sensor or stored.troubles or not stored.sure:
        return None
    reading.recognised(BY_FILES)

    def frames(reading: Reading, low: int, high: int) -> Iterator[Frame | FrameStack]:
        yield from as_told(
            reading, _pieces(stored, low, high, reading.in_stacks), stored.pitch_told
        )

    return Laid(stored.n_frames, frames, together=stored.chunk)


def _pieces(stored: Stored, low: int, high: int, in_stacks: bool) -> Iterator[Frame | FrameStack]:
    for piece in stored.pieces:
        if piece.high <= low or piece.low >= high:
            continue
        try:
            read = stored.given if in_stacks else stored.frames
            yield from read(piece, low, high)
        except Lost as why:
            raise Irregular(f"{stored.path}: {piece.words}: lost: {why}") from why


STORE = RecordingFormat(
    "Zarr store of ours", lambda head: is_store(head.path), read, of_folders=True, laid=laid
)
