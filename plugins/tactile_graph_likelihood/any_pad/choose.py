"""``locate``: one object of any of some shapes on any pad."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Literal, NamedTuple

import numpy as np
from annotated_types import Len

from tactile_graph.wires import Image
from tactile_graph_likelihood.any_pad.fits.contest import tops_of_each
from tactile_graph_likelihood.any_pad.fits.first_fit import gains_hold
from tactile_graph_likelihood.any_pad.fits.localise import AnyPad
from tactile_graph_likelihood.any_pad.fits.pressure_chances import log_chances, shared_by
from tactile_graph_likelihood.any_pad.fits.wide import sized_in_part
from tactile_graph_likelihood.any_pad.locate import ANY_PAD, SoonSettings
from tactile_graph_likelihood.any_pad.observation.learned_pad import Placing
from tactile_graph_likelihood.any_pad.observation.observed import NearlySquare, observed
from tactile_graph_likelihood.any_pad.uncertainty.around import posterior_around
from tactile_graph_likelihood.any_pad.uncertainty.ghosts import tells_of_ghosts
from tactile_graph_likelihood.single.any_pressure import EVEN, shares_by
from tactile_graph_likelihood.single.fit_footprint import KINDS
from tactile_graph_likelihood.single.likely import Likely, likely
from tactile_graph_likelihood.single.model import Likeliest
from tactile_graph_likelihood.single.readings import Readings

Name = Literal["disc", "ellipse", "rectangle"]

FEW = 12.0
"""Touched elements by which shapes are told apart half as well as their evidence says."""

FEWEST = 5
"""Touched elements from which on shapes are told apart: an ellipse has as many unknowns, and around
fewer its top is as flat as the pad is wide."""


class Located(NamedTuple):
    """The likeliest shape, its probability among those asked for, and theirs."""

    shape: Likely
    name: str
    probability: float
    disc: float
    ellipse: float
    rectangle: float


class Locate:
    """Return the likeliest shape on a pad that need not be as it is told, and its place.

    Parameters
    ----------
    shapes : list
        The shapes to choose from, equally likely beforehand.
    settings : LocateSettings

    Notes
    -----
    By Bayes' rule over the shapes' evidence, over all pressures that were looked at, worth as many
    times less as neighbouring elements hang together, and less the fewer elements are touched.
    Where fewer than five are, it is a disc if one is asked for, all shapes being as likely as
    before. See `locate_disc` for what is estimated.
    """

    stateless = True
    notice = staticmethod(tells_of_ghosts)

    def __init__(
        self,
        *,
        shapes: Annotated[list[Name], Len(1)] = ["disc", "ellipse", "rectangle"],  # noqa: B006
        settings: SoonSettings = ANY_PAD,
    ) -> None:
        self._pad, self._gap_cm = settings.known_pad, settings.gap_cm
        self._placing = Placing(self._pad)
        self._every: dict[str, AnyPad] = {
            name: AnyPad.of(settings, KINDS[name]) for name in dict.fromkeys(shapes)
        }

    def __call__(self, image: NearlySquare) -> Located:
        """Return the choice.

        Parameters
        ----------
        image : Image
            Readings that rise with load, in any quantity; invalid cells say nothing.

        Raises
        ------
        RuleError
            If the image's cells are not nearly square, or a pad was learned, of another shape,
            pitch or quantity.
        Degenerate
            If nothing rises above the noise, or none of the shapes explains what does.
        """
        return self.placed(image, [self._believed(image)])[0]

    def _believed(self, image: Image) -> Located:
        """Return the choice by readings evened by learned gains, or not; see `gains_hold`."""
        fits = self._every.values()
        told = any(one.unevened is not None for one in fits)
        if not told or gains_hold(image, self._pad, self._gap_cm, fits):
            return self.chosen(self.readings(image))
        every = {name: its.unevened or its for name, its in self._every.items()}
        return self._chosen(observed(image, self._pad, self._gap_cm, evened=False), every)

    def placed(self, image: Image, found: Sequence[Located]) -> list[Located]:
        """Return all objects of an image where a learned pad says that they lie."""
        moved = self._placing(image, [its.shape.posterior for its in found])
        return [
            its._replace(shape=likely(posterior))
            for its, posterior in zip(found, moved, strict=True)
        ]

    def readings(self, image: Image) -> Readings:
        """Return what an image shows; errors as of a call."""
        return observed(image, self._pad, self._gap_cm)

    def chosen(self, readings: Readings) -> Located:
        """Return the choice by some readings; errors as of a call."""
        return self._chosen(readings, self._every)

    def _chosen(self, readings: Readings, every: Mapping[str, AnyPad]) -> Located:
        every = {name: any_pad.suited(readings) for name, any_pad in every.items()}
        if "disc" in every and readings.touched < FEWEST:
            return _as_disc(every, readings)
        every, readings, tops = tops_of_each(every, readings)
        chance = probabilities(tops, readings)
        best = max(chance, key=chance.__getitem__)
        shares = dict.fromkeys(Located._fields[3:], 0.0) | chance
        if readings.is_wide:
            readings, even = sized_in_part(every[best], readings, tops[best][EVEN])
            tops[best] = {EVEN: even}
        shape = likely(posterior_around(every[best], readings, tops[best]))
        return Located(shape, best, chance[best], **shares)


def _as_disc(every: Mapping[str, AnyPad], readings: Readings) -> Located:
    """Return the disc as `locate_disc` does, no more likely than any other shape."""
    its, readings, even = every["disc"].first(readings)
    shape = likely(posterior_around(its, readings, its.completed(readings, even)))
    chance = dict.fromkeys(every, 1.0 / len(every))
    shares = dict.fromkeys(Located._fields[3:], 0.0) | chance
    return Located(shape, "disc", chance["disc"], **shares)


def probabilities(
    tops: Mapping[str, Mapping[str, Likeliest]], readings: Readings
) -> dict[str, float]:
    """Return the probability of each shape by its fits, given that it is one of them."""
    shared = shared_by((t for its in tops.values() for t in its.values()), readings.touched)
    logs = {
        name: float(np.logaddexp.reduce(list(log_chances(its, shared, readings.touched).values())))
        for name, its in tops.items()
    }
    return shares_by(logs, readings.touched, FEW)
