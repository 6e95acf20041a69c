"""What commands write: whole lines on a full disc, nothing beside a pipe, refusals beforehand."""

from __future__ import annotations

import errno
import gc
import inspect
import json
import os
import resource
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from io import FileIO
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from helpers_cli import call, install
from tactile_graph import Image, provenance
from tactile_graph.cli import cli
from tactile_graph.cli.commands import run
from tactile_graph.cli.endings import words
from tactile_graph.cli.output.writers import JsonLines, LineFile
from tactile_graph.errors import UsageError
from tactile_graph.files import said

pytestmark = pytest.mark.usefixtures("hand_made")


@contextmanager
def full_at(n_bytes: int) -> Iterator[None]:
    """Let no file be larger, as if the disc were full then.

    Python would cut short what it keeps of a module imported meanwhile, without a word.
    """
    gc.collect()  # files that other tests left open are closed while there is room
    writes = sys.dont_write_bytecode
    sys.dont_write_bytecode = True
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (n_bytes, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        sys.dont_write_bytecode = writes


def test_a_full_disc_ends_a_run_with_whole_lines_and_says_how_many(tmp_path: Path) -> None:
    with full_at(4096):
        got = call("run", "discs", "--frames", 100, "-o", "out.jsonl")
    lines = (tmp_path / "out.jsonl").read_text().splitlines(keepends=True)
    assert got.exit_code == 2
    assert all(line.endswith("\n") and json.loads(line) for line in lines)
    n = len(lines)
    kept = f"the first {n} frames are in it, and no part of another"
    assert f"error: out.jsonl: cannot be written: File too large; {kept}\n" in got.stderr
    assert "wrote" not in got.stderr
    assert "the source ended" not in got.stderr
    note = json.loads((tmp_path / "out.jsonl.meta.json").read_text())
    assert (note["complete"], note["result"]["frames"]) == (False, n)


def test_an_older_file_stays_on_a_full_disc_and_is_told(tmp_path: Path) -> None:
    (tmp_path / "out.jsonl").write_text("older\n")
    with full_at(4096):
        got = call("run", "discs", "--frames", 100, "-o", "out.jsonl")
    assert "error: out.unfinished.jsonl: cannot be written: File too large" in got.stderr
    assert got.stderr.endswith("and no part of another; the older out.jsonl stays\n")
    assert (tmp_path / "out.jsonl").read_text() == "older\n"


def test_a_note_that_has_no_room_either_hides_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    n_written = 0
    write = provenance.write_whole

    def full(name: Path, content: str) -> None:
        nonlocal n_written
        n_written += 1
        with said(name):
            if n_written > 1:
                raise OSError(errno.ENOSPC, "No space left on device")
        write(name, content)

    monkeypatch.setattr(provenance, "write_whole", full)
    with full_at(4096):
        got = call("run", "discs", "--frames", 100, "-o", "out.jsonl")
    n = (tmp_path / "out.jsonl").read_text().count("\n")
    note = "out.jsonl.meta.json: cannot be written: No space left on device"
    assert got.exit_code == 2
    assert f"error: out.jsonl: cannot be written: File too large; the first {n} " in got.stderr
    assert f"{note}: what it says is of the first frame\n" in got.stderr
    assert f"{n} frames in " in got.stderr
    n_written = 0
    got = call("run", "discs", "-o", "out.jsonl")
    assert got.exit_code == 2
    assert "wrote out.jsonl\n" in got.stderr
    assert got.stderr.endswith(f"error: {note}\n")


@pytest.mark.parametrize("older", ["", "older\n"])
def test_a_note_that_has_no_room_from_the_start_leaves_one_frame_and_that_is_told(
    tmp_path: Path, older: str
) -> None:
    if older:
        (tmp_path / "out.jsonl").write_text(older)
    with full_at(1000):
        got = call("run", "discs", "-o", "out.jsonl")
    name, stays = (
        ("out.unfinished.jsonl", "; the older out.jsonl stays") if older else ("out.jsonl", "")
    )
    assert got.exit_code == 2
    assert f"wrote {name}; only the first frame is in it{stays}\n" in got.stderr
    assert got.stderr.endswith(f"error: {name}.meta.json: cannot be written: File too large\n")
    assert (tmp_path / name).read_text().count("\n") == 1


@pytest.mark.slow
@pytest.mark.parametrize(("name", "library"), [("out.parquet", "pyarrow"), ("out.zarr", "zarr")])
def test_what_stands_only_when_it_is_whole_leaves_no_note_of_what_is_not_there(
    tmp_path: Path, name: str, library: str
) -> None:
    pytest.importorskip(library)
    only = () if library == "pyarrow" else ("--only", "footprint")
    before = set(os.listdir(tmp_path))
    with full_at(100):
        got = call("run", "discs", "--frames", 100, "-o", name, *only)
    assert got.exit_code == 2
    assert f"{name}: cannot be written: File too large; nothing of it is kept\n" in got.stderr
    assert set(os.listdir(tmp_path)) == before
    assert call("run", "discs", "-o", name, *only).exit_code == 0
    note = (tmp_path / f"{name}.meta.json").read_text()
    with full_at(100):
        got = call("run", "discs", "--frames", 100, "-o", name, *only)
    assert "File too large; the older one stays\n" in got.stderr
    assert (tmp_path / f"{name}.meta.json").read_text() == note


def interrupted_at(frame: int, monkeypatch: pytest.MonkeyPatch) -> None:
    real = run._Run._results

    def results(self: run._Run) -> Iterator[object]:
        for k, result in enumerate(real(self)):
            if k == frame:
                signal.raise_signal(signal.SIGINT)
            yield result

    monkeypatch.setattr(run._Run, "_results", results)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("ending", "library"),
    [("csv", ""), ("jsonl", ""), ("parquet", "pyarrow"), ("h5", "h5py"), ("zarr", "zarr")],
)
def test_an_older_whole_output_stays_where_a_run_ends_early(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ending: str, library: str
) -> None:
    if library:
        pytest.importorskip(library)
    name, beside = f"out.{ending}", f"out.unfinished.{ending}"
    words = ("run", "discs", "-o", name, *(("--only", "footprint") if ending in "h5zarr" else ()))

    def content() -> dict[Path, bytes]:
        return {p: p.read_bytes() for p in sorted(tmp_path.rglob(f"{name}*/**/*")) if p.is_file()}

    assert call(*words).exit_code == 0
    before = content()
    with monkeypatch.context() as patched:
        interrupted_at(2, patched)
        got = call(*words)
    assert got.exit_code == 130
    assert f"wrote {beside}; the older {name} stays\n" in got.stderr
    assert content() == before
    note = json.loads((tmp_path / f"{beside}.meta.json").read_text())
    assert (note["complete"], note["result"]["frames"]) == (False, 2)
    assert (tmp_path / beside).exists()
    assert call(*words).exit_code == 0
    assert json.loads((tmp_path / f"{name}.meta.json").read_text())["complete"] is True


