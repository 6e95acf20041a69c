"""The thesis' ways of chapter 5 and figure 4.37 as files: their settings, and each step to ours."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tactile_graph import Pipeline, load
from tactile_graph_compare.variants.lineage import nodes_between
from tactile_graph_hull.hull import hull
from tactile_graph_thesis import tactile_graph_pipelines
from tactile_graph_thesis.measure.simulated_readings import simulated
from tactile_graph_thesis.measure.weighing import PIPELINES, calibration_curve

ANNEALED = {"temperature": 5.0, "cooling": 0.9, "n_sweeps": 110, "energy_scale": 1.0}
"""Section 5.4.1; the energy is in squared levels."""
LINED = {"n_levels": 200, "lambda_d": 0.02, "lambda_l": 1.0, "lines": "explicit"}
SMOOTHED = {"n_levels": 200, "lambda_d": 1.0, "lambda_l": 300.0, "lines": "explicit"}

NEW: dict[tuple[str, str], tuple[set[str], set[str], dict[str, set[str]]]] = {
    ("thesis-smooth", "thesis-lines"): (
        set(), set(), {"restored": {"model.lines", "model.lambda_d", "model.lambda_l"}},
    ),
    ("thesis-smooth", "bayes-smooth"): ({"levels"}, set(), {"restored": {"in", "when"}}),
    ("thesis-lines", "lines-enclosed"): ({"closed", "object"}, set(), {}),
    ("lines-enclosed", "lines-logarithmic"): ({"levels"}, set(), {"restored": {"in", "when"}}),
    ("lines-logarithmic", "bayes-lines"): (
        set(), set(), {"restored": {"model.lambda_d", "model.lambda_l", "energy_scale"}},
    ),
    ("thesis-lines", "thesis-circle"): ({"hull", "circle"}, set(), {}),
    ("thesis-circle", "circle-enclosed"): (
        {"closed", "object", "outline"}, set(), {"hull": {"in", "when"}},
    ),
    ("circle-enclosed", "circle-logarithmic"): ({"levels"}, set(), {"restored": {"in", "when"}}),
    ("circle-logarithmic", "circle-restored"): (set(), set(), {"restored": {"step"}}),
    ("circle-restored", "circle-smoothed"): (
        set(), set(), {"restored": {"model.lambda_d", "model.lambda_l"}},
    ),
    ("circle-smoothed", "bayes-circle"): (set(), set(), {"outline": {"in"}}),
    ("thesis-lines", "thesis-rectangle"): (
        {"hull", "axis", "turned", "ellipse", "rectangle"}, set(), {},
    ),
    ("thesis-rectangle", "rectangle-enclosed"): (
        {"closed", "object", "outline"}, set(), {"hull": {"in", "when"}},
    ),
    ("rectangle-enclosed", "rectangle-logarithmic"): (
        {"levels"}, set(), {"restored": {"in", "when"}},
    ),
    ("rectangle-logarithmic", "rectangle-restored"): (set(), set(), {"restored": {"step"}}),
    ("rectangle-restored", "rectangle-smoothed"): (
        set(), set(), {"restored": {"model.lambda_d", "model.lambda_l"}},
    ),
    ("rectangle-smoothed", "rectangle-straight"): (
        {"sides"}, {"axis", "turned", "ellipse"}, {"rectangle": {"step", "in"}},
    ),
    ("rectangle-straight", "bayes-rectangle"): (set(), set(), {"outline": {"in"}}),
    ("thesis-identify", "identify-decoupled"): (
        {"siemens"}, set(), {"grams": {"in", "when", "curve"}, "identity": {"database"}},
    ),
    ("identify-decoupled", "identify-footprint"): (
        set(), {"measured", "round"}, {"features": {"step", "in"}, "identity": {"in", "database"}},
    ),
    ("identify-footprint", "identify-locate"): (set(), set(), {"identity": {"step"}}),
}  # fmt: skip
"""Parent and child: nodes added, nodes removed, and of those changed, what. What objects are known
by goes with how they are measured."""
ROOTS = {"thesis-smooth", "thesis-identify"}


def given(pipeline: Pipeline, node: str) -> dict[str, Any]:
    """Return the settings of a node, with the defaults."""
    return dict(pipeline.nodes[node].settings)


RECTANGLES = {
    "thesis-identify": {"RECTANGLE I": [2112, 145.1], "RECTANGLE II": [1457, 132.0]},
    "identify-decoupled": {"RECTANGLE I": [2983, 145.1], "RECTANGLE II": [1492, 132.0]},
}
"""Weight and area of which these would know the rectangles, means of 25 readings."""


def with_rectangles(pipeline: Pipeline) -> Pipeline:
    """Return a pipeline that knows the rectangles besides the objects of table 4.9."""
    known = given(pipeline, "identity").get("database")
    if known is None:
        return pipeline
    more = [
        {"name": name, "shape": "rectangle", "readings": [reading]}
        for name, reading in RECTANGLES[pipeline.name].items()
    ]
    database = {**known, "objects": [*known["objects"], *more]}
    return pipeline.with_settings({"identity.database": database})


def share_wrong(pipeline: Pipeline, seed: int) -> float:
    """Return the share of names, of at most 150 frames, that are another object's."""
    results = pipeline.stream(only=["identity"], seed=seed)
    said = [(r.get("identity"), r.frame.truth[0].name) for r, _ in zip(results, range(150))]  # type: ignore[index] # noqa: B905
    return float(np.mean([i.name != true for i, true in said if i is not None]))


