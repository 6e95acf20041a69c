"""``Model``: one kind of outline on a pad, and the posterior of it that an image gives."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import Kernel
from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image, Shape
from tactile_graph_likelihood.geometry.outline_prior import LARGEST, SMALLEST
from tactile_graph_likelihood.geometry.outlines import (
    ELLIPSE,
    FREE,
    OVAL,
    Values,
    packed,
    unknowns,
)
from tactile_graph_likelihood.geometry.oval import as_ellipse, to_ellipses, to_oval
from tactile_graph_likelihood.large_pads.search import attempted_on_large_pad
from tactile_graph_likelihood.large_pads.solid import least_shown
from tactile_graph_likelihood.single.climbs.maximise import Mode
from tactile_graph_likelihood.single.climbs.search import (
    ATTEMPTS,
    NEAR,
    POOR,
    SAME,
    UNLIKELY,
    attempted,
    moments,
)
from tactile_graph_likelihood.single.density.element_terms import LEAST, OFF, ON, States
from tactile_graph_likelihood.single.density.goodness_of_fit import (
    NO_FIT,
    GoodnessOfFit,
)
from tactile_graph_likelihood.single.density.problem import LARGE_PAD, Problem
from tactile_graph_likelihood.single.noise import Noise, NoiseTaken
from tactile_graph_likelihood.single.posterior import Posterior
from tactile_graph_likelihood.single.readings import Readings, is_row, readings_of, size_of
from tactile_graph_likelihood.single.sampling.even_points import even_points
from tactile_graph_likelihood.single.sampling.importance import normal_points, weighted_moments
from tactile_graph_likelihood.single.sampling.sample import Sample, sample_around

Attempted = Kernel[..., tuple[float, float, GoodnessOfFit]]

BLOCK = 32
"""Points between two looks at how sure the answer is."""

WIDE_POINTS = 2 * BLOCK
"""Where sampling ends of a wide outline, whose posterior is nearly normal where it fits at all."""

SMALLEST_PITCHES = 0.4

Start = Shape | Values | None

Belief = tuple[Values, Values] | None
"""Mean and precision matrix of a normal belief about the outline's numbers."""

NO_START = np.zeros(0)

FIRST, SECOND, MORE, EVERY = range(1), range(1, 2), range(1, ATTEMPTS), range(ATTEMPTS)
"""Attempts at a most likely outline."""


class Likeliest(NamedTuple):
    """A most likely outline whose posterior is not yet sampled.

    ``evidence`` is the log evidence if the posterior were normal around it; ``unsure`` says whether
    another attempt may do better, ``fit`` how well the image fits it.
    """

    mode: Mode
    evidence: float
    unsure: bool
    fit: GoodnessOfFit


