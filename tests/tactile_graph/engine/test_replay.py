"""A replay settles what a plan alone would, with the outcomes and times of a wider run."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from helpers_blocks import told
from helpers_graphs import CALLS, STEPS, frame, registry
from tactile_graph import Pipeline, loads
from tactile_graph.engine.outcomes.outcome import NOT_ASKED, Failed, Skipped
from tactile_graph.engine.plan import make_plan
from tactile_graph.engine.replay import Replay

TEXT = """\
pipeline: p
nodes:
  number: {step: read, in: frame}
  good: {step: picky, in: number, with: {bad: 2}, when: number > 2}
  spare: {step: add1, in: number}
  best: {first_of: [good, spare]}
  low: {step: pair, in: number}
  noted: {step: add1, in: number, when: low.note > 0}
outputs: [best, spare, noted]
"""


def pipeline() -> Pipeline:
    return loads(TEXT, "p.yaml", registry(STEPS))


def replay(*asked: str) -> Replay:
    plan = make_plan(pipeline(), asked)
    return Replay(plan, {item.name: item.name for item in plan.nodes})


def test_only_what_the_plan_alone_would_have_run_is_settled_and_no_step_is_called() -> None:
    result = pipeline().run(frame(3))
    CALLS.clear()
    alone = replay("best")(result)
    assert CALLS == []
    assert alone["best"] == 3
    assert alone.outcome("spare") is NOT_ASKED  # the other output needed it, best did not
    assert result["spare"] == 4
    assert alone.frame is result.frame


def test_times_are_those_recorded_and_none_where_nothing_was_asked_for() -> None:
    result = pipeline().run(frame(3))
    times = replay("best")(result).times_us
    assert times["number"] == result.times_us["number"] > 0.0
    assert (times["spare"], result.times_us["spare"] > 0.0) == (0.0, True)


def test_skips_and_failures_are_told_in_the_plans_own_names_and_words() -> None:
    own = pipeline()
    guard = own.nodes["good"].guard
    assert guard is not None
    worded = replace(own.nodes["good"], guard=replace(guard, text="enough"))
    plan = make_plan(replace(own, nodes={**own.nodes, "good": worded}), ("good", "noted"))
    text = TEXT.replace("good", "fine").replace("noted", "told").replace("low", "both")
    recorded = loads(text, "p.yaml", registry(STEPS))
    names = {"number": "number", "good": "fine", "low": "both", "noted": "told"}
    alone = Replay(plan, names)
    skipped = alone(recorded.run(frame(2))).outcome("good")
    assert isinstance(skipped, Skipped)
    assert (skipped.origin, skipped.reason) == ("good", "when enough is false (number = 2)")
    unknown = alone(recorded.run(frame(2))).outcome("noted")
    assert (unknown.origin, unknown.reason) == ("low.note", "low.note is not known")
    result = recorded.run(frame(4))
    failed, known = alone(result).outcome("good"), result.outcome("fine")
    assert isinstance(failed, Failed)
    assert failed.origin == "good"
    assert (failed.error, failed.where, failed.inputs) == (known.error, known.where, known.inputs)


def test_a_reused_result_is_replayed_as_reused() -> None:
    runner = pipeline().runner()
    runner(frame(3))
    alone = replay("best")(runner(frame(3)))
    assert alone.reused
    assert set(alone.times_us.values()) == {0.0}


def test_a_run_that_settled_too_little_is_told_by_what_it_lacks() -> None:
    result = pipeline().run(frame(3), only=["best", "noted"])
    failed = replay("spare")(result).outcome("spare")
    assert isinstance(failed, Failed)
    assert failed.reason == "LookupError: nothing was recorded of 'spare'"


def test_a_node_the_recorded_plan_lacks_is_an_error() -> None:
    with pytest.raises(KeyError, match="spare"):
        replay("spare")(pipeline().run(frame(3), only=["number"]))


PICKY = """\
pipeline: p
nodes:
  number: {step: read, in: frame}
  items: {step: many, in: number}
  some: {step: picky, in: items, each: true, with: {bad: 2}}
"""


def test_items_without_a_value_are_told_in_the_plans_own_names() -> None:
    lists = f"{PICKY}outputs: [some]\n"
    plan = make_plan(loads(lists, "p.yaml", registry(STEPS)), ("some",))
    recorded = loads(lists.replace("some", "few"), "p.yaml", registry(STEPS)).run(frame(3))
    alone = Replay(plan, {"number": "number", "items": "items", "some": "few"})(recorded)
    first, failed, last = alone["some"]
    assert (first, failed.origin, failed.item, last) == (3, "some", (1,), 5)
    assert [(f.origin, f.item) for f in alone.failures] == [("some", (1,))]


def test_items_handed_on_are_told_in_the_plans_own_names() -> None:
    more = """\
  more: {step: add1, in: some, each: true}
  sum: {step: total, in: more}
outputs: [more, sum]
"""
    lists = f"{PICKY}{more}"
    own = loads(lists, "p.yaml", registry(STEPS))
    recorded = loads(lists.replace("some", "few"), "p.yaml", registry(STEPS)).run(frame(3))
    names = {name: name for name in own.nodes}
    alone = Replay(make_plan(own, ("more", "sum")), {**names, "some": "few"})(recorded)
    for name in ("more", "sum"):
        assert told(alone.outcome(name)) == told(own.run(frame(3)).outcome(name))


INNER = """\
pipeline: inner
nodes:
  v: {step: read, in: frame}
  x: {step: picky, in: v, with: {bad: 2}}
  y: {step: add1, in: v, when: v > 100}
  z: {step: picky, in: v, with: {bad: 1}}
outputs: [x, y, z]
"""
OVER_LISTS = """\
pipeline: p
nodes:
  number: {step: read, in: frame}
  items: {step: many, in: number}
  u: {use: inner, in: {frame: frame, v: items}, each: true}
outputs: [u.x, u.y, u.z]
"""


def test_what_a_pipeline_over_a_list_lacks_is_told_as_the_plan_alone_tells_it(
    tmp_path: Path,
) -> None:
    (tmp_path / "inner.yaml").write_text(INNER)
    known = registry(STEPS, {"inner": tmp_path / "inner.yaml"})
    own = loads(OVER_LISTS, "p.yaml", known)
    other = loads(OVER_LISTS.replace(" u:", " w:").replace("u.", "w."), "p.yaml", known)
    plan = make_plan(own, tuple(own.outputs))
    alone = Replay(plan, {"number": "number", "items": "items", "u": "w"})(other.run(frame(3)))
    expected = own.run(frame(3))
    for name in ("u.x", "u.y", "u.z"):
        assert told(alone.outcome(name)) == told(expected.outcome(name))
    assert alone.outcome("u.x")[1].origin == "u/x"
    assert alone.outcome("u.y").reason == "when v > 100 is false (v = 3)"
    assert alone.outcome("u.z").origin == "u/z"
