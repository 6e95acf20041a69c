"""Recordings of a made-up pad of raw readings, empty and with round objects, and what it is."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Circle, Frame, TrueObject
from tactile_graph_sources.writers.write_npz import write_npz

Array = NDArray[np.float64]


@dataclass
class MadeUpPad:
    """Elements with offset, noise and gain; readings go with the load, objects are round and soft.

    ``lean_cells`` is how far what hovers beside an object draws its readings to the right, for an
    object of the largest height; ``stretch`` how much longer the pad seems along y.
    """

    rows: int = 14
    columns: int = 20
    pitch_cm: tuple[float, float] = (0.5, 0.8)
    noise: float = 2.0
    gain_sigma: float = 0.0
    turn_on: float = 0.0
    lean_cells: float = 0.0
    stretch: float = 0.0
    dead: tuple[tuple[int, int], ...] = ()
    dead_row: int | None = None
    stuck: tuple[tuple[int, int], ...] = ()
    seed: int = 0
    rng: np.random.Generator = field(init=False)
    offset: Array = field(init=False)
    gain: Array = field(init=False)

    def __post_init__(self) -> None:
        self.rng = np.random.default_rng(self.seed)
        shape = (self.rows, self.columns)
        self.offset = 100.0 + 10.0 * self.rng.uniform(-1.0, 1.0, shape)
        self.gain = np.exp(self.gain_sigma * self.rng.standard_normal(shape))

    def frame(self, objects: tuple[tuple[float, float, float], ...], index: int = 0) -> Frame:
        """Return what (x, y, height) in cells read as; the truth is where they lie."""
        row, column = np.mgrid[: self.rows, : self.columns].astype(float)
        load = np.zeros((self.rows, self.columns))
        for x, y, height in objects:
            behind = self.lean_cells * (height / 400.0)
            y_seen = y + self.stretch * (y - 0.5 * self.rows) / self.rows
            for at, part in ((x, 1.0), (x + 2.0, 0.3 * behind)):
                far = np.hypot(column - at, row - y_seen)
                load += part * height / (1.0 + np.exp(3.0 * (far - 2.4)))
        read = load * self.gain
        read[read < self.turn_on] = 0.0
        for at in self.dead:
            read[at] = 0.0
        if self.dead_row is not None:
            read[self.dead_row] = 0.0
        values = self.offset + read + self.noise * self.rng.standard_normal(read.shape)
        for at in self.stuck:
            values[at] = 900.0
        truth = tuple(
            TrueObject(
                Circle((x + 0.5) * self.pitch_cm[0], (y + 0.5) * self.pitch_cm[1], 1.2), height
            )
            for x, y, height in objects
        )
        return Frame.of(values, self.pitch_cm, quantity="raw", index=index, truth=truth)

    def empty(self, n: int = 60) -> Iterator[Frame]:
        """Yield frames of nothing."""
        for index in range(n):
            yield self.frame((), index)

    def objects(self, n: int = 150) -> Iterator[Frame]:
        """Yield frames of one object each, anywhere on the pad, of any height."""
        for index in range(n):
            x = self.rng.uniform(0.0, self.columns - 1.0)
            y = self.rng.uniform(0.0, self.rows - 1.0)
            yield self.frame(((x, y, self.rng.uniform(150.0, 400.0)),), index)

    def recorded(self, folder: Path, n_empty: int = 60, n_objects: int = 150) -> tuple[Path, Path]:
        """Write an empty recording and one of objects; return both."""
        paths = folder / "empty.npz", folder / "objects.npz"
        write_npz(paths[0], self.empty(n_empty))
        write_npz(paths[1], self.objects(n_objects))
        return paths


def untold(frames: Iterator[Frame]) -> Iterator[Frame]:
    """Yield frames without their truth."""
    for frame in frames:
        yield Frame(frame.image, frame.index)
