"""``Readings``: an image as the kernels take it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.errors import DataError, Degenerate, RuleError
from tactile_graph.steps.rules import require_square
from tactile_graph.wires import Image
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.large_pads.solid import typical_load
from tactile_graph_likelihood.single.density.element_terms import (
    OFF,
    ON,
    OVER,
    UNKNOWN,
    States,
)
from tactile_graph_likelihood.single.density.problem import LARGE_PAD

FAINT = 0.015
"""Share of a loaded element's reading below which another counts as nothing. A column of a divider
that is loaded up to its supply turns a converter's noise into 0.4 % on its idle elements."""
LARGEST = 1e100
"""Reading beyond which no pad's unit can be; the squares of smaller ones are numbers."""
MANY = 4096
"""Touched elements beyond which an outline is searched for by blocks of them."""
RANK = 8
"""Of the reading that stands for a loaded element: a grain of sand alone bears more than it."""


class TurnOn(NamedTuple):
    """What is told of a law at its least loads; all of ln load.

    Parameters
    ----------
    log_load : float
        Of its turn-on.
    bend : float
        How much less a load below reads by a law that went on as above, over the squared distance.
    arm : float
        How far the turn-on lies below the load by which the law is known.
    hidden : float
        The load that noise hides on most elements.
    chance : float
        Probability of the told bend, as far as readings were looked at for it.
    """

    log_load: float
    bend: float
    arm: float
    hidden: float
    chance: float = 1.0


class Gap(NamedTuple):
    """What is believed of the distance of neighbouring elements' edges.

    Parameters
    ----------
    middle_cm, std_cm : float
    is_told : bool
        Whether a pad of this pitch is told of, whose gap it is.
    """

    middle_cm: float
    std_cm: float
    is_told: bool


class Readings(NamedTuple):
    """What an image says, and where its elements lie.

    ``grid`` holds left and top edge of the first element, pitch and side of an element, and two
    zeros (a search's own); ``logs`` and ``states`` are as in `element_terms`. ``stretch`` is the
    height of a cell over its width, where it is nearly 1 and was taken for that, cells being as
    large as they are; ``least_log`` the logarithm of the least load that shows, where the readings
    themselves say it; ``turn_on`` what is told of the law there, where readings are by one;
    ``through_foam`` what was read before foam was undone; ``unheld`` logarithms as they were read,
    where some are held to the load at which readings end, and ``noise`` the deviation of a load
    there; ``gap`` what is believed of elements'
    gap, where that was not said; ``length_std_cm`` how uncertain it leaves the lengths of an
    outline; ``filtered`` whether readings are not each their own, see `is_filtered`; ``ghosts``
    whether they look as on a matrix without isolation, see `ghosts`; ``part_of`` all readings,
    where most of what a wide outline covers whole is left out of these, see `in_part`.
    """

    grid: Values
    logs: Values
    states: States
    touched: int
    stretch: float = 1.0
    least_log: float | None = None
    turn_on: TurnOn | None = None
    through_foam: Readings | None = None
    unheld: Values | None = None
    noise: float = 0.0
    gap: Gap | None = None
    length_std_cm: float = 0.0
    filtered: bool = False
    ghosts: bool = False
    part_of: Readings | None = None

    @property
    def size_cm(self) -> tuple[float, float]:
        """Width and height from the first element's edge to the last one's."""
        return size_of(self.grid, self.states.shape)

    @property
    def is_wide(self) -> bool:
        """Whether so much is touched that an outline is searched for by blocks of elements."""
        return self.part_of is not None or self.touched > MANY

    @property
    def shows(self) -> NDArray[np.bool_]:
        """Which elements read a load, if only that they read the most."""
        found: NDArray[np.bool_] = (self.states == ON) | (self.states == OVER)
        return found

    def with_states(self, states: States) -> Readings:
        """Return readings of other states, and of as many touched elements as show by them."""
        found = self._replace(states=states)
        return found._replace(touched=int(np.count_nonzero(found.shows)))

    def without(self, elements: NDArray[np.bool_]) -> Readings:
        """Return readings of which some elements say nothing."""
        return self.with_states(np.where(elements, np.uint8(UNKNOWN), self.states))


@compiled_later
def split(values: Values, least: float, logs: Values, states: States) -> int:
    """Write logarithms and states of readings; return how many show, -1 if one is NaN."""
    count = 0
    for i in range(values.shape[0]):
        for j in range(values.shape[1]):
            value = values[i, j]
            if value - value != 0.0:
                return -1
            if value > 0.0 and value >= least:
                logs[i, j] = np.log(value)
                states[i, j] = ON
                count += 1
            else:
                logs[i, j] = 0.0
                states[i, j] = OFF
    return count


