"""Families ``circle fits``, ``ellipse fits``, ``rectangle fits``, ``hulls``: points to shapes."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Callable, Iterator, Mapping
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np

from suite_parts.contestants import error_of
from suite_parts.fits_common import NOISE_CM, POINTS, Case, Fit, Values, opencv_box, ours
from suite_parts.fits_ellipses import ellipse_cases, ellipse_fits
from suite_parts.records import Measured
from suite_parts.rounds_of import in_turn
from tactile_graph import Circle, Polygon, Rectangle
from tactile_graph.errors import Degenerate
from tactile_graph.wires.frame import TrueObject

ARCS_DEG = (30, 60, 120, 360)


def measured(
    n_sets: int, rounds: int, seed: int, told: Callable[[str], None]
) -> Iterator[Measured]:
    """Yield what every fit makes of every case."""
    for family, cases, fits in (
        ("circle fits", circle_cases, circle_fits),
        ("ellipse fits", ellipse_cases, ellipse_fits),
        ("rectangle fits", rectangle_cases, rectangle_fits),
        ("hulls", hull_cases, hulls),
    ):
        for case in cases(n_sets, seed):
            told(f"{family}, {case.name}")
            yield from _raced(family, case, fits(), rounds)


def _raced(family: str, case: Case, fits: Mapping[str, Fit], rounds: int) -> Iterator[Measured]:
    calls: dict[str, Callable[[], object]] = {}
    errors: dict[str, list[dict[str, float | None]]] = {}
    for name, fit in fits.items():
        answered = [_tried(fit, xy) for xy in case.sets]
        errors[name] = [error_of(a, [t]) for a, t in zip(answered, case.truth, strict=True)]
        source = itertools.cycle(case.sets)
        calls[name] = lambda fit=fit, source=source: _tried(fit, next(source))
    times = in_turn(calls, rounds, round_s=0.01, most_s=0.5)
    for name in fits:
        names = dict.fromkeys(q for row in errors[name] for q in row)
        columns = {q: tuple(row.get(q) for row in errors[name]) for q in names}
        yield Measured(family, case.name, name, times[name], columns)


def _tried(fit: Fit, xy: Values) -> list[Any]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return fit(xy)
        except Degenerate:
            return []


# -- circles ---------------------------------------------------------------------------------


def circle_cases(n_sets: int, seed: int) -> Iterator[Case]:
    for degrees in ARCS_DEG:
        rng = np.random.default_rng([seed, degrees])
        sets, truth = [], []
        for _ in range(n_sets):
            x, y, radius = rng.uniform(8, 12), rng.uniform(8, 12), rng.uniform(3, 7)
            t = rng.uniform(0, 2 * np.pi) + np.radians(degrees) * rng.random(POINTS)
            xy = np.column_stack([x + radius * np.cos(t), y + radius * np.sin(t)])
            sets.append(xy + rng.normal(0, NOISE_CM, xy.shape))
            truth.append(TrueObject(Circle(x, y, radius), 0.0, "arc"))
        yield Case(f"arc of {degrees} degrees", tuple(sets), tuple(truth))


def circle_fits() -> dict[str, Fit]:
    kinds = ("", "_thesis", "_kasa", "_taubin", "_hyper")
    fits = ours(*(f"fit_circle{kind}" for kind in kinds))
    if find_spec("circle_fit"):
        module = import_module("circle_fit")
        for name in ("kmh", "prattSVD", "taubinSVD", "hyperSVD", "riemannSWFLa"):
            if hasattr(module, name):
                fits[f"circle-fit {name}"] = _of_circle_fit(getattr(module, name))
    if find_spec("skimage"):
        fits["skimage CircleModel"] = _skimage_circle()
        fits["skimage RANSAC"] = _skimage_ransac()
    if find_spec("cv2"):
        fits["OpenCV minEnclosingCircle"] = _opencv_circle()
    return fits


def _of_circle_fit(function: Callable[..., Any]) -> Fit:
    def fit(xy: Values) -> list[Any]:
        try:
            x, y, radius, _ = function(xy)
        except (ValueError, np.linalg.LinAlgError, ZeroDivisionError):
            return []
        return [Circle(float(x), float(y), float(radius))] if np.isfinite(x + y + radius) else []

    return fit


def _skimage_circle() -> Fit:
    from skimage.measure import CircleModel

    def fit(xy: Values) -> list[Any]:
        model = CircleModel.from_estimate(xy)
        return [Circle(*map(float, (*model.center, model.radius)))] if model else []

    return fit


def _skimage_ransac() -> Fit:
    from skimage.measure import CircleModel, ransac

    def fit(xy: Values) -> list[Any]:
        model, _ = ransac(
            xy, CircleModel, min_samples=3, residual_threshold=0.4, max_trials=100, rng=0
        )
        return [Circle(*map(float, (*model.center, model.radius)))] if model else []

    return fit


def _opencv_circle() -> Fit:
    import cv2

    def fit(xy: Values) -> list[Any]:
        (x, y), radius = cv2.minEnclosingCircle(xy.astype(np.float32))
        return [Circle(float(x), float(y), float(radius))]

    return fit


# -- rectangles ------------------------------------------------------------------------------


def rectangle_cases(n_sets: int, seed: int) -> Iterator[Case]:
    for noise in (0.02, NOISE_CM):
        rng = np.random.default_rng([seed, int(1000 * noise), 2])
        sets, truth = [], []
        for _ in range(n_sets):
            length, breadth, turn = rng.uniform(8, 14), rng.uniform(3, 6), rng.uniform(0, np.pi)
            shape = Rectangle(rng.uniform(8, 12), rng.uniform(8, 12), length, breadth, turn)
            corners = shape.outline_cm()
            lengths = np.array([length, breadth, length, breadth])
            side = rng.choice(4, POINTS, p=lengths / lengths.sum())
            ends = np.roll(corners, -1, axis=0)
            if not np.isclose(np.hypot(*(ends[0] - corners[0])), length):
                side = (side + 1) % 4
            along = rng.random(POINTS)[:, None]
            xy = corners[side] * (1 - along) + ends[side] * along
            sets.append(xy + rng.normal(0, noise, xy.shape))
            truth.append(TrueObject(shape, 0.0, "rectangle"))
        yield Case(f"noise {noise:g} cm", tuple(sets), tuple(truth))


def rectangle_fits() -> dict[str, Fit]:
    fits = ours("fit_rectangle", "min_area_rectangle")
    if find_spec("cv2"):
        import cv2

        fits["OpenCV minAreaRect"] = opencv_box(cv2.minAreaRect, Rectangle, 1.0)
    return fits


# -- hulls -----------------------------------------------------------------------------------


def hull_cases(n_sets: int, seed: int) -> Iterator[Case]:
    for n in (50, 500, 5000):
        rng = np.random.default_rng([seed, n, 3])
        sets = tuple(
            np.ascontiguousarray(rng.normal(10, 2, (n, 2))) for _ in range(max(2, n_sets // 4))
        )
        truth = tuple(TrueObject(_exact_hull(xy), 0.0, "hull") for xy in sets)
        yield Case(f"{n} points", sets, truth)


def _exact_hull(xy: Values) -> Polygon:
    from scipy.spatial import ConvexHull

    return Polygon(xy[ConvexHull(xy).vertices])


def hulls() -> dict[str, Fit]:
    fits = ours("hull", "hull_graham", "hull_beneath_beyond", "hull_qhull")
    if find_spec("cv2"):
        import cv2

        def opencv(xy: Values) -> list[Any]:
            return [Polygon(cv2.convexHull(xy.astype(np.float32))[:, 0, :].astype(np.float64))]

        fits["OpenCV convexHull"] = opencv
    return fits
