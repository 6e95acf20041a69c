"""Numbers that stand for no reading."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import frames_of
from tactile_graph_sources.readers.words.filled import filling


@pytest.mark.parametrize(
    ("low", "rest", "found"),
    [(-999.0, 0.0, -999.0), (-999.0, -600.0, None), (-998.0, 5.0, None), (1e20, 4095.0, 1e20)],
)
def test_a_number_far_from_all_others_stands_for_no_reading(
    low: float, rest: float, found: float | None
) -> None:
    assert filling(np.array([[low, rest], [3.0, rest]])) == found


def test_where_every_cell_holds_it_it_is_a_reading() -> None:
    assert filling(np.full((2, 2), -999.0)) is None


def test_what_the_project_wrote_is_taken_at_its_word(tmp_path: Path) -> None:
    values = np.full((2, 3, 4), 5.0)
    values[:, 1, 1] = -999.0
    ours, other = tmp_path / "ours.npz", tmp_path / "other.npz"
    np.savez(ours, values=values, quantity=np.array("raw"), pitch_cm=np.array([1.0, 1.0]))
    np.savez(other, frames=values)
    (kept, *_), _ = frames_of(ours)
    assert kept.image.valid is None
    assert kept.image.values[1, 1] == -999.0
    (left_out, *_), report = frames_of(other)
    assert left_out.image.valid is not None
    assert not left_out.image.valid[1, 1]
    assert "recordings with cells of -999 taken for missing" in report.counts
