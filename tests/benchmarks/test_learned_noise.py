"""A pad's unevenness, learned from recordings of objects whose places are not known."""

import sys
from pathlib import Path

import numpy as np
import pytest

from helpers_likelihood import made
from tactile_graph import load
from tactile_graph_likelihood.single.footprint_of import FootprintDisc, FootprintRectangle

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from learned_noise import learned_noise

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("warm_kernels")]


def recorded(scene, sigma, voids, frames=12):
    source = load("circle-likelihood").with_source(
        "simulate", scene=scene, frames=frames, sigma=sigma, voids=voids
    )
    run = source.runner(only=["grams"])
    return [run(frame)["grams"] for frame in source.frames(5)]


@pytest.mark.parametrize(("sigma", "voids"), [(0.25, 0.05), (0.483, 0.164), (0.8, 0.3)])
def test_sigma_and_voids_come_back_from_a_simulated_recording(sigma, voids):
    found = learned_noise(
        made(FootprintDisc, on_pad="whole").model, recorded("discs", sigma, voids)
    )
    assert found.sigma == pytest.approx(sigma, rel=0.1)
    assert found.voids == pytest.approx(voids, abs=0.04)
    assert found.estimated == ()


def test_where_there_are_no_voids_hardly_any_are_learned():
    found = learned_noise(made(FootprintDisc, on_pad="whole").model, recorded("discs", 0.483, 0.0))
    assert found.voids < 0.01
    assert found.sigma == pytest.approx(0.483, rel=0.1)


def test_images_that_are_no_such_object_are_passed_over():
    images, model = recorded("discs", 0.483, 0.164, 6), made(FootprintDisc, on_pad="whole").model
    empty = images[0].with_values(np.zeros((16, 16)))
    assert learned_noise(model, iter([empty, *images])) == learned_noise(model, images)


def test_the_guess_matters_little():
    images = recorded("discs", 0.6, 0.2, 8)
    low, high = (
        learned_noise(made(FootprintDisc, on_pad="whole", sigma=sigma, voids=voids).model, images)
        for sigma, voids in ((0.3, 0.05), (1.2, 0.5))
    )
    for found in (low, high):
        assert found.sigma == pytest.approx(0.6, rel=0.12)
        assert found.voids == pytest.approx(0.2, abs=0.08)
    assert high.sigma == pytest.approx(low.sigma, rel=0.02)
    assert high.voids == pytest.approx(low.voids, abs=0.01)


def test_the_kind_of_outline_matters_little():
    found = learned_noise(made(FootprintRectangle).model, recorded("rectangles", 0.6, 0.2, 8))
    assert found.sigma == pytest.approx(0.6, rel=0.1)
    assert found.voids == pytest.approx(0.2, abs=0.08)


def test_what_was_learned_makes_an_uneven_pad_fit():
    images = recorded("discs", 0.9, 0.1, 16)
    model = made(FootprintDisc, on_pad="whole").model
    learned = made(
        FootprintDisc, on_pad="whole", sigma=learned_noise(model, images[:8]).sigma, voids=0.1
    ).model
    before = np.mean([model.posterior(image).fits for image in images[8:]])
    after = np.mean([learned.posterior(image).fits for image in images[8:]])
    assert before <= 0.5
    assert after >= 0.85
