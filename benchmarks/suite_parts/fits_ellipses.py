"""Family ``ellipse fits``: arcs, few and many points, more and more noise, and a pad's outlines."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.util import find_spec
from typing import Any

import numpy as np

from suite_parts.fits_common import NOISE_CM, POINTS, Case, Fit, Values, opencv_box, ours
from tactile_graph import Ellipse
from tactile_graph.api.pipeline import loads
from tactile_graph.wires.frame import TrueObject

COUNTS = (10, 20, 40, 1000)
NOISES_CM = (0.01, 0.05, 0.5)
LEAST_POINTS = 8

OUTLINED = """
pipeline: outlined
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  boundary: {step: boundary_scan, in: footprint}
  hull: {step: hull, in: boundary}
outputs: [boundary, hull]
"""
OVALS = [
    {"shape": "ellipse", "name": f"{a:g} x {b:g}", "weight_g": 40.0 * a * b, "semi_major_cm": a,
     "semi_minor_cm": b}
    for a, b in ((7.0, 4.5), (6.0, 3.0), (5.0, 4.0), (4.0, 2.5))
]  # fmt: skip


def ellipse_cases(n_sets: int, seed: int) -> Iterator[Case]:
    """Yield point sets of ellipses: whole and in part, few points and many, little noise and much.

    Also what a pad of 16 by 16 elements shows of ellipses: the centres of the boundary's elements,
    and their hull's corners.
    """
    yield _arcs("arc of 120 degrees", n_sets, [seed, 120, 1], degrees=120)
    yield _arcs("arc of 360 degrees", n_sets, [seed, 360, 1])
    for n in COUNTS:
        yield _arcs(f"points: {n}", n_sets, [seed, n, 4], n=n)
    for noise in NOISES_CM:
        yield _arcs(f"noise: {noise:g} cm", n_sets, [seed, int(1000 * noise), 5], noise=noise)
    yield from _outlines(n_sets, seed)


def _arcs(
    name: str,
    n_sets: int,
    seed: list[int],
    *,
    degrees: float = 360.0,
    n: int = POINTS,
    noise: float = NOISE_CM,
) -> Case:
    rng = np.random.default_rng(seed)
    sets, truth = [], []
    for _ in range(n_sets):
        a, b, turn = rng.uniform(4, 7), rng.uniform(2, 3.5), rng.uniform(0, np.pi)
        shape = Ellipse(rng.uniform(8, 12), rng.uniform(8, 12), a, b, turn)
        t = rng.uniform(0, 2 * np.pi) + np.radians(degrees) * rng.random(n)
        u, v = a * np.cos(t), b * np.sin(t)
        cos, sin = np.cos(turn), np.sin(turn)
        xy = np.column_stack([shape.x_cm + u * cos - v * sin, shape.y_cm - u * sin - v * cos])
        sets.append(xy + rng.normal(0, noise, xy.shape))
        truth.append(TrueObject(shape, 0.0, "ellipse"))
    return Case(name, tuple(sets), tuple(truth))


def _outlines(n_sets: int, seed: int) -> Iterator[Case]:
    scene = {"in_turn": [[oval] for oval in OVALS]}
    pipeline = loads(OUTLINED).with_source("simulate", scene=scene, frames=n_sets)
    found: dict[str, list[tuple[Values, TrueObject]]] = {"boundary": [], "hull": []}
    for result in pipeline.stream(seed=seed):
        for name, cases in found.items():
            xy = np.array(result.get(name).xy_cm)
            if len(xy) >= LEAST_POINTS:
                cases.append((xy, result.frame.truth[0]))
    for name, cases in found.items():
        sets, truth = zip(*cases, strict=True)
        yield Case(f"16 by 16: {name}", sets, truth)


def ellipse_fits() -> dict[str, Fit]:
    """Return our fits and those of the peers that are installed."""
    fits = ours("fit_ellipse", "fit_ellipse_direct")
    if find_spec("cv2"):
        import cv2

        for name in ("fitEllipse", "fitEllipseAMS", "fitEllipseDirect"):
            fits[f"OpenCV {name}"] = opencv_box(getattr(cv2, name), Ellipse, 0.5)
    # scikit-image 0.26 needs an `eig` that gives real numbers, as NumPy's did before 2.5.
    if find_spec("skimage") and not np.iscomplexobj(np.linalg.eigvals(np.eye(2))):
        fits["skimage EllipseModel"] = _skimage_ellipse()
    return fits


def _skimage_ellipse() -> Fit:
    from skimage.measure import EllipseModel

    def fit(xy: Values) -> list[Any]:
        model = EllipseModel.from_estimate(xy)
        if not model:
            return []
        (x, y), (a, b), turn = model.center, model.axis_lengths, model.theta
        if a < b:
            a, b, turn = b, a, turn + np.pi / 2
        return [Ellipse(float(x), float(y), float(a), float(b), float(-turn))]

    return fit
