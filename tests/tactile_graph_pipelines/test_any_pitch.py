"""The same cells on pads of other pitches: the same shape, as many cells large."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tactile_graph import Frame, load

PIPELINES = [
    "objects", "bayes-objects", "rectangle-1", "rectangle-2", "rectangle-3", "ellipse-direct",
    "bayes-rectangle", "rectangle-straight",
]  # fmt: skip


def readings() -> np.ndarray:
    """Return a rectangle of 14 by 8 cells, turned by 0.5 rad, unevenly read by 32 by 32 cells."""
    at = (np.arange(32 * 9) + 0.5) / 9 - 16.0
    x, y = at[None], at[:, None]
    along, across = x * np.cos(0.5) - y * np.sin(0.5), x * np.sin(0.5) + y * np.cos(0.5)
    covered = ((abs(along) < 7.0) & (abs(across) < 4.0)).reshape(32, 9, 32, 9).mean((1, 3))
    rng = np.random.default_rng(0)
    gains = np.exp(rng.normal(0.0, 0.2, (32, 32)))
    return 100.0 * covered * gains + rng.normal(0.0, 0.3, (32, 32))


def found(name: str, pitch_cm: float) -> tuple[Any, dict[str, float]]:
    """Return what a pipeline decides, and its lengths in cells."""
    result = load(name).run(Frame.of(readings(), pitch_cm))
    got = result["shapes"][0] if "shapes" in result else result["rectangle"]
    shape = getattr(got, "shape", got)
    lengths = {
        key: getattr(shape, key) / pitch_cm
        for key in ("x_cm", "y_cm", "length_cm", "breadth_cm", "corrected_length_cm",
                    "corrected_breadth_cm")
        if hasattr(shape, key)
    }  # fmt: skip
    return getattr(got, "kind", getattr(shape, "ambiguous", None)), lengths


@pytest.mark.slow
@pytest.mark.parametrize("name", PIPELINES)
def test_shape_and_size_in_cells_are_the_same_at_any_pitch(name: str) -> None:
    decided, lengths = found(name, 1.3)
    assert decided in ("rectangle", False)
    assert lengths["length_cm"] > lengths["breadth_cm"] > 7.0
    for pitch_cm in (0.1, 5.0):
        again, its = found(name, pitch_cm)
        assert again == decided
        assert its == pytest.approx(lengths, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("name", PIPELINES[2:])
def test_cells_that_are_not_square_give_the_same_sides_either_way(name: str) -> None:
    run = load(name).run
    sides = []
    for values, pitch_cm in ((readings(), (1.0, 1.7)), (readings().T, (1.7, 1.0))):
        got = run(Frame.of(values, pitch_cm))["rectangle"]
        sides.append((got.length_cm, got.breadth_cm))
    assert sides[1] == pytest.approx(sides[0], rel=1e-6)