def test_every_file_of_the_folder_is_a_step_of_the_lineage() -> None:
    assert set(tactile_graph_pipelines()) - ROOTS <= {child for _, child in NEW}
    assert {name for name in ROOTS if load(name).evolves} == set()


@pytest.mark.parametrize(("parent", "child"), NEW)
def test_each_changes_one_thing_of_the_one_before(parent: str, child: str) -> None:
    before, after = load(parent), load(child)
    assert after.evolves == parent
    added, removed, changed, _ = nodes_between(before, after)
    new, gone, other = NEW[parent, child]
    inner = {n for n in removed if n.partition("/")[0] in gone}
    assert (set(added), set(removed) - inner | gone) == (new, gone)
    assert {c.node: {s.what for s in c.changes} for c in changed} == other


@pytest.mark.parametrize(
    "name",
    ["thesis-lines", "thesis-circle", "thesis-rectangle", "lines-enclosed", "circle-enclosed",
     "rectangle-enclosed", "lines-logarithmic", "circle-logarithmic", "rectangle-logarithmic"],
)  # fmt: skip
def test_the_thesis_schedule_and_one_pair_of_weights_are_in_each(name: str) -> None:
    settings = given(load(name), "restored")
    assert {k: settings[k] for k in ANNEALED} == ANNEALED
    assert {k: getattr(settings["model"], k) for k in LINED} == LINED
    assert (settings["start"], settings["schedule"]) == ("random", "geometric")


def test_without_lines_a_difference_weighs_as_much_as_the_data() -> None:
    settings = given(load("thesis-smooth"), "restored")
    assert {k: settings[k] for k in ANNEALED} == ANNEALED
    model = settings["model"]
    assert (model.n_levels, model.lambda_d, model.lines) == (200, 1.0, "none")


@pytest.mark.parametrize("name", ["circle-smoothed", "rectangle-straight", "bayes-circle"])
def test_later_ones_smooth_the_image_too(name: str) -> None:
    settings = given(load(name), "restored")
    assert {k: getattr(settings["model"], k) for k in SMOOTHED} == SMOOTHED
    assert settings["n_rounds"] == 2


@pytest.mark.parametrize("name", ["thesis-smooth", "thesis-lines", "thesis-circle",
                                  "thesis-rectangle", "circle-enclosed"])  # fmt: skip
def test_the_image_is_the_raw_one_with_no_threshold_and_no_logarithm(name: str) -> None:
    nodes = load(name).nodes
    assert str(nodes["restored"].inputs[0].refs[0]) == "frame.image"
    steps = {n.signature.name for n in nodes.values() if n.signature is not None}
    assert not steps & {"threshold", "compress"}


@pytest.mark.slow
def test_the_circle_is_that_of_the_hull_of_every_line() -> None:
    pipeline = load("thesis-circle")
    (frame,) = list(pipeline.with_source("simulate", scene="discs", frames=1).frames(4))
    result = pipeline.runner(["restored", "hull", "circle"], seed=2)(frame)
    np.testing.assert_array_equal(
        result["hull"].xy_cm, hull(result["restored"].lines.middles).xy_cm
    )


@pytest.mark.slow
def test_what_lines_enclose_is_nearer_than_the_hull_of_every_line() -> None:
    names = ("thesis-circle", "circle-enclosed")
    runs = [load(name).runner(seed=1) for name in names]
    off = []
    for frame in load(names[0]).with_source("simulate", scene="discs", frames=12).frames(31):
        assert frame.truth is not None
        true = frame.truth[0].shape.radius_cm
        off.append([abs(run(frame)["circle"].radius_cm - true) for run in runs])
    every, enclosed = np.mean(off, axis=0)
    assert enclosed < 0.5 * every


