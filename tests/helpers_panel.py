"""Look-alikes of CapContact's archives: a capacitive image beside the mask of what touched."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter

from helpers_recordings import SHARED, Array, npz_bytes, shared
from tactile_graph.steps import Report
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.arrays.capcontact import PITCH_CM
from tactile_graph_sources.recording import recording

ROWS, COLUMNS, FINER = 41, 72, 8
COUNTS, NOISE, HOVERS = 560.0, 8.0, 0.3


class Camera(NamedTuple):
    """How the camera of the masks sees what lies on the panel.

    ``matrix`` and ``shift_cm`` map a place on the panel to one in the mask; a contact's area is
    seen ``exp(of_one + of_x x)`` times as large.
    """

    matrix: tuple[tuple[float, float], tuple[float, float]] = ((1.0, 0.0), (0.0, 1.0))
    shift_cm: tuple[float, float] = (0.0, 0.0)
    of_one: float = 0.0
    of_x: float = 0.0


class Tip(NamedTuple):
    """A fingertip's contact: an ellipse, seen turned by the angle counter-clockwise."""

    x_cm: float
    y_cm: float
    semi_major_cm: float
    semi_minor_cm: float
    angle_rad: float

    def mask(self) -> Array:
        """Return 1 where it lies on the fine grid and 0 elsewhere, shape (328, 576)."""
        row, column = np.mgrid[: ROWS * FINER, : COLUMNS * FINER] + 0.5
        x = column * PITCH_CM[0] / FINER - self.x_cm
        y = row * PITCH_CM[1] / FINER - self.y_cm
        u = x * np.cos(self.angle_rad) - y * np.sin(self.angle_rad)
        v = x * np.sin(self.angle_rad) + y * np.cos(self.angle_rad)
        inside = (u / self.semi_major_cm) ** 2 + (v / self.semi_minor_cm) ** 2 <= 1.0
        return np.asarray(inside, np.float64)

    def seen_by(self, camera: Camera) -> Tip:
        """Return it where and as large as the camera sees it."""
        x, y = np.array(camera.matrix) @ (self.x_cm, self.y_cm) + camera.shift_cm
        growth = np.exp(0.5 * (camera.of_one + camera.of_x * self.x_cm))
        major, minor = self.semi_major_cm * growth, self.semi_minor_cm * growth
        return Tip(float(x), float(y), major, minor, self.angle_rad)


def ftir_of(tips: Sequence[Tip]) -> Array:
    """Return the mask of what touched: 0 there, 255 elsewhere."""
    return np.asarray(255.0 * (1.0 - np.maximum.reduce([tip.mask() for tip in tips])))


def cap_of(tips: Sequence[Tip], rng: np.random.Generator) -> Array:
    """Return the panel's counts: contacts blurred, and the fingers that hover behind them."""
    image = rng.normal(0.0, NOISE, (ROWS, COLUMNS))
    for tip in tips:
        behind = tip._replace(y_cm=tip.y_cm + 1.2)
        for part, height, blur in ((tip, COUNTS, 1.2), (behind, HOVERS * COUNTS, 1.6)):
            cells = part.mask().reshape(ROWS, FINER, COLUMNS, FINER).mean(axis=(1, 3))
            image += height * gaussian_filter(cells, blur)
    return np.asarray(np.round(image), np.int16)


def tips_drawn(rng: np.random.Generator) -> list[Tip]:
    """Return one to three fingertips well apart."""
    places = rng.permutation([6.0, 17.0, 28.0])[: rng.integers(1, 4)]
    return [
        Tip(x + rng.uniform(-3.0, 3.0), rng.uniform(3.0, 16.0), rng.uniform(0.55, 0.75),
            rng.uniform(0.4, 0.55), rng.uniform(-1.5, 1.5))
        for x in places
    ]  # fmt: skip


def panel_frames(folder: Path, n: int = 18, camera: Camera | None = None) -> Iterator[Frame]:
    """Write archives of fingertips into a folder, and yield them as they are read."""
    camera, rng = camera or Camera(), np.random.default_rng(0)
    for k in range(n):
        tips = tips_drawn(rng)
        ftir = ftir_of([tip.seen_by(camera) for tip in tips])
        path = folder / f"tips-{k:04d}.npz"
        path.write_bytes(npz_bytes(cap=cap_of(tips, rng), ftir=ftir))
        yield from recording(path=path, report=Report())


def real_panel_frames(chosen: slice = slice(None)) -> Iterator[Frame]:
    """Yield the frames of real archives; the test is skipped where there are none."""
    shared("capcontact")
    for path in sorted((SHARED / "capcontact").glob("*.npz"))[chosen]:
        yield from recording(path=path, report=Report())
