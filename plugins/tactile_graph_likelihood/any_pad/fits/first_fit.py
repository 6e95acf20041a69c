"""A frame's first outline, by readings that a learned pad's gains have evened, if these hold."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

from tactile_graph.wires import Image
from tactile_graph_likelihood.any_pad.fits.localise import AnyPad
from tactile_graph_likelihood.any_pad.observation.observed import observed
from tactile_graph_likelihood.single.model import Likeliest
from tactile_graph_likelihood.single.readings import Readings
from tactile_graph_pads.pad import Pad


class FirstFit(NamedTuple):
    """An even face's outline by one attempt, the readings as it has them, and fits that suit."""

    fits: AnyPad
    readings: Readings
    even: Likeliest


def first_fit(image: Image, pad: Pad, gap_cm: float | None, any_pad: AnyPad) -> FirstFit:
    """Return the first fit of a frame, with or without the gains that a pad has learned.

    Parameters
    ----------
    image : Image
    pad : Pad
    gap_cm : float, optional
        As in `observed`.
    any_pad : AnyPad

    Notes
    -----
    Gains were learned under some objects and need not hold under others: foam spreads loads over
    neighbours, and dividing by gains makes such readings less even, not more. Where they scatter
    more like those that were not evened, after more attempts too if one may have gone astray, both
    are fitted. Foam that is seen in one of them alone tells that it is right, since gains that do
    not hold hide it. Else what is likelier is kept: the density of readings' logarithms is the same
    but for the gains.

    Raises
    ------
    RuleError, DataError, Degenerate
        As of `observed`.
    """
    found = _fitted(observed(image, pad, gap_cm), any_pad)
    plain = any_pad.unevened
    if plain is None or not _scatters(found, any_pad):
        return found
    found = found._replace(even=found.fits.searched(found.readings, found.even))
    if not _scatters(found, any_pad):
        return found
    other = _fitted(observed(image, pad, gap_cm, evened=False), plain)
    if _foam(found) != _foam(other):
        return other if _foam(other) else found
    return other if other.even.evidence > found.even.evidence else found


def _foam(found: FirstFit) -> bool:
    return found.readings.through_foam is not None


def _fitted(readings: Readings, any_pad: AnyPad) -> FirstFit:
    return FirstFit(*any_pad.suited(readings).first(readings))


def _scatters(found: FirstFit, any_pad: AnyPad) -> bool:
    """Return whether a fit's sigma is nearer to that of readings that are not evened."""
    plain = any_pad.unevened
    if plain is None:
        return False
    sigmas = math.log(any_pad.told.noise.sigma) + math.log(plain.told.noise.sigma)
    return 2.0 * float(found.even.mode.p[-2]) > sigmas


def gains_hold(image: Image, pad: Pad, gap_cm: float | None, every: Iterable[AnyPad]) -> bool:
    """Return whether learned gains hold in a frame, for the kind of outline that fits it.

    Under an outline of another kind than the object's, readings scatter whatever the gains.
    Errors as of `first_fit`.
    """
    likeliest, hold = -math.inf, True
    for any_pad in every:
        found = first_fit(image, pad, gap_cm, any_pad)
        evened = found.fits.unevened is not None
        if any_pad.unevened is None or (evened and not _scatters(found, any_pad)):
            return True
        if found.even.evidence > likeliest:
            likeliest, hold = found.even.evidence, evened
    return hold
