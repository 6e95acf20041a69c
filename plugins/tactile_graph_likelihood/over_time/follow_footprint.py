"""``follow_footprint``: an outline over time, at rest, moved, and put down again."""

from __future__ import annotations

import contextlib
import math
from dataclasses import replace
from typing import Annotated, Any, Literal, NamedTuple

from annotated_types import Ge, Le, Lt

from tactile_graph.errors import Degenerate
from tactile_graph.steps import Grid, Quantity, Spread, TimeGap
from tactile_graph.wires import Image
from tactile_graph_likelihood.known.known_sizes import KnownSizes, sizes_of
from tactile_graph_likelihood.over_time.at_rest import AtRest
from tactile_graph_likelihood.over_time.noise_behind import NoiseBehind, noise_behind
from tactile_graph_likelihood.settings import DEFAULTS, FootprintSettings, Load, Positive
from tactile_graph_likelihood.single.any_pressure import AnyPressure, asked_by
from tactile_graph_likelihood.single.fit_footprint import KINDS
from tactile_graph_likelihood.single.likely import Likely, likely
from tactile_graph_likelihood.single.posterior import Posterior
from tactile_graph_likelihood.single.readings import Readings

LEAST_SCATTER = 0.02
"""Of the logarithm of a load between frames: no pad repeats better."""

WORTH = 0.01
"""Share of the readings' variance that more frames must take off to be worth a new posterior."""

STILL_MOVES = 0.5
"""Odds that what moved with the last frame moves with this one, too: so much less with each frame
at rest."""

SOON_S = 0.1
"""Time between frames where no clock says."""


class Followed(NamedTuple):
    """An outline, the frames it has lain there, and how often its size was seen before.

    ``moved`` tells whether it was put down, or moved, with this very frame.
    """

    shape: Likely
    frames: int
    placements: int
    moved: bool


class _Fit(NamedTuple):
    """An even face's posterior, and what it came from."""

    model: AnyPressure
    readings: Readings
    known: KnownSizes | None
    even: Posterior