@dataclass(frozen=True)
class Model:
    """One kind of outline on a pad whose noise is known or guessed.

    Parameters
    ----------
    kind, corners : int
        Kind of outline, as in `outlines`; corners only of polygons.
    noise : Noise
    gap_cm : float
        Distance of neighbouring elements' edges.
    whole : float
        Probability beforehand that the outline lies fully on the pad; its centre always does.
    smallest_cm, largest_cm : float
        Range of radii, half axes and half sides, over which they are log-uniform; 0 and infinity
        for so many pitches and the pad's diagonal.
    smallest_pitches : float
        The least of them where no other is told, but on a single row, which tells of none.
    precision : float
        The posterior mean's error, over the posterior's standard deviation, at which sampling
        ends.
    most_points : int
        Where it ends at the latest.
    seed : int
        Shifts the points at which the posterior is looked at.
    """

    kind: int
    corners: int = 0
    noise: Noise = field(default_factory=Noise)
    gap_cm: float = 0.3
    whole: float = 0.0
    smallest_cm: float = 0.5
    largest_cm: float = 15.0
    smallest_pitches: float = SMALLEST_PITCHES
    precision: float = 0.15
    most_points: int = 1024
    seed: int = 0

    def posterior(self, image: Image, start: Start = None, belief: Belief = None) -> Posterior:
        """Return the posterior of the outline.

        Parameters
        ----------
        image : Image
            Loads.
        start : Shape or ndarray, optional
            Where to begin: an outline of this kind, or a whole point.
        belief : (ndarray, ndarray), optional
            Mean and precision matrix of a normal belief about the outline's numbers.

        Raises
        ------
        ValueError
            As `readings.readings_of`; if ``start`` is of another kind.
        Degenerate
            If nothing is touched, or no outline of this kind is possible.
        """
        return self.posterior_of(self.readings(image), start, belief)

    def readings(self, image: Image) -> Readings:
        """Return an image's readings; errors as of `readings.readings_of`."""
        return readings_of(image, self.gap_cm, self.noise.least)

    def posterior_of(
        self, readings: Readings, start: Start = None, belief: Belief = None
    ) -> Posterior:
        """Return the same from readings.

        A sample whose points are worth fewer than there are unknowns promises far too much: its
        covariance is then wider by that of a normal distribution around the top.
        """
        problem = self.problem(readings, belief)
        top = self._find(problem, self._begin(start, problem), EVERY, _way_of(readings))
        if top.mode.height == -math.inf:
            raise self.impossible(readings)
        found = self._sampled(readings, problem, top.mode)
        if found.equal_points > len(top.mode.p):
            return found
        normal = self.normal_around(top, row=is_row(readings))
        return replace(found, covariance=found.covariance + normal.covariance)

    def likeliest(
        self,
        readings: Readings,
        before: Likeliest | None = None,
        start: Start = None,
        attempts: Sequence[int] = FIRST,
    ) -> Likeliest:
        """Return the most likely outline of some attempts, and of what was found before.

        ``attempts`` are `FIRST`, `MORE` after it, or `EVERY` one.
        """
        problem = self.problem(readings)
        return self._find(problem, self._begin(start, problem), attempts, _way_of(readings), before)

    def likeliest_near(self, readings: Readings, point: Values | None = None) -> Likeliest:
        """Return the most likely outline near a point, shape (K,), that is nearly as likely.

        Without a point, near what has the moments of the touched elements.
        """
        problem = self.problem(readings)
        attempt = 0 if _way_of(readings) is attempted_on_large_pad else NEAR
        return self._find(problem, self._begin(point, problem), [attempt], _way_of(readings))

    def _find(
        self,
        problem: Problem,
        begin: Values,
        attempts: Sequence[int],
        way: Attempted,
        before: Likeliest | None = None,
    ) -> Likeliest:
        """Return the most likely outline of some attempts, and of what was found before."""
        table = self._table(problem)
        n = table.shape[1]
        best, evidence, fit = _nowhere(n), -math.inf, NO_FIT
        if before is not None:
            best, evidence, _, fit = before
        unsure = attempts[-1] + 1 < ATTEMPTS
        for which in attempts:
            p, root, known = np.zeros(n), np.zeros((n, n)), best.height
            height, log, its = way.call(problem, table, begin, which, known, p, root)
            if height > known:
                best, evidence, fit = Mode(p, root, height), log, its
            again = which > 0 and abs(height - known) < SAME
            if best.height > -math.inf and fit.surprise > (UNLIKELY if again else POOR):
                unsure = False
                break
        return Likeliest(best, evidence, unsure, fit)

    def posterior_around(self, readings: Readings, mode: Mode, loose: float = 0.0) -> Posterior:
        """Return the posterior around a mode, with ``loose`` as in `sample_around`."""
        return self._sampled(readings, self.problem(readings), mode, loose)

    def posterior_near(self, readings: Readings, point: Values, loose: float) -> Posterior:
        """Return the posterior around the top near a point, shape (K,)."""
        problem = self.problem(readings)
        begin = self._begin(point, problem)
        mode = Mode(begin, np.zeros((len(begin), len(begin))), -math.inf)
        return self._sampled(readings, problem, mode, loose)

    def point_of(self, top: Likeliest) -> Values:
        """Return a most likely point in the outline's own numbers, shape (K,)."""
        return as_ellipse.call(top.mode.p) if self.kind == ELLIPSE else top.mode.p

    def normal_around(
        self,
        top: Likeliest,
        count: int | None = None,
        pull: Values | None = None,
        row: bool = False,
    ) -> Posterior:
        """Return the posterior of a top's first numbers as if it were normal, the others known.

        Parameters
        ----------
        top : Likeliest
        count : int, optional
            How many: the outline's, its load, and what of the noise comes first; all if not given.
        pull : ndarray, shape (count,), optional
            As in `normal_points`.
        row : bool
            Whether the readings are of one row of cells, as `is_row` tells.
        """
        n = len(top.mode.p) if count is None else count
        steps, pull = self.table_of(n)[:BLOCK], np.zeros(n) if pull is None else pull
        p, points, covariance = normal_points.call(top.mode.p, top.mode.root, steps, pull)
        weights = np.full(BLOCK, 1.0 / BLOCK)
        likeliest, mean = p, p
        if self.kind == ELLIPSE:
            likeliest, mean, covariance = _as_ellipses(p, points, weights)
            if row or min(mean[2], mean[3]) <= 0.0:
                mean, covariance = _around(likeliest, mean, covariance)
        return Posterior(
            self.kind, self.corners, mean, covariance, points, weights, likeliest, top.evidence,
            float(BLOCK), *top.fit,
        )  # fmt: skip

    def _sampled(
        self, readings: Readings, problem: Problem, mode: Mode, loose: float = 0.0
    ) -> Posterior:
        worth, table = self.precision**-2, self._table(problem)
        if readings.is_wide:
            table = table[:WIDE_POINTS]
        sample = sample_around.call(problem, table, BLOCK, worth, loose, *mode)
        if len(sample.points):
            return self._posterior_of(problem.kind, sample)
        raise self.impossible(readings)

    @staticmethod
    def impossible(readings: Readings) -> Degenerate:
        """Return the error that no outline is possible."""
        return Degenerate(
            f"{readings.touched} touched elements: no such outline on the pad explains them"
        )

    def problem(self, readings: Readings, belief: Belief = None) -> Problem:
        """Return what is asked of some readings, as the kernels take it."""
        noise, places, guess = self._noise_at(float(readings.grid[2]))
        if readings.least_log is not None:
            noise = noise.copy()
            noise[LEAST] = readings.least_log
        kind = OVAL if self.kind == ELLIPSE and belief is None else self.kind
        mean, precision = belief or _no_belief(_unknowns(self.kind, self.corners))
        states = readings.states
        loud = states.size > LARGE_PAD and readings.part_of is None
        if loud and (readings.is_wide or readings.least_log is None):
            noise, states = _quiet(readings, noise)
        return Problem(
            kind, self.corners, readings.grid, readings.logs, states, noise, places, guess,
            self._prior(readings), mean, precision,
        )  # fmt: skip

    def _posterior_of(self, kind: int, sample: Sample) -> Posterior:
        top, mean, covariance = sample.likeliest, sample.mean, sample.covariance
        if kind == OVAL:
            top, mean, covariance = _as_ellipses(top, sample.points, sample.weights)
        return Posterior(
            self.kind, self.corners, mean, covariance, sample.points, sample.weights, top,
            sample.log_evidence, sample.equal_points, *sample.fit,
        )  # fmt: skip

    def range_cm(self, readings: Readings) -> tuple[float, float]:
        """Return the smallest and the largest radius, half axis or half side."""
        smallest, largest = self._prior(readings)[SMALLEST : LARGEST + 1].tolist()
        return smallest, largest

    def prior_vector(self, readings: Readings) -> Values:
        """Return the prior as the kernels take it, see `outline_prior`."""
        return self._prior(readings).copy()

    def _prior(self, readings: Readings) -> Values:
        """Return the same, which is everybody's."""
        place = readings.grid.tobytes(), readings.states.shape
        pitch = float(readings.grid[2])
        pitches = SMALLEST_PITCHES if is_row(readings) else self.smallest_pitches
        smallest_cm = self.smallest_cm or pitches * pitch
        usual_cm = self.smallest_cm or SMALLEST_PITCHES * pitch
        return _prior_of(place, smallest_cm, self.largest_cm, self.whole, usual_cm)

    def _noise_at(self, pitch_cm: float) -> NoiseTaken:
        kept = self._kept.get(pitch_cm)
        if kept is None:
            kept = self._kept[pitch_cm] = self.noise.as_taken(pitch_cm)
        return kept

    @cached_property
    def _kept(self) -> dict[float, NoiseTaken]:
        return {}

    def _table(self, problem: Problem) -> Values:
        return self.table_of(_unknowns(self.kind, self.corners) + 1 + len(problem.estimated))

    def table_of(self, n: int) -> Values:
        """Return evenly spread points of Student's t, shape (N, n), in whole blocks."""
        return _table(max(1, math.ceil(self.most_points / BLOCK)) * BLOCK, n, self.seed)

    def _begin(self, start: Start, problem: Problem) -> Values:
        if start is None:
            return NO_START
        if not isinstance(start, Shape):
            begin = start.copy()
            if problem.kind == OVAL:
                to_oval.call(begin)
            return begin
        kind, corners, p = packed(start)
        if kind != self.kind or (kind == FREE and corners != self.corners):
            raise ValueError(f"start: a {type(start).__name__} is not of the shape to be fitted")
        load = moments.call(problem.grid, problem.logs, problem.states)[6]
        begin = np.concatenate([p, [load], problem.guess[:, 0]])
        if problem.kind == OVAL:
            to_oval.call(begin)
        return begin


