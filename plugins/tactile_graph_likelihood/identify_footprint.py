"""``identify_footprint``: which known object lies on the pad, and where, in one likelihood."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from annotated_types import Ge, Gt, Le, Lt

from tactile_graph.errors import Degenerate
from tactile_graph.steps import Quantity
from tactile_graph.wires import Circle, Ellipse, Image, Rectangle, Shape
from tactile_graph_likelihood.element_terms import SPAN
from tactile_graph_likelihood.footprint_of import Positive, model_of
from tactile_graph_likelihood.known_footprints import (
    KnownFootprint,
    known_footprints,
    weight_of,
)
from tactile_graph_likelihood.known_sizes import KnownSizes
from tactile_graph_likelihood.likely import Likely, likely
from tactile_graph_likelihood.noise import level_of
from tactile_graph_likelihood.outlines import DISC, ELLIPSE, RECTANGLE
from tactile_graph_likelihood.posterior import Posterior
from tactile_graph_likelihood.readings import Readings, readings_of

HOPELESS = 20.0
"""How far, in logarithms, an object's best possible evidence may lie below the best one's."""

SIZES_TELL = 15.0
"""What known sizes can add to the evidence of a free outline, at most."""

UNKNOWN = "unknown"


class Identified(NamedTuple):
    """Which object it is, and where it lies.

    ``probability`` is that of ``name``; ``unknown`` the probability that it is none of the known
    objects, in which case ``object`` is the likeliest outline of any size.
    """

    name: str
    shape: str
    known: bool
    probability: float
    runner_up: str
    runner_up_probability: float
    unknown: float
    object: Likely


class IdentifyFootprint:
    """Return the known object that explains shape, size and weight best, located.

    Parameters
    ----------
    database : Path or mapping, optional
        The object database, or an export of one; the sample of the thesis' objects if not given.
    sizes : mapping
        Name -> shape and lengths, as in a scene, of objects whose sizes are known; those of
        others come from what was learned of their touched elements.
    unknown : float
        Probability, before a frame is read, that it is none of them.
    learned_level_v : float
        Voltage from which an element counted as touched when the objects were learned.
    pad, on_pad, smallest_cm, largest_cm, precision
        As in `fit_footprint`.

    Raises
    ------
    DataError
        If the objects were not learned in grams, without a shape, or without what their sizes
        can be found from.
    UsageError
        If ``sizes`` names an object that is not known.

    Notes
    -----
    Thesis figure 4.37 in one likelihood. An object's evidence is that of its kind of outline with
    its sizes as prior, times the density of the weight's logarithm by its readings (Student's t).
    The load's scale is log-uniform within an outline's evidence, and takes the weight's place:
    the weight's density is divided by that of the scale. The unknown object is a disc, ellipse or
    rectangle of any size and weight.
    """

    stateless = True

    def __init__(
        self,
        *,
        database: Path | dict[str, Any] | None = None,
        sizes: dict[str, dict[str, Any]] = {},  # noqa: B006 - settings are never changed
        unknown: Annotated[float, Ge(0), Lt(1)] = 0.05,
        learned_level_v: Positive = 0.01,
        pad: str | dict[str, Any] = "thesis",
        on_pad: Literal["whole", "partly"] = "partly",
        smallest_cm: Positive = 0.5,
        largest_cm: Positive = 15.0,
        precision: Annotated[float, Gt(0), Le(1)] = 0.2,
    ) -> None:
        from tactile_graph_pads.pad import load_pad

        pad_record = load_pad(pad)
        self._free = {
            kind: model_of(
                kind, 0, pad, None, None, 1e-3, None, None, None, [], on_pad,
                smallest_cm, largest_cm, precision, 1024, 0,
            )
            for kind in (DISC, ELLIPSE, RECTANGLE)
        }  # fmt: skip
        self._level = level_of(pad_record, learned_level_v)
        self._objects = known_footprints(database, sizes, self._free[DISC], pad_record, self._level)
        self._log_unknown = math.log(max(unknown, 1e-300))
        self._log_known = math.log((1.0 - unknown) / len(self._objects))

    def __call__(self, image: Annotated[Image, Quantity("gram")]) -> Identified:
        """Return the object.

        Parameters
        ----------
        image : Image
            Loads in grams; invalid cells say nothing.

        Raises
        ------
        Degenerate
            If nothing is touched, or nothing explains what is.
        """
        model = self._free[DISC]
        readings = readings_of(image, model.gap_cm, model.noise.least)
        free = self._any(readings)
        tops = [p.log_evidence for p in free.values()]
        score = _log_mean(tops, len(self._free)) + self._log_unknown
        found: list[tuple[float, KnownFootprint | None, Posterior]] = [
            (score, None, max(free.values(), key=lambda p: p.log_evidence))
        ]
        log_weight = math.log(max(weight_of(image, self._level), 1e-300))
        rest = [
            (it.log_density(log_weight) + math.log(SPAN) + self._log_known, it)
            for it in self._objects
        ]
        best = score
        for level, it in sorted(rest, key=lambda pair: -pair[0]):
            if level + max(tops) + SIZES_TELL < best - HOPELESS:
                break
            seen = self._seen(it, readings, free)
            if seen is not None:
                found.append((level + seen[0], it, seen[1]))
                best = max(best, level + seen[0])
        return _chosen(found)

    def _any(self, readings: Readings) -> dict[int, Posterior]:
        """Return the posteriors of outlines of any size."""
        found, reason = {}, Degenerate("no outline explains what is touched")
        for kind, model in self._free.items():
            try:
                found[kind] = model.posterior_of(readings)
            except Degenerate as why:
                reason = why
        if not found:
            raise reason
        return found

    def _seen(
        self, it: KnownFootprint, readings: Readings, free: dict[int, Posterior]
    ) -> tuple[float, Posterior] | None:
        """Return an object's log evidence by its outline, and the posterior; None without one."""
        found = []
        for kind, corners, known in it.outlines:
            model = replace(self._free[DISC], kind=kind, corners=corners)
            start = _start(free[kind], known) if kind in free else None
            try:
                posterior = model.posterior_of(readings, start, known.belief(model))
            except Degenerate:
                continue
            found.append((posterior.log_evidence - known.log_share(model), posterior))
        if not found:
            return None
        logs = [log for log, _ in found]
        return _log_mean(logs, len(it.outlines)), max(found, key=lambda pair: pair[0])[1]


