"""Items made in a tiny version: they come out, with numbers, figures and conclusions.

What each came to is written down in ``comes_to.yaml``. After a change that is meant,
``python tests/tactile_graph_thesis/items/test_items.py`` writes it anew.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from tactile_graph.compiled import warm_up
from tactile_graph_thesis.catalogue import chosen, items
from tactile_graph_thesis.item import Made, Table
from tactile_graph_thesis.items.chapter_4.figures_4_22_to_4_28_rectangles import (
    lone_cells,
    with_strays,
)
from tactile_graph_thesis.making import Outcome, outcomes
from tactile_graph_thesis.measure import noise_response
from tactile_graph_thesis.measure.shown_reading import stages, typical_rectangle
from tactile_graph_thesis.sections.judging import finding_of
from tactile_graph_thesis.sections.reading import chapters
from tactile_graph_thesis.work import Work

pytestmark = pytest.mark.usefixtures("warm_kernels")

NOISES = ("noise-algorithms", "noise-circles", "noise-rectangles")
SCHEDULE = ("annealing", "state-space")
COMPILED = tuple(
    i.id for i in items() if i.id.startswith(("figure-3.6", "figure-4.", "figure-5.", "table-5."))
)
"""Much is compiled for those: the tables of chapter 4 stand for it where there is no time."""
LONG = (
    *(*SCHEDULE, *COMPILED, "restoration-filters", "load-prior", "noise-models"),
    *("direct-ellipse", "finer-pad", "heavier-smaller", "hysteresis", "boundary-operators"),
    *("figure-2.19", "one-pad", "rotation-order", "stack-order", "table-4.9"),
    *("variable-threshold", "broken-image", "noisy-rectangles", "erased-rectangles"),
    *("residual-voltages", "converter", "subpixel", "table-4.7", "table-4.8"),
    *("figure-2.14", "figure-2.15", "erased-discs"),
)
VERDICTS: dict[str, list[bool]] = yaml.safe_load(
    (Path(__file__).parent / "verdicts.yaml").read_text(encoding="utf-8")
)
"""What comes out with the work below."""
FILE = Path(__file__).parent / "comes_to.yaml"
COMES_TO = yaml.safe_load(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
TIMED = re.compile(r"time|(^|[_ ])[mu]?s$")
"""Columns of times."""


def told(made: Made) -> dict[str, Any]:
    """Return what an item came to: words, the numbers in them, and each column's mean size."""
    findings = [
        {"refuted by": f.refuted_by, "words": NUMBER.sub("#", f"{f.thesis}: {f.found}"),
         "numbers": [float(n) for n in NUMBER.findall(f.found)]}
        for f in made.findings
    ]  # fmt: skip
    compared = [float(f"{one.ours:.4g}") for one in made.compared]
    return {"findings": findings, "compared": compared, "columns": _columns(made.table)}


def _columns(table: Table | None) -> dict[str, float]:
    found = {}
    for k, name in enumerate(table.columns if table else ()):
        values = [row[k] for row in table.rows if isinstance(row[k], (int, float))]  # type: ignore[union-attr]
        if values and not TIMED.search(name):
            size = np.abs(np.nan_to_num(np.array(values, float), posinf=0.0, neginf=0.0))
            found[str(name)] = float(f"{size.mean():.5g}")
    return found


def alike(one: Any, other: Any) -> bool:
    """Return whether two are the same, numbers to 2 %: one reading may go otherwise."""
    if isinstance(one, float | int):
        return bool(one == pytest.approx(other, rel=0.02, abs=2e-3))
    if isinstance(one, list):
        return len(one) == len(other) and all(map(alike, one, other))
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(alike(one[k], other[k]) for k in one)
    return bool(one == other)


def not_found(outcome: Outcome) -> list[str]:
    """Return the statements of the text judged by a finding of an item that it does not make."""
    return [
        f"{section.number}: {claim.says}"
        for chapter in chapters()
        for section in chapter.sections
        for claim in section.claims
        if claim.finding and outcome.item.id in claim.items and finding_of(claim, outcome) is None
    ]