def _way_of(readings: Readings) -> Attempted:
    """Return how an outline is searched for."""
    return attempted_on_large_pad if readings.is_wide and readings.part_of is None else attempted


def _quiet(readings: Readings, noise: Values) -> tuple[Values, States]:
    """Return noise and states of a large pad on which the converter's noise shows as loads."""
    least = least_shown.call(readings.logs, readings.states, noise)
    if least <= noise[LEAST]:
        return noise, readings.states
    raised = noise.copy()
    raised[LEAST] = least
    light = (readings.states == ON) & (readings.logs < least)
    return raised, np.where(light, np.uint8(OFF), readings.states)


def _as_ellipses(top: Values, points: Values, weights: Values) -> tuple[Values, Values, Values]:
    """Turn weighted ovals into ellipses in place; return the top as one, mean and covariance."""
    to_ellipses.call(points, weights)
    mean, covariance = np.empty(points.shape[1]), np.empty((points.shape[1],) * 2)
    weighted_moments.call(points, weights, len(points), mean, covariance)
    top = as_ellipse.call(top)
    quarters = round((top[4] - mean[4]) / (0.5 * math.pi))
    top[4] -= quarters * 0.5 * math.pi
    if quarters % 2:
        top[[2, 3]] = top[[3, 2]]
    return top, mean, covariance


