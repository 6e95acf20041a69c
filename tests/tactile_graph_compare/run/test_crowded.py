"""What is said of times that were measured while other programs held the processor."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tactile_graph import Frame, Image
from tactile_graph_compare import compare
from tactile_graph_compare.run import crowded as module
from tactile_graph_compare.run.crowded import Waiting, crowded
from tactile_graph_compare.run.session import Session
from tactile_graph_compare.variants.prepare import prepare
from tactile_graph_compare.variants.request import VariantRequest


@pytest.fixture
def told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The file in which a system tells of a thread's time."""
    file = tmp_path / "schedstat"
    file.write_text("1000 500 3\n")
    monkeypatch.setattr(module, "SCHEDULED", file)
    return file


def test_the_share_is_of_what_a_thread_could_have_run_since(told: Path) -> None:
    waiting = Waiting()
    assert waiting.share == 0.0
    told.write_text("4000 1500 9\n")
    assert waiting.share == pytest.approx(0.25)
    (line,) = crowded(waiting)
    assert line.startswith("other programs kept the processor for 25% of the time")


def test_a_little_and_an_unknown_share_are_not_told(told: Path) -> None:
    waiting = Waiting()
    told.write_text("9000 1300 9\n")
    assert waiting.share == pytest.approx(0.0909, abs=1e-4)
    assert crowded(waiting) == ()
    for text in ("", "0 0 0", "1e3 x"):
        told.write_text(text)
        assert crowded(waiting) == ()
    told.unlink()
    assert crowded(waiting) == ()
    assert crowded(None) == ()


def frames(told: Path) -> list[Frame]:
    rng = np.random.default_rng(0)
    told.write_text("1000 3000 9\n")
    return [
        Frame(Image(rng.random((4, 4)), (1.0, 1.0), quantity="volt"), index=k) for k in range(6)
    ]


def test_a_comparison_says_so(hand_made: Path, told: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def late(self: Waiting) -> float:
        return 0.4

    given = frames(told)
    assert not any("other programs" in n for n in compare(["discs"], frames=given).notes)
    monkeypatch.setattr(Waiting, "share", property(late))
    assert any("kept the processor for 40%" in n for n in compare(["discs"], frames=given).notes)


def test_nothing_is_said_of_frames_that_others_timed(hand_made: Path, told: Path) -> None:
    from tactile_graph.plugins.registry import installed

    prepared = prepare([VariantRequest("discs")], installed())
    here, there = Session(prepared), Session(prepared)
    for frame in frames(told):
        there.add(frame)
    here.join(there.part())
    assert here.waiting is None
    assert there.waiting is not None
