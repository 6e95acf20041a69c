"""Who runs on a frame: our pipelines, and straight scripts with other libraries."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Circle, Ellipse, Frame, Pipeline, Rectangle, load
from tactile_graph.engine.tables.truth import errors_against, nearest, shape_kind
from tactile_graph.wires.frame import TrueObject

Values = NDArray[np.float64]
LEVEL_V = 0.01
LARGEST_CM = 15.0
"""Of radii and half sides on 16x16 elements, for who asks for it."""
DISC5 = np.array(
    [[0, 0, 1, 0, 0], [0, 1, 1, 1, 0], [1, 1, 1, 1, 1], [0, 1, 1, 1, 0], [0, 0, 1, 0, 0]], np.uint8
)


@dataclass(frozen=True)
class Contestant:
    """A name, and what it makes of a frame: the shapes it found.

    ``pipeline`` is None for a peer's script.
    """

    name: str
    call: Callable[[Frame], object]
    shapes: Callable[[Any], list[Any]]
    pipeline: Pipeline | None = None


def ours(name: str, pad: dict[str, Any]) -> Contestant:
    """Return a shipped pipeline, set to the pad at hand."""
    pipeline = load(name)
    wide = LARGEST_CM * pad["geometry"]["rows"] / 16  # the objects grow with the pad
    at_hand = {"pad": pad, "largest_cm": wide}
    on_pad = {
        f"{node.name}.{setting}": value
        for node in pipeline.nodes.values()
        for setting, value in at_hand.items()
        if setting in node.settings
    }
    pipeline = pipeline.with_settings(on_pad) if on_pad else pipeline
    return Contestant(name, pipeline.runner(), shapes_of, pipeline)


def shapes_of(result: Any) -> list[Any]:
    """Return every shape among a result's outputs, lists and records of them looked into."""
    return list(_shapes(result.outputs.values()))


def _shapes(values: Iterable[Any]) -> Iterable[Any]:
    for value in values:
        if shape_kind(type(value)) is not None:
            yield value
        elif isinstance(value, list | tuple):
            yield from _shapes(value)
        elif hasattr(value, "x_cm") and hasattr(value, "y_cm"):
            yield value  # a contact: it has a place, if no shape


def error_of(shapes: list[Any], truth: Iterable[TrueObject]) -> dict[str, float | None]:
    """Return the mean absolute errors over the true objects; None where one has no answer.

    An object's centre is compared with the nearest shape of any kind, its measures only with one
    of its own kind.
    """
    found: dict[str, list[float | None]] = {}
    for true in truth:
        found.setdefault("centre_cm", []).append(_centre_error(shapes, true))
        kind = shape_kind(type(true.shape))
        alike = [s for s in shapes if shape_kind(type(s)) is kind]
        if alike:
            best = min(alike, key=lambda s: _distance(s, true.shape))
            if kind is not None and nearest(best, [true]) is not None:
                for name, error in errors_against(best, true).items():
                    if name != "centre_cm":
                        found.setdefault(name, []).append(abs(error))
    return {
        q: None if any(e is None for e in errors) else float(np.mean([e or 0.0 for e in errors]))
        for q, errors in found.items()
    }


def _centre_error(shapes: list[Any], true: TrueObject) -> float | None:
    return min((_distance(s, true.shape) for s in shapes), default=None)


def _distance(a: Any, b: Any) -> float:
    return float(np.hypot(a.x_cm - b.x_cm, a.y_cm - b.y_cm))


def peers() -> list[Contestant]:
    """Return the scripts whose libraries are installed."""
    makers: list[tuple[str, str, Callable[[], Callable[[Frame], list[Any]]]]] = [
        ("scikit-image script", "skimage", _skimage_circle),
        ("scikit-image RANSAC", "skimage", _skimage_ransac),
        ("circle-fit script", "circle_fit", _circle_fit),
        ("OpenCV script", "cv2", _opencv_circle),
        ("OpenCV fitEllipse", "cv2", _opencv_ellipse),
        ("OpenCV minAreaRect", "cv2", _opencv_rectangle),
    ]
    return [
        Contestant(name, make(), lambda found: list(found))
        for name, module, make in makers
        if find_spec(module)
    ]


def _fine(frame: Frame) -> NDArray[np.uint8]:
    """Return the footprint in half cells."""
    mask = frame.image.values >= LEVEL_V
    return np.repeat(np.repeat(mask, 2, axis=0), 2, axis=1).astype(np.uint8)


