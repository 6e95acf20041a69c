"""Every shipped pipeline loads, runs on its own source, and has a parent that exists."""

from __future__ import annotations

import json
from itertools import islice
from typing import Any

import numpy as np
import pytest

import tactile_graph_thesis
from tactile_graph import Frame, load
from tactile_graph.cli.output.writers import json_row
from tactile_graph.engine.outcomes.outcome import Failed
from tactile_graph.plugins.registry import installed

NAMES = installed().names("pipelines")
LONGEST_LINE = 2048


SLOW = {name for name in NAMES if "likelihood" in name or "locate" in name} | {
    *("adaptive", "bayes-circle", "bayes-lines", "bayes-objects", "bayes-rectangle"),
    "bayes-smooth",
    *("circle-by-order", "circle-followed", "circle-full", "identify-reliefs", "objects"),
    *tactile_graph_thesis.tactile_graph_pipelines(),
}
"""Their kernels alone compile for a quarter of a minute, or they are steps between others."""


each = pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[pytest.mark.slow] if n in SLOW else []) for n in NAMES]
)


@each
def test_runs_on_its_own_source_without_an_error(name: str) -> None:
    pipeline = load(name)
    results = list(islice(pipeline.stream(), 6))
    assert results, "its source gives no frame"
    failed = [
        result.outcome(output)
        for result in results
        for output in pipeline.outputs
        if isinstance(result.outcome(output), Failed)
    ]
    # Energies to the letter leave fields from which not every frame's shape can be had.
    allowed = len(results) // 3 if name.startswith("thesis-") else 0
    assert len(failed) <= allowed, failed
    assert all(outcome.kind == "degenerate" for outcome in failed)
    for result in results:
        assert len(json.dumps(of_one_object(json_row(result, full=False)))) < LONGEST_LINE


def of_one_object(data: Any) -> Any:
    """Return data with one item of each list of records: their number is the frame's."""
    if isinstance(data, dict):
        return {k: of_one_object(v) for k, v in data.items()}
    records = isinstance(data, list) and data and isinstance(data[0], dict)
    return of_one_object(data[0]) if records else data


@pytest.mark.parametrize("name", NAMES)
def test_is_short_says_what_it_is_and_is_named_as_its_file(name: str) -> None:
    pipeline = load(name)
    assert pipeline.name == name
    assert pipeline.about
    assert len(pipeline.text.splitlines()) <= 40
    assert not pipeline.unused


def test_each_circle_evolves_from_the_one_before() -> None:
    assert [load(f"circle-{n}").evolves for n in (1, 2, 3)] == ["", "circle-1", "circle-2"]


@each
def test_a_frame_without_a_valid_reading_is_never_an_untouched_pad(name: str) -> None:
    pipeline = load(name)
    frame = next(iter(pipeline.frames()))
    lost = Frame.of(
        np.full(frame.image.shape, np.nan),
        frame.image.pitch_cm,
        frame.image.origin_cm,
        frame.image.quantity,
    )
    result = pipeline.run(lost)
    outcomes = [result.outcome(output) for output in pipeline.outputs]
    if name == "adaptive":  # tells how many cells it can read
        assert "when legible is false (cells.share = 0)" in str(outcomes[0])
    else:
        assert all(isinstance(outcome, Failed) for outcome in outcomes), outcomes
