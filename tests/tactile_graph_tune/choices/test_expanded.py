"""What a file uses comes into it node by node, and computes what it did."""

from __future__ import annotations

import pytest

from tactile_graph import load
from tactile_graph.inspect import NO_VALUE
from tactile_graph_tune.choices.declared import declared

INNER = """\
pipeline: inner
conditions: {touched: footprint.count > 0}
nodes:
  footprint: {step: pressed, in: frame, with: {level_v: 0.5}, free: {level_v: [0.4]}}
  merged: {step: merge, in: [footprint], when: touched and frame.image.quantity == "volt"}
  volt: {step: load, in: frame}
  circle: {step: disc, in: footprint, when: touched and volt.total > 2}
outputs: [circle]
"""
OUTER = """\
pipeline: outer
source: {step: made, with: {frames: 12, empty: [3, 7]}}
nodes:
  footprint: {step: pressed, in: frame, with: {level_v: 0.7}}
  quick: {use: inner.yaml, in: frame, with: {footprint.level_v: 0.6}, when: footprint.count > 1}
  fixed: {step: either, in: footprint}
  circle: {first_of: [quick, fixed]}
outputs: [circle]
"""
DEEP = """\
pipeline: deep
nodes:
  circle: {step: disc, in: frame.mask}
outputs: [circle]
"""
BETWEEN = """\
pipeline: between
nodes:
  footprint: {step: pressed, in: frame, with: {level_v: 0.5}}
  disc: {use: deep.yaml, in: footprint}
outputs: [disc]
"""


@pytest.fixture
def outer(hand_made):
    (hand_made / "inner.yaml").write_text(INNER)
    (hand_made / "outer.yaml").write_text(OUTER)
    return load("outer.yaml")


def test_its_guards_are_places_and_its_settings_those_given(outer):
    its = declared(outer, "circle")
    assert {"quick_touched", "quick", "fixed_good"} <= set(its.places)
    assert its.data["nodes"]["quick_footprint"]["with"] == {"level_v": 0.6}
    assert its.data["nodes"]["quick"] == {"first_of": ["quick_circle"],
                                          "when": "footprint.count > 1"}  # fmt: skip
    quoted = its.data["nodes"]["quick_merged"]["when"]
    assert "quick_volt" in its.data["nodes"]
    assert quoted == 'quick_touched and frame.image.quantity == "volt"'


def test_what_the_file_chose_gives_the_same_answers(outer):
    its = declared(outer, "circle")
    again = its.resolved(its.text(its.rungs, its.given))
    for frame in outer.frames():
        one, other = (p.run(frame).outcome("circle") for p in (outer, again))
        assert type(one) is type(other)
        assert type(one) in NO_VALUE or one == other


@pytest.mark.parametrize(
    ("old", "new"),
    [("in: frame, with: {f", "in: {frame: frame, footprint: footprint}, with: {f"),
     ("outputs: [circle]", "outputs: [circle, footprint]")],
)  # fmt: skip
def test_what_has_no_single_place_in_the_file_stays_a_pipeline(hand_made, old, new):
    (hand_made / "inner.yaml").write_text(INNER.replace(old, new))
    text = OUTER.replace(old, new) if "in:" in old else OUTER.replace("[quick,", "[quick.circle,")
    (hand_made / "outer.yaml").write_text(text.replace(", with: {footprint.level_v: 0.6}", ""))
    its = declared(load("outer.yaml"), "circle")
    assert its.data["nodes"]["quick"]["use"] == "inner.yaml"


def test_files_that_are_used_within_are_named_from_the_outer_one(hand_made):
    (hand_made / "sub").mkdir()
    (hand_made / "sub/deep.yaml").write_text(DEEP)
    (hand_made / "sub/inner.yaml").write_text(BETWEEN)
    (hand_made / "outer.yaml").write_text(OUTER.replace("inner.yaml", "sub/inner.yaml").replace(
        "with: {footprint.level_v: 0.6}, ", ""))  # fmt: skip
    its = declared(load("outer.yaml"), "circle")
    assert its.data["nodes"]["quick_disc"]["use"] == "sub/deep.yaml"
    assert its.resolved(its.text(its.rungs, its.given)).outputs
