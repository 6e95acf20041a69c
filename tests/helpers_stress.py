"""Steps that break in every way there is, and scenes with profiles for the stress tests."""

from __future__ import annotations

import math
import os
import time
from functools import cache
from typing import Any

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st

from tactile_graph import Circle, Degenerate, Image, Points, Polygon, hookimpl
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph_stress.subject import Subject, subjects

FAST = settings(max_examples=5, deadline=None)
FULL = settings(max_examples=200, deadline=None)
seeds = st.integers(0, 2**32 - 1)


def profile() -> settings:
    """Return few examples, or many where hypothesis' profile is ``full``."""
    return FULL if settings.get_current_profile_name() == "full" else FAST


@cache
def subject_of(name: str, feed: str = "", registry: Registry | None = None) -> Subject:
    """Return the subject of a step, fed as asked; with points if it may be and nothing is asked."""
    return next(s for s in _found(registry) if s.name == name and s.feed in (feed or s.feed))


@cache
def _found(registry: Registry | None) -> list[Subject]:
    return subjects(registry or installed())[0]


def registry_of(isolated: dict[str, float | None] | None = None, **steps: Any) -> Registry:
    class Plugin:
        @hookimpl
        def tactile_graph_steps(self) -> dict[str, Any]:
            return steps

        @hookimpl
        def tactile_graph_isolated(self) -> dict[str, float | None]:
            return isolated or {}

    return Registry([("fakes", "fakes", "1", lambda: Plugin())])  # type: ignore[arg-type,return-value]


def _kasa(xy: Any) -> tuple[float, float, float]:
    rows = np.column_stack([xy, np.ones(len(xy))])
    b, c, d = np.linalg.lstsq(rows, -(xy * xy).sum(axis=1), rcond=None)[0].tolist()
    return -b / 2, -c / 2, math.sqrt(max(b * b / 4 + c * c / 4 - d, 0.0))


def _refuse(xy: Any) -> None:
    if len(xy) < 3 or not (np.abs(xy) < 1e100).all():
        raise Degenerate("not enough to go on")


def uncentred(points: Points) -> Circle:
    """Kåsa's fit as textbooks print it: far away it loses all digits."""
    _refuse(points.xy_cm)
    return Circle(*_kasa(np.asarray(points.xy_cm, dtype=np.float64)))


def centred(points: Points) -> Circle:
    xy = np.asarray(points.xy_cm, dtype=np.float64)
    _refuse(xy)
    middle = xy.mean(axis=0)
    x, y, radius = _kasa(xy - middle)
    return Circle(x + float(middle[0]), y + float(middle[1]), radius)


def ordered(points: Points) -> Circle:
    """Depends on the order of the points."""
    _refuse(points.xy_cm)
    x, y, radius = _kasa(np.asarray(points.xy_cm)[:5])
    return Circle(x, y, radius)


def nan_out(points: Points) -> Circle:
    return Circle(math.nan, 0.0, 1.0)


def no_circle(points: Points) -> Circle:
    return 0.0, 0.0, 1.0  # type: ignore[return-value]


def warns(points: Points) -> Circle:
    return Circle(float(np.float64(1.0) / np.float64(0.0)), 0.0, 1.0)


def crashes(points: Points) -> Circle:
    return Circle(float(points.xy_cm[7, 9]), 0.0, 1.0)


def numpys_error(points: Points) -> Circle:
    return Circle(float(np.linalg.inv(np.zeros((2, 2)))[0, 0]), 0.0, 1.0)


def aborts(points: Points) -> Circle:
    """Ends its process, where there are more than a few points."""
    if len(points.xy_cm) > 5:
        os.abort()
    return centred(points)


def hangs(points: Points) -> Circle:
    time.sleep(600)
    return centred(points)


def refuses(points: Points) -> Circle:
    raise ValueError("radius_cm: must be > 0")


DRAWS = np.random.default_rng(0)


def drawing(image: Image) -> Image:
    """Draws without being given what to draw by."""
    return image.with_values(image.values * DRAWS.random())


def seeded(image: Image, *, rng: np.random.Generator) -> Image:
    return image.with_values(image.values * rng.random())


def halving(image: Image) -> Image:
    image.values.setflags(write=True)
    image.values[...] *= 0.5
    return image.with_values(image.values.copy())


def all_corners(points: Points) -> Polygon:
    """A hull that keeps every point."""
    return Polygon(np.array(points.xy_cm))


FAKES = registry_of(
    uncentred=uncentred, centred=centred, ordered=ordered, nan_out=nan_out, warns=warns,
    no_circle=no_circle, crashes=crashes, numpys_error=numpys_error, refuses=refuses,
    drawing=drawing, seeded=seeded, halving=halving, hull=all_corners, aborts=aborts, hangs=hangs,
    isolated={"aborts": None, "hangs": 0.2},
)  # fmt: skip
