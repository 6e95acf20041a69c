"""``UnderPressures``: fits of an outline to a frame's readings under each pressure."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tactile_graph_likelihood.any_pad.fits.pressure_chances import FOAM
from tactile_graph_likelihood.any_pad.fits.two_pressures import LEAN, PARTS, under_two
from tactile_graph_likelihood.any_pad.fits.waist import gain_by_two
from tactile_graph_likelihood.any_pad.pad_effects.from_frame import (
    is_partly_hidden,
    room_on_pad,
    strays_beyond,
)
from tactile_graph_likelihood.any_pad.pad_effects.through_foam import has_no_foam
from tactile_graph_likelihood.geometry.outlines import RECTANGLE, Values, sizes, unknowns
from tactile_graph_likelihood.single.any_pressure import (
    CLEAR,
    EVEN,
    FIRST,
    NARROWER,
    OWN,
    RISE,
    WIDER,
    Pattern,
    asked_by,
)
from tactile_graph_likelihood.single.changed import changed
from tactile_graph_likelihood.single.density.element_terms import OVER
from tactile_graph_likelihood.single.model import Likeliest, Model
from tactile_graph_likelihood.single.noise import Noise
from tactile_graph_likelihood.single.readings import Readings
from tactile_graph_likelihood.single.sampling.sample import beyond_the_pad

FAINT = Pattern(1.0, 0.4, 2.5, 1.5)
"""From which on another pressure is worth its time; where a quick answer will do, it is `CLEAR`."""

SHARPER = 0.6
"""As `FAINT`, the fall of a rectangle: its own shape tells more of that."""

NEAR_EDGE = 0.25
"""Pitches before the pad's edge within which a side may as well be cut off by it."""

LEANING_WHOLE = 0.9
"""Of outlines that lean and end near the pad's edge, the share that lies on it whole, at most: what
is cut off leans more often than not, as a plate does that its other half pulls down."""

SATURATED = 0.1
"""Of what is touched, the share that reads the most from which on a pad saturates."""

STRANGE, FEW_STRAYS = -1.5, 2e-3
"""Surprise from which on an even face's readings are rather foam's, whatever pattern they leave;
and the share of strays beyond its outline up to which these are not what is unlikely."""


