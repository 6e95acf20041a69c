"""``reproduce`` lists, makes one or several, writes their files, and says what failed."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from tactile_graph.errors import UsageError
from tactile_graph.plugins.registry import installed
from tactile_graph_thesis import catalogue
from tactile_graph_thesis.book.text import number
from tactile_graph_thesis.catalogue import items
from tactile_graph_thesis.commands.reproduce import reproduce
from tactile_graph_thesis.commands.showing import show_item
from tactile_graph_thesis.item import Item, Made, Table
from tactile_graph_thesis.work import Work


def run(*args: object) -> Result:
    return CliRunner().invoke(reproduce, [str(a) for a in args], catch_exceptions=False)


def test_it_is_offered() -> None:
    assert installed().load("commands", "reproduce") is reproduce


def test_without_an_id_all_are_listed() -> None:
    listed = run().output
    assert all(i.id in listed and i.title in listed for i in items())


def test_a_table_is_shown_beside_the_thesis_and_written(tmp_path: Path) -> None:
    result = run("table-4.5", "-o", tmp_path / "new", "--readings", 20)
    assert result.exit_code == 0
    assert "DISC II, radius avg" in result.stdout
    assert "the convex hull improves the radius dramatically: comes out" in result.stdout
    names = sorted(p.name for p in (tmp_path / "new").iterdir())
    assert names == ["table-4.5.csv", "table-4.5.png", "table-4.5.svg"]
    text = (tmp_path / "new/table-4.5.csv").read_text(encoding="utf-8")
    rows = list(csv.DictReader(text.splitlines()))
    assert len(rows) == 18
    assert rows[9]["object and quantity"] == "DISC II, centre y avg"
    assert float(rows[9]["thesis"]) == 0.5


def test_all_makes_the_book_although_an_item_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(_: Work) -> Made:
        raise ZeroDivisionError("by zero")

    wanted = [i for i in items() if i.id in ("figure-2.8", "figure-4.19")]
    wanted.append(Item("figure-9.9", "Fails", "Nothing.", fails))
    monkeypatch.setattr(catalogue, "items", lambda: tuple(wanted))
    result = run("all", "-o", tmp_path)
    assert result.exit_code == 1
    assert "figure 9.9 could not be made: ZeroDivisionError: by zero" in result.stderr
    assert "2/3" in result.stderr
    assert "could not be made: figure 9.9" in result.stdout
    book = (tmp_path / "book.html").read_text(encoding="utf-8")
    assert book.count("data:image/svg+xml") == 2
    assert "ZeroDivisionError: by zero" in book
    assert "reproduce all --seed 0 --readings 500" in book
    assert (tmp_path / "compared.csv").exists()


def test_a_single_item_makes_no_book(tmp_path: Path) -> None:
    run("figure-4.9", "-o", tmp_path)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["figure-4.9.png", "figure-4.9.svg"]


def test_unknown_names_and_folders_that_cannot_be_are_told_before_the_work(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="did you mean 'subpixel'"):
        run("subpixels", "-o", tmp_path)
    file = tmp_path / "file"
    file.write_text("")
    with pytest.raises(UsageError, match="cannot be made"):
        run("2.8", "-o", file / "inside")


def test_a_group_needs_twenty_readings() -> None:
    assert run("4.5", "--readings", 19).exit_code == 2


@pytest.mark.parametrize("width", [40, 60, 160])
def test_a_narrow_terminal_leaves_columns_out_and_breaks_no_number(
    width: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    names = ("resistance_ohm", *(f"{10 * k}_kOhm alone_V" for k in range(1, 11)))
    rows = tuple((1000.0 * r, *(r + k / 8 for k in range(10))) for r in range(1, 4))
    made = Made(table=Table(names, rows))
    monkeypatch.setenv("COLUMNS", str(width))
    show_item(Item("mine", "Mine", "A table.", lambda work: made), made)
    lines = capsys.readouterr().out.splitlines()
    last = max(i for i, line in enumerate(lines) if line.startswith(" ") and line.strip())
    assert all(len(line.rstrip()) <= width for line in lines[: last + 1])
    n = len(lines[last].split())
    assert lines[last].split() == [number(v) for v in rows[-1][:n]]
    assert n == 11 if width == 160 else 1 < n < 11
    told = f"3 of 3 rows and {n} of 11 columns; all are in the CSV file"
    assert (told in lines) is (n < 11)
