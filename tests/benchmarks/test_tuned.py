"""The benchmark of tuned guards: what it is told on chose nothing."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tactile_graph import load
from tactile_graph_compare.score.answers import answers_of
from tactile_graph_tune.shares import weights_of

FOLDER = Path(__file__).parents[2] / "benchmarks"
sys.path.insert(0, str(FOLDER))
import tuned  # noqa: E402


def test_pads_that_report_are_of_other_kinds_than_those_that_choose() -> None:
    assert set(tuned.SEEN) & set(tuned.UNSEEN) == set()
    assert set(tuned.SEEN) | set(tuned.UNSEEN) == set(tuned.KINDS)


@pytest.mark.slow
def test_the_parts_of_a_stream_are_as_many_and_count_for_what_they_stand_for() -> None:
    frames = tuned.stream_parts("noise 1 mV", 60, 3) + tuned.streamed(60, 3)
    empty = [f for f in frames if not f.truth]
    assert len(empty) == 40
    assert {f.label for f in empty} == {"empty"}
    assert max(abs(f.image.values).max() for f in empty) < 0.01
    assert all(f.image.values.max() > 0.05 for f in frames[:60] if f.truth)
    sides = [np.arange(60), np.arange(60, 120)]
    labelled = [replace(f, label=f"{f.label} own") for f in frames]
    weights = weights_of(labelled, tuned.stream_shares(), sides)
    shares = {part: sum(w for f, w in zip(labelled, weights, strict=True) if part in f.label)
              for part in tuned.PARTS}  # fmt: skip
    assert [shares[part] / 120.0 for part in tuned.PARTS] == pytest.approx([0.8, 0.15, 0.05])


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(tuned.CASES))
def test_every_ladder_answers_what_its_truth_can_judge(name: str) -> None:
    case = tuned.CASES[name]
    ladder = load(case.path)
    output = next(iter(ladder.outputs))
    assert set(answers_of(ladder, (output,)).quantities) & {"centre", "identity"}
    (frame, *_) = tuned.frames_of(case, tuned.UNSEEN[:1], 2, 1, own=False)
    assert ladder.run(frame).outcome(output) is not None


@pytest.mark.parametrize("name", ["circles", "stream", "mixture", "rectangles"])
def test_guards_set_by_eye_are_others_than_those_to_be_beaten(name: str) -> None:
    case = tuned.CASES[name]
    assert load(case.eye_path).key != load(case.by_hand).key
