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

CHANCES = {"lean": 0.15, "fall": 0.13, "foam": 0.02}
"""Of each, before a frame is read. Foam is a pad's own and mostly known; what it shares between
neighbours the model takes for their own, so its evidence comes out too large."""

LOOK = 1.5
"""Lean and fall of the residuals, in standard deviations, from which on a fit is worth its time."""

HOPELESS = 2.0
"""Nats by which the evidence of a rough fit may fall behind an even face's and still be looked at:
with `CHANCES` against it, it would have a share of 2 % at most."""

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
            for part in CHANCES
            if part not in known
        }

    def posterior(self, image: Image, start: Start = None) -> Posterior:
        """Return the posterior of the outline; parameters and errors as of `Model.posterior`."""
        readings = readings_of(image, self.even.gap_cm, self.even.noise.least)
        even = self.even.posterior_of(readings, start)
        others = dict(self._others_of(readings, even))
        return mixed(even, others) if others else even

    def _others_of(self, readings: Readings, even: Posterior) -> Iterator[tuple[str, Posterior]]:
        """Return what explains the residuals, where these lean, or fall towards the rim."""
        for part, model in self.others.items():
            if (even.lean if part == "lean" else even.fall) < LOOK:
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


def mixed(even: Posterior, others: dict[str, Posterior]) -> Posterior:
    """Return the mixture of posteriors, of the numbers that all have.

    Parameters
    ----------
    even : Posterior
    others : dict of str to Posterior
        By their name in `CHANCES`; what they estimate beside an even face's numbers comes last.
    """
    every = [even, *others.values()]
    chances = np.array([0.0, *(CHANCES[part] for part in others)])
    chances[0] = 1.0 - chances.sum()
    logs = np.array([its.log_evidence for its in every]) + np.log(chances)
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
