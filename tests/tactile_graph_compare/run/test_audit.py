"""What a guard saves and costs, found by running what it keeps from running."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tactile_graph import Circle, Frame, loads
from tactile_graph.errors import UsageError
from tactile_graph.wires import TrueObject
from tactile_graph_compare.run.audit import audit
from tactile_graph_compare.variants.ablations import ablations_of

pytestmark = pytest.mark.usefixtures("hand_made")

HANDED = """\
pipeline: handed
source: {step: made, with: {frames: 10}}
nodes:
  footprint: {step: pressed, in: frame}
  cheap: {step: disc, in: footprint}
  good: {step: disc, in: footprint, when: cheap.x_cm > 2}
  whole: {step: merge, in: [footprint]}
  costly: {step: either, in: whole}
  circle: {first_of: [good, costly]}
outputs: [circle]
"""


def by_name(found):
    return {(g.node, g.kind): g for g in found.guards}


def test_every_guard_and_hand_over_that_is_asked_for_has_an_ablation():
    told = [(s.node, s.kind, s.text) for s in ablations_of(loads(HANDED))]
    assert told == [("good", "when", "cheap.x_cm > 2"), ("circle", "first_of", "without good")]


def test_a_guard_is_worth_what_its_ablation_runs_besides():
    pipeline = loads(HANDED)
    found = by_name(audit(pipeline))
    handed = found["circle", "first_of"]
    # The centre of what is found lies at 1, 2, 3, 4, 5 in turn: good answers in three of five.
    assert handed.n_stopped == 6
    assert handed.saved_us != 0.0
    # The costly one puts a circle at (1, 1) whatever comes: good is nearer, and that is won.
    (centre, _) = handed.differences
    assert centre.mean < 0.0
    assert (centre.n_both, centre.n_only_reference) == (10, 0)
    assert handed.n_changed == 6
    guard = found["good", "when"]
    assert guard.n_stopped == 4
    assert (guard.n_changed, guard.differences[0].mean > 0.0) == (4, True)


def test_a_pipeline_is_audited_by_its_name_or_file_too():
    frames = list(loads(HANDED).frames())
    Path("handed.yaml").write_text(HANDED)
    for given in ("handed.yaml", Path("handed.yaml")):
        assert by_name(audit(given, frames))["circle", "first_of"].n_stopped == 6
    assert audit("discs", frames).n_frames == 10
    with pytest.raises(UsageError, match="no pipeline named 'disc'; did you mean 'discs'"):
        audit("disc", frames)


def test_a_guard_against_an_empty_pad_prevents_failures_and_costs_no_answer():
    text = HANDED.replace("when: cheap.x_cm > 2", "when: footprint.count > 0")
    pipeline = loads(text.replace("[good, costly]", "[good]")).with_source(
        "made", frames=10, empty=[0, 5])  # fmt: skip
    guard = by_name(audit(pipeline))["good", "when"]
    assert (guard.n_stopped, guard.n_failed_prevented, guard.n_false_prevented) == (2, 2, 0)
    assert guard.saved_us > 0.0
    assert 0.0 < guard.saved_share < 1.0
    assert guard.saved_when_us == pytest.approx(5 * guard.saved_us)
    assert all(not d.mean and not d.n_only_reference for d in guard.differences)


def test_a_guard_that_keeps_a_false_answer_from_being_given_is_credited_with_it():
    text = HANDED.replace("when: cheap.x_cm > 2", "when: footprint.count > 3")
    pipeline = loads(text.replace("[good, costly]", "[good]"))
    small = np.zeros((3, 3))
    small[1, 1] = 1.0
    frames = [Frame.of(small, quantity="volt", truth=())]
    guard = by_name(audit(pipeline, frames))["good", "when"]
    assert (guard.n_stopped, guard.n_false_prevented) == (1, 1)
    lost = [Frame.of(small, quantity="volt", truth=(TrueObject(Circle(1.5, 1.5, 0.5)),))]
    guard = by_name(audit(pipeline, lost))["good", "when"]
    assert [d.n_only_reference for d in guard.differences] == [1, 1]


def test_a_guard_that_never_stops_anything_costs_what_only_it_needs():
    text = HANDED.replace("[good, costly]", "[good]").replace("cheap.x_cm > 2", "cheap.x_cm > 0")
    guard = by_name(audit(loads(text)))["good", "when"]
    # good and cheap are the same but for the guard; without it nothing asks for cheap.
    assert guard.n_stopped == 0
    assert guard.saved_us < 0.0


@pytest.mark.slow
def test_a_sample_is_seeded_and_takes_its_share():
    pipeline = loads(HANDED.replace("frames: 10", "frames: 200"))
    first, again = (audit(pipeline, sample=0.2, seed=3) for _ in range(2))
    assert first.n_seen == 200
    assert 20 < first.n_frames < 60
    indices = [a.everything.frames.indices.tolist() for a in (first, again)]
    assert indices[0] == indices[1]
    other = audit(pipeline, sample=0.2, seed=4).everything.frames.indices.tolist()
    assert other != indices[0]


def test_frames_handed_in_are_not_told_as_the_pipelines_own_source():
    pipeline = loads(HANDED)
    frames = list(pipeline.frames())[:5]
    found = audit(pipeline, frames)
    assert found.n_frames == 5
    assert found.everything.source == "frames handed in"
    assert "step" not in found.everything.provenance["source"]
