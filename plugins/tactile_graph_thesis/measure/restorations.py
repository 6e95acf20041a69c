"""Figures 5.10 to 5.14 and table 5.2: readings restored with lines, and the circles of these."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame, load
from tactile_graph.errors import Degenerate
from tactile_graph.steps import Report
from tactile_graph.wires import Circle, Image, Points, Polygon, Shape
from tactile_graph_fitters.circle.fit_circle import fit_circle
from tactile_graph_hull.hull import hull
from tactile_graph_mrf.contours.contours import contours
from tactile_graph_mrf.descent.restore import restore
from tactile_graph_mrf.energy.line_field import LineField
from tactile_graph_mrf.energy.model import Model
from tactile_graph_sources.simulate import simulate
from tactile_graph_thesis.numbers import error_table

Array = NDArray[np.float64]
Way = Literal["thesis", "bayes"]

STIFF = Model(lambda_d=1.0, lambda_l=300.0)
"""Weights at which the image is smoothed too: those of the pipelines on a logarithmic scale."""


class Restoration(NamedTuple):
    """One object's images; ``truth`` is the image without noise, or None where nobody knows it.

    ``energy`` is that of the image restored with lines, in squared levels; ``unit`` is what the
    images hold.
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
    unit: str


class Hulls(NamedTuple):
    """Convex hulls of one object by lines and by circle-3, and what it is.

    ``every_line`` is the hull of the whole line field, ``enclosed`` that of what the lines of the
    same field enclose, ``logarithmic`` the latter where the image is on a logarithmic scale.
    """

    name: str
    shape: Shape
    lines: LineField
    every_line: Polygon
    enclosed: Polygon
    logarithmic: Polygon
    heuristic: Polygon


EVERY_LINE, ENCLOSED = "every line", "what lines enclose"
LOGARITHMIC = "what lines enclose, on the logarithm"
MOVED_IN = "the same, moved in"
LEAST_ENERGY = "every line at the least energy"
HEURISTIC = "circle-3"
WAYS = (EVERY_LINE, ENCLOSED, LEAST_ENERGY, LOGARITHMIC, MOVED_IN, HEURISTIC)
"""To the radius: of the hull of every line of `thesis-circle`'s field, of what the same lines
enclose (`circle-enclosed`), of every line where `restore` finds the least energy of stiffer
weights, of what lines enclose on the logarithm (`circle-logarithmic`), of that moved inwards by
what border cells leave uncovered (`bayes-circle`), and of `circle-3`. The first three are on
volts."""


class RadiusRow(NamedTuple):
    """A row of table 5.2.

    Parameters
    ----------
    name : str
    actual_cm : float
    radius_cm : mapping
        By `WAYS`: the radius found in each reading, shape (n,); NaN where there is no answer.
    """

    name: str
    actual_cm: float
    radius_cm: Mapping[str, Array]

    def mean_cm(self, way: str) -> float:
        """Mean radius by a way.

        Parameters
        ----------
        way : str
        """
        return float(np.nanmean(self.radius_cm[way]))

    def sd_cm(self, way: str) -> float:
        """Standard deviation of the radius by a way.

        Parameters
        ----------
        way : str
        """
        return float(np.nanstd(self.radius_cm[way]))

    def error_cm(self, way: str) -> Array:
        """Absolute error in each reading, shape (n,).

        Parameters
        ----------
        way : str
        """
        return np.abs(self.radius_cm[way] - self.actual_cm)


