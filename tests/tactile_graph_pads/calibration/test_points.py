"""Observations become points with error bars; what contradicts itself is refused."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.errors import DataError
from tactile_graph_pads.calibration.points import Observation, points_of


def group(load_g: float, *readings: float, source: str = "") -> Observation:
    return Observation(load_g, np.array(readings), source)


def test_a_group_is_averaged_before_its_scatter_is_taken() -> None:
    point, other = points_of([group(10, 0, 2), group(10, 1, 3), group(30, 4, 4)])
    assert (point.load_g, point.reading, point.placements, point.elements) == (10, 1.5, 2, 4)
    assert point.sd == pytest.approx(np.std([1, 2], ddof=1))
    assert point.sd_single == pytest.approx(np.std([0, 2, 1, 3], ddof=1))
    assert other.sd == 0.0


def test_points_come_by_rising_load_in_whatever_order_they_were_measured() -> None:
    seen = [group(g, g / 10.0) for g in (300, 20, 100)]
    assert [p.load_g for p in points_of(seen)] == [20, 100, 300]


def test_swapped_loads_are_found() -> None:
    seen = [group(100, 2.0, source="a.npz"), group(200, 1.0, source="b.npz"), group(400, 4.0)]
    said = r"loads in disorder: 200 g reads 1, less than the 2 of 100 g; were loads mixed up"
    with pytest.raises(DataError, match=said + r" \(a.npz and b.npz\)"):
        points_of(seen)


def test_scatter_within_repeatability_is_no_disorder() -> None:
    assert len(points_of([group(100, 1.0), group(110, 0.95), group(400, 2.0)])) == 3


def test_the_more_placements_the_less_is_put_down_to_chance() -> None:
    light, heavy = [group(100, 1.0)] * 30, [group(110, 0.9)] * 30
    with pytest.raises(DataError, match="loads in disorder"):
        points_of([*light, *heavy, group(400, 2.0)])


def test_a_reading_that_stands_still_is_saturated() -> None:
    seen = [group(g, r) for g, r in ((100, 1.0), (200, 1.9), (400, 2.0), (800, 2.01))]
    with pytest.raises(
        DataError, match=r"saturated: from 400 to 800 g an element the reading goes"
    ):
        points_of(seen)


def test_one_noisy_step_at_the_end_is_not_saturation() -> None:
    seen = [group(g, r) for g, r in ((100, 1.0), (200, 1.5), (400, 2.0), (420, 2.0))]
    assert len(points_of(seen)) == 4


@pytest.mark.parametrize("load_g", [0.0, -3.0, float("nan"), float("inf")])
def test_a_load_must_be_a_weight(load_g: float) -> None:
    with pytest.raises(DataError, match=r"x.npz: a load must be above 0 g, got"):
        points_of([group(load_g, 1.0, source="x.npz")])


def test_a_load_that_reads_nothing_is_refused() -> None:
    with pytest.raises(DataError, match="reads 0, which is nothing: is it on the pad"):
        points_of([group(50, 0.0), group(100, 1.0)])
