"""The queue between the reader and whoever takes the frames."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from tactile_graph_sources.devices.counters import LinkCounts
from tactile_graph_sources.devices.decoder import Decoded
from tactile_graph_sources.devices.inbox import Arrived, Inbox


def arrived(i: int, gap: bool = False) -> Arrived:
    return Arrived(Decoded(np.zeros((1, 1)), None, gap, i), float(i))


def test_the_newest_frame_wins_and_the_rest_is_counted() -> None:
    counts = LinkCounts()
    inbox = Inbox(True, 100, counts)
    inbox.put([arrived(i) for i in range(5)])
    taken = inbox.get(0.0)
    assert taken is not None
    assert taken.frame.end == 4
    assert counts.dropped == 4
    assert inbox.get(0.0) is None


def test_the_mark_of_a_gap_outlives_a_dropped_frame() -> None:
    inbox = Inbox(True, 100, LinkCounts())
    inbox.put([arrived(0, gap=True), arrived(1), arrived(2)])
    taken = inbox.get(0.0)
    assert taken is not None
    assert taken.frame.gap


def test_a_full_lossless_inbox_holds_the_reader_back() -> None:
    counts = LinkCounts()
    inbox = Inbox(False, 2, counts)
    thread = threading.Thread(target=inbox.put, args=([arrived(i) for i in range(6)],))
    thread.start()
    taken = [inbox.get(10.0) for _ in range(6)]
    thread.join(10.0)
    assert [t.frame.end for t in taken if t] == list(range(6))
    assert counts.dropped == 0


def test_closing_lets_a_held_back_reader_go() -> None:
    inbox = Inbox(False, 1, LinkCounts())
    thread = threading.Thread(target=inbox.put, args=([arrived(0), arrived(1)],))
    thread.start()
    inbox.close()
    thread.join(10.0)
    assert not thread.is_alive()
    assert len(inbox) == 2
    assert [t and t.time_s for t in (inbox.get(0.0), inbox.get(0.0), inbox.get(0.0))] == [
        0,
        1,
        None,
    ]


def test_what_broke_the_reader_reaches_the_taker() -> None:
    inbox = Inbox(False, 1, LinkCounts())
    inbox.fail(RuntimeError("broken"))
    with pytest.raises(RuntimeError, match="broken"):
        inbox.get(1.0)
