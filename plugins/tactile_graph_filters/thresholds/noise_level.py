"""The level above a frame's own noise, and a mask that says which level made it."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tactile_graph.quantities import unit_of
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.readings.clipped_noise import FEW_STEPS, is_anywhere
from tactile_graph_filters.readings.dead_below import dead_below
from tactile_graph_filters.readings.dead_lines import EQUAL_SHARE, dead_lines
from tactile_graph_filters.readings.line_noise import cut_off_noise
from tactile_graph_filters.readings.ordered import in_order

Values = NDArray[np.float64]
Cells = NDArray[np.bool_]
EVERY = np.zeros((0, 0), np.bool_)
"""Stands for cells all of which are read."""

LOW, MIDDLE = 0.05, 0.25
"""Shares of the cells, by rising reading: the unloaded ones are among the lower quarter."""
UPPER = 0.75
"""Up to which share it is asked whether readings lie side by side as a load's do."""
LOW_TO_MIDDLE_SD = 0.9704
"""How far apart these lie in noise, in standard deviations."""
NOISES = 10.0
"""The level lies so many standard deviations above the lower quarter."""
FEW_CELLS = (1.0, 28.0, 10.1, 3.44, 1.97, 2.95, 1.99, 1.53, 1.26, 1.08, 1.32, 1.15, 1.04)
"""By so much that spread is raised where it is a gap between few readings: of up to 4, 8, 12, …
52 cells. An empty pad with normal noise is then reached no oftener than one of 8 x 8 (in one of 820
frames; in one of 100 with 5 to 8 cells, where the two lowest alone tell), by 2 million simulated
frames each."""
FEWEST_AT_REST, BEYOND = 4, 7.0
"""What stands apart from so many readings or more by so many times their range is no noise, however
close the lowest of them lie: normal noise of up to 52 cells looks so in less than one of 1000
frames."""
PLAINLY = 30.0
"""How many times as far as the lower readings lie apart the peak of few cells lies above them if
something seems to lie there: in less than one of 100 frames of an empty pad of 3 x 3 cells."""
LEAST_SHARE = 0.03
"""And no lower than at this share of the peak, for frames without any noise below."""
OWN_NOISE = "the frame's own noise"
OF_PEAK = f": {100.0 * LEAST_SHARE:g} % of the peak, as that is more"
"""Is told after what the level is above, where the noise alone does not decide."""


def noise_level(image: Image) -> float:
    """Return the level, in the image's unit, from which on cells stand out of the noise.

    Parameters
    ----------
    image : Image
        Unloaded in at least a quarter of its valid cells. Dead rows and columns are left out
        (not those that merely nothing touches, on a pad that a device cuts off at its least
        reading), and cells that are dead far below the others (`dead_below`).

    Returns
    -------
    float
        The lower quartile, plus ten standard deviations of the noise, as the distance of the
        5 % quantile from the quartile tells it (where both are cut off: `cut_off_noise`), or 3 %
        of the peak's height if that is more. Of 52 cells or fewer it is raised by `FEW_CELLS`, but
        not above readings that plainly stand apart (`BEYOND`); of 4 or fewer no noise is known.
        Above every reading where all are equal; infinite where no cell is valid.

    Notes
    -----
    Chosen on 90 frames of a capacitive panel (CapContact), so that its contacts are as many as the
    optical reference shows.
    """
    return told_level(image)[0]


def told_level(image: Image) -> tuple[float, str]:
    """Return the `noise_level`, and what it is above."""
    found = _lower(image)
    if found is None:
        return math.inf, OWN_NOISE
    low, base, peak, seen = found
    level = level_above(base - low, base, peak)
    few = (seen.size - 1) // 4
    if 0 <= few < len(FEW_CELLS):
        raised = level_above(FEW_CELLS[few] * (base - low), base, peak)
        level = max(level, min(raised, _level_below_apart(seen)))
    return level, OWN_NOISE + OF_PEAK if is_of_peak(level, base, peak) else OWN_NOISE


def is_untold(image: Image) -> bool:
    """Return whether few cells, none of which reaches the level, leave open if something is there.

    Parameters
    ----------
    image : Image
        All of whose readings lie below its `noise_level`.
    """
    if image.values.size > 4 * len(FEW_CELLS) or (found := _lower(image)) is None:
        return False
    low, base, peak, seen = found
    return seen.size > 4 and low < base and peak - base > PLAINLY * (base - low)


def _level_below_apart(seen: Values) -> float:
    """Return the level above the first of few readings that others plainly stand apart from."""
    ordered = np.sort(seen)
    rest = ordered[max(FEWEST_AT_REST - 1, int(MIDDLE * (seen.size - 1))) : -1]
    levels = rest + BEYOND * (rest - ordered[0])
    apart = (levels > rest) & (ordered[seen.size - rest.size :] > levels)
    return float(levels[apart].min(initial=math.inf))


def lower_readings(image: Image) -> tuple[float, float, float] | None:
    """Return the 5 % quantile, the lower quartile and the peak of the cells that are read.

    Where both quantiles are the same, the first is what it were if nothing had cut off the noise
    that `cut_off_noise` finds above. None where no cell is valid.
    """
    found = _lower(image)
    return None if found is None else found[:3]


