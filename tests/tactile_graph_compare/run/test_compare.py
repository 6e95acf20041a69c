"""A whole comparison of hand-made pipelines whose every figure can be worked out by hand."""

from __future__ import annotations

import math
import pickle
import re
from itertools import islice, pairwise

import numpy as np
import pytest

from helpers_graphs import STEPS, registry
from tactile_graph import Circle, Ellipse, Frame, Image, load, loads
from tactile_graph.errors import PluginError, RuleError, UsageError
from tactile_graph.wires import TrueObject
from tactile_graph_compare import compare
from tactile_graph_compare.output.tables import heading, reason_lines
from tactile_graph_compare.records.comparison import SettingChange
from tactile_graph_compare.records.graph import STATES
from tactile_graph_compare.run.frame_choice import FrameChooser

pytestmark = pytest.mark.usefixtures("hand_made")


def both(**rest):
    return compare(["discs", "next.yaml"], **{"n_frames": 10, **rest})


def test_errors_are_those_of_each_pipeline_run_alone():
    c = both()
    for variant in c.variants:
        expected = [
            math.hypot(found.x_cm - (r.frame.index % 5 + 1), found.y_cm - 2.0)
            for r in variant.pipeline.stream(c.variants[0].pipeline.frames())
            if (found := r.get("circle"))
        ]
        score = c.score(variant.label, "centre")
        np.testing.assert_allclose(score.absolute, expected)
        assert score.n_answered == len(expected) == 10
    assert c.quantities == ("centre", "radius")
    assert c.source == "made (frames: 10)"


def test_what_ran_and_what_was_skipped_is_told_for_each_variant_as_if_alone():
    c = both(source_settings={"empty": [0]})
    discs, following = c.variants
    assert following.timeline.nodes == ("footprint", "merged", "first", "spare", "circle")
    words = [[STATES[s] for s in row] for row in following.timeline.states]
    skipped = ["ran", "not asked", "skipped", "skipped", "skipped"]
    assert words[0] == skipped
    assert words[1] == ["ran", "ran", "failed", "ran", "ran"]  # handed over: the first failed at 1
    assert words[2] == ["ran", "ran", "ran", "not asked", "ran"]
    assert following.timeline.ran.tolist()[:3] == [1, 4, 4]
    assert following.timeline.not_run.tolist()[:3] == [4, 0, 1]
    assert (discs.n_ok, discs.n_skipped, discs.n_failed) == (9, 1, 0)
    assert following.reasons == (
        ("skipped", "circle", "spare", "when touched is false (footprint.count = 0)", 1),
    )
    assert discs.reasons[0][3] == "when footprint.count > 0 is false (footprint.count = 0)"


def test_equal_nodes_are_one_and_times_are_credited_to_each():
    c = both()
    names = {n.name: n for n in c.graph.nodes}
    assert list(names) == ["footprint", "circle", "merged", "first", "circle@2"]
    assert names["footprint"].variants == ("discs", "next")
    spare = names["circle"]  # equal to what next calls its spare
    assert spare.own_names == {"discs": ("circle",), "next": ("spare",)}
    assert names["merged"].new_in == ("next",)
    assert names["footprint"].new_in == names["circle"].new_in == ()  # its parent has them too
    assert (names["circle@2"].output_of, names["circle"].output_of) == (("next",), ("discs",))
    assert (c.saving.n_nodes_alone, c.saving.n_nodes_merged, c.saving.n_shared) == (7, 5, 2)
    totals = {n.name: n.total_s for n in c.graph.nodes}
    assert c.saving.merged_s == pytest.approx(sum(totals.values()))
    alone = sum(np.nansum(v.times.per_frame_us) for v in c.variants) * 1e-6
    assert c.saving.alone_s == pytest.approx(alone)
    # discs needs two of the nodes in every frame; next its spare only where the first failed.
    assert np.nansum(c.variants[0].times.per_frame_us) * 1e-6 == pytest.approx(
        totals["footprint"] + totals["circle"])  # fmt: skip
    assert c.saving.merged_s < c.saving.alone_s < c.saving.merged_s + 2 * totals["footprint"] + (
        totals["circle"])  # fmt: skip


