"""Replies to requests that pause, come late, or are too long: no frame is made of two."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from helpers_serial import FakePad
from tactile_graph import Frame
from tactile_graph.steps.injected import Report
from tactile_graph_sources.serial_port import serial

FAST = 2_000_000
"""So that a reply that does not come is waited for a quarter of a second only."""


@contextmanager
def answering(pad: FakePad, hurt: dict[int, Sequence[bytes | float]]) -> Iterator[None]:
    """Answer each request by a frame of 256 cells that all hold its number, from 1.

    Some replies are of these parts instead: bytes that are sent, seconds that it pauses.
    """
    over = threading.Event()

    def play() -> None:
        n = 0
        while pad.asked(1, over):
            n += 1
            for part in hurt.get(n, [bytes([n % 250 + 1]) * 256]):
                if isinstance(part, bytes):
                    pad.send(part)
                else:
                    time.sleep(part)
            time.sleep(0.002)

    player = threading.Thread(target=play)
    player.start()
    try:
        yield
    finally:
        over.set()
        player.join()


@pytest.fixture
def pad(tmp_path: Path) -> Iterator[FakePad]:
    fake = FakePad(tmp_path / "tty")
    yield fake
    fake.unplug()


def taken(
    pad: FakePad, report: Report, hurt: dict[int, Sequence[bytes | float]], n_frames: int = 40
) -> list[Frame]:
    with answering(pad, hurt):
        return list(
            serial(
                port=str(pad.link), preset="itas", baud=FAST, n_frames=n_frames, report=report,
                give_up_s=20.0,
            )
        )  # fmt: skip


def torn(frames: Sequence[Frame]) -> list[int]:
    return [f.index for f in frames if len(np.unique(f.image.values)) > 1]


@pytest.mark.slow
@pytest.mark.parametrize("pause_s", [0.28, 0.4, 0.9])
def test_a_reply_that_pauses_tears_no_frame(pad: FakePad, pause_s: float) -> None:
    """The host asks again meanwhile: the rest comes before the next reply, or with it."""
    report = Report()
    frames = taken(pad, report, {20: [b"\x05" * 128, pause_s, b"\x05" * 128]})
    assert torn(frames) == []
    assert [f.gap for f in frames].count(True) <= 1


@pytest.mark.slow
def test_where_every_reply_pauses_torn_frames_are_doubtful(pad: FakePad) -> None:
    """By its length alone a rest and a beginning are a reply."""
    slow = {n: [bytes([n]) * 128, 0.5, bytes([n]) * 128] for n in range(10, 16)}
    report = Report()
    frames = taken(pad, report, slow)
    assert all(frames[i].doubtful for i in torn(frames))
    assert report.counts["doubtful frames"] == sum(f.doubtful for f in frames)
    assert not frames[-1].doubtful
    assert torn(frames[-8:]) == []


@pytest.mark.slow
def test_a_short_reply_makes_the_next_ones_doubtful_and_no_more(pad: FakePad) -> None:
    report = Report()
    frames = taken(pad, report, {20: [b"\x05" * 255]})
    assert [f.index for f in frames if f.doubtful] == list(range(19, 28))
    assert report.counts["bad frames: short"] == 1


@pytest.mark.slow
@pytest.mark.parametrize("pause_s", [0.0, 0.01])
def test_a_byte_too_many_moves_no_cell_of_the_replies_that_follow(
    pad: FakePad, pause_s: float
) -> None:
    """One that comes much later than the rest is too late for the reply it is part of."""
    report = Report()
    long = [b"\x05" * 100 + b"\x55" + b"\x05" * 155, pause_s, b"\x05"]
    frames = taken(pad, report, {20: long})
    assert torn(frames) == ([] if pause_s == 0.0 else [19])
    assert not any(f.doubtful for f in frames)


@pytest.mark.slow
def test_a_late_reply_is_a_frame(pad: FakePad) -> None:
    """It was asked for, and nothing was asked since."""
    late = [0.29, bytes([5]) * 256]
    report = Report()
    frames = taken(pad, report, {20: late})
    assert torn(frames) == []
    assert np.unique(frames[19].image.values) == 5
    assert not any(f.gap or f.doubtful for f in frames)


def test_what_was_asked_for_before_is_no_reply(pad: FakePad) -> None:
    """A program that was killed had asked for a frame."""
    report = Report()
    frames = taken(pad, report, {1: [b"\x05" * 200, b"\x06" * 256]}, n_frames=3)
    assert torn(frames) == []