def _lower(image: Image) -> tuple[float, float, float, Values] | None:
    """Return the lower readings, and of which ones; none where the first is no cell's reading."""
    rows, columns = dead_lines(image)
    usable, found = _lower_beside(image, rows, columns)
    if usable is None or found is None or not (rows.any() or columns.any()):
        return found
    low, base, _, seen = found
    if not (low < base and seen.size):
        return found
    untouched = _untouched_lines(image, rows, columns, usable, low, seen)
    if untouched is None:
        return found
    return _lower_beside(image, rows & ~untouched[0], columns & ~untouched[1])[1]


def _lower_beside(
    image: Image, rows: Cells, columns: Cells
) -> tuple[Cells | None, tuple[float, float, float, Values] | None]:
    """Return which cells are neither dead nor on these lines, None for all, and their readings."""
    values, usable = image.values, image.valid
    if rows.any() or columns.any():
        alive = ~rows[:, None] & ~columns
        usable = alive if usable is None else alive & usable
    if (dead := dead_below(image)) is not None:
        usable = ~dead if usable is None else usable & ~dead
    if usable is not None:
        values = values[usable]
    if values.size == 0:
        return usable, None
    seen = np.asarray(values, np.float64).ravel()
    low, middle = (int(share * (seen.size - 1)) for share in (LOW, MIDDLE))
    parted = np.partition(seen, (low, middle, seen.size - 1))
    lowest, base, peak = (float(parted[k]) for k in (low, middle, seen.size - 1))
    if lowest == base < peak:
        ordered = in_order(seen)
        of_frame = cells_of(image.values, usable)
        sigma = cut_off_noise.call(*of_frame, ordered, base, least_step(ordered))
        return usable, (lowest - LOW_TO_MIDDLE_SD * float(sigma), base, peak, seen[:0])
    return usable, (lowest, base, peak, seen)


def _untouched_lines(
    image: Image, rows: Cells, columns: Cells, usable: Cells, low: float, seen: Values
) -> tuple[Cells, Cells] | None:
    """Return which rows and columns read the same only because nothing touches them, if any.

    Notes
    -----
    They read the least of the other cells, and among the lower three quarters of these what reads
    more lies side by side: it is a load. Noise that a device cuts off lies anywhere.
    """
    ordered = in_order(seen)
    if low > ordered[0]:
        return None
    alike = image.values == low
    rows = rows & (alike.mean(axis=1) >= EQUAL_SHARE)
    columns = columns & (alike.mean(axis=0) >= EQUAL_SHARE)
    if not (rows.any() or columns.any()):
        return None
    reach = float(ordered[int(UPPER * (ordered.size - 1))]) - low
    hum = FEW_STEPS * least_step(ordered)
    cells, known = cells_of(image.values, usable)
    return None if is_anywhere.call(cells, known, low, reach, hum) else (rows, columns)


def cells_of(values: NDArray[Any], usable: Cells | None) -> tuple[Values, Cells]:
    """Return readings and which of them count, as `cut_off_noise` takes them."""
    known = EVERY if usable is None else np.ascontiguousarray(usable)
    return np.ascontiguousarray(values, np.float64), known


def least_step(ordered: Values) -> float:
    """Return the least difference of two readings."""
    steps = np.diff(ordered)
    return float(steps[steps > 0.0].min(initial=math.inf))


def level_above(spread: float, base: float, peak: float) -> float:
    """Return the level above the noise.

    Parameters
    ----------
    spread : float
        From the 5 % quantile to the lower quartile.
    base : float
        The lower quartile.
    peak : float
    """
    level = base + max(NOISES * (spread / LOW_TO_MIDDLE_SD), LEAST_SHARE * (peak - base))
    return level if level > base else math.nextafter(base, math.inf)


def is_of_peak(level: float, base: float, peak: float) -> bool:
    """Return whether the share of the peak made a level, not the noise."""
    return level == base + LEAST_SHARE * (peak - base) > base


class LevelledMask(Mask):
    """A mask that knows the level it was made with.

    Parameters
    ----------
    values, pitch_cm, origin_cm, count
        As of a `Mask`.
    level : float
        What its cells reach.
    quantity : str
        Of the readings.
    above : str
        What the level is above.
    """

    __slots__ = ("above", "level", "quantity")
    columns_shown: ClassVar[tuple[str, ...]] = (*Mask.columns_shown, "level")
    image_unit: ClassVar[tuple[str, ...]] = ("level",)
    level: float
    quantity: str
    above: str

    def __init__(
        self,
        values: NDArray[np.bool_],
        pitch_cm: tuple[float, float],
        origin_cm: tuple[float, float],
        count: int | None,
        level: float,
        quantity: str,
        above: str = OWN_NOISE,
    ) -> None:
        super().__init__(values, pitch_cm, origin_cm, count)
        object.__setattr__(self, "level", level)
        object.__setattr__(self, "quantity", quantity)
        object.__setattr__(self, "above", above)

    def __reduce__(self) -> tuple[type[LevelledMask], tuple[Any, ...]]:
        """Copy and pickle by what it is made of."""
        made_of = (
            self.values,
            self.pitch_cm,
            self.origin_cm,
            self.count,
            self.level,
            self.quantity,
            self.above,
        )
        return LevelledMask, made_of

    @property
    def assumed(self) -> str:
        """What was taken that nobody said."""
        unit = unit_of(self.quantity)
        none = "" if self.count else "; no reading is so high"
        return f"cells from {self.level:.4g} {unit} on, which is above {self.above}{none}"
