"""Scenes on pads of any size: the pad grows with the object, so a cell always bears alike."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tactile_graph import Frame, load

SIZES = (16, 32, 64, 128, 256)
RADIUS_CM, WEIGHT_G = 5.1, 2700.0
"""A disc on 16x16 elements; on n x n it is n/16 times as wide and (n/16)^2 as heavy."""


@dataclass(frozen=True)
class Scene:
    """One case: its frames, and the pad they come from."""

    name: str
    size: int
    pad: dict[str, Any]
    frames: tuple[Frame, ...]

    @property
    def case(self) -> str:
        return f"{self.name} {self.size}"


SCENES = ("empty", "clean", "noisy", "broken", "two objects", "saturated", "dead row")


def scene(name: str, size: int, frames: int, seed: int) -> Scene:
    """Return the frames of a scene on a pad of ``size`` by ``size`` elements."""
    rng = np.random.default_rng([seed, size, SCENES.index(name)])
    pad = pad_of(name, size, rng)
    settings = {"scene": {"objects": _objects(name, size)}, "pad": pad, "frames": frames}
    if name == "two objects":
        settings["scene"]["apart_cm"] = 1.3
    made = load("contacts").with_source("simulate", **settings).frames(seed)
    return Scene(name, size, pad, tuple(made))


def _objects(name: str, size: int) -> list[dict[str, Any]]:
    scale = size / 16
    disc = {
        "shape": "disc",
        "name": "disc",
        "weight_g": WEIGHT_G * scale**2 * (300.0 if name == "saturated" else 1.0),
        "radius_cm": RADIUS_CM * scale,
    }
    if name == "empty":
        return []
    if name == "two objects":
        small = {**disc, "radius_cm": 3.6 * scale, "weight_g": 1350.0 * scale**2}
        plate = {
            "shape": "rectangle",
            "name": "plate",
            "weight_g": 1500.0 * scale**2,
            "length_cm": 9.0 * scale,
            "breadth_cm": 4.5 * scale,
        }
        return [small, plate]
    return [disc]


def pad_of(name: str, size: int, rng: np.random.Generator) -> dict[str, Any]:
    """Return the thesis' pad in a size, as it is in a scene."""
    from tactile_graph.pipeline.document import read_document
    from tactile_graph.plugins.registry import installed

    path = installed().path("pads", "thesis")
    pad: dict[str, Any] = read_document(path.read_text(encoding="utf-8"), str(path)).data
    pad = {**pad, "geometry": {**pad["geometry"], "rows": size, "columns": size}}
    if name == "clean":
        del pad["unevenness"]
    if name == "dead row":
        pad["defects"] = {"dead_rows": [size // 2 - 1]}
    if name == "broken":
        dead: Sequence[Any] = rng.permutation(size * size)[: size * size // 20]
        pad["defects"] = {"dead_elements": [[int(i) // size, int(i) % size] for i in dead]}
    return pad