def test_a_variant_is_charged_only_for_what_it_alone_would_have_run():
    """In most frames next needs no spare, though discs, whose circle that is, runs it."""
    c = both(n_frames=20)
    for kept in c.chosen:
        for variant in c.variants:
            spent = sum(s.time_us for s in kept.stories[variant.label].values())
            assert variant.times.per_frame_us[kept.position] == pytest.approx(spent)
    assert any(f.stories["next"]["spare"].state == "not asked" for f in c.chosen)


def test_the_worst_error_is_the_largest_whichever_its_sign_and_right_answers_are_never_worst():
    chooser = FrameChooser(n_regular=0)
    for position, error in enumerate([0.0, 2.0, -3.0, 1.0]):
        chooser.add(position, None, {"v": {"radius": error, "identity": 0.0}})
    ((position, _, (choice,)),) = chooser.chosen()
    assert (position, choice.error, str(choice)) == (2, -3.0, "worst radius of v")


def test_variants_take_turns_in_coming_first_unless_a_step_keeps_state():
    from tactile_graph.plugins.registry import installed
    from tactile_graph_compare.run.session import MOST_ORDERS, Session
    from tactile_graph_compare.variants.prepare import prepare
    from tactile_graph_compare.variants.request import VariantRequest

    def firsts(n):
        wanted = [VariantRequest("discs", {"footprint.level_v": 0.1 + 0.01 * k}) for k in range(n)]
        runners = Session(prepare(wanted, installed())).runners
        return [r.plan.nodes[0].name for r in runners]

    assert set(firsts(3)) == {"footprint", "footprint@2", "footprint@3"}
    assert len(set(firsts(20))) == MOST_ORDERS
    found = registry(STEPS)
    text = "pipeline: {}\nnodes:\n  number: {{step: read, in: frame}}\n"
    text += "  sum: {{step: count, in: number}}\noutputs: [sum]"
    counting = [VariantRequest(loads(text.format(name), registry=found)) for name in ("a", "b")]
    assert len(Session(prepare(counting, found)).runners) == 1


def test_the_lineage_tells_what_was_added_and_changed_and_what_that_did():
    (step,) = both().lineage
    assert (step.parent, step.child) == ("discs", "next")
    assert (step.added, step.removed) == (("merged", "first", "spare"), ())
    assert step.kept == ("footprint",)
    (change,) = step.changed
    assert (change.node, {c.what for c in change.changes}) == (
        "circle", {"step", "in", "when", "first of"})  # fmt: skip
    assert [d.quantity for d in step.differences] == ["centre", "radius"]
    assert all(d.mean == 0.0 and d.n_both == 10 for d in step.differences)


def test_a_condition_of_the_same_words_that_means_something_else_is_a_change():
    text = (
        "pipeline: {0}\nevolves: discs\nsource: {{step: made}}\nconditions: {{big: {1}}}\n"
        "nodes:\n  footprint: {{step: pressed, in: frame}}\n"
        "  circle: {{step: disc, in: footprint, when: big}}\noutputs: [circle]"
    )
    a = loads(text.format("a", "footprint.count > 0"))
    b = loads(text.format("b", "footprint.count > 1"))
    from tactile_graph_compare.variants.lineage import nodes_between

    (change,) = nodes_between(a, b)[2]
    assert str(change.changes[0]) == "when: footprint.count > 0 -> footprint.count > 1"


def test_a_change_is_told_in_the_words_of_a_pipeline_file():
    assert str(SettingChange("when", "touched", None)) == "when: touched -> none"
    assert str(SettingChange("each", None, True)) == "each: none -> true"
    assert str(SettingChange("factor", 2, 3)) == "factor: 2 -> 3"
    long = str(SettingChange("curve", list(range(100)), None))
    assert long.startswith("curve: [0, 1, 2,")
    assert long.endswith("… -> none")
    assert len(long) < 80