def test_what_a_run_that_ended_early_wrote_is_replaced_by_the_next(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    interrupted_at(2, monkeypatch)
    call("run", "discs", "-o", "out.csv")
    interrupted_at(1, monkeypatch)
    assert "wrote out.csv\n" in call("run", "discs", "-o", "out.csv").stderr
    assert len((tmp_path / "out.csv").read_text().splitlines()) == 2
    assert not (tmp_path / "out.unfinished.csv").exists()


def test_frames_that_ctrl_c_alone_ends_replace_an_older_output(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "out.csv").write_text("older\n")
    monkeypatch.setattr("tactile_graph.cli.many.made_of.device", lambda pipeline: "a port")
    interrupted_at(2, monkeypatch)
    assert "wrote out.csv\n" in call("run", "discs", "-o", "out.csv").stderr
    assert len((tmp_path / "out.csv").read_text().splitlines()) == 3


def test_an_older_output_stays_whole_until_the_next_is(tmp_path: Path) -> None:
    (tmp_path / "out.csv").write_text("older\n")
    (tmp_path / "out.csv").chmod(0o640)
    writer = LineFile("out.csv", JsonLines())
    writer.open().write(b"newer\n")
    assert (tmp_path / "out.csv").read_text() == "older\n"
    with pytest.raises(UsageError, match="another run is writing it"):
        LineFile("out.csv", JsonLines()).open()
    writer.close()
    assert (tmp_path / "out.csv").read_text() == "newer\n"
    assert (tmp_path / "out.csv").stat().st_mode & 0o777 == 0o640
    assert not (tmp_path / "out.unfinished.csv").exists()


class Interrupted(FileIO):
    """A file of which Ctrl-C comes within each line that begins with n."""

    def write(self, data: Any) -> int:
        if data[:1] == b"n":
            super().write(data[:2])
            raise KeyboardInterrupt
        return super().write(data)


def test_a_line_that_is_interrupted_is_not_in_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        "tactile_graph.cli.output.writers.opened_alone", lambda name: Interrupted(name, "w")
    )
    writer = LineFile("out.csv", JsonLines())
    writer._put(writer.open(), "first\n")
    with pytest.raises(KeyboardInterrupt):
        writer._put(writer.open(), "next\n")
    writer.close()
    assert (tmp_path / "out.csv").read_text() == "first\n"


