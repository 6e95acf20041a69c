"""What the model was not designed for: found all the same, or said so."""

import math
from statistics import NormalDist

import numpy as np
import pytest

from helpers_likelihood import GRID, NOISE, drawn
from tactile_graph.wires import Circle, Image
from tactile_graph_likelihood.geometry.covered import covered
from tactile_graph_likelihood.geometry.outlines import DISC, packed
from tactile_graph_likelihood.single.density.goodness_of_fit import (
    dome,
    neighbours_alike,
    standardised,
    trend,
)
from tactile_graph_likelihood.single.model import Model
from tactile_graph_likelihood.single.readings import readings_of
from tactile_graph_pads.contact import spread
from tactile_graph_pads.geometry import Geometry

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("warm_kernels")]

DISCS = Model(DISC, noise=NOISE, whole=True)


def discs(n, seed):
    rng = np.random.default_rng(seed)
    for _ in range(n):
        radius = rng.uniform(5.0, 7.5)
        yield Circle(*rng.uniform(radius, 20.5 - radius, 2), radius), rng


def share_of(shape):
    kind, corners, p = packed(shape)
    return covered.reference(kind, corners, p, GRID, (0, 0, 16, 16))


def off(shape):
    """Return how far each element lies from the middle over the radius, along x and y."""
    at = 0.5 + 1.3 * np.arange(16)
    x = (at[None, :] - shape.x_cm) / shape.radius_cm
    return x, (at[:, None] - shape.y_cm) / shape.radius_cm


def shares_of_flagged(n, change, seed=3):
    flagged = 0
    for shape, rng in discs(n, seed):
        values = change(shape, drawn(shape, 80.0, rng).values, rng)
        found = DISCS.posterior(Image(values, (1.3, 1.3), (-0.15, -0.15), "gram"))
        flagged += not found.fits
    return flagged / n


def smooth(rng, width_cm):
    at = 1.3 * np.arange(16)
    kernel = np.exp(-0.5 * ((at[:, None] - at[None, :]) / width_cm) ** 2)
    root = np.linalg.cholesky(kernel + 1e-9 * np.eye(16))
    return root @ rng.standard_normal((16, 16)) @ root.T


def bumpy(shape, values, rng):
    return 80.0 * share_of(shape) * np.exp(0.48 * smooth(rng, 3.25))


def on_foam(shape, values, rng):
    load = spread(values, Geometry(), 0.65)
    return np.where(load < 5.0, 0.0, load)


def tilted(shape, values, rng):
    load = values * np.maximum(1.0 + 0.8 * off(shape)[0], 0.0)
    return np.where(load < 5.0, 0.0, load)


def with_strays(shape, values, rng):
    load = np.exp(rng.uniform(2.3, 4.6, values.shape))
    return np.where((values == 0.0) & (rng.random(values.shape) < 0.06), load, values)


def untouched(shape, values, rng):
    return values


@pytest.mark.parametrize("change", [bumpy, on_foam, tilted, with_strays])
def test_what_the_model_has_no_name_for_raises_the_flag(change):
    assert shares_of_flagged(24, change) >= 0.8


def test_what_the_model_made_itself_does_not():
    assert shares_of_flagged(80, untouched) <= 0.03


def test_voids_and_a_dead_row_hardly_move_the_answer():
    errors = []
    for shape, rng in discs(30, 4):
        values = drawn(shape, 80.0, rng, voids=0.3).values.copy()
        values[8] = 0.0
        found = DISCS.posterior(Image(values, (1.3, 1.3), (-0.15, -0.15), "gram")).mean
        errors.append(math.hypot(found[0] - shape.x_cm, found[1] - shape.y_cm))
    assert np.mean(errors) < 0.12


