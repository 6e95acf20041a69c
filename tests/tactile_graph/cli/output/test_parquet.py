"""Parquet files hold what CSV holds, with types and units; they are there whole or not at all."""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path

import pytest

from helpers_cli import call
from tactile_graph.cli.output import parquet

FILE = """
pipeline: many
source: {step: simulate, with: {scene: mixed}}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  objects: {step: split_contacts, in: [frame, footprint]}
outputs: [objects]
"""


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("many.yaml").write_text(FILE)


@pytest.mark.slow
@pytest.mark.parametrize("form", [(), ("--long",)], ids=["wide", "long"])
def test_parquet_and_csv_hold_the_same_rows(form: tuple[str, ...]) -> None:
    pq = pytest.importorskip("pyarrow.parquet")
    for name in ("out.csv", "out.parquet"):
        done = call("run", "many.yaml", "--frames", 4, "-o", name, *form)
        assert done.exit_code == 0, done.output
    table = pq.read_table("out.parquet")
    with open("out.csv") as file:
        rows = list(csv.DictReader(file))
    assert table.column_names == list(rows[0])
    assert table.num_rows == len(rows) > 4 * bool(form)
    for name in table.column_names:
        written = ["" if v is None else str(v) for v in table[name].to_pylist()]
        assert written == [row[name] for row in rows]
    units = json.loads(Path("out.csv.meta.json").read_text())["columns"]
    fields = {f.name: (f.metadata or {}).get(b"unit", b"").decode() for f in table.schema}
    assert {n: u for n, u in fields.items() if u} == units
    assert not list(Path().glob("*.part"))


def test_groups_of_rows_are_written_as_they_fill(monkeypatch: pytest.MonkeyPatch) -> None:
    pq = pytest.importorskip("pyarrow.parquet")
    monkeypatch.setattr(parquet, "ROWS_A_GROUP", 2)
    assert call("run", "many.yaml", "--frames", 5, "-o", "out.parquet").exit_code == 0
    assert pq.ParquetFile("out.parquet").num_row_groups == 3
    assert pq.read_table("out.parquet")["frame"].to_pylist() == [0, 1, 2, 3, 4]


def test_without_pyarrow_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    done = call("run", "many.yaml", "-o", "out.parquet")
    assert done.exit_code == 2
    assert "Parquet files need pyarrow: pip install 'tactile-graph[parquet]'" in done.stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--long",), "--long: a table on the screen: has a row a frame; give -o FILE.csv or"),
        (("--long", "-o", "a.jsonl"), "--long: JSON lines: they hold every list already"),
        (("--format", "parquet"), "a Parquet file cannot go to stdout; give a name"),
    ],
)
def test_forms_that_a_format_does_not_have_are_refused(words: tuple[str, ...], said: str) -> None:
    if "parquet" in words:
        pytest.importorskip("pyarrow")
    done = call("run", "many.yaml", "--frames", 1, *words)
    assert done.exit_code == 2
    assert said in done.stderr
