"""Frames are gathered as they come, and nothing waits for a source that is slow."""

from __future__ import annotations

from collections.abc import Iterator
from unittest.mock import patch

import pytest

from helpers_graphs import frame
from tactile_graph import Frame
from tactile_graph.engine.blocks import gathering
from tactile_graph.engine.blocks.gathering import Share, Taken, flat, gathered
from tactile_graph.wires.frame_stack import FrameStack


def test_frames_that_come_at_once_are_gathered_and_keep_their_order() -> None:
    frames = [frame(k, k) for k in range(1200)]
    with patch.multiple(gathering, SLOW_S=60.0, PATIENCE_S=60.0):
        stacks = [*gathered(frames)]
    assert [len(s) for s in stacks] == [1, 512, 512, 175]
    assert [*flat(stacks)] == frames


def test_a_slow_source_is_handed_on_frame_by_frame() -> None:
    with patch.object(gathering, "SLOW_S", -1.0):
        assert [len(s) for s in gathered(frame(k, k) for k in range(4))] == [1, 1, 1, 1]


def test_what_came_before_an_error_is_handed_on_before_it_is_raised() -> None:
    def broken() -> Iterator[Frame]:
        yield from (frame(k, k) for k in range(5))
        raise OSError("the cable is out")

    got = []
    with pytest.raises(OSError, match="cable"):
        got += [*map(got.append, gathered(broken()))]
    assert sum(map(len, got)) == 5


def test_stacks_of_a_source_pass_between_single_frames() -> None:
    stack = FrameStack.of([frame(k, k) for k in range(3)])
    stacks = [*gathered([frame(8), stack, frame(9)])]
    assert stacks[1] is stack
    assert [len(s) for s in stacks] == [1, 3, 1]


def test_a_block_is_as_long_as_is_done_in_a_moment() -> None:
    stack = FrameStack.of([frame(k, k) for k in range(100)])
    now = 0.0
    with patch.object(gathering.time, "perf_counter", lambda: now):
        sizes = []
        for part in Share().parts(stack):
            sizes.append(len(part))
            now += 0.02 * len(part)
    assert sizes[0] == 16
    assert set(sizes[1:]) <= {4, 5}
    assert sum(sizes) == 100


def test_as_many_are_taken_as_are_asked_for_and_no_further_one_is_read() -> None:
    frames = [frame(k, k) for k in range(9)]
    stacks = [FrameStack.of(frames[:4]), FrameStack.of(frames[4:6]), *frames[6:]]
    for start in range(10):
        for n in (0, 1, 3, None):
            taken = Taken(iter(stacks))
            assert [*flat(taken.next(start))] == frames[:start]
            stop = None if n is None else start + n
            assert [*flat(taken.next(n))] == frames[start:stop]
    asked = iter(stacks)
    taken = Taken(asked)
    assert [len(s) for s in taken.next(5)] == [4, 1]
    assert taken.n_left == 1
    assert next(asked) is frames[6]
