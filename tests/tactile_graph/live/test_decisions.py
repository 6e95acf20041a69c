"""Decisions are read from the lines a live run wrote, and put beside the frames they are of."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers_graphs import frame
from tactile_graph.errors import DataError
from tactile_graph.live import Recorded
from tactile_graph.live.decisions import as_decided, decisions_in

NODES = ("best", "middle", "cheap")


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "live.jsonl"
    path.write_text(text)
    return path


def test_frames_that_were_shed_are_left_out_and_decisions_are_in_place(tmp_path: Path) -> None:
    path = written(
        tmp_path, '{"frame": 1}\n{"frame": 3, "deadline": ["best", "middle"]}\n{"frame": 4}\n'
    )
    recorded = Recorded()
    seen = [
        (one.index, set(recorded.skipped))
        for one in as_decided((frame(0, i) for i in range(9)), decisions_in(path, NODES), recorded)
    ]
    assert seen == [(1, set()), (3, {"best", "middle"}), (4, set())]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("{", r"live.jsonl:1: is no JSON line"),
        ("[1]", r"live.jsonl:1: has no 'frame': lines are wanted that a run wrote"),
        ('{"frame": true}', r"live.jsonl:1: has no 'frame'"),
        ('{"frame": 0, "deadline": "best"}', r"live.jsonl:1: 'deadline' is a list of nodes, got"),
        (
            '{"frame": 0, "deadline": ["bset"]}',
            r"live.jsonl:1: the pipeline has no node 'bset'; did you mean 'best'\?",
        ),
    ],
)
def test_a_line_that_is_none_is_told_with_its_place(
    tmp_path: Path, line: str, message: str
) -> None:
    with pytest.raises(DataError, match=message):
        list(decisions_in(written(tmp_path, line), NODES))


def test_decisions_of_other_frames_are_refused(tmp_path: Path) -> None:
    path = written(tmp_path, '{"frame": 0}\n{"frame": 12}\n')
    with pytest.raises(DataError, match=r"live.jsonl:2: is of frame 12, which the source does not"):
        list(as_decided([frame(0, 0), frame(0, 1)], decisions_in(path, NODES), Recorded()))


def test_a_file_that_cannot_be_read_is_told(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="cannot be read"):
        list(decisions_in(tmp_path / "none.jsonl", NODES))
