"""The settings that the steps share: flat in YAML, told in the same words, with their defaults."""

import numpy as np
import pytest

from helpers_likelihood import drawn
from tactile_graph import load, loads
from tactile_graph.errors import PipelineError
from tactile_graph.plugins.registry import installed
from tactile_graph.wires import Rectangle
from tactile_graph_likelihood.any_pad.locate import LocateRectangle
from tactile_graph_likelihood.settings import FootprintSettings, LocateSettings

STEPS = {
    "footprint_disc": ("partly", 0.15, None),
    "fit_footprint": ("partly", 0.15, None),
    "footprint_by_order": ("partly", 0.15, None),
    "follow_footprint": ("partly", 0.15, None),
    "choose_shape": ("partly", 0.2, None),
    "identify_footprint": ("partly", 0.2, None),
    "fit_footprints": ("whole", None, None),
    "locate_objects": ("mostly", None, None),
}


@pytest.mark.parametrize("step", STEPS)
def test_a_step_takes_the_shared_settings_as_its_own(step):
    settings = {s.name: s for s in installed().step(step).settings}
    on_pad, precision, smallest_cm = STEPS[step]
    assert settings["pad"].default == "thesis"
    assert settings["on_pad"].default == on_pad
    assert settings["smallest_cm"].default == smallest_cm
    assert (settings["precision"].default if "precision" in settings else None) == precision


TEXT = """
pipeline: settings
nodes:
  disc: {{step: footprint_disc, in: frame, with: {{{settings}}}}}
outputs: [disc]
"""


@pytest.mark.parametrize(
    ("settings", "what"),
    [
        ("smallest_cm: 5, largest_cm: 2", "smallest_cm: must be below largest_cm, got 5 and 2"),
        ("sigma: -1", "sigma: must be > 0"),
        ("sgima: 1", "unknown setting 'sgima'"),
    ],
)
def test_what_is_wrong_with_them_is_told_with_its_place(settings, what):
    with pytest.raises(PipelineError, match=what):
        loads(TEXT.format(settings=settings))


def test_a_pipeline_hands_them_on():
    pipeline = load("circle-likelihood")
    model = pipeline.nodes["circle"].callable.model
    assert (model.whole, model.precision) == (True, 0.2)


@pytest.mark.parametrize(("settings", "usual"), [(FootprintSettings, 1024), (LocateSettings, 768)])
def test_a_finer_precision_may_take_more_points(settings, usual):
    precision = settings().precision
    assert settings().points == settings(precision=1.0).points == usual
    assert settings(precision=precision / 2).points == 4 * usual
    assert settings(precision=1e-6).points == 32768
    assert settings(precision=precision / 2, most_points=64).points == 64


@pytest.mark.slow
def test_a_rectangle_is_located_as_precisely_as_asked():
    image = drawn(Rectangle(10.0, 9.5, 11.0, 4.0, 0.7), 60.0, np.random.default_rng(1))
    for mirrored in (image.values, image.values[:, ::-1], image.values[::-1], image.values.T):
        given = image.with_values(np.ascontiguousarray(mirrored))
        for precision in (0.1, 0.05):
            found = LocateRectangle(LocateSettings(precision=precision))(given)
            assert found.posterior.equal_points > 0.99 * precision**-2


@pytest.mark.parametrize(
    ("step", "setting"), [("locate_objects", "more"), ("fit_footprints", "more")]
)
def test_what_moves_or_scales_an_answer_has_an_end(step, setting):
    node = f"{{step: {step}, in: frame, with: {{{setting}: .inf}}}}"
    with pytest.raises(PipelineError, match=f"{setting}: must be a finite number, got inf"):
        loads(f"pipeline: endless\nnodes: {{one: {node}}}\noutputs: [one]\n")
