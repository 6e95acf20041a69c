"""What lines enclose: regions, which of them are objects, and voids within these."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from helpers_modes import compiled, held, plainly
from tactile_graph.errors import DataError
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.contours.line_regions import line_regions, with_voids
from tactile_graph_mrf.contours.regions import label_regions, standing
from tactile_graph_mrf.energy.line_field import LineField


def between(values: NDArray[np.float64], least: float = 0.0) -> LineField:
    """Lines wherever neighbouring values differ by more than ``least``."""
    across = np.abs(np.diff(values, axis=0)) > least
    down = np.abs(np.diff(values, axis=1)) > least
    return LineField.of(Image(values), across, down)


def picture(*rows: str) -> NDArray[np.float64]:
    return np.array([[float(c) for c in row] for row in rows])


def found(*rows: str, **settings: float) -> list[str]:
    values = picture(*rows)
    mask = line_regions(Image(values), between(values), **settings).mask  # type: ignore[arg-type]
    return ["".join("#" if on else "." for on in row) for row in mask.values]


def test_what_stands_above_its_surroundings_is_the_object() -> None:
    rows = ("111111", "155511", "155511", "111111")
    assert found(*rows) == ["......", ".###..", ".###..", "......"]


def test_what_lies_below_its_surroundings_is_none_whatever_its_level() -> None:
    # A wide hollow in a high floor; and the same object in volts or upside down.
    rows = ("999999", "955559", "955559", "955559", "999999")
    assert found(*rows, void_cells=4) == ["######", "#....#", "#....#", "#....#", "######"]


def test_a_missing_element_within_an_object_is_no_hole() -> None:
    rows = ("000000", "055550", "050050", "055550", "000000")
    assert found(*rows) == ["......", ".####.", ".####.", ".####.", "......"]
    assert found(*rows, void_cells=2)[2] == ".####."
    assert found(*rows, void_cells=1)[2] == ".#..#."


def test_a_missing_element_at_the_rim_of_the_pad_is_a_bay() -> None:
    assert found("55055", "55555", "00000") == ["##.##", "#####", "....."]


def test_a_spike_within_an_object_does_not_make_its_surroundings_background() -> None:
    rows = ("00000", "05550", "05950", "05550", "00000")
    assert found(*rows) == [".....", ".###.", ".###.", ".###.", "....."]


def test_a_terrace_belongs_to_the_object_if_it_stands_higher_above_the_ground_than_below() -> None:
    assert found("000000", "044550", "044550", "000000")[1] == ".####."
    assert found("000000", "011990", "011990", "000000")[1] == "...##."


def test_small_parts_and_faint_steps_are_no_objects() -> None:
    assert found("000000", "050000", "000550", "000550") == ["......", "......", "...##.", "...##."]
    faint = ("000000", "011000", "011000", "000990", "000990")
    assert found(*faint, least_step=0.2)[1:] == ["......", "......", "...##.", "...##."]
    assert found(*faint, least_step=0.0)[1:] == [".##...", ".##...", "...##.", "...##."]


def test_without_lines_there_is_no_object() -> None:
    values = picture("0005", "0055")
    regions = line_regions(Image(values), LineField.none(Image(values)))
    assert regions.count == 0
    assert regions.area_cm2 == 0.0
    assert regions.labels.max() == 1


def test_regions_serve_as_a_mask_in_its_place() -> None:
    values = picture("000", "550", "550")
    image = Image(values, (2.0, 1.5), (3.0, 4.0))
    regions = line_regions(image, between(values))
    assert regions.provides[Mask] == "mask"
    assert regions.area_cm2 == 4 * 3.0
    assert regions.mask.origin_cm == (3.0, 4.0)


def test_lines_of_another_grid_are_refused() -> None:
    with pytest.raises(DataError, match=r"must have the image's shape \(2, 2\), got \(3, 3\)"):
        line_regions(Image(np.zeros((2, 2))), LineField.none(Image(np.zeros((3, 3)))))


def regions_by_waves(
    horizontal: NDArray[np.bool_], vertical: NDArray[np.bool_]
) -> NDArray[np.int32]:
    """Return the region of each cell, shape (rows, columns), from 1 in reading order.

    Two cells that share a side with no line on it are in one region.
    """
    rows, columns = vertical.shape[0], horizontal.shape[1]
    first = np.arange(rows * columns).reshape(rows, columns)  # of the region, as known so far
    far = rows * columns
    while True:
        lowest = first.copy()
        across = np.where(horizontal, far, np.minimum(first[:-1], first[1:]))
        down = np.where(vertical, far, np.minimum(first[:, :-1], first[:, 1:]))
        for part, other in (
            (lowest[:-1], across),
            (lowest[1:], across),
            (lowest[:, :-1], down),
            (lowest[:, 1:], down),
        ):
            np.minimum(part, other, out=part)
        if np.array_equal(lowest, first):
            break
        first = lowest
    return (np.searchsorted(np.unique(first), first) + 1).astype(np.int32)


@pytest.mark.slow
@pytest.mark.parametrize("by", [plainly, compiled])
@given(r=st.integers(1, 7), c=st.integers(1, 7), share=st.floats(0, 1), seed=st.integers(0, 999))
def test_loops_part_as_the_reference_does(
    by: Callable[..., Any], r: int, c: int, share: float, seed: int
) -> None:
    pytest.importorskip("numba")
    rng = np.random.default_rng(seed)
    across, down = held(rng.random((r - 1, c)) < share), held(rng.random((r, c - 1)) < share)
    wanted = regions_by_waves(across, down)
    np.testing.assert_array_equal(by(label_regions)(across, down), wanted)


@pytest.mark.slow
@given(st.integers(0, 999))
def test_raised_regions_have_the_outline_of_most_contrast(seed: int) -> None:
    """No other choice of regions has a larger sum of (inside - outside) over its outline."""
    rng = np.random.default_rng(seed)
    values = rng.integers(0, 4, (3, 3)).astype(float)
    lines = between(values)
    labels = label_regions.reference(lines.horizontal, lines.vertical)
    n = labels.max()
    if n > 8:
        return

    def contrast(chosen: NDArray[np.bool_]) -> float:
        on = chosen[labels]
        total = 0.0
        for axis in (0, 1):
            total -= float(
                (np.diff(on.astype(float), axis=axis) * -np.diff(values, axis=axis)).sum()
            )
        return total

    best = max(
        contrast(np.array([False, *(code >> k & 1 for k in range(n))], bool))
        for code in range(2**n)
    )
    assert contrast(standing(values, lines, labels)) == pytest.approx(best)


def test_a_hollow_that_meets_the_outside_at_a_corner_only_is_filled() -> None:
    rows = [".....", ".###.", ".#.#.", "..##.", "....."]
    mask = np.array([[c == "#" for c in row] for row in rows])
    filled = mask.copy()
    filled[2, 2] = True
    np.testing.assert_array_equal(with_voids(mask, 1), filled)
    np.testing.assert_array_equal(with_voids(mask, 0), mask)