def _start(free: Posterior, known: KnownSizes) -> Shape:
    """Return the outline of known sizes where one of any size was found."""
    shape = free.most_likely_shape
    if isinstance(shape, Circle):
        return Circle(shape.x_cm, shape.y_cm, float(known.mean[0]))
    assert isinstance(shape, Ellipse | Rectangle)
    factor = 2.0 if isinstance(shape, Rectangle) else 1.0
    long, short = (factor * known.mean).tolist()
    return type(shape)(shape.x_cm, shape.y_cm, long, short, shape.angle_rad)


def _log_mean(logs: list[float], count: int) -> float:
    top = max(logs)
    return top + math.log(sum(math.exp(log - top) for log in logs) / count)


def _chosen(found: list[tuple[float, KnownFootprint | None, Posterior]]) -> Identified:
    found = sorted(found, key=lambda one: -one[0])
    chances = np.exp([one[0] - found[0][0] for one in found])
    chances /= chances.sum()
    names = [UNKNOWN if one[1] is None else one[1].name for one in found]
    best = found[0][1]
    return Identified(
        names[0],
        "" if best is None else best.shape,
        best is not None,
        float(chances[0]),
        names[1] if len(names) > 1 else "",
        float(chances[1]) if len(names) > 1 else 0.0,
        float(chances[names.index(UNKNOWN)]),
        likely(found[0][2]),
    )