def test_difference_images_are_of_equally_named_nodes_cell_by_cell():
    wide = {"footprint.level_v": 0.001}
    c = compare(["discs", "discs --set footprint.level_v=2"], n_frames=3)
    assert c.lineage == ()  # neither evolved from the other
    off = c.chosen[0].difference("footprint", c.labels[0], c.labels[1])
    assert off.n_changed == 4
    assert set(np.unique(off.values)) == {-1.0, 0.0}
    assert c.chosen[0].difference("circle", *c.labels) is None
    pipeline = load("discs").with_settings(wide)
    assert c.chosen[0].value("discs", "footprint").count == 4
    assert pipeline.run(c.chosen[0].frame).get("footprint").count == 4


def test_frames_kept_are_regular_ones_and_the_worst_of_each_with_every_value():
    c = both(n_frames=40, chooser=FrameChooser(n_regular=3, most=10))
    regular = [f.position for f in c.chosen if any(x.why == "regular" for x in f.choices)]
    assert len(regular) == 3
    assert regular[0] == 0
    worst = {(x.variant, x.quantity): f for f in c.chosen for x in f.choices if x.why == "worst"}
    for (label, quantity), kept in worst.items():
        score = c.score(label, quantity)
        assert abs(kept.errors[label][quantity]) == score.largest
        assert kept.position in score.positions[np.abs(score.errors) == score.largest]
    story = c.chosen[0].stories["next"]
    assert list(story) == ["footprint", "merged", "first", "spare", "circle"]
    assert isinstance(story["circle"].value, Circle)
    assert (story["spare"].state, story["spare"].merged) == ("not asked", "circle")


def test_a_frame_without_an_answer_is_kept_with_the_reason_in_the_variants_own_names():
    c = both(source_settings={"empty": [2]}, chooser=FrameChooser(n_regular=0))
    # The pad is empty there, and truly so: nothing is missing, so nothing is kept for it.
    assert not [x for f in c.chosen for x in f.choices if x.why == "no answer"]
    c = compare(["discs --set footprint.level_v=9"], n_frames=4, chooser=FrameChooser(n_regular=0))
    (kept,) = c.chosen
    assert [str(x) for x in kept.choices] == [
        f"{c.labels[0]} gave no centre", f"{c.labels[0]} gave no radius"]  # fmt: skip
    story = kept.stories[c.labels[0]]["circle"]
    assert (story.state, story.origin) == ("skipped", "circle")
    assert c.score(c.labels[0], "centre").n_missing == 4


def test_the_number_of_results_held_is_bounded():
    chooser = FrameChooser(n_regular=4, most=6)
    both(n_frames=200, chooser=chooser)
    assert len(chooser._regular) <= 8
    assert len(chooser.chosen()) <= 6


def test_frames_equal_to_the_last_cost_nothing_and_are_left_out_of_times():
    still = [Frame.of(np.ones((2, 2)), quantity="volt", index=i,
                      truth=(TrueObject(Circle(1.0, 1.0, 1.0)),)) for i in range(6)]  # fmt: skip
    c = compare(["discs"], still)
    assert c.frames.reused.tolist() == [False] + 5 * [True]
    assert np.isnan(c.variants[0].times.per_frame_us).tolist() == [False] + 5 * [True]
    assert c.score("discs", "centre").n_answered == 6


def test_only_what_equals_the_frame_before_is_reused_whoever_ran_it():
    values = [1.0, 2.0, 1.0, 2.0, 2.0] * 6
    frames = [Frame.of(np.full((2, 2), v), quantity="volt", index=i) for i, v in enumerate(values)]
    c = compare(["discs", "next.yaml"], frames)
    assert c.frames.reused.tolist() == [b == a for a, b in pairwise([0.0, *values])]


