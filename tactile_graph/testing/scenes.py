"""``scene``: a frame of objects on a simulated pad, with what truly lies there."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from tactile_graph.errors import UsageError
from tactile_graph.plugins.registry import installed
from tactile_graph.steps.injected import Report
from tactile_graph.steps.settings import spelled, validate_settings
from tactile_graph.wires import Circle, Ellipse, Frame, Polygon, Rectangle

WEIGHT_G = 500.0


def scene(*objects: Any, seed: int = 0, **settings: Any) -> Frame:
    """Return a frame of objects lying on a pad, its ``truth`` what they are.

    Parameters
    ----------
    *objects : Circle, Ellipse, Rectangle, Polygon or mapping
        Shapes of 500 g where they say, or objects as in the file of a scene; none for an empty pad.
    seed : int
        Of all that is random: noise, unevenness, places that are left to chance.
    **settings
        Those of the source ``simulate``, such as ``pad``, ``output`` or ``sigma``.

    Raises
    ------
    UsageError
        If a setting is not allowed, or an object is nothing that can lie there.
    """
    step = installed().step("sources.simulate")
    laid = {"objects": [_object(thing) for thing in objects]}
    values, troubles = validate_settings(step, {"scene": laid, "frames": 1, **settings})
    if troubles:
        path, what = troubles[0]
        raise UsageError(f"scene: {spelled(path)}: {what}" if path else f"scene: {what}")
    rng, report = np.random.default_rng(seed), Report()
    frames = step.target(**step.arguments(values), **{step.rng: rng, step.report: report})
    return next(iter(frames))  # type: ignore[no-any-return]


def _object(thing: Any) -> dict[str, Any]:
    """Return an object as in the file of a scene."""
    if isinstance(thing, Mapping):
        return dict(thing)
    if not isinstance(thing, Circle | Ellipse | Rectangle | Polygon):
        raise UsageError(f"scene: an object is a shape or a mapping, got {thing!r}")
    placed = {"place": [thing.x_cm, thing.y_cm], "weight_g": WEIGHT_G}
    if isinstance(thing, Circle):
        return {"shape": "disc", "radius_cm": thing.radius_cm, **placed}
    if isinstance(thing, Polygon):
        return {"shape": "polygon", "corners_cm": thing.xy_cm.tolist(), "angle_deg": 0.0, **placed}
    placed["angle_deg"] = math.degrees(thing.angle_rad)
    if isinstance(thing, Ellipse):
        axes = {"semi_major_cm": thing.semi_major_cm, "semi_minor_cm": thing.semi_minor_cm}
        return {"shape": "ellipse", **axes, **placed}
    sides = {"length_cm": thing.length_cm, "breadth_cm": thing.breadth_cm}
    return {"shape": "rectangle", **sides, **placed}
