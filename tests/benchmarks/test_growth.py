"""Growth is fitted by its exponent, and a step that takes too long is ended and told."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from growth_parts import timing
from growth_parts.fit import exponent, large_end
from growth_parts.page import page, table
from growth_parts.scenes import SCENES, case
from growth_parts.timing import Bounds, Point, points_of


def points(power: float, noise: float = 0.0, fixed_s: float = 0.0) -> list[Point]:
    rng = np.random.default_rng(1)
    return [
        Point(
            "hull",
            "hull",
            "many",
            side,
            tuple(fixed_s + 1e-9 * side ** (2 * power) * np.exp(noise * rng.normal(size=7))),
        )
        for side in (16, 32, 64, 128, 256, 512)
    ]


def test_the_exponent_is_that_of_the_cells_and_its_interval_holds_it() -> None:
    for power in (0.5, 1.0, 2.0):
        found = exponent(points(power, noise=0.1))
        assert found is not None
        assert found.low < power < found.high
        assert found.high - found.low < 0.1
        assert found.faster == (power > 1.5)
    assert exponent(points(1.0)[:1]) is None


def test_a_fixed_cost_hides_growth_on_small_pads_and_not_at_the_large_end() -> None:
    of = points(1.5, fixed_s=1e-3)
    whole, end = exponent(of), large_end(of)
    assert whole is not None
    assert end is not None
    assert whole.value < 1.1 < 1.3 < end.value


def test_the_page_names_what_grows_faster_and_why_a_step_has_no_time() -> None:
    over = Point("restore", "mrf", "many", 64, told="over 2 s a call")
    told = page([*points(2.0), over], 2.0)
    assert "| `hull` | many 2.00 (2.00–2.00) | sorts its points: n log n |" in told
    assert "64: over 2 s a call" in table([over])


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("side", [16, 64])
def test_scenes_press_the_pad_within_its_rim(scene: str, side: int) -> None:
    frame = case(scene, side)
    assert frame.values.shape == frame.on.shape == (side, side)
    assert 0.1 < frame.on.mean() < 0.4
    assert 0.0 < frame.xy_cm.min() < frame.xy_cm.max() < side * 1.3


@pytest.mark.slow
def test_a_step_is_timed_and_one_that_takes_too_long_is_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found = list(points_of("threshold", "many", [16, 32], Bounds(2.0)))
    assert [(p.side, bool(p.rounds_s), p.told) for p in found] == [(16, True, ""), (32, True, "")]
    monkeypatch.setattr(timing, "FIRST_S", 0.2)
    (over,) = points_of("posterior", "grown", [128, 256], Bounds(0.1))
    assert (over.side, over.rounds_s) == (128, ())
    assert over.told == "over 0.2 s, compiling counted"
