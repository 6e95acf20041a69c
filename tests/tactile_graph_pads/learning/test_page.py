"""The page and its nodes: what is shown can be pasted, and hostile names stay text."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from helpers_html import read_html
from helpers_learning import MadeUpPad, untold
from tactile_graph import loads
from tactile_graph_pads.learning.learn import learn_pad
from tactile_graph_pads.learning.pad_file import Making, write_pad
from tactile_graph_pads.learning.page import nodes, page
from tactile_graph_pads.learning.pictures import pictures
from tactile_graph_pads.learning.recordings import read_stack
from tactile_graph_sources.writers.write_npz import write_npz

MAKING = Making("tactile-graph learn-pad '<b>.npz'", "tactile-graph 0", "2026", {"<b>.npz": "0"})


@pytest.mark.slow
def test_the_nodes_shown_run_with_the_pad_that_was_written(tmp_path: Path) -> None:
    pad = MadeUpPad(lean_cells=2.0, stuck=((5, 6),))
    empty, objects = pad.recorded(tmp_path, n_objects=80)
    found = learn_pad(read_stack([(empty, None)]), read_stack([(objects, None)]))
    (path, *_) = write_pad(tmp_path / "pad.yaml", found, None, MAKING)
    shown = nodes(found, str(path))
    assert "inpaint" in shown
    pipeline = f"pipeline: p\nsource: {{step: recording, with: {{path: {objects}}}}}\n{shown}\n"
    result = next(iter(loads(f"{pipeline}outputs: [placed, grams]\n").stream()))
    assert result["placed"].count == 1
    assert result["grams"].total > 0.0


@pytest.mark.slow
@pytest.mark.parametrize("dead_row", [None, 6])
def test_the_nodes_shown_weigh_as_well_as_is_claimed(tmp_path: Path, dead_row: int | None) -> None:
    """The recordings of 6 weights, and of none, by the nodes that their pad file comes with."""
    pad = MadeUpPad(gain_sigma=0.2, noise=4.0, dead_row=dead_row)
    empty, _ = pad.recorded(tmp_path, n_objects=1)
    given = []
    for weight_g in np.linspace(500.0, 3000.0, 6):
        path = tmp_path / f"{weight_g:g}g.npz"
        at = pad.rng.uniform((3.0, 3.0), (16.0, 10.0), (12, 2))
        write_npz(path, untold(pad.frame(((x, y, 0.1 * weight_g),)) for x, y in at))
        given.append((path, float(weight_g)))
    found = learn_pad(read_stack([(empty, None)]), read_stack(given))
    assert found.curve is not None
    (path, *_) = write_pad(tmp_path / "pad.yaml", found, None, MAKING)
    pipeline = loads(f"pipeline: p\n{nodes(found, str(path))}\noutputs: [grams]\n")

    def weighs(path: Path) -> np.ndarray:
        source = pipeline.with_source("recording", path=str(path))
        return np.array([result["grams"].total for result in source.stream()])

    assert weighs(empty).max() < 1e-9
    off_percent = [100.0 * np.median(np.abs(weighs(p) / w - 1.0)) for p, w in given]
    assert np.mean(off_percent) < 1.5 * found.curve.off_percent < 15.0


@pytest.mark.slow
def test_the_page_is_whole_and_names_stay_text(tmp_path: Path) -> None:
    empty, _ = MadeUpPad().recorded(tmp_path, n_objects=1)
    found = learn_pad(read_stack([(empty, None)]), None)
    text = page(found, MAKING, "<i>.yaml")
    root = read_html(text.removeprefix("<!doctype html>"))
    assert [h2.text for h2 in root.all("h2")] == [
        "What could not be told, and what to mind", "The empty pad", "In a pipeline",
    ]  # fmt: skip
    assert root.all("b") == root.all("i") == root.all("script") == []
    assert "'<b>.npz'" in root.text
    assert "<i>.yaml" in root.text


@pytest.mark.slow
def test_readings_that_are_all_the_same_are_drawn(tmp_path: Path) -> None:
    pad = MadeUpPad()
    empty, objects = pad.recorded(tmp_path, n_objects=3)
    found = learn_pad(read_stack([(empty, None)]), read_stack([(objects, None)]))
    (picture,) = (
        p
        for p in pictures(replace(found, under=np.full(9, 0.25)))
        if p.title == "Readings under objects"
    )
    assert picture.figure.axes[0].patches