@dataclass(frozen=True)
class UnderPressures:
    """Fits of an outline that estimate gains, voids and one pressure or two with it.

    Parameters
    ----------
    told : Model
        An outline on the pad as told: the middle of every guess.
    quick : bool
        Whether a quick answer will do: other pressures are looked at where the pattern is clear.
    """

    told: Model
    quick: bool = False

    @cached_property
    def _kept(self) -> dict[str, Model]:
        return {}

    def fit(self, pressure: str) -> Model:
        """Return the model that estimates sigma and voids with the outline, under a pressure."""
        found = self._kept.get(pressure)
        if found is None:
            own = ["contrast"] if self.quick else []
            parts = own if pressure == EVEN else PARTS.get(pressure, (pressure,))
            found = self._kept[pressure] = self._search(self.told.noise, *parts, "sigma", "voids")
        return found

    @cached_property
    def n_even(self) -> int:
        """How many numbers an even face has on a pad whose noise is known."""
        return unknowns.call(self.told.kind, self.told.corners) + 1

    def _search(self, noise: Noise, *estimated: str) -> Model:
        """Return a model that goes over the pad's edge, unless it must not, as if there were none.

        Where the edge makes a step in the prior, a search would be caught before it.
        """
        whole = 1.0 if self.told.whole >= 1.0 else 0.0
        return changed(self.told, noise=changed(noise, estimated=estimated), whole=whole)

    def under_each(self, readings: Readings, even: Likeliest) -> dict[str, Likeliest]:
        """Return the most likely outlines by pressure, an even face's among them.

        Pressures are looked at that its residuals hint at. Where the outline is partly beyond the
        pad's edge only foam is, which may be why.
        """
        found = {EVEN: even}
        asked = asked_by([even.fit], self._others, self.least)
        if RISE in asked and not self.rises(readings, even):
            asked.remove(RISE)
        if FOAM not in asked and self._is_strange(readings, even):
            asked.append(FOAM)
        if asked and "fall" not in asked and has_no_foam(readings):
            asked = [part for part in asked if part != FOAM]  # that of own gains falls to the rim
        hidden = bool(asked) and self.reaches_beyond(readings, even)
        for part in asked:
            if hidden and part != FOAM:
                continue
            top = self.pressed(part, readings, even)
            if hidden and self.reaches_beyond(readings, top):
                continue
            if top.mode.height > -math.inf:
                found[part] = top
        if len(found) > 1 and not hidden and self.told.kind != RECTANGLE:
            found |= under_two(self.fit, self.told.point_of, readings, found)
        return found

    def rises(self, readings: Readings, even: Likeliest) -> bool:
        """Return whether a face may press with its rim; where it saturates, its middle reads less.

        A stiff rectangle's rise is no pressure of its own.
        """
        if self.told.kind == RECTANGLE or even.fit.fall > -self.least.rise:
            return False
        return bool(np.count_nonzero(readings.states == OVER) < SATURATED * readings.touched)

    def _is_strange(self, readings: Readings, even: Likeliest) -> bool:
        """Return whether an even face's readings are unlikely, and not for what lies beyond it."""
        if self.told.kind == RECTANGLE or even.fit.surprise >= STRANGE:
            return False
        return strays_beyond(self.told, readings, self.told.point_of(even)) <= FEW_STRAYS

    @property
    def _others(self) -> dict[str, list[float]]:
        """The pressures that are looked at alone; a stiff rectangle's rise is none of its own."""
        return FIRST if self.told.kind == RECTANGLE else OWN

    @property
    def least(self) -> Pattern:
        """The pattern that residuals show from which on another pressure is worth its time."""
        return CLEAR if self.quick else self.faint

    @cached_property
    def faint(self) -> Pattern:
        """The same where any answer will do, quick or not."""
        return FAINT._replace(fall=SHARPER) if self.told.kind == RECTANGLE else FAINT

    def gain_by_two(self, readings: Readings, even: Likeliest) -> float:
        """Return `gain_by_two` of an even face's most likely outline, which is no disc."""
        return gain_by_two.call(self.fit(EVEN).problem(readings), even.mode.p)

    def reaches_beyond(self, readings: Readings, top: Likeliest) -> bool:
        """Return whether a most likely outline is partly beyond the pad's edge.

        Foam, which makes outlines too large, may be why.
        """
        return is_partly_hidden(self.told.kind, readings, self.told.point_of(top))

    def beyond(self, part: str, readings: Readings, top: Likeliest) -> Values | None:
        """Return the covariance by which sides beyond the pad's edge widen a top's outline.

        None where they all lie well before it. Of no disc, whose arc tells of what is beyond.
        """
        if readings.is_wide:
            return None
        if room_on_pad(self.told.kind, readings, self.told.point_of(top)) > NEAR_EDGE:
            return None
        whole = self.told.whole
        if part == LEAN and whole < 1.0:
            whole = min(whole, LEANING_WHOLE)
        problem = changed(self.fit(part), whole=whole).problem(readings)
        return beyond_the_pad.call(problem, top.mode.p, top.mode.root)

    def pressed(self, part: str, readings: Readings, even: Likeliest) -> Likeliest:
        """Return the most likely outline under a pressure, near an even face's."""
        n, p = self.n_even, self.told.point_of(even)
        begin = np.concatenate([p[:n], OWN[part], p[-2:]])
        if part == "fall":
            begin[2 : 2 + sizes.call(self.told.kind)] *= 1.0 + WIDER
        elif part == RISE:
            begin[2 : 2 + sizes.call(self.told.kind)] *= 1.0 - NARROWER
        return self.fit(part).likeliest_near(readings, begin)
