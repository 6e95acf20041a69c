"""Known objects, readings and images for the classifiers' tests."""

from __future__ import annotations

from typing import Any

import numpy as np

from tactile_graph import Image, Mask
from tactile_graph_classifiers.database.instrument import Instrument
from tactile_graph_classifiers.database.rows import Lesson, Setting
from tactile_graph_classifiers.database.text import FORMAT, VERSION
from tactile_graph_classifiers.measuring.measurements import Measurements

PAIR = ("weight", "area_cm2")
SETTING = Setting(PAIR, "gram", "features")
MAT = Instrument(16, 16, 1.3, 1.3)


def reading(weight: float, area: float, quantity: str = "gram") -> Measurements:
    return Measurements(PAIR, np.array([weight, area], dtype=np.float64), quantity)


def lesson(name: str, *rows: tuple[float, ...], shape: str = "") -> Lesson:
    array = np.array(rows, dtype=np.float64)
    return Lesson(name, shape, array, [f"{name} {i}" for i in range(len(rows))])


def normal_rows(rng: np.random.Generator, mean, deviation, n: int = 25):
    return np.asarray(mean) + np.asarray(deviation) * rng.standard_normal((n, len(mean)))


def export_of(objects: dict[str, Any], features: tuple[str, ...] = PAIR, **more: Any) -> Any:
    listed = [
        {"name": name, "shape": "disc", "readings": np.asarray(rows, dtype=np.float64).tolist()}
        for name, rows in objects.items()
    ]
    return {"format": FORMAT, "version": VERSION, "quantity": "gram", "features": list(features),
            "objects": listed, **more}  # fmt: skip


def three_objects(seed: int = 0, n: int = 25) -> dict[str, Any]:
    rng = np.random.default_rng(seed)
    return {
        "light": normal_rows(rng, (500.0, 40.0), (10.0, 4.0), n),
        "heavy": normal_rows(rng, (2000.0, 40.0), (30.0, 4.0), n),
        "wide": normal_rows(rng, (2000.0, 150.0), (30.0, 9.0), n),
    }


def digital_disc(radius: float, size: int = 64) -> np.ndarray:
    at = np.arange(size) - size / 2 + 0.5
    return at[:, None] ** 2 + at[None, :] ** 2 <= radius**2


def image_and_mask(on, values=None, pitch=(1.0, 1.0), valid=None, quantity="gram"):
    on = np.array(on, dtype=bool)
    values = np.ones(on.shape) if values is None else np.array(values, dtype=np.float64)
    image = Image(values, pitch, (0.0, 0.0), quantity, valid)
    return image, Mask(on, pitch)
