"""``check --watch`` looks again at each save, however an editor saves, and ends on Ctrl-C."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from tactile_graph import load
from tactile_graph.cli.terminal import console
from tactile_graph.cli.watch import SETTLED_S, watch
from tactile_graph.errors import PipelineError


class Editor:
    """Does something at each wait of the watcher, and presses Ctrl-C when nothing is left."""

    def __init__(self, deeds: Sequence[Callable[[], object]]) -> None:
        self.deeds = list(deeds)
        self.waited: list[float] = []

    def __call__(self, seconds: float) -> None:
        self.waited.append(seconds)
        if seconds == SETTLED_S:
            return
        if not self.deeds:
            raise KeyboardInterrupt
        self.deeds.pop(0)()


def looks(folder: Path, deeds: Sequence[Callable[[], object]]) -> tuple[list[str], bool, Editor]:
    """Return what was in the files at each look, what came of the last, and the editor."""
    seen: list[str] = []

    def look() -> bool:
        texts = [p.read_text() if p.exists() else "-" for p in sorted(folder.glob("*.yaml"))]
        seen.append(" ".join(texts))
        return "wrong" not in seen[-1]

    editor = Editor(deeds)
    right = watch(look, [folder / "named.yaml"], console(), editor)
    return seen, right, editor


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "named.yaml").write_text("1")
    (tmp_path / "used.yaml").write_text("2")
    return tmp_path


def nothing() -> None:
    pass


def test_each_save_is_looked_at_and_nothing_else(folder: Path) -> None:
    deeds = [nothing, lambda: (folder / "named.yaml").write_text("longer"), nothing, nothing]
    seen, right, editor = looks(folder, deeds)
    assert seen == ["1 2", "longer 2"]
    assert right
    assert min(editor.waited) >= SETTLED_S


def test_a_file_that_is_only_read_is_watched_too(folder: Path) -> None:
    seen, right, _ = looks(folder, [lambda: (folder / "used.yaml").write_text("wrong")])
    assert seen == ["1 2", "1 wrong"]
    assert not right


def test_a_file_on_another_drive_is_told_in_full(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def other_drive(path: str, start: str = "") -> str:
        raise ValueError("path is on mount 'D:', start on mount 'C:'")

    monkeypatch.setattr(os.path, "relpath", other_drive)
    looks(folder, [lambda: (folder / "named.yaml").write_text("longer")])
    assert f"{folder / 'named.yaml'} changed" in capsys.readouterr().out


def test_a_file_put_in_the_place_of_another_is_a_save_even_at_the_same_time(folder: Path) -> None:
    def replace() -> None:
        before = (folder / "used.yaml").stat()
        (folder / "new").write_text("3")
        os.utime(folder / "new", ns=(before.st_atime_ns, before.st_mtime_ns))
        (folder / "new").replace(folder / "used.yaml")

    assert looks(folder, [replace])[0] == ["1 2", "1 3"]


def test_a_file_that_is_gone_is_waited_for(folder: Path) -> None:
    named = folder / "named.yaml"
    seen, *_ = looks(folder, [named.unlink, nothing, lambda: named.write_text("back")])
    assert seen == ["1 2", "2", "back 2"]


def test_a_file_that_was_read_and_is_gone_is_waited_for_while_something_is_wrong(
    folder: Path,
) -> None:
    named, used, seen = folder / "named.yaml", folder / "used.yaml", []

    def look() -> bool:
        uses = "used" in named.read_text()
        seen.append(used.read_text() if uses and used.exists() else "gone" if uses else "unused")
        return seen[-1] != "gone"

    named.write_text("used")
    deeds: list[Callable[[], object]] = [
        used.unlink,
        lambda: used.write_text("back"),
        lambda: used.write_text("again"),
        lambda: named.write_text("alone"),
        lambda: used.write_text("nobody reads it"),
        nothing,
    ]
    assert watch(look, [named], console(), Editor(deeds))
    assert seen == ["2", "gone", "back", "again", "unused"]


def test_a_pipeline_that_is_used_before_it_is_there_is_seen_to_come(folder: Path) -> None:
    named, used = folder / "named.yaml", folder / "later.yaml"
    one = "pipeline: p\nnodes: {l: {step: load, in: frame}}\noutputs: [l]\n"
    named.write_text(one.replace("step: load", "use: later.yaml"))
    seen = []

    def look() -> bool:
        try:
            load(named)
        except PipelineError as error:
            seen.append(str(error))
            return False
        return True

    assert watch(look, [named], console(), Editor([lambda: used.write_text(one)]))
    assert len(seen) == 1
    assert "no pipeline file 'later.yaml'" in seen[0]


@pytest.mark.parametrize("right", [True, False])
def test_where_there_is_no_file_the_first_look_is_the_last(
    right: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    assert watch(lambda: right, [], console(), Editor([nothing])) is right
    assert capsys.readouterr().out == "there is no file to watch\n"


def test_what_changes_during_a_look_is_looked_at_once_more(folder: Path) -> None:
    n = 0

    def look() -> bool:
        nonlocal n
        n += 1
        (folder / "named.yaml").read_text()
        if n == 1:
            (folder / "named.yaml").write_text("changed meanwhile")
        return True

    watch(look, [folder / "named.yaml"], console(), Editor([nothing]))
    assert n == 2


@pytest.mark.slow
def test_ctrl_c_ends_the_command_without_a_word_and_with_the_last_outcome(tmp_path: Path) -> None:
    path = tmp_path / "p.yaml"
    right = "pipeline: p\nnodes: {l: {step: load, in: frame}}\noutputs: [l]\n"
    path.write_text(right)
    command = [sys.executable, "-m", "tactile_graph", "check", "--watch", str(path)]
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment
    ) as running:
        try:
            said = _said(running, "watching 1 file; Ctrl-C ends")
            assert ": right" in said[0]
            path.write_text(right.replace("load,", "laod,"))
            said = _said(running, "watching 1 file; Ctrl-C ends")
            assert "p.yaml changed" in said[1]
            assert any("did you mean 'load'" in line for line in said)
            running.send_signal(signal.SIGINT)
            out, err = running.communicate(timeout=20)
        finally:
            running.kill()
    assert (running.returncode, out, err) == (2, "", "")


def _said(running: subprocess.Popen[str], last: str) -> list[str]:
    """Return the lines a program says up to one of them."""
    assert running.stdout is not None
    lines = []
    for line in running.stdout:
        lines.append(line.rstrip())
        if lines[-1] == last:
            return lines
    raise AssertionError(f"it ended: {lines}")