def _cm(frame: Frame, points: Values) -> Values:
    """Return points counted in half cells, (x, y), in cm."""
    return np.asarray(frame.image.origin_cm) + (points + 0.5) * np.asarray(frame.image.pitch_cm) / 2


def _kasa(xy: Values) -> tuple[float, float, float]:
    a = np.column_stack([xy, np.ones(len(xy))])
    p, q, r = np.linalg.lstsq(a, (xy * xy).sum(axis=1), rcond=None)[0]
    return p / 2, q / 2, float(np.sqrt(max(r + (p * p + q * q) / 4, 0.0)))


def _circles(x: float, y: float, radius: float) -> list[Any]:
    return [Circle(float(x), float(y), float(radius))] if radius > 0.0 else []


def _opencv_boundary(frame: Frame) -> Values | None:
    import cv2

    eroded = cv2.erode(_fine(frame), DISC5, borderType=cv2.BORDER_CONSTANT, borderValue=0)
    contours, _ = cv2.findContours(
        cv2.dilate(eroded, DISC5), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE
    )
    if not contours:
        return None
    hull = cv2.convexHull(np.vstack(contours))[:, 0, :]
    return _cm(frame, hull.astype(np.float64))


def _opencv_circle() -> Callable[[Frame], list[Any]]:
    def script(frame: Frame) -> list[Any]:
        xy = _opencv_boundary(frame)
        return [] if xy is None or len(xy) < 3 else _circles(*_kasa(xy))

    return script


def _opencv_ellipse() -> Callable[[Frame], list[Any]]:
    import cv2

    def script(frame: Frame) -> list[Any]:
        xy = _opencv_boundary(frame)
        if xy is None or len(xy) < 5:
            return []
        (x, y), (a, b), turn = cv2.fitEllipse(xy.astype(np.float32))
        major, minor = max(a, b) / 2, min(a, b) / 2
        if not minor > 0.0:
            return []
        angle = np.radians(-turn if a >= b else -turn - 90.0)
        return [Ellipse(float(x), float(y), float(major), float(minor), float(angle))]

    return script


def _opencv_rectangle() -> Callable[[Frame], list[Any]]:
    import cv2

    def script(frame: Frame) -> list[Any]:
        xy = _opencv_boundary(frame)
        if xy is None or len(xy) < 3:
            return []
        (x, y), (a, b), turn = cv2.minAreaRect(xy.astype(np.float32))
        angle = np.radians(-turn if a >= b else -turn - 90.0)
        if not min(a, b) > 0.0:
            return []
        return [Rectangle(float(x), float(y), float(max(a, b)), float(min(a, b)), float(angle))]

    return script


def _skimage_boundary(frame: Frame) -> Values:
    from skimage.morphology import dilation, erosion
    from skimage.segmentation import find_boundaries

    opened = dilation(erosion(_fine(frame), DISC5, mode="constant", cval=0), DISC5)
    rows, columns = np.nonzero(find_boundaries(opened, mode="inner"))
    return _cm(frame, np.column_stack([columns, rows]).astype(np.float64))


def _skimage_circle() -> Callable[[Frame], list[Any]]:
    from scipy.spatial import ConvexHull
    from skimage.measure import CircleModel

    def script(frame: Frame) -> list[Any]:
        xy = _skimage_boundary(frame)
        if len(xy) < 3:
            return []
        model = CircleModel.from_estimate(xy[ConvexHull(xy).vertices])
        return _circles(*model.center, model.radius) if model else []

    return script


def _skimage_ransac() -> Callable[[Frame], list[Any]]:
    from skimage.measure import CircleModel, ransac

    def script(frame: Frame) -> list[Any]:
        xy = _skimage_boundary(frame)
        if len(xy) < 4:
            return []
        model, _ = ransac(
            xy, CircleModel, min_samples=3, residual_threshold=0.5, max_trials=100, rng=0
        )
        return _circles(*model.center, model.radius) if model else []

    return script


def _circle_fit() -> Callable[[Frame], list[Any]]:
    from circle_fit import taubinSVD

    def script(frame: Frame) -> list[Any]:
        xy = _skimage_boundary(frame)
        if len(xy) < 3:
            return []
        x, y, radius, _ = taubinSVD(xy)
        return _circles(x, y, radius)

    return script
