"""``choose_shape``: which of some shapes lies on the pad, by evidence."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal, NamedTuple

from annotated_types import Gt, Le, Len

from tactile_graph.errors import Degenerate
from tactile_graph_likelihood.geometry.outlines import REGULAR
from tactile_graph_likelihood.several.frame_fits import FrameFits
from tactile_graph_likelihood.single.any_pressure import EVEN, AnyPressure, asked_by, chances
from tactile_graph_likelihood.single.fit_footprint import KINDS
from tactile_graph_likelihood.single.footprint_of import Load, Part, Positive, model_of
from tactile_graph_likelihood.single.likely import Likely, likely
from tactile_graph_likelihood.single.readings import readings_of

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

    pressure : "any" or "even"
        Whether the object may press unevenly, as in `fit_footprint`: a ball's or a leaning
        disc's load else passes for an ellipse's. Looked at where a likely shape with an even face
        leaves such a pattern over, then of all shapes.

    Notes
    -----
    By Bayes' rule over the shapes' evidence, the frame's likelihood averaged over the prior, with
    ``pressure: any`` over pressures too, equally likely beforehand with each shape. A shape that
    explains nothing has probability 0. See `fit_footprint` for the model.
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
        pressure: Literal["any", "even"] = "any",
    ) -> None:
        self._outlines = [
            (name, AnyPressure(model_of(
                REGULAR if n else KINDS[name], n, pad, None, None, 1e-3, None, None, None,
                estimate, on_pad, smallest_cm, largest_cm, precision, 1024, 0,
            )))
            for name in dict.fromkeys(shapes)
            for n in (CORNERS if name == "polygon" else (0,))
        ]  # fmt: skip
        self._others = self._outlines[0][1].others if pressure == "any" else {}

    def __call__(self, image: Load) -> Chosen:
        """Return the choice.

        Raises
        ------
        Degenerate
            If nothing is touched, or none of the shapes explains what is.
        """
        outlines = [outline for _, outline in self._outlines]
        first = outlines[0].even
        fits = FrameFits(readings_of(image, first.gap_cm, first.noise.least))
        fits.add_even(outlines)
        before = {EVEN: 1.0}
        fits.look_around(before)
        if asked := asked_by(fits.found.values(), self._others):
            fits.add_others(outlines, asked)
            fits.look_around(chances(dict.fromkeys(asked)))
            before = chances({part: fits.likeliest(part) for part in asked})
        if not fits.found:
            raise Degenerate(fits.reason)
        return self._chosen(fits, before)

    def _chosen(self, fits: FrameFits, before: dict[str, float]) -> Chosen:
        logs = [fits.evidence(k, before) for k in range(len(self._outlines))]
        names = [name for name, _ in self._outlines]
        evidence = {
            name: _log_mean([log for log, its in zip(logs, names, strict=True) if its == name])
            for name in dict.fromkeys(names)
        }
        likeliest = max(evidence.values())
        weights = {name: math.exp(log - likeliest) for name, log in evidence.items()}
        total = sum(weights.values())
        shares = dict.fromkeys(Chosen._fields[3:], 0.0)
        shares |= {n: w / total for n, w in weights.items()}
        seen = {k for k, _ in fits.found}
        best = max(dict.fromkeys(names[k] for k in sorted(seen)), key=lambda name: evidence[name])
        shape = max((k for k in sorted(seen) if names[k] == best), key=logs.__getitem__)
        return Chosen(
            likely(fits.posterior(shape, before)), best, shares[best],
            shares["disc"], shares["ellipse"], shares["rectangle"], shares["polygon"],
        )  # fmt: skip


def _log_mean(logs: list[float]) -> float:
    """Return the logarithm of the mean of numbers whose logarithms are given."""
    top = max(logs)
    if top == -math.inf:
        return top
    return top + math.log(sum(math.exp(log - top) for log in logs) / len(logs))
