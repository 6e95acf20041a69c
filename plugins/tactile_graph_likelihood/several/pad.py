"""All objects on a pad: parts that nothing connects, each looked at by itself."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Shape
from tactile_graph_likelihood.any_pad.pad_effects.gap import narrower
from tactile_graph_likelihood.geometry.outlines import ELLIPSE, Values, packed, unknowns
from tactile_graph_likelihood.geometry.pieces import components
from tactile_graph_likelihood.several.beginnings.ladder import LEAST_PIECE
from tactile_graph_likelihood.several.joint.joint_posterior import (
    MIDDLE,
    WIDTH,
    JointProblem,
)
from tactile_graph_likelihood.several.joint.scene import Configuration, joined
from tactile_graph_likelihood.several.search import Search
from tactile_graph_likelihood.single.climbs.search import LIGHT_EDGE
from tactile_graph_likelihood.single.density.element_terms import ON, OVER, UNKNOWN
from tactile_graph_likelihood.single.readings import Readings

REACH = 2
"""Cells within which touched elements may be one object's."""

LEAST_ADJACENT = 3
"""Touched elements side by side that may be an object where there are larger ones, too: strays are
single ones."""

MARGIN, OF_EXTENT = 2, 4
"""Cells around a part that are looked at with it, and of how many cells of its own another is: an
outline that grows beyond what is looked at would not be held by the bare cells there."""

TEMPER = 2.0
"""How many times less evidence between kinds and other outlines is worth: none of them is quite
what lies there."""

DOUBT = 4.0
"""The same between numbers of outlines, for the probability that is stated: searches miss some."""

SMALLEST, LARGEST = 10.0 / 13.0, 15.0 / 26.0
"""Least radius or half side in pitches, and the largest over the pad's longer side, where nobody
says: 1 and 12 cm on the pad `thesis`, where all else was tuned."""

LOADS = 1.5
"""Standard deviation of the logarithm of an outline's load, about the touched elements' median."""


@dataclass(frozen=True, eq=False)
class Expected:
    """What is expected on a pad before a frame is read.

    Parameters
    ----------
    kinds : list of (int, int)
        Kinds of outlines and their corners, all alike likely.
    sizes_cm : (float, float), either None
        Range of radii and half sides; as the pad is where not given.
    whole : float
        Probability that an outline lies on the pad whole.
    most : int
        Outlines at most.
    more : float
        Log odds of a number of outlines over one less.
    """

    kinds: list[tuple[int, int]]
    sizes_cm: tuple[float | None, float | None]
    whole: float
    most: int
    more: float

    def outlines(self, shapes: Sequence[Shape], problem: JointProblem) -> Configuration:
        """Return shapes as outlines of the kinds that are looked for.

        Those of other kinds become the ellipse, or the first kind, of the same place and area.
        """
        fallback = next((k for k in self.kinds if k[0] == ELLIPSE), self.kinds[0])
        kinds, corners, points = [], [], np.zeros((len(shapes), WIDTH))
        for row, shape in zip(points, shapes, strict=True):
            kind, n, p = packed(shape)
            if (kind, n) not in self.kinds:
                kind, n = fallback
                radius = math.sqrt(shape.area_cm2 / math.pi)
                p = np.array([shape.x_cm, shape.y_cm, radius, radius, 0.0])
                p = p[: unknowns.call(kind, n)]
            row[: len(p)] = p
            row[len(p)] = problem.prior[MIDDLE]
            kinds.append(kind)
            corners.append(n)
        return Configuration(np.array(kinds), np.array(corners), points, 0.0)

    def sizes_on(self, readings: Readings) -> tuple[float, float]:
        """Return the range of radii and half sides on a pad, in cm."""
        smallest, largest = self.sizes_cm
        if smallest is None:
            smallest = SMALLEST * float(readings.grid[2])
            smallest = smallest if largest is None else min(smallest, 0.5 * largest)
        if largest is None:
            largest = max(LARGEST * max(readings.size_cm), 2.0 * smallest)
        return smallest, largest

    def problem(self, readings: Readings, noise: Values) -> JointProblem:
        """Return the problem of a whole pad on which nothing lies yet."""
        grid, logs, states = readings.grid, readings.logs, readings.states
        states = np.where(states == OVER, ON, states).astype(np.uint8)
        prior = np.zeros(11)
        prior[:2], prior[2:4], prior[4:6] = grid[:2], readings.size_cm, self.sizes_on(readings)
        prior[6:8] = self.whole, math.nan
        prior[9:] = float(np.median(logs[states == ON])) + LIGHT_EDGE, LOADS
        bare = np.zeros(states.shape)
        return JointProblem(grid, logs, states, noise, prior, bare, bare)


