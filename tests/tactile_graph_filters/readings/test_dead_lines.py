"""Lines that read nothing are told from those that are only unloaded."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from helpers_modes import answered_by, compiled, held, plainly
from tactile_graph.wires import Image
from tactile_graph_filters.readings import dead_lines as dead_lines_module
from tactile_graph_filters.readings.dead_lines import constant_lines, dead_lines


def noisy() -> np.ndarray:
    return np.random.default_rng(1).normal(0.0, 1.0, (10, 12))


def found(values: np.ndarray, valid: np.ndarray | None = None) -> tuple[list[int], list[int]]:
    rows, columns = dead_lines(Image(values, valid=valid))
    return np.flatnonzero(rows).tolist(), np.flatnonzero(columns).tolist()


def test_lines_stuck_at_any_value_are_dead_also_where_they_cross() -> None:
    values = noisy()
    values[3], values[:, 7] = 0.0, 1023.0
    assert found(values) == ([3], [7])


def test_lines_without_a_valid_cell_are_dead() -> None:
    valid = np.ones((10, 12), bool)
    valid[:, 2] = False
    assert found(noisy(), valid) == ([], [2])


def test_unloaded_lines_are_not_dead_with_noise_or_without() -> None:
    assert found(noisy()) == ([], [])
    silent = np.zeros((10, 12))
    silent[3:6, 4:9] = 1.0
    assert found(silent) == ([], [])


def test_lines_of_few_cells_are_never_called_dead() -> None:
    values = np.random.default_rng(1).normal(0.0, 1.0, (9, 3))
    values[4] = 0.0
    assert found(values) == ([], [])


def test_an_image_without_columns_has_no_dead_line() -> None:
    assert found(np.zeros((9, 0))) == ([], [])


def test_a_dead_line_is_found_however_few_of_its_neighbours_are_equal() -> None:
    values = np.random.default_rng(1).normal(0.0, 1.0, (16, 16))
    values[5, :], values[:, 9] = 3.0, 4.0
    values[5, 1:14:4] = values[5:15:3, 9] = 7.0
    assert found(values.copy()) == ([5], [9])
    values[5, 15] = 7.0
    assert found(values) == ([], [9])


def test_noise_is_told_from_dead_lines_by_its_neighbours_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    votes: list[int] = []
    monkeypatch.setattr(dead_lines_module, "_equal_to_most", lambda line: votes.append(1) or 0)
    values = noisy()
    with answered_by("plain"):
        constant_lines.loops(values, np.empty(10, bool), np.empty(12, bool))
    assert not votes


@pytest.mark.slow  # much is compiled
@settings(max_examples=100, deadline=None)
@given(
    arrays(
        np.float64,
        st.tuples(st.integers(1, 9), st.integers(1, 9)),
        elements=st.sampled_from([0.0, -0.0, 1.0, 2.0, np.nan]),
    )
)
def test_votes_find_what_sorting_finds(values: np.ndarray) -> None:
    found = []
    for way in (constant_lines.reference, plainly(constant_lines), compiled(constant_lines)):
        rows, columns = np.empty(len(values), bool), np.empty(values.shape[1], bool)
        way(held(values), rows, columns)
        found.append((rows.tolist(), columns.tolist()))
    assert found[0] == found[1] == found[2]
