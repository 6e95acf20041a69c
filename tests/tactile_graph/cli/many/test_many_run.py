"""``run --workers``: the file that one process writes, whatever becomes of the workers."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from helpers_many import command, ran, ran_here, surroundings, write_plugin
from tactile_graph import load
from tactile_graph.cli import cli
from tactile_graph.cli.many.unfinished import Unfinished
from tactile_graph.errors import UsageError

pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
DISCS = ("--source", "simulate", "--with", "scene=discs")
LATELY = """
pipeline: lately
about: Remembers a few frames, of those in which anything lies there
source: {step: sample}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  mean: {step: lately, in: frame, when: footprint.count > 8, with: {frames: 4}}
  counted: {step: deadly, in: frame}
outputs: [mean]
"""
ENDLESS = """
pipeline: endless
about: Counts for ever
source: {step: sample}
nodes:
  n: {step: counted, in: frame}
outputs: [n]
"""
unlike_windows = pytest.mark.skipif(sys.platform == "win32", reason="sends POSIX's signals")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return where a store lies, and a plugin is installed."""
    path = tmp_path_factory.mktemp("many")
    write_plugin(path)
    (path / "lately.yaml").write_text(LATELY)
    (path / "endless.yaml").write_text(ENDLESS)
    for name, seed in (("a.zarr", "1"), ("b.zarr", "2")):
        got = ran_here(path, "convert", name, *DISCS, "--with", "frames=700", "--seed", seed)
        assert got.returncode == 0, got.stderr
    write_arrays(path)
    return path


def write_arrays(folder: Path) -> None:
    """Write the frames of a store as arrays, as they are and with one of garbage."""
    frames = [*load("circle-1").with_source("recording", path=folder / "a.zarr").frames()]
    values = np.stack([frame.image.values for frame in frames])
    image = frames[0].image
    grid = {"pitch_cm": image.pitch_cm, "origin_cm": image.origin_cm, "quantity": image.quantity}
    np.savez(folder / "a.npz", values=values, **grid)  # type: ignore[arg-type]
    np.save(folder / "a.npy", values.astype(np.float32))
    raw = bytearray((folder / "a.npz").read_bytes())
    raw[len(raw) // 2] ^= 1
    (folder / "damaged.npz").write_bytes(raw)
    values[350] = 5.0 * np.random.default_rng(0).random(values.shape[1:])
    np.savez(folder / "garbage.npz", values=values, **grid)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def whole(folder: Path) -> bytes:
    """Return what one process writes of the recording that runs are killed over."""
    return written(folder, "whole.csv", "deadly.yaml", "a.zarr")[0]


def written(folder: Path, name: str, *words: str, here: bool = True) -> tuple[bytes, str]:
    """Return what a run wrote, and what it said; in a process of its own only where asked for."""
    got = (ran_here if here else ran)(folder, "run", *words, "-o", name)
    assert got.returncode == 0, got.stderr
    return (folder / name).read_bytes(), got.stderr


# -- the same file -----------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("words", [
    ("circle-1", "a.zarr", "b.zarr"),
    ("circle-1", *DISCS, "--frames", "300"),
    ("circle-1", "a.zarr", "--frames", "90:501"),
    ("lately.yaml", "a.zarr", "b.zarr", "--frames", "3:1200"),
    ("circle-1", "a.npz"),
    ("circle-1", "a.npy", "--with", "quantity=volt"),
    ("lately.yaml", "a.npz", "--frames", "3:600"),
    ("circle-1", "garbage.npz"),
    ("lately.yaml", "garbage.npz"),
], ids=["in place", "sent", "a span", "few remembered", "npz", "npy", "few remembered of npz",
        "garbage", "few remembered and garbage"])  # fmt: skip
@pytest.mark.parametrize("ending", [".csv", ".jsonl"])
def test_two_workers_write_what_one_process_does(
    folder: Path, words: tuple[str, ...], ending: str
) -> None:
    one, _ = written(folder, f"one{ending}", *words)
    two, _ = written(folder, f"two{ending}", *words, "--workers", "2")
    assert one == two
    meta = [json.loads((folder / f"{n}{ending}.meta.json").read_text()) for n in ("one", "two")]
    assert meta[0]["result"] == meta[1]["result"]
    counts = [m["source"]["counts"] for m in meta]
    in_store = "a.zarr" in words  # a span of it ends before the last frame is asked for
    assert counts[0]["frames"] == counts[1]["frames"] if in_store else counts[0] == counts[1]
    assert meta[0]["source"]["sha256"] == meta[1]["source"]["sha256"]


