"""``locate_objects``: several objects on any pad."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Annotated

import numpy as np
from annotated_types import Ge, Le, MinLen
from pydantic import AllowInfNan

from tactile_graph.steps import Spread
from tactile_graph_likelihood.any_pad.observation.observed import (
    NearlySquare,
    gap_by,
    observed,
    uniform,
)
from tactile_graph_likelihood.any_pad.pad_effects.from_frame import (
    FEWEST,
    MOST_STRAYS,
    NORMAL,
    PAIRS,
    TOLD_STRAYS,
    learned,
    variance_inflation,
)
from tactile_graph_likelihood.any_pad.pad_effects.through_foam import without_foam
from tactile_graph_likelihood.any_pad.uncertainty.ghosts import as_ghostly, tells_of_ghosts
from tactile_graph_likelihood.any_pad.uncertainty.posterior import on_any_pad
from tactile_graph_likelihood.any_pad.uncertainty.widened import (
    as_filtered,
    stretched,
    unsized,
    within,
)
from tactile_graph_likelihood.geometry.outline_prior import LARGEST, SMALLEST
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.geometry.pieces import components
from tactile_graph_likelihood.several.enclosed import enclose
from tactile_graph_likelihood.several.filled_hull import fill_their_hull
from tactile_graph_likelihood.several.fit_footprints import Footprints, Kind, SeveralSettings
from tactile_graph_likelihood.several.gap_of_all import sized
from tactile_graph_likelihood.several.joint.joint_posterior import JointProblem
from tactile_graph_likelihood.several.joint.scene import laid
from tactile_graph_likelihood.several.least_size import freed
from tactile_graph_likelihood.several.pad import LEAST_ADJACENT, OnPad, likeliest
from tactile_graph_likelihood.several.posteriors import goodness_of_load, posteriors
from tactile_graph_likelihood.single.density.element_terms import ON, UNKNOWN
from tactile_graph_likelihood.single.likely import likely
from tactile_graph_likelihood.single.noise import LEAST_SIGMA, LEAST_VOIDS, MOST_VOIDS, Noise
from tactile_graph_likelihood.single.readings import Readings, is_row

COVERED = 0.95
"""Share of an element from which on it counts as covered whole."""

TOLD = 8.0
"""Covered elements that what is told of gains and voids is worth."""

NUMBERS, MANY = 4, 10**6
"""Numbers fitted to an outline, about; readings so many that they make no sigma larger."""

ANEW = np.array([0.4, 1.0, 0.3])
"""Change of ln sigma, of the voids' log odds and of ln shared from which on the search is made
anew."""

LIKELY, VAGUE, STRANGE = 0.5, 0.72, -6.0
"""Where an answer is flagged, as is one that encloses a bare middle: the number's probability is no
larger, the mean deviation of all centres is larger, in pitches, or the surprise is no larger."""

FEW_ELEMENTS = 2.3
"""Factor of an outline's variance: its gains and voids are those of few elements, not the noise's
own."""

BELOW = 1.0
"""By how much the logarithm of the least load that shows lies below that of the median touched
element, at least: where edges lie in gaps all readings are alike, and seem to begin just below
them; no outline presses less than twice the least."""

ABSORBED = 2.0
"""Over an outline's number of elements: by how much its fit lowers neighbours' correlation."""

SEVERAL = SeveralSettings(on_pad="mostly")


class LocateObjects:
    """Return the outlines of all objects on a pad that need not be as it is told.

    Parameters
    ----------
    kinds : list of str
        What an object may be; each is as likely as any other. Polygons are regular.
    most : int
        Objects at most.
    more : float
        Log odds of a number of objects over one less, before anything is read.
    settings : SeveralSettings

    Notes
    -----
    What counts as touched follows from the noise in the frame itself. Foam is undone where it is
    seen. Gains and voids are those of what the outlines cover whole, all objects together, beside
    what the pad says; where they differ much the search goes on from there. Readings at the end of
    their range count as loads. ``fits`` is False where it is for any of the shapes; too, where
    three elements side by side are touched and no object is found there, or where rows and columns
    of several seem to make ghosts, as on a matrix without isolation; and more objects than ``most``
    that lie apart lower ``count_probability``. The order of the shapes means nothing: `track` keeps
    who is who.
    """

    stateless = True
    notice = staticmethod(tells_of_ghosts)

    def __init__(
        self,
        *,
        kinds: Annotated[list[Kind], MinLen(1)] = ["disc", "ellipse", "rectangle"],  # noqa: B006 - settings are never changed
        most: Annotated[int, Ge(1), Le(12)] = 6,
        more: Annotated[float, AllowInfNan(False)] = 1.0,
        settings: Annotated[
            SeveralSettings, Spread("pad", "gap_cm", "on_pad", "smallest_cm", "largest_cm")
        ] = SEVERAL,
    ) -> None:
        self._pad, self._gap_cm, self._told = settings.known_pad, settings.gap_cm, settings.noise
        self.expected = settings.expected(kinds, most, more)

    def __call__(self, image: NearlySquare) -> Footprints:
        """Return the outlines.

        Parameters
        ----------
        image : Image
            Readings that rise with load, in any quantity; invalid cells say nothing.

        Raises
        ------
        RuleError
            If the image's cells are not nearly square.
        Degenerate
            If nothing rises above the noise, or no such outlines explain what does.
        """
        readings = observed(image, self._pad, self._gap_cm)
        if not readings.is_wide:
            readings = without_foam(readings, self._told.foam_cm) or readings
        problem, found = self.searched(readings)
        if self.expected.sizes_cm[0] is None and not is_row(readings):
            problem, found = freed(problem, found)
        unsure_cm = 0.0
        if self._gap_cm is None:
            guess = gap_by(self._pad, image.pitch_cm)
            problem, found, unsure_cm = sized(problem, readings, found, guess)
        pitch = float(readings.grid[2])
        parts, fit = posteriors(problem, found)
        alike = unbiased(fit.neighbours, readings.touched, len(parts))
        wide = FEW_ELEMENTS * variance_inflation(alike, readings.touched)
        uneven = math.sqrt(FEW_ELEMENTS) * self._told.sigma * pitch**1.5
        placed = [on_any_pad(part, part.log_evidence, wide, uneven) for part in parts]
        if is_row(readings):
            smallest_cm, largest_cm = problem.prior[SMALLEST : LARGEST + 1].tolist()
            placed = [within(its, smallest_cm, largest_cm) for its in placed]
        vague = float(np.mean([its.centre_std_cm for its in placed])) >= VAGUE * pitch
        if readings.filtered:
            placed = [as_filtered(its, pitch) for its in placed]
        if readings.ghosts:
            placed = [as_ghostly(its) for its in placed]
        shapes = [stretched(unsized(its, unsure_cm), readings) for its in placed]
        return Footprints(
            tuple(likely(shape) for shape in shapes),
            len(shapes),
            found.count_probability,
            max(found.counts.values()),
            fit.surprise,
            fit.surprise > STRANGE
            and found.count_probability > LIKELY
            and not overlooked(problem, found)
            and not vague
            and all(shape.fits for shape in shapes)
            and not enclose(found)
            and not fill_their_hull(found),
        )

    def searched(self, readings: Readings) -> tuple[JointProblem, OnPad]:
        """Return the likeliest outlines, under the noise that they leave.

        Raises
        ------
        Degenerate
            If nothing rises above the noise, or no such outlines explain what does.
        """
        pitch = float(readings.grid[2])
        told, least_log = self._told, uniform(readings).least_log
        if readings.through_foam is not None:
            told = replace(told, foam_cm=0.0)
        if least_log is not None:
            most = float(np.median(readings.logs[readings.shows])) - BELOW
            told = replace(told, least=math.exp(min(least_log, most)))
        problem = self.expected.problem(readings, told.vector(pitch))
        found = likeliest(problem, self.expected)
        noise, shared = said_by(problem, found, told)
        problem = problem._replace(noise=noise.vector(pitch))
        if is_other(told, noise, shared):
            found = likeliest(problem, self.expected, shared, found.outlines, anew=False)
        return problem, found.under(problem.noise, shared)


def said_by(problem: JointProblem, found: OnPad, told: Noise) -> tuple[Noise, float]:
    """Return the noise that outlines leave, and how many times less evidence is worth by it."""
    its, on = laid(problem, found.outlines), problem.states == ON
    bare = (its.share <= 0.0) & (problem.states != UNKNOWN)
    count = np.count_nonzero(bare & on) + TOLD_STRAYS * told.strays
    strays = min(float(count / (np.count_nonzero(bare) + TOLD_STRAYS)), MOST_STRAYS)
    # A law's power would bend the loads of whole outlines, too, which are what parts them.
    noise = learned(told, scatter_of(its, told), MANY, strays)
    vector, n = noise.vector(float(problem.grid[2])), found.outlines.count
    _, alike = goodness_of_load.call(its._replace(noise=vector), NUMBERS * n)
    touched = int(np.count_nonzero(on))
    return noise, variance_inflation(unbiased(alike, touched, n), touched)


def scatter_of(laid_out: JointProblem, told: Noise) -> Values:
    """Return ln sigma and the voids' log odds of what outlines cover whole, and of what is told."""
    states = laid_out.states
    whole = (laid_out.share >= COVERED) & (states != UNKNOWN)
    shown = whole & (states == ON)
    n, many = int(np.count_nonzero(whole)), int(np.count_nonzero(shown))
    sigma = told.sigma
    if many >= FEWEST:
        off = laid_out.logs[shown] - np.log(laid_out.load[shown])
        sigma = max(NORMAL * float(np.median(np.abs(off - np.median(off)))), LEAST_SIGMA)
    log_sigma = (many * math.log(sigma) + TOLD * math.log(told.sigma)) / (many + TOLD)
    return np.array([log_sigma, log_odds((n - many + TOLD * told.voids) / (n + TOLD))])


