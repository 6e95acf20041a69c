"""Shapes by evidence."""

import numpy as np
import pytest

from helpers_likelihood import drawn, made
from tactile_graph import load
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Circle, Image, Rectangle
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
