"""``posterior_around``: what fits under all pressures come to, on any pad."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from tactile_graph_likelihood.any_pad.fits.left_open import (
    NO_FALL,
    PATTERN,
    UNSEEN,
    hidden_by,
    looseness,
    unseen_share,
)
from tactile_graph_likelihood.any_pad.fits.localise import AnyPad
from tactile_graph_likelihood.any_pad.fits.pressure_chances import (
    FALL,
    FOAM,
    log_chances,
    on_foam,
    shared_by,
)
from tactile_graph_likelihood.any_pad.observation.clump import is_in_parts
from tactile_graph_likelihood.any_pad.pad_effects.from_frame import (
    evened_by_foam,
    variance_inflation,
)
from tactile_graph_likelihood.any_pad.pad_effects.hollow import is_covered_rim
from tactile_graph_likelihood.any_pad.pad_effects.through_foam import has_no_foam
from tactile_graph_likelihood.any_pad.uncertainty.ghosts import as_ghostly
from tactile_graph_likelihood.any_pad.uncertainty.lopsided import lopsided
from tactile_graph_likelihood.any_pad.uncertainty.posterior import AnyPadPosterior, on_any_pad
from tactile_graph_likelihood.any_pad.uncertainty.under_pressure import UnderPressure
from tactile_graph_likelihood.any_pad.uncertainty.widened import (
    as_filtered,
    evenly_spread,
    resized,
    stretched,
    unsized,
    within,
)
from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE
from tactile_graph_likelihood.single.any_pressure import BOTH, EVEN, FOAM_ODDS, RISE, mixed
from tactile_graph_likelihood.single.changed import changed
from tactile_graph_likelihood.single.model import Likeliest
from tactile_graph_likelihood.single.posterior import Posterior
from tactile_graph_likelihood.single.readings import Readings, is_row

NEGLIGIBLE = 0.03
"""Probability over the likeliest pressure's below which one is left out."""

PRESSED = {"lean": 0.8, "fall": 0.8, RISE: 0.8, "foam": 2.8}
PRESSED |= {both: PRESSED[parts[0]] for both, parts in BOTH.items()}
"""Share that is added to the variance where a pressure of one or two numbers explains the load: no
face presses quite like that, and foam shares gains that the fit takes for the outline's."""

PROFILES, PROFILE_OFF = (RISE, *BOTH), 0.06
"""Pressures with a rise or of two kinds, and of a pitch by how much lengths under them are off: no
face presses quite like that, and what its fit leaves over is small."""

LEAN_AND_FALL, LEANT = "lean and fall", 0.15
"""Of a pitch: by how much more sizes are off of what leans and falls or rises to its rim."""

RISEN, RISEN_FROM = 0.25, 1.2
"""Of a pitch: by how much a face that rises to its rim in a way that no fit explains looks too
large."""

BLURRED = 0.6
"""Of the width of foam: by how much a face that falls or rises to its rim under it, nobody knows
how, is larger or smaller than an even one that looks like it."""

COVERED = 0.5
"""Of a pitch: by how much a rim under a cover looks too large."""

RISES, LESS = -0.5, 0.3
"""Of how far a load falls to its rim, in standard deviations: it rises there if it is less; and the
share of an edge's shift that is left then."""

TOLD_FOAM = 0.8
"""The same under foam that is told, whose width nobody knows to better than a tenth."""

UNSURER = 1.3
"""Times the variance of a normal distribution around an outline with an angle that a sample of it
would come to, for a quick answer: between two rows of elements nothing holds its sides."""

UNSUREST = 2.3
"""The same of a rectangle under a pressure, which has nine unknowns, for any other answer."""

TWO, FEWEST_OF_TWO, WELL = 5.0, 12, 0.7
"""Nats, over what neighbours share, by which two discs are likelier from which on an outline is
taken for both of them; touched elements, at least; and a surprise that few outlines around two
discs are above."""


