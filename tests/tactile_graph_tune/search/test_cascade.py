"""What the columns say of a choice is what the engine does with it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from helpers_tune import LADDER, frames
from tactile_graph import loads
from tactile_graph.inspect import NO_VALUE, Failed
from tactile_graph_tune.choices.comparisons import Comparison
from tactile_graph_tune.choices.declared import declared
from tactile_graph_tune.search.cascade import Asked, Cascade, bound
from tactile_graph_tune.table.losses import LossOf
from tactile_graph_tune.table.record import Judged, Rounds, record

pytestmark = pytest.mark.usefixtures("hand_made")

JUDGED = Judged("circle", "centre", "cm", 2.0)
ONCE = Rounds(1, 0, lambda n, of: None)
EITHER = Comparison("(load.total > 5.5 or load.x_cm > 2)", "is true", 0.0)
CHOICES = [
    {},
    {"touched": (Comparison("footprint.count", ">", 0.0),), "good": (EITHER,)},
    {"touched": (Comparison("footprint.count", ">", 0.0),)},
    {"touched": (Comparison("footprint.count", ">", 4.5),),
     "good": (Comparison("first.radius_cm", "<", 1.2),)},
    {"fixed": (Comparison("load.x_cm", ">", 0.5), Comparison("load.total", "<", 5.0))},
    {"fixed_good": (Comparison("load.total", ">", 4.5),),
     "good": (Comparison("load.total", "<", 5.5),)},
]  # fmt: skip


def recorded():
    its = declared(loads(LADDER), "circle")
    opened = its.opened()
    (table,) = record([opened], ["load.x_cm", EITHER.field], frames(), JUDGED, ONCE)
    fields = {k: replace(c, time_us=0.0) for k, c in table.fields.items()}
    return its, Cascade(opened, its, opened.outputs["circle"]), replace(table, fields=fields)


@pytest.mark.parametrize("chosen", CHOICES)
@pytest.mark.parametrize(
    "order",
    [
        ("good", "fixed_good"),
        *(pytest.param(it, marks=pytest.mark.slow) for it in [("fixed_good", "good"), ("good",)]),
    ],
)
def test_time_and_error_of_every_frame_are_those_of_the_engine(chosen, order):
    its, cascade, table = recorded()
    found = cascade.predicted(table, order, chosen)
    run = loads(its.text(order, chosen)).runner()
    loss = LossOf(run.plan.pipeline, "circle", "centre", 2.0)
    for i, frame in enumerate(frames()):
        run.forget()
        result = run(frame)
        ran = [n for n, t in result.times_us.items() if t > 0.0]
        spent = sum(table.nodes[n].time_us[i] for n in ran)
        assert found.time_us[i] == pytest.approx(spent), (i, ran)
        assert found.answered[i] == (result.outcome("circle").__class__ not in NO_VALUE)
        fails = [n for n in ran if type(result.outcome(n)) is Failed]
        assert found.failed[i] == bool(fails), (i, fails)
        assert found.loss[i] == pytest.approx(loss(frame, result.outcome_at)), i


def test_many_comparisons_at_once_come_to_what_each_comes_to_alone():
    _, cascade, table = recorded()
    order = ("good", "fixed_good")
    several = [Comparison("load.total", ">", level) for level in (0.5, 4.2, 5.5)]
    column = table.fields["load.total"].values
    asked = Asked("load.total", "load", np.stack([c.of(column) for c in several]), 0.0)
    at_once = cascade(table, order, {"good": [asked]})
    for k, comparison in enumerate(several):
        alone = cascade.predicted(table, order, {"good": (comparison,)})
        np.testing.assert_array_equal(at_once.time_us[k], alone.time_us)
        np.testing.assert_array_equal(at_once.loss[k], alone.loss)


def test_what_is_read_where_it_may_be_missing_is_bound():
    several = LADDER.replace("in: [footprint], when", "in: [footprint, extra], when")
    several = several.replace("  load:", "  extra: {step: merge, in: [footprint]}\n  load:")
    opened = declared(loads(several), "circle").opened()
    (table,) = record([opened], ["load.x_cm"], frames(), JUDGED, ONCE)
    assert bound(opened, table) == {"footprint", "extra"}
    assert bound(recorded()[1].pipeline, table) == set()
