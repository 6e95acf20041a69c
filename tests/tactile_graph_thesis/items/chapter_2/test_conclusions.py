"""What the thesis concludes in chapter 2 comes out on its pad, seed after seed."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_thesis.catalogue import chosen, items
from tactile_graph_thesis.item import Item, Made
from tactile_graph_thesis.work import Work

pytestmark = pytest.mark.usefixtures("warm_kernels")

STUDIES = (
    "hysteresis",
    "current-limit",
    "converter",
    "samples",
    "coupling-directions",
    "stack-order",
    "bias-sensitivity",
    "bias-loaded",
    "bias-coupling",
    "bias-random",
    "bump",
    "foam",
    "characteristic",
    "error-bars",
    "curve",
    "weight-area",
)
SLOW = {"stack-order", "weight-area", "converter", "samples"}


def study(name: str) -> Item:
    (item,) = chosen((name,))
    return item


def test_these_are_the_studies_in_the_order_of_the_thesis() -> None:
    chapter = [i for i in items() if i.place[0][0] == 2]
    assert tuple(i.study or i.id for i in chapter if i.study or not i.number) == STUDIES


COSTLY = ("hysteresis", "characteristic")
"""Those for which much is compiled, or drawn."""


@pytest.mark.slow
@pytest.mark.parametrize("name", STUDIES)
def test_what_the_thesis_concludes_comes_out(name: str) -> None:
    for seed in range(1 if name in SLOW else 3):
        found = study(name).make(Work(seed)).findings
        assert found
        missed = [f for f in found if not f.holds]
        assert not missed, (seed, missed)


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        pytest.param(n, marks=[pytest.mark.slow] if n in COSTLY else [])
        for n in STUDIES
        if n not in SLOW
    ],
)
def test_tables_and_pictures_are_whole(name: str) -> None:
    made = study(name).make(Work())
    assert made.table is not None
    assert made.figure is not None
    assert made.table.rows
    assert {len(row) for row in made.table.rows} == {len(made.table.columns)}
    numbers = [v for row in made.table.rows for v in row if not isinstance(v, str)]
    assert np.isfinite(numbers).all()
    shown = [axes for axes in made.figure.axes if axes.get_xlabel()]
    assert shown
    assert any("/" in axes.get_ylabel() or axes.get_ylabel() == "row" for axes in shown)


@pytest.mark.slow
def test_a_study_is_the_same_for_the_same_seed_and_another_for_another_pad() -> None:
    def rows(seed: int, pad: str) -> object:
        made: Made = study("error-bars").make(Work(seed, pad_name=pad))
        assert made.table is not None
        return made.table.rows

    assert rows(5, "thesis") == rows(5, "thesis")
    assert rows(5, "thesis") != rows(6, "thesis")
    assert rows(5, "thesis") != rows(5, "plain")
