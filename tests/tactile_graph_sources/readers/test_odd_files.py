"""Files that people really have, and that hold less than they seem to: each says what is wrong."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from tactile_graph.errors import DataError
from tactile_graph.steps import Report
from tactile_graph_sources.readers.tables.dialect import Dialect
from tactile_graph_sources.recording import recording


def refused(path: Path) -> str:
    with pytest.raises(DataError) as caught:
        list(recording(path=path, report=Report()))
    return caught.value.what


def test_a_quoted_number_with_a_comma_is_no_number_and_never_two(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text('"1,000","2,000","3,000","4,000"\n')
    assert "line 1, column 1: '1,000' is no number" in refused(path)
    path.write_text('"0.5","1.5"\n2.5,3.5\n')
    assert [f.image.values.tolist() for f in recording(path=path, report=Report())] == [
        [[0.5, 1.5], [2.5, 3.5]]
    ]
    assert Dialect().fields('"1,2') == ["1", "2"]  # one quote alone means nothing


def test_arrays_that_cannot_be_read_say_why(tmp_path: Path) -> None:
    path = tmp_path / "a.npy"
    np.save(path, np.zeros((4, 4)))
    path.write_bytes(path.read_bytes()[:-8])
    assert refused(path) == (
        "its array cannot be read: the file is cut off: it holds less than its header says"
    )
    np.save(path, np.array([[1, None]], dtype=object))
    assert refused(path) == "its array cannot be read: it holds Python objects, not numbers"
    np.save(path, np.zeros((0, 4, 4)))
    assert refused(path) == "its array has shape (0, 4, 4): it holds no cell"


def test_a_pipe_is_told_to_be_saved_first(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    assert refused(tmp_path / "pipe") == "is no plain file; save what it gives as a file first"
    assert refused(tmp_path / "pipes") == "there is no such file; did you mean 'pipe'?"