@compiled_later
def ranked(values: Values, rank: int) -> float:
    """Return the value that so many, less one, are at least as large as."""
    largest = np.full(rank, -np.inf)  # ascending
    for i in range(values.shape[0]):
        for j in range(values.shape[1]):
            value = values[i, j]
            if value <= largest[0]:
                continue
            k = 0
            while k + 1 < rank and largest[k + 1] < value:
                largest[k] = largest[k + 1]
                k += 1
            largest[k] = value
    return float(largest[0])


def _loaded(values: Values, least: float, logs: Values, states: States) -> float:
    """Return what a loaded element reads; of the last two only the space is used.

    On a large pad more than eight readings may be strays. There it is twice the median of those
    among other readings, 0 where there are none.
    """
    if values.size <= LARGE_PAD:
        return ranked.call(values, RANK)
    split.call(values, least, logs, states)
    typical = typical_load.call(logs, states)
    return 0.0 if math.isnan(typical) else 2.0 * math.exp(typical)


def grid_of(image: Image, gap_cm: float) -> Values:
    """Return where an image's elements lie, as `Readings` has it, in square cells as large as its.

    Raises
    ------
    RuleError
        If the gap between elements leaves none.
    """
    (x, y), (across, down), half = image.origin_cm, image.pitch_cm, 0.5 * gap_cm
    pitch = across if across == down else math.sqrt(across * down)
    if not gap_cm < pitch:
        raise RuleError(f"gap_cm: must be below the pitch of {pitch:g} cm, got {gap_cm:g}")
    return np.array([x + half, y + half, pitch, pitch - gap_cm, 0.0, 0.0])


def readings_of(image: Image, gap_cm: float, least: float, faint: float = FAINT) -> Readings:
    """Return an image's readings.

    Parameters
    ----------
    image : Image
        Loads, in any unit; invalid cells say nothing either way.
    gap_cm : float
        Distance of neighbouring elements' edges; less than the pitch.
    least : float
        Readings below it count as nothing.
    faint : float
        So do those below this share of the eighth largest reading, as beside saturated elements;
        on a large pad, of twice the median.

    Raises
    ------
    RuleError
        If the cells are not square, or the gap leaves no element.
    DataError
        If a valid cell is not finite or beyond 1e100.
    Degenerate
        If nothing is touched.
    """
    require_square(image)
    grid = grid_of(image, gap_cm)
    values = np.ascontiguousarray(image.filled(0.0), dtype=np.float64)
    logs, states = np.empty(values.shape), np.empty(values.shape, np.uint8)
    if faint > 0.0 and values.size >= RANK and faint * values.max() > least:
        least = max(least, faint * _loaded(values, least, logs, states))
    touched = split.call(values, least, logs, states)
    if touched < 0:
        raise DataError("image", "a valid cell holds NaN or infinity")
    if values.size and values.max() > LARGEST:
        raise DataError("image", f"readings must be at most {LARGEST:g}, got {values.max():g}")
    if image.valid is not None:
        states[~image.valid] = UNKNOWN
        touched = int((states == ON).sum())
    if touched == 0:
        raise Degenerate(_why(float(values.max(initial=0.0)), least, image.valid))
    return Readings(grid, logs, states, touched)


def _why(peak: float, least: float, valid: NDArray[np.bool_] | None) -> str:
    if 0.0 < peak < least:
        return (
            f"no reading reaches {least:.3g}, the least that shows (see shows_from); the largest "
            f"is {peak:.3g}: no outline fits"
        )
    if valid is not None and not valid.all():
        n_bad = int(np.count_nonzero(~valid))
        return (
            f"no element with a valid reading bears a load ({n_bad} of {valid.size} have none): no "
            "outline fits"
        )
    return "no element bears a load: no outline fits"


def is_row(readings: Readings) -> bool:
    """Return whether the pad is a single row or column, which tells nothing of what lies across."""
    return 1 in readings.states.shape


def size_of(grid: Values, shape: tuple[int, ...]) -> tuple[float, float]:
    """Return width and height of a grid of so many rows and columns, between its outer edges."""
    (rows, columns), (_, _, pitch, side, *_) = shape, grid.tolist()
    gap = pitch - side
    return columns * pitch - gap, rows * pitch - gap
