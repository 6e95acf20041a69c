"""The data of the thesis' figures 5.8 to 5.14 and of its table 5.2, made anew."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np

from tactile_graph import Frame, load
from tactile_graph.errors import Degenerate
from tactile_graph.steps import Report
from tactile_graph.wires import Circle, Image, Mask, Points, Polygon, Shape
from tactile_graph_fitters.circle.fit_circle import fit_circle
from tactile_graph_hull.hull import hull
from tactile_graph_mrf.contours.contours import contours
from tactile_graph_mrf.contours.outline_points import outline_points
from tactile_graph_mrf.descent.restore import restore
from tactile_graph_mrf.energy.line_field import LineField
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.samplers.gibbs import gibbs
from tactile_graph_sources.simulate import simulate
from tactile_graph_thesis.numbers import error_table

VOLTS = Model(lambda_d=1.0, lambda_l=300.0)
"""Model of table 5.2's line fields in volts: that of the pipelines."""
SIMULATED = Model(lambda_d=1.0, lambda_l=1000.0)
"""Model of figure 5.8: lines pay from steps of 35 levels on."""
RECTANGLE = (slice(5, 11), slice(3, 13))
"""Rows and columns of the rectangle of figure 5.8."""
FLOOR, TOP, NOISE = 50.0, 150.0, 15.0
"""Grey levels of figure 5.8: outside, on the rectangle, and the noise's standard deviation."""
ENERGY_SCALE = 0.001
"""Factor on the energy in squared levels, beside which T = 5 is a temperature; see `gibbs`."""


class Restoration(NamedTuple):
    """One object's images; ``truth`` is the image without noise, or None where nobody knows it.

    ``energy`` is that of the image restored with lines, in squared levels.
    """

    name: str
    truth: Image | None
    observed: Image
    smooth: Image
    lined: Image
    lines: LineField
    outlines: tuple[Polygon, ...]
    shape: Shape | None
    restorer: str
    energy: float


class Hulls(NamedTuple):
    """Convex hulls of one object by both ways, and what it is."""

    name: str
    shape: Shape
    lines: LineField
    bayesian: Polygon
    heuristic: Polygon


class RadiusRow(NamedTuple):
    """A row of table 5.2, in cm: mean and standard deviation over the readings.

    ``volt_hull`` is nearest to the thesis: the hull of all lines in the image in volts, by
    `restore` (a line that a sampler leaves astray would spoil it). ``line_hull`` is the hull of
    what the lines of `bayes-lines` enclose; ``bayesian`` that of `bayes-circle`, moved inwards by
    what cells at the border leave uncovered; ``heuristic`` circle-3's.
    """

    name: str
    actual_cm: float
    volt_hull_cm: tuple[float, float]
    line_hull_cm: tuple[float, float]
    bayesian_cm: tuple[float, float]
    heuristic_cm: tuple[float, float]


def figure_5_8(seed: int = 0, restorer: Literal["gibbs", "restore"] = "gibbs") -> Restoration:
    """Return a rectangle on an even floor: original, corrupted, restored without and with lines.

    By ``gibbs`` with the thesis' schedule (section 5.4.1: T0 = 5, cooled by 0.9 over 110 sweeps
    from a random start, 200 levels), or by ``restore``, whose energy is lower. Figure 5.9 is the
    ``lines``. The thesis gives neither the image nor the noise in numbers; these are ours.
    """
    rng = np.random.default_rng(seed)
    on = np.zeros((16, 16), np.bool_)
    on[RECTANGLE] = True
    truth = Image(np.where(on, TOP, FLOOR), quantity="level")
    observed = truth.with_values(truth.values + NOISE * rng.standard_normal(on.shape))
    bare = replace(SIMULATED, lines="none")
    if restorer == "gibbs":
        smooth = gibbs(observed, rng=rng, model=bare, energy_scale=ENERGY_SCALE)
        lined = gibbs(observed, rng=rng, model=SIMULATED, energy_scale=ENERGY_SCALE)
    else:
        smooth, lined = restore(observed, model=bare), restore(observed, model=SIMULATED)
    return Restoration(
        "simulated rectangle",
        truth,
        observed,
        smooth.image,
        lined.image,
        lined.lines,
        contours(truth.mask(on)),
        None,
        restorer,
        lined.energy,
    )


