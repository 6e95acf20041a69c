"""``AtRest``: frames of an object that lies still, averaged, and whether the next one is another.

A frame's log loads are ``ln(s c g) + e``: the gains g were drawn when the object was put down and
stay; e is drawn for each frame. So a mean over frames keeps the gains' whole variance.
"""

from __future__ import annotations

import math

import numpy as np

from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.over_time.noise_behind import NoiseBehind, told_alone
from tactile_graph_likelihood.single.density.element_terms import (
    OFF,
    ON,
    ROOT_TWO_PI,
    SPAN,
    UNDER,
    UNKNOWN,
)
from tactile_graph_likelihood.single.readings import Readings

ODD = 0.01
"""Share of an object's elements whose reading changes though it lies still."""

SLID = 0.4
"""Share of elements that change where an object slid with its gains."""

LEAST_SPREAD = 0.3
"""Of the logarithms of an object's loads."""


class AtRest:
    """The frames since an object was put down.

    Parameters
    ----------
    first : Readings
    frame_sigma : float
        Standard deviation of the logarithm of a load between frames.
    least : float
        Logarithm of the least load that shows, where a frame's noise does not say it.
    noise : NoiseBehind, optional
        Of the first frame.
    """

    def __init__(
        self, first: Readings, frame_sigma: float, least: float, noise: NoiseBehind | None = None
    ) -> None:
        self._sigma, self._least = frame_sigma, least
        self._sums = np.zeros(first.states.shape)
        self._on = np.zeros(first.states.shape)
        self._seen = np.zeros(first.states.shape)
        self._noise = np.zeros(first.states.shape)
        self._change = 0.0
        self.frames = 0
        self._latest, self._latest_noise = first, noise
        self.add(first, noise)

    @property
    def _means(self) -> Values:
        return self._sums / np.maximum(self._on, 1.0)

    def _changed(self, now: Readings) -> float:
        """Return by how much all loads' logarithms changed together: weight, or creep."""
        both = (self._on > 0.0) & (now.states == ON)
        return float(np.median((now.logs - self._means)[both])) if both.any() else 0.0

    def add(self, now: Readings, noise: NoiseBehind | None = None) -> None:
        """Count a frame as one of the same object at rest."""
        on = now.states == ON
        its = noise or told_alone(now, self._least)
        self._change = self._changed(now)
        self._sums += np.where(on, now.logs - self._change, 0.0)
        self._noise += np.where(on, its.width**2, 0.0)
        self._on += on
        self._seen += now.states != UNKNOWN
        self.frames += 1
        self._latest, self._latest_noise = now, noise

    def fits_grid(self, now: Readings) -> bool:
        """Return whether a frame is of the same pad."""
        same = now.states.shape == self._on.shape
        return same and bool(np.array_equal(now.grid, self._latest.grid))

    def log_odds_of_move(self, now: Readings, noise: NoiseBehind | None = None) -> float:
        """Return the log likelihood of a frame if the object moved, over that if it rested.

        Notes
        -----
        Rested: a load repeats within the scatter of a frame and of the mean before it, or, with
        the probability `ODD`, does not; it fades where it was near the least that shows, or as
        often as it did before. Moved: an element that is or was touched is touched by even chance,
        and reads any load with the spread of the object's own. By even chance that is so of each
        such element, or of the share `SLID`: of an object that slid, elements well inside may read
        as before.
        """
        was, on = self._on > 0.0, now.states == ON
        means = self._means + self._changed(now)
        every = now.logs[on]
        middle, spread = float(every.mean()), max(float(every.std()), LEAST_SPREAD)
        its = noise or told_alone(now, self._least)
        n, scatter = np.maximum(self._on, 1.0), self._sigma**2
        before = scatter + self._noise / n
        width = np.sqrt(np.where(on, scatter + its.width**2, before) + before / n)
        repeats = (1.0 - ODD) * _normal(now.logs - means, width) + ODD / SPAN
        appears = ODD / SPAN + _normal(now.logs - its.least, np.hypot(2.0 * self._sigma, its.width))
        rested = np.where(on, np.where(was, repeats, appears), 1.0)
        gone = was & ~on
        fades = ODD + (1.0 - ODD) * _below(((its.least - means) / width)[gone])
        rested[gone] = np.maximum(fades, 1.0 - self._on[gone] / self._seen[gone])
        fresh = np.where(on, 0.5 * _normal(now.logs - middle, spread), np.where(was, 0.5, 1.0))
        known = (now.states != UNKNOWN) & (self._seen > 0.0)
        moved = np.log(fresh / rested)[known].sum()
        slid = np.log((1.0 - SLID) + SLID * fresh / rested)[known].sum()
        return float(np.logaddexp(moved, slid) - math.log(2.0))

    @property
    def averaged(self) -> Readings:
        """The mean of the frames, at the latest one's load; an element is on if it mostly was."""
        mostly = (2.0 * self._on > self._seen) & (self._seen > 0.0)
        bare = (OFF, 0.0) if self._latest_noise is None else (UNDER, self._latest_noise.least)
        states = np.where(mostly, ON, bare[0]).astype(np.uint8)
        states[self._seen == 0.0] = UNKNOWN
        logs = np.where(mostly, self._means + self._change, bare[1])
        return self._latest._replace(logs=logs).with_states(states)


def _below(z: Values) -> Values:
    """Return the normal distribution's share below z, shape (N,)."""
    return np.array([0.5 * math.erfc(-e * math.sqrt(0.5)) for e in z.tolist()])


def _normal(off: Values, width: Values | float) -> Values:
    z = np.minimum(np.abs(off / width), 37.0)
    return np.asarray(np.exp(-0.5 * z * z) / (width * ROOT_TWO_PI))
