"""``record`` a pad on a pseudo terminal into a store."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from helpers_serial import KITS, FakePad
from tactile_graph import Frame
from tactile_graph.cli import cli
from tactile_graph.wires import Circle, TrueObject
from tactile_graph_sources.commands import record
from tactile_graph_sources.devices.inbox import Inbox
from tactile_graph_sources.devices.port import Port
from tactile_graph_sources.devices.reader import Reader
from tactile_graph_sources.store import read_store
from tactile_graph_sources.writers.write_store import StoreWriter

pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
KIT = next(k for k in KITS if k.preset == "fsr-8x8")


@pytest.fixture
def pad(tmp_path: Path) -> Iterator[FakePad]:
    fake = FakePad(tmp_path / "tty")
    yield fake
    fake.unplug()


@pytest.fixture
def sends(monkeypatch: pytest.MonkeyPatch, pad: FakePad):
    """Return a function that has the pad send some bytes as soon as its port is open."""
    opened = threading.Event()
    real = Reader._open

    def open_and_tell(self: Reader) -> Port:
        port = real(self)
        opened.set()
        return port

    monkeypatch.setattr(Reader, "_open", open_and_tell)

    def send(data: bytes) -> None:
        opened.clear()
        threading.Thread(target=lambda: opened.wait(20.0) and pad.send(data)).start()

    return send


def encoded(n: int) -> tuple[list[np.ndarray], bytes]:
    rng = np.random.default_rng(0)
    pads = [KIT.pad(rng) for _ in range(n)]
    return pads, b"".join(KIT.encode(p, i) for i, p in enumerate(pads))


def run(pad: FakePad, target: Path, *args: object):
    fixed = [str(target), "--port", str(pad.link), "--preset", KIT.preset, "--give-up", "20"]
    return CliRunner().invoke(cli, ["record", *fixed, *map(str, args)])


def test_every_frame_is_recorded_and_gone_on_with(tmp_path: Path, pad: FakePad, sends) -> None:
    pads, data = encoded(30)
    target = tmp_path / "a.zarr"
    for more in ([], ["--append"]):
        sends(data)
        result = run(pad, target, "--frames", 30, "--pad", "bench", "--chunk", 8, *more)
        assert result.exit_code == 0, result.output
    assert "a.zarr: 60 frames" in result.output
    read = list(read_store(target))
    for i, frame in enumerate(read):
        np.testing.assert_array_equal(frame.image.values, pads[i % 30])
        assert frame.device_time_s == pytest.approx(2e-3 * (i % 30))
    assert [f.index for f in read if f.gap] == [30]


PRINTED = """preset: printed
transport: {baud: 115200}
framer: {kind: text}
geometry: {rows: 2, columns: 3, quantity: gram}
"""


def test_what_a_board_prints_is_recorded_as_it_is(tmp_path: Path, pad: FakePad, sends) -> None:
    preset, target = tmp_path / "printed.yaml", tmp_path / "a.zarr"
    preset.write_text(PRINTED)
    sends(b"0\n2.00,2.01,-2.02,nan,1e-3,5\r\n-1,-2,-3,-4,-5,-6\r\n1,2,3,4,5,6\r\n")
    words = ["--port", str(pad.link), "--preset", str(preset), "--give-up", "20"]
    result = recorded(target, *words, "--frames", 3)
    assert result.exit_code == 0, result.output
    first, second, third = (f.image for f in read_store(target))
    assert first.filled(-9.0).tolist() == [[2.0, 2.01, -2.02], [-9.0, 0.001, 5.0]]
    assert second.values.tolist() == [[-1.0, -2.0, -3.0], [-4.0, -5.0, -6.0]]
    assert third.valid is None or third.valid.all()
    assert first.quantity == "gram"


def test_ctrl_c_keeps_what_was_recorded(
    tmp_path: Path, pad: FakePad, sends, monkeypatch: pytest.MonkeyPatch
) -> None:
    _, data = encoded(10)
    real = StoreWriter.write

    def write(self: StoreWriter, frame) -> None:
        real(self, frame)
        if self.n_frames == 10:
            raise KeyboardInterrupt

    monkeypatch.setattr(StoreWriter, "write", write)
    sends(data)
    result = run(pad, tmp_path / "a.zarr")
    assert result.exit_code == 0
    assert "a.zarr: 10 frames" in result.output
    assert len(list(read_store(tmp_path / "a.zarr"))) == 10


@pytest.mark.slow
def test_a_pad_that_is_given_up_ends_the_recording_of_what_came(
    tmp_path: Path, pad: FakePad, sends
) -> None:
    _, data = encoded(5)
    sends(data)
    result = run(pad, tmp_path / "a.zarr", "--give-up", "0.5")
    assert result.exit_code == 0
    assert "a.zarr: 5 frames" in result.stdout
    assert "given up: " in result.stderr
    assert "no frame for 0.5 s" in result.stderr
    result = run(pad, tmp_path / "a.zarr", "--give-up", "0.5", "--append")
    assert result.exit_code == 2
    assert "no frame for 0.5 s" in result.stderr


@pytest.mark.slow
@pytest.mark.parametrize("more", [(), ("--append",)], ids=["new", "append"])
def test_what_sends_no_frame_is_not_done(
    tmp_path: Path, pad: FakePad, sends, more: tuple[str, ...]
) -> None:
    target = tmp_path / "a.zarr"
    if more:
        sends(encoded(5)[1])
        assert run(pad, target, "--frames", 5).exit_code == 0
    sends(np.random.default_rng(1).bytes(3000))
    result = run(pad, target, "--seconds", 0.5, *more)
    assert result.exit_code == 2
    assert "no frame came, and nothing was written" in result.stderr


def test_ctrl_c_before_a_frame_is_not_done(
    tmp_path: Path, pad: FakePad, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("tactile_graph_sources.commands.record._keep", interrupted)
    result = run(pad, tmp_path / "a.zarr")
    assert result.exit_code == 2
    assert "no frame came, and nothing was written" in result.stderr


def test_a_recording_that_is_there_is_not_overwritten(tmp_path: Path, pad: FakePad) -> None:
    (tmp_path / "a.zarr").mkdir()
    result = run(pad, tmp_path / "a.zarr")
    assert result.exit_code == 2
    assert "is there already" in result.output


@pytest.mark.parametrize(
    ("times", "n_kept", "told"), [(1, 30, []), (2, 4, ["not written: 26 frames that had come"])]
)
def test_ctrl_c_ends_the_reading_and_a_second_one_the_writing(
    tmp_path: Path,
    pad: FakePad,
    sends,
    monkeypatch: pytest.MonkeyPatch,
    times: int,
    n_kept: int,
    told: list[str],
) -> None:
    _, data = encoded(30)
    put, write = Inbox.put, StoreWriter.write
    come: list[object] = []
    all_came = threading.Event()

    def counted(self: Inbox, arrived) -> None:
        put(self, arrived := list(arrived))
        come.extend(arrived)
        if len(come) == 30:
            all_came.set()

    def slow(self: StoreWriter, frame: Frame) -> None:
        write(self, frame)
        assert all_came.wait(20.0)
        if 4 - times < self.n_frames <= 4:
            os.kill(os.getpid(), signal.SIGINT)

    monkeypatch.setattr(Inbox, "put", counted)
    monkeypatch.setattr(StoreWriter, "write", slow)
    sends(data)
    result = run(pad, tmp_path / "a.zarr", "--chunk", 2)
    assert result.exit_code == 0, result.output
    assert f"a.zarr: {n_kept} frames\n" in result.output
    assert [line.strip() for line in result.output.splitlines() if "not written" in line] == told
    assert [f.index for f in read_store(tmp_path / "a.zarr")] == list(range(n_kept))


def test_frames_that_pile_up_are_told_once(
    tmp_path: Path, pad: FakePad, sends, monkeypatch: pytest.MonkeyPatch
) -> None:
    _, data = encoded(30)
    monkeypatch.setattr(record, "BEHIND", 2)
    write = StoreWriter.write

    def slow(self: StoreWriter, frame: Frame) -> None:
        write(self, frame)
        time.sleep(0.002)

    monkeypatch.setattr(StoreWriter, "write", slow)
    sends(data)
    result = run(pad, tmp_path / "a.zarr", "--frames", 30)
    assert result.output.count("wait to be written; a larger --chunk is faster") == 1


def test_ctrl_c_before_there_is_a_store_says_so(
    tmp_path: Path, pad: FakePad, monkeypatch: pytest.MonkeyPatch
) -> None:
    def begin(self: StoreWriter, *_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(StoreWriter, "__init__", begin)
    result = run(pad, tmp_path / "a.zarr")
    assert (result.exit_code, result.output.strip()) == (130, "interrupted")
    assert not (tmp_path / "a.zarr").exists()


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP], ids=lambda s: s.name)
def test_a_shutdown_or_closed_terminal_keeps_what_was_recorded(
    tmp_path: Path, pad: FakePad, sends, monkeypatch: pytest.MonkeyPatch, number: signal.Signals
) -> None:
    _, data = encoded(10)
    real = StoreWriter.write

    def write(self: StoreWriter, frame) -> None:
        real(self, frame)
        if self.n_frames == 10:
            os.kill(os.getpid(), number)

    monkeypatch.setattr(StoreWriter, "write", write)
    before = signal.getsignal(number)
    sends(data)
    result = run(pad, tmp_path / "a.zarr")
    assert result.exit_code == 128 + number
    assert "a.zarr: 10 frames" in result.output
    assert f"ended by {number.name}" in result.output
    assert len(list(read_store(tmp_path / "a.zarr"))) == 10
    assert signal.getsignal(number) is before


def test_a_full_disc_is_told_with_the_store_and_what_is_in_it(
    tmp_path: Path, pad: FakePad, sends, monkeypatch: pytest.MonkeyPatch
) -> None:
    _, data = encoded(10)
    real = StoreWriter._write

    def write(self: StoreWriter, name: str, low: int, rows: object) -> None:
        if low >= 8:
            raise OSError(28, "No space left on device")
        real(self, name, low, rows)

    monkeypatch.setattr(StoreWriter, "_write", write)
    sends(data)
    result = run(pad, tmp_path / "a.zarr", "--chunk", 8, "--frames", 10)
    assert result.exit_code == 2
    assert "a.zarr: 8 frames\n" in result.output
    assert f"'record --append {tmp_path / 'a.zarr'}' goes on with it" in result.output
    assert "a.zarr: cannot be written: No space left on device" in result.output
    assert len(list(read_store(tmp_path / "a.zarr"))) == 8


def test_a_store_that_was_moved_away_leaves_nothing_in_its_place(
    tmp_path: Path, pad: FakePad, sends, monkeypatch: pytest.MonkeyPatch
) -> None:
    _, data = encoded(12)
    target, real = tmp_path / "a.zarr", StoreWriter.flush

    def flush(self: StoreWriter) -> None:
        if self.n_written and target.exists():
            target.rename(tmp_path / "b.zarr")
        real(self)

    monkeypatch.setattr(StoreWriter, "flush", flush)
    sends(data)
    result = run(pad, target, "--chunk", 8, "--frames", 12)
    assert result.exit_code == 2
    assert "goes on with it" not in result.output
    assert "a.zarr is gone: it was moved away" in result.output
    assert "4 frames after its first 8 are lost" in result.output
    assert [path.name for path in tmp_path.glob("*.zarr")] == ["b.zarr"]
    assert len(list(read_store(tmp_path / "b.zarr"))) == 8


def test_a_name_of_a_file_is_refused_before_the_port_is_opened(tmp_path: Path) -> None:
    args = ["record", "a.npz", "--port", "/dev/no", "--preset", KIT.preset]
    result = CliRunner().invoke(cli, args)
    assert result.exit_code == 2
    assert "TARGET a.npz: a recording is a Zarr store; record a.zarr, and" in result.output


def test_frames_of_another_pad_are_not_appended(tmp_path: Path, pad: FakePad, sends) -> None:
    frame = Frame.of(np.zeros((3, 2)), (1.3, 1.0), quantity="volt")
    with StoreWriter(tmp_path / "a.zarr") as store:
        store.write(frame)
    sends(encoded(1)[1])
    result = run(pad, tmp_path / "a.zarr", "--append")
    assert result.exit_code == 2
    told = "holds 3 x 2 cells of 1.3 x 1 cm from (0, 0) cm on, volt; this one is 8 x 8 cells of 1 x"
    assert told in result.output


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "pad_name", "told"),
    [
        (PRINTED, "", ""),
        (PRINTED.replace("115200", "9600"), "bench", ""),
        (PRINTED, "other", "is of another pad 'bench', this one is 'other'; choose another name"),
        (
            PRINTED.replace("gram", "gram, flip: rows"),
            "",
            "is of another preset with flip: none, this one has rows; choose another name",
        ),
        (PRINTED.replace("preset: p", "preset: re"), "", "with preset: printed, this one has re"),
    ],
)
def test_a_preset_or_pad_that_means_something_else_is_not_appended(
    tmp_path: Path, pad: FakePad, sends, text: str, pad_name: str, told: str
) -> None:
    preset, target = tmp_path / "printed.yaml", tmp_path / "a.zarr"
    words = ["--port", pad.link, "--preset", preset, "--give-up", 20, "--frames", 1]
    for now, name in ((PRINTED, "bench"), (text, pad_name)):
        preset.write_text(now)
        sends(b"0\n1,2,3,4,5,6\n1,2,3,4,5,6\n")
        result = recorded(target, *words, "--pad", name, "--append")
    assert result.exit_code == (2 if told else 0), result.output
    assert told in result.output
    assert len(list(read_store(target))) == (1 if told else 2)


def test_frames_of_any_source_are_recorded_with_their_truth(tmp_path: Path) -> None:
    args = ["record", str(tmp_path / "a.zarr"), "--source", "simulate", "--with", "scene=discs"]
    result = CliRunner().invoke(cli, [*args, "--frames", "3"])
    assert result.exit_code == 0, result.output
    assert result.output == f"{tmp_path / 'a.zarr'}: 3 frames\n"
    frames = list(read_store(tmp_path / "a.zarr"))
    assert len(frames) == 3
    assert all(f.truth for f in frames)


SIMULATED = ("--source", "simulate", "--with", "scene=discs")


def recorded(target: Path, *args: object):
    return CliRunner().invoke(cli, ["record", str(target), *map(str, args)])


@pytest.mark.parametrize(
    ("method", "n_kept"), [("_make", 1), ("_put", 3)], ids=["as it is made", "as it is closed"]
)
def test_ctrl_c_as_a_store_is_made_or_closed_loses_no_frame(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, method: str, n_kept: int
) -> None:
    real = getattr(StoreWriter, method)

    def interrupted(self: StoreWriter, *args: object) -> object:
        os.kill(os.getpid(), signal.SIGINT)
        return real(self, *args)

    monkeypatch.setattr(StoreWriter, method, interrupted)
    target = tmp_path / "a.zarr"
    result = recorded(target, *SIMULATED, "--frames", 3)
    assert result.exit_code == 0, result.output
    assert f"a.zarr: {n_kept} frame" in result.output
    assert len(list(read_store(target))) == n_kept


def test_a_signal_that_is_swallowed_on_its_way_ends_the_recording_at_the_next_frame(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = StoreWriter.write

    def write(self: StoreWriter, frame: Frame) -> None:
        real(self, frame)
        with contextlib.suppress(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGTERM)

    monkeypatch.setattr(StoreWriter, "write", write)
    result = recorded(tmp_path / "a.zarr", *SIMULATED, "--frames", 3)
    assert result.exit_code == 128 + signal.SIGTERM
    assert "a.zarr: 1 frame\n" in result.output


def test_what_does_not_fit_is_told_alone_and_of_no_port(tmp_path: Path) -> None:
    with StoreWriter(tmp_path / "a.zarr") as store:
        store.write(Frame.of(np.zeros((3, 2)), (1.3, 1.0), quantity="volt"))
    result = recorded(tmp_path / "a.zarr", *SIMULATED, "--frames", 3, "--append")
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")
    assert "a.zarr: holds 3 x 2 cells" in result.stderr
    assert len(result.stderr.splitlines()) == 1


def test_only_a_pad_is_said_to_have_sent_bytes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("tactile_graph_sources.commands.record._keep", interrupted)
    result = recorded(tmp_path / "a.zarr", *SIMULATED)
    assert result.stderr.endswith("a.zarr: no frame came, and nothing was written\n")


@pytest.mark.parametrize(
    ("args", "message"),
    [
        ([], "Missing option '--port' (or '--source')"),
        (["--port", "/dev/no"], "Missing option '--preset'"),
        (["--port", "/dev/no", "--source", "simulate"], "and not both"),
    ],
)
def test_a_pad_or_another_source_is_named(args: list[str], message: str, tmp_path: Path) -> None:
    result = CliRunner().invoke(cli, ["record", str(tmp_path / "a.zarr"), *args])
    assert result.exit_code == 2
    assert message in result.output


@pytest.mark.slow
def test_a_silent_pad_ends_in_time_and_is_told(tmp_path: Path, pad: FakePad) -> None:
    began = time.monotonic()
    result = run(pad, tmp_path / "a.zarr", "--seconds", "0.5")
    assert time.monotonic() - began < 30.0
    assert result.exit_code == 2
    assert "no frame came, and nothing was written" in result.output
    assert not (tmp_path / "a.zarr").exists()


@pytest.mark.slow
def test_what_a_port_tells_begins_with_the_time_of_day(tmp_path: Path, pad: FakePad) -> None:
    result = run(pad, tmp_path / "a.zarr", "--give-up", "2.5")
    assert re.search(r"^\d\d:\d\d:\d\d  \S+tty: stalled: nothing came", result.output, re.M)


def test_frames_with_a_true_shape_of_a_plugins_own_are_kept_without_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Stroke(Circle):
        pass

    frame = Frame.of(np.ones((2, 2)), truth=(TrueObject(Stroke(1.0, 2.0, 3.0)),))
    monkeypatch.setattr("tactile_graph_sources.commands.record._frames", lambda *_: iter([frame]))
    result = CliRunner().invoke(cli, ["record", str(tmp_path / "a.zarr"), "--source", "simulate"])
    assert result.exit_code == 0
    assert result.output.endswith("  left out: truth of plugins' own shapes (Stroke)\n")
    assert [f.truth for f in read_store(tmp_path / "a.zarr")] == [None]
