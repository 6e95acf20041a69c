"""``choose_shape``: which of some shapes lies on the pad, by evidence."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal, NamedTuple

from annotated_types import Gt, Le, Len

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image
from tactile_graph_likelihood.fit_footprint import KINDS
from tactile_graph_likelihood.footprint_of import Load, Part, Positive, model_of
from tactile_graph_likelihood.likely import Likely, likely
from tactile_graph_likelihood.model import Model, Top
from tactile_graph_likelihood.outlines import REGULAR
from tactile_graph_likelihood.posterior import Posterior
from tactile_graph_likelihood.readings import Readings, readings_of

FAR = 8.0
"""Nats below the largest evidence from which on a shape is not looked around."""
HOPELESS = 25.0
"""Nats below it from which on a shape's search begins no second time."""

Name = Literal["disc", "ellipse", "rectangle", "polygon"]

CORNERS = (3, 5, 6)
"""Of a regular polygon, equally likely beforehand; four are a rectangle's."""


class Chosen(NamedTuple):
    """The likeliest shape, its probability among those asked for, and theirs."""

    shape: Likely
    name: str
    probability: float
    disc: float
    ellipse: float
    rectangle: float
    polygon: float


class ChooseShape:
    """Return the shape with the largest evidence, and the probability of each.

    Parameters
    ----------
    shapes : list
        The shapes to choose from, equally likely beforehand. ``polygon`` is a regular one of 3, 5
        or 6 corners.
    pad : str or mapping
        Name of a pad, its YAML file, or the pad itself.
    estimate : list
        What of sigma, voids and foam is estimated with the object.
    on_pad : "whole" or "partly"
        Whether the whole outline lies on the pad, or its centre only.
    smallest_cm, largest_cm : float, optional
        Range of radii and half sizes: the evidence of a shape with two falls as it widens. 0.4
        pitches and the pad's diagonal if not given.
    precision : float
        As in `fit_footprint`.

    Notes
    -----
    By Bayes' rule over the shapes' evidence, the frame's likelihood averaged over the prior. A
    shape that explains nothing has probability 0. See `fit_footprint` for the model.
    """

    stateless = True

    def __init__(
        self,
        *,
        shapes: Annotated[list[Name], Len(1)] = ["disc", "ellipse", "rectangle"],  # noqa: B006
        pad: str | dict[str, Any] = "thesis",
        estimate: list[Part] = [],  # noqa: B006 - settings are never changed
        on_pad: Literal["whole", "partly"] = "partly",
        smallest_cm: Positive | None = None,
        largest_cm: Positive | None = None,
        precision: Annotated[float, Gt(0), Le(1)] = 0.2,
    ) -> None:
        self._models = {
            name: [
                model_of(
                    REGULAR if n else KINDS[name], n, pad, None, None, 1e-3, None, None, None,
                    estimate, on_pad, smallest_cm, largest_cm, precision, 1024, 0,
                )
                for n in (CORNERS if name == "polygon" else (0,))
            ]
            for name in dict.fromkeys(shapes)
        }  # fmt: skip

    def __call__(self, image: Load) -> Chosen:
        """Return the choice.

        Raises
        ------
        Degenerate
            If nothing is touched, or none of the shapes explains what is.
        """
        tops, readings = self._tops(image)
        logs = [top.evidence for _, _, top in tops]
        found: dict[int, Posterior] = {}
        reason = "none of the shapes explains what is touched"
        for k in sorted(range(len(tops)), key=logs.__getitem__, reverse=True):
            _, model, top = tops[k]
            if top.height == -math.inf or logs[k] < max(logs) - FAR:
                continue
            try:
                found[k] = model.around(readings, top)
                logs[k] = found[k].log_evidence
            except Degenerate as why:
                logs[k], reason = -math.inf, str(why)
        if not found:
            raise Degenerate(reason)
        own = {
            name: [log for log, top in zip(logs, tops, strict=True) if top[0] == name]
            for name in self._models
        }
        evidence: dict[str, float] = {name: _log_mean(its) for name, its in own.items()}
        likeliest = max(evidence.values())
        weights = {name: math.exp(log - likeliest) for name, log in evidence.items()}
        total = sum(weights.values())
        chances = dict.fromkeys(Chosen._fields[3:], 0.0)
        chances |= {n: w / total for n, w in weights.items()}
        best = max(dict.fromkeys(tops[k][0] for k in found), key=lambda name: evidence[name])
        shape = max((k for k in found if tops[k][0] == best), key=logs.__getitem__)
        return Chosen(
            likely(found[shape]), best, chances[best],
            chances["disc"], chances["ellipse"], chances["rectangle"], chances["polygon"],
        )  # fmt: skip

    def _tops(self, image: Image) -> tuple[list[tuple[str, Model, Top]], Readings]:
        """Return the top of each outline to choose from, and the readings it comes from."""
        models = [(name, model) for name, its in self._models.items() for model in its]
        first = models[0][1]
        readings = readings_of(image, first.gap_cm, first.noise.least)
        tops = [model.top_of(readings) for _, model in models]
        likeliest = max(top.evidence for top in tops)
        for k, (_, model) in enumerate(models):
            if tops[k].unsure and tops[k].evidence > likeliest - HOPELESS:
                tops[k] = model.top_of(readings, tops[k])
        return [(*model, top) for model, top in zip(models, tops, strict=True)], readings


def _log_mean(logs: list[float]) -> float:
    """Return the logarithm of the mean of numbers whose logarithms are given."""
    top = max(logs)
    if top == -math.inf:
        return top
    return top + math.log(sum(math.exp(log - top) for log in logs) / len(logs))
