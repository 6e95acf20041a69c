"""Parquet files hold what CSV holds, with types and units; they are there whole or not at all."""

from __future__ import annotations

import csv
import io
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_cli import call
from helpers_graphs import registry
from tactile_graph import Frame, Image, loads
from tactile_graph.cli.output import parquet
from tactile_graph.engine.tables.columns import Column, OutputColumns
from tactile_graph.engine.tables.table import FrameTable
from tactile_graph.errors import UsageError

FILE = """
pipeline: many
source: {step: simulate, with: {scene: mixed}}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  objects: {step: split_contacts, in: [frame, footprint]}
outputs: [objects]
"""


BIG = """
pipeline: big
nodes:
  n: {step: big, in: frame}
outputs: [n]
"""


def big(image: Image) -> int:
    return 2**70


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
    assert 'Parquet files need pyarrow: pip install "tactile-graph[parquet]"' in done.stderr


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


def of_volts_and_grams() -> None:
    """Write two recordings of two frames, one in volts and one in grams."""
    for name, quantity in (("v.npz", "volt"), ("g.npz", "gram")):
        values = np.zeros((2, 4, 4))
        values[:, 1:3, 1:3] = 5.0
        np.savez(name, values=values, quantity=quantity, pitch_cm=[1.0, 1.0], origin_cm=[0, 0])


def units_and_rows(name: str) -> tuple[dict[str, str], int, int]:
    """Return the units in a file, and how many groups and rows it has."""
    file = pytest.importorskip("pyarrow.parquet").ParquetFile(name)
    return parquet.units_in(file.schema_arrow), file.num_row_groups, file.metadata.num_rows


@pytest.mark.slow
@pytest.mark.parametrize("more", [(), ("--workers", 2)], ids=["alone", "workers"])
def test_frames_in_several_units_leave_a_column_without_one_whichever_came_first(
    more: tuple[Any, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("pyarrow")
    monkeypatch.setattr(parquet, "ROWS_A_GROUP", 2)
    of_volts_and_grams()
    for names, unit in ((("v.npz", "g.npz"), None), (("g.npz",), "g")):
        done = call("run", "contacts", *names, "-o", "out.parquet", *more)
        assert done.exit_code == 0, done.output
        units, groups, rows = units_and_rows("out.parquet")
        assert (units.get("load.total"), units["load.x_cm"]) == (unit, "cm")
        assert rows == 2 * len(names) <= 2 * groups
        told = json.loads(Path("out.parquet.meta.json").read_text())["columns"]
        assert told["load.total"] == (unit or "")
        said = "frames are in gram and volt: load.total, load.peak have no one unit"
        assert (said in done.stderr) == (unit is None)
    assert not list(Path().glob(".*.part"))


class Piped:
    """A file of no name that takes bytes once."""

    name = "<stdout>"

    def __init__(self, file: Any) -> None:
        self.write = file.write


def test_parts_that_differ_in_units_are_joined_without_them() -> None:
    arrow = pytest.importorskip("pyarrow")
    pq = pytest.importorskip("pyarrow.parquet")
    parts = []
    for unit in ("V", "g"):
        fields = [("frame", "1"), ("load.total", unit)]
        schema = arrow.schema([arrow.field(n, arrow.float64(), metadata={"unit": u})
                               for n, u in fields])  # fmt: skip
        part = io.BytesIO()
        pq.write_table(arrow.table([[1.0], [2.0]], schema=schema), part)
        parts.append(part.getvalue())
    assert parquet.PARQUET.joined is not None
    with Path("joined.parquet").open("wb") as file:
        parquet.PARQUET.joined(iter(parts), file)
        n_bytes = file.tell()
    assert units_and_rows("joined.parquet") == ({"frame": "1"}, 1, 2)
    assert Path("joined.parquet").stat().st_size == n_bytes
    assert pq.read_table("joined.parquet")["load.total"].to_pylist() == [2.0, 2.0]
    with Path("piped.parquet").open(
        "wb"
    ) as file:  # as stdout, which nothing can be taken back from
        parquet.PARQUET.joined(iter(parts), Piped(file))  # type: ignore[arg-type]
    assert Path("piped.parquet").read_bytes() == Path("joined.parquet").read_bytes()


def test_a_whole_number_beyond_64_bits_is_refused_by_name() -> None:
    pytest.importorskip("pyarrow")
    table = FrameTable([OutputColumns("n", (Column("n", "n", "", "", int),), ())])
    writer = parquet.ParquetFile("out.parquet", table)
    pipeline = loads(BIG, "big.yaml", registry({"big": big}))
    writer.write(pipeline.run(Frame.of([[1.0]])))
    with pytest.raises(UsageError) as found:
        writer.close()
    assert str(found.value) == (
        f"-o out.parquet: column 'n' holds {2**70}, and whole numbers in Parquet have 64 bits; "
        ".csv and .jsonl take it"
    )
    assert not list(Path().glob("*out.parquet*"))
