"""A file is taken apart and written again with another choice in it."""

from __future__ import annotations

import pytest

from helpers_tune import LADDER
from tactile_graph import loads
from tactile_graph_tune.choices.comparisons import Comparison
from tactile_graph_tune.choices.declared import declared
from tactile_graph_tune.choices.text import Notes

pytestmark = pytest.mark.usefixtures("hand_made")


def taken():
    return declared(loads(LADDER), "circle")


def test_each_condition_and_guard_is_a_place_and_each_rung_without_one_gets_one():
    its = taken()
    assert {p.name: p.nodes for p in its.places.values()} == {
        "touched": ("merged", "fixed"), "fixed": ("fixed",), "good": ("good",),
        "fixed_good": ("fixed_good",)}  # fmt: skip
    assert its.fixed["merged"] == ("volt",)
    assert its.rungs == ("good", "fixed_good")


def test_what_the_file_chose_makes_the_same_pipeline_again():
    its = taken()
    again = loads(its.text(its.rungs, its.given))
    for name, node in loads(LADDER).nodes.items():
        read = [set(x.guard.refs) if x.guard else None for x in (node, again.nodes[name])]
        assert read[0] == read[1]
    assert [str(c) for c in again.nodes["circle"].choices] == ["good", "fixed"]


def test_opened_every_guard_is_gone_but_what_reads_the_frame():
    guards = {n: x.guard.text for n, x in taken().opened().nodes.items() if x.guard}
    assert guards == {"merged": "volt"}


def test_another_choice_is_put_in_with_its_comments_and_what_nothing_reads_left_out():
    chosen = {"fixed_good": (Comparison("load.total", ">", 4.5),)}
    text = taken().text(("fixed_good",), chosen, {"pipeline": "new"}, Notes({"fixed_good": "why"}))
    its = loads(text)
    assert list(its.nodes) == ["footprint", "load", "fixed", "fixed_good", "circle"]
    assert its.nodes["fixed_good"].guard.text == "load.total > 4.5"
    assert "  # why\n  fixed_good: {first_of: [fixed], when: load.total > 4.5}\n" in text
    assert "conditions" not in text


def test_a_condition_that_another_part_names_stays():
    text = LADDER.replace("when: load.total < 9 and touched", "when: not touched")
    assert "touched" not in declared(loads(text), "circle").places


def test_places_that_are_kept_stand_as_they_stood():
    its = taken().keeping({"touched", "good"})
    guards = {n: x.guard.text for n, x in its.opened().nodes.items() if x.guard}
    good = "first.radius_cm > 0.9"
    assert guards == {"merged": "volt and touched", "fixed": "touched", "good": good}
