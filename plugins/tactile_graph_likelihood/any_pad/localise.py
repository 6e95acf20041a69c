"""``AnyPad``: the posterior of an outline on a pad that need not be the one that is told."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from tactile_graph.errors import Degenerate
from tactile_graph_likelihood.geometry.outlines import Values, bounds, unknowns
from tactile_graph_likelihood.single.any_pressure import (
    EVEN, FIRST, WIDER, asked_by, chances, log_of, mixed,
)
from tactile_graph_likelihood.geometry.outlines import sizes
from tactile_graph_likelihood.single.element_terms import ON, UNKNOWN
from tactile_graph_likelihood.single.maximise import Mode
from tactile_graph_likelihood.single.model import Likeliest, Model, Start
from tactile_graph_likelihood.single.noise import Noise
from tactile_graph_likelihood.single.posterior import Posterior
from tactile_graph_likelihood.single.readings import Readings

LAW = 0.35
"""Of ln sigma that is not as told, the share that is the law's, not the gains'."""
FITTED = 3.0
STRAYS_SEEN = 50.0
HOPELESS = 2.0
NEGLIGIBLE = 0.03


@dataclass(frozen=True)
class AnyPad:
    model: Model

    @cached_property
    def unlearned(self) -> dict[str, Model]:
        """By pressure, the models that estimate the pad's noise with the outline."""
        noise = self.model.noise
        parts = {EVEN: (), **{part: (part,) for part in FIRST}}
        return {
            name: replace(self.model, noise=replace(noise, estimated=(*part, "sigma", "voids")))
            for name, part in parts.items()
        }

    @property
    def n(self) -> int:
        return unknowns.call(self.model.kind, self.model.corners) + 1

    def posterior(self, readings: Readings, start: Start = None) -> Posterior:
        top = self.unlearned[EVEN].likeliest(readings, start=start)
        if top.unsure:
            top = self.unlearned[EVEN].likeliest(readings, before=top)
        strays = strays_of(self.model, readings, top.mode.p)
        noise = learned(self.model.noise, top.mode.p, readings.touched, strays)
        noise = replace(noise, estimated=("contrast",))
        model = replace(self.model, noise=noise)
        begin = np.append(top.mode.p[: self.n], noise.contrast)
        fine = model.likeliest(readings, start=begin)
        even = model.posterior_around(readings, fine.mode)
        found = self.completed(readings, top, even, strays)
        return widened(found, readings)

    def completed(self, readings: Readings, top: Likeliest, even: Posterior, strays: float) -> Posterior:
        asked = asked_by([even], FIRST)
        if not asked:
            return even
        tops = {part: self._other(part, readings, top) for part in asked}
        logs = {EVEN: top.evidence, **{p: t.evidence for p, t in tops.items()}}
        best = max(logs.values())
        found = {EVEN: even}
        for part, its in tops.items():
            if its.evidence < max(best - 3.5, top.evidence - HOPELESS) or its.mode.height == -math.inf:
                continue
            got = self._sampled(part, readings, its, strays)
            if got is not None:
                found[part] = got
        before = chances({part: found.get(part) for part in asked})
        kappa = max(min(kappa_of(p, readings) for p in found.values()),1.)
        found = {part: replace(one, log_evidence=logs[part]/kappa) for part, one in found.items()}
        return mixed(found, before)

    def _other(self, part: str, readings: Readings, top: Likeliest) -> Likeliest:
        model, n = self.unlearned[part], self.n
        begin = np.concatenate([top.mode.p[:n], FIRST[part], top.mode.p[n:]])
        if part == "fall":
            begin[2 : 2 + sizes.call(self.model.kind)] *= 1.0 + WIDER
        return model.likeliest(readings, start=begin)

    def _sampled(self, part: str, readings: Readings, top: Likeliest, strays: float) -> Posterior | None:
        k = self.n + len(FIRST[part])
        noise = learned(self.model.noise, top.mode.p, readings.touched, strays)
        model = replace(self.model, noise=replace(noise, contrast=1.0, estimated=(part,)))
        mode = Mode(top.mode.p[:k].copy(), top.mode.root[:k, :k].copy(), top.mode.height)
        try:
            return model.posterior_around(readings, mode)
        except Degenerate:
            return None


def learned(noise: Noise, p: Values, touched: int, strays: float) -> Noise:
    sigma = math.exp(p[-2]) * math.sqrt(1.0 + FITTED / max(touched, 6))
    voids = 1.0 / (1.0 + math.exp(-p[-1]))
    contrast = 1.0 + LAW * math.log(sigma / noise.sigma)
    return replace(noise, sigma=sigma, voids=voids, strays=strays, contrast=contrast)


def strays_of(model: Model, readings: Readings, p: Values) -> float:
    """Return the share of strays, by what reads beyond an outline's bounding box."""
    left, top, right, bottom = bounds.call(model.kind, model.corners, p)
    x0, y0, pitch, side = readings.grid[:4]
    rows, columns = readings.states.shape
    c0, c1 = math.ceil((left - side - x0) / pitch), math.floor((right - x0) / pitch) + 1
    r0, r1 = math.ceil((top - side - y0) / pitch), math.floor((bottom - y0) / pitch) + 1
    inside = readings.states[max(r0, 0) : max(r1, 0), max(c0, 0) : max(c1, 0)]
    known = readings.states.size - inside.size
    beyond = readings.touched - int(np.count_nonzero(inside == ON))
    told = model.noise.strays
    return min((beyond + STRAYS_SEEN * told) / (known + STRAYS_SEEN), 0.3)


def kappa_of(one: Posterior, readings: Readings) -> float:
    rho = (one.neighbours - 1.0) / math.sqrt(1.6 * max(readings.touched, 1))
    if rho <= 0.03: return 1.0
    return max(1.0, math.sqrt(math.pi / -math.log(min(rho, 0.95))))


def widened(found: Posterior, readings: Readings) -> Posterior:
    kappa = kappa_of(found, readings)
    if kappa <= 1.0: return found
    return replace(found, covariance=kappa * found.covariance,
        points=found.mean + math.sqrt(kappa) * (found.points - found.mean))
