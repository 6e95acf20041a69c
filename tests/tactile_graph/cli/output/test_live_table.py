"""Which columns a table gives up where the terminal is narrow."""

from __future__ import annotations

import io

import numpy as np
from rich.console import Console

from tactile_graph import Frame, load
from tactile_graph.cli.output.live_table import LiveTable
from tactile_graph.engine.tables.columns import columns_of


def test_what_an_empty_pad_leaves_open_at_first_keeps_its_place():
    pipeline = load("contacts")
    values = np.zeros((8, 8))
    empty = pipeline.run(Frame.of(values, 1.0, quantity="volt"))
    values[2:6, 2:6] = 0.6
    pressed = pipeline.run(Frame.of(values, 1.0, quantity="volt"))

    def shown(first):
        outputs = columns_of(pipeline, tuple(pipeline.outputs))
        table = LiveTable(Console(file=io.StringIO(), width=80), outputs, first)
        return [c.column.field for c in table.blocks[0].cells]

    assert shown(pressed) == ["loaded", "total", "contact area", "peak", "x", "y"]
    assert shown(empty) == ["loaded", "total", "force", "contact area", "peak", "x"]
