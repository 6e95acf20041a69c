"""``AnyPressure``: an outline that presses evenly, leaning, less to its rim, or through foam."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image
from tactile_graph_likelihood.geometry.outlines import Values, period, sizes
from tactile_graph_likelihood.single.changed import changed
from tactile_graph_likelihood.single.density.goodness_of_fit import GoodnessOfFit
from tactile_graph_likelihood.single.model import Belief, Model, Start
from tactile_graph_likelihood.single.noise import FALL_GUESSED, GUESSED_FOAM
from tactile_graph_likelihood.single.posterior import Posterior
from tactile_graph_likelihood.single.readings import Readings
from tactile_graph_likelihood.single.sampling.importance import weighted_moments

LEAN, ROUND = 0.15, 0.15
"""Probability, before a frame is read, that a face leans; that its load falls to the rim, be it
that the face is round or that foam spreads the load."""

RISING = 0.05
"""That it rises to the rim, as of a flat stiff face on a soft layer."""

FOAM_ODDS = 0.15
"""Of foam over a round face, before a frame is read: foam is a pad's own and mostly known."""

SHARED, SPREAD = 5.0, 2.0
"""Mean and deviation, where there is foam, of how alike neighbours' residuals are: it shares their
gains, which no outline explains. Without foam they are 0 and 1."""

SHARED_BY = 80
"""Touched elements from which on it is so; among fewer are fewer neighbours."""

LARGEST = 700.0
"""Of log odds."""


class Pattern(NamedTuple):
    """What an even face leaves over, in standard deviations, as in `GoodnessOfFit`."""

    lean: float
    fall: float
    alike: float
    rise: float


CLEAR = Pattern(1.5, 1.5, 2.5, 2.5)
"""From which on a lean, a fall or a rise, and foam where neighbours are alike, are worth a fit's
time."""

HOPELESS = 2.0
"""Nats by which the evidence of a rough fit may fall behind an even face's and still be looked at:
with its chance beforehand against it, it would have a share of 3 % at most."""

WIDER = 0.15
"""By how much a falling pressure's outline is larger than an even one's that looks like it."""

NARROWER = 0.06
"""By how much a rising pressure's outline is smaller than an even one's that looks like it."""

EVEN, RISE = "even", "rise"

FIRST = {"lean": [0.0, 0.0], "fall": [FALL_GUESSED], "foam": [math.log(GUESSED_FOAM)]}
"""What a fit begins with, beside an even face's numbers."""

OWN = {**FIRST, RISE: [-0.4]}
"""The same, with a face that presses with its rim, of which a known pad's models know nothing."""

BOTH = {
    "lean and fall": ("lean", "profile"),
    "foam and fall": ("foam", "profile"),
    "foam and lean": ("foam", "lean"),
}
"""What is estimated of faces that lean or lie under foam, and fall, rise or lean, too."""

COUNTS = {part: len(own) for part, own in {**OWN, "profile": [0.0]}.items()}
COUNTS |= {both: sum(COUNTS[part] for part in parts) for both, parts in BOTH.items()}
"""How many numbers each estimates beside an even face's."""


@dataclass(frozen=True)
class AnyPressure:
    """A model of an even face on a pad as it is known, and models of what else it may be.

    Parameters
    ----------
    even : Model
    """

    even: Model

    @cached_property
    def others(self) -> dict[str, Model]:
        """The models that estimate how the pressure varies, or how far foam spreads it."""
        noise = self.even.noise
        known = {*noise.estimated, *(["foam"] if noise.foam_cm > 0.0 else [])}
        return {
            part: replace(self.even, noise=replace(noise, estimated=(*noise.estimated, part)))
            for part in FIRST
            if part not in known
        }

    def posterior(self, image: Image, start: Start = None) -> Posterior:
        """Return the posterior of the outline; parameters and errors as of `Model.posterior`."""
        readings = self.even.readings(image)
        even = self.even.posterior_of(readings, start)
        return self.completed(readings, even, asked_by([even], self.others))

    def completed(
        self, readings: Readings, even: Posterior, asked: list[str], belief: Belief = None
    ) -> Posterior:
        """Return the mixture of an even face's posterior and those under the pressures asked for.

        Those that turn out hopeless count as impossible, so that the evidence of outlines that
        were asked for the same compares. Parameters as of `Model.posterior_of`.
        """
        if not asked:
            return even
        found = {EVEN: even}
        for part in asked:
            other = self._other(part, readings, even, belief)
            if other is not None:
                found[part] = other
        return mixed(found, chances({part: found.get(part) for part in asked}))

    def _other(
        self, part: str, readings: Readings, even: Posterior, belief: Belief
    ) -> Posterior | None:
        model, begin = self.others[part], self.begin(part, even.most_likely)
        try:
            if belief is not None:
                return model.posterior_of(readings, begin, belief)
            top = model.likeliest(readings, start=begin)
            if top.evidence < even.log_evidence - HOPELESS:
                return None
            return model.posterior_around(readings, top.mode)
        except Degenerate:
            return None

    def begin(self, part: str, point: Values) -> Values:
        """Return where the fit of another pressure begins, from an even face's likeliest point."""
        begin = np.append(point, FIRST[part])
        if part == "fall":
            begin[2 : 2 + sizes.call(self.even.kind)] *= 1.0 + WIDER
        return begin


