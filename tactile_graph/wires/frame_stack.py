"""``FrameStack``: frames of one grid and quantity, their images in one array."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires.frame import Frame
from tactile_graph.wires.stacks import Column, ImageStack, Rows, Stack

MOST_FRAMES, MOST_BYTES = 512, 1 << 20
"""Of a stack: its arrays are to stay in the processor's cache."""


class FrameStack(Stack):
    """Frames alike in shape, grid, quantity and validity, as a source may give them at once.

    Parameters
    ----------
    images : ImageStack
    index : ndarray of int, shape (n,)
        Their numbers in the source.
    time_s : ndarray of float, shape (n,), optional
        When they were taken; None where the source keeps no time.
    frames : sequence of Frame, optional
        The frames themselves, where they are there already and may say more than that.
    place : ndarray of int, shape (n,), optional
        Which frames of their recording they are (`Frame.place`).
    """

    item = Frame

    def __init__(
        self,
        images: ImageStack,
        index: NDArray[np.int64],
        time_s: NDArray[np.float64] | None = None,
        frames: Sequence[Frame] | None = None,
        place: NDArray[np.int64] | None = None,
    ) -> None:
        self.images, self.index, self.time_s = images, index, time_s
        self.frames, self.place = frames, place

    @classmethod
    def of(cls, frames: Sequence[Frame]) -> FrameStack:
        """Return frames as a stack; all are alike (`alike`)."""
        index = np.array([f.index for f in frames])
        return cls(ImageStack.of([f.image for f in frames]), index, None, frames)

    def __len__(self) -> int:
        return len(self.images)

    def __getitem__(self, i: int) -> Frame:
        if self.frames is not None:
            return self.frames[i]
        time_s = None if self.time_s is None else float(self.time_s[i])
        place = None if self.place is None else int(self.place[i])
        return Frame(self.images[i], int(self.index[i]), time_s, place=place)

    def take(self, rows: Rows) -> FrameStack:
        """Return some of the frames."""
        time_s = None if self.time_s is None else self.time_s[rows]
        frames = None if self.frames is None else [self.frames[i] for i in rows.tolist()]
        place = None if self.place is None else self.place[rows]
        return FrameStack(self.images.take(rows), self.index[rows], time_s, frames, place)

    def field(self, name: str) -> Stack | None:
        """Return the images, or the frames' numbers."""
        return {"image": self.images, "index": Column(self.index)}.get(name)

    @classmethod
    def joined(cls, stacks: Sequence[FrameStack]) -> FrameStack:
        """Return stacks on one grid, of which the frames say no more than their times, as one."""
        first = stacks[0]
        if len(stacks) == 1:
            return first
        images = first.images
        values = np.concatenate([stack.images.values for stack in stacks])
        times_s = [stack.time_s for stack in stacks if stack.time_s is not None]
        places = [stack.place for stack in stacks if stack.place is not None]
        return cls(
            ImageStack(values, images.pitch_cm, images.origin_cm, images.quantity),
            np.concatenate([stack.index for stack in stacks]),
            np.concatenate(times_s) if times_s else None,
            place=np.concatenate(places) if len(places) == len(stacks) else None,
        )

    def numbered(self, first: int, n_places: int = 0) -> FrameStack:
        """Return the same frames, numbered from ``first`` on, behind so many more places."""
        index = np.arange(first, first + len(self))
        frames = self.frames
        if frames is not None:
            frames = [frame.numbered(i, n_places) for i, frame in enumerate(frames, first)]
        place = None if self.place is None else self.place + n_places
        return FrameStack(self.images, index, self.time_s, frames, place)

    @property
    def times_s(self) -> list[float | None]:
        """When each was taken."""
        if self.frames is not None:
            return [f.time_s for f in self.frames]
        return [None] * len(self) if self.time_s is None else [*self.time_s.tolist()]

    @property
    def says_more(self) -> NDArray[np.bool_]:
        """Of which frames more is known than image, number and time, shape (n,)."""
        if self.frames is None:
            return np.zeros(len(self), np.bool_)
        return np.array([_says_more(f) for f in self.frames], np.bool_)


def _says_more(frame: Frame) -> bool:
    told = frame.label or frame.gap or frame.doubtful
    return bool(told) or frame.truth is not None or frame.device_time_s is not None


def in_stacks(frames: Sequence[Frame]) -> Iterator[FrameStack]:
    """Yield frames as stacks of such as are alike and stand side by side."""
    start = 0
    keys = [_likeness(f) for f in frames]
    for i in range(1, len(frames) + 1):
        if i == len(frames) or keys[i] != keys[start]:
            yield FrameStack.of(frames[start:i])
            start = i


def _likeness(frame: Frame) -> tuple[Any, ...]:
    image = frame.image
    values = image.values
    grid = (values.shape, values.dtype, image.pitch_cm, image.origin_cm)
    return (*grid, image.quantity, image.valid is None)
