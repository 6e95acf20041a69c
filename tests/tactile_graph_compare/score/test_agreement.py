"""How far two variants' answers lie apart, whatever is true."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest

from tactile_graph import Circle, Degenerate, Rectangle
from tactile_graph.engine.outcomes.outcome import Failed, Skipped
from tactile_graph.pipeline.wiring import Ref
from tactile_graph_compare.records.scores import Agreement
from tactile_graph_compare.score.agreement import Agreeing, Found, found_in
from tactile_graph_compare.score.answers import Answers, Places
from tactile_graph_compare.score.quantities import quantities_of, units_of

SKIPPED = Skipped("a", "nothing there")
FAILED = Failed("a", Degenerate("no"))


def one(*things: Any, **rest: Any) -> Found:
    return Found(things, **rest)


def agreed(quantities: tuple[str, ...], *frames: tuple[Found, Found]) -> dict[str, Agreement]:
    agreeing = Agreeing("b", "a", {q: units_of([Circle, Rectangle])[q] for q in quantities})
    for position, (mine, theirs) in enumerate(frames):
        agreeing.add(position, mine, theirs)
    return {a.quantity: a for a in agreeing.agreements()}


def test_centres_sizes_and_angles_are_the_variants_less_the_references() -> None:
    far = one(Rectangle(4.0, 1.0, 6.0, 2.0, math.radians(89.0)))
    near = one(Rectangle(1.0, 5.0, 5.0, 2.5, math.radians(-89.0)))
    got = agreed(quantities_of(Rectangle), (far, near), (near, near))
    assert got["centre"].differences.tolist() == [5.0, 0.0]
    assert got["centre"].bias == pytest.approx(math.hypot(1.5, -2.0))
    assert got["length"].differences.tolist() == [1.0, 0.0]
    assert got["breadth"].differences.tolist() == [-0.5, 0.0]
    assert got["angle"].differences == pytest.approx([-2.0, 0.0])
    assert (got["length"].mean, got["length"].largest, got["length"].bias) == (0.5, 1.0, 0.5)


def test_shapes_of_different_kinds_have_only_their_centres_to_compare() -> None:
    got = agreed(("centre", "radius"), (one(Circle(1, 1, 2)), one(Rectangle(1, 2, 3, 2, 0.0))))
    assert list(got) == ["centre"]
    assert got["centre"].differences.tolist() == [1.0]


def test_who_alone_answers_is_counted_thing_by_thing_and_neither_frame_by_frame() -> None:
    disc = Circle(1.0, 1.0, 1.0)
    got = agreed(("centre",), (one(disc), one()), (one(), one(disc)), (one(), one()),
                 (one(disc), one(disc)))["centre"]  # fmt: skip
    assert (got.n_both, got.n_only_variant, got.n_only_reference, got.n_neither) == (1, 1, 1, 1)
    assert got.positions.tolist() == [3]


def test_things_of_lists_are_paired_and_what_lies_too_far_off_is_no_pair() -> None:
    mine = one(Circle(9.0, 1.0, 1.0), Circle(1.0, 1.5, 1.2), many=True, n_counted=2)
    theirs = one(Circle(1.0, 1.0, 1.0), many=True, n_counted=1)
    got = agreed(("centre", "radius", "count"), (mine, theirs))
    assert got["centre"].differences.tolist() == [0.5]
    assert got["radius"].differences == pytest.approx([0.2])
    assert (got["centre"].n_only_variant, got["centre"].n_only_reference) == (1, 0)
    assert got["count"].differences.tolist() == [1.0]
    assert agreed(("centre",), (one(Circle(9, 1, 1)), one(Circle(1, 1, 1))))["centre"].n_both == 1


def test_counts_and_names_are_compared_where_both_gave_one() -> None:
    got = agreed(
        ("count", "identity"),
        (one(n_counted=2, name="mug"), one(n_counted=2, name="mug")),
        (one(n_counted=3, name="cup"), one(n_counted=1, name="mug")),
        (one(n_counted=3, name=""), one(name="mug")),
        (one(), one()),
    )
    assert got["count"].differences.tolist() == [0.0, 2.0]
    assert (got["count"].n_only_variant, got["count"].n_neither) == (1, 1)
    assert got["identity"].differences.tolist() == [0.0, 1.0]
    assert got["identity"].n_only_reference == 1


def test_the_largest_difference_of_a_frame_is_told_at_once() -> None:
    agreeing = Agreeing("b", "a", ("centre", "radius"))
    mine = one(Circle(1, 1, 1), Circle(9, 9, 3), many=True)
    theirs = one(Circle(1, 1.5, 1), Circle(9, 9, 4), many=True)
    assert agreeing.add(0, mine, theirs) == {"centre": 0.5, "radius": 1.0}
    assert agreeing.add(1, mine, one()) == {}


def test_a_quantity_nobody_ever_answered_is_left_out() -> None:
    assert agreed(("centre", "count"), (one(), one())) == {}


# -- what a variant answered -----------------------------------------------------------------

PLACES = Places(Ref("c"), False, lambda v: (v,), lambda v: v, (Circle,), ("centre", "radius"))
LISTED = Places(Ref("c"), True, lambda v: v, lambda v: v, (Circle,), ("centre", "radius"))


@pytest.mark.parametrize("outcome", [SKIPPED, FAILED])
def test_what_is_skipped_or_failed_is_no_answer(outcome: Any) -> None:
    answers = Answers((PLACES,), ((Ref("n"), len),), (Ref("who"),))
    assert found_in(answers, lambda ref: outcome) == Found()


def test_what_is_not_finite_is_no_answer() -> None:
    answers = Answers((PLACES,), (), ())
    assert found_in(answers, lambda ref: Circle(math.nan, 1.0, 1.0)) == Found()
    got = agreed(("centre", "radius"), (one(Circle(1, 1, math.nan)), one(Circle(1, 2, 3))),
                 (one(Circle(1, 1, 4)), one(Circle(1, 1, 3))))  # fmt: skip
    assert got["centre"].differences.tolist() == [1.0, 0.0]
    assert got["radius"].differences.tolist() == [1.0]


def test_things_counts_and_names_are_found() -> None:
    disc = Circle(1, 1, 1)
    values = {"c": [disc, FAILED], "n": [1, 2], "who": SimpleNamespace(known=True, name="mug")}
    answers = Answers((LISTED,), ((Ref("n"), len),), (Ref("who"),))
    assert found_in(answers, lambda ref: values[ref.node]) == Found((disc,), True, 2, "mug")
    values["who"] = SimpleNamespace(known=False, name="nearest")
    assert found_in(answers, lambda ref: values[ref.node]).name == ""