def figures_5_10_to_5_13(seed: int = 0, pad: str = "thesis") -> tuple[Restoration, ...]:
    """Return Disc I, Disc II and RECTANGLE II on a pad, restored without and with lines.

    As `bayes-smooth` and `bayes-lines` do it, on the logarithmic scale of `compress`.
    ``outlines`` are the closed contours of what the lines enclose.
    """
    smooth = load("bayes-smooth").runner(seed=seed)
    lined = load("bayes-lines").runner(["levels", "restored", "closed", "object"], seed)
    made = []
    for frame in _frames(seed, 3, pad):
        result = lined(frame)
        made.append(
            Restoration(
                _name(frame),
                None,
                result["levels"].image,
                smooth(frame)["restored"].image,
                result["restored"].image,
                result["closed"],
                contours(result["object"].mask),
                _shape(frame),
                "gibbs",
                result["restored"].energy,
            )
        )
    return tuple(made)


def figure_5_14(seed: int = 0, pad: str = "thesis") -> tuple[Hulls, ...]:
    """Return the hulls of Disc I and Disc II: of the line field, and of circle-3's opened mask."""
    lined = load("bayes-lines").runner(["closed", "object"], seed)
    heuristic = load("circle-3").runner(["hull"])
    return tuple(
        Hulls(
            _name(frame),
            _shape(frame),
            (result := lined(frame))["closed"],
            _line_hull(result["object"].mask),
            heuristic(frame)["hull"],
        )
        for frame in _frames(seed, 2, pad)
    )


def table_5_2(seed: int = 0, readings: int = 100, pad: str = "thesis") -> tuple[RadiusRow, ...]:
    """Return the radii of Disc I and Disc II by each way, over so many readings of each.

    A reading without an answer is left out.
    """
    lined = load("bayes-lines").runner(["object"], seed)
    bayesian, heuristic = load("bayes-circle").runner(), load("circle-3").runner()
    objects = error_table("table-5.2").objects
    radii: dict[str, list[list[float]]] = {name: [[], [], [], []] for name in objects}
    actual = {}
    for frame in _frames(seed, 3 * readings, pad):
        name, shape = _name(frame), _shape(frame)
        if name not in radii or not isinstance(shape, Circle):
            continue
        actual[name] = shape.radius_cm
        volts = restore(frame.image, model=VOLTS).lines
        found = [
            _hull_circle(Points(volts.segments_cm.mean(axis=1))),
            _hull_circle(outline_points(lined(frame)["object"].mask)),
            bayesian(frame).get("circle"),
            heuristic(frame).get("circle"),
        ]
        for column, circle in zip(radii[name], found, strict=True):
            column += [] if circle is None else [circle.radius_cm]
    return tuple(
        RadiusRow(name, actual[name], *map(_mean_and_sd, columns))
        for name, columns in radii.items()
    )


def _hull_circle(points: Points) -> Circle | None:
    try:
        return fit_circle(hull(points).points)
    except Degenerate:
        return None


def _mean_and_sd(values: list[float]) -> tuple[float, float]:
    return float(np.mean(values)), float(np.std(values))


def _line_hull(mask: Mask) -> Polygon:
    """Return the convex hull of the middles of the lines around an object."""
    return hull(outline_points(mask))


def _frames(seed: int, n: int, pad: str) -> Iterator[Frame]:
    """Yield frames of table 5.1's objects in turn."""
    rng = np.random.default_rng(seed)
    return simulate(scene="bayes", pad=pad, frames=n, rng=rng, report=Report())


def _shape(frame: Frame) -> Shape:
    assert frame.truth is not None
    return frame.truth[0].shape


def _name(frame: Frame) -> str:
    assert frame.truth is not None
    return frame.truth[0].name
