"""The live source, end to end over a pseudo terminal."""

from __future__ import annotations

import socket
import threading
import time
import tracemalloc
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_cli import call
from helpers_serial import KITS, FakePad, Kit
from tactile_graph import Frame, loads
from tactile_graph.errors import DataError, UsageError
from tactile_graph.steps.injected import Report
from tactile_graph_sources.devices.port import Port
from tactile_graph_sources.devices.reader import Reader
from tactile_graph_sources.serial_port import serial

BY_NAME = {k.preset: k for k in KITS}
FLEXITAC = BY_NAME["flexitac-12x32"]
HELD = FLEXITAC.followers
RATE_HZ = 500


@pytest.fixture
def pad(tmp_path: Path) -> Iterator[FakePad]:
    fake = FakePad(tmp_path / "tty")
    yield fake
    fake.unplug()


def encoded(kit: Kit, n: int) -> list[bytes]:
    """Return frames whose first cell is their number."""
    rng = np.random.default_rng(0)
    pads = [kit.pad(rng) for _ in range(n)]
    for i, p in enumerate(pads):
        p[0, 0] = kit.low + i % 200
    return [kit.encode(p, i) for i, p in enumerate(pads)]


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> threading.Event:
    """Return what is set when the port is open: opening flushes whatever was sent before."""
    event = threading.Event()
    real = Reader._open

    def open_and_tell(self: Reader) -> Port:
        port = real(self)
        event.set()
        return port

    monkeypatch.setattr(Reader, "_open", open_and_tell)
    return event


@contextmanager
def played(opened: threading.Event, play: Callable[[], None]) -> Iterator[None]:
    """Play the pad's part in another thread, from the moment the port is open."""

    def run() -> None:
        assert opened.wait(20.0)
        play()

    player = threading.Thread(target=run)
    player.start()
    try:
        yield
    finally:
        player.join(30.0)
        assert not player.is_alive()


def source_of(fake: FakePad, preset: str, report: Report, **settings: Any) -> Generator[Frame]:
    settings = {"give_up_s": 20.0} | settings
    frames = serial(port=str(fake.link), preset=preset, report=report, **settings)
    assert isinstance(frames, Generator)
    return frames


def stream(pad: FakePad, frames: list[bytes]) -> None:
    start = time.monotonic()
    for i, frame in enumerate(frames):
        time.sleep(max(0.0, start + i / RATE_HZ - time.monotonic()))
        pad.send(frame)


@pytest.mark.slow
def test_500_frames_a_second_unplugged_and_replugged(pad: FakePad, opened: threading.Event) -> None:
    """All frames of both halves come, in order, one gap is marked, memory stays flat."""
    n = 500
    frames = encoded(FLEXITAC, n)
    report = Report()
    source = source_of(pad, FLEXITAC.preset, report)
    half_seen = threading.Event()

    def play() -> None:
        stream(pad, frames)
        assert half_seen.wait(20.0)
        opened.clear()
        pad.unplug()
        pad.plug_in()
        assert opened.wait(20.0)
        stream(pad, frames)

    got: list[tuple[int, bool, float]] = []
    memory = []
    with played(opened, play):
        tracemalloc.start()
        for frame in source:
            assert frame.time_s is not None
            got.append((int(frame.image.values[0, 0]), frame.gap, frame.time_s))
            if len(got) in (100, 900):
                memory.append(tracemalloc.get_traced_memory()[0])
            if len(got) == n - HELD:  # the last ones wait for the headers after them
                half_seen.set()
            if len(got) == 2 * (n - HELD):
                break
        tracemalloc.stop()
    source.close()
    assert [value for value, _, _ in got] == [i % 200 for i in range(n - HELD)] * 2
    assert [i for i, (_, gap, _) in enumerate(got) if gap] == [n - HELD]
    times = [t for _, _, t in got]
    assert times == sorted(times)
    assert memory[1] - memory[0] < 400_000
    assert report.counts["good frames"] == 2 * (n - HELD)
    assert report.counts["reconnects"] == 1
    assert report.counts["bytes"] == 2 * sum(map(len, frames))
    assert not any(name.startswith("bad frames") for name in report.counts)
    assert [what.split()[0] for _, what in report.troubles] == ["lost", "back"]


@pytest.mark.slow
def test_frames_that_came_in_time_are_given_however_late_they_are_taken(
    pad: FakePad, opened: threading.Event
) -> None:
    """A pipeline that compiles for seconds at its first frame loses none of those after it."""
    frames = encoded(FLEXITAC, 30)
    source = source_of(pad, FLEXITAC.preset, Report(), seconds=0.2)
    sent = threading.Event()

    def play() -> None:
        pad.send(b"".join(frames))
        sent.set()

    with played(opened, play):
        first = next(source)
        assert sent.wait(20.0)
        time.sleep(0.3)
        rest = list(source)
    values = [int(f.image.values[0, 0]) for f in (first, *rest)]
    assert values == list(range(30 - HELD))


