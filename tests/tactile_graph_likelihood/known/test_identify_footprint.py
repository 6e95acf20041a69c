"""Known objects by shape, size and weight in one likelihood; sizes from touched elements."""

import math

import numpy as np
import pytest

from helpers_likelihood import NOISE, drawn, made
from tactile_graph.errors import DataError, Degenerate, UsageError
from tactile_graph.wires import Circle, Ellipse, Image, Rectangle
from tactile_graph_classifiers.database.opening import load_known
from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE
from tactile_graph_likelihood.known.identify_footprint import IdentifyFootprint
from tactile_graph_likelihood.known.known_footprints import KnownFootprint
from tactile_graph_likelihood.known.touched_sizes import Touching, sizes_from
from tactile_graph_likelihood.single.model import Model
from tactile_graph_likelihood.single.readings import readings_of

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("warm_kernels")]

TRUE = {
    "Disc I": [6.9], "Disc II": [3.8], "Disc III": [5.1], "Disc IV": [7.7],
    "RECTANGLE I": [8.0, 3.5], "RECTANGLE II": [7.0, 1.5],
}  # fmt: skip


def database(weights, shape="disc", area=100.0, quantity="gram"):
    """Return an export of objects that differ in weight alone, of 25 readings each."""
    rows = [[1.0 + 0.001 * (k - 12), area * (1.0 + 0.002 * (k - 12))] for k in range(25)]
    return {
        "format": "tactile-graph objects",
        "version": 1,
        "quantity": quantity,
        "features": ["weight", "area_cm2"],
        "objects": [
            {"name": n, "shape": shape, "readings": [[w * g, a] for g, a in rows]}
            for n, w in weights.items()
        ],
    }


def weighing(image, grams):
    return image.with_values(image.values * grams / image.values.sum())


def test_sizes_of_the_sample_come_from_its_touched_elements():
    for it in made(IdentifyFootprint)._objects:
        if it.name in TRUE:
            ((_, _, sizes),) = it.outlines
            assert sizes.mean == pytest.approx(np.array(TRUE[it.name]), rel=0.03)
    pentagon = next(o for o in made(IdentifyFootprint)._objects if o.name == "PENTAGON")
    five = next(s for _, n, s in pentagon.outlines if n == 5)
    assert five.mean[0] == pytest.approx(4.0, rel=0.04)


@pytest.mark.parametrize(
    ("kind", "shape", "halves"),
    [
        (DISC, lambda x, t: Circle(10 + x, 10, 4.5), [4.5]),
        (RECTANGLE, lambda x, t: Rectangle(10 + x, 10, 8.0, 7.8, t), [4.0, 3.9]),
    ],
)
def test_sizes_are_those_of_images_that_the_model_makes(kind, shape, halves):
    rng, rows = np.random.default_rng(1), []
    for k in range(60):
        image = drawn(shape(0.02 * k, 0.05 * k), 60.0, rng)
        v, u = np.nonzero(image.values)
        matrix = np.cov(u, v, ddof=0) + np.eye(2) / 12.0
        axes = 2.0 * 1.3 * np.sqrt(np.linalg.eigvalsh(matrix)[::-1])
        rows.append([1.69 * len(u)] if kind == DISC else axes)
    area = math.pi * 4.5**2 if kind == DISC else 62.4
    weight = 60.0 * area / 1.69 * 0.84 * math.exp(0.5 * 0.48**2)
    grid = readings_of(image, 0.3, 5.0)
    found = sizes_from(
        kind, 0, Touching(Model(kind, noise=NOISE), grid, weight, 5.0), np.array(rows)
    )
    assert found.mean == pytest.approx(np.array(halves), rel=0.03)


