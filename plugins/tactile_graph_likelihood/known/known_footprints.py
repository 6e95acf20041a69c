"""Known objects as the likelihood takes them: kind of outline, sizes, and weight."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tactile_graph.errors import DataError, UsageError, did_you_mean
from tactile_graph.wires import Image, Polygon
from tactile_graph_likelihood.geometry.outlines import (
    DISC,
    ELLIPSE,
    RECTANGLE,
    REGULAR,
    Values,
    packed,
)
from tactile_graph_likelihood.known.known_sizes import KnownSizes
from tactile_graph_likelihood.known.touched_sizes import FEATURES, Touching, sizes_from
from tactile_graph_likelihood.single.model import Model
from tactile_graph_likelihood.single.readings import readings_of
from tactile_graph_pads.pad import Pad

KINDS = {"disc": DISC, "ellipse": ELLIPSE, "rectangle": RECTANGLE, "polygon": REGULAR}
CORNERS = (3, 4, 5, 6)
"""Of a polygon that nobody says more of."""

STATED_CM = 0.02
"""Standard deviation of a size that is stated."""

LEAST_SPREAD, FEW_SPREAD, FEW = 0.005, 0.05, 3
"""Of the logarithm of a weight: never less; and with fewer readings than three."""


@dataclass(frozen=True, eq=False)
class KnownFootprint:
    """A known object.

    Parameters
    ----------
    name, shape : str
    outlines : tuple of (int, int, KnownSizes)
        Kind, corners and sizes; several where the number of corners is not known.
    log_weight, spread, freedom : float
        Student's t of the logarithm of the sum of all readings.
    """

    name: str
    shape: str
    outlines: tuple[tuple[int, int, KnownSizes], ...]
    log_weight: float
    spread: float
    freedom: float

    def log_density(self, log_weight: float) -> float:
        """Return the log density of a weight's logarithm."""
        z, nu = (log_weight - self.log_weight) / self.spread, self.freedom
        constant = math.lgamma(0.5 * (nu + 1.0)) - math.lgamma(0.5 * nu)
        constant -= 0.5 * math.log(nu * math.pi) + math.log(self.spread)
        return constant - 0.5 * (nu + 1.0) * math.log1p(z * z / nu)


def known_footprints(
    database: Path | dict[str, Any] | None,
    stated: Mapping[str, Mapping[str, Any]],
    model: Model,
    pad: Pad,
    level: float,
) -> tuple[KnownFootprint, ...]:
    """Return the objects of a database.

    Parameters
    ----------
    database : Path, mapping or None
        As the classifiers take it.
    stated : mapping
        Name -> shape and lengths of objects whose sizes are known, as in a scene.
    model : Model
        How elements are touched.
    pad : Pad
    level : float
        Load from which an element counted as touched when the objects were learned.

    Raises
    ------
    DataError
        If the database has no weight in grams or no area, or an object has no shape.
    UsageError
        If ``stated`` names an object that is not known.
    """
    from tactile_graph_classifiers.database.opening import load_known

    known = load_known(database, ["weight", "area_cm2"])
    if known.quantity not in ("", "gram"):
        raise DataError(
            known.where, f"the objects were learned in {known.quantity}; they are needed in gram"
        )
    for name in stated:
        if name not in known.names:
            near = did_you_mean(name, known.names)
            raise UsageError(f"sizes: no object named {name!r} is known{near or ''}")
    axes = _axes(database)
    ones = np.ones(pad.geometry.shape)
    grid = readings_of(pad.image(ones, "gram"), model.gap_cm, 0.0)
    found = []
    for k, it in enumerate(known.objects):
        weights = np.log(np.maximum(it.readings[:, 0], 1e-9))
        at = Touching(model, grid, float(np.exp(weights.mean())), level)
        if it.name in stated:
            shape, outlines = _stated(it.name, stated[it.name])
        elif it.shape in KINDS:
            shape = it.shape
            two = shape in ("rectangle", "ellipse")
            if two and axes is None:
                raise DataError(
                    known.where,
                    f"{it.name!r} has two sizes, but {FEATURES[2][0]} and {FEATURES[2][1]} were "
                    "not learned; learn them, or state its sizes",
                )
            features = axes[k] if two and axes is not None else it.readings[:, 1:]
            outlines = _outlines(shape, at, features)
        else:
            raise DataError(
                known.where, f"{it.name!r} was learned without a shape; state its sizes"
            )
        found.append(KnownFootprint(it.name, shape, outlines, *_weight(weights)))
    return tuple(found)


def _axes(database: Path | dict[str, Any] | None) -> list[Values] | None:
    from tactile_graph_classifiers.database.opening import load_known

    try:
        return [o.readings for o in load_known(database, list(FEATURES[2])).objects]
    except DataError:
        return None


def _weight(logs: Values) -> tuple[float, float, float]:
    """Return middle, width and degrees of freedom of the next weight's logarithm."""
    n = len(logs)
    if n < FEW:
        return float(logs.mean()), FEW_SPREAD * math.sqrt(1.0 + 1.0 / n), float(FEW)
    spread = max(float(logs.std(ddof=1)), LEAST_SPREAD)
    return float(logs.mean()), spread * math.sqrt(1.0 + 1.0 / n), n - 1.0


def _outlines(
    shape: str, at: Touching, features: Values
) -> tuple[tuple[int, int, KnownSizes], ...]:
    kind = KINDS[shape]
    corners = CORNERS if kind == REGULAR else (0,)
    return tuple((kind, n, sizes_from(kind, n, at, features)) for n in corners)


def _stated(
    name: str, given: Mapping[str, Any]
) -> tuple[str, tuple[tuple[int, int, KnownSizes], ...]]:
    """Return the outline that lengths say, as in a scene."""
    from tactile_graph_sources.scene import load_scene

    thing = {"weight_g": 1.0, **given, "name": name}
    outline = load_scene({"objects": [thing]}).group(0)[0].footprint(0.0, 0.0, 0.0)
    if isinstance(outline, Polygon):
        if "sides" not in given:
            raise UsageError(f"sizes: {name!r}: a polygon needs sides and radius_cm here")
        kind, corners, lengths = REGULAR, int(given["sides"]), np.array([float(given["radius_cm"])])
    else:
        kind, corners, p = packed(outline)
        lengths = p[2 : 3 if kind == DISC else 4]
    exact = KnownSizes(lengths, STATED_CM**2 * np.eye(len(lengths)))
    return str(given.get("shape", "")), ((kind, corners, exact),)


def weight_of(image: Image, level: float) -> float:
    """Return the sum of all loads from ``level`` on."""
    values = image.filled(0.0)
    return float(values[values >= level].sum())
