"""Names and files cannot act on terminals, pages or spreadsheets."""

from __future__ import annotations

import ast
import csv
import io
import json
import os
import subprocess
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tactile_graph.cli.terminal import console
from tactile_graph.foreign_text import (
    csv_line,
    html_text,
    pasted,
    pasted_path,
    pasted_words,
    visible,
)

ROOT = Path(__file__).parents[2]
ECHOES = {
    "tactile_graph/cli/say.py",
    "tactile_graph/cli/endings.py",  # a coloured word before what is made visible
    "tactile_graph/cli/commands/schema.py",
    "tactile_graph/cli/commands/graph.py",  # the bytes of a picture
    "plugins/tactile_graph_sources/commands/record.py",  # a counter that goes back to its line
}


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("plain, naïve, 手, tab\tand\nline", "plain, naïve, 手, tab\tand\nline"),
        ("\x1b[31mred\x1b]0;title\x07", r"\u001b[31mred\u001b]0;title\u0007"),
        ("gpj.\u202eexe\u2066", r"gpj.\u202eexe\u2066"),
        ("\x9b2J\r\x7f", r"\u009b2J\u000d\u007f"),
        ("\udcff\U000e0041", r"\udcff\udb40\udc41"),
    ],
)
def test_what_acts_unseen_is_spelled_out(text: str, shown: str) -> None:
    assert visible(text) == shown
    assert visible(shown) == shown


@pytest.mark.slow
@given(st.text())
def test_json_stays_what_it_is(text: str) -> None:
    assert json.loads(visible(json.dumps([text], ensure_ascii=False))) == [text]


@pytest.mark.parametrize("cell", ["=cmd|' /C calc'!A0", "+1+1", "-2+3", "@SUM(A1)", "\t=1", " =1"])
def test_no_cell_is_a_formula(cell: str) -> None:
    read = next(csv.reader(io.StringIO(csv_line([cell, 1]))))
    assert read == ["'" + cell, "1"]


@pytest.mark.parametrize("cell", ["-0.5", "+7", "1e-3", "a=b", "", "x - y"])
def test_numbers_and_plain_texts_stay_in_csv(cell: str) -> None:
    assert next(csv.reader(io.StringIO(csv_line([cell, -0.5, None])))) == [cell, "-0.5", ""]


def test_html_is_escaped_and_visible() -> None:
    assert html_text('<b>\x1b&"') == r"&lt;b&gt;\u001b&amp;&quot;"


def test_consoles_print_no_control_character_of_a_name(capsys: pytest.CaptureFixture[str]) -> None:
    from rich.table import Table
    from rich.text import Text

    table = Table("a\x1b[2J")
    table.add_row(Text("b\u202e"))
    out = console()
    out.print(table)
    out.print(Text("c\x9b"), "d\x07", style="red")
    printed = capsys.readouterr().out
    assert [c for c in printed if c in "\x1b\u202e\x9b\x07"] == []
    assert r"a\u001b[2J" in printed


@pytest.mark.slow
@pytest.mark.parametrize("folder", ["tactile_graph", "plugins"])
def test_commands_print_by_the_one_function(folder: str) -> None:
    """``click.echo`` and ``print`` would hand on to the terminal whatever a name holds."""
    found = set()
    for path in (ROOT / folder).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            call = ast.unparse(node.func) if isinstance(node, ast.Call) else ""
            if call in ("click.echo", "click.secho", "print"):
                found.add(path.relative_to(ROOT).as_posix())
    assert found <= ECHOES


@pytest.mark.parametrize(
    "word",
    ["a", "my mat", "it's", "$HOME", "a\nb'\\\t", "\udcff7", "\x1b[31m", "\u202eä", "ä", "*"],
)
def test_a_shell_takes_it_for_one_word_that_is_all_seen(word: str) -> None:
    told = pasted(word)
    assert told.isprintable()
    raw = subprocess.run(
        ["bash", "-c", f"printf %s {told}"], capture_output=True, check=True
    ).stdout
    assert os.fsdecode(raw) == word


def test_a_path_is_no_option() -> None:
    assert pasted_path("-x.npy") == "./-x.npy"
    assert pasted_path("x.npy") == "x.npy"
    assert pasted("-x") == "-x"


@pytest.mark.parametrize(
    ("word", "told"),
    [
        (r"C:\mats\a-1.csv", r"C:\mats\a-1.csv"),
        (r"C:\my mats\a.csv", r'"C:\my mats\a.csv"'),
        ("C:\\my mats\\", r'"C:\my mats\\"'),
        (r"C:\a&b", r'"C:\a&b"'),
        (r'a "b\"', r'"a \"b\\\""'),
        ("it's", '"it\'s"'),
        ("", '""'),
    ],
)
def test_on_windows_what_must_be_is_in_double_quotes(
    word: str, told: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "name", "nt")
    assert pasted_words([word, "a"]) == f"{told} a"
    if " " in word:  # which Windows' own rule looks at
        assert told == subprocess.list2cmdline([word])
