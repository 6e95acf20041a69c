"""What tuning found, told to people."""

from __future__ import annotations

from dataclasses import fields
from types import SimpleNamespace
from typing import Any

import pytest

from tactile_graph_tune.output.tables import doubt, points_table, settings_told, verdict
from tactile_graph_tune.search.front import Choice
from tactile_graph_tune.split import Interval
from tactile_graph_tune.table.record import Judged
from tactile_graph_tune.tuned import ALWAYS, CHOSEN, GIVEN, Point, Tuned, Weight


def weight(time_us: float) -> Weight:
    return Weight(*(Interval(mean, mean, mean) for mean in (time_us, 0.0, 0.0, 0.0)))


@pytest.mark.parametrize(("predicted_us", "told"), [(90.0, ""), (4420.0, "as given was predicted")])
def test_times_that_were_disturbed_are_doubted(predicted_us: float, told: str) -> None:
    point = SimpleNamespace(weight=weight(predicted_us), rerun=weight(100.0))
    tuned = SimpleNamespace(points=dict.fromkeys((GIVEN, ALWAYS, CHOSEN), point))
    assert doubt(tuned).startswith(told)
    assert bool(doubt(tuned)) == bool(told)


def tuned(everything_us: float, oracle_us: float, surely_us: float = 1.0) -> Tuned:
    """Return an outcome in which a choice takes 17.5 us, and everything and an oracle so much."""
    point = Point("", Choice(0, (), {}), weight(17.5), weight(17.5))
    given: dict[str, Any] = dict.fromkeys(its.name for its in fields(Tuned))
    bound = SimpleNamespace(time_at=lambda error, missed: oracle_us)
    given |= {"points": dict.fromkeys((GIVEN, ALWAYS, CHOSEN), point), "bound": bound}
    given |= {"everything_us": everything_us, "ratio": Interval(1.0, 1.0, 1.0)}
    given |= {"saved": Interval(2.5, surely_us, 4.0)}
    return Tuned(**given | {"judged": Judged("circle", "centre", "cm", 2.0),
                            "difference": weight(0.0)})  # fmt: skip


@pytest.mark.parametrize(
    ("everything_us", "oracle_us", "shares", "told"),
    [
        (20.0, 15.0, ["50 %", "50 %", "50 %", "0 %", "100 %"], "it saves 50 % of what an oracle"),
        # as sums of the same times come out in another order
        (17.5 * (1.0 + 2e-16), 17.5 * (1.0 - 2e-16), [""] * 5, "an oracle saves nothing either"),
        (17.0, 17.5, [""] * 5, "an oracle saves nothing either"),
        (20.0, float("nan"), [""] * 5, "no oracle errs as little"),
    ],
)
def test_of_a_saving_that_is_rounding_alone_there_is_no_share(
    everything_us: float, oracle_us: float, shares: list[str], told: str
) -> None:
    found = tuned(everything_us, oracle_us)
    assert [row[-1] for row in points_table(found).rows] == shares
    assert told in verdict(found)


def test_of_a_saving_that_may_be_chance_no_share_is_said() -> None:
    said = verdict(tuned(20.0, 15.0, surely_us=-0.1))
    assert "saves against skipping nothing is not clear of chance" in said
    assert "of what an oracle saves" not in said


def test_values_that_are_as_good_are_told() -> None:
    given: dict[str, Any] = dict.fromkeys(its.name for its in fields(Tuned))
    given |= {"settings": {"a.x": 2}, "as_good": {"a.x": (1, 2, 3), "b.y": (5,)}}
    assert [*settings_told(Tuned(**given))] == ["a.x = 2; as good: 1, 2, 3", "b.y as it was"]