def test_an_interrupted_line_takes_nothing_from_what_stdout_held_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "log.jsonl").write_text("earlier\n")
    monkeypatch.setattr(
        "tactile_graph.cli.output.writers._stdout_for_itself",
        lambda: (Interrupted("log.jsonl", "a"), True),
    )
    writer = LineFile("-", JsonLines())
    writer._put(writer.open(), "first\n")
    with pytest.raises(KeyboardInterrupt):
        writer._put(writer.open(), "next\n")
    writer.close()
    assert (tmp_path / "log.jsonl").read_text() == "earlier\nfirst\nne"


def test_an_older_output_that_cannot_be_replaced_is_written_into(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As another person's file in a folder for all, or one that a program has open on Windows."""

    def refused(*paths: object) -> None:
        raise PermissionError(errno.EPERM, "Operation not permitted")

    (tmp_path / "out.csv").write_text("older, and longer\n")
    before = (tmp_path / "out.csv").stat().st_ino
    writer = LineFile("out.csv", JsonLines())
    writer.open().write(b"newer\n")
    monkeypatch.setattr(os, "replace", refused)
    monkeypatch.setattr(os, "chmod", refused)
    writer.close()
    assert (tmp_path / "out.csv").read_text() == "newer\n"
    assert (tmp_path / "out.csv").stat().st_ino == before
    assert not (tmp_path / "out.unfinished.csv").exists()


@pytest.mark.slow
@pytest.mark.parametrize(("ending", "library"), [("parquet", "pyarrow"), ("h5", "h5py")])
def test_no_kind_of_output_is_thrown_away_where_the_older_one_cannot_be_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ending: str, library: str
) -> None:
    pytest.importorskip(library)

    def refused(*paths: object) -> None:
        raise PermissionError(errno.EACCES, "Access is denied")

    name = f"out.{ending}"
    words = ("run", "discs", "-o", name, *(("--only", "footprint") if ending == "h5" else ()))
    (tmp_path / name).write_text("older")
    monkeypatch.setattr(os, "replace", refused)
    assert call(*words).exit_code == 0
    assert (tmp_path / name).stat().st_size > 500
    assert [p for p in tmp_path.iterdir() if "part" in p.name or "new" in p.name] == []


