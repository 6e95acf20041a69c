"""``study`` lists the studies, does one, and writes its table and picture."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from tactile_graph.errors import UsageError
from tactile_graph.plugins.registry import installed
from tactile_graph_pads.pad import load_pad
from tactile_graph_thesis.chapter_2 import load_study, study_names
from tactile_graph_thesis.commands.study import study


def run(*args: object) -> Result:
    return CliRunner().invoke(study, [str(a) for a in args], catch_exceptions=False)


def test_both_commands_are_offered() -> None:
    assert {"calibrate", "study"} <= set(installed().names("commands"))
    assert installed().load("commands", "study") is study


def test_without_a_name_all_are_listed_with_their_figure() -> None:
    listed = run().output
    for name in study_names():
        assert name in listed
        assert load_study(name).figure in listed


def test_a_study_shows_a_table_and_the_conclusions() -> None:
    result = run("bias-coupling")
    assert result.exit_code == 0
    assert "resistance" in result.output
    assert "24 of 61 rows" in result.output
    assert "of 30, 40 and 50 kOhm the coupling is least at 30 kOhm: comes out" in result.output


@pytest.mark.parametrize("width", [40, 60, 80, 100, 140])
def test_no_number_is_broken_and_columns_without_room_are_named(
    monkeypatch: pytest.MonkeyPatch, width: int
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    asked = load_study("bias-sensitivity")
    table = asked.table(asked.run(load_pad("thesis"), np.random.default_rng(0)))
    lines = run("bias-sensitivity").output.splitlines()
    assert max(map(len, lines[1:27])) <= width
    first = next(line for line in lines if line.split()[:1] == ["1000"])
    n = len(first.split())
    assert first.split() == [f"{v:.4g}" for v in table.rows[0][:n]]
    gone = [line for line in lines if line.startswith("not shown, for want of width: ")]
    named = f"not shown, for want of width: {', '.join(table.columns[n:])}; -o FILE.csv gives all"
    assert gone == ([named] if n < len(table.columns) else [])
    assert (n < len(table.columns)) == (width < 100)


def test_every_row_goes_into_a_csv_file(tmp_path: Path) -> None:
    out = tmp_path / "b.csv"
    assert f"wrote {out}" in run("bias-sensitivity", "-o", out).output
    rows = list(csv.DictReader(out.read_text().splitlines()))
    assert len(rows) == 61
    assert float(rows[0]["resistance_ohm"]) == pytest.approx(1e3)
    assert float(rows[0]["100 kOhm alone_V"]) == pytest.approx(5 * 100 / 101)


@pytest.mark.parametrize("to", ["-", "csv"])
def test_stdout_can_take_the_csv_alone(to: str) -> None:
    result = run("bias-random", "-o", to)
    lines = result.stdout.splitlines()
    assert len(lines) == 62
    assert lines[0].startswith("resistance_ohm,alone_V,")
    assert "comes out" in result.stderr


@pytest.mark.parametrize("name", ["bump", "bias-loaded"])
def test_it_is_drawn(tmp_path: Path, name: str) -> None:
    run(name, "--plot", tmp_path / "p.png")
    assert (tmp_path / "p.png").read_bytes().startswith(b"\x89PNG")


def test_the_seed_decides_what_is_random() -> None:
    one, again, other = (run("bump", "--seed", s, "-o", "-").stdout for s in (1, 1, 2))
    assert one == again != other


def test_a_conclusion_that_does_not_come_out_is_an_exit_code_of_1(tmp_path: Path) -> None:
    """A pad whose repeatability is perfect tells 10 samples from 100."""
    pad = tmp_path / "exact.yaml"
    pad.write_text("scan: {sample_s: 0.01}\nlaw: {repeatability: 0}\n")
    result = run("samples", "--pad", pad)
    assert result.exit_code == 1
    assert "DOES NOT COME OUT" in result.output


def test_an_unknown_study_is_named_with_its_nearest() -> None:
    with pytest.raises(
        UsageError, match="no study named 'wieght-area'; did you mean 'weight-area'"
    ):
        run("wieght-area")
    with pytest.raises(UsageError, match="no study named 'zzz'; there are: bias-coupling,"):
        run("zzz")


def test_where_to_write_is_checked_before_the_work(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"its name must end in .csv, or be - for stdout"):
        run("bump", "-o", "b.txt")
    with pytest.raises(UsageError, match="there is no folder"):
        run("bump", "-o", tmp_path / "none" / "b.csv")
    with pytest.raises(UsageError, match=r"--plot b.doc: its name must end in"):
        run("bump", "--plot", "b.doc")
