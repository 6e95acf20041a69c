"""Steps that bring in noise: as much of it as is asked for."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph import Image, Mask, Points
from tactile_graph_thesis.noise.add_noise import add_noise
from tactile_graph_thesis.noise.flip_cells import flip_cells
from tactile_graph_thesis.noise.jitter_points import jitter_points


def rng() -> np.random.Generator:
    return np.random.default_rng(1)


def test_noise_on_an_image_has_the_size_asked_for() -> None:
    image = Image(np.full((100, 100), 2.0), quantity="volt")
    noised = add_noise(image, sd=0.3, rng=rng())
    assert noised.quantity == "volt"
    assert (noised.values - 2.0).std() == pytest.approx(0.3, rel=0.05)
    assert (noised.values - 2.0).mean() == pytest.approx(0.0, abs=0.02)


def test_flipped_cells_have_the_shares_asked_for_each_way() -> None:
    on = np.zeros((200, 200), bool)
    on[:100] = True
    flipped = flip_cells(Mask(on), on=0.1, off=0.3, rng=rng()).values
    assert flipped[100:].mean() == pytest.approx(0.1, abs=0.01)
    assert 1 - flipped[:100].mean() == pytest.approx(0.3, abs=0.01)


def test_moved_points_are_moved_as_far_as_asked_for() -> None:
    moved = jitter_points(Points(np.zeros((5000, 2))), sd_cm=0.4, rng=rng()).xy_cm
    assert moved.std(axis=0) == pytest.approx([0.4, 0.4], rel=0.05)
    assert abs(np.corrcoef(moved.T)[0, 1]) < 0.05