def test_who_reads_stdout_to_its_end_waits_for_no_run_that_is_done(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    before = os.listdir("/proc/self/fd") if os.path.isdir("/proc/self/fd") else []
    writer = LineFile("-", JsonLines())
    writer.open().write(b"line\n")
    writer.close()
    assert not before or len(os.listdir("/proc/self/fd")) == len(before)
    sys.stdout.write("more\n")
    assert capfd.readouterr().out == "line\nmore\n"


@pytest.mark.parametrize(
    "command",
    [("schema", "-o", "out"), ("graph", "discs", "--format", "svg", "-o", "out")],
    ids=lambda c: c[0],
)
def test_a_full_disc_leaves_no_half_file(tmp_path: Path, command: tuple[str, ...]) -> None:
    before = set(os.listdir(tmp_path))
    with full_at(1000):
        got = call(*command)
    assert got.exit_code == 2
    assert "error: out: cannot be written: File too large\n" in got.stderr
    assert set(os.listdir(tmp_path)) == before


def test_nothing_is_written_beside_a_pipe(tmp_path: Path) -> None:
    os.mkfifo("pipe")
    got: list[str] = []
    reader = threading.Thread(target=lambda: got.append(Path("pipe").read_text()))
    reader.start()
    assert call("run", "discs", "-o", "pipe", "--format", "csv").exit_code == 0
    reader.join(10.0)
    assert got[0].count("\n") == 5
    assert not (tmp_path / "pipe.meta.json").exists()


@pytest.mark.parametrize(
    "command",
    [
        ("run", "discs", "-o", "out.csv"),
        ("run", "discs", "--plot", "out.png"),
        ("graph", "discs", "-o", "out.svg"),
        ("schema", "-o", "out.json"),
    ],
    ids=" ".join,
)
def test_a_folder_that_may_not_be_written_is_refused_before_the_work(
    command: tuple[str, ...], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(os, "access", lambda *_: False)  # root may write anywhere
    got = call(*command)
    assert got.exit_code == 2
    assert got.stdout == ""
    assert f"error: {command[-2]} {command[-1]}: no permission to write in" in got.stderr


def test_a_name_that_leaves_no_room_for_the_note_is_refused_before_the_work(tmp_path: Path) -> None:
    fits = f"{'o' * 228}.unfinished.jsonl"
    assert call("run", "discs", "-o", fits).exit_code == 0
    for name in (f"o{fits}", f"{'o' * 250}.jsonl"):  # the latter leaves no room for itself
        got = call("run", "discs", "-o", name)
        assert got.exit_code == 2
        told = f"error: -o {name}: the name is too long: of {name}.meta.json,"
        assert got.stderr.startswith(told)
    assert {p.name for p in tmp_path.iterdir() if "oo" in p.name} == {fits, f"{fits}.meta.json"}
    got = call("run", "discs", "-o", fits)  # whose older one would stay, and the new one beside it
    assert f"of {'o' * 228}.unfinished.unfinished.jsonl.meta.json, beside it" in got.stderr


def test_a_table_that_could_not_be_written_is_told_without_a_type() -> None:
    assert words(OSError(errno.ENOSPC, "No space left on device")) == (
        "the output cannot be written: No space left on device"
    )
    assert words(ValueError()) == "ValueError"


def test_a_step_that_ends_the_program_is_told_and_what_was_done_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def leaving(image: Image) -> float:
        if image.values[1, 1]:
            sys.exit("enough")
        return 1.0

    install(monkeypatch, tmp_path, steps={"leaving": leaving})
    nodes = "nodes: {a: {step: leaving, in: frame}}, outputs: [a]"
    Path("p.yaml").write_text(f"{{pipeline: p, {nodes}}}")
    got = call("run", "p.yaml", "--source", "made", "--with", "empty=[0]", "-o", "out.jsonl")
    assert got.exit_code == 2
    assert Path("out.jsonl").read_text().count("\n") == 1
    assert "error: a plugin ended the program: SystemExit('enough'), " in got.stderr
    assert "test_outputs.py:" in got.stderr
    assert call("explain", "p.yaml", "--source", "made").exit_code == 2


def chatty(image: Image) -> float:
    print("debug!", image.peak)  # noqa: T201 -- what authors leave in their steps
    return 1.0


def test_what_steps_print_does_not_get_between_lines_for_programs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install(monkeypatch, tmp_path, steps={"chatty": chatty})
    nodes = "nodes: {a: {step: chatty, in: frame}}, outputs: [a]"
    Path("p.yaml").write_text(f"{{pipeline: p, {nodes}}}")
    got = call("run", "p.yaml", "--source", "made", "-o", "-")
    assert got.exit_code == 0
    assert "debug!" not in got.stdout
    assert "debug! 1." in got.stderr
    assert sys.stdout is not sys.stderr


def test_a_narrow_terminal_still_shows_whole_words_of_what_plugins_offer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    got = CliRunner(env={"COLUMNS": "60"}).invoke(cli, ["plugins"])
    assert "…" not in got.stdout
    assert "import" not in got.stdout
    assert "2 pipelines" in " ".join(got.stdout.split())


ODD = ("=1+1.txt", "\x1b[31mred.txt", "a\u202etxt.txt")


@pytest.fixture
def odd_files(tmp_path: Path) -> tuple[str, ...]:
    for name in ODD:
        (tmp_path / name).write_text("1\nword\n")
    return ODD


@pytest.mark.parametrize("form", [(), ("-o", "-"), ("--format", "csv")], ids=" ".join)
def test_a_name_neither_acts_on_the_terminal_nor_turns_text_round(
    odd_files: tuple[str, ...], form: tuple[str, ...]
) -> None:
    got = call("run", "discs", *odd_files, *form)
    assert got.exit_code == 0, got.output
    assert [c for c in got.output if c in "\x1b\u202e"] == []
    assert r"\u001b[31mred.txt" in got.output
    assert r"a\u202etxt.txt" in got.output


def test_a_name_is_no_formula_in_csv_and_itself_in_json(odd_files: tuple[str, ...]) -> None:
    lines = call("run", "discs", *odd_files, "--format", "csv").stdout.splitlines()
    assert [line.split(",")[2] for line in lines] == [
        "label", "'=1+1.txt", r"\u001b[31mred.txt", r"a\u202etxt.txt"
    ]  # fmt: skip
    lines = call("run", "discs", *odd_files, "-o", "-").stdout.splitlines()
    assert [json.loads(line)["label"] for line in lines] == list(ODD)


def test_an_error_shows_a_name_without_its_escapes() -> None:
    got = call("run", "discs", "no\x1b[2Jfile.txt")
    assert got.exit_code == 2
    assert "\x1b" not in got.output
    assert r"no\u001b[2Jfile.txt" in got.output


class Boom(BaseException):
    pass


@pytest.mark.parametrize("error", [Boom("no more"), GeneratorExit("no more")])
def test_no_exception_of_a_step_is_taken_for_a_frame_that_failed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException
) -> None:
    """Exit code 1 says that the run went through and some frame failed."""

    def exploding(image: Image) -> float:
        raise error

    install(monkeypatch, tmp_path, steps={"exploding": exploding})
    Path("p.yaml").write_text(
        "{pipeline: p, nodes: {a: {step: exploding, in: frame}}, outputs: [a]}"
    )
    got = call("run", "p.yaml", "--source", "made", "-o", "out.jsonl")
    assert got.exit_code == 2
    assert f"error: a plugin ended the program: {type(error).__name__}('no more'), " in got.stderr
    assert call("explain", "p.yaml", "--source", "made").exit_code == 2


def clipped(image: Image) -> float:
    image.values.setflags(write=True)
    image.values[:] = 0.0
    return 1.0


def peak(image: Image) -> float:
    return image.peak


def test_verify_finds_the_step_that_writes_and_others_get_their_answers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install(monkeypatch, tmp_path, steps={"clipped": clipped, "peak": peak})
    nodes = "{a: {step: clipped, in: frame}, b: {step: peak, in: frame}}"
    Path("p.yaml").write_text(f"{{pipeline: p, nodes: {nodes}, outputs: [a, b]}}")
    words = ("run", "p.yaml", "--source", "made", "--frames", "3", "-o", "-")
    got = call(*words, "--verify")
    assert got.exit_code == 1
    outputs = [json.loads(line)["outputs"] for line in got.stdout.splitlines()]
    assert [o["b"] >= 1.0 for o in outputs] == [True] * 3
    assert ["failed" in o["a"] for o in outputs] == [True] * 3
    assert "step clipped of " in got.stderr
    told = " ".join(got.stderr.split())
    assert "writes into image, which others read: change a copy (" in told
    assert f"({__file__}:{inspect.getsourcelines(clipped)[1]})" in told
    assert call("run", "discs", "--verify", "--frames", "3").exit_code == 0


def test_ctrl_c_is_told_as_such_though_a_library_makes_another_error_of_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def validated(*_: object) -> None:
        try:
            signal.raise_signal(signal.SIGTERM)
        except BaseException as error:
            raise ValueError("no schema can be built") from error

    monkeypatch.setattr("tactile_graph.api.pipeline.load", validated)
    monkeypatch.setattr(sys, "argv", ["tactile-graph", "run", "discs"])
    with pytest.raises(SystemExit) as got:
        cli.main()
    assert got.value.code == 128 + signal.SIGTERM
