"""Shapes by evidence."""

import numpy as np
import pytest

from helpers_likelihood import drawn, made
from tactile_graph import load
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Circle, Image, Rectangle
from tactile_graph_likelihood.single.any_pressure import shares_by
from tactile_graph_likelihood.single.choose_shape import ChooseShape

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("warm_kernels")]


def test_evidence_tells_discs_from_rectangles():
    rng, step = np.random.default_rng(3), made(ChooseShape)
    for shape, name in (
        (Circle(10.0, 9.5, 5.5), "disc"),
        (Rectangle(10.0, 9.5, 13.0, 6.0, 0.4), "rectangle"),
    ):
        found = [step(drawn(shape, 60.0, rng)) for _ in range(10)]
        assert sum(f.name == name for f in found) >= 9
        for f in found:
            assert f.disc + f.ellipse + f.rectangle == pytest.approx(1.0)
            assert f.probability == max(f.disc, f.ellipse, f.rectangle)


def test_no_shape_is_chosen_where_nothing_is_touched():
    empty = Image(np.zeros((16, 16)), (1.3, 1.3), (-0.15, -0.15), "gram")
    with pytest.raises(Degenerate, match="no element bears a load"):
        made(ChooseShape)(empty)


@pytest.mark.parametrize(
    ("name", "output", "centre_cm"),
    [("circle-likelihood", "circle", 0.1), ("rectangle-likelihood", "rectangle", 0.17)],
)
def test_pipelines_locate_on_the_calibrated_pad(name, output, centre_cm):
    pipeline = load(name)
    run = pipeline.runner()
    off = []
    for frame in pipeline.frames(3):
        found, true = run(frame)[output], frame.truth[0].shape
        off.append(np.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm))
    assert len(off) == 20
    assert np.mean(off) < centre_cm


def test_the_object_pipeline_names_discs_and_rectangles():
    pipeline = load("object-likelihood")
    run = pipeline.runner()
    right = 0
    for frame in pipeline.frames(3):
        kind = "disc" if isinstance(frame.truth[0].shape, Circle) else "rectangle"
        right += run(frame)["object"].name == kind
    assert right >= 17


def test_few_elements_tell_less_than_their_evidence_says():
    logs = {"disc": 0.0, "ellipse": -3.0}
    sure = [shares_by(logs, n, 12.0)["disc"] for n in (0, 3, 12, 48, 10**6)]
    assert sure == sorted(sure)
    assert 0.5 < sure[0] < 0.6
    assert sure[2] == pytest.approx(1.0 / (1.0 + np.exp(-1.5)))
    assert sure[4] == pytest.approx(1.0 / (1.0 + np.exp(-3.0)), abs=1e-6)


def test_an_ellipse_of_two_elements_is_possible():
    values = np.zeros((16, 16))
    values[5, 5:7] = 60.0, 40.0
    image = Image(values, (1.3, 1.3), (-0.15, -0.15), "gram")
    assert made(ChooseShape, smallest_cm=1.0, largest_cm=3.0)(image).ellipse > 0.02


@pytest.mark.parametrize("name", ["locate", "object-likelihood"])
def test_small_objects_are_named_as_surely_as_rightly(name, tmp_path):
    rng, lines = np.random.default_rng(5), ["about: small", "in_turn:"]
    for k in range(90):
        a, b = np.sort(np.exp(rng.uniform(0.0, np.log(3.0), 2)))[::-1].round(3)
        sizes = [
            (f"disc, weight_g: {110 * a * a:.0f}, radius_cm: {a}", 0),
            (f"ellipse, weight_g: {110 * a * b:.0f}, semi_major_cm: {a}, semi_minor_cm: {b}", 1),
            (f"rectangle, weight_g: {140 * a * b:.0f}, length_cm: {2 * a}, breadth_cm: {2 * b}", 2),
        ]
        lines.append(f"  - [{{shape: {sizes[k % 3][0]}}}]")
    (tmp_path / "small.yaml").write_text("\n".join(lines) + "\n")
    pipeline = load(name).with_settings({"object.smallest_cm": 1.0, "object.largest_cm": 3.0})
    pipeline = pipeline.with_source("simulate", scene=str(tmp_path / "small.yaml"), frames=90)
    run, told, right = pipeline.runner(), [], []
    for frame in pipeline.frames():
        its, true = run(frame).get("object"), type(frame.truth[0].shape).__name__
        if its is not None:
            told.append(its.probability)
            right.append(its.name == {"Circle": "disc"}.get(true, true.lower()))
    assert len(told) > 80
    assert np.mean(told) < np.mean(right) + 0.09
