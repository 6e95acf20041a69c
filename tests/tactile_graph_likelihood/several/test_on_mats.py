"""Large things on large mats of pressure: counts and lengths, and that bare cells hold outlines."""

import numpy as np
import pytest

from tactile_graph.compiled import warm_up
from tactile_graph.wires import Circle, Image, Rectangle
from tactile_graph_likelihood.any_pad.observation.observed import observed
from tactile_graph_likelihood.several.locate_objects import LocateObjects
from tactile_graph_likelihood.several.sides import sides_moved
from tactile_graph_pads.pad import load_pad

pytestmark = pytest.mark.slow  # the kernels alone compile for a quarter of a minute

CARTON, EVEN_CARTON = Rectangle(75.0, 24.0, 25.0, 18.0, -0.35), Rectangle(75.0, 24.0, 25.0, 18.0, 0)
BAR, CUP = Rectangle(30.0, 42.0, 40.0, 6.0, 0.0), Circle(8.0, 10.0, 4.0)
FINE = 4  # places of a cell, each way, at which its pressure is looked at


@pytest.fixture(autouse=True, scope="module")
def compiled():
    warm_up()


def covered(shape, x, y):
    """Return where places lie on a shape."""
    x, y = x - shape.x_cm, y - shape.y_cm
    if isinstance(shape, Circle):
        return np.hypot(x, y) < shape.radius_cm
    cos, sin = np.cos(shape.angle_rad), np.sin(shape.angle_rad)
    along, across = x * cos - y * sin, x * sin + y * cos
    return (abs(along) < 0.5 * shape.length_cm) & (abs(across) < 0.5 * shape.breadth_cm)


def mat_under(pressures, seed, shape=(48, 96)):
    """Return an image of shapes under kPa on a mat of 1 cm, with gains of 0.1 and noise."""
    rows, columns = (np.arange(FINE * n) / FINE + 0.5 / FINE for n in shape)
    x, y = np.meshgrid(columns, rows)
    load = sum(kpa * covered(its, x, y) for its, kpa in pressures)
    load = load.reshape(shape[0], FINE, shape[1], FINE).mean(axis=(1, 3))
    rng = np.random.default_rng(seed)
    read = load * np.exp(rng.normal(0.0, 0.1, shape)) + rng.normal(0.0, 0.15, shape)
    return Image(np.round(read / 0.1) * 0.1, (1.0, 1.0), (0.0, 0.0), "kilopascal")


@pytest.mark.parametrize("seed", [101, 102, 103])
def test_nothing_is_found_beside_one_large_object(seed):
    """Tiny outlines on bare cells, or along its edge, explain next to no cell of their own."""
    found = LocateObjects()(mat_under([(CARTON, 4.0)], seed))
    assert found.count == 1
    (its,) = found.shapes
    assert its.length_cm == pytest.approx(25.0, abs=0.3)


@pytest.mark.parametrize("seed", [104, 107, 110])
def test_what_a_strip_along_an_edge_explains_is_the_large_object_s(seed):
    found = LocateObjects()(mat_under([(EVEN_CARTON, 4.0), (CUP, 5.0)], seed))
    assert found.count == 2


def test_bare_cells_hold_an_outline_however_far_it_grows():
    cups = [Circle(x, y, 4.0) for x, y in ((8.0, 10.0), (21.0, 10.0), (8.0, 24.0))]
    image = mat_under([(BAR, 6.0), *((cup, 5.0) for cup in cups)], 106)
    (bar,) = (its for its in LocateObjects()(image).shapes if hasattr(its, "length_cm"))
    assert bar.length_cm == pytest.approx(40.0, abs=4.0 * bar.length_std_cm)


@pytest.mark.parametrize("seed", [100, 106])
def test_an_object_whose_edges_lie_in_gaps_is_one(seed):
    """All its readings are alike, so that they seem to begin just below."""
    found = LocateObjects()(mat_under([(BAR, 6.0)], seed))
    assert (found.count, found.fits) == (1, True)


def test_a_side_in_a_wrong_gap_is_moved_to_where_it_is_likelier():
    _, found = LocateObjects().searched(
        observed(mat_under([(EVEN_CARTON, 4.0)], 107), load_pad("thesis"))
    )
    scene, its = found.parts[0].scene, found.outlines
    wide = its.with_one(0, its)
    wide.points[0, [0, 2]] += 0.78  # its right side in another gap
    moved = sides_moved(scene.problem, wide)
    before, after = (scene.settled(one, most=0)[0].log_evidence for one in (wide, moved))
    assert after > before + 10.0
    assert moved.points[0, 2] < 13.0
    assert sides_moved(scene.problem, its) is its