def log_odds(voids: float) -> float:
    """Return the log odds of a share of voids, which is never none nor all."""
    voids = min(max(voids, LEAST_VOIDS), MOST_VOIDS)
    return math.log(voids / (1.0 - voids))


def overlooked(problem: JointProblem, found: OnPad) -> bool:
    """Return whether elements side by side are touched where no outline lies on any of them."""
    pieces = components.call(problem.states == ON, 1)
    sizes = np.bincount(pieces.ravel())
    sizes[0] = 0
    sizes[pieces[laid(problem, found.outlines).share > 0.0]] = 0
    return bool(sizes.max() >= LEAST_ADJACENT)


def unbiased(neighbours: float, touched: int, n_outlines: int) -> float:
    """Return how alike neighbours are, free of what the fit of each outline takes away.

    A load and a place fitted to few elements leave residuals that are unlike by themselves.
    """
    return neighbours + ABSORBED * math.sqrt(PAIRS / max(touched, 1)) * n_outlines


def is_other(told: Noise, noise: Noise, shared: float) -> bool:
    """Return whether a noise is so different that outlines should be looked for anew."""
    voids = log_odds(noise.voids) - log_odds(told.voids)
    changes = math.log(noise.sigma / told.sigma), voids, math.log(shared)
    return bool((np.abs(changes) > ANEW).any())
