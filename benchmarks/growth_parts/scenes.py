"""Frames of any size to time steps on, and learned pads of that size."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Circle, Frame
from tactile_graph.testing import Case
from tactile_graph.testing.cases import PITCH_CM
from tactile_graph.wires import TrueObject
from tactile_graph_filters.contacts.contacts import contacts
from tactile_graph_pads.learned import Elements, write_elements
from tactile_graph_pads.learning.patch import N_PLACE, PatchKind
from tactile_graph_pads.learning.place import PlaceCorrection, write_place

Reals = NDArray[np.float64]
Disc = tuple[float, float, float]
"""Column, row and radius in cells."""

NOISE = 0.01
TOUCHED_FROM = 0.3
FIXED_RADIUS = 2.3
SPACING = 8
POINTS_A_CELL = 2.0

FED_TOO = ("found",)
"""Ports that are no growth to measure without, though nobody has to wire them."""


def grown(side: int) -> list[Disc]:
    """Return two objects that take the same share of every pad."""
    return [(0.38 * side, 0.39 * side, 0.25 * side), (0.78 * side, 0.70 * side, 0.14 * side)]


def one(side: int) -> list[Disc]:
    """Return the larger of these alone."""
    return grown(side)[:1]


def many(side: int) -> list[Disc]:
    """Return objects of the size of a small one on 16x16, one in each 8 by 8 cells."""
    rng = np.random.default_rng(side)
    middles = np.arange(SPACING / 2, side, SPACING)
    return [
        (x + rng.uniform(-1, 1), y + rng.uniform(-1, 1), FIXED_RADIUS)
        for y in middles
        for x in middles
    ]


SCENES = {"one": one, "grown": grown, "many": many}
ONE_OUTLINE = "likelihood"
"""Family whose steps find one outline, for the most part: it is no fault that two take longer."""


def scenes_of(family: str) -> list[str]:
    """Return the scenes that a family's steps are timed on."""
    return [name for name in SCENES if name != "one" or family == ONE_OUTLINE]


def case(scene: str, side: int) -> Case:
    """Return a frame of ``side`` by ``side`` cells of 1.3 cm, noise of 1 % under its objects."""
    discs = SCENES[scene](side)
    values = np.zeros((side, side))
    for disc in discs:
        _press(values, disc)
    rng = np.random.default_rng(1)
    values *= 1.0 + NOISE * rng.standard_normal(values.shape)
    xy = np.concatenate([_outline(disc) for disc in discs]) * PITCH_CM
    return Case(f"{scene} {side}", values, values > TOUCHED_FROM, xy)


def _press(values: Reals, disc: Disc) -> None:
    """Add a soft disc: 1 within, down to 0 over a cell at the rim."""
    column, row, radius = disc
    top, left = max(0, int(row - radius - 2)), max(0, int(column - radius - 2))
    part = values[top : int(row + radius + 3), left : int(column + radius + 3)]
    y, x = np.mgrid[: part.shape[0], : part.shape[1]] + 0.5
    part += np.clip(radius + 0.5 - np.hypot(x + left - column, y + top - row), 0.0, 1.0)


def _outline(disc: Disc) -> Reals:
    column, row, radius = disc
    n = round(2 * math.pi * radius * POINTS_A_CELL)
    t = np.arange(n) * (2 * math.pi / n)
    return np.column_stack([column + radius * np.cos(t), row + radius * np.sin(t)])


def given(scene: str, side: int) -> dict[str, Any]:
    """Return what makes the values of ports that take lists of anything, by the port's name."""

    def found(frame: Case) -> Any:
        return contacts(frame.image("gram"), frame.mask()).contacts

    def true(frame: Case) -> Frame:
        pitch = PITCH_CM[0]
        truth = [Circle(x * pitch, y * pitch, r * pitch) for x, y, r in SCENES[scene](side)]
        objects = tuple(TrueObject(circle, 100.0, "disc") for circle in truth)
        return Frame(frame.image("gram"), 0, 0.0, objects)

    return {"contacts": found, "found": found, "frame": true}


def settings_of(step: str, side: int, folder: Path) -> dict[str, Any]:
    """Return what a step cannot do without on a pad of that size; its defaults otherwise."""
    if step in ("correct_place", "correct_readings", "threshold_learned"):
        return {"pad": _learned_pad(side, folder)}
    return {
        "gain": {"rows": [1.0] * side},
        "hit_or_miss": {"hit": [[0, 1, 0], [1, 1, 1], [0, 1, 0]]},
        "simplify_polygon": {"corners": 4},
        "threshold": {"level": TOUCHED_FROM},
    }.get(step, {})


def _learned_pad(side: int, folder: Path) -> str:
    """Write a pad learned in volts, every element good and even; return the path of its file."""
    shape, kind = (side, side), PatchKind(3)
    n = N_PLACE + kind.size
    flat = PlaceCorrection(
        kind, shape, np.zeros(kind.size), 1.0, np.zeros((n, 2)), np.zeros((n, n)), np.ones(2)
    )
    write_place(folder / "place.npz", flat)
    good = np.full(shape, "good", dtype="U8")
    table = Elements(np.full(shape, 0.01), np.full(shape, 0.01), np.ones(shape), good)
    write_elements(folder / "table.csv", table)
    path = folder / "pad.yaml"
    path.write_text(
        f"learned: {{reading: volt, rows: {side}, columns: {side}, pitch_cm: "
        f"[{PITCH_CM[0]}, {PITCH_CM[1]}], origin_cm: [0, 0], elements: table.csv, "
        "noise: 0.01, touched_from: 0.1, gain_of: volt, place: place.npz}\n"
    )
    return str(path)