def test_the_same_seed_gives_the_same_errors_and_intervals():
    first, again, other = both(), both(), both(seed=1)
    assert first.differences == again.differences
    np.testing.assert_array_equal(first.scores[0].errors, again.scores[0].errors)
    assert first.provenance["seed"] == 0
    assert other.provenance["seed"] == 1


def test_steps_are_held_to_what_they_promise():
    def liar(image: Image) -> Circle:
        return image

    text = "pipeline: p\nnodes: {a: {step: liar, in: frame}}\noutputs: [a]"
    pipeline = loads(text, registry=registry({**STEPS, "liar": liar}))
    with pytest.raises(PluginError, match="promises Circle, but gave Image"):
        compare([pipeline], [Frame.of(np.ones((2, 2)))])


def test_a_number_that_is_not_finite_is_told_and_its_frame_is_not_ok():
    def first(image: Image) -> Circle:
        return Circle(1.0 / image.values[0, 0] if image.values[0, 0] else math.nan, 1.0, 1.0)

    text = "pipeline: p\nnodes: {a: {step: first, in: frame}}\noutputs: [a]"
    pipeline = loads(text, registry=registry({**STEPS, "first": first}))
    frames = [Frame.of(np.full((2, 2), value), index=k) for k, value in enumerate((0.0, 1.0))]
    found = compare([pipeline], frames)
    (variant,) = found.variants
    assert (variant.n_ok, variant.n_skipped, variant.n_failed) == (1, 0, 0)
    assert variant.reasons == (("strange", "a", "a.x_cm", "nan, which is no answer", 1),)
    assert [*reason_lines(found)] == [
        ("strange", "p, a in 1 frame: a.x_cm: nan, which is no answer")
    ]


def test_provenance_tells_every_variant_with_all_its_settings():
    c = compare(["discs", "discs --set footprint.level_v=0.3"], n_frames=3)
    told = c.provenance["variants"]["discs level_v=0.3"]
    assert told["given"] == "'discs --set footprint.level_v=0.3'"
    assert told["pipeline"]["nodes"]["footprint"]["with"] == {"level_v": 0.3}
    assert c.provenance["plugins"]["hand"]["version"] == "1.2"
    assert c.provenance["source"]["with"]["frames"] == 3


def test_a_frame_that_breaks_a_rule_is_told_in_the_variants_name():
    counts = [Frame.of(np.ones((2, 2)), quantity="counts")]
    with pytest.raises(RuleError, match=r"pipeline 'discs', node 'footprint'.*takes volt"):
        compare(["discs"], counts)


def test_frames_handed_in_are_told_as_such_and_not_as_the_pipelines_own_source():
    c = compare(["discs", "next.yaml"], list(load("discs").frames())[:3])
    assert c.source == "frames handed in"
    assert heading(c).startswith("2 variants on frames handed in: 3 frames")
    assert "step" not in c.provenance["source"]
    assert all(v["pipeline"]["source"] is None for v in c.provenance["variants"].values())
    assert "hand" in c.provenance["plugins"]  # their steps come from it all the same


def test_provenance_tells_which_frames_of_the_source_there_were():
    assert both(n_frames=4).provenance["frames"] == {"from": 0, "to": 4}


