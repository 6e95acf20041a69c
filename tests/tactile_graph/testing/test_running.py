"""The fixtures: steps and pipelines run as tests want them, and registries without strangers."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from tactile_graph import Circle, Degenerate, Frame, Image, Mask, hookimpl
from tactile_graph.errors import PluginError, UsageError
from tactile_graph.testing import scene

Fixture = Callable[..., Any]


def above(image: Image, *, level: float = 0.5) -> Mask:
    return image.mask(image.values > level)


def greedy(image: Image) -> Mask:
    image.values.setflags(write=True)
    image.values[...] = 0.0
    return image.mask(image.values > 0)


def wrong(image: Image) -> Mask:
    return image  # type: ignore[return-value]


def hopeless(image: Image) -> Mask:
    raise Degenerate("nothing here")


PIPELINE = "{pipeline: p, nodes: {m: {step: STEP, in: frame}}, outputs: [m]}"


def test_a_step_runs_on_a_bare_array_and_its_answer_is_read_only(run_step: Fixture) -> None:
    found = run_step(above, np.eye(3), settings={"level": 0.2})
    assert found.count == 3
    assert not found.values.flags.writeable
    assert run_step("threshold", Image(np.eye(3)), settings={"level": 0.5}).count == 3


def test_a_step_that_writes_or_breaks_its_word_is_an_error(run_step: Fixture) -> None:
    with pytest.raises(PluginError, match="step 'greedy' writes into image, which others read"):
        run_step(greedy, np.eye(3))
    with pytest.raises(PluginError, match="step 'wrong' promises Mask, but gave Image of 3 x 3"):
        run_step(wrong, np.eye(3))
    with pytest.raises(Degenerate, match="nothing here"):
        run_step(hopeless, np.eye(3))


def test_a_setting_that_is_not_allowed_is_told(run_step: Fixture) -> None:
    with pytest.raises(UsageError, match="unknown setting 'levle'; did you mean 'level'"):
        run_step(above, np.eye(3), settings={"levle": 1})


def test_a_pipeline_runs_with_steps_that_are_not_installed(
    run_pipeline: Fixture, isolated_registry: Fixture
) -> None:
    registry = isolated_registry({"above": above})
    text = PIPELINE.replace("STEP", "above")
    frames = [np.eye(3), Frame.of(np.ones((2, 2)))]
    results = run_pipeline(text, *frames, registry=registry, settings={"m.level": 0.1})
    assert [r["m"].count for r in results] == [3, 4]


def test_a_node_that_fails_fails_the_test(
    run_pipeline: Fixture, isolated_registry: Fixture
) -> None:
    registry = isolated_registry({"hopeless": hopeless, "greedy": greedy, "wrong": wrong})
    for name, told in (
        ("hopeless", "nothing here"), ("greedy", "writes into"), ("wrong", "promises Mask"),
    ):  # fmt: skip
        with pytest.raises((Degenerate, PluginError), match=told):
            run_pipeline(PIPELINE.replace("STEP", name), np.eye(3), registry=registry)


@pytest.mark.slow
def test_a_shipped_pipeline_runs_by_name_on_its_own_frames(run_pipeline: Fixture) -> None:
    results = run_pipeline("circle-3", settings={"footprint.level_v": 0.02})
    assert len(results) > 2


def test_a_registry_of_a_module_holds_its_plugin_and_the_projects_own(
    isolated_registry: Fixture,
) -> None:
    @hookimpl
    def tactile_graph_steps() -> dict[str, Any]:
        return {"above": above}

    module = ModuleType("mine")
    module.tactile_graph_steps = tactile_graph_steps  # type: ignore[attr-defined]
    registry = isolated_registry(plugin=module)
    assert registry.step("above").fields == ()
    assert registry.has("steps", "threshold")
    assert {p.package for p in registry.plugins} == {"tactile-graph", "under test"}
    assert not isolated_registry().has("steps", "above")


# -- scenes ----------------------------------------------------------------------------------


def test_a_scene_lies_where_its_truth_says() -> None:
    frame = scene(Circle(10.0, 11.0, 4.0), seed=3)
    assert frame.truth is not None
    (thing,) = frame.truth
    assert (thing.shape, thing.weight_g) == (Circle(10.0, 11.0, 4.0), 500.0)
    values = frame.image.values
    x = float((values.sum(axis=0) @ frame.image.x_cm) / values.sum())
    y = float((values.sum(axis=1) @ frame.image.y_cm) / values.sum())
    assert np.hypot(x - 10.0, y - 11.0) < 1.0
    assert (scene(Circle(10.0, 11.0, 4.0), seed=3).image.values == values).all()


def test_a_scene_takes_objects_as_files_do_and_an_empty_pad() -> None:
    thing = {"shape": "rectangle", "length_cm": 6.0, "breadth_cm": 3.0, "weight_g": 900.0}
    frame = scene(thing, output="counts")
    assert frame.truth is not None
    assert frame.truth[0].weight_g == 900.0
    assert frame.image.quantity == "counts"
    assert scene().truth == ()


def test_what_cannot_lie_on_a_pad_is_told() -> None:
    with pytest.raises(UsageError, match="an object is a shape or a mapping, got 3"):
        scene(3)
    with pytest.raises(UsageError, match="unknown setting 'pda'; did you mean 'pad'"):
        scene(pda="thesis")
