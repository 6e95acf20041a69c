"""What waits to go through the pipe."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from tactile_graph import Frame, Image
from tactile_graph_live.bench import outbox as module
from tactile_graph_live.bench.outbox import Outbox
from tactile_graph_live.bench.wire import Row, Rows, Said, Snapshot, Taken


class Slow:
    """A pipe whose other side reads when it is told to."""

    def __init__(self) -> None:
        self.sent: list[Any] = []
        self.may = threading.Event()

    def send(self, what: Any) -> None:
        assert self.may.wait(5)
        self.sent.append(what)


@pytest.fixture
def pipe() -> Iterator[Slow]:
    slow = Slow()
    yield slow
    slow.may.set()


def stuck(pipe: Slow) -> Outbox:
    """Return an outbox whose sender is busy with a first note."""
    box = Outbox(pipe.send)
    box.note(Said("first"))
    while box._notes:
        pass
    return box


def row(i: int) -> Row:
    return Row(i, None, "", None, 0.0, 1.0, (), ())


def finished(box: Outbox, pipe: Slow) -> list[Any]:
    pipe.may.set()
    box.end()
    return pipe.sent[1:]


def test_the_newest_picture_wins(pipe: Slow) -> None:
    box = stuck(pipe)
    for i in range(5):
        box.show(Snapshot(i, i))  # type: ignore[arg-type]
    assert [s.arrived_ns for s in finished(box, pipe)] == [4]


def test_notes_go_first_and_rows_together(pipe: Slow) -> None:
    box = stuck(pipe)
    box.row(row(0))
    box.row(row(1))
    box.note(Said("second"))
    note, rows = finished(box, pipe)
    assert note == Said("second")
    assert rows == Rows((row(0), row(1)), 0)


def test_rows_that_nobody_takes_go_the_oldest_first_and_are_counted(
    pipe: Slow, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "MOST_ROWS", 3)
    box = stuck(pipe)
    for i in range(10):
        box.row(row(i))
    (rows,) = finished(box, pipe)
    assert [r.frame for r in rows.rows] == [7, 8, 9]
    assert rows.n_lost == 7


def test_frames_to_record_end_with_the_last(pipe: Slow, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "AT_ONCE", 2)
    box = stuck(pipe)
    for i in range(3):
        box.frame(Frame(Image(np.zeros((1, 1))), i))
    box.last_frame()
    taken = finished(box, pipe)
    assert all(isinstance(t, Taken) for t in taken)
    assert [f.index for t in taken for f in t.frames] == [0, 1, 2]
    assert [t.last for t in taken] == [False, True]


def test_a_recording_without_frames_has_a_last_too(pipe: Slow) -> None:
    box = stuck(pipe)
    box.last_frame()
    assert finished(box, pipe) == [Taken((), 0, True)]


def test_results_without_end_hold_up_neither_pictures_nor_frames(pipe: Slow) -> None:
    kinds: list[type] = []

    def send(what: Any) -> None:
        assert pipe.may.wait(5)
        kinds.append(type(what))
        if len(kinds) < 20:
            box.row(row(len(kinds)))  # the next is there before this one is through

    box = Outbox(send)
    box.row(row(0))
    box.show(Snapshot(0, 0))  # type: ignore[arg-type]
    box.frame(Frame(Image(np.zeros((1, 1))), 0))
    pipe.may.set()
    box.end()
    assert {Snapshot, Taken} <= set(kinds[:4])