@pytest.fixture(scope="module")
def pressed(folder: Path) -> Path:
    """Return a recording long enough for blocks, of which few frames say more than their values.

    A disc comes and goes; one cell has no reading once.
    """
    k = np.arange(2600)
    row, column = np.mgrid[:16, :16]
    x, y = 7.5 + 2.0 * np.sin(k / 50.0), 7.5 + np.cos(k / 30.0)
    away = np.hypot(column - x[:, None, None], row - y[:, None, None])
    values = np.where(away < 4.3, 0.3, 0.0) * (k % 70 < 60)[:, None, None]
    values += 1e-4 * np.random.default_rng(0).random(values.shape)
    values[2200, 3, 3] = np.nan
    grid = {"pitch_cm": np.array((1.3, 1.3)), "origin_cm": np.zeros(2), "quantity": "volt"}
    np.savez(folder / "c.npz", values=values, time_s=0.02 * k, **grid)  # type: ignore[arg-type]
    got = ran_here(folder, "convert", "c.npz", "c.zarr")
    assert got.returncode == 0, got.stderr
    return folder / "c.npz"


@pytest.mark.slow
@pytest.mark.parametrize(("name", "ending"), [("c.npz", ".csv"), ("c.zarr", ".jsonl")])
def test_workers_run_blocks_as_one_process_does(
    folder: Path, pressed: Path, name: str, ending: str
) -> None:
    one, _ = written(folder, f"b1{ending}", "circle-3", name)
    two, _ = written(folder, f"b2{ending}", "circle-3", name, "--workers", "2")
    assert one == two
    assert one.count(b"skipped") > 300
    meta = [json.loads((folder / f"{n}{ending}.meta.json").read_text()) for n in ("b1", "b2")]
    assert meta[0]["result"] == meta[1]["result"]


@pytest.mark.slow
def test_parquet_holds_the_same_rows(folder: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="the 'parquet' extra is missing")
    for name, more in (("one.parquet", ()), ("two.parquet", ("--workers", "2"))):
        written(folder, name, "circle-1", "a.zarr", *more)
    one, two = (parquet.read_table(folder / n) for n in ("one.parquet", "two.parquet"))
    assert one.equals(two, check_metadata=True)


@pytest.mark.slow
def test_lines_go_to_stdout_as_they_come(folder: Path) -> None:
    words = ("run", "circle-1", "a.zarr", "--frames", "50", "-o", "-", "--format", "csv")
    assert ran(folder, *words).stdout == ran(folder, *words, "--workers", "2").stdout


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
def test_lines_go_to_a_named_pipe_as_they_come(folder: Path) -> None:
    pipe = folder / "pipe.jsonl"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    got = ran(folder, "run", "circle-1", *DISCS, "--frames", "9", "-o", pipe.name, "--workers", "2")
    assert (got.returncode, got.stdout) == (0, "")
    lines = os.read(reader, 1 << 16).splitlines()
    os.close(reader)
    assert [json.loads(line)["frame"] for line in lines] == [*range(9)]


@pytest.mark.slow
def test_no_frames_make_an_empty_file(folder: Path) -> None:
    words = ("circle-1", "--source", "simulate", "--with", "frames=0")
    assert written(folder, "e1.csv", *words)[0] == written(folder, "e2.csv", *words, "--workers",
                                                            "2")[0]  # fmt: skip


@pytest.mark.slow
def test_endless_state_goes_by_recording_or_in_one_process_and_is_told(folder: Path) -> None:
    _, said = written(folder, "n1.csv", "endless.yaml", "a.zarr", "--workers", "2")
    assert "in one process: n keeps state" in said
    both, said = written(folder, "n2.csv", "endless.yaml", "a.zarr", "b.zarr", "--workers", "2")
    assert "state starts anew with each" in said
    counts = [float(row.split(b",")[-1]) for row in both.splitlines()[1:]]
    assert counts == [*range(1, 701), *range(1, 701)]
    assert written(folder, "n3.csv", "endless.yaml", "a.zarr", "b.zarr")[0] == both


@pytest.mark.slow
def test_state_that_ends_reaches_back_to_no_recording_before(folder: Path) -> None:
    words = ("lately.yaml", "b.zarr", "a.zarr")
    one, _ = written(folder, "l1.csv", *words)
    assert written(folder, "l2.csv", *words, "--workers", "2")[0] == one


