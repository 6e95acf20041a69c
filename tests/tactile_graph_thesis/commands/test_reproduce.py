"""``reproduce`` lists, makes one or several, writes their files, and says what failed."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from tactile_graph.errors import UsageError
from tactile_graph.plugins.registry import installed
from tactile_graph_thesis import catalogue
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
    listed = " ".join(run().output.split())  # a narrow terminal folds titles
    assert all(i.id in listed and i.study in listed and i.title in listed for i in items())


@pytest.mark.slow  # much is compiled
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


@pytest.mark.slow
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


@pytest.mark.slow
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


def test_a_pad_that_is_not_there_is_told_before_the_work(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="did you mean 'thesis'"):
        run("2.8", "--pad", "thesi", "-o", tmp_path / "new")
    assert not (tmp_path / "new").exists()


# -- one table, one picture ------------------------------------------------------------------


def test_a_study_shows_rows_from_the_first_to_the_last_and_the_conclusions(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = run("bias-coupling", "--show-only")
    assert result.exit_code == 0
    assert "figure 2.10 (bias-coupling)" in result.output
    assert "pad thesis, seed 0" in result.output
    assert "24 of 61 rows" in result.output
    assert "of 30, 40 and 50 kOhm the coupling is least at 30 kOhm: comes out" in result.output
    first = [line.split()[0] for line in result.output.splitlines() if line.strip()]
    assert "1000" in first
    assert "1e+06" in first
    assert list(tmp_path.iterdir()) == []


def test_every_row_goes_into_a_csv_file_and_nothing_else_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert "wrote b.csv" in run("bias-sensitivity", "--csv", "b.csv").output
    rows = list(csv.DictReader((tmp_path / "b.csv").read_text().splitlines()))
    assert len(rows) == 61
    assert float(rows[0]["resistance_ohm"]) == pytest.approx(1e3)
    assert float(rows[0]["100 kOhm alone_V"]) == pytest.approx(5 * 100 / 101)
    assert [p.name for p in tmp_path.iterdir()] == ["b.csv"]


def test_stdout_can_take_the_csv_alone() -> None:
    result = run("bias-random", "--csv", "-")
    lines = result.stdout.splitlines()
    assert len(lines) == 62
    assert lines[0].startswith("resistance_ohm,alone_V,")
    assert "comes out" in result.stderr


@pytest.mark.parametrize(
    ("name", "file", "start"),
    [
        pytest.param("bump", "p.png", b"\x89PNG", marks=pytest.mark.slow),
        pytest.param("bias-loaded", "p.pdf", b"%PDF", marks=pytest.mark.slow),
        ("figure-4.19", "p.svg", b"<svg"),
    ],
)
def test_the_figure_of_one_item_is_drawn(
    tmp_path: Path, name: str, file: str, start: bytes
) -> None:
    run(name, "--plot", tmp_path / file)
    assert (tmp_path / file).read_bytes().lstrip().startswith(start)
    assert [p.name for p in tmp_path.iterdir()] == [file]


@pytest.mark.slow
def test_a_folder_that_is_named_is_filled_too(tmp_path: Path) -> None:
    result = run("bump", "--csv", tmp_path / "b.csv", "-o", tmp_path / "all")
    assert f"wrote {tmp_path / 'b.csv'}, {tmp_path / 'all'}" in result.output
    names = sorted(p.name for p in (tmp_path / "all").iterdir())
    assert names == ["figure-2.13.csv", "figure-2.13.png", "figure-2.13.svg"]


@pytest.mark.slow
def test_the_seed_and_the_pad_decide_what_is_random() -> None:
    one, again, other, even = (
        run("bump", "--csv", "-", *more).stdout
        for more in (("--seed", 1), ("--seed", 1), ("--seed", 2), ("--seed", 1, "--pad", "plain"))
    )
    assert one == again
    assert len({one, other, even}) == 3


@pytest.mark.slow
@pytest.mark.parametrize(("strict", "code"), [((), 0), (("--strict",), 1)])
def test_a_conclusion_that_does_not_come_out_may_be_an_exit_code_of_1(
    tmp_path: Path, strict: tuple[str, ...], code: int
) -> None:
    """A pad whose repeatability is perfect tells 10 samples from 100."""
    pad = tmp_path / "exact.yaml"
    pad.write_text("scan: {sample_s: 0.01}\nlaw: {repeatability: 0}\n")
    result = run("samples", "--pad", pad, "--show-only", *strict)
    assert result.exit_code == code
    assert "DOES NOT COME OUT" in result.output
    assert f"pad {pad}, seed 0" in result.output


def test_where_to_write_is_checked_before_the_work(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"its name must end in .csv, or be - for stdout"):
        run("bump", "--csv", "b.txt")
    with pytest.raises(UsageError, match="there is no folder"):
        run("bump", "--csv", tmp_path / "none" / "b.csv")
    with pytest.raises(UsageError, match=r"--plot b.doc: its name must end in"):
        run("bump", "--plot", "b.doc")
    with pytest.raises(UsageError, match="--show-only writes no files, but --csv names one"):
        run("bump", "--csv", "-", "--show-only")
    with pytest.raises(UsageError, match=r"--csv takes one item, 2 are named: figure-4.5, table-4"):
        run("4.5", "--csv", tmp_path / "b.csv")


def test_what_an_item_does_not_have_is_told(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"--csv: figure 4\.9 has no table"):
        run("figure-4.9", "--csv", "-")
    with pytest.raises(UsageError, match=r"p.png: figure 4.19 is drawn as .svg only"):
        run("figure-4.19", "--plot", tmp_path / "p.png")


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
    show_item(Item("mine", "Mine", "A table.", lambda work: made), made, "pad thesis, seed 0")
    lines = capsys.readouterr().out.splitlines()
    last = max(i for i, line in enumerate(lines) if line.startswith(" ") and line.strip())
    assert all(len(line.rstrip()) <= width for line in lines[: last + 1])
    n = len(lines[last].split())
    assert lines[last].split() == [f"{v:.4g}" for v in rows[-1][:n]]
    assert n == 11 if width == 160 else 1 < n < 11
    named = f"not shown, for want of width: {', '.join(names[n:])}"
    assert [line for line in lines if "want of width" in line] == ([named] if n < 11 else [])
    assert ("3 of 3 rows; a CSV file has all" in lines) is (n < 11)
