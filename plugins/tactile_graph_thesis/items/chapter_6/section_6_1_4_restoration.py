"""Section 6.1.4: filters around a restoration, other models of the noise, a prior on the load."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from tactile_graph import Frame, Pipeline, load
from tactile_graph_thesis.drawing.bars import bars
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.measure.altered import altered
from tactile_graph_thesis.measure.circles import circle_errors
from tactile_graph_thesis.measure.shown_reading import DISCS
from tactile_graph_thesis.work import Work

READINGS, QUICK_READINGS = 20, 6
"""Of each disc."""
PIPELINE = "bayes-circle"
ANNEALED = "circle-enclosed"
"""The thesis' schedule on volts, and what its lines enclose."""
NOISES = ("gaussian", "laplace", "student_t", "outliers", "poisson")
BETTER = 0.9
"""Share of the error left from which a change is an improvement."""
_MODEL = {"lambda_d": 1, "lambda_l": 300}
_ANNEALED = {
    "model": {"n_levels": 200, "lambda_d": 0.02, "lambda_l": 1, "lines": "explicit"},
    "temperature": 5,
    "cooling": 0.9,
    "n_sweeps": 110,
    "energy_scale": 1,
}
_SMOOTHED: dict[str, dict[str, Any]] = {
    "smooth": {"step": "low_pass", "in": "frame"},
    "restored": {"step": "gibbs", "in": "smooth", "with": _ANNEALED},
}


def filtered_after(step: str) -> dict[str, dict[str, Any]]:
    """Return the nodes that filter what lines enclose before its outline is taken.

    Parameters
    ----------
    step : "open" or "close"
    """
    filtered: dict[str, Any] = {"step": step, "in": "object", "with": {"element": "cross3"}}
    return {
        "filtered": {**filtered, "when": "object.count > 0"},
        "outline": {"step": "outline_points", "in": "filtered", "when": "filtered.count > 0"},
    }


def restored_with(model: Mapping[str, object], expected: bool = False) -> dict[str, Any]:
    """Return the node that restores, with more of the model given.

    Parameters
    ----------
    model : mapping
    expected : bool
        Whether it takes the load that a node ``expected`` gives.
    """
    wires = {"image": "levels.image", **({"expected": "expected"} if expected else {})}
    settings = {"model": {**_MODEL, **model}, "n_rounds": 2}
    return {"step": "restore", "in": wires, "with": settings, "when": "levels.stands_out"}


def _frames(work: Work) -> list[Frame]:
    n = QUICK_READINGS if work.quick else READINGS
    return work.frames("discs", 3 * work.readings)[: 3 * n]


def _compared(work: Work, ways: Mapping[str, Pipeline], title: str, said: str) -> Made:
    frames = _frames(work)
    runners = [p.runner(seed=work.seed) for p in ways.values()]
    errors = circle_errors(frames, runners, DISCS)
    means = {way: e.reshape(-1, 3).mean(axis=0) for way, e in zip(ways, errors, strict=True)}
    groups = {
        way: {"centre": float(np.hypot(*m[:2])), "radius": float(m[2])} for way, m in means.items()
    }
    return Made(
        findings=(improves({way: of["radius"] for way, of in groups.items()}, said),),
        table=Table(
            ("way", "centre_cm", "radius_cm"), [(w, *of.values()) for w, of in groups.items()]
        ),
        figure=bars(groups, "mean error / cm", title),
        notes=(f"{len(frames)} readings of the discs of table 4.2.",),
    )


def improves(radius_cm: Mapping[str, float], said: str) -> Finding:
    """Return whether one of some changes betters the first way's radius.

    Parameters
    ----------
    radius_cm : mapping
        Way -> mean error of the radius, that without a change first.
    said : str
        What is concluded.
    """
    plain, *others = radius_cm.values()
    words = ", ".join(f"{way} {value:.2f}" for way, value in radius_cm.items())
    return Finding(
        said,
        f"mean error of the radius, cm: {words}",
        f"none that leaves less than {100 * BETTER:.0f} % of the error",
        min(others) < BETTER * plain,
    )


def _filters(work: Work) -> Made:
    ways = {
        "restored alone": load(ANNEALED),
        "smoothed before": altered(ANNEALED, _SMOOTHED),
        "opened after": altered(ANNEALED, filtered_after("open")),
        "closed after": altered(ANNEALED, filtered_after("close")),
        "smoothed before, closed after": altered(
            ANNEALED, {**_SMOOTHED, **filtered_after("close")}
        ),
    }
    said = "there is a definite scope for improvement by filtering before or after a restoration"
    return _compared(work, ways, "A restoration with filters before and after", said)


def _noises(work: Work) -> Made:
    ways = {
        noise: altered(PIPELINE, {"restored": restored_with({"noise": noise})}) for noise in NOISES
    }
    said = "(not in the thesis) another model of the noise than the Gaussian gives better results"
    return _compared(work, ways, "A restoration by each model of the noise", said)


def _prior(work: Work) -> Made:
    expected: dict[str, dict[str, Any]] = {
        "located": {"use": "circle-3", "in": "frame"},
        "expected": {"step": "expect", "in": {"image": "levels.image", "shape": "located"}},
    }
    ways = {
        f"weight {weight:g}": altered(
            PIPELINE,
            {**expected, "restored": restored_with({"lambda_prior": weight}, expected=True)},
        )
        for weight in (0.0, 0.1, 1.0)
    }
    said = "the restoration can be improved by prior knowledge of the pressure in the potential"
    return _compared(work, ways, "A restoration told the load of circle-3's disc", said)


_RADIUS = (
    "Judged by the radius of a circle around what the lines enclose, which the thesis is after."
)
ITEMS = (
    Item("restoration-filters", "Filters before and after a restoration",
         "Errors of circle-enclosed with the image smoothed before, with what lines enclose opened "
         "or closed after, and with both.", _filters, _RADIUS, after="6.1.4"),
    Item("noise-models", "Models of the noise on readings",
         "Errors of bayes-circle by the data term of each model of the noise.", _noises, _RADIUS,
         after="6.1.4"),
    Item("load-prior", "A prior on the load",
         "Errors of bayes-circle when the load of the disc that circle-3 finds is expected, by the "
         "weight of the prior.", _prior, _RADIUS, after="6.1.4"),
)  # fmt: skip
