"""The vector from an object's geometric centre to the centre of its load."""

import math

import numpy as np
import pytest

from helpers_rectangles import covered
from tactile_graph.errors import Degenerate, RuleError
from tactile_graph.wires import Image, Mask, Rectangle
from tactile_graph_fitters.orientation.heavier_side import heavier_side

BLOCK = covered(Rectangle(10.0, 10.0, 12.0, 6.0, 0.0))


def tilted(dx, dy):
    """A linear pressure over the block whose centre lies (dx, dy) off its own."""
    x, y = np.meshgrid(BLOCK.x_cm, BLOCK.y_cm)
    load = 1.0 + 12.0 * dx * (x - 10.0) / 144.0 + 12.0 * dy * (y - 10.0) / 36.0
    return Image(np.where(BLOCK.values, load, 0.0), BLOCK.pitch_cm, quantity="gram")


@pytest.mark.parametrize(("dx", "dy"), [(1.0, 0.0), (-0.5, 0.4), (0.0, -0.6)])
def test_a_tilted_block_gives_the_vector_of_its_tilt(dx, dy):
    got = heavier_side(tilted(dx, dy), BLOCK)
    assert (got.dx_cm, got.dy_cm) == pytest.approx((dx, dy), rel=0.02, abs=1e-9)
    assert got.distance_cm == pytest.approx(math.hypot(dx, dy), rel=0.02)
    assert math.remainder(got.angle_rad - math.atan2(-dy, dx), 2 * math.pi) == pytest.approx(
        0.0, abs=0.02
    )
    assert got.clear


def test_an_even_block_has_no_heavier_side():
    got = heavier_side(tilted(0.0, 0.0), BLOCK)
    assert got.distance_cm == pytest.approx(0.0, abs=1e-12)
    assert not got.clear


def test_scatter_alone_is_rarely_clear():
    rng = np.random.default_rng(0)
    clear = [
        heavier_side(
            Image(BLOCK.values * np.exp(0.5 * rng.standard_normal(BLOCK.shape)), BLOCK.pitch_cm),
            BLOCK,
        ).clear
        for _ in range(200)
    ]
    assert np.mean(clear) < 0.06


def test_a_fitted_shape_gives_the_geometric_centre():
    got = heavier_side(tilted(0.0, 0.0), BLOCK, Rectangle(9.0, 10.5, 12, 6, 0.0))
    assert (got.dx_cm, got.dy_cm) == pytest.approx((1.0, -0.5))
    assert (got.load_x_cm, got.load_y_cm) == pytest.approx((10.0, 10.0))


def test_angles_are_as_seen_with_y_down():
    assert heavier_side(tilted(0.0, -0.5), BLOCK).angle_deg == pytest.approx(90.0)


def test_an_empty_footprint_and_one_without_load_are_refused():
    nothing = Mask(np.zeros(BLOCK.shape, bool), BLOCK.pitch_cm)
    with pytest.raises(Degenerate, match="no valid cell is on: no side is heavier"):
        heavier_side(tilted(0.0, 0.0), nothing)
    with pytest.raises(Degenerate, match="cells bear no load: no side is heavier"):
        heavier_side(Image(np.zeros(BLOCK.shape), BLOCK.pitch_cm), BLOCK)


def test_image_and_mask_must_be_of_one_grid():
    with pytest.raises(RuleError, match=r"same shape, got \(4, 4\)"):
        heavier_side(Image(np.ones((4, 4))), BLOCK)