@pytest.mark.slow
@pytest.mark.parametrize("name", ["lately", "endless"])
def test_a_part_has_the_state_that_all_frames_before_it_left(folder: Path, name: str) -> None:
    words = (f"{name}.yaml", "a.zarr", "b.zarr")
    whole = written(folder, "p1.csv", *words)[0].splitlines()
    for more in ((), ("--workers", "2")):
        part, said = written(folder, "p2.csv", *words, "--frames", "400:900", *more)
        assert part.splitlines() == [whole[0], *whole[401:901]]
        assert not more or ("in one process" in said) == (name == "endless")


GUARDED = """
pipeline: guarded
about: Asks for nothing where less lies there than in the last few frames
nodes:
  mean: {step: lately, in: frame, with: {frames: 4}}
  image: {step: deadly, in: frame, when: mean > frame.image.total}
outputs: [image]
"""


@pytest.mark.slow
@pytest.mark.parametrize("more", [(), ("--workers", "2")], ids=["one process", "two workers"])
def test_a_part_of_an_audit_has_the_state_that_frames_before_it_left(
    folder: Path, more: tuple[str, ...]
) -> None:
    (folder / "guarded.yaml").write_text(GUARDED)

    def n_stopped(frames: str) -> int:
        words = ("guarded.yaml", "a.zarr", "--frames", frames, "--json", "g.json")
        got = ran_here(folder, "audit", *words, *more)
        assert got.returncode == 0, got.stderr
        assert "in one process" not in got.stderr
        return int(json.loads((folder / "g.json").read_text())["guards"][0]["n_stopped"])

    assert n_stopped("0:405") + n_stopped("405:600") == n_stopped("0:600")


@pytest.mark.slow
def test_state_and_garbage_go_in_one_process_and_are_told(folder: Path) -> None:
    """Where frames are left out, those behind have other places, and so has what is remembered."""
    words = ("lately.yaml", "garbage.npz")
    one, _ = written(folder, "g1.csv", *words)
    two, said = written(folder, "g2.csv", *words, "--workers", "2")
    assert one == two
    assert "in one process: steps keep state" in said
    assert "garbage.npz: frames of garbage left out\n" in said


@pytest.mark.slow
def test_a_damaged_archive_is_refused_as_by_one_process(folder: Path) -> None:
    words = ("run", "circle-1", "damaged.npz", "-o", "x.csv")
    one, two = ran_here(folder, *words), ran_here(folder, *words, "--workers", "2")
    assert "Bad CRC-32" in one.stderr
    assert (two.returncode, two.stderr) == (one.returncode, one.stderr)
    assert not [*folder.glob("*x.csv*")]


# -- what is refused ---------------------------------------------------------------------------


@pytest.mark.parametrize(("words", "told"), [
    (("--workers", "2"), "are for files: give -o FILE.jsonl"),
    (("--workers", "2", "-o", "a.csv", "--plot", "a.svg"), "workers draw nothing"),
    (("--workers", "0", "-o", "a.csv"), "'0': must be a whole number from 1 on, or auto"),
    (("--workers", "1.5", "-o", "a.csv"), "'1.5': must be a whole number from 1 on, or auto"),
    (("--workers", "many", "-o", "a.csv"), "'many': must be a whole number from 1 on, or auto"),
    (("--on", "nowhere", "-o", "a.csv"), "is no executor"),
    (("--resume", "-o", "-"), "what went to - is not known"),
])  # fmt: skip
def test_what_workers_have_no_place_for_is_refused(words: tuple[str, ...], told: str) -> None:
    got = CliRunner().invoke(cli, ["run", "circle-1", *words])
    assert got.exit_code == 2
    assert told in " ".join(got.output.split()) or told in str(got.exception)


# -- what becomes of workers and of the run ----------------------------------------------------