class FollowFootprint:
    """Return the posterior of an outline from all frames that tell something about it.

    Parameters
    ----------
    shape : "disc", "ellipse" or "rectangle"
        What the outline is.
    settings : FootprintSettings
        Its sigma stays while the object lies still.
    frame_sigma : float, optional
        Standard deviation of the logarithm of a load between frames; the pad's repeatability
        over its force exponent, and at least 0.02, if not given.
    fixed : float, optional
        Share of the gains' variance that stays with the pad when an object is put down again.
    rest_s : float
        How long an object lies still, on average.
    same_object : float
        Probability that what is put down next is the same object: its sizes are then known. 0
        begins anew with each move.

    Notes
    -----
    At rest the frames' log loads are averaged: the variance of a reading is sigma**2 +
    frame_sigma**2 / n after n frames. A frame belongs to another placement where the odds of
    `at_rest.AtRest.log_odds_of_move` and of ``rest_s`` say so; what moved with the frame before is
    likelier to move again, by odds that halve with each frame at rest. The sizes' posterior then
    becomes their prior, its precision times (1 - r) / (1 + r), where r is ``fixed`` for an object
    that was moved by nothing and falls to 0 over one pitch. It is taken where the evidence is
    larger with it than without.
    """

    def __init__(
        self,
        *,
        shape: Literal["disc", "ellipse", "rectangle"] = "disc",
        settings: Annotated[
            FootprintSettings,
            Spread("pad", "sigma", "on_pad", "smallest_cm", "largest_cm", "precision", "pressure"),
        ] = DEFAULTS,
        frame_sigma: Positive | None = None,
        fixed: Annotated[float, Ge(0), Le(1)] | None = None,
        rest_s: Positive = 60.0,
        same_object: Annotated[float, Ge(0), Lt(1)] = 0.5,
    ) -> None:
        pad = settings.known_pad
        self._sigma = pad.unevenness.sigma if settings.sigma is None else settings.sigma
        scatter = pad.law.repeatability / pad.law.power
        self._frame_sigma = max(scatter, LEAST_SCATTER) if frame_sigma is None else frame_sigma
        self._fixed = pad.unevenness.fixed if fixed is None else fixed
        self._rest_s, self._same = rest_s, same_object
        self._model = replace(settings, sigma=self._sigma).model(KINDS[shape])
        self._pad = pad
        noise, self._any = self._model.noise, settings.pressure == "any"
        self._least = math.log(noise.least) if noise.least > 0.0 else -700.0
        self._resting: AtRest | None = None
        self._posterior: Posterior | None = None
        self._known: KnownSizes | None = None
        self._used, self._placements = 0, 0

    def __call__(
        self,
        image: Load,
        volts: Annotated[Image | None, Quantity("volt"), Grid.like("image")] = None,
        *,
        gap_s: TimeGap = None,
    ) -> Followed:
        """Return the outline by this frame and those before it.

        Parameters
        ----------
        image : Image
            Loads; invalid cells say nothing.
        volts : Image, optional
            The readings that loads in grams were made of: what is no more than noise by the frame
            itself (`above_noise`) then shows nothing, and loads may change by the noise in them.
            Without it loads repeat as the pad and ``frame_sigma`` say, and what noise the circuit's
            inverse has turned into loads passes for the object's.

        Raises
        ------
        RuleError
            If the volts are of another shape, or of loads that are not in grams.
        Degenerate
            If nothing is touched, nothing rises above the noise, or no such outline explains what
            is; the object is then gone.
        """
        try:
            readings, noise = self._model.readings(image), None
            if volts is not None:
                readings, noise = noise_behind(readings, image, volts, self._pad, self._least)
            if gap_s is None or gap_s < 0.0:  # a clock that was set back
                gap_s = SOON_S
            if self._rests(readings, noise, gap_s):
                return self._again(readings, noise)
            return self._put_down(readings, noise)
        except Degenerate:
            self._resting = None
            raise

    def _rests(self, readings: Readings, noise: NoiseBehind | None, gap_s: float) -> bool:
        resting = self._resting
        if resting is None or not resting.fits_grid(readings):
            return False
        odds = math.expm1(min(gap_s / self._rest_s, 700.0))
        prior = math.log(max(odds, STILL_MOVES**resting.frames, 1e-12))
        return resting.log_odds_of_move(readings, noise) + prior < 0.0

    def _again(self, readings: Readings, noise: NoiseBehind | None) -> Followed:
        resting = self._resting
        assert resting is not None
        assert self._posterior is not None
        resting.add(readings, noise)
        n = resting.frames
        scatter = self._frame_sigma**2
        if (1.0 / self._used - 1.0 / n) * scatter > WORTH * (self._sigma**2 + scatter / n):
            start = self._posterior.most_likely_shape
            fit = self._fit(resting.averaged, self._known, n, start)
            self._posterior = self._completed(fit, self._asked([fit]))
            self._used = n
        return Followed(likely(self._posterior), n, self._placements, moved=False)

    def _put_down(self, readings: Readings, noise: NoiseBehind | None) -> Followed:
        before, self._resting = self._posterior, None
        fits = [self._fit(readings, None, 1)]
        if before is not None and self._same > 0.0:
            with contextlib.suppress(Degenerate):
                fits.append(self._fit(readings, self._carried(before, fits[0]), 1))
        asked = self._asked(fits)
        alone = chosen = self._completed(fits[0], asked)
        known = fits[-1].known
        if known is not None:
            carried = self._completed(fits[1], asked)
            gain = carried.log_evidence - known.log_share(self._model, readings)
            gain += math.log(self._same / (1.0 - self._same)) - alone.log_evidence
            chosen = carried if gain > 0.0 else alone
        same = chosen is not alone
        self._placements = self._placements + 1 if same else 1
        self._known = known if same else None
        self._posterior, self._used = chosen, 1
        self._resting = AtRest(readings, self._frame_sigma, self._least, noise)
        return Followed(likely(chosen), 1, self._placements, moved=True)

    def _carried(self, before: Posterior, now: _Fit) -> KnownSizes:
        """Return what an earlier placement tells of the sizes at this one."""
        found = sizes_of(before.kind, before.mean, before.covariance)
        x, y = before.mean[:2] - now.even.mean[:2]
        r = self._fixed * max(0.0, 1.0 - math.hypot(x, y) / float(now.readings.grid[2]))
        return found._replace(covariance=found.covariance * ((1.0 + r) / (1.0 - r)))

    def _fit(
        self, readings: Readings, known: KnownSizes | None, frames: int, start: Any = None
    ) -> _Fit:
        """Return the posterior of an even face by a mean of frames."""
        sigma = math.hypot(self._sigma, self._frame_sigma / math.sqrt(frames))
        model = replace(self._model, noise=replace(self._model.noise, sigma=sigma))
        belief = None if known is None else known.belief(model)
        even = model.posterior_of(readings, start, belief)
        return _Fit(AnyPressure(model), readings, known, even)

    def _asked(self, fits: list[_Fit]) -> list[str]:
        """Return the pressures that any of the fits asks for."""
        return asked_by([fit.even for fit in fits], fits[0].model.others) if self._any else []

    def _completed(self, fit: _Fit, asked: list[str]) -> Posterior:
        belief = None if fit.known is None else fit.known.belief(fit.model.even)
        return fit.model.completed(fit.readings, fit.even, asked, belief)
