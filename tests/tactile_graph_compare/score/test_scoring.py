"""What counts as an answer, for which true object, and how far it is off."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tactile_graph import Circle, Degenerate, Ellipse, Frame, Polygon, Rectangle
from tactile_graph.engine.outcomes.outcome import Failed, Skipped
from tactile_graph.pipeline.wiring import Ref
from tactile_graph.wires import TrueObject
from tactile_graph_compare.score.answers import Answers, Places, answers_of
from tactile_graph_compare.score.quantities import quantities_of
from tactile_graph_compare.score.scoring import NOBODY, Scorer
from tactile_graph_compare.score.statistics import score_of

DISC = TrueObject(Circle(3.0, 4.0, 2.0), name="disc")
SLAB = TrueObject(Rectangle(10.0, 4.0, 6.0, 2.0, math.radians(89.0)), name="slab")
SKIPPED = Skipped("a", "nothing there")
FAILED = Failed("a", Degenerate("no"))


def frame(*truth: TrueObject) -> Frame:
    return Frame.of(np.ones((2, 2)), truth=truth)


def places(name: str, *kinds: type, many: bool = False, quantities: Any = None) -> Places:
    named = quantities or tuple(dict.fromkeys(q for k in kinds for q in quantities_of(k)))
    items = (lambda v: v) if many else (lambda v: (v,))
    return Places(Ref(name), many, items, lambda v: v, kinds, named)


def scored(answers: Answers, true: Frame, **values: Any) -> Scorer:
    scorer = Scorer(answers)
    scorer.add(7, true, lambda ref: values[ref.node])
    return scorer


def told(scorer: Scorer) -> dict[str, list[tuple[int, Any]]]:
    return {
        name: [(o, None if math.isnan(e) else round(e, 9)) for o, e in
               sorted(zip(t.objects, t.errors, strict=True))]
        for name, t in scorer.errors.items() if t.objects
    }  # fmt: skip


def test_a_single_answer_is_held_against_the_nearest_object_of_its_kind():
    answers = Answers((places("c", Circle),), (), ())
    got = scored(answers, frame(SLAB, DISC), c=Circle(9.0, 4.0, 1.5))
    assert told(got) == {"centre": [(1, 6.0)], "radius": [(1, -0.5)]}
    assert got.errors["centre"].offsets == [(6.0, 0.0)]


def test_a_circle_for_a_rectangle_has_a_centre_to_compare_but_no_radius():
    answers = Answers((places("c", Circle),), (), ())
    got = scored(answers, frame(SLAB), c=Circle(10.0, 5.0, 1.5))
    assert told(got) == {"centre": [(0, 1.0)]}


def test_an_angle_is_off_by_less_than_a_quarter_turn():
    answers = Answers((places("r", Rectangle),), (), ())
    found = Rectangle(10.0, 4.0, 6.5, 1.5, math.radians(-88.0))
    got = told(scored(answers, frame(SLAB), r=found))
    assert got == {"centre": [(0, 0.0)], "length": [(0, 0.5)], "breadth": [(0, -0.5)],
                   "angle": [(0, 3.0)]}  # fmt: skip


def test_an_ellipse_is_as_long_as_its_whole_axis_and_only_compared_with_one():
    answers = Answers((places("e", Ellipse),), (), ())
    oval = TrueObject(Ellipse(1.0, 1.0, 3.0, 2.0, 0.0))
    got = told(scored(answers, frame(oval), e=Ellipse(1.0, 1.0, 3.5, 2.0, 0.0)))
    assert got["length"] == [(0, 1.0)]
    got = told(scored(answers, frame(SLAB), e=Ellipse(10.0, 4.0, 3.5, 2.0, 0.0)))
    assert set(got) == {"centre", "angle"}


@pytest.mark.parametrize("outcome", [SKIPPED, FAILED])
def test_no_answer_is_missing_for_what_was_there_and_right_where_nothing_was(outcome):
    answers = Answers((places("c", Circle),), (), ())
    assert told(scored(answers, frame(DISC), c=outcome)) == {
        "centre": [(0, None)], "radius": [(0, None)]}  # fmt: skip
    assert told(scored(answers, frame(DISC, DISC), c=outcome))["centre"] == [(NOBODY, None)]
    assert told(scored(answers, frame(), c=outcome)) == {}


@pytest.mark.parametrize("x_cm", [math.nan, math.inf])
def test_a_place_that_is_not_finite_is_no_answer_and_moves_no_bias(x_cm):
    answers = Answers((places("c", Circle),), (), ())
    scorer = scored(answers, frame(DISC), c=Circle(x_cm, 4.0, 2.5))
    scorer.add(8, frame(DISC), lambda ref: Circle(4.0, 4.0, 2.0))
    assert told(scorer) == {"centre": [(0, None), (0, 1.0)], "radius": [(0, 0.0), (0, 0.5)]}
    score = score_of("v", "centre", "cm", scorer.errors["centre"])
    assert (score.mean, score.bias, score.n_missing) == (1.0, 1.0, 1)


def test_an_answer_where_nothing_lies_is_extra():
    got = scored(Answers((places("c", Circle),), (), ()), frame(), c=Circle(1.0, 1.0, 1.0))
    assert told(got) == {}
    assert got.errors["centre"].n_extra == 1


def test_a_later_output_answers_for_a_skipped_one_but_not_for_a_failed_one():
    answers = Answers((places("c", Circle), places("r", Rectangle)), (), ())
    slab = SLAB.shape
    assert told(scored(answers, frame(SLAB), c=SKIPPED, r=slab))["centre"] == [(0, 0.0)]
    assert told(scored(answers, frame(SLAB), c=FAILED, r=slab))["centre"] == [(0, None)]


def test_several_answers_are_paired_with_several_objects_within_the_gate():
    answers = Answers((places("s", Circle, Rectangle, many=True),), (), ())
    found = [Rectangle(9.5, 4.0, 6.0, 2.0, 0.0), Circle(3.0, 5.0, 2.0), Circle(15.0, 15.0, 1.0)]
    got = scored(answers, frame(DISC, SLAB, TrueObject(Circle(8.0, 12.0, 1.0))), s=found)
    assert told(got)["centre"] == [(0, 1.0), (1, 0.5), (2, None)]
    assert told(got)["radius"] == [(0, 0.0), (2, None)]
    assert got.errors["centre"].n_extra == 1


def test_another_kind_of_shape_than_was_there_leaves_its_measures_without_an_answer():
    answers = Answers((places("s", Circle, Rectangle, many=True),), (), ())
    got = told(scored(answers, frame(DISC), s=[Rectangle(3.0, 4.0, 2.0, 1.0, 0.0)]))
    assert got == {"centre": [(0, 0.0)], "radius": [(0, None)]}


def test_the_polygons_area_is_compared():
    square = Polygon(np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]))
    answers = Answers((places("p", Polygon),), (), ())
    truth = frame(TrueObject(Polygon(square.xy_cm * 1.5)))
    assert told(scored(answers, truth, p=square))["area"] == [(0, -5.0)]


def test_counts_are_found_less_true_and_no_count_is_missing_only_where_something_lay():
    answers = Answers((), ((Ref("n"), len), (Ref("m"), len)), ())
    assert told(scored(answers, frame(DISC), n=[1, 2, 3], m=[])) == {"count": [(NOBODY, 2.0)]}
    assert told(scored(answers, frame(DISC), n=SKIPPED, m=[1])) == {"count": [(NOBODY, 0.0)]}
    assert told(scored(answers, frame(DISC), n=FAILED, m=SKIPPED)) == {"count": [(NOBODY, None)]}
    assert told(scored(answers, frame(), n=SKIPPED, m=SKIPPED)) == {}


class Named:
    def __init__(self, name: str, known: bool = True) -> None:
        self.name, self.known = name, known


@pytest.mark.parametrize(
    ("value", "error"),
    [(Named("disc"), 0.0), (Named("slab"), 1.0), (Named("disc", False), None), (SKIPPED, None)],
)
def test_an_identity_is_right_wrong_or_not_known(value, error):
    got = scored(Answers((), (), (Ref("i"),)), frame(DISC), i=value)
    assert told(got) == {"identity": [(NOBODY, error)]}


def test_a_frame_nobody_knows_the_truth_of_is_not_scored():
    scorer = Scorer(Answers((places("c", Circle),), (), ()))
    assert scorer.add(0, Frame.of(np.ones((2, 2))), lambda ref: DISC.shape) == {}
    assert not scorer.errors


def test_the_worst_error_of_a_frame_is_told_and_no_answer_is_worst_of_all():
    answers = Answers((places("s", Circle, many=True),), (), ())
    scorer = Scorer(answers)
    two = frame(DISC, TrueObject(Circle(8.0, 4.0, 1.0)))
    worst = scorer.add(0, two, lambda ref: [Circle(3.0, 4.5, 1.0), Circle(8.0, 4.0, 1.2)])
    assert worst == pytest.approx({"centre": 0.5, "radius": -1.0})
    assert math.isnan(scorer.add(1, two, lambda ref: [DISC.shape])["centre"])


@pytest.mark.parametrize(
    ("name", "quantities", "many"),
    [
        ("circle-3", ("centre", "radius"), False),
        ("rectangle-1", ("centre", "length", "breadth", "angle"), False),
        ("contacts", ("centre", "count"), True),
        ("tracks", ("centre", "count"), True),
        ("identify", ("identity",), False),
        ("features", (), False),
    ],
)
def test_what_a_shipped_pipeline_answers_is_told_by_the_types_of_its_outputs(
    name, quantities, many
):
    from tactile_graph import load

    pipeline = load(name)
    answers = answers_of(pipeline, tuple(pipeline.outputs))
    assert answers.quantities == quantities
    assert all(p.many == many for p in answers.places)


def test_shapes_come_before_what_only_has_a_place():
    from tactile_graph import load

    def refs(name: str) -> list[str]:
        pipeline = load(name)
        return [str(p.ref) for p in answers_of(pipeline, tuple(pipeline.outputs)).places]

    assert refs("rectangle-1") == ["rectangle"]
    assert refs("identify-locate") == ["circle", "slab.rectangle"]
    assert refs("objects") == ["shapes"]
    pipeline = load("rectangle-1")
    axis = answers_of(pipeline, ("axis",))
    assert (axis.quantities, axis.places[0].kinds) == (("centre", "angle"), ())
