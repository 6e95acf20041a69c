"""The shipped pipeline that finds several objects at once by their likelihood."""

import numpy as np
import pytest

from tactile_graph import Frame, load
from tactile_graph.engine.outcomes.outcome import Skipped
from tactile_graph_tracking.score_objects import score_objects

pytestmark = [
    pytest.mark.slow,  # the kernels alone compile for half a minute
    pytest.mark.usefixtures("warm_kernels"),
]


def test_one_to_six_objects_are_counted_and_placed() -> None:
    pipeline = load("objects-likelihood").with_source("simulate", scene="mixed", frames=18)
    scores = [score_objects(r.frame, r["objects"].shapes) for r in pipeline.stream(seed=4)]
    assert len(scores) == 18
    assert np.mean([s.count_right for s in scores]) >= 0.8
    errors = [e for s in scores for *_, e in s.pairs]
    assert np.median(errors) < 0.2


def test_an_empty_pad_has_no_objects() -> None:
    empty = Frame.of(np.zeros((16, 16)), 1.3, (-0.15, -0.15), "volt", truth=())
    result = load("objects-likelihood").run(empty)
    assert isinstance(result.outcome("objects"), Skipped)
    assert not result.failures
