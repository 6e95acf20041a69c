"""A stack gives, frame by frame, what it is made of."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from tactile_graph import Circle, Frame, Image, Mask, Polygon
from tactile_graph.testing.same import same
from tactile_graph.wires import Points
from tactile_graph.wires.frame_stack import FrameStack, in_stacks
from tactile_graph.wires.stacks import (
    Column,
    ImageStack,
    Listed,
    MaskStack,
    PointsStack,
    PolygonStack,
    RecordStack,
    Stack,
    field_of,
)

RNG = np.random.default_rng(3)


@dataclass(frozen=True)
class Reading:
    level: float
    n: int
    there: bool


def masks(n: int, rows: int, columns: int) -> list[Mask]:
    return [Mask(RNG.random((rows, columns)) < 0.4, (1.5, 2.0), (0.5, 0.0)) for _ in range(n)]


SAMPLES: list[tuple[type[Stack], list[Any]]] = [
    (ImageStack, [Image(RNG.random((3, 4)), (1.0, 2.0), (3.0, 4.0), "volt") for _ in range(5)]),
    (MaskStack, masks(5, 4, 9)),
    (MaskStack, masks(5, 3, 64)),
    (MaskStack, masks(5, 2, 65)),
    (MaskStack, masks(4, 0, 3)),
    (PointsStack, [Points(RNG.random((k, 2))) for k in (3, 0, 2, 5)]),
    (PolygonStack, [Polygon(RNG.random((k, 2))) for k in (3, 1, 4)]),
    (RecordStack, [Circle(1.0 * k, 2.0, 3.0) for k in range(4)]),
    (RecordStack, [Reading(0.5, 3, True), Reading(-0.0, 4, False)]),
    (Column, [1, 2, 5]),
    (Column, [0.5, float("inf")]),
    (Listed, ["a", None, (1, 2)]),
]


@pytest.mark.parametrize(("kind", "values"), SAMPLES)
def test_values_and_some_of_them_come_back(kind: type[Stack], values: list[Any]) -> None:
    stack = kind.of(values)
    rows = np.array([0, len(values) - 1])
    assert len(stack) == len(values)
    assert same([*stack], values)
    assert same([stack[i] for i in range(len(values))], values)
    assert same([*stack.take(rows)], [values[i] for i in rows])


@pytest.mark.parametrize("columns", [1, 8, 9, 33, 64])
def test_masks_are_the_same_by_their_cells_and_by_their_rows(columns: int) -> None:
    given = MaskStack.of(masks(6, 5, columns))
    assert given.words is not None
    grid = (given.pitch_cm, given.origin_cm)
    packed = MaskStack.packed(given.words.copy(), columns, *grid, given.counts.copy())
    assert [int(word) & 1 for word in given.words[:, 0]] == [int(m.values[0, 0]) for m in given]
    assert same([*packed.take(np.array([1, 3]))], [given[1], given[3]])
    assert same([*packed], [*given])
    assert MaskStack.of(masks(1, 2, 65)).words is None


def test_fields_are_columns_where_arrays_know_them() -> None:
    given = MaskStack.of(masks(6, 5, 7))
    for name in ("count", "fraction", "area_cm2"):
        column = field_of(given, (name,))
        assert isinstance(column, Column)
        assert same([*column], [getattr(m, name) for m in given])
    polygons = PolygonStack.of([Polygon(RNG.random((k, 2))) for k in (3, 4)])
    assert same([*field_of(polygons, ("points", "count"))], [3, 4])
    assert same([*field_of(polygons, ("area_cm2",))], [p.area_cm2 for p in polygons])


def test_frames_that_are_alike_make_a_stack_and_come_back() -> None:
    frames = [Frame.of(np.full((2, 3), k), index=k, time_s=0.5 * k) for k in range(4)]
    (stack,) = in_stacks(frames)
    assert [*stack] == frames
    assert stack.times_s == [0.0, 0.5, 1.0, 1.5]
    later = stack.numbered(7)
    assert [f.index for f in later] == [7, 8, 9, 10]
    bare = FrameStack(stack.images, np.arange(4), np.array([0.0, 0.5, 1.0, 1.5]))
    assert [(f.index, f.time_s) for f in bare.take(np.array([1, 2]))] == [(1, 0.5), (2, 1.0)]
