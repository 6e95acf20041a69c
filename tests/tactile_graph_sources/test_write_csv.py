"""Tables that are read back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tactile_graph import Frame
from tactile_graph.errors import DataError
from tactile_graph.steps.injected import Report
from tactile_graph_sources.recording import recording
from tactile_graph_sources.write_csv import write_csv


@pytest.mark.parametrize("timed", [True, False])
def test_a_table_is_read_back(tmp_path: Path, timed: bool) -> None:
    rng = np.random.default_rng(0)
    values = rng.normal(size=(6, 3, 5))
    values[2, 1, 1] = np.nan
    made = [
        Frame.of(v, quantity="volt", index=i, time_s=0.1 * i if timed else None)
        for i, v in enumerate(values)
    ]
    path = tmp_path / "a.csv"
    assert write_csv(path, made) == 6
    read = list(recording(path=path, rows=3, columns=5, quantity="volt", report=Report()))
    assert [f.time_s for f in read] == [f.time_s for f in made]
    for a, b in zip(made, read, strict=True):
        np.testing.assert_array_equal(a.image.filled(np.nan), b.image.filled(np.nan))
    assert [p.name for p in tmp_path.iterdir()] == ["a.csv"]


def test_nothing_is_left_behind_when_a_frame_does_not_fit(tmp_path: Path) -> None:
    made = [Frame.of(np.ones((2, 2)), time_s=0.0), Frame.of(np.ones((3, 2)), time_s=0.0)]
    with pytest.raises(DataError, match=r"frame 1 is of shape \(3, 2\), the first \(2, 2\)"):
        write_csv(tmp_path / "a.csv", made)
    with pytest.raises(DataError, match="frame 1 has no time, the first has one"):
        write_csv(tmp_path / "a.csv", [made[0], Frame.of(np.ones((2, 2)))])
    with pytest.raises(DataError, match="there is no frame to write"):
        write_csv(tmp_path / "a.csv", [])
    assert not list(tmp_path.iterdir())