@dataclass(frozen=True, eq=False)
class Found:
    """The likeliest outlines of a part of a pad, and others that the search came upon.

    Parameters
    ----------
    scene : Search
    outlines : Configuration
    others : list of (float, Configuration)
        Each with its log probability over that of the likeliest.
    """

    scene: Search
    outlines: Configuration
    others: list[tuple[float, Configuration]]


@dataclass(frozen=True, eq=False)
class OnPad:
    """The likeliest outlines on a pad, and the log probabilities of each number of them.

    Those of numbers beyond what is allowed are kept apart.
    """

    parts: list[Found]
    counts: dict[int, float]
    beyond: dict[int, float]

    @property
    def outlines(self) -> Configuration:
        """Return the outlines of all parts."""
        return joined([part.outlines for part in self.parts])

    @property
    def count_probability(self) -> float:
        """Return the probability of this number among all that the search came upon."""
        every = self.counts | self.beyond
        here = every[self.outlines.count]
        odds = [math.exp(min((log - here) / DOUBT, 50.0)) for log in every.values()]
        return 1.0 / sum(odds)

    @property
    def height(self) -> float:
        """What the outlines add to the log probability where they are."""
        return sum(part.scene.worth(part.outlines) for part in self.parts)

    def on(
        self, changed: Callable[[JointProblem], JointProblem], shared: float | None = None
    ) -> OnPad:
        """Return the same outlines on a pad of which something else is known."""
        parts = []
        for part in self.parts:
            its = part.scene
            worth = its.shared if shared is None else shared
            scene = Search(changed(its.problem), its.kinds, its.more, worth)
            parts.append(replace(part, scene=scene))
        return OnPad(parts, self.counts, self.beyond)

    def under(self, noise: Values, shared: float) -> OnPad:
        """Return the same outlines under another noise."""
        return self.on(lambda its: its._replace(noise=noise), shared)

    def settled(self) -> OnPad:
        """Return what these outlines come to, brought to their joint mode."""
        parts = [replace(it, outlines=it.scene.settled(it.outlines)[0]) for it in self.parts]
        return OnPad(parts, self.counts, self.beyond)

    def settled_on(self, side_cm: float) -> OnPad:
        """Return what these outlines come to on elements of other sides, in the same places."""

        def narrowed(its: JointProblem) -> JointProblem:
            return its._replace(grid=narrower(its.grid, float(its.grid[3]) - side_cm))

        return self.on(narrowed).settled()


def parts_of(problem: JointProblem, expected: Expected, shared: float) -> list[Search]:
    """Return the parts of a pad that nothing connects, each with some cells around it."""
    on = problem.states == ON
    labels, pieces = components.call(on, REACH), components.call(on, 1)
    sizes = np.bincount(labels.ravel())[1:]
    adjacent = np.zeros(sizes.size, np.int64)
    np.maximum.at(adjacent, labels[on] - 1, np.bincount(pieces.ravel())[pieces[on]])
    may_be = (sizes >= LEAST_PIECE) | (adjacent >= LEAST_ADJACENT)
    large = np.flatnonzero(may_be) if may_be.any() else [sizes.argmax()]
    found = []
    for k in large:
        own = labels == k + 1
        box = around(own.any(axis=1)), around(own.any(axis=0))
        grid = problem.grid.copy()
        grid[:2] += grid[2] * np.array([box[1].start, box[0].start])
        states = np.where(on & ~own, UNKNOWN, problem.states)[box].astype(np.uint8)
        bare = np.zeros(states.shape)
        part = problem._replace(
            grid=grid, logs=problem.logs[box].copy(), states=states, load=bare, share=bare
        )
        found.append(Search(part, expected.kinds, expected.more, shared))
    return found


