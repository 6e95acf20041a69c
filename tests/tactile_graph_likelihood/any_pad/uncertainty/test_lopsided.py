"""What an outline misses to a side: other shapes than discs, ellipses and rectangles."""

import math

import numpy as np
import pytest

from helpers_modes import plainly
from tactile_graph.wires import Image
from tactile_graph_likelihood.any_pad.locate import LocateDisc, LocateRectangle
from tactile_graph_likelihood.any_pad.uncertainty.lopsided import lopsided
from tactile_graph_likelihood.any_pad.uncertainty.posterior import LOPSIDED
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, RECTANGLE
from tactile_graph_likelihood.single.density.element_terms import ON, UNDER, UNKNOWN

GRID = np.array([0.0, 0.0, 1.3, 1.0, 0.0, 0.0])
MIDDLE = 0.5 + 1.3 * np.arange(16)
X, Y = MIDDLE - 10.0, MIDDLE[:, None] - 10.0
FAR = np.hypot(X, Y)
BOX = (np.abs(X) < 6.0) & (np.abs(Y) < 6.0)
DISC_OF_5 = np.array([10.0, 10.0, 5.0])
SQUARE = np.array([10.0, 10.0, 6.0, 6.0, 0.0])


def states_of(shown: np.ndarray) -> np.ndarray:
    return np.where(shown, np.uint8(ON), np.uint8(UNDER))


def found(kind: int, p: np.ndarray, shown: np.ndarray) -> float:
    return plainly(lopsided)(kind, p, GRID, states_of(shown))


SHAPES = {
    "T": BOX & ((Y < -2.5) | (np.abs(X) < 2.0)),
    "L": BOX & ((X < -2.5) | (Y > 2.5)),
    "half ring": BOX & (Y < 0.0) | BOX & (np.abs(X) > 4.0),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_other_shapes_leave_corners_of_their_box_empty(shape: str) -> None:
    assert found(RECTANGLE, SQUARE, SHAPES[shape]) > LOPSIDED
    turned = np.array([10.0, 10.0, 6.0, 6.0, math.pi / 2.0])
    assert found(RECTANGLE, turned, SHAPES[shape]) == pytest.approx(
        found(RECTANGLE, SQUARE, SHAPES[shape])
    )


def test_corners_beyond_count_with_voids_inside() -> None:
    triangle = (Y < 4.2) & (np.abs(X) < (Y + 8.4) / math.sqrt(3.0))
    disc = np.array([10.0, 10.0, 5.4])
    with_corners = found(DISC, disc, triangle)
    assert with_corners > LOPSIDED
    assert with_corners > found(DISC, disc, triangle & (FAR < 5.4)) + 0.5


U, V = X * math.cos(0.3) - Y * math.sin(0.3), X * math.sin(0.3) + Y * math.cos(0.3)


@pytest.mark.parametrize(
    ("kind", "p", "inside"),
    [
        (DISC, DISC_OF_5, FAR < 5.0),
        (ELLIPSE, np.array([10.0, 10.0, 6.0, 4.0, 0.3]), np.hypot(U / 6.0, V / 4.0) < 1.0),
        (RECTANGLE, np.array([10.0, 10.0, 6.0, 4.0, 0.3]), (np.abs(U) < 6.0) & (np.abs(V) < 4.0)),
    ],
)
def test_voids_anywhere_are_to_no_side(kind: int, p: np.ndarray, inside: np.ndarray) -> None:
    rng = np.random.default_rng(1)
    for _ in range(40):
        assert found(kind, p, inside & (rng.random((16, 16)) > 0.3)) < LOPSIDED


def test_nor_are_hollows_and_dead_lines() -> None:
    disc = np.array([10.0, 10.0, 7.0])
    assert found(DISC, disc, (FAR < 7.0) & (FAR > 3.5)) < LOPSIDED
    column = BOX.copy()
    column[:, 4] = False
    assert found(RECTANGLE, SQUARE, column) == 0.0, "nothing else is missed"


@pytest.mark.parametrize("size", [2, 3])
def test_nor_is_a_block_of_dead_elements(size: int) -> None:
    for row in range(3, 13 - size):
        for column in range(3, 13 - size):
            shown = FAR < 5.0
            shown[row : row + size, column : column + size] = False
            assert found(DISC, DISC_OF_5, shown) < LOPSIDED


def test_few_elements_and_unknown_ones_say_nothing() -> None:
    small = np.array([10.0, 10.0, 1.5])
    assert found(DISC, small, (FAR < 1.5) & (X < 0.0)) == 0.0
    shown = SHAPES["L"]
    states = np.where(BOX & ~shown, np.uint8(UNKNOWN), states_of(shown))
    assert plainly(lopsided)(RECTANGLE, SQUARE, GRID, states) == 0.0


def grams_of(shown: np.ndarray, seed: int = 2) -> Image:
    rng = np.random.default_rng(seed)
    loads = 40.0 * np.exp(0.4 * rng.standard_normal(shown.shape))
    loads[rng.random(shown.shape) < 0.1] = 0.0
    return Image(np.where(shown, loads, 0.0), (1.3, 1.3), (0.0, 0.0), "gram")


@pytest.mark.usefixtures("plain_kernels")
@pytest.mark.slow
def test_a_t_does_not_fit_and_a_rectangle_and_a_disc_do() -> None:
    assert not LocateRectangle()(grams_of(SHAPES["T"])).fits
    assert LocateRectangle()(grams_of(BOX)).fits
    assert LocateDisc()(grams_of(FAR < 5.0)).fits