@pytest.fixture(scope="module")
def work() -> Work:
    return Work(seed=0, readings=20, quick=True)


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        pytest.param(i.id, marks=[pytest.mark.slow] if i.id in LONG else [])
        for i in items()
        if i.id not in NOISES
    ],
)
def test_each_comes_out(name: str, work: Work) -> None:
    (outcome,) = outcomes(chosen((name,)), work)
    assert outcome.made is not None, outcome.trace
    assert not_found(outcome) == []
    made = outcome.made
    assert made.figure is not None or made.svg
    for finding in made.findings:
        assert isinstance(finding.holds, bool)
        assert "nan" not in finding.found
        assert "refuted" not in finding.found
    assert [finding.holds for finding in made.findings] == VERDICTS.get(name, [])
    found, before = told(made), COMES_TO[name]
    assert {k: v for k, v in found.items() if not alike(v, before[k])} == {}
    if made.table is not None:
        assert all(len(row) == len(made.table.columns) for row in made.table.rows)
    if made.figure is not None:
        for axes in made.figure.axes:
            drawn = axes.lines or axes.images or axes.collections or axes.patches
            assert drawn or axes.get_label() == "<colorbar>", name
            assert not drawn or axes.get_xlabel() or axes.get_ylabel() or axes.get_title(), name


def test_every_verdict_is_of_an_item() -> None:
    assert set(VERDICTS) <= {item.id for item in items()}
    assert set(COMES_TO) == {item.id for item in items()} - {*NOISES}


@pytest.mark.slow
@pytest.mark.parametrize("name", NOISES)
def test_each_study_of_noise_comes_out(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(noise_response, "QUICK_READINGS", 2)
    (outcome,) = outcomes(chosen((name,)), Work(readings=20, quick=True))
    assert outcome.made is not None, outcome.trace
    assert not_found(outcome) == []
    assert outcome.made.table is not None
    assert {row[1] for row in outcome.made.table.rows} >= {
        "noise on the image",
        "cells switched on",
    }


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        *("table-4.3", "table-4.4", "table-4.5", "table-4.7"),
        pytest.param("table-4.8", marks=pytest.mark.slow),
    ],
)
def test_tables_stand_beside_the_thesis(name: str, work: Work) -> None:
    (outcome,) = outcomes(chosen((name,)), work)
    assert outcome.made is not None
    compared = outcome.made.compared
    assert len(compared) == (12 if name in ("table-4.7", "table-4.8") else 18)
    for largest, average in zip(compared[::2], compared[1::2], strict=True):
        assert "max" in largest.what
        assert "avg" in average.what
        assert largest.ours >= average.ours > 0.0
        for one in (largest, average):
            assert one.low is not None
            assert one.high is not None
            assert one.low <= one.ours + 1e-9
            assert one.ours <= one.high + 1e-9
            assert one.thesis is not None


@pytest.mark.slow
def test_the_convex_hull_betters_the_radius(work: Work) -> None:
    (outcome,) = outcomes(chosen(("table-4.5",)), work)
    assert outcome.made is not None
    finding = outcome.made.findings[0]
    assert "dramatically" in finding.thesis
    assert finding.holds


def test_the_comparison_is_tried_on_a_footprint_that_has_noise_points(work: Work) -> None:
    frame = with_strays(typical_rectangle(work), work.seed)
    result = stages("rectangle-1", frame, work.seed)
    before, after = lone_cells(result["footprint"]), lone_cells(result["clean"])
    assert before >= 3
    assert after < before
    read = typical_rectangle(work).image.values
    on = read >= 0.01
    np.testing.assert_array_equal(frame.image.values[on], read[on])


@pytest.mark.slow
def test_the_seed_decides_everything() -> None:
    def rows(seed: int) -> object:
        (outcome,) = outcomes(chosen(("table-4.5",)), Work(seed, 20))
        assert outcome.made is not None
        return outcome.made.compared

    assert rows(1) == rows(1) != rows(2)


@pytest.mark.slow
def test_what_an_item_gives_does_not_depend_on_what_was_made_before(work: Work) -> None:
    (alone,) = outcomes(chosen(("figure-4.3",)), Work(seed=0, readings=20, quick=True))
    (after,) = outcomes(chosen(("figure-4.3",)), work)
    assert alone.made is not None
    assert after.made is not None
    assert alone.made.compared == after.made.compared


if __name__ == "__main__":
    warm_up()
    shared = Work(seed=0, readings=20, quick=True)
    texts = {i.id: told(i.make(shared)) for i in items() if i.id not in NOISES}
    FILE.write_text(yaml.safe_dump(texts, sort_keys=False, width=100, allow_unicode=True))
