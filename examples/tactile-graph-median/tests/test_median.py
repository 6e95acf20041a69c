"""The median takes single cells out, keeps edges, and leaves invalid cells alone."""

import numpy as np
import pytest
from tactile_graph_median.median import median

from tactile_graph import Degenerate, Frame, Image, loads


def test_a_single_stuck_cell_goes() -> None:
    values = np.zeros((5, 5))
    values[2, 2] = 9.0
    assert median(Image(values)).values.max() == 0.0


def test_a_straight_edge_stays() -> None:
    values = np.repeat([[0.0, 0.0, 1.0, 1.0]], 4, axis=0)
    assert median(Image(values.copy())).values.tolist() == values.tolist()


def test_the_window_ends_with_the_pad() -> None:
    image = Image(np.array([[1.0, 2.0], [3.0, 10.0]]))
    assert median(image).values.tolist() == [[2.5, 2.5], [2.5, 2.5]]


def test_a_reach_of_none_changes_nothing() -> None:
    values = np.random.default_rng(0).random((4, 6))
    assert median(Image(values), reach=0).values.tolist() == values.tolist()


def test_invalid_cells_count_for_nothing_and_stay_invalid() -> None:
    frame = Frame.of(np.array([[1.0, np.nan, 3.0]]), quantity="volt")
    found = median(frame.image)
    assert found.values.tolist() == [[1.0, 0.0, 3.0]]
    assert found.valid is frame.image.valid
    assert found.quantity == "volt"


def test_a_pad_without_a_valid_cell_gives_zeros_and_no_warning() -> None:
    assert median(Frame.of(np.full((3, 3), np.nan)).image).values.max() == 0.0


def test_it_is_found_by_name_in_a_pipeline() -> None:
    pipeline = loads("{pipeline: p, nodes: {m: {step: median, in: frame}}, outputs: [m]}")
    assert pipeline.run(np.eye(4))["m"].shape == (4, 4)


def test_its_range_is_checked_at_load() -> None:
    text = "{pipeline: p, nodes: {m: {step: median, in: frame, with: {reach: -1}}}, outputs: [m]}"
    with pytest.raises(Exception, match="reach: must be >= 0, got -1"):
        loads(text)


def test_huge_readings_neither_overflow_nor_warn() -> None:
    assert median(Image(np.full((2, 2), 1.7e308))).values.tolist() == [[1.7e308] * 2] * 2


def test_a_valid_cell_without_a_number_is_refused() -> None:
    with pytest.raises(Degenerate, match="a valid cell holds no finite number"):
        median(Image(np.array([[1.0, np.nan]])))
