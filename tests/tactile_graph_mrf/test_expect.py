"""The image an object of known outline should give, and what it does as a prior."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph import loads
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Circle, Image, Rectangle
from tactile_graph_mrf.descent.restore import restore
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.expect import expect


def test_the_load_of_a_rectangle_is_spread_over_the_cells_it_covers():
    image = Image(np.zeros((6, 8)), (0.5, 0.5), (1.0, 2.0), "gram")
    expected = expect(image, Rectangle(2.5, 3.5, 2.0, 1.0, 0.0), load=3.0, known=0.0)
    wanted = np.zeros((6, 8))
    wanted[2:4, 1:5] = 3.0
    np.testing.assert_allclose(expected.values, wanted)
    assert expected.quantity == "gram"
    assert (expected.pitch_cm, expected.origin_cm) == (image.pitch_cm, image.origin_cm)


def test_without_a_load_the_images_own_is_kept():
    image = Image(np.full((12, 12), 2.0))
    expected = expect(image, Circle(6.0, 6.0, 3.0), known=0.0)
    share = expected.values / expected.values.max()
    assert share.sum() == pytest.approx(np.pi * 9, rel=0.02)
    touched = share > 0
    assert expected.values.sum() == pytest.approx(2.0 * np.count_nonzero(touched))


def test_cells_on_the_edge_are_left_to_the_data():
    expected = expect(Image(np.ones((12, 12))), Circle(6.0, 6.0, 3.2), load=1.0)
    assert expected.valid is not None
    assert expected.valid[6, 6]
    assert expected.valid[0, 0]
    assert not expected.valid[6, 2]  # from 2.8 on, so a fifth of it
    assert set(expected.values[expected.valid]) == {0.0, 1.0}


def test_an_outline_off_the_pad_is_refused_in_words():
    with pytest.raises(Degenerate, match="covers no cell"):
        expect(Image(np.ones((4, 4))), Circle(50.0, 50.0, 1.0))


@pytest.mark.slow  # all kinds of moves are compiled
def test_knowing_the_class_restores_better():
    """Noise as high as the load: the outline of the class, with its load, brings it back."""
    rng = np.random.default_rng(0)
    truth = np.zeros((16, 16))
    truth[4:10, 5:12] = 1.0
    image = Image(truth + rng.standard_normal(truth.shape))
    expected = expect(image, Rectangle(8.5, 7.0, 7.0, 6.0, 0.0), load=1.0)
    error = {}
    for weight in (0.0, 5.0):
        model = Model(lines="none", smoothness="truncated_quadratic", lambda_prior=weight)
        restored = restore(image, None, expected, model=model)
        error[weight] = np.sqrt(np.mean((restored.image.values - truth) ** 2))
    assert error[5.0] < 0.5 * error[0.0]


@pytest.mark.slow  # all kinds of moves are compiled
def test_it_is_wired_into_a_restorer():
    text = """
pipeline: p
source: {step: simulate, with: {frames: 1}}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  edge: {step: boundary_scan, in: footprint}
  hull: {step: hull, in: edge}
  circle: {step: fit_circle, in: hull}
  expected: {step: expect, in: {image: frame, shape: circle}}
  restored:
    step: restore
    in: {image: frame, expected: expected}
    with: {model: {lambda_prior: 1}}
outputs: [restored]
"""
    plain = text.replace("lambda_prior: 1", "lambda_prior: 0")
    one, two = (next(iter(loads(t).stream(seed=1)))["restored"] for t in (text, plain))
    assert not np.array_equal(one.image.values, two.image.values)
