"""The section ``learned`` of a pad file, and the table of its elements."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tactile_graph.errors import DataError, PipelineError, UsageError
from tactile_graph_pads.learned import Elements, read_elements, write_elements
from tactile_graph_pads.pad import learned_of, load_pad

LEARNED = """
learned:
  reading: raw
  rows: 2
  columns: 3
  pitch_cm: [0.5, 0.8]
  origin_cm: [0.0, 0.0]
  elements: table.csv
  noise: 1.5
  touched_from: 9.0
"""


def elements() -> Elements:
    state = np.full((2, 3), "good", dtype="U8")
    state[1, 2] = "dead"
    shape = (2, 3)
    return Elements(np.arange(6.0).reshape(shape), np.full(shape, 1.5), np.full(shape, 1.0), state)


def test_a_table_comes_back_as_it_was_written(tmp_path: Path) -> None:
    write_elements(tmp_path / "t.csv", elements())
    found = read_elements(tmp_path / "t.csv", (2, 3))
    assert all((a == b).all() for a, b in zip(found, elements(), strict=True))
    assert found.good.sum() == 5


def test_a_pads_table_lies_beside_its_file(tmp_path: Path) -> None:
    (tmp_path / "pad.yaml").write_text(LEARNED)
    learned = learned_of(tmp_path / "pad.yaml")
    with pytest.raises(DataError, match=r"table.csv: the table of elements cannot be read"):
        _ = learned.table
    write_elements(tmp_path / "table.csv", elements())
    assert learned_of(tmp_path / "pad.yaml").table.offset[1, 2] == 5.0


def test_a_pad_described_by_hand_has_learned_nothing() -> None:
    assert load_pad("thesis").learned is None
    with pytest.raises(UsageError, match=r"pad 'thesis' was not learned.*tactile-graph learn-pad"):
        learned_of("thesis")


def test_mistakes_in_the_section_are_told_with_their_line(tmp_path: Path) -> None:
    (tmp_path / "pad.yaml").write_text(
        LEARNED.replace("noise: 1.5", "noise: -1").replace("raw", "rew")
    )
    with pytest.raises(PipelineError) as error:
        load_pad(tmp_path / "pad.yaml")
    assert "pad.yaml:9:" in str(error.value)
    assert "'raw'" in str(error.value)


@pytest.mark.parametrize(
    ("changed", "match"),
    [
        (("1,2,5,1.5,1,dead\n", ""), "lacks the element in row 1, column 2"),
        (("dead", "broken"), r":7: state must be one of .*got 'broken'"),
        (("1,2,5,", "1,3,5,"), "row 1, column 3 is not on a pad of 2 x 3"),
        (("1,2,5,1.5,1", "1,2,5,-2,1"), "noise must be finite and >= 0, got -2"),
        (("1,2,5,", "1,2,nan,"), ":7: offset must be finite, got nan"),
        (("1,2,5,1.5,1,", "1,2,5,1.5,inf,"), ":7: gain must be finite and > 0, got inf"),
        (("1,2,5,", "1,2,five,"), ":7: offset must be a number, got 'five'"),
        (("1,2,5,1.5,1,dead", "1;2;5;1.5;1;dead"), ":7: row must be a whole number, got '1;2;5"),
        (("1,2,5,1.5,1,dead", "1,2"), ":7: offset must be a number, got nothing: the line ends"),
        (("1,2,5,", "0,0,5,"), ":7: row 0, column 0 is given twice; the first is in line 2"),
        (("offset", "zero"), r"needs the columns .*lacks offset, got 'row,column,zero,"),
    ],
)
def test_a_wrong_table_is_refused_by_line(
    tmp_path: Path, changed: tuple[str, str], match: str
) -> None:
    path = tmp_path / "t.csv"
    write_elements(path, elements())
    path.write_text(path.read_text().replace(*changed))
    with pytest.raises(DataError, match=match):
        read_elements(path, (2, 3))


@pytest.mark.parametrize("mark", [";", "\t"])
def test_a_table_that_a_spreadsheet_saved_is_read(tmp_path: Path, mark: str) -> None:
    path = tmp_path / "t.csv"
    write_elements(path, elements())
    path.write_text(path.read_text().replace(",", mark).replace(".", ","))
    found = read_elements(path, (2, 3))
    assert all((a == b).all() for a, b in zip(found, elements(), strict=True))