def test_images_and_arrays_are_frames_and_one_variant_may_stand_alone():
    frames = [f.image for f in load("discs").frames()][:2]
    assert [v.label for v in compare("discs", frames).variants] == ["discs"]
    with pytest.raises(RuleError, match="takes volt at port 'image', got a frame of raw"):
        compare(load("discs"), np.ones((2, 4, 4)))
    with pytest.raises(UsageError, match=r"got a path or text, 'my\.npy'; source='recording', "):
        compare(["discs"], "my.npy")
    with pytest.raises(UsageError, match="variants must be a list of pipelines, got int"):
        compare(3)


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ({"n_frames": -1}, "n_frames: must be a whole number >= 1, got -1"),
        ({"n_frames": "3"}, "n_frames: must be a whole number >= 1, got '3'"),
        ({"sweeps": {"footprint.level_v": []}}, "sweeps: footprint.level_v has no values"),
        ({"sweeps": {"footprint.level_v": 3}}, "footprint.level_v must be a list of values, got 3"),
        ({"sweeps": {"footprint.level_v": "2,3"}}, "must be a list of values, got '2,3'"),
        ({"sweeps": {"footprint.level_v": [1, 1]}}, "level_v: a value stands there twice"),
        ({"sweeps": ["a.b"]}, "sweeps must be a mapping"),
        ({"sweeps": {"footprint.levl_v": [1]}}, "sweeps footprint.levl_v: none of the pipelines"),
        ({"settings": "a=1"}, "settings must be a mapping"),
        ({"settings": {"a.b": 1}}, "settings a.b: none of the pipelines has it"),
        ({"reference": "disc"}, "reference disc: must be one of the variants"),
    ],
)
def test_what_is_wrong_with_a_call_is_told_by_the_names_of_python(asked, told):
    with pytest.raises(UsageError, match=told):
        compare("discs", **asked)


def test_frames_and_a_source_exclude_each_other():
    with pytest.raises(UsageError, match="give frames or a source, not both"):
        compare(["discs"], [], source="made")


def test_a_quantity_the_first_variant_has_not_is_compared_with_the_first_that_has_it():
    text = (
        "pipeline: {0}\nnodes:\n  footprint: {{step: pressed, in: frame}}\n"
        "  shape: {{step: either, in: footprint, with: {{kind: ellipse}}}}\noutputs: [shape]"
    )
    oval = (TrueObject(Ellipse(2.0, 2.0, 3.0, 1.0, 0.0)),)
    frames = [Frame.of(np.ones((4, 6)), quantity="volt", index=i, truth=oval) for i in range(3)]
    c = compare(["discs", loads(text.format("a")), loads(text.format("b"))], frames)
    told = {(d.variant, d.quantity): d.reference for d in c.differences}
    assert told[("a", "centre")] == told[("b", "centre")] == "discs"
    assert ("a", "length") not in told
    assert told[("b", "length")] == "a"


def test_frames_of_unknown_truth_are_timed_only():
    c = compare(["discs"], (Frame.of(np.full((2, 2), 1.0 + i), quantity="volt") for i in range(3)))
    assert c.scores == ()
    assert c.frames.n_true.tolist() == [-1, -1, -1]
    assert c.variants[0].times.median_us > 0.0


def test_the_graph_can_be_drawn():
    c = both()
    svg = c.graph.pipeline.svg()
    assert re.search(r"circle@2", svg)
    assert {(e.start, e.end, e.kind) for e in c.graph.edges} >= {
        ("frame", "footprint", "data"), ("footprint", "circle", "guard"),
        ("first", "circle@2", "choice")}  # fmt: skip


def test_a_comparison_comes_back_from_a_pickle():
    c = compare(["discs", "next.yaml"], list(load("discs").frames())[:3])
    again = pickle.loads(pickle.dumps(c))
    assert again.graph.pipeline.svg() == c.graph.pipeline.svg()
    assert again.graph.pipeline.outputs == c.graph.pipeline.outputs
    assert again.variants[0].pipeline.source is None
    assert again.quantities == c.quantities


@pytest.mark.parametrize(("n_places", "told"), [(1, "1 way "), (2, "2 ways "), (5, "")])
def test_few_placements_in_many_frames_are_told(n_places, told):
    """Of twelve frames."""
    given = [*islice(both().variants[0].pipeline.frames(), n_places)]
    again = [given[i % n_places].with_index(i) for i in range(12)]
    notes = compare(["discs", "next.yaml"], frames=again).notes
    assert [n.startswith(f"in 12 frames objects lie in {told}alone") for n in notes] == (
        [True] if told else []
    )
