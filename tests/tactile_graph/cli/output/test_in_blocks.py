"""What is written of blocks is, byte for byte, what is written of one frame after the other."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_blocks import in_blocks, one_by_one
from tactile_graph import Circle, Frame, Pipeline, load
from tactile_graph.cli.output.tally import Tally
from tactile_graph.cli.output.writers import Csv, JsonLines
from tactile_graph.engine.blocks.block import Block
from tactile_graph.engine.tables.columns import columns_of
from tactile_graph.engine.tables.table import make_table
from tactile_graph.wires import TrueObject
from tactile_graph.wires.frame_stack import in_stacks

PIPELINE = "circle-3"
OUTPUTS = ("circle", "footprint.fraction", "footprint")


def frames() -> list[Frame]:
    """Return frames with a disc, without one, of one cell, repeated, labelled, with a truth."""
    rows, columns = np.indices((8, 9))
    disc = 0.5 * (np.hypot(rows - 3.6, columns - 4.2) < 3.1)
    found = [disc * (1.0 + 0.01 * k) for k in range(6)]
    found += [np.zeros((8, 9)), np.eye(8, 9), disc, disc, disc + 0.3, np.zeros((8, 9))]
    made = [
        Frame.of(v, 1.3, quantity="volt", index=k, time_s=0.25 * k) for k, v in enumerate(found)
    ]
    image = made[2].image
    truth = (TrueObject(Circle(5.0, 5.0, 4.0)),)
    return [
        *made,
        Frame(image, 12, label="=left\x1b"),
        Frame(image, 13, truth=truth),
        Frame(image, 14, gap=True, doubtful=True, device_time_s=3.0),
    ]


@pytest.fixture
def both(plain_kernels: None) -> tuple[Pipeline, list[Any], list[Block[Any]]]:
    pipeline = load(PIPELINE)
    runner = pipeline.runner(OUTPUTS)
    blocks = [runner.block(stack) for stack in in_stacks(frames())]
    return pipeline, one_by_one(pipeline, frames(), only=OUTPUTS), blocks


LINES: dict[str, Callable[[Pipeline, tuple[str, ...]], Any]] = {
    "jsonl": lambda p, o: JsonLines(),
    "jsonl, full": lambda p, o: JsonLines(full=True),
    "csv": lambda p, o: Csv(make_table(p, o, False)),
    "csv, long": lambda p, o: Csv(make_table(p, o, True)),
}


@pytest.mark.parametrize("form", LINES)
def test_lines_are_the_same(form: str, both: Any) -> None:
    pipeline, results, blocks = both
    lines = LINES[form](pipeline, OUTPUTS)
    expected = "".join(lines.line(result) for result in results)
    assert "".join(lines.of_block(block) for block in blocks) == expected
    assert expected.count("\n") >= len(results)


def test_a_run_says_the_same_in_closing(both: Any) -> None:
    pipeline, results, blocks = both
    single, several = (Tally(columns_of(pipeline, OUTPUTS)) for _ in range(2))
    for result in results:
        single.add(result)
    several.n = single.n = 200  # beyond the frames that are looked through
    for block in blocks:
        several.add_block(block)
    assert several.n - 200 == len(results)
    several.n = single.n
    assert several.data() == single.data() | {
        "assumed": several.data()["assumed"], "notices": several.data()["notices"]
    }  # fmt: skip
    for kind in ("skipped", "failed", "not_finite"):
        told = [
            {k: (v.n, v.first_frame, v.last_frame) for k, v in getattr(t, kind).items()}
            for t in (single, several)
        ]
        assert told[0] == told[1]
    assert several.n_skipped == single.n_skipped == 4


def test_parquet_holds_the_same(both: Any, tmp_path: Path) -> None:
    pq = pytest.importorskip("pyarrow.parquet")
    from tactile_graph.cli.output.parquet import ParquetFile

    pipeline, results, blocks = both
    tables = []
    for name in ("single", "several"):
        file = ParquetFile(str(tmp_path / f"{name}.parquet"), make_table(pipeline, OUTPUTS, False))
        for result in results if name == "single" else ():
            file.write(result)
        for block in blocks if name == "several" else ():
            file.write_block(block)
        file.close()
        tables.append(pq.read_table(tmp_path / f"{name}.parquet"))
    assert tables[0].equals(tables[1], check_metadata=True)


def test_blocks_of_a_whole_file_come_to_its_frames(plain_kernels: None) -> None:
    results = [*in_blocks(load(PIPELINE), frames(), 4)]
    assert [r.frame.index for r in results] == [*range(15)]