def test_equal_weight_and_area_but_another_shape_is_told_apart():
    data = {
        "format": "tactile-graph objects", "version": 1, "quantity": "gram",
        "features": ["weight", "area_cm2"],
        "objects": [
            {"name": n, "shape": s, "readings": [[2000.0 + k, 90.0 + k] for k in range(5)]}
            for n, s in (("puck", "disc"), ("slab", "rectangle"), ("oval", "ellipse"))
        ],
    }  # fmt: skip
    sizes = {
        "puck": {"shape": "disc", "radius_cm": 4.5},
        "slab": {"shape": "rectangle", "length_cm": 10.2, "breadth_cm": 6.1},
        "oval": {"shape": "ellipse", "semi_major_cm": 5.9, "semi_minor_cm": 3.4},
    }
    step, rng, right = made(IdentifyFootprint, database=data, sizes=sizes, on_pad="whole"), None, 0
    rng = np.random.default_rng(2)
    outlines = {
        "puck": Circle(10.0, 9.5, 4.5),
        "slab": Rectangle(10.0, 9.5, 10.2, 6.1, 0.7),
        "oval": Ellipse(10.0, 9.5, 5.9, 3.4, -0.5),
    }
    for name, outline in outlines.items():
        for _ in range(6):
            found = step(weighing(drawn(outline, 60.0, rng), 2002.0))
            right += found.name == name
            assert found.shape == sizes[found.name]["shape"] if found.known else True
            assert found.probability + found.runner_up_probability <= 1.0 + 1e-9
            assert np.hypot(found.object.x_cm - 10.0, found.object.y_cm - 9.5) < 0.5
    assert right >= 17


def test_weight_tells_equal_shapes_apart_and_a_stranger_is_unknown():
    step = made(
        IdentifyFootprint,
        database=database({"light": 2000.0, "heavy": 2100.0}),
        sizes={n: {"shape": "disc", "radius_cm": 5.5} for n in ("light", "heavy")},
        on_pad="whole",
    )
    rng = np.random.default_rng(3)
    image = drawn(Circle(10.0, 9.5, 5.5), 40.0, rng)
    for grams, name in ((2000.0, "light"), (2100.0, "heavy"), (2600.0, "unknown")):
        found = step(weighing(image, grams))
        assert found.name == name
        assert found.probability > 0.9
        assert found.known == (name != "unknown")
    smaller = step(weighing(drawn(Circle(10.0, 9.5, 4.0), 40.0, rng), 2000.0))
    assert smaller.name == "unknown"
    assert smaller.object.radius_cm == pytest.approx(4.0, abs=0.3)


def test_the_density_of_a_weight_is_one():
    it = KnownFootprint("a", "disc", (), 7.0, 0.02, 4.0)
    at = np.linspace(6.0, 8.0, 20001)
    assert np.trapezoid([math.exp(it.log_density(x)) for x in at], at) == pytest.approx(
        1.0, abs=1e-3
    )


def test_what_cannot_be_used_is_refused_in_words():
    with pytest.raises(UsageError, match="no object named 'Disk I' is known"):
        made(IdentifyFootprint, sizes={"Disk I": {"shape": "disc", "radius_cm": 1.0}})
    with pytest.raises(DataError, match="has two sizes, but semi_major_cm and semi_minor_cm"):
        made(IdentifyFootprint, database=database({"slab": 2000.0}, "rectangle"))
    with pytest.raises(DataError, match="was learned without a shape"):
        made(IdentifyFootprint, database=database({"thing": 2000.0}, ""))
    corners = {"shape": "polygon", "corners_cm": [[0, 0], [3, 0], [0, 3]]}
    with pytest.raises(UsageError, match="needs sides and radius_cm"):
        made(IdentifyFootprint, database=database({"a": 2000.0}), sizes={"a": corners})
    with pytest.raises(DataError, match="learned in kilopascal; they are needed in gram"):
        made(IdentifyFootprint, database=database({"a": 2000.0}, quantity="kilopascal"))
    empty = Image(np.zeros((16, 16)), (1.3, 1.3), (-0.15, -0.15), "gram")
    with pytest.raises(Degenerate, match="no element bears a load"):
        made(IdentifyFootprint)(empty)


def test_all_objects_of_the_sample_are_taken():
    names = tuple(o.name for o in made(IdentifyFootprint)._objects)
    assert names == load_known(None, ["weight"]).names