def around(lines: NDArray[np.bool_]) -> slice:
    """Return the rows or columns that are looked at for a part that has cells in some of them."""
    own = np.flatnonzero(lines)
    first, last = int(own[0]), int(own[-1])
    margin = max(MARGIN, (last + 1 - first) // OF_EXTENT)
    return slice(max(first - margin, 0), last + margin + 1)


def likeliest(
    problem: JointProblem,
    expected: Expected,
    shared: float = 1.0,
    starts: Configuration | None = None,
    anew: bool = True,
) -> OnPad:
    """Return the outlines on a pad of the most evidence.

    Parameters
    ----------
    problem : JointProblem
        Of the whole pad.
    expected : Expected
    shared : float
        As in `Scene`.
    starts : Configuration, optional
        Where the search may begin, too.
    anew : bool
        Whether it begins elsewhere even where these explain what is read.

    Raises
    ------
    Degenerate
        If no outlines, as many as are allowed, explain the image.
    """
    scenes = parts_of(problem, expected, shared)
    begins = split(starts, scenes) if starts else [None] * len(scenes)
    every = [s.divisions(expected.most, b, anew) for s, b in zip(scenes, begins, strict=True)]
    worths = [
        {n: scene.of_number(found) for n, found in divisions.items()}
        for scene, divisions in zip(scenes, every, strict=True)
    ]
    logs, choice = chosen(worths, expected.most)
    if not logs:
        raise Degenerate(f"no {expected.most} objects or fewer explain what is touched")
    counts = choice[max(logs, key=logs.__getitem__)]
    parts = []
    for scene, divisions, n in zip(scenes, every, counts, strict=True):
        if n == 0:
            continue
        its = divisions[n]
        others = [(scene.rank(o) - scene.rank(its), o) for o in scene.every if o is not its]
        parts.append(Found(scene, its, others))
    weighed, _ = chosen([scene.worths for scene in scenes], expected.most * len(scenes))
    weighed |= {sum(counts): logs[sum(counts)]}
    beyond = {n: weighed.pop(n) for n in list(weighed) if n > expected.most}
    return OnPad(parts, weighed, beyond)


def split(found: Configuration, scenes: list[Search]) -> list[Configuration | None]:
    """Return the outlines that lie nearest to each part, None where there are none."""
    near = np.array(
        [[scene.far_from(x, y) for x, y in found.points[:, :2]] for scene in scenes]
    ).argmin(axis=0)
    its = [np.flatnonzero(near != part) for part in range(len(scenes))]
    return [found.without(*out) if len(out) < found.count else None for out in its]


def chosen(
    every: list[dict[int, float]], most: int
) -> tuple[dict[int, float], dict[int, tuple[int, ...]]]:
    """Return the log probability of each number of outlines, and how many each part has then.

    Outlines have no names: K of them may be exchanged in K! ways.
    """
    best: dict[int, tuple[float, tuple[int, ...]]] = {0: (0.0, ())}
    for some in every:
        new: dict[int, tuple[float, tuple[int, ...]]] = {}
        for (n, (log, counts)), (k, more) in product(best.items(), [(0, 0.0), *some.items()]):
            total = log + more
            if n + k <= most and total > -math.inf and total > new.get(n + k, (-math.inf,))[0]:
                new[n + k] = total, (*counts, k)
        best = new
    logs = {n: log + math.lgamma(n + 1.0) for n, (log, _) in best.items() if n > 0}
    return logs, {n: counts for n, (_, counts) in best.items()}
