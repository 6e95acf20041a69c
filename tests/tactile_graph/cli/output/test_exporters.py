"""Exporters of plugins: found by the ending of a file's name, or by ``--format``."""

from __future__ import annotations

import os
from importlib import import_module
from pathlib import Path

import click
import pytest

from helpers_cli import call, install

CODE = """
from pathlib import Path

from tactile_graph import hookimpl
from tactile_graph.exporter import Exporter


@hookimpl
def tactile_graph_exporters():
    target = "tg_words:WORDS"
    return {".csv": target, ".md": "none:NONE", ".md.gz": target}


class Words:
    def __init__(self, export):
        self.name, self.n = export.name, 0  # and no word of what is broken

    def write(self, result):
        self.n += 1

    def close(self):
        Path(self.name).write_text(f"{self.n} frames in words")


WORDS = Exporter("words", "records", Words)
"""
TEXT = "{pipeline: p, source: {step: made}, nodes: {m: {step: pressed, in: frame}}, outputs: [m]}"
IN_WORDS = "4 frames in words"


@pytest.fixture
def exporters(hand_made: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (hand_made / "tg_words.py").write_text(CODE)
    monkeypatch.syspath_prepend(str(hand_made))
    words = ("words", "in-words", "1", lambda: import_module("tg_words"))
    install(monkeypatch, hand_made, words)
    (hand_made / "p.yaml").write_text(TEXT)
    return hand_made


def written(*args: object) -> str:
    got = call("run", "p.yaml", *args)
    assert got.exit_code == 0, got.stderr
    return Path(str(args[args.index("-o") + 1])).read_text()


def test_one_whose_ending_is_taken_is_had_by_its_plugins_name(exporters: Path) -> None:
    assert written("-o", "q.txt", "--format", "words.csv") == IN_WORDS
    assert written("-o", "q.csv").startswith("frame,")
    assert written("-o", "q.words.csv").startswith("frame,")  # the ending alone says the form
    assert "words.csv" in call("plugins").stdout


def test_what_one_writes_to_stdouts_own_descriptor_gets_there(
    exporters: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    words = import_module("tg_words").Words
    monkeypatch.setattr(words, "write", lambda self, result: os.write(1, b"line\n"))
    monkeypatch.setattr(words, "close", lambda self: None)
    assert call("run", "p.yaml", "-o", "-", "--format", "words.csv").exit_code == 0
    assert capfd.readouterr().out == 4 * "line\n"


@pytest.mark.parametrize("method", ["__init__", "write", "close"])
def test_an_error_names_exporter_and_plugin_and_leaves_no_note_of_nothing(
    exporters: Path, monkeypatch: pytest.MonkeyPatch, method: str
) -> None:
    def broken(*_: object) -> None:
        raise KeyError("colour")

    monkeypatch.setattr(import_module("tg_words").Words, method, broken)
    got = call("run", "p.yaml", "-o", "q.md.gz")
    assert got.exit_code == 2
    what = "opened" if method == "__init__" else method
    told = (
        f"-o q.md.gz: exporter '.md.gz' of plugin 'words' (package in-words): its {what} breaks: K"
    )
    assert told in got.stderr
    assert not Path("q.md.gz.meta.json").exists() or method == "write"


def test_that_one_wrote_no_file_is_said(exporters: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(import_module("tg_words").Words, "close", lambda self: None)
    got = call("run", "p.yaml", "-o", "q.md.gz")
    assert "no file q.md.gz is there: none was written" in got.stderr
    assert "wrote q.md.gz" not in got.stderr


def test_what_an_exporter_refuses_in_clicks_own_words_is_shown_so(
    exporters: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refusing(*_: object) -> None:
        raise click.BadParameter("q.md.gz is too short a name")

    monkeypatch.setattr(import_module("tg_words").Words, "__init__", refusing)
    got = call("run", "p.yaml", "-o", "q.md.gz")
    assert got.exit_code == 2
    assert got.stderr.startswith("error: Invalid value: q.md.gz is too short a name\n")


def test_the_name_that_is_suggested_is_taken(exporters: Path) -> None:
    got = call("run", "p.yaml", "-o", "q.txt", "--format", "words.cvs")
    assert got.exit_code == 2
    assert "words.csv" in got.stderr.partition("did you mean")[2]


def test_an_ending_of_two_parts_is_found(exporters: Path) -> None:
    assert written("-o", "Table.MD.gz") == IN_WORDS
    assert written("-o", "q.txt", "--format", "md.gz") == IN_WORDS
    got = call("run", "p.yaml", "-o", "q.nothing")
    assert got.exit_code == 2
    assert "its name must end in " in got.stderr
    assert "words" not in got.stderr


@pytest.mark.parametrize("name", [".csv", ".md.gz"])
def test_a_name_that_is_an_ending_alone_has_none(exporters: Path, name: str) -> None:
    got = call("run", "p.yaml", "-o", name)
    assert got.exit_code == 2
    assert f"-o {name}: its name must end in " in got.stderr


@pytest.mark.parametrize("args", [("-o", "x.rst"), ("-o", "x", "--format", "rst")])
def test_that_a_plugin_is_down_is_said_where_its_ending_is_missing(
    hand_made: Path, monkeypatch: pytest.MonkeyPatch, args: tuple[str, ...]
) -> None:
    install(monkeypatch, hand_made, ("words", "in-words", "1", lambda: import_module("tg_gone")))
    (hand_made / "p.yaml").write_text(TEXT)
    got = call("run", "p.yaml", *args)
    assert got.exit_code == 2
    assert "(plugins failed to load: words; " in got.stderr
