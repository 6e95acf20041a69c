"""A guard is taken apart into what may be chosen and what stays."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_tune.choices.comparisons import Comparison, alternatives, is_free, taken_apart

NODES = ("mask", "fit")


@pytest.mark.parametrize(
    ("text", "comparison"),
    [
        ("mask.count > 12", Comparison("mask.count", ">", 12.0)),
        ("fit.rms_cm <= -0.5", Comparison("fit.rms_cm", "<=", -0.5)),
        ("fit.fits", Comparison("fit.fits", "is true", 0.0)),
        ("not fit.fits", Comparison("fit.fits", "is false", 0.0)),
    ],
)
def test_a_comparison_of_a_field_is_found_and_spelled_as_it_was(text, comparison):
    assert taken_apart(text, NODES, {}).comparisons == (comparison,)
    assert comparison.text == text


@pytest.mark.parametrize(
    "text",
    ["frame.image.total > 3", "mask.count > fit.n", "mask.count > 1 or fit.fits",
     'fit.kind == "disc"', "mask.count + 1 > 3"],
)  # fmt: skip
def test_whatever_is_no_comparison_of_a_nodes_field_with_a_number_stays(text):
    taken = taken_apart(text, NODES, {})
    assert (taken.comparisons, taken.fixed) == ((), (text.replace('"', "'"),))
    assert not is_free(text, NODES)


def test_alternatives_of_one_node_are_a_field_that_holds_or_not():
    (found,) = taken_apart("mask.count > 3 or mask.rise > 1.5", NODES, {}).comparisons
    assert found.text == "(mask.count > 3 or mask.rise > 1.5)"
    assert found.node == "mask"
    assert [c.text for c in alternatives(found.field)] == ["mask.count > 3", "mask.rise > 1.5"]
    assert taken_apart(f"fit.fits and {found.text}", NODES, {}).comparisons[1] == found
    nested = "mask.count > 3 or (mask.count > 1 or mask.rise > 1.5)"
    assert taken_apart(nested, NODES, {}).comparisons == ()


def test_a_comment_ends_with_its_line():
    taken = taken_apart("mask.count > 3  # enough\nand mask.rise > 1.5", NODES, {})
    assert [c.text for c in taken.comparisons] == ["mask.count > 3", "mask.rise > 1.5"]


def test_parts_joined_by_and_are_told_apart_and_conditions_by_their_names():
    conditions = {"touched": "mask.count > 0", "volt": "frame.image.quantity == 'volt'"}
    taken = taken_apart("touched and fit.fits and volt", NODES, conditions)
    assert taken.named == ("touched",)
    assert taken.comparisons == (Comparison("fit.fits", "is true", 0.0),)
    assert taken.fixed == ("volt",)


def test_no_comparison_holds_for_what_is_not_known():
    values = np.array([1.0, np.nan, 3.0])
    for sign in ("<", ">", "!=", "is true", "is false"):
        assert not Comparison("mask.count", sign, 0.0).of(values)[1]
