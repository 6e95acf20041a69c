"""``adaptive`` goes only as far as a frame needs, and says why it went no further."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tactile_graph import Circle, Frame, Pipeline, load
from tactile_graph.api.result import Result
from tactile_graph.engine.outcomes.outcome import Skipped
from tactile_graph.pipeline.graph import NodeKind
from tactile_graph_fitters.circle.fit_circle_load import EvenCircle
from tactile_graph_likelihood.single.likely import LikelyCircle

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("warm_kernels")]

DISCS = ((1860.0, 6.8), (6360.0, 5.1), (6810.0, 7.7))
SATURATED = 10e3  # g/cm^2, where an element's law ends at 10 kg
CHEAP = {"cells", "footprint", "siemens", "grams", "even"}


def frames(n: int, seed: int = 5, g_cm2: float = 0.0, **settings: Any) -> list[Frame]:
    """Discs of table 4.2 on the thesis' pad; ``settings`` are the source's or the scene's."""
    discs = [
        {"shape": "disc", "name": "disc", "weight_g": g_cm2 * math.pi * r**2 or w, "radius_cm": r}
        for w, r in DISCS
    ]
    scene = {"in_turn": [[d] for d in settings.pop("discs", discs)]}
    scene |= {"foam_cm": settings.pop("foam_cm")} if "foam_cm" in settings else {}
    source = load("contacts").with_source("simulate", scene=scene, frames=n, **settings)
    return list(source.frames(seed))


def empty(n: int) -> list[Frame]:
    source = load("contacts").with_source("simulate", scene={"objects": []}, frames=n)
    return list(source.frames(3))


def results(pipeline: Pipeline, given: list[Frame]) -> Iterator[Result]:
    return map(pipeline.runner(), given)


def ran(result: Result) -> set[str]:
    """Names of the steps that ran."""
    return {name for name, t in result.times_us.items() if t > 0.0}


def off(result: Result) -> float:
    (true,) = result.frame.truth or ()
    found = result["circle"]
    assert isinstance(true.shape, Circle)
    centre = math.hypot(found.x_cm - true.shape.x_cm, found.y_cm - true.shape.y_cm)
    return max(centre, abs(found.radius_cm - true.shape.radius_cm))


def ungated(pipeline: Pipeline) -> Pipeline:
    """Return it with every step run in every frame; which answer is taken stays."""
    nodes = {
        name: node if node.kind is NodeKind.FIRST_OF else replace(node, guard=None)
        for name, node in pipeline.nodes.items()
    }
    return replace(pipeline, nodes=nodes)


def test_on_an_empty_pad_only_the_gates_run() -> None:
    for result in results(load("adaptive"), empty(10)):
        assert ran(result) == {"cells", "footprint"}
        outcome = result.outcome("siemens")
        assert isinstance(outcome, Skipped)
        asked = "footprint.together = 0, footprint.rise = 0"
        assert outcome.reason == f"when touched is false ({asked})"
        assert isinstance(result.outcome("circle"), Skipped)


def test_of_a_frame_that_is_mostly_lost_nothing_is_computed() -> None:
    (frame,) = frames(1)
    values = np.where(np.arange(16) < 9, np.nan, frame.image.values)
    lost = Frame.of(values, frame.image.pitch_cm, frame.image.origin_cm, "volt")
    (result,) = results(load("adaptive"), [lost])
    assert ran(result) == {"cells"}
    outcome = result.outcome("footprint")
    assert isinstance(outcome, Skipped)
    assert outcome.reason == "when legible is false (cells.share = 0.4375)"


def test_where_load_is_even_the_cheap_fit_answers_and_nothing_else_runs() -> None:
    for result in results(load("adaptive"), frames(12, sigma=0.0, voids=0.0)):
        assert ran(result) == CHEAP
        assert type(result["circle"]) is EvenCircle
        assert off(result) < 0.03
        outcome = result.outcome("located")
        assert isinstance(outcome, Skipped)
        assert outcome.reason == "nothing asked for it"


def test_on_an_uneven_pad_the_likelihood_answers() -> None:
    for result in results(load("adaptive"), frames(12)):
        assert ran(result) == {*CHEAP, "located"}
        assert type(result["circle"]) is LikelyCircle
        outcome = result.outcome("plain")
        assert isinstance(outcome, Skipped)
        assert "certain is false (even.uneven = 0." in outcome.reason


def test_under_foam_the_likelihood_finds_the_foam() -> None:
    given = frames(12, foam_cm=1.3)
    found = list(results(load("adaptive"), given))
    likely = [r["circle"] for r in found if isinstance(r["circle"], LikelyCircle)]
    assert len(likely) >= 10
    assert np.mean([c.posterior.pressures.get("foam", 0.0) for c in likely]) > 0.8
    even = load("circle-likelihood").with_settings({"circle.pressure": "even"})
    assert np.mean([off(r) for r in found]) < 0.4 * np.mean([off(r) for r in results(even, given)])


def test_beyond_saturation_the_likelihood_answers_still() -> None:
    for result in results(load("adaptive"), frames(6, g_cm2=SATURATED)):
        assert type(result["circle"]) is LikelyCircle
        assert off(result) < 0.3


def test_of_what_no_disc_explains_it_says_so() -> None:
    """Elements a thousand times as uneven as the pad is told to be."""
    found = list(results(load("adaptive"), frames(30, sigma=3.0)))
    flagged = [r for r in found if not r["circle"].fits]
    others = [off(r) for r in found if r["circle"].fits]
    assert len(flagged) >= 20
    assert max(others) < 0.8
    assert np.mean([off(r) for r in flagged]) > 2.0 * np.mean(others)
    assert np.mean([r["circle"].centre_std_cm for r in flagged]) > 0.4


def test_a_small_residual_of_few_elements_is_not_trusted() -> None:
    """Four unknowns fit seven uneven elements well; the centre is off all the same."""
    disc = [{"shape": "disc", "name": "disc", "weight_g": 400.0, "radius_cm": 1.2}]
    found = list(results(load("adaptive"), frames(40, discs=disc)))
    few = [e for r in found if isinstance(e := r.outcome("even"), EvenCircle) and e.uneven < 0.1]
    assert few
    assert all(e.n_cells <= 12 for e in few)
    assert all(type(r.outcome("circle")) is not EvenCircle for r in found)


@pytest.mark.parametrize(
    "settings", [{}, {"sigma": 0.0, "voids": 0.0}, {"foam_cm": 1.0}], ids=["uneven", "even", "foam"]
)
def test_what_is_skipped_would_not_have_changed_the_answer(settings: dict[str, Any]) -> None:
    given = frames(4, seed=9, **settings)
    pipeline = load("adaptive")
    lazy, eager = results(pipeline, given), results(ungated(pipeline), given)
    for one, all_of_it in zip(lazy, eager, strict=True):
        a, b = one["circle"], all_of_it["circle"]
        assert (a.x_cm, a.y_cm, a.radius_cm) == (b.x_cm, b.y_cm, b.radius_cm)