def asked_by(
    evens: Iterable[Posterior | GoodnessOfFit], others: Iterable[str], least: Pattern = CLEAR
) -> list[str]:
    """Return which pressures may explain what even faces leave over, where any does.

    Parameters
    ----------
    evens : iterable of Posterior or GoodnessOfFit
        Those of a frame that may be true: one that leaves a pattern is enough.
    others : iterable of str
        The pressures there are models of.
    least : Pattern
        From which on it is one.
    """
    evens = list(evens)
    lean = any(its.lean >= least.lean for its in evens)
    fall = any(its.fall >= least.fall for its in evens)
    alike = any(its.neighbours >= least.alike for its in evens)
    rise = any(its.fall <= -least.rise for its in evens)
    asked = {"lean": lean, "fall": fall, "foam": fall or alike, RISE: rise}
    return [part for part in others if asked[part]]


def chances(
    others: Mapping[str, Posterior | GoodnessOfFit | None],
    touched: int = SHARED_BY,
    foam_odds: float = FOAM_ODDS,
    own_odds: float = 0.0,
) -> dict[str, float]:
    """Return the probability of each pressure before the loads' evidence is heard.

    Parameters
    ----------
    others : mapping of str to Posterior, GoodnessOfFit or None
        Those that were looked at, but the even one. A round face and foam are told apart by how
        alike neighbours are once the fall is explained; None where nobody knows.
    touched : int
        Elements that read a load.
    foam_odds : float
        Of foam that shares elements' gains over a round face, before neighbours are looked at.
    own_odds : float
        Of foam under which elements keep their own gains, over a round face.
    """
    found = {"lean": LEAN} if "lean" in others else {}
    if RISE in others:
        found[RISE] = RISING
    if "fall" in others and "foam" in others:
        log_odds = log_of(foam_odds)
        if (fall := others["fall"]) is not None:
            log_odds += 0.5 * fall.neighbours**2
            shared = SHARED * math.sqrt(min(touched / SHARED_BY, 1.0))
            log_odds -= 0.5 * ((fall.neighbours - shared) / SPREAD) ** 2 + math.log(SPREAD)
        odds = math.exp(min(log_odds, LARGEST)) + own_odds
        foam = odds / (1.0 + odds)
        found |= {"fall": ROUND * (1.0 - foam), "foam": ROUND * foam}
    else:
        found |= {part: ROUND for part in ("fall", "foam") if part in others}
    return {EVEN: 1.0 - sum(found.values()), **found}


def mixed(its: Mapping[str, Posterior], before: Mapping[str, float]) -> Posterior:
    """Return the mixture of posteriors, of the numbers that an even face has.

    Parameters
    ----------
    its : mapping of str to Posterior
        By pressure. What they estimate beside an even face's numbers comes last.
    before : mapping of str to float
        Probability of each pressure.
    """
    every = list(its.values())
    logs = np.array([one.log_evidence + log_of(before[part]) for part, one in its.items()])
    log_evidence = float(np.logaddexp.reduce(logs))
    shares = np.exp(logs - log_evidence)
    n = min(len(one.mean) - COUNTS.get(part, 0) for part, one in its.items())
    best = every[int(shares.argmax())]
    points = np.concatenate([_turned_to(best, one, n) for one in every])
    weights = np.concatenate([s * one.weights for s, one in zip(shares, every, strict=True)])
    mean, covariance = np.empty(n), np.empty((n, n))
    weighted_moments.call(points, weights, len(points), mean, covariance)
    return changed(
        best, points=points, weights=weights, mean=mean, covariance=covariance,
        most_likely=best.most_likely[:n], log_evidence=log_evidence,
        equal_points=float(1.0 / (weights @ weights)),
        pressures=dict(zip(its, shares.tolist(), strict=True)),
    )  # fmt: skip


def _turned_to(best: Posterior, one: Posterior, n: int) -> Values:
    """Return a posterior's points, their angles in the period around another's mean."""
    points, turn = one.points[:, :n], period.call(one.kind, one.corners)
    count = sizes.call(one.kind)
    if turn <= 0.0 or (steps := round((best.mean[2 + count] - one.mean[2 + count]) / turn)) == 0:
        return points
    points = points.copy()
    points[:, 2 + count] += steps * turn
    if count == 2 and steps % 2:
        points[:, [2, 3]] = points[:, [3, 2]]
    return points


def log_of(chance: float) -> float:
    """Return a probability's logarithm, no less than that of the least number."""
    return math.log(max(chance, 1e-300))


def log_mean(logs: Sequence[float], count: int) -> float:
    """Return the logarithm of the mean of so many numbers, some of whose logarithms are given."""
    top = max(logs, default=-math.inf)
    if top == -math.inf:
        return top
    return top + math.log(sum(math.exp(log - top) for log in logs) / count)


def shares_by(logs: Mapping[str, float], touched: int, few: float) -> dict[str, float]:
    """Return probabilities whose logarithms, up to a constant, so many elements give.

    Evidence of few elements tells less than it says, since outlines among them are no normal
    distributions: of n it is worth ``1 + (few / n)**2`` times less.
    """
    top, worth = max(logs.values()), 1.0 / (1.0 + (few / max(touched, 1)) ** 2)
    weights = {name: math.exp(worth * (log - top)) for name, log in logs.items()}
    total = sum(weights.values())
    return {name: weight / total for name, weight in weights.items()}