def test_a_slow_viewer_gets_the_newest_frame(pad: FakePad, opened: threading.Event) -> None:
    report = Report()
    source = source_of(pad, FLEXITAC.preset, report, newest=True)
    frames = encoded(FLEXITAC, 100)
    first, sent = threading.Event(), threading.Event()

    def play() -> None:
        pad.send(b"".join(frames[:8]))
        assert first.wait(20.0)
        pad.send(b"".join(frames[8:]))
        sent.set()

    with played(opened, play):
        seen = [next(source)]
        first.set()
        assert sent.wait(20.0)
        while int(seen[-1].image.values[0, 0]) < 97:
            seen.append(next(source))
    source.close()
    assert len(seen) + report.counts["dropped frames"] == 98
    assert report.counts["dropped frames"] > 0
    assert not any(f.gap for f in seen)


@pytest.mark.parametrize("name", ["fsrray", "itas", "pressure-mat-28x56"])
def test_a_pad_that_is_asked_answers(pad: FakePad, opened: threading.Event, name: str) -> None:
    """Boot text comes first; one reply is short and never goes on."""
    kit = BY_NAME[name]
    frames = encoded(kit, 16)
    frames[4] = frames[4][:-9]
    report = Report()
    # A fast line, so that a reply that does not come is not waited for long.
    source = source_of(pad, name, report, n_frames=5, baud=2_000_000)
    done = threading.Event()
    question = {"fsrray": b"\x10", "itas": b"A", "pressure-mat-28x56": b"start_reading\n"}[name]
    asked = []

    def play() -> None:
        pad.send(kit.junk)
        for frame in frames:
            asked.append(pad.asked(len(question), done))
            if not asked[-1]:
                return
            pad.send(frame)

    with played(opened, play):
        got = list(source)
        done.set()
    assert set(asked) <= {question, b""}
    values = [int(f.image.values[0, 0]) - kit.low for f in got]
    assert values == sorted(values)
    assert 4 not in values
    assert [f.gap for f in got].count(True) == 1
    assert report.n_expected == 5


