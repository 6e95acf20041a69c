"""Which frames the numbers of a file of truth mean."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
import pytest

from tactile_graph import Frame
from tactile_graph.errors import DataError
from tactile_graph.steps import Report
from tactile_graph_sources.readers.words.truth_file import with_truth

Row = tuple[int, int | None]


def frames(rows: Iterable[Row], labels: str = "", gap: int = -1) -> Iterator[Frame]:
    """Yield frames of places and own numbers; labels of a letter each take turns."""
    for k, (place, own) in enumerate(rows):
        label = labels[k % len(labels)] if labels else ""
        rest = {"place": place, "own_number": own, "label": label, "gap": place == gap}
        yield Frame.of(np.zeros((2, 2)), index=k, **rest)


def known(
    folder: Path, found: Iterator[Frame], by: str, said: str = "0-19", report: Report | None = None
) -> list[int]:
    """Return the places of frames of which a table knows the truth: ``said`` counted ``by``."""
    path = folder / "truth.csv"
    path.write_text(f"{by},kind\n{said},none\n")
    return [f.place or 0 for f in with_truth(found, path, report) if f.truth is not None]


def told(text: str) -> str:
    return " ".join(re.sub(r"\S*truth.csv: ", "", text).split())


def test_a_frame_that_was_left_out_keeps_its_number_and_that_is_told(tmp_path, capsys):
    held = [(k, None) for k in range(20) if k not in (5, 6)]
    assert known(tmp_path, frames(held), "frames", "4-7") == [4, 7]
    assert told(capsys.readouterr().err) == (
        "frames are counted from 0 as they stand in the recording; those that were left out, of "
        "which 5 is the first, count too"
    )
    assert known(tmp_path, frames(held), "frames", "all") == [k for k, _ in held]
    assert known(tmp_path, frames((k, None) for k in range(20)), "frames", "4-7") == [4, 5, 6, 7]
    assert capsys.readouterr().err == ""


def test_those_left_out_at_the_end_are_there(tmp_path):
    report = Report()
    report.n_places = 20
    held = [(k, None) for k in range(18)]
    assert len(known(tmp_path, frames(held), "frames", "0-19", report)) == 18
    with pytest.raises(DataError, match="speaks of frame 20, the last one is 19"):
        known(tmp_path, frames(held), "frames", "0-20", report)
    path = tmp_path / "truth.json"
    path.write_text(f"[{', '.join(['null'] * 17 + ['[]', '[]', '[]'])}]")
    assert [f.place for f in with_truth(frames(held), path, report) if f.truth == ()] == [17]
    with pytest.raises(DataError, match="holds the truth of 20 frames, there are 18, those that"):
        list(with_truth(frames(held), path))


def test_an_entry_of_a_list_is_a_frame_that_was_left_out_too(tmp_path):
    path = tmp_path / "truth.json"
    path.write_text("[null, null, [], null]")
    found = with_truth(frames([(0, None), (2, None), (3, None)]), path)
    assert [f.place for f in found if f.truth is not None] == [2]
    with pytest.raises(DataError, match="in a table, the column 'numbers' counts by these"):
        list(with_truth(frames([(0, 1), (1, 2)]), path))


def test_own_numbers_that_leap_are_refused_until_it_is_said_which_are_meant(tmp_path, capsys):
    held = [*((k, k + 1) for k in range(3)), *((k, k + 4) for k in range(3, 17))]
    with pytest.raises(DataError, match=r"after 3 comes 7 at frame 3, .* 'numbers' .* or 'places'"):
        known(tmp_path, frames(held), "frames", "0-9")
    capsys.readouterr()
    assert known(tmp_path, frames(held), "numbers", "3-7") == [2, 3]
    assert known(tmp_path, frames(held), "places", "3-7") == [3, 4, 5, 6, 7]
    assert known(tmp_path, frames(held), "frames", "all") == [*range(17)]
    assert capsys.readouterr().err == ""
    with pytest.raises(
        DataError, match="speaks of frame 21, the recording's own numbers end at 20"
    ):
        known(tmp_path, frames(held), "numbers", "3-21")


def test_own_numbers_that_begin_elsewhere_are_told(tmp_path, capsys):
    held = [(k, k + 1) for k in range(20)]
    assert known(tmp_path, frames(held), "frames", "3") == [3]
    assert told(capsys.readouterr().err) == (
        "frames are counted from 0 as they stand in the recording, which itself gives frame 0 the "
        "number 1; name the column 'numbers' to count by its own numbers"
    )


def test_own_numbers_that_come_again_or_are_missing_are_refused(tmp_path):
    with pytest.raises(DataError, match=r"and 0 comes again at frame 2, .* 'places'"):
        known(tmp_path, frames([(0, 0), (1, 1), (2, 0)]), "numbers")
    with pytest.raises(DataError, match=r"and frame 0, counted from 0, has none; .* 'frames'"):
        known(tmp_path, frames([(0, None)]), "numbers")
    with pytest.raises(DataError, match="after 1 comes 0 at frame 2"):
        known(tmp_path, frames([(0, 0), (1, 1), (2, 0)]), "frames")


def test_frames_of_several_sensors_take_turns(tmp_path):
    held = [(k, k // 2) for k in range(20)]
    assert known(tmp_path, frames(held, "ab"), "frames", "2-3") == [2, 3]
    assert known(tmp_path, frames(held, "ab"), "numbers", "2-3") == [4, 5, 6, 7]
    leaping = [(k, k // 2 + (k > 5)) for k in range(20)]
    with pytest.raises(DataError, match="after 2 comes 4 at frame 6"):
        known(tmp_path, frames(leaping, "ab"), "frames", "2-3")


def test_a_gap_of_unknown_size_is_told(tmp_path, capsys):
    held = [(k, None) for k in range(9)]
    known(tmp_path, frames(held, gap=4), "frames", "2-3")
    assert "a gap before frame 4; how many frames are missing" in told(capsys.readouterr().err)


def test_a_table_says_once_how_it_counts(tmp_path):
    with pytest.raises(DataError, match="'frames' and 'places' both say which frames are meant"):
        known(tmp_path, frames([]), "frames,places", "1,1")
