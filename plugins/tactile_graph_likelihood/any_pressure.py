"""``AnyPressure``: an outline that presses evenly, leaning, less to its rim, or through foam."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image
from tactile_graph_likelihood.model import Model, Start
from tactile_graph_likelihood.noise import FALL_GUESSED, GUESSED_FOAM
from tactile_graph_likelihood.outlines import sizes
from tactile_graph_likelihood.posterior import Posterior
from tactile_graph_likelihood.readings import Readings, readings_of
from tactile_graph_likelihood.sampling import spread_of

LEAN, ROUND = 0.15, 0.15
"""Probability, before a frame is read, that a face leans; that its load falls to the rim, be it
that the face is round or that foam spreads the load."""

FOAM_ODDS = 0.15
"""Of foam over a round face, before a frame is read: foam is a pad's own and mostly known."""

SHARED, SPREAD = 5.0, 2.0
"""Mean and deviation, where there is foam, of how alike neighbours' residuals are: it shares their
gains, which no outline explains. Without foam they are 0 and 1."""

LOOK = 1.5
"""Lean and fall of the residuals, in standard deviations, from which on a fit is worth its time."""

ALIKE = 2.5
"""How alike neighbours are, from which on foam is worth a look."""

HOPELESS = 2.0
"""Nats by which the evidence of a rough fit may fall behind an even face's and still be looked at:
with its chance beforehand against it, it would have a share of 3 % at most."""

WIDER = 0.15
"""By how much a falling pressure's outline is larger than an even one's that looks like it."""


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
        readings = readings_of(image, self.even.gap_cm, self.even.noise.least)
        even = self.even.posterior_of(readings, start)
        others = dict(self._others_of(readings, even))
        return mixed(even, others, chances(even, others)) if others else even

    def _others_of(self, readings: Readings, even: Posterior) -> Iterator[tuple[str, Posterior]]:
        """Return what explains the residuals, where these lean, or fall towards the rim."""
        for part, model in self.others.items():
            seen = (even.lean if part == "lean" else even.fall) >= LOOK
            if not seen and not (part == "foam" and even.neighbours >= ALIKE):
                continue
            begin = np.append(even.most_likely, FIRST[part])
            if part == "fall":
                begin[2 : 2 + sizes.call(self.even.kind)] *= 1.0 + WIDER
            top = model.top_of(readings, start=begin)
            if top.evidence < even.log_evidence - HOPELESS:
                continue
            try:
                yield part, model.around(readings, top)
            except Degenerate:
                continue


FIRST = {"lean": [0.0, 0.0], "fall": [FALL_GUESSED], "foam": [math.log(GUESSED_FOAM)]}
"""What a fit begins with, beside an even face's numbers."""


def chances(even: Posterior, others: dict[str, Posterior]) -> dict[str, float]:
    """Return the probability of each but the even face, before the loads' evidence is heard.

    A round face and foam are told apart by how alike neighbours are once the fall is explained.
    """
    found = {"lean": LEAN} if "lean" in others else {}
    if "fall" in others and "foam" in others:
        alike = others["fall"].neighbours
        log_odds = math.log(FOAM_ODDS) + 0.5 * alike**2
        log_odds -= 0.5 * ((alike - SHARED) / SPREAD) ** 2 + math.log(SPREAD)
        foam = 1.0 / (1.0 + math.exp(-min(max(log_odds, -700.0), 700.0)))
        return {**found, "fall": ROUND * (1.0 - foam), "foam": ROUND * foam}
    return found | {part: ROUND for part in ("fall", "foam") if part in others}


def mixed(even: Posterior, others: dict[str, Posterior], before: dict[str, float]) -> Posterior:
    """Return the mixture of posteriors, of the numbers that all have.

    Parameters
    ----------
    even : Posterior
    others : dict of str to Posterior
        What they estimate beside an even face's numbers comes last.
    before : dict of str to float
        Probability of each of the others.
    """
    every = [even, *others.values()]
    shares = np.array([1.0 - sum(before.values()), *(before[part] for part in others)])
    logs = np.array([its.log_evidence for its in every]) + np.log(np.maximum(shares, 1e-300))
    log_evidence = float(np.logaddexp.reduce(logs))
    shares = np.exp(logs - log_evidence)
    n = len(even.mean)
    points = np.concatenate([its.points[:, :n] for its in every])
    weights = np.concatenate([s * its.weights for s, its in zip(shares, every, strict=True)])
    mean, covariance = np.empty(n), np.empty((n, n))
    spread_of.call(points, weights, len(points), mean, covariance)
    best = every[int(shares.argmax())]
    return replace(
        best, points=points, weights=weights, mean=mean, covariance=covariance,
        most_likely=best.most_likely[:n], log_evidence=log_evidence,
        equal_points=float(1.0 / (weights @ weights)),
        pressures=dict(zip(("even", *others), shares.tolist(), strict=True)),
    )  # fmt: skip
