"""``Noise``: how unevenly elements read, as the kernels take it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.density.element_terms import (
    CONTRAST,
    FALL,
    FOAM,
    LEAN_X,
    LEAN_Y,
    SIGMA,
    VOIDS,
)
from tactile_graph_likelihood.single.density.problem import Places
from tactile_graph_pads.pad import Pad

ESTIMATED = {
    "sigma": (SIGMA,),
    "voids": (VOIDS,),
    "foam": (FOAM,),
    "fall": (FALL,),
    "profile": (FALL,),
    "lean": (LEAN_X, LEAN_Y),
    "contrast": (CONTRAST,),
}
"""What may be estimated with an object, and its places in a noise vector."""

LEAST_SIGMA, LEAST_VOIDS, MOST_VOIDS = 0.05, 1e-3, 0.9
"""What a model is held to: no pad is more even than this, and each element may fail."""

DEVIATIONS = 5.0  # of the converter's noise that hardly any element of a frame exceeds
SPREADS = {SIGMA: 0.4, VOIDS: 0.8, FOAM: 0.7, FALL: 0.3, LEAN_X: 0.7, LEAN_Y: 0.7, CONTRAST: 0.15}
"""Standard deviations of ln sigma, the voids' log odds, ln foam, of the pressure's fall and lean
(see `load_shares`) and of the contrast, before a frame is read."""

FALL_GUESSED = 0.5
"""The middle of the guess: a ball's (Hertz)."""

PROFILE_STD = 0.5
"""The deviation of a fall that may be a rise as well, around an even face: a flat stiff one's on a
soft layer is -1/2."""

GUESSED_FOAM = 0.5
"""Pitches; the middle of the guess where foam is estimated and none is given."""


class NoiseTaken(NamedTuple):
    """A noise vector, shape (9,), which of its places are estimated, (M,), and the guess of those.

    The guess has the mean and standard deviation of each, shape (M, 2), in the numbers of a point.
    """

    vector: Values
    places: Places
    guess: Values


@dataclass(frozen=True)
class Noise:
    """What the model takes for granted of a pad's unevenness.

    Parameters
    ----------
    sigma : float
        Standard deviation of the logarithm of an element's gain.
    voids : float
        Share of covered elements that read nothing.
    strays : float
        Probability that an element's reading has nothing to do with the object.
    least : float
        Least load that shows, in the image's unit; 0 where any does.
    foam_cm : float
        Width (standard deviation) over which foam spreads the load.
    estimated : tuple of str
        Which of sigma, voids, foam, fall, profile (a fall that may be a rise), lean and contrast
        are estimated with the object; the values here are then the middle of the guess. A pressure
        whose fall or lean is not estimated has none.
    contrast : float
        Power of an element's coverage that its reading goes with: 1 where readings are loads.
    contrast_std : float
        Its standard deviation beforehand, where it is estimated.
    """

    sigma: float = 0.5
    voids: float = 0.1
    strays: float = 1e-3
    least: float = 0.0
    foam_cm: float = 0.0
    estimated: tuple[str, ...] = ()
    contrast: float = 1.0
    contrast_std: float = SPREADS[CONTRAST]

    def vector(self, pitch_cm: float) -> Values:
        """Return the numbers as the kernels take them, shape (9,)."""
        return self.as_taken(pitch_cm).vector

    def as_taken(self, pitch_cm: float) -> NoiseTaken:
        """Return the numbers as the kernels take them, and which of them are estimated."""
        foam = self.foam_cm / pitch_cm
        if "foam" in self.estimated and foam <= 0.0:
            foam = GUESSED_FOAM
        numbers = [
            max(self.sigma, LEAST_SIGMA),
            min(max(self.voids, LEAST_VOIDS), MOST_VOIDS),
            self.strays,
            math.log(self.least) if self.least > 0.0 else -700.0,
            foam,
            FALL_GUESSED if "fall" in self.estimated else 0.0,
            0.0,
            0.0,
            self.contrast,
        ]
        places = [place for name in self.estimated for place in ESTIMATED[name]]
        guess: list[float] = []
        spreads = SPREADS | {CONTRAST: self.contrast_std}
        if "profile" in self.estimated:
            spreads[FALL] = PROFILE_STD
        for place in places:
            middle = numbers[place]
            if place < FALL:
                middle = math.log(middle / (1.0 - middle) if place == VOIDS else middle)
            guess += [middle, spreads[place]]
        return NoiseTaken(
            np.array(numbers),
            np.array(places, dtype=np.int64),
            np.array(guess, dtype=np.float64).reshape(len(places), 2),
        )


def noise_of(pad: Pad, **given: object) -> Noise:
    """Return a pad's own noise, but for what is given and not None.

    Parameters
    ----------
    pad : Pad
        Its unevenness, the scatter of its readings, its foam, and the least load that shows: half
        its turn-on load, below which the step `force` reads nothing, or what the converter's noise
        can pass for, if that is more.
    **given
        Fields of `Noise` to be used instead.
    """
    scatter = pad.law.repeatability / pad.law.power
    own: dict[str, object] = {
        "sigma": math.hypot(pad.unevenness.sigma, scatter),
        "voids": pad.unevenness.voids,
        "foam_cm": pad.contact.foam_cm,
        "least": max(0.5 * pad.law.turn_on_g, level_of(pad, DEVIATIONS * _noise_v(pad))),
    }
    own.update({name: value for name, value in given.items() if value is not None})
    return Noise(**own)  # type: ignore[arg-type]


def _noise_v(pad: Pad) -> float:
    """Return the standard deviation of a scanned voltage: noise and rounding, averaged."""
    step_v = 0.0 if pad.converter.bits is None else pad.converter.step_v
    return math.hypot(pad.scan.noise_v, step_v / math.sqrt(12.0)) / math.sqrt(pad.scan.samples)


def level_of(pad: Pad, level_v: float) -> float:
    """Return the load, in grams, that one element alone shows as so many volts."""
    volts = np.zeros(pad.geometry.shape)
    volts[0, 0] = level_v
    return max(float(pad.backward(volts).load_g[0, 0]), 1e-6)