class Running:
    """A run in a process of its own."""

    def __init__(self, folder: Path, name: str, *more: str, recording: str = "a.zarr") -> None:
        self.folder, self.name = folder, name
        self.words = ("run", "deadly.yaml", recording, "--workers", "2", "-o", name, *more)
        self.process = subprocess.Popen(
            command(*self.words), cwd=folder, env=surroundings(folder), stderr=subprocess.PIPE,
            text=True, start_new_session=True,
        )  # fmt: skip

    def wait_until(self, so: Callable[[], bool]) -> None:
        until = time.monotonic() + 120.0
        while not so():
            assert self.process.poll() is None, self.process.stderr and self.process.stderr.read()
            assert time.monotonic() < until
            time.sleep(0.1)

    def keeps_something(self) -> bool:
        journal = self.folder / f".{self.name}.journal"
        return journal.exists() and journal.read_bytes().count(b"\n") > 3

    def workers(self) -> list[int]:
        """Return the processes that work for it."""
        listed = subprocess.run(
            ["ps", "-eo", "pid,ppid,sid"], capture_output=True, text=True, check=True
        ).stdout
        rows = [tuple(map(int, line.split())) for line in listed.splitlines()[1:]]
        own = self.process.pid
        first = {pid for pid, parent, _ in rows if parent == own}
        return [pid for pid, parent, _ in rows if parent in first]

    def session(self) -> list[int]:
        """Return all processes of it that are left."""
        listed = subprocess.run(
            ["ps", "-eo", "pid,sid,stat"], capture_output=True, text=True, check=True
        ).stdout
        rows = [line.split() for line in listed.splitlines()[1:]]
        return [int(p) for p, s, stat in rows if int(s) == self.process.pid and "Z" not in stat]

    def end(self) -> str:
        _, said = self.process.communicate(timeout=240)
        return said

    def all_gone(self) -> bool:
        until = time.monotonic() + 20.0
        while self.session() and time.monotonic() < until:
            time.sleep(0.1)
        return not self.session()


@pytest.mark.slow
@pytest.mark.parametrize("recording", ["a.zarr", "a.npz"])
def test_a_deadly_frame_is_told_and_left_out(folder: Path, recording: str) -> None:
    got = ran_here(folder, "run", "deadly.yaml", recording, "--frames", "200", "--workers", "2",
              "--set", "image.at=[150]", "-o", "d.csv")  # fmt: skip
    assert got.returncode == 1
    assert "frame 150: workers died of it each time: left out" in got.stderr
    whole, _ = written(folder, "whole-d.csv", "deadly.yaml", recording)
    rows = whole.splitlines(keepends=True)[:201]
    assert (folder / "d.csv").read_bytes() == b"".join(rows[:151] + rows[152:])


@pytest.mark.slow
@unlike_windows
def test_killed_workers_lose_nothing(folder: Path, whole: bytes) -> None:
    running = Running(folder, "k.csv", "--set", "image.slow_s=0.01")
    for _ in range(2):
        running.wait_until(lambda: len(running.workers()) == 2)
        time.sleep(0.5)
        os.kill(running.workers()[0], signal.SIGKILL)
        time.sleep(0.3)
    assert "700 frames" in running.end()
    assert (folder / "k.csv").read_bytes() == whole


def ended(folder: Path, name: str, setting: str) -> tuple[int, str]:
    """Return how a run ends of which a step ends the program, and what it says."""
    words = "run", "deadly.yaml", "a.zarr", "-o", name, "--workers", "2"
    got = ran_here(folder, *words, "--set", f"image.{setting}")
    assert not (folder / name).exists()
    return got.returncode, got.stderr


@pytest.mark.slow
def test_a_step_that_ends_the_program_is_told_and_what_was_done_is_kept(folder: Path) -> None:
    code, said = ended(folder, "exits.csv", "exits_at=300")
    assert code == 2
    assert "300 frames are kept: --resume goes on with exits.csv" in said
    assert re.search(r"SystemExit\('gives up'\), .*deadly\.py:\d+ in deadly", said)
    code, said = ended(folder, "stops.csv", "stops_at=0")
    assert (code, "kept" in said) == (130, False)


@pytest.mark.slow
def test_what_a_step_writes_as_c_does_is_kept_from_the_lines(folder: Path) -> None:
    got = ran(folder, "run", "deadly.yaml", "a.zarr", "-o", "-", "--frames", "0:4")
    assert [json.loads(line)["frame"] for line in got.stdout.splitlines()] == [0, 1, 2, 3]
    assert "as C does" in got.stderr


@pytest.mark.slow
@unlike_windows
@pytest.mark.parametrize(("number", "recording"), [
    (signal.SIGKILL, "a.zarr"), (signal.SIGINT, "a.zarr"), (signal.SIGTERM, "a.zarr"),
    (signal.SIGKILL, "a.npz"),
])  # fmt: skip
def test_an_ended_run_ends_its_workers_and_goes_on_with_resume(
    folder: Path, number: signal.Signals, recording: str
) -> None:
    name = f"{number.name}-{recording}.csv"
    whole, _ = written(folder, f"whole-{name}", "deadly.yaml", recording)
    running = Running(folder, name, "--set", "image.slow_s=0.005", recording=recording)
    running.wait_until(running.keeps_something)
    running.process.send_signal(number)
    said = running.end()
    assert running.all_gone()
    assert not (folder / name).exists()
    if number != signal.SIGKILL:
        assert running.process.returncode == 128 + number
        assert re.search(rf"\d+ frames are kept: --resume goes on with {name}", said)
    again = ran if number == signal.SIGINT else ran_here
    got = again(folder, *running.words, "--resume")
    assert "going on from frame" not in got.stdout
    assert "700 frames" in got.stderr, got.stderr
    assert (folder / name).read_bytes() == whole
    assert "is done already" in ran_here(folder, *running.words, "--resume").stderr