def _around(top: Values, mean: Values, covariance: Values) -> tuple[Values, Values]:
    """Return a top in place of the mean, and the mean squares about it in place of the variance.

    Where nothing holds an ellipse's shorter half axis, a normal distribution of ovals reaches far
    over those whose half axes differ by more than there is of them: the mean of these is no
    ellipse. The normal's own mean, which is the top, is one, as it is of rectangles.
    """
    off = mean - top
    return top.copy(), covariance + np.outer(off, off)


@lru_cache(256)
def _prior_of(
    place: tuple[bytes, tuple[int, ...]],
    smallest_cm: float,
    largest_cm: float,
    whole: float,
    usual_cm: float,
) -> Values:
    """Return a prior vector on elements of a grid, as bytes, of so many rows and columns.

    Outlines of two sizes that are smaller than usual leave the others as likely as they were.
    """
    grid = np.frombuffer(place[0])
    (left, top), (width, height) = grid[:2].tolist(), size_of(grid, place[1])
    if not math.isfinite(largest_cm):
        largest_cm = max(math.hypot(width, height), 2.0 * usual_cm)
    extra = 0.0
    if smallest_cm < usual_cm < largest_cm:
        wider = math.log(largest_cm / smallest_cm) / math.log(largest_cm / usual_cm)
        extra = 2.0 * math.log(wider)
    return np.array([left, top, width, height, smallest_cm, largest_cm, whole, math.nan, extra])


@cache
def _nowhere(n: int) -> Mode:
    """Return the mode of a posterior of which no outline is possible."""
    return Mode(np.zeros(n), np.zeros((n, n)), -math.inf)


@cache
def _no_belief(n: int) -> tuple[Values, Values]:
    return np.zeros(n), np.zeros((n, n))


@cache
def _unknowns(kind: int, corners: int) -> int:
    return int(unknowns.call(kind, corners))


@cache
def _table(count: int, n: int, seed: int) -> Values:
    table = even_points(count, n, seed)
    table.setflags(write=False)
    return table