def test_the_device_time_stands_beside_the_hosts(
    pad: FakePad, opened: threading.Event, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(time, "monotonic", lambda: 0.0)  # goes on by 16 ms at once on Windows
    kit = BY_NAME["fsr-8x8"]
    source = source_of(pad, kit.preset, Report(), n_frames=3)
    before = time.perf_counter()
    with played(opened, lambda: pad.send(b"".join(encoded(kit, 3)))):
        got = list(source)
    assert [f.device_time_s for f in got] == pytest.approx([0.0, 2e-3, 4e-3])
    assert all(f.time_s is not None and before <= f.time_s <= time.perf_counter() for f in got)
    assert [f.index for f in got] == [0, 1, 2]
    assert {f.image.quantity for f in got} == {"counts"}


@pytest.mark.slow
def test_a_link_without_frames_is_stalled_and_says_why(
    pad: FakePad, opened: threading.Event
) -> None:
    big = BY_NAME["flexitac-16x32"]
    report = Report()
    source = source_of(pad, FLEXITAC.preset, report, timeout_s=0.5, give_up_s=1.5)
    with (
        played(opened, lambda: pad.send(b"".join(encoded(big, 6)))),
        pytest.raises(DataError, match=r"tty: no frame for 1.5 s \(stalled\)"),
    ):
        next(source)
    ((where, what),) = report.troubles
    assert where == str(pad.link)
    assert "baud rate 2000000, the size 12 x 32, the kit 'flexitac-12x32'" in what
    assert "headers come every 514 bytes, the preset expects 386" in what
    assert report.counts["timeouts"] >= 1


@pytest.mark.slow
def test_silence_is_stalled_too(pad: FakePad) -> None:
    report = Report()
    source = source_of(pad, "m1616", report, timeout_s=0.2, give_up_s=0.6)
    with pytest.raises(DataError, match=r"no frame for 0.6 s"):
        next(source)
    assert "nothing came for 0.2 s; is it the right port" in report.troubles[0][1]


def test_it_waits_no_longer_once_no_frame_is_wanted(pad: FakePad) -> None:
    report = Report()
    report.wanted = False
    assert list(source_of(pad, "m1616", report)) == []


def test_a_port_that_is_not_there_is_named() -> None:
    with pytest.raises(UsageError, match=r"port '/dev/no-such' cannot be opened: .*ports here: "):
        next(serial(port="/dev/no-such", preset="m1616", report=Report()))


def test_a_port_someone_else_reads_is_refused(pad: FakePad, opened: threading.Event) -> None:
    """Two readers would each get half of the bytes."""
    kit = BY_NAME["m1616"]
    first = source_of(pad, "m1616", Report())
    with played(opened, lambda: pad.send(b"".join(encoded(kit, 8)))):
        next(first)
        with pytest.raises(UsageError, match="cannot be opened"):
            next(source_of(pad, "m1616", Report()))
    first.close()


def test_closing_ends_the_thread_and_frees_the_port(pad: FakePad, opened: threading.Event) -> None:
    for _ in range(2):
        opened.clear()
        source = source_of(pad, FLEXITAC.preset, Report())
        with played(opened, lambda: pad.send(b"".join(encoded(FLEXITAC, 8)))):
            next(source)
        source.close()
        assert not [t for t in threading.enumerate() if t.name.startswith("serial")]


def test_a_pad_that_must_be_started_is_asked_again_when_it_missed_it(
    pad: FakePad, opened: threading.Event, tmp_path: Path
) -> None:
    preset = tmp_path / "mine.yaml"
    preset.write_text(
        "preset: mine\nextends: flexitac-12x32\nrequest: {send: 'text:go', when: start}\n"
    )
    asked = []
    never = threading.Event()

    def play() -> None:
        asked.append(pad.asked(2, never))  # as if still starting: no answer
        asked.append(pad.asked(2, never))
        pad.send(b"".join(encoded(FLEXITAC, 8)))

    source = source_of(pad, str(preset), Report(), timeout_s=0.2, n_frames=2)
    with played(opened, play):
        assert len(list(source)) == 2
    assert asked == [b"go", b"go"]


@pytest.mark.slow
def test_a_socket_is_a_port_too(opened: threading.Event) -> None:
    """Its in_waiting is 0 or 1, however much has come."""
    frames = encoded(FLEXITAC, 200)
    report = Report()
    with socket.create_server(("127.0.0.1", 0)) as server:
        url = f"socket://127.0.0.1:{server.getsockname()[1]}"

        def play() -> None:
            connection, _ = server.accept()
            with connection:
                connection.sendall(b"".join(frames))
                assert done.wait(20.0)

        done = threading.Event()
        with played(opened, play):
            got = list(
                serial(
                    port=url, preset=FLEXITAC.preset, n_frames=198, give_up_s=20.0, report=report
                )
            )
            done.set()
    assert [int(f.image.values[0, 0]) for f in got] == [i % 200 for i in range(198)]


CIRCLE_OF_COUNTS = """
pipeline: live-circle
nodes:
  footprint: {step: threshold, in: frame, with: {level: 60}}
  fine: {step: subdivide, in: footprint, with: {factor: 2}}
  eroded: {step: erode, in: fine, with: {element: disc5}}
  dilated: {step: dilate, in: eroded, with: {element: disc5}}
  boundary: {step: boundary_scan, in: dilated}
  hull: {step: hull, in: boundary}
  circle: {step: fit_circle, in: hull, when: footprint.count > 0}
outputs: [circle]
"""


@pytest.mark.slow
def test_circle_3_follows_a_disc_on_a_live_pad_through_an_unplugging(
    pad: FakePad, opened: threading.Event
) -> None:
    """500 frames a second of FlexiTac through circle-3's steps: the disc, the gap, the counters."""
    n, rows, columns = 250, 12, 32
    y, x = np.mgrid[:rows, :columns] + 0.5
    centres = [8.0 + 16.0 * i / n for i in range(n)]
    discs = [np.where(np.hypot(x - c, y - 6.0) < 4.0, 120, 3).astype(np.uint8) for c in centres]
    frames = [FLEXITAC.encode(d, i) for i, d in enumerate(discs)]
    report = Report()
    source = source_of(pad, FLEXITAC.preset, report)
    half_seen = threading.Event()

    def play() -> None:
        stream(pad, frames)
        assert half_seen.wait(30.0)
        opened.clear()
        pad.unplug()
        pad.plug_in()
        assert opened.wait(20.0)
        stream(pad, frames)

    results = []
    with played(opened, play):
        for result in loads(CIRCLE_OF_COUNTS).stream(source):
            results.append(result)
            if len(results) == n - HELD:
                half_seen.set()
            if len(results) == 2 * (n - HELD):
                break
    source.close()
    assert all(r.ok for r in results)
    pitch = results[0].frame.image.pitch_cm[0]
    found = np.array([r["circle"].x_cm / pitch for r in results])
    assert np.abs(found - np.array([*centres[:-HELD], *centres[:-HELD]])).max() < 0.6
    assert [i for i, r in enumerate(results) if r.frame.gap] == [n - HELD]
    assert report.counts["good frames"] == 2 * (n - HELD)
    assert report.counts["reconnects"] == 1


@pytest.mark.slow
def test_a_run_on_a_pad_that_sends_no_frame_is_not_done(
    tmp_path: Path, pad: FakePad, opened: threading.Event
) -> None:
    """As `record` ends, too."""
    out = tmp_path / "out.csv"
    words = [f"port={pad.link}", "preset=fsr-8x8", "seconds=0.5", "n_frames=3"]
    source = ["--source", "serial", *(w for word in words for w in ("--with", word))]
    with played(opened, lambda: pad.send(b"ready\n")):
        result = call("run", "contacts", *source, "-o", out)
    assert result.exit_code == 2
    told = "source 'serial': no frame came, and nothing was written (6 bytes, 6 discarded bytes)"
    assert told in result.stderr
    assert not out.exists()
