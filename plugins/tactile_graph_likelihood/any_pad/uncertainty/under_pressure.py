"""The posterior of an outline under one pressure: sampled, or the normal one around its fit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tactile_graph.errors import Degenerate
from tactile_graph_likelihood.any_pad.fits.left_open import fewness, is_scattered, looseness
from tactile_graph_likelihood.any_pad.fits.localise import AnyPad
from tactile_graph_likelihood.any_pad.fits.two_pressures import PARTS
from tactile_graph_likelihood.any_pad.pad_effects.from_frame import (
    AS_LOADS,
    contrast_of,
    learned,
    strays_beyond,
    variance_inflation,
)
from tactile_graph_likelihood.any_pad.uncertainty.posterior import inflated
from tactile_graph_likelihood.geometry.outlines import DISC, Values
from tactile_graph_likelihood.single.any_pressure import COUNTS, EVEN
from tactile_graph_likelihood.single.changed import changed
from tactile_graph_likelihood.single.climbs.maximise import Mode
from tactile_graph_likelihood.single.density.element_terms import CONTRAST
from tactile_graph_likelihood.single.model import Likeliest
from tactile_graph_likelihood.single.noise import SPREADS
from tactile_graph_likelihood.single.posterior import Posterior
from tactile_graph_likelihood.single.readings import Readings, is_row

FEW_POINTS = 64
"""Points in which the posterior of what is rather noise is looked at, as wide as the pad."""

FINER = 2.0
"""By how much more precisely an outline is sampled the fewer elements are touched."""

COARSER = 1.3
"""By how much less precisely a wide outline is: a point costs much, and its mean is sure."""


@dataclass(frozen=True)
class UnderPressure:
    """What the fits of a frame tell of an outline under each pressure, taken by itself.

    Parameters
    ----------
    fits : AnyPad
    readings : Readings
    tops : mapping of str to Likeliest
        By pressure, as of `AnyPad.completed`.
    """

    fits: AnyPad
    readings: Readings
    tops: Mapping[str, Likeliest]

    def normal(self, part: str) -> Posterior:
        """Return the normal distribution around a fit, widened by what neighbours share."""
        told, n, top, row = self.fits.told, self.fits.n_even, self.tops[part], is_row(self.readings)
        if part == EVEN and self.fits.quick:
            its = told.normal_around(top, n + 1, self._pull(), row)
        else:
            its = told.normal_around(top, n + COUNTS.get(part, 0), row=row)
        return inflated(its, variance_inflation(top.fit.neighbours, self.readings.touched))

    def _pull(self) -> Values:
        """Return the slope of what an even face's scatter says of the law's exponent."""
        noise, pull = self.fits.told.noise, np.zeros(self.fits.n_even + 1)
        sigma = float(self.tops[EVEN].mode.p[-2])
        contrast = contrast_of(noise, sigma, self.readings, self.fits.law)
        pull[-1] = (contrast.power - noise.contrast) / SPREADS[CONTRAST] ** 2
        return pull

    def looked_at(self, part: str) -> Posterior:
        """Return a likeliest fit's posterior: sampled, but for an outline with an angle pressed.

        That has nine unknowns and more, for which few points are worse than none. Nor is a sample
        taken whose points are worth fewer than there are unknowns, as where strays explain all
        there is, unless it promises less than a normal distribution around the top.
        """
        fits, is_disc = self.fits, self.fits.told.kind == DISC
        if fits.quick and not fits.reaches_beyond(self.readings, self.tops[part]):
            normal = self.normal(part)
            if not is_disc or normal.centre_std_cm <= fits.sampled_above_cm:
                return normal
        if part != EVEN and not is_disc:
            return self.normal(part)
        try:
            found = self._sampled(part)
        except Degenerate:
            return self.normal(part)
        if found.equal_points > fits.n_even:
            return found
        return max(found, self.normal(part), key=lambda its: its.centre_std_cm)

    def _sampled(self, part: str) -> Posterior:
        """Return the posterior under a pressure, with the noise that its fit has found.

        Where neighbours are alike, readings scatter less about their own mean than gains do, by as
        much as elements are shared.
        """
        told, n, readings, top = self.fits.told, self.fits.n_even, self.readings, self.tops[part]
        point = told.point_of(top)
        shared = variance_inflation(top.fit.neighbours, readings.touched)
        strays = strays_beyond(told, readings, point)
        contrast, by_law = AS_LOADS, part == EVEN
        if by_law:
            contrast = contrast_of(told.noise, float(point[-2]), readings, self.fits.law)
        noise = learned(told.noise, point[-2:], readings.touched, strays, contrast, shared)
        loose = looseness(readings)
        if part == EVEN and self.fits.quick and told.kind == DISC:
            model = changed(told, noise=changed(noise, estimated=("contrast",)))
            return model.posterior_around(readings, _first(top, 1 + n), loose)
        # Of few elements a point costs little, and the posterior is far from normal.
        precision = told.precision / (1.0 + FINER * fewness(readings))
        if readings.is_wide:
            precision *= COARSER
        estimated = ("contrast",) if by_law else PARTS.get(part, (part,))
        noise = changed(noise, estimated=estimated)
        model = changed(told, noise=noise, precision=precision)
        if by_law:
            begin = point[: n + 1].copy()
            begin[-1] = noise.contrast
            if is_scattered(told.kind, readings, point):
                model = changed(model, most_points=FEW_POINTS)
            return model.posterior_near(readings, begin, loose)
        return model.posterior_around(readings, _first(top, n + COUNTS[part]), loose)


def _first(top: Likeliest, count: int) -> Mode:
    """Return the first numbers of a top, the others known."""
    return Mode(top.mode.p[:count].copy(), top.mode.root[:count, :count].copy(), top.mode.height)
