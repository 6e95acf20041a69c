"""Objects that press unevenly, chosen among shapes, identified, and followed over time."""

import math

import numpy as np
import pytest

from helpers_likelihood import NOISE, drawn, made
from tactile_graph.wires import Circle, Image, Rectangle
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, RECTANGLE
from tactile_graph_likelihood.known.identify_footprint import IdentifyFootprint
from tactile_graph_likelihood.over_time.follow_footprint import FollowFootprint
from tactile_graph_likelihood.single.any_pressure import EVEN, AnyPressure, asked_by, mixed
from tactile_graph_likelihood.single.choose_shape import ChooseShape
from tactile_graph_likelihood.single.frame_fits import FrameFits
from tactile_graph_likelihood.single.model import Model
from tactile_graph_likelihood.single.readings import readings_of

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("warm_kernels")]


DISC_CM = Circle(10.0, 9.5, 6.4)


def pressed(seed, face, disc=DISC_CM):
    """Return a disc's image whose load leans, or falls to the rim as a ball's."""
    rng = np.random.default_rng(seed)
    image, (y, x) = drawn(disc, 70.0, rng, least_g=0.0), np.mgrid[0:16, 0:16] * 1.3 + 0.5
    u, v = (x - disc.x_cm) / disc.radius_cm, (y - disc.y_cm) / disc.radius_cm
    if face == "leans":
        way = rng.uniform(0.0, 2.0 * math.pi)
        share = np.exp(1.1 * (u * math.cos(way) + v * math.sin(way)))
    else:
        share = np.sqrt(np.maximum(1.0 - u * u - v * v, 0.02))
    loads = image.values * share
    return image.with_values(np.where(loads < 5.0, 0.0, loads))


@pytest.mark.parametrize("face", ["leans", "ball"])
def test_a_disc_that_presses_unevenly_is_still_a_disc(face):
    seen = [pressed(seed, face) for seed in range(16)]
    right, stated, off = {}, {}, {}
    for pressure in ("any", "even"):
        found = [made(ChooseShape, on_pad="whole", pressure=pressure)(image) for image in seen]
        right[pressure] = np.mean([f.name == "disc" for f in found])
        stated[pressure] = np.mean([f.disc for f in found])
        off[pressure] = np.mean([math.hypot(f.shape.x_cm - 10.0, f.shape.y_cm - 9.5)
                                 + abs(math.sqrt(f.shape.area_cm2 / math.pi) - 6.4)
                                 for f in found])  # fmt: skip
    assert right["any"] >= 0.9
    assert right["any"] >= right["even"]
    assert stated["any"] > stated["even"]
    assert off["any"] < 0.6 * off["even"]


def test_an_even_object_is_chosen_as_without_the_question_and_mostly_not_asked():
    rng, asked = np.random.default_rng(2), 0
    steps = [made(ChooseShape, on_pad="whole", pressure=pressure) for pressure in ("any", "even")]
    for k in range(20):
        shape = DISC_CM if k % 2 else Rectangle(10.0, 9.5, 13.0, 7.0, 0.4)
        image = drawn(shape, 60.0, rng)
        found, even = (step(image) for step in steps)
        assert found.name == even.name
        if [*found.shape.posterior.pressures] == [EVEN]:
            assert found.probability == even.probability
        else:
            asked += 1
            assert found.probability == pytest.approx(even.probability, abs=0.15)
    assert asked <= 7


def test_evidence_of_shapes_compares_though_one_alone_leaves_a_pattern():
    image = pressed(3, "leans")
    outlines = [AnyPressure(Model(kind, noise=NOISE, whole=True)) for kind in (DISC, ELLIPSE)]
    fits = FrameFits(readings_of(image, 0.3, 5.0), outlines)
    asked = asked_by(fits.found.values(), outlines[0].others)
    assert "lean" in asked
    before = fits.look_under(asked)
    assert sum(before.values()) == pytest.approx(1.0)
    for k in range(2):
        parts = [fits.logs[k, part] + math.log(before[part]) for part in before]
        assert fits.evidence(k, before) == pytest.approx(np.logaddexp.reduce(parts))
    assert fits.likeliest("lean") is fits.found[0, "lean"]
    assert fits.posterior(0, before).pressures["lean"] > 0.9


