"""Steps that are told no sizes, on pads far larger and far finer than the thesis'."""

import numpy as np
import pytest

from helpers_likelihood import made
from tactile_graph.wires import Circle, Image, Rectangle
from tactile_graph_likelihood.by_order.footprint_by_order import FootprintByOrder
from tactile_graph_likelihood.known.identify_footprint import IdentifyFootprint
from tactile_graph_likelihood.over_time.follow_footprint import FollowFootprint
from tactile_graph_pads.coverage.coverage import coverage_cm2
from tactile_graph_pads.geometry import Geometry

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("warm_kernels")]

SIGMA, VOIDS = 0.3, 0.05


MAT = Geometry(64, 27, 2.7, 0.3)
"""A floor mat of 3 cm pitch, 192 cm long."""

FINGERTIP = Geometry(16, 16, 0.17, 0.03)
"""A pad of 0.2 cm pitch, 3.2 cm wide."""

CASES = [
    # what searches a large pad is compiled for it
    pytest.param(MAT, Circle(40.0, 90.0, 22.0), id="mat", marks=pytest.mark.slow),
    pytest.param(FINGERTIP, Circle(1.5, 1.7, 0.32), id="fingertip"),
]


def pad_of(geometry):
    return {
        "geometry": {"rows": geometry.rows, "columns": geometry.columns,
                     "element_cm": geometry.element_cm, "gap_cm": geometry.gap_cm},
        "unevenness": {"sigma": SIGMA, "voids": VOIDS},
    }  # fmt: skip


def image_of(shape, geometry, seed, grams=60.0):
    rng = np.random.default_rng(seed)
    share = coverage_cm2(shape, geometry) / geometry.element_cm**2
    load = grams * share * np.exp(SIGMA * rng.standard_normal(share.shape))
    load[(load < 5.0) | (rng.random(share.shape) < VOIDS)] = 0.0
    pitch = geometry.pitch_cm
    return Image(load, (pitch, pitch), geometry.origin_cm, "gram")


def near(found, true, pitch):
    assert np.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm) < 0.3 * pitch
    assert found.radius_cm == pytest.approx(true.radius_cm, abs=0.3 * pitch)


@pytest.mark.slow
@pytest.mark.parametrize(("geometry", "disc"), CASES)
def test_an_outline_by_order_and_one_over_time_need_no_sizes(geometry, disc):
    pad = pad_of(geometry)
    near(made(FootprintByOrder, pad=pad)(image_of(disc, geometry, 1)), disc, geometry.pitch_cm)
    step = made(FollowFootprint, pad=pad)
    for seed in range(3):
        found = step(image_of(disc, geometry, seed), gap_s=1.0)
        near(found.shape, disc, geometry.pitch_cm)
    assert found.placements == 3  # sizes were carried, so their range is known


@pytest.mark.parametrize(("geometry", "disc"), CASES)
def test_an_object_is_identified_and_a_stranger_is_unknown_without_sizes(geometry, disc):
    images = [image_of(disc, geometry, seed) for seed in range(4)]
    weights = [float(image.values.sum()) for image in images]
    data = {
        "format": "tactile-graph objects", "version": 1, "quantity": "gram",
        "features": ["weight", "area_cm2"],
        "objects": [{"name": "it", "shape": "disc",
                     "readings": [[w, disc.area_cm2 * (1.0 + 0.01 * k)]
                                  for k, w in enumerate(weights)]}],
    }  # fmt: skip
    sizes = {"it": {"shape": "disc", "radius_cm": disc.radius_cm}}
    step = made(IdentifyFootprint, database=data, sizes=sizes, pad=pad_of(geometry))
    found = step(images[0])
    assert found.name == "it"
    near(found.object, disc, geometry.pitch_cm)
    large = 1.7 * disc.radius_cm
    slab = Rectangle(disc.x_cm, disc.y_cm, 2.0 * large, 1.2 * large, 0.5)
    other = image_of(slab, geometry, 9)
    alike = other.with_values(other.values * (weights[0] / other.values.sum()))
    found = step(alike)
    assert found.name == "unknown"
    assert found.object.length_cm == pytest.approx(2.0 * large, abs=geometry.pitch_cm)


@pytest.mark.parametrize("step", [FootprintByOrder, FollowFootprint, IdentifyFootprint])
def test_sizes_out_of_order_are_refused(step):
    with pytest.raises(ValueError, match="smallest_cm: must be below largest_cm, got 9 and 3"):
        made(step, smallest_cm=9.0, largest_cm=3.0)