def posterior_around(
    fits: AnyPad, readings: Readings, tops: Mapping[str, Likeliest]
) -> AnyPadPosterior:
    """Return the posterior around the most likely outlines, over all pressures.

    Parameters
    ----------
    fits : AnyPad
    readings : Readings
        As `AnyPad.first` gives them.
    tops : mapping of str to Likeliest
        By pressure, as of `AnyPad.completed`.

    Notes
    -----
    The likeliest of the fits is sampled with the noise that it has found, an even face with the
    law's exponent; the others stand for themselves as normal distributions, by their evidence over
    what neighbouring elements share. Where more than 4096 elements are touched a
    pattern that an even face leaves only widens the posterior.
    """
    return _Around(fits, readings, tops).posterior()


@dataclass(frozen=True)
class _Around:
    """What fits of a frame found under some pressures, and what they come to."""

    fits: AnyPad
    readings: Readings
    tops: Mapping[str, Likeliest]

    def posterior(self) -> AnyPadPosterior:
        """Return the posterior over all pressures."""
        told, readings, tops = self.fits.told, self.readings, self.tops
        logs = self._log_chances()
        best = max(logs, key=logs.__getitem__)
        shares = {part: math.exp(log - logs[best]) for part, log in logs.items()}
        its = self._weighed(best, shares)
        pressed = sum(share * self._wider(part) for part, share in shares.items())
        evidence = tops[EVEN].evidence + logs[best] - logs[EVEN]
        unseen = self._hidden(its) + readings.length_std_cm**2
        if len(shares) > 1 and any(part in PROFILES for part in shares):
            profiled = sum(shares.get(part, 0.0) for part in PROFILES) / sum(shares.values())
            unseen += profiled * (PROFILE_OFF * float(readings.grid[2])) ** 2
        whole = on_any_pad(
            its,
            evidence,
            pressed / sum(shares.values()),
            told.noise.sigma * float(readings.grid[2]) ** 1.5,
            unseen,
            self._missed() if best == EVEN else 0.0,
            is_in_parts(readings.through_foam or readings.part_of or readings) or self._is_two(),
            # Learned gains leave so little that what is always unseen would look vague.
            0.0 if self.fits.unevened is None else unseen,
        )
        whole = unsized(self._cut_off(whole, shares), self._unended_cm(shares))
        if is_covered_rim(told.kind, readings, whole.mean):
            whole = unsized(whole, COVERED * float(readings.grid[2]))
        if readings.filtered:
            whole = as_filtered(whole, float(readings.grid[2]))
        if readings.ghosts:
            whole = as_ghostly(whole)
        whole = stretched(whole, readings)
        if is_row(readings):
            whole = within(whole, *told.range_cm(readings))
        if told.kind != RECTANGLE or self.fits.quick or self.readings.is_wide:
            return whole
        whole = resized(whole, UNSEEN * unseen_share(tops[EVEN].fit.fall))
        reaches_beyond = self.fits.reaches_beyond(readings, tops[best])
        return whole if reaches_beyond else evenly_spread(whole)

    def _log_chances(self) -> dict[str, float]:
        # A pressure is told by all of a face: elements count for as much less along both axes.
        shared = shared_by(self.tops.values(), self.readings.touched) ** 2
        odds = FOAM_ODDS * self._foam_by_scatter()
        return log_chances(self.tops, shared, self.readings.touched, odds)

    def _weighed(self, best: str, shares: Mapping[str, float]) -> Posterior:
        """Return the mixture of the fits by their shares, of which the best has 1."""
        under = UnderPressure(self.fits, self.readings, self.tops)
        found = {best: under.looked_at(best)}
        for part, share in shares.items():
            if part != best and share > NEGLIGIBLE:
                found[part] = under.normal(part)
        its = found[best]
        if len(found) > 1:
            weighed = {p: changed(f, log_evidence=math.log(shares[p])) for p, f in found.items()}
            its = mixed(weighed, dict.fromkeys(weighed, 1.0))
        elif best != EVEN:
            its = changed(its, pressures={best: 1.0})
        if self.readings.through_foam is not None:
            its = changed(its, pressures=on_foam(its.pressures))
        return its

    def _unended_cm(self, shares: Mapping[str, float]) -> float:
        """Return the deviation of sizes where foam hides how a face ends, or a rise is left over.

        Foam that was undone, or is told of, hides less.
        """
        best = self.tops[max(shares, key=shares.__getitem__)].fit
        if len(self.tops) == 1 and best.fall >= -(RISEN_FROM + NO_FALL):
            return 0.0
        hidden = sum(shares.values()) * (RISEN * unseen_share(-best.fall - RISEN_FROM)) ** 2
        for part, top in self.tops.items():
            hidden += shares[part] * LEANT**2 if part == LEAN_AND_FALL else 0.0
            if part.startswith(FOAM):
                width = math.exp(top.mode.p[self.fits.n_even])
                hidden += shares[part] * (BLURRED * width) ** 2
        return float(self.readings.grid[2]) * math.sqrt(hidden / sum(shares.values()))

    def _cut_off(self, whole: AnyPadPosterior, shares: Mapping[str, float]) -> AnyPadPosterior:
        """Return a posterior that is wider towards where sides may lie beyond the pad's edge.

        A sample of an even rectangle knows of these by itself.
        """
        if self.fits.told.kind == DISC:  # its arc tells of what is beyond
            return whole
        kept = {part: share for part, share in shares.items() if share > NEGLIGIBLE}
        if self.fits.told.kind == RECTANGLE and [*kept] == [EVEN] and not self.fits.quick:
            return whole
        covariance = whole.covariance
        for part, share in kept.items():
            beyond = self.fits.beyond(part, self.readings, self.tops[part])
            if beyond is not None:
                covariance = covariance.copy()
                covariance[:6, :6] += share / sum(kept.values()) * beyond[:6, :6]
        return whole if covariance is whole.covariance else changed(whole, covariance=covariance)

    def _missed(self) -> float:
        """Return how much what an even face's outline misses lies to a side, 0 where foam blurs it.

        Nor is it looked at where more than 4096 elements are touched.
        """
        told, readings = self.fits.told, self.readings
        if told.noise.foam_cm > 0.0 or readings.through_foam is not None or self.readings.is_wide:
            return 0.0
        point = told.point_of(self.tops[EVEN])
        return max(lopsided.call(told.kind, point, readings.grid, readings.states), 0.0)

    def _is_two(self) -> bool:
        """Return whether two discs that touch are clearly likelier than all that was looked at.

        Not asked of a disc, nor where an outline explains readings well, foam may fill a waist, or
        few or more than 4096 are touched.
        """
        told, readings, even = self.fits.told, self.readings, self.tops[EVEN]
        if told.kind == DISC or even.fit.surprise > WELL or readings.touched < FEWEST_OF_TWO:
            return False
        if self.readings.is_wide or is_row(readings):
            return False
        if told.noise.foam_cm > 0.0 or readings.through_foam is not None:
            return False
        best = max(top.evidence for top in self.tops.values()) - even.evidence
        worth = variance_inflation(even.fit.neighbours, readings.touched)
        return self.fits.gain_by_two(readings, even) > best + TWO * worth

    def _foam_by_scatter(self) -> float:
        """Return by how much readings' scatter makes foam more probable than a round face."""
        if FALL not in self.tops or FOAM not in self.tops:
            return 1.0
        if has_no_foam(self.readings):
            return 0.0
        told = math.log(self.fits.told.noise.sigma)
        by_foam, by_face = (float(self.tops[part].mode.p[-2]) - told for part in (FOAM, FALL))
        return evened_by_foam(by_foam, by_face, self.readings.touched)

    def _wider(self, part: str) -> float:
        """Return by how much the variance under a pressure is larger than that of its fit."""
        told = self.fits.told
        wider = 1.0 + PRESSED.get(part, TOLD_FOAM if told.noise.foam_cm > 0.0 else 0.0)
        if told.kind == DISC:
            return wider
        if self.fits.quick:
            return UNSURER * wider
        return UNSUREST * wider if part != EVEN and told.kind == RECTANGLE else wider

    def _hidden(self, its: Posterior) -> float:
        """Return the variance in cm^2 of lengths that a pattern hides where it is not looked into.

        Less of it where the face rises to its rim: foam and round faces fall to it.
        """
        if self.fits.quick:
            left = hidden_by(its.alike, self.readings) if len(self.tops) == 1 else 0.0
            return left + looseness(self.readings)
        if not self.readings.is_wide or its.alike <= PATTERN:
            return 0.0
        rises = its.fall < RISES and its.lean <= PATTERN
        return hidden_by(LESS * PATTERN if rises else PATTERN, self.readings)
