"""Cases for steps that take a mask."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Mask
from tactile_graph_stress import scenes
from tactile_graph_stress.case import Case
from tactile_graph_stress.cases.stress_cases import StressCases
from tactile_graph_stress.similarity import Similarity
from tactile_graph_stress.subject import Subject

Cells = NDArray[np.bool_]

PITCHES = (1e-9, 1e9, 1e-3, 1e6, 1e-150, 1e150)
OFFSETS = (1e8, 1e2, 1e4, 1e6)


def mask_cases(subject: Subject, rng: np.random.Generator, quick: bool) -> Iterator[Case]:
    """Yield the cases, few of each group if ``quick``."""
    few = 2 if quick else 6
    cells = scenes.blob()
    base = Mask(cells, (1.3, 1.3))
    yield Case("truth", "as it is", base, base, Similarity())
    for pitch in PITCHES[:few]:
        law = Similarity(pitch)
        given = Mask(cells, (1.3 * pitch, 1.3 * pitch))
        yield Case("scale", f"pitch times {pitch:g}", given, base, law, _scaled(subject, pitch))
    for offset in OFFSETS[:few]:
        law = Similarity(1.0, 0.0, offset, -0.7 * offset)
        given = Mask(cells, (1.3, 1.3), (offset, -0.7 * offset))
        yield Case("offset", f"{offset:g} cm away", given, base, law)
    for quarters in (1, 2):
        yield _quarter(cells, quarters, base)
    for name, odd in _odd(rng):
        group = "empty" if name in ("no cell", "all cells", "all of 64 x 64") else "cells"
        yield Case(group, name, Mask(odd, (1.3, 1.3)))


def _scaled(subject: Subject, scale: float) -> dict[str, float]:
    return {k: v * scale for k, v in subject.lengths.items()}


def _quarter(cells: Cells, quarters: int, base: Mask) -> Case:
    """Return a case turned by quarter turns, which no rounding can hurt."""
    n = 1.3 * cells.shape[0]
    turn = Similarity(1.0, 0.5 * math.pi * quarters)
    # About the middle of the (square) pad, which stays where it is.
    x, y = (0.5 * n - turn.around(np.array([[0.5 * n, 0.5 * n]]))[0]).tolist()
    law = Similarity(1.0, turn.turn_rad, x, y)
    given = Mask(np.ascontiguousarray(np.rot90(cells, quarters)), (1.3, 1.3))
    return Case("turn", f"by {90 * quarters} deg", given, base, law)


def _odd(rng: np.random.Generator) -> Iterator[tuple[str, Cells]]:
    """Yield masks at the limits."""
    no, yes = np.zeros((16, 16), np.bool_), np.ones((16, 16), np.bool_)
    y, x = np.mgrid[0:16, 0:16]
    yield "no cell", no
    yield "all cells", yes
    yield "all of 64 x 64", np.ones((64, 64), np.bool_)
    yield "one cell", (x == 5) & (y == 9)
    yield "a corner", (x == 0) & (y == 15)
    yield "two cells", ((x == 5) | (x == 6)) & (y == 9)
    yield "two corners", (x == y) & ((x == 0) | (x == 15))
    yield "a row", y == 4
    yield "a column", x == 11
    yield "a diagonal", x == y
    yield "a slanting line", x == 2 * y
    yield "a ring", ((x - 8) ** 2 + (y - 8) ** 2 < 49) & ((x - 8) ** 2 + (y - 8) ** 2 > 25)
    yield "every other cell", (x + y) % 2 == 0
    yield "the rim", (x == 0) | (x == 15) | (y == 0) | (y == 15)
    yield "at random", rng.random((16, 16)) < 0.5
    yield "1 x 1, on", np.ones((1, 1), np.bool_)
    yield "1 x 1, off", np.zeros((1, 1), np.bool_)
    yield "1 x 40", rng.random((1, 40)) < 0.7
    yield "40 x 1", rng.random((40, 1)) < 0.7


MASKS = StressCases(lambda subject: subject.feed == "mask", mask_cases)
