"""The benchmark of workers: ways that cannot be gone are told, and ratios are to both."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from worker_speed import APART, ONE, Way, ratios, speeds, ways_of


def writes(text: str, seconds: float = 0.0) -> Callable[[str], object]:
    def act(out: str) -> None:
        time.sleep(seconds)
        Path(out).write_text(text)

    return act


def test_a_way_whose_package_is_missing_is_told_and_the_others_go_on(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ways = {
        ONE: Way(writes("a", 0.04)),
        "of nowhere": Way(writes("b"), needs="no_such_package"),
        APART: Way(writes("a", 0.01)),
    }
    found = speeds(ways, 100, 1, tmp_path)
    said = capsys.readouterr().out
    assert [*found] == [ONE, APART]
    assert "of nowhere   left out: no_such_package is not installed\n" in said
    assert "\nall write the same\n" in said
    assert 2.0 < found[APART] / found[ONE] < 4.5


def test_a_way_that_writes_something_else_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    speeds({ONE: Way(writes("a")), APART: Way(writes("b"))}, 100, 1, tmp_path)
    assert "NOT all write the same" in capsys.readouterr().out


def test_ratios_are_to_one_process_and_to_two_apart() -> None:
    found = {ONE: 100.0, APART: 125.0, "--workers 2": 150.0}
    assert ratios(found, "--workers 2").split() == ["1.50", "1.20"]
    assert ratios({ONE: 100.0}, ONE).split() == ["1.00"]


def test_what_ratios_are_to_comes_first() -> None:
    assert [*ways_of("a.zarr", "circle-1", 10)][:2] == [ONE, APART]
