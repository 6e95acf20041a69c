"""The shipped pipeline that finds several objects on any pad."""

import numpy as np
import pytest

from tactile_graph import Frame, load
from tactile_graph.compiled import warm_up
from tactile_graph.engine.outcomes.outcome import Skipped
from tactile_graph_tracking.score_objects import score_objects

pytestmark = pytest.mark.slow  # the kernels alone compile for a quarter of a minute


@pytest.fixture(autouse=True, scope="module")
def compiled() -> None:
    warm_up()


def test_most_scenes_of_one_to_six_objects_are_counted() -> None:
    pipeline = load("locate-objects").with_source("simulate", scene="mixed", frames=18)
    scores = [score_objects(r.frame, r["objects"].shapes) for r in pipeline.stream(seed=4)]
    assert np.mean([s.count_right for s in scores]) >= 0.6
    errors = [e for s in scores for *_, e in s.pairs]
    assert np.median(errors) < 0.25


def test_an_empty_pad_has_no_objects() -> None:
    empty = Frame.of(np.zeros((16, 16)), 1.3, (-0.15, -0.15), "volt", truth=())
    result = load("locate-objects").run(empty)
    assert isinstance(result.outcome("objects"), Skipped)
    assert not result.failures