def figures_5_10_to_5_13(
    seed: int = 0, pad: str = "thesis", way: Way = "thesis"
) -> tuple[Restoration, ...]:
    """Return Disc I, Disc II and RECTANGLE II on a pad, restored without and with lines.

    Parameters
    ----------
    seed : int
    pad : str
    way : str
        ``thesis``: volts, by `thesis-smooth` and `thesis-lines`. ``bayes``: on a logarithmic
        scale, by `bayes-smooth` and `bayes-lines`; ``outlines`` are then the closed contours of
        what the lines enclose.
    """
    smooth = load(f"{way}-smooth").runner(seed=seed)
    ours = way == "bayes"
    asked = ["levels", "restored", "closed", "object"] if ours else ["restored"]
    lined = load(f"{way}-lines").runner(asked, seed)
    made = []
    for frame in frames(seed, 3, pad):
        result = lined(frame)
        restored = result["restored"]
        made.append(
            Restoration(
                name_of(frame),
                None,
                result["levels"].image if ours else frame.image,
                smooth(frame)["restored"].image,
                restored.image,
                result["closed"] if ours else restored.lines,
                contours(result["object"].mask) if ours else (),
                shape_of(frame),
                "gibbs",
                restored.energy,
                "log reading (asinh)" if ours else "V",
            )
        )
    return tuple(made)


def hulls(seed: int = 0, readings: int = 1, pad: str = "thesis") -> list[Hulls]:
    """Return the hulls of figure 5.14 for each reading of Disc I and Disc II in turn.

    A reading of which one way makes no hull is left out.

    Parameters
    ----------
    seed : int
    readings : int
        Of each disc.
    pad : str
    """
    enclosed = load("circle-enclosed").runner(["restored", "hull"], seed)
    logarithmic = load("circle-logarithmic").runner(["hull"], seed)
    heuristic = load("circle-3").runner(["hull"])
    found = []
    for frame in frames(seed, 3 * readings, pad):
        if not isinstance(shape_of(frame), Circle):
            continue
        result = enclosed(frame)
        lines = result["restored"].lines
        other = logarithmic(frame).get("hull"), heuristic(frame).get("hull")
        if "hull" in result and lines.count and None not in other:
            every = hull(lines.middles)
            found.append(
                Hulls(name_of(frame), shape_of(frame), lines, every, result["hull"], *other)
            )
    return found


def table_5_2(seed: int = 0, readings: int = 100, pad: str = "thesis") -> tuple[RadiusRow, ...]:
    """Return the radii of Disc I and Disc II by each way, over so many readings of each.

    Parameters
    ----------
    seed : int
    readings : int
    pad : str
    """
    enclosed = load("circle-enclosed").runner(["restored", "circle"], seed)
    others = [
        load(name).runner(["circle"], seed)
        for name in ("circle-logarithmic", "bayes-circle", "circle-3")
    ]
    objects = error_table("table-5.2").objects
    radii: dict[str, list[list[float]]] = {name: [] for name in objects}
    actual = {}
    for frame in frames(seed, 3 * readings, pad):
        name, shape = name_of(frame), shape_of(frame)
        if name not in radii or not isinstance(shape, Circle):
            continue
        actual[name] = shape.radius_cm
        result = enclosed(frame)
        found = (
            _hull_circle(result["restored"].lines.middles),
            result.get("circle"),
            _hull_circle(restore(frame.image, model=STIFF).lines.middles),
            *(run(frame).get("circle") for run in others),
        )
        radii[name].append([np.nan if c is None else c.radius_cm for c in found])
    return tuple(
        RadiusRow(name, actual[name], dict(zip(WAYS, np.array(of).T, strict=True)))
        for name, of in radii.items()
    )


def _hull_circle(points: Points) -> Circle | None:
    try:
        return fit_circle(hull(points).points)
    except Degenerate:
        return None


def frames(seed: int, n: int, pad: str) -> Iterator[Frame]:
    """Yield frames of table 5.1's objects in turn.

    Parameters
    ----------
    seed, n : int
    pad : str
    """
    rng = np.random.default_rng(seed)
    return simulate(scene="bayes", pad=pad, frames=n, rng=rng, report=Report())


def shape_of(frame: Frame) -> Shape:
    """Return the true outline of a frame's object.

    Parameters
    ----------
    frame : Frame
    """
    assert frame.truth is not None
    shape = frame.truth[0].shape
    assert isinstance(shape, Shape)
    return shape


def name_of(frame: Frame) -> str:
    """Return what a frame's object is called.

    Parameters
    ----------
    frame : Frame
    """
    assert frame.truth is not None
    return frame.truth[0].name
