"""The small pieces the report draws with, each against an answer known beforehand."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from tactile_graph import Circle, Image, Mask
from tactile_graph_compare.records.scores import Score
from tactile_graph_compare.report import scatter
from tactile_graph_compare.report.axes import Scale, scale_of, tick_text
from tactile_graph_compare.report.lineage import difference_of
from tactile_graph_compare.report.markup import Html, join, number, tag, text
from tactile_graph_compare.report.spread import Row, spread
from tactile_graph_compare.report.timeline import _runs

# -- markup ------------------------------------------------------------------------------------


def test_text_is_escaped_and_markup_is_not() -> None:
    assert tag("p", "a<b & 'c'", tag("b", "d")) == "<p>a&lt;b &amp; &#x27;c&#x27;<b>d</b></p>"
    assert tag("a", class_='"><x', href="#1", hidden=True, open=False, title=None) == (
        '<a class="&quot;&gt;&lt;x" href="#1" hidden></a>'
    )
    assert join(["a", None, ["<", Html("<br>")]]) == "a&lt;<br>"
    assert text("\x00\ud800\x9f\u202e") == r"\u0000\ud800\u009f\u202e"


@pytest.mark.parametrize(("value", "told"), [(1.0, "1"), (0.126, "0.13"), (-0.001, "0"),
                                             (100.0, "100"), (2.5, "2.5")])  # fmt: skip
def test_coordinates_are_short(value: float, told: str) -> None:
    assert number(value) == told


# -- scales ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("values", "log"),
    [([1.0, 2.0], None), ([1.0, 100.0], None), ([-3.0, 4.0], False), ([0.0], None), ([], None),
     ([1e-9, 1e9], None), ([5.0, 5.0], True), ([math.nan, 1.0, math.inf], None)],
)  # fmt: skip
def test_a_scale_holds_its_values_and_round_ticks(values: list[float], log: bool | None) -> None:
    scale = scale_of(values, 10.0, 110.0, log=log)
    known = [v for v in values if math.isfinite(v)]
    at = [scale(v) for v in sorted(known)]
    assert at == sorted(at)
    assert all(10.0 <= x <= 110.0 for x in at)
    ticks = scale.ticks()
    assert 2 <= len(ticks) <= 9
    assert ticks == sorted(set(ticks))
    assert all(scale.low <= t <= scale.high * 1.001 for t in ticks)


def test_scales_are_logarithmic_from_eightfold_on_and_else_begin_at_nothing() -> None:
    assert scale_of([1.0, 8.0], 0, 1).log
    even = scale_of([1.0, 7.9], 0, 1)
    assert not even.log
    assert even.low == 0.0
    assert scale_of([7.0, 8.0], 0, 1, close=True).low > 6.0
    assert scale_of([0.0, 800.0], 0, 1).log is False
    decades = Scale(1.0, 100.0, 0.0, 200.0, True)
    assert decades(10.0) == pytest.approx(100.0)
    assert decades(1e6) == 200.0


@pytest.mark.parametrize(("value", "told"), [(20000.0, "20000"), (0.05, "0.05"), (-1.5, "−1.5"),
                                             (1e-9, "1e-09")])  # fmt: skip
def test_ticks_read_well(value: float, told: str) -> None:
    assert tick_text(value) == told


# -- differences --------------------------------------------------------------------------------


def test_grids_of_other_cells_are_compared_on_the_finer() -> None:
    coarse = Mask(np.array([[True, False]]), (1.0, 1.0))
    fine = Mask(np.array([[True, True, False, False], [True, False, False, True]]), (0.5, 0.5))
    found = difference_of(coarse, fine)
    assert found is not None
    grid, off = found
    assert grid is fine
    assert off.tolist() == [[0, 0, 0, 0], [0, -1, 0, 1]]
    backwards = difference_of(fine, coarse)
    assert backwards is not None
    assert backwards[1].tolist() == (-off).tolist()


@pytest.mark.parametrize(
    "other",
    [
        Mask(np.ones((1, 2), bool), (1.0, 1.0), (0.5, 0.0)),
        Mask(np.ones((1, 3), bool), (2.0 / 3.0, 1.0)),
        Image(np.ones((1, 2))),
        Circle(0.0, 0.0, 1.0),
    ],
)
def test_grids_that_do_not_fit_have_no_difference(other: object) -> None:
    assert difference_of(Mask(np.ones((1, 2), bool)), other) is None


def test_images_of_other_quantities_have_no_difference() -> None:
    first, second = Image(np.ones((1, 2)), quantity="volt"), Image(np.ones((1, 2)), quantity="gram")
    assert difference_of(first, second) is None
    assert difference_of(first, first) is not None


# -- lines -------------------------------------------------------------------------------------


def test_runs_of_frames_are_one_bar_each() -> None:
    on = np.array([1, 1, 0, 1, 0, 0, 1], bool)
    starts = re.findall(r"M([\d.]+) ", _runs(on, 100.0, 2.0, 0.0))
    assert [float(s) for s in starts] == [100.0, 106.0, 112.0]
    assert re.findall(r"h([\d.]+)v", _runs(on, 100.0, 2.0, 0.0)) == ["4.0", "2.0", "2.0"]
    assert _runs(np.zeros(3, bool), 0.0, 1.0, 0.0) == ""


# -- plots -------------------------------------------------------------------------------------


def test_the_front_is_a_staircase_through_those_on_it() -> None:
    none = np.empty(0, int)
    scores = [
        Score("v", "centre", "cm", none, none, none * 1.0, error, None, None, None, None, 1, 0, 0,
              pareto)
        for error, pareto in ((3.0, True), (2.5, False), (1.0, True))
    ]  # fmt: skip
    spots = [(10.0, 3.0), (40.0, 2.5), (30.0, 1.0)]
    x, y = Scale(0.0, 50.0, 0.0, 50.0), Scale(0.0, 5.0, 50.0, 0.0)
    steps = [(10.0, scatter.TOP), (10.0, 20.0), (30.0, 20.0), (30.0, 40.0), (scatter.RIGHT, 40.0)]
    assert scatter._corners(scores, spots, x, y) == steps
    assert scatter._corners(scores[1:2], spots[1:2], x, y) == []
    often = replace(scores[1], n_answered=2, pareto=True)  # which none of the others beats
    edge = [(40.0, scatter.TOP), (40.0, 25.0), (scatter.RIGHT, 25.0)]
    assert scatter._corners([scores[0], often, scores[2]], spots, x, y) == edge
    told = "L".join(f"{px:.1f} {py:.1f}" for px, py in steps)
    assert f'd="M{told}"' in scatter._front(steps)[1]


def test_a_histogram_counts_every_value_and_says_what_lies_beyond() -> None:
    values = np.concatenate([np.linspace(0.0, 1.0, 400), [90.0]])
    drawn = spread("n", "t", [Row(1, "a", values, 3), Row(2, "b", np.empty(0))], log=False)
    assert drawn is not None
    assert "3 missing · 1 beyond" in drawn
    assert "no answer at all" in drawn
    assert "401 values" in drawn
    assert spread("n", "t", [Row(1, "a", np.empty(0))], log=False) is None
