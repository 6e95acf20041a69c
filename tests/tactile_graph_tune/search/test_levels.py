"""Only numbers are turned, and how surely each is known is told by resamples."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from helpers_cli import disc
from helpers_tune import LADDER, frames
from tactile_graph import Circle, Mask, loads
from tactile_graph_tune import Request
from tactile_graph_tune.choices.comparisons import Comparison
from tactile_graph_tune.choices.declared import Chosen
from tactile_graph_tune.request import Free
from tactile_graph_tune.search.front import Choice
from tactile_graph_tune.search.levels import (
    Dial,
    Known,
    dials_of,
    levels_of,
    unchanged_where_as_good,
)
from tactile_graph_tune.searching import Tuning, searched

pytestmark = pytest.mark.usefixtures("hand_made")

EITHER = "(footprint.count > 4 or footprint.area_cm2 > 90)"
WASTEFUL = LADDER.replace("touched: footprint.count > 0", f"touched: {EITHER}").replace(
    ", with: {fail_at_x: 1}", ""
)
"""``touched`` lets no disc of 4 cells pass."""


def tuned(text: str = LADDER, n: int = 48, **asked: object) -> Tuning:
    pipeline = loads(text, steps={"slow_disc": slow_disc} if "slow_disc" in text else None)
    request = Request(pipeline, rounds=1, levels=True, **asked)  # type: ignore[arg-type]
    return searched(request, frames(n), [], lambda what, n, of: None)


def slow_disc(mask: Mask) -> Circle:
    """Return a disc as late as no busy machine makes anything else."""
    time.sleep(0.003)
    return disc(mask)


def test_dials_are_the_numbers_of_comparisons_and_of_what_an_or_joins() -> None:
    flag, same = Comparison("load.ok", "is true", 0.0), Comparison("load.kind", "==", 2.0)
    plain, either = Comparison("load.total", "<", 9.0), Comparison(EITHER, "is true", 0.0)
    chosen = {"fixed": (plain, flag, same), "touched": (either,)}
    dials = list(dials_of(chosen))
    assert [(d.place, d.comparison.text) for d in dials] == [
        ("fixed", "load.total < 9"),
        ("touched", "footprint.count > 4"),
        ("touched", "footprint.area_cm2 > 90"),
    ]
    assert dials[0].put(chosen, 5.0) == {**chosen, "fixed": (plain._replace(level=5.0), flag, same)}
    assert dials[2].turned(7.5).field == "(footprint.count > 4 or footprint.area_cm2 > 7.5)"


@pytest.mark.slow
def test_nothing_changes_but_numbers() -> None:
    its = tuned(WASTEFUL, most_error=9.0, most_missed=1.0, most_false=1.0)
    given, chosen = its.variants[0].given, its.chosen

    def shape(choice):
        dials = dials_of(choice.chosen)
        return choice.order, [(d.place, d.comparison.field, d.comparison.sign) for d in dials]

    assert shape(chosen) == shape(given)
    assert all(shape(p.choice) == shape(given) for p in its.front.points)
    assert its.front.n_weighed > 50
    for point in its.front.points:
        text = its.variants[0].declared.text(point.choice.order, point.choice.chosen)
        loads(text)


def test_a_number_that_stops_what_should_pass_is_turned() -> None:
    its = tuned(WASTEFUL, most_us=1e9, most_missed=1.0)
    count, _ = (d.comparison.level for d in dials_of({"t": its.chosen.chosen["touched"]}))
    assert 0 <= count < 4
    rows = its.split.choosing
    assert its.means(its.chosen, rows).error < its.means(its.variants[0].given, rows).error


def test_a_number_that_nothing_speaks_against_stays_and_is_said_to_be_anything() -> None:
    its = tuned(WASTEFUL.replace("count > 4", "count > 0"))
    (_, count), (_, x) = [k for k in its.resamples().of_all(its.chosen) if k[0] == "touched"]
    stays = [d.comparison.level for d in dials_of({"t": its.chosen.chosen["touched"]})][1]
    assert stays == 90.0
    assert x.share == 1.0
    assert count.share < 1.0
    assert count.low <= 0.0 <= count.high
    assert x.text.endswith(" is as good")


def test_what_other_numbers_join_by_or_is_read_off_the_columns() -> None:
    its = tuned(WASTEFUL)
    table = its.variants[0].table
    count, area = (table.fields[f"footprint.{k}"].values for k in ("count", "area_cm2"))
    column = table.column("(footprint.count > 5 or footprint.area_cm2 > 4.5)")
    unknown = np.isnan(count) & np.isnan(area)
    np.testing.assert_array_equal(np.isnan(column.values), unknown)
    held = column.values[~unknown] == 1.0
    np.testing.assert_array_equal(held, ((count > 5) | (area > 4.5))[~unknown])
    assert column.time_us == table.fields[EITHER].time_us


def test_levels_are_those_between_values_and_its_own_first() -> None:
    table = tuned().variants[0].table
    dial = Dial("touched", 0, Comparison("footprint.count", ">", 1.5), 0)
    assert levels_of(dial, table)[0] == 1.5
    known = replace(table, fields={k: table.fields[k] for k in ("footprint.count",)})
    assert set(levels_of(dial, known)) >= {1.5, 2.0, 5.0}


def test_what_is_as_good_stays_and_the_rest_is_turned() -> None:
    def guards(more: float, less: float, x: float) -> Chosen:
        total = Comparison("load.total", ">", more), Comparison("load.total", "<", less)
        return {"touched": total[:1], "good": (total[1], Comparison("load.x", "<", x))}

    given, found = guards(1.0, 9.0, 5.0), guards(3.0, 7.0, 4.0)
    ranges = [(0.5, 4.0), (6.0, 8.0), (3.0, 6.0)]

    def known(choice: Choice, dial: Dial) -> Known:
        at = [d.key for d in dials_of(choice.chosen)].index(dial.key)
        return Known(dial.comparison, *ranges[at], 0.5)

    def kept(allowed: Callable[[Choice], bool]) -> list[float]:
        its = unchanged_where_as_good(Choice(0, (), found), given, known, allowed)
        return [d.comparison.level for d in dials_of(its.chosen)]

    assert kept(lambda choice: True) == [1.0, 7.0, 5.0]
    assert kept(lambda choice: choice.chosen["touched"][0].level > 2.0) == [3.0, 7.0, 5.0]


@pytest.mark.slow
def test_limits_are_those_of_the_file_whatever_settings_are_chosen() -> None:
    heavy = LADDER.replace("level_v: 0.5", "level_v: 5")
    heavy = heavy.replace("disc, in: merged, with: {fail_at_x: 1}", "slow_disc, in: merged")
    its = tuned(heavy, most_error=9.0, free=(Free("footprint.level_v", (0.5,)),))
    assert its.means(its.goal.given, its.split.choosing).missed == 1.0  # nothing is that heavy
    other = its.variants[1]
    found = its.resamples().of_all(Choice(1, other.given.order, other.given.chosen))
    (count,) = [k for place, k in found if place == "touched"]
    assert count.low >= 5.0  # so anything may be missed: what stops most is cheapest