def test_a_mixture_of_turned_rectangles_is_one_rectangle():
    image = drawn(Rectangle(10.0, 9.5, 13.0, 7.0, 0.4), 60.0, np.random.default_rng(4))
    model = Model(RECTANGLE, noise=NOISE, whole=True)
    one = model.posterior(image)
    turned = Rectangle(10.0, 9.5, 7.0, 13.0, 0.4 - 0.5 * math.pi)
    other = AnyPressure(model).others["lean"].posterior(image, turned)
    both = mixed({EVEN: one, "lean": other}, {EVEN: 0.5, "lean": 0.5})
    assert both.mean[:5] == pytest.approx(one.mean[:5], abs=0.15)
    assert np.sqrt(np.diag(both.covariance))[2:4].max() < 0.5


def database(weights, radius_cm):
    rows = [[1.0 + 0.001 * (k - 12), 100.0 * (1.0 + 0.002 * (k - 12))] for k in range(25)]
    return {
        "format": "tactile-graph objects", "version": 1, "quantity": "gram",
        "features": ["weight", "area_cm2"],
        "objects": [{"name": n, "shape": "disc", "readings": [[w * g, a] for g, a in rows]}
                    for n, w in weights.items()],
    }, {n: {"shape": "disc", "radius_cm": radius_cm} for n in weights}  # fmt: skip


@pytest.mark.parametrize("face", ["leans", "ball"])
def test_a_known_object_is_known_however_it_presses(face):
    data, sizes = database({"it": 3000.0, "other": 3600.0}, 6.4)
    named, off = {}, {}
    for pressure in ("any", "even"):
        step = made(
            IdentifyFootprint, database=data, sizes=sizes, on_pad="whole", pressure=pressure
        )
        found = []
        for seed in range(8):
            image = pressed(seed, face)
            found.append(step(image.with_values(image.values * (3000.0 / image.values.sum()))))
        named[pressure] = np.mean([f.name == "it" for f in found])
        off[pressure] = np.mean([math.hypot(f.object.x_cm - 10.0, f.object.y_cm - 9.5)
                                 for f in found])  # fmt: skip
    assert named["any"] == 1.0
    assert named["even"] <= (0.5 if face == "ball" else 1.0)
    assert off["any"] < (0.6 * off["even"] if face == "leans" else 0.25)


def test_an_object_of_known_weight_but_much_smaller_is_not_taken_for_a_ball():
    data, sizes = database({"it": 2000.0}, 6.4)
    step = made(IdentifyFootprint, database=data, sizes=sizes, on_pad="whole")
    for seed in range(5):
        image = drawn(Circle(10.0, 9.5, 4.8), 60.0, np.random.default_rng(seed))
        alike = image.with_values(image.values * (2000.0 / image.values.sum()))
        assert step(alike).name == "unknown"


def test_placements_of_a_ball_teach_its_true_radius():
    off = {}
    for pressure in ("any", "even"):
        step = made(FollowFootprint, on_pad="whole", pressure=pressure)
        for seed in range(8):
            disc = Circle(9.0 + 0.4 * seed, 9.5, 6.4)
            found = step(pressed(seed, "ball", disc), gap_s=100.0)
            assert found.moved
        off[pressure] = abs(found.shape.radius_cm - 6.4)
    assert off["any"] < 0.2 < 0.3 < off["even"]


def test_an_empty_frame_is_no_shape():
    empty = Image(np.zeros((16, 16)), (1.3, 1.3), (-0.15, -0.15), "gram")
    with pytest.raises(Exception, match="no element bears a load"):
        made(ChooseShape, pressure="any")(empty)
