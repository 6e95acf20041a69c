"""``FrameFits``: fits of several outlines, under several pressures, to one frame."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from tactile_graph.errors import Degenerate
from tactile_graph_likelihood.geometry.outlines import (
    DISC,
    ELLIPSE,
    Values,
    as_ellipse_of_disc,
)
from tactile_graph_likelihood.single.any_pressure import (
    EVEN,
    AnyPressure,
    chances,
    log_of,
    mixed,
)
from tactile_graph_likelihood.single.model import MORE, Likeliest, Model
from tactile_graph_likelihood.single.posterior import Posterior
from tactile_graph_likelihood.single.readings import Readings

FAR = 8.0
"""Nats below the largest evidence from which on a fit is not looked around."""

HOPELESS = 25.0
"""Nats below it from which on a shape's search begins no second time, and is not looked at under
other pressures."""

Key = tuple[int, str]
"""Which outline, and its pressure."""


class FrameFits:
    """Fits to one frame: all have a most likely point, the likely ones a posterior.

    Parameters
    ----------
    readings : Readings
    outlines : sequence of AnyPressure
        Looked at with an even face at once.

    Attributes
    ----------
    logs : dict of Key to float
        Log evidence: of the posterior where there is one, as if normal around the top elsewhere.
    found : dict of Key to Posterior
    reason : str
        Why there is no posterior, where there is none.
    """

    def __init__(self, readings: Readings, outlines: Sequence[AnyPressure]) -> None:
        self.readings, self.outlines = readings, outlines
        self.logs: dict[Key, float] = {}
        self.found: dict[Key, Posterior] = {}
        self.reason = "none of the shapes explains what is touched"
        self._fits: dict[Key, tuple[Model, Likeliest]] = {}
        self._add_even()
        self._look_around({EVEN: 1.0})

    def _add_even(self) -> None:
        """Add the most likely point of each outline with an even face."""
        tops = [outline.even.likeliest(self.readings) for outline in self.outlines]
        likeliest = max(top.evidence for top in tops)
        for k, outline in enumerate(self.outlines):
            if tops[k].unsure and tops[k].evidence > likeliest - HOPELESS:
                tops[k] = outline.even.likeliest(self.readings, tops[k], attempts=MORE)
            if outline.even.kind == ELLIPSE and tops[k].mode.height == -math.inf:
                tops[k] = self._near_a_disc(outline.even, tops) or tops[k]
            self._add((k, EVEN), outline.even, tops[k])

    def _near_a_disc(self, ellipse: Model, tops: Sequence[Likeliest]) -> Likeliest | None:
        """Return the most likely ellipse near a disc, where moments of few elements gave none."""
        for outline, top in zip(self.outlines, tops, strict=True):
            if outline.even.kind == DISC and top.mode.height > -math.inf:
                begin = as_ellipse_of_disc(outline.even.point_of(top))
                return ellipse.likeliest_near(self.readings, begin)
        return None

    def look_under(self, asked: Sequence[str]) -> dict[str, float]:
        """Look at the likely ones under other pressures; return each's probability beforehand."""
        likeliest = max(self.logs.values())
        for k, outline in enumerate(self.outlines):
            if self.logs[k, EVEN] < likeliest - HOPELESS:
                continue
            for part in asked:
                begin = outline.begin(part, self.point((k, EVEN)))
                model = outline.others[part]
                self._add((k, part), model, model.likeliest(self.readings, start=begin))
        self._look_around(chances(dict.fromkeys(asked)))
        return chances({part: self.likeliest(part) for part in asked})

    def _add(self, key: Key, model: Model, top: Likeliest) -> None:
        self._fits[key] = model, top
        self.logs[key] = top.evidence

    def point(self, key: Key) -> Values:
        """Return the most likely point, as a model takes it to begin with."""
        if key in self.found:
            return self.found[key].most_likely
        model, top = self._fits[key]
        return model.point_of(top)

    def _look_around(self, before: Mapping[str, float]) -> None:
        """Find the posteriors of the likely fits, given the probabilities of pressures."""
        scores = {key: log + log_of(before[key[1]]) for key, log in self.logs.items()}
        for key in sorted(scores, key=scores.__getitem__, reverse=True):
            model, top = self._fits[key]
            if key in self.found or top.mode.height == -math.inf:
                continue
            if scores[key] < max(scores.values()) - FAR:
                continue
            try:
                self.found[key] = model.posterior_around(self.readings, top.mode)
                self.logs[key] = self.found[key].log_evidence
            except Degenerate as why:
                self.logs[key], self.reason = -math.inf, str(why)
            scores[key] = self.logs[key] + log_of(before[key[1]])

    def likeliest(self, part: str) -> Posterior | None:
        """Return the posterior of the likeliest outline under one pressure, if one has any."""
        its = [found for key, found in self.found.items() if key[1] == part]
        return max(its, key=lambda one: one.log_evidence, default=None)

    def evidence(self, outline: int, before: Mapping[str, float]) -> float:
        """Return an outline's log evidence, over all pressures that were looked at."""
        logs = [log + log_of(before[key[1]]) for key, log in self.logs.items() if key[0] == outline]
        return float(np.logaddexp.reduce(logs))

    def posterior(self, outline: int, before: Mapping[str, float]) -> Posterior:
        """Return an outline's posterior over all pressures, of which one at least has its own."""
        its = {key[1]: found for key, found in self.found.items() if key[0] == outline}
        return next(iter(its.values())) if [*its] == [EVEN] else mixed(its, before)
