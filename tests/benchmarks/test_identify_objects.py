"""The benchmark of identification: what it counts, and that several presses find strangers."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).parents[2] / "benchmarks"
sys.path.insert(0, str(FOLDER))
import identify_objects  # noqa: E402
from identify_objects import LOST, WAYS, Distances, groups, joined, oracle, tried  # noqa: E402


def test_presses_are_grouped_within_their_session():
    rows = list(range(10))
    assert groups(rows, 3) == [[0, 1, 2], [5, 6, 7]]
    assert groups(rows, 5) == [rows[:5], rows[5:]]
    assert groups(rows, 1) == [[row] for row in rows]


def test_shares_are_those_of_all_catalogues_together():
    some = Distances(np.array([0.5, 2.0]), np.array([True, True]), np.array([3.0]), np.array([0.1]))
    other = Distances(np.array([0.5, 0.9]), np.array([True, False]), np.array([0.3]),
                      np.array([0.1]))  # fmt: skip
    assert [float(x) for x in joined([some, other]).line().split()] == [50.0, 75.0, 25.0, 50.0, 0.0]


@pytest.fixture(scope="module")
def readings():
    """Return those of six objects, one of them the like of another, on the strip."""
    names = ("coin", "larger coin", "tape", "box", "cube", "stool")
    catalogue = identify_objects.catalogue
    identify_objects.catalogue = lambda *some: [  # type: ignore[assignment]
        thing for thing in catalogue(*some) if thing.name.removeprefix("foreign ") in names
    ]
    try:
        yield identify_objects.readings_of("strip", 31)
    finally:
        identify_objects.catalogue = catalogue


@pytest.mark.slow
def test_several_presses_find_strangers_that_one_does_not(readings):
    one, _, five = tried(WAYS["all, discriminant"], readings)
    assert (len(one.known), len(five.known), len(five.strangers)) == (150, 30, 30)
    assert one.right.mean() >= 0.93
    assert five.right.mean() >= 0.97
    assert (five.known > 1.0).mean() <= 0.1
    assert (five.strangers > 1.0).mean() > (one.strangers > 1.0).mean() + 0.05
    bound = oracle(readings).mean(axis=0)
    assert (np.diff(bound) >= 0.0).all()
    for lost, found in zip(LOST, bound, strict=True):
        assert found >= (one.strangers > np.quantile(one.known, 1.0 - lost)).mean() - 0.02


@pytest.mark.slow
def test_it_prints_a_row_a_way_and_what_strangers_cost(readings, capsys, monkeypatch):
    monkeypatch.setattr(identify_objects, "readings_of", lambda *_: readings)
    identify_objects.main(["--pads", "strip", "--seeds", "31", "--curve",
                           "--ways", "weight and area, Mahalanobis"])  # fmt: skip
    out = capsys.readouterr().out
    assert out.count("weight and area, Mahalanobis  ") == 4
    assert out.count("one press, told the stranger") == 2
    assert "nan" not in out