def test_faint_readings_beside_saturated_elements_count_as_nothing():
    errors = []
    for shape, rng in discs(20, 8):
        values = drawn(shape, 5000.0, rng).values
        ghosts = (values == 0.0) & (rng.random(values.shape) < 0.3)
        values = np.where(ghosts, 20.0 * np.exp(0.5 * rng.standard_normal(values.shape)), values)
        found = DISCS.posterior(Image(values, (1.3, 1.3), (-0.15, -0.15), "gram"))
        errors.append(math.hypot(found.mean[0] - shape.x_cm, found.mean[1] - shape.y_cm))
        assert found.fits
    assert np.mean(errors) < 0.1


def test_a_grain_that_bears_nearly_all_hides_nothing():
    for shape, rng in discs(5, 9):
        values = drawn(shape, 40.0, rng).values.copy()
        row, column = np.unravel_index(values.argmax(), values.shape)
        values[row, column] = 30_000.0
        image = Image(values, (1.3, 1.3), (-0.15, -0.15), "gram")
        assert readings_of(image, 0.3, 5.0).touched == (values >= 5.0).sum()
        found = DISCS.posterior(image)
        assert math.hypot(found.mean[0] - shape.x_cm, found.mean[1] - shape.y_cm) < 0.25


@pytest.mark.parametrize("which", ["reference", "call"])
def test_patterns_are_standard_normal_or_so_where_there_is_none(which):
    rng = np.random.default_rng(5)
    share = share_of(Circle(10.0, 10.0, 6.0))
    domes = getattr(dome, which)(share)
    alike, leans, falls = [], [], []
    for _ in range(150):
        residuals = np.where(share > 0.0, 3.0 * rng.standard_normal(share.shape) + 0.0, 0.0)
        alike.append(getattr(neighbours_alike, which)(residuals))
        lean, fall = getattr(trend, which)(residuals, domes)
        leans.append(lean)
        falls.append(fall)
    assert abs(np.mean(alike)) < 0.35
    assert 0.7 < np.std(alike) < 1.3
    assert np.mean(np.array(leans) > 3.0) <= 0.02
    assert abs(np.mean(leans)) < 0.4
    assert abs(np.mean(falls)) < 0.35
    assert 0.7 < np.std(falls) < 1.3


def test_a_pattern_is_found_whatever_its_size():
    rng = np.random.default_rng(6)
    shape = Circle(10.0, 10.0, 6.0)
    share = share_of(shape)
    domes, (x, y) = dome.call(share), off(shape)
    noise = rng.standard_normal(share.shape)

    def seen(pattern):
        return np.where(share > 0.0, pattern, 0.0)

    def lean_and_fall(pattern):
        return trend.call(seen(pattern), domes)

    assert max(np.abs(lean_and_fall(noise))) < 2.5
    for scale in (0.01, 100.0):
        assert lean_and_fall(scale * (noise + 2.0 * x))[0] > 3.5
        assert lean_and_fall(scale * (noise - 2.0 * y))[0] > 3.5
        assert lean_and_fall(scale * (noise + 2.0 * domes))[1] > 3.0
        assert lean_and_fall(scale * (noise - 2.0 * domes))[1] < -3.0
        assert neighbours_alike.call(seen(scale * smooth(rng, 3.0))) > 4.0
    assert lean_and_fall(2.0 * x * (rng.random(share.shape) < 0.05)) == (0.0, 0.0)


def test_a_dome_is_the_pressure_under_a_ball():
    shape = Circle(10.0, 10.0, 6.0)
    x, y = off(shape)
    squared = x * x + y * y
    near = squared < 0.7
    expected = 0.5 * np.log(1.0 - 0.85 * squared[near])
    found = dome.call(share_of(shape))
    np.testing.assert_allclose(found[near], expected, atol=0.05)


@pytest.mark.parametrize("z", [-0.8, 0.0, 1.0, 3.0])
def test_a_residual_that_shows_has_mean_0_and_variance_1(z):
    u = np.random.default_rng(7).standard_normal(400_000)
    normal = NormalDist()
    tail, density = normal.cdf(z), normal.pdf(z)
    kept = [standardised.call(float(v), z, tail, density) for v in u[u > -z][:20_000]]
    assert abs(np.mean(kept)) < 0.03
    assert np.var(kept) == pytest.approx(1.0, abs=0.06)
