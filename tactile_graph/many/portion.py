"""``Portion``: frames that one worker takes at a time, named by number or sent along."""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.engine.blocks.gathering import flat
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.frame_stack import FrameStack
from tactile_graph.wires.image import Image


@dataclass(frozen=True)
class Portion:
    """Frames from ``low`` up to, not with, ``high``, by their place in the source.

    Parameters
    ----------
    low, high : int
    sent : bytes, optional
        The frames themselves; None where the worker reads them.
    start : int
        Of the recording that they are of: state reaches back no further.
    without : frozenset of int
        Places of frames that are left out.
    n_before : int
        How many frames that come before it are sent along, ahead of its own.
    """

    low: int
    high: int
    sent: bytes | None = None
    start: int = 0
    without: frozenset[int] = frozenset()
    n_before: int = 0

    @property
    def n_frames(self) -> int:
        """How many frames there are, those that are left out too."""
        return self.high - self.low

    def first(self, n: int) -> Portion:
        """Return the first frames of it."""
        return replace(self, high=self.low + n)

    def given(self) -> list[Frame | FrameStack]:
        """Return the frames that were sent, in stacks where they came so; cut, one by one."""
        assert self.sent is not None  # or a worker would read them
        found = unpacked(self.sent)
        n = sum(len(f) if isinstance(f, FrameStack) else 1 for f in found)
        inside = any(self.low <= place < self.high for place in self.without)
        if self.n_before or inside or n != self.n_frames:
            return [*self.frames()[1]]
        return found

    def frames(self) -> tuple[list[Frame], list[Frame]]:
        """Return the frames that were sent: those before it, and its own that are not left out."""
        assert self.sent is not None  # or a worker would read them
        low = self.low - self.n_before
        every = list(enumerate(flat(unpacked(self.sent)), low))[: self.high - low]
        kept = [(place, frame) for place, frame in every if place not in self.without]
        before = [frame for place, frame in kept if place < self.low]
        return before, [frame for _, frame in kept[len(before) :]]

    def leaving_out(self, places: frozenset[int]) -> Portion:
        """Return it without some more frames."""
        return replace(self, without=self.without | places)


class _Stack(NamedTuple):
    """Frames of one kind, their values as one array: it is pickled in a tenth of the time."""

    values: NDArray[Any]
    image: Image
    rest: list[tuple[Any, ...]]


_REST = (
    "index", "time_s", "truth", "device_time_s", "gap", "label", "doubtful", "place", "own_number",
    "state_of",
)  # fmt: skip


def packed(frames: Sequence[Frame | FrameStack]) -> bytes:
    """Return frames as bytes."""
    parcels: list[FrameStack | _Stack | list[Frame]] = []
    alone: list[Frame] = []
    for given in frames:
        if isinstance(given, FrameStack):
            parcels += [_parcel(alone), given] if alone else [given]
            alone = []
        else:
            alone.append(given)
    return pickle.dumps([*parcels, _parcel(alone)] if alone else parcels, protocol=5)


def _parcel(frames: list[Frame]) -> _Stack | list[Frame]:
    first = frames[0].image
    if not all(_alike(f, first) for f in frames):
        return frames
    values = np.stack([f.image.values for f in frames])
    rest = [tuple(getattr(f, name) for name in _REST) for f in frames]
    return _Stack(values, first, rest)


def _alike(frame: Frame, first: Image) -> bool:
    image = frame.image
    return (
        type(image) is Image
        and frame.mask is None
        and image.valid is None
        and first.valid is None
        and image.values.flags.c_contiguous  # sums of others may be rounded otherwise
        and image.values.shape == first.values.shape
        and image.values.dtype == first.values.dtype
        and image.pitch_cm == first.pitch_cm
        and image.origin_cm == first.origin_cm
        and image.quantity == first.quantity
    )


def unpacked(data: bytes) -> list[Frame | FrameStack]:
    """Return the frames again, in stacks where they came so."""
    found: list[Frame | FrameStack] = []
    for held in pickle.loads(data):
        if isinstance(held, FrameStack):
            for array in (held.images.values, held.images.valid):
                if array is not None:
                    array.setflags(write=False)
            found.append(held)
        else:
            found += _frames(held) if isinstance(held, _Stack) else held
    return found


def _frames(held: _Stack) -> list[Frame]:
    image = held.image
    return [
        Frame(
            Image(values, image.pitch_cm, image.origin_cm, image.quantity),
            **dict(zip(_REST, rest, strict=True)),
        )
        for values, rest in zip(held.values, held.rest, strict=True)
    ]
