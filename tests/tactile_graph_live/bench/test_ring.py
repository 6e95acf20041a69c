"""The last minute of frames."""

from __future__ import annotations

import numpy as np

from tactile_graph import Frame, Image
from tactile_graph_live.bench.ring import Ring


def filled(n: int, ring: Ring, every_s: float = 1.0) -> Ring:
    for i in range(n):
        ring.add(Frame(Image(np.full((2, 2), float(i))), i), i * every_s)
    return ring


def test_frames_older_than_the_time_kept_go() -> None:
    ring = filled(100, Ring(seconds=60.0))
    assert ring.kept() == (60.0, 61)


def test_frames_go_when_they_take_too_many_bytes() -> None:
    ring = filled(100, Ring(seconds=1e6, n_bytes=10 * 32))
    assert ring.kept() == (9.0, 10)


def test_a_frame_is_found_by_how_long_ago_it_came() -> None:
    ring = filled(10, Ring())
    frames, back_s, newer = ring.back(3.5)
    assert ([f.index for f in frames], back_s, newer) == ([5], 4.0, True)
    assert ring.back(0.0)[0][-1].index == 9
    assert ring.back(1e9)[0][-1].index == 0


def test_frames_that_lead_up_to_it_come_before_it() -> None:
    ring = filled(10, Ring())
    assert [f.index for f in ring.back(2.0, lead=3)[0]] == [4, 5, 6, 7]
    assert [f.index for f in ring.back(9.0, lead=3)[0]] == [0]


def test_the_next_frame_is_found_by_the_number_of_the_one_before() -> None:
    ring = filled(5, Ring())
    frames, _, newer = ring.after(2)
    assert (frames[-1].index, newer) == (3, True)
    frames, _, newer = ring.after(4)
    assert (frames[-1].index, newer) == (4, False)


def test_of_nothing_kept_nothing_is_found() -> None:
    assert Ring().back(1.0) == ([], 0.0, False)
    assert Ring().after(0) == ([], 0.0, False)
    assert Ring().kept() == (0.0, 0)


def test_what_is_gone_is_let_go_of_and_finding_stays_right() -> None:
    ring = filled(5000, Ring(seconds=10.0))
    assert ring.kept() == (10.0, 11)
    assert len(ring._kept) < 2100
    assert ring.back(3.0)[0][-1].index == 4996
    assert [f.index for f in ring.after(4990, lead=5)[0]] == [4989, 4990, 4991]


def test_the_newest_frame_is_kept_however_large_it_is() -> None:
    assert filled(3, Ring(n_bytes=1)).kept() == (0.0, 1)
