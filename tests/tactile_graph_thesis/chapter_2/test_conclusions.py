"""Every study's conclusions come out, on the thesis' pad, seed after seed."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_pads.pad import load_pad
from tactile_graph_thesis.chapter_2 import Study, load_study, study_names

SLOW = {"weight-area": 1, "converter": 1, "samples": 1}


@pytest.mark.parametrize("name", study_names())
def test_what_the_thesis_concludes_comes_out(name: str) -> None:
    study = load_study(name)
    assert study.name == name
    for seed in range(SLOW.get(name, 3)):
        result = study.run(load_pad("thesis"), np.random.default_rng(seed))
        missed = [f for f in study.findings(result) if not f.holds]
        assert not missed, (seed, missed)


@pytest.mark.parametrize("name", [n for n in study_names() if n not in SLOW])
def test_tables_and_pictures_are_whole(name: str) -> None:
    study: Study[object] = load_study(name)
    result = study.run(load_pad("thesis"), np.random.default_rng(0))
    table = study.table(result)
    assert table.rows
    assert {len(row) for row in table.rows} == {len(table.columns)}
    numbers = [v for row in table.rows for v in row if not isinstance(v, str)]
    assert np.isfinite(numbers).all()
    figure = new_figure()
    study.plot(figure, result)
    shown = [axes for axes in figure.axes if axes.get_xlabel()]
    assert shown
    assert any("/" in axes.get_ylabel() or axes.get_ylabel() == "row" for axes in shown)


def test_a_study_is_the_same_for_the_same_seed() -> None:
    study = load_study("error-bars")
    one, again = (study.run(load_pad("thesis"), np.random.default_rng(5)) for _ in range(2))
    for a, b in zip(one, again, strict=True):
        np.testing.assert_array_equal(a, b)
