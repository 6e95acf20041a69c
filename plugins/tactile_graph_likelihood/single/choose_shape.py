"""``choose_shape``: which of some shapes lies on the pad, by evidence."""

from __future__ import annotations

from typing import Annotated, Literal, NamedTuple

from annotated_types import Len

from tactile_graph.errors import Degenerate
from tactile_graph.steps import Spread
from tactile_graph_likelihood.geometry.outlines import REGULAR
from tactile_graph_likelihood.settings import ROUGHER, FootprintSettings, Load
from tactile_graph_likelihood.single.any_pressure import (
    EVEN,
    AnyPressure,
    asked_by,
    log_mean,
    shares_by,
)
from tactile_graph_likelihood.single.fit_footprint import KINDS
from tactile_graph_likelihood.single.frame_fits import FrameFits
from tactile_graph_likelihood.single.likely import Likely, likely

Name = Literal["disc", "ellipse", "rectangle", "polygon"]

FEW = 8.0
"""Touched elements by which shapes are told apart half as well as their evidence says."""

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
    settings : FootprintSettings

    Notes
    -----
    By Bayes' rule over the shapes' evidence, the frame's likelihood averaged over the prior, with
    ``pressure: any`` over pressures too, equally likely beforehand with each shape. A shape that
    explains nothing has probability 0. See `fit_footprint` for the model. The evidence of a shape
    with two sizes falls as their range widens. A ball's or a leaning disc's load passes for an
    ellipse's where all presses evenly: where a likely shape with an even face leaves such a pattern
    over, all are looked at under other pressures.
    """

    stateless = True

    def __init__(
        self,
        *,
        shapes: Annotated[list[Name], Len(1)] = ["disc", "ellipse", "rectangle"],  # noqa: B006
        settings: Annotated[
            FootprintSettings,
            Spread(
                "pad", "estimate", "on_pad", "smallest_cm", "largest_cm", "precision", "pressure"
            ),
        ] = ROUGHER,
    ) -> None:
        self._outlines = [
            (name, AnyPressure(settings.model(REGULAR if n else KINDS[name], n)))
            for name in dict.fromkeys(shapes)
            for n in (CORNERS if name == "polygon" else (0,))
        ]
        self._others = self._outlines[0][1].others if settings.pressure == "any" else {}

    def __call__(self, image: Load) -> Chosen:
        """Return the choice.

        Raises
        ------
        Degenerate
            If nothing is touched, or none of the shapes explains what is.
        """
        outlines = [outline for _, outline in self._outlines]
        fits = FrameFits(outlines[0].even.readings(image), outlines)
        before = {EVEN: 1.0}
        if asked := asked_by(fits.found.values(), self._others):
            before = fits.look_under(asked)
        if not fits.found:
            raise Degenerate(fits.reason)
        return self._chosen(fits, before)

    def _chosen(self, fits: FrameFits, before: dict[str, float]) -> Chosen:
        logs = [fits.evidence(k, before) for k in range(len(self._outlines))]
        names = [name for name, _ in self._outlines]
        evidence: dict[str, float] = {}
        for name in dict.fromkeys(names):
            its = [log for log, owner in zip(logs, names, strict=True) if owner == name]
            evidence[name] = log_mean(its, len(its))
        shares = shares_by(evidence, fits.readings.touched, FEW)
        shares = dict.fromkeys(Chosen._fields[3:], 0.0) | shares
        seen = {k for k, _ in fits.found}
        best = max(dict.fromkeys(names[k] for k in sorted(seen)), key=lambda name: evidence[name])
        shape = max((k for k in sorted(seen) if names[k] == best), key=logs.__getitem__)
        return Chosen(likely(fits.posterior(shape, before)), best, shares[best], **shares)
