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
    """By its length alone a rest and a beginning are a reply: no rest is left, so none is torn."""
    slow = {n: [bytes([n]) * 128, 0.5, bytes([n]) * 128] for n in range(10, 16)}
    report = Report()
    frames = taken(pad, report, slow)
    assert torn(frames) == []
    assert not any(f.gap or f.doubtful for f in frames)


@pytest.mark.slow
@pytest.mark.parametrize("longer_s", [0.9, 1.7])
def test_a_pad_that_pauses_in_each_reply_and_once_for_longer_stays_in_step(
    pad: FakePad, longer_s: float
) -> None:
    """Its pauses are longer than the silence that ends a reply."""
    halves = {n: [bytes([n]) * 128, 0.12, bytes([n]) * 128] for n in range(1, 16)}
    halves[4][1] = longer_s
    report = Report()
    frames = taken(pad, report, halves, n_frames=12)
    assert [np.unique(f.image.values).tolist() for f in frames] == [[n] for n in range(1, 13)]
    assert not any(f.gap or f.doubtful for f in frames)


@pytest.mark.slow
def test_the_rest_of_a_short_reply_is_waited_for_before_the_next_is_asked_for(pad: FakePad) -> None:
    report = Report()
    start = time.perf_counter()
    frames = taken(pad, report, {20: [b"\x05" * 255]})
    assert time.perf_counter() - start > 2.0
    assert [f.index for f in frames if f.gap] == [19]
    assert not any(f.doubtful for f in frames)
    assert report.counts["bad frames: short"] == 1
    assert not report.counts["timeouts"]


@pytest.mark.slow
def test_frames_of_a_line_that_is_never_silent_are_doubtful(
    pad: FakePad, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A rest that was waited for as long as it may may still come."""
    monkeypatch.setattr("tactile_graph_sources.devices.reader.LONGEST_SETTLING", 0.1)
    report = Report()
    frames = taken(pad, report, {5: [b"\x05" * 255]}, n_frames=8)
    assert [f.index for f in frames if f.doubtful] == [4, 5, 6, 7]
    assert report.counts["doubtful frames"] >= 4


@pytest.mark.slow
@pytest.mark.parametrize("pause_s", [0.0, 0.01])
def test_a_byte_too_many_moves_no_cell_of_the_replies_that_follow(
    pad: FakePad, pause_s: float
) -> None:
    """One that comes much later than the rest is too late for the reply it is part of."""
    report = Report()
    cells = b"\x05" * 100 + b"\x55" + b"\x05" * 155
    long = [cells, pause_s, b"\x05"] if pause_s else [cells + b"\x05"]
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
