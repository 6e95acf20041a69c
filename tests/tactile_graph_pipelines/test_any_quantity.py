"""Every shipped pipeline runs on frames of any quantity and grid, or says at once what it lacks."""

from __future__ import annotations

import json
import sys
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tactile_graph_thesis
from helpers_cli import call
from tactile_graph import Circle, Pipeline, load
from tactile_graph.errors import PipelineError, RuleError
from tactile_graph.plugins.registry import installed

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from any_units import GRIDS, PEAKS, disc, outcomes

SHIPPED = installed().names("pipelines")
IN_VOLTS = {name for name in SHIPPED if "likelihood" in name} | {
    *("adaptive", "circle-followed", "circle-full")
}
"""Those that weigh a pad's volts: they cannot do with less."""
KNOWN_IN_GRAMS = {
    *("identify", "identify-any", "identify-locate", "identify-reliefs"),
    *("thesis-identify", "identify-decoupled", "identify-footprint"),
}
"""Those that know the thesis' objects, by their grams."""

SLOW = {
    *("locate", "locate-circle", "locate-contacts", "locate-objects", "locate-rectangle"),
    *("bayes-circle", "bayes-objects", "bayes-lines", "bayes-rectangle", "bayes-smooth"),
    *("circle-by-order", "objects", *tactile_graph_thesis.tactile_graph_pipelines()),
}
"""Those of which much is computed or compiled, and steps between others, which are like those."""


def slow_where_much_is_compiled(names: set[str]) -> list[Any]:
    """Return names as parameters."""
    return [
        pytest.param(name, marks=[pytest.mark.slow] if name in SLOW else [])
        for name in sorted(names)
    ]


@cache
def loaded(name: str) -> Pipeline:
    """Return a pipeline, which keeps nothing of the frames it ran on."""
    return load(name)


@pytest.mark.slow
@pytest.mark.parametrize(
    "quantity",
    [pytest.param(q, marks=[pytest.mark.slow] if q in ("gram", "counts") else []) for q in PEAKS],
)
@pytest.mark.parametrize(
    "name", slow_where_much_is_compiled(set(SHIPPED) - IN_VOLTS - KNOWN_IN_GRAMS)
)
def test_it_answers_on_three_grids(name: str, quantity: str) -> None:
    pipeline = loaded(name)
    for shape in GRIDS:
        result = pipeline.run(disc(shape, quantity))
        assert result.failures == []
        assert set(result) == set(pipeline.outputs)


@pytest.mark.parametrize("quantity", sorted(set(PEAKS) - {"volt"}))
@pytest.mark.parametrize("name", sorted(IN_VOLTS))
def test_one_that_needs_volts_says_so_before_it_computes(name: str, quantity: str) -> None:
    with pytest.raises(RuleError, match=f"takes volt at port .*, got a frame of {quantity}"):
        loaded(name).run(disc((16, 16), quantity))


@pytest.mark.parametrize("quantity", ["raw", "counts", "kilopascal"])
@pytest.mark.parametrize("name", slow_where_much_is_compiled(KNOWN_IN_GRAMS))
def test_one_that_knows_objects_by_grams_says_so_before_it_computes(
    name: str, quantity: str
) -> None:
    words = f"takes gram at port 'features', got a frame of {quantity}; .*were learned in gram; lea"
    with pytest.raises(RuleError, match=words):
        loaded(name).run(disc((16, 16), quantity))


@pytest.mark.slow  # many are loaded
def test_a_source_that_says_its_unit_is_refused_when_it_is_loaded() -> None:
    with pytest.raises(PipelineError, match=r"takes gram at port .*, got kilopascal; .*learn"):
        load("identify-any").with_source("recording", path="any.npz", quantity="kilopascal")
    load("identify-any").with_source("recording", path="any.npz", quantity="volt")
    load("identify-any").with_source("recording", path="any.npz")


@pytest.mark.slow
@pytest.mark.parametrize("name", ["identify-any", "circle-3", "objects-likelihood", "contacts"])
def test_the_table_of_units_and_grids_has_no_late_word(name: str) -> None:
    found = [*outcomes(name)]
    assert len(found) == 15
    assert {one.what for one in found} <= {"answers", "says so before"}, found


@pytest.mark.parametrize("quantity", sorted(set(PEAKS) - {"volt"}))
@pytest.mark.parametrize("shape", GRIDS)
def test_a_circle_lies_where_the_disc_does_whatever_the_unit(
    shape: tuple[int, int], quantity: str
) -> None:
    circle = loaded("circle-3").run(disc(shape, quantity))["circle"]
    assert isinstance(circle, Circle)
    middle = (shape[1] / 2 + 0.5, shape[0] / 2 + 0.5)
    assert np.hypot(circle.x_cm - middle[0], circle.y_cm - middle[1]) < 0.5
    assert circle.radius_cm == pytest.approx(0.28 * min(shape), abs=0.8)


@pytest.mark.slow
def test_a_plain_npz_runs_and_is_learned(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for n in range(4):
        frames = [disc((16, 16), "raw", 10 * n + k).image.values for k in range(3)]
        np.savez(f"mug-{n}.npz", frames=np.array(frames))
    done = call("run", "circle-3", "mug-0.npz", "-o", "out.jsonl")
    assert done.exit_code == 0, done.output
    assert "assumed  footprint: cells from" in done.stderr
    assert "raw on, which is above the frame's own noise" in done.stderr
    done = call("learn", "mug", *[f"mug-{n}.npz" for n in range(4)])
    assert done.exit_code == 0, done.output
    database = "identity.database=tactile-objects.sqlite"
    done = call("run", "identify", "mug-1.npz", "--set", database, "-o", "-", "--format", "jsonl")
    assert done.exit_code == 0, done.output
    names = [json.loads(line)["outputs"]["identity"]["name"] for line in done.stdout.splitlines()]
    assert names == ["mug"] * 3