def test_identification_takes_the_thesis_settings() -> None:
    pipeline = load("thesis-identify")
    assert given(pipeline, "footprint")["level_v"] == 0.01
    identity = given(pipeline, "identity")
    assert pipeline.nodes["identity"].signature.name == "minimum_distance_normalised"
    assert identity["features"] == ["weight", "area_cm2"]
    assert (identity["reject"], identity["keep_variance"], identity["weights"]) == (
        False, False, None)  # fmt: skip
    assert (
        'slab: {use: rectangle-2, in: frame, when: identity.shape == "rectangle"}' in pipeline.text
    )
    assert 'circle: {use: circle-3, in: frame, when: identity.shape == "disc"}' in pipeline.text


@pytest.mark.slow
def test_the_curve_of_the_file_is_the_calibration_curve_to_a_ninth() -> None:
    curve = np.array([(0.0, 0.0), *given(load("thesis-identify"), "grams")["curve"]])
    whole = np.array([(0.0, 0.0), *calibration_curve(0)])
    volts = np.geomspace(0.02, 2.0, 200)
    ratio = np.interp(volts, *curve.T) / np.interp(volts, *whole.T)
    assert np.abs(np.log(ratio)).max() < np.log(1.0 + 1.0 / 9.0)
    assert curve[-1].tolist() == [5.0, 750.0]


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["curve", "decoupled"])
def test_objects_are_known_by_the_means_of_25_readings(kind: str) -> None:
    pipeline = load(PIPELINES[kind])  # type: ignore[index]
    known = {o["name"]: o["readings"] for o in given(pipeline, "identity")["database"]["objects"]}
    readings = simulated(pipeline, "identify", 25, 5, 44)
    assert set(known) == set(readings)
    for name, one in readings.items():
        names = one.rows[0].names
        columns = [names.index("weight"), names.index("area_cm2")]
        mean = np.mean([m.values[columns] for m in one.rows], axis=0)
        assert known[name] == [pytest.approx(mean, rel=2e-3, abs=0.06)], name


@pytest.mark.slow
def test_each_step_of_identification_errs_less_up_to_none() -> None:
    scene = load("identify-locate").source.settings["scene"]
    wrong = {}
    for name in ("thesis-identify", "identify-decoupled", "identify-footprint", "identify-locate"):
        pipeline = with_rectangles(load(name))
        wrong[name] = share_wrong(pipeline.with_source("simulate", scene=scene, frames=150), 7)
    assert wrong["thesis-identify"] > 0.15
    assert wrong["thesis-identify"] > wrong["identify-decoupled"] > 0.02
    assert wrong["identify-footprint"] == wrong["identify-locate"] == 0.0


@pytest.mark.slow
def test_the_objects_of_table_4_9_are_all_named_right() -> None:
    pipeline = load("thesis-identify")
    assert pipeline.source.settings["scene"] == "identify"
    assert share_wrong(pipeline.with_source("simulate", scene="identify", frames=150), 7) == 0.0


CHAPTER_4: dict[str, dict[str, dict[str, Any]]] = {
    "circle-1": {
        "footprint": {"level_v": 0.01}, "eroded": {"element": "cross3"},
        "dilated": {"element": "cross3"},
    },
    "circle-2": {
        "footprint": {"level_v": 0.01}, "fine": {"factor": 2}, "eroded": {"element": "disc5"},
        "dilated": {"element": "disc5"},
    },
    "circle-3": {
        "footprint": {"level_v": 0.01}, "fine": {"factor": 2}, "eroded": {"element": "disc5"},
        "dilated": {"element": "disc5"},
    },
    "rectangle-1": {
        "footprint": {"level_v": 0.01}, "smooth": {"size": 3}, "clean": {"level": 0.3},
        "rectangle": {"inside_cells": 0.35 / 1.3},
    },
    "rectangle-2": {
        "footprint": {"level_v": 0.01}, "smooth": {"size": 3}, "clean": {"level": 0.3},
        "fine": {"factor": 10}, "filled": {"element": "cross3", "times": 8},
        "opened": {"element": "square21"}, "rectangle": {"inside_cells": -0.05 / 1.3},
    },
}  # fmt: skip


@pytest.mark.parametrize("name", CHAPTER_4)
def test_localisers_of_chapter_4_have_these_settings(name: str) -> None:
    pipeline = load(name)
    for node, told in CHAPTER_4[name].items():
        settings = given(pipeline, node)
        assert {k: settings[k] for k in told} == told, node
