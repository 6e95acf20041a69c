"""Pipelines on the likelihood: identified and located at once, followed over time, by order."""

import numpy as np
import pytest

from tactile_graph import Frame, load
from tactile_graph.engine.outcomes.outcome import Skipped
from tactile_graph_classifiers.measuring.shapes import true_name


@pytest.mark.slow
def test_objects_are_identified_and_located_at_once():
    pipeline = load("identify-likelihood")
    off = []
    for result in pipeline.stream(seed=2):
        found, true = result["identity"], result.frame.truth[0].shape
        assert found.name == true_name(result.frame)
        off.append(np.hypot(found.object.x_cm - true.x_cm, found.object.y_cm - true.y_cm))
    assert len(off) == 20
    assert np.mean(off) < 0.15


@pytest.mark.slow
def test_a_followed_disc_shows_its_radius_ever_better():
    pipeline = load("circle-followed")
    results = list(pipeline.stream(seed=3))
    stated = [r["disc.shape"].radius_std_cm for r in results]
    assert [r["disc.placements"] for r in results] == list(range(1, len(results) + 1))
    assert stated[-1] < 0.5 * stated[0]
    last = results[-1]
    true = last.frame.truth[0].shape.radius_cm
    assert last["disc.shape"].radius_cm == pytest.approx(true, abs=0.05)


@pytest.mark.slow
def test_the_order_of_volts_locates_a_disc():
    pipeline = load("circle-by-order")
    off = []
    for result in pipeline.stream(seed=4):
        found, true = result["circle"], result.frame.truth[0].shape
        off.append((np.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm),
                    abs(found.radius_cm - true.radius_cm)))  # fmt: skip
    centre, radius = np.mean(off, axis=0)
    assert centre < 0.15
    assert radius < 0.15


@pytest.mark.parametrize("name", ["identify-likelihood", "circle-followed", "circle-by-order"])
def test_an_empty_pad_is_skipped(name):
    pipeline = load(name)
    result = pipeline.run(Frame.of(np.zeros((16, 16)), 1.3, quantity="volt"))
    for output in pipeline.outputs:
        assert isinstance(result.outcome(output), Skipped)