@pytest.mark.slow
@unlike_windows
def test_what_has_changed_since_is_not_gone_on_with(folder: Path) -> None:
    running = Running(folder, "c.csv", "--set", "image.slow_s=0.01")
    running.wait_until(running.keeps_something)
    running.process.send_signal(signal.SIGINT)
    running.end()
    got = ran(folder, *(w.replace("0.01", "0.0") for w in running.words), "--resume")
    assert got.returncode == 2
    assert "c.csv was begun with other content: the pipeline or its settings" in got.stderr


@pytest.mark.slow
@unlike_windows
def test_what_another_code_made_is_not_gone_on_with(folder: Path) -> None:
    running = Running(folder, "e.csv", "--set", "image.slow_s=0.01")
    running.wait_until(running.keeps_something)
    running.process.send_signal(signal.SIGKILL)
    running.end()
    code = folder / "deadly.py"
    before = code.read_text()
    code.write_text(before.replace("return frame.image\n", "return frame.image  # as before\n"))
    try:
        got = ran(folder, *running.words, "--resume")
    finally:
        code.write_text(before)
    assert got.returncode == 2
    assert "begun with other content: the code of the project or of a plugin" in got.stderr


@pytest.mark.slow
def test_what_a_killed_run_left_of_a_whole_file_is_taken(folder: Path) -> None:
    (folder / ".j.csv.joined.part").write_text("half of it")
    words = ("run", "circle-1", "a.zarr", "--frames", "30", "--workers", "1", "-o", "j.csv")
    assert ran_here(folder, *words).returncode == 0
    (folder / ".j.csv.parts").write_text("left")
    (folder / ".j.csv.journal").write_text("left")
    assert "is done already" in ran_here(folder, *words, "--resume").stderr
    assert [p.name for p in folder.glob(".j.csv*")] == []


@pytest.mark.slow
@pytest.mark.parametrize("source", [("a.zarr",), DISCS], ids=["in place", "sent"])
def test_a_short_run_is_answered_by_the_code_that_one_process_uses(
    folder: Path, source: tuple[str, ...]
) -> None:
    words = ("describe", *source, "--frames", "60")
    one, _ = written(folder, "one.csv", *words, here=False)
    two, _ = written(folder, "two.csv", *words, "--workers", "2", here=False)
    assert one == two


@pytest.mark.slow
def test_a_run_that_never_began_leaves_nothing(folder: Path) -> None:
    pytest.importorskip("distributed", reason="the 'cluster' extra is not installed")
    got = ran_here(folder, "run", "circle-1", "a.zarr", "-o", "x.csv", "--on", "tcp://127.0.0.1:9")
    assert got.returncode == 2
    assert "no scheduler answers there" in got.stderr
    assert [p.name for p in folder.iterdir() if "x.csv" in p.name] == []


@pytest.mark.slow
def test_frames_that_were_done_and_not_kept_are_told(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise UsageError("x.csv: cannot be written: No space left on device")

    monkeypatch.setattr(Unfinished, "add", full)
    got = ran_here(folder, "run", "circle-1", "a.zarr", "-o", "x.csv", "--workers", "1")
    assert got.returncode == 2
    assert "nothing of x.csv is kept\nerror: x.csv: cannot be written" in got.stderr
    assert [p.name for p in folder.iterdir() if "x.csv" in p.name] == []


@pytest.mark.slow
def test_short_runs_are_equal_to_the_last_bit_by_machine_code(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Plain code answers a kernel's first calls, wherever these are: some of its sums differ."""
    words = ("run", "describe", *DISCS, "--frames", "40")
    monkeypatch.setenv("TACTILE_GRAPH_KERNELS", "compiled")
    for name, workers in (("one.jsonl", ()), ("two.jsonl", ("--workers", "2"))):
        got = ran(tmp_path, *words, *workers, "-o", name)
        assert got.returncode == 0, got.stderr
    assert (tmp_path / "one.jsonl").read_bytes() == (tmp_path / "two.jsonl").read_bytes()
