"""Figure 4.37: the object is identified, and only the localiser of its class runs."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph import Circle, Frame, load
from tactile_graph.engine.outcomes.outcome import Skipped
from tactile_graph_classifiers.measuring.shapes import true_name


@pytest.mark.slow
def test_only_the_localiser_of_the_identified_class_runs_and_explain_says_why():
    pipeline = load("identify-locate")
    localisers = [name for name in pipeline.outputs if name != "identity"]
    seen = set()
    for result in pipeline.stream(seed=2):
        identity = result["identity"]
        assert identity.name == true_name(result.frame)
        seen.add(identity.shape)
        for name in localisers:
            outcome = result.outcome(name)
            wanted = {"circle": "disc", "slab": "rectangle"}[name.partition(".")[0]]
            inner = [e for e in result.explain() if e.node.startswith(name.partition(".")[0] + "/")]
            assert inner
            if identity.shape == wanted:
                assert not isinstance(outcome, Skipped)
                assert {e.state for e in inner} == {"ran"}
            else:
                assert isinstance(outcome, Skipped)
                assert f"(identity.shape = '{identity.shape}')" in outcome.reason
                assert {e.state for e in inner} == {"skipped"}
    assert seen == {"disc", "rectangle", "polygon"}


def test_the_circle_it_finds_is_that_of_circle_3():
    pipeline = load("identify-locate")
    frame = next(pipeline.frames(seed=5))
    found = pipeline.run(frame)["circle"]
    assert isinstance(found, Circle)
    alone = load("circle-3").run(frame)["circle"]
    assert (found.x_cm, found.y_cm, found.radius_cm) == (alone.x_cm, alone.y_cm, alone.radius_cm)


@pytest.mark.parametrize(
    "name",
    ["features", "describe", "identify", "identify-any", "identify-locate", "identify-reliefs"],
)
def test_an_empty_pad_is_skipped_and_only_the_footprint_is_computed(name):
    pipeline = load(name)
    result = pipeline.run(Frame.of(np.zeros((16, 16)), 1.3, quantity="volt"))
    for output in pipeline.outputs:
        outcome = result.outcome(output)
        assert isinstance(outcome, Skipped)
        assert "footprint.count = 0" in outcome.reason
    assert [n for n, t in result.times_us.items() if t > 0] == ["footprint"]


def test_the_database_is_a_setting_of_the_pipeline(tmp_path):
    from tactile_graph.errors import PipelineError

    with pytest.raises(PipelineError, match=r"nix.sqlite: there is no such object database"):
        load("identify").with_settings({"identity.database": str(tmp_path / "nix.sqlite")})
    with pytest.raises(PipelineError, match="no feature named 'wieght' was learned; did you mean"):
        load("identify").with_settings({"identity.features": ["wieght"]})


def test_other_features_are_a_line_in_yaml():
    pipeline = load("identify").with_settings(
        {"identity.features": ["weight", "area_cm2", "axis_ratio", "hu_1"]}
    )
    pipeline = pipeline.with_source("simulate", scene="rectangles", frames=10)
    assert all(r["identity"].name == true_name(r.frame) for r in pipeline.stream(seed=1))


@pytest.mark.slow
def test_identify_any_names_the_objects_of_the_thesis_by_all_features():
    results = list(
        load("identify-any").with_source("simulate", scene="identify", frames=25).stream()
    )
    right = [r["identity"].name == true_name(r.frame) for r in results]
    assert sum(right) >= 23
    assert all(r["identity"].nearest == true_name(r.frame) for r in results)
