"""Step ``above_noise``: what is touched, by the noise in the frame itself."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Any, NamedTuple

import numpy as np
from annotated_types import Gt
from numpy.typing import NDArray

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image, Mask, quick_mask
from tactile_graph_filters.readings.dead_below import without_dead
from tactile_graph_filters.readings.ordered import in_order
from tactile_graph_filters.thresholds.noise_level import least_step, noise_level
from tactile_graph_likelihood.any_pad.observation.learned_pad import taught
from tactile_graph_likelihood.any_pad.observation.rising import (
    SHOWS,
    rise_of,
    risen_by_element,
    together,
)
from tactile_graph_pads.pad import load_pad

TINY = float(np.finfo(np.float64).tiny)
MOST_RISE = 1e6
"""Rise that is told of a frame without noise."""
FEWEST_CELLS = 5
"""Cells from which on a frame's readings tell noise from a load at all."""
FEW_CELLS, FOR_FEW = 32, 1.5
"""Up to so many cells a reading must rise by so many times as much: their closest quarter often
lies far closer than noise does."""
BY_LOWEST = ((3, 3.0, 96.0), (4, 0.9, 12.0))
"""Where few cells tell no noise, some of the lowest do: how many, and what times their range the
largest rises, for each cell of the pad and at most. Of empty frames of 5 to 32 cells up to 5 % seem
touched to the pipelines `locate` (far more of readings that are cut off at 0). Of discs with a
radius of 0.7 to 1 cell one in ten is not seen on 3 x 3 cells, one in 100 at most on more, but a
quarter on 2 x 4 and most on 5 or 6 cells, hardly one of which they leave untouched."""
FEWEST_IN_RINGS = 7
"""Cells from which on noise hardly ever falls from ring to ring around the largest (`_of_few`)."""
STANDS = 1.5
"""Times the noise that the largest then rises at least, as the pipelines `locate` ask."""
Found = tuple[float, float, int, int, float, NDArray[np.bool_]]
"""Zero, noise, cells that show, those together, the largest rise, and which show."""


class Showing(NamedTuple):
    """A footprint of what rises above the noise; a port that takes a mask takes it as it is.

    ``level`` is what its cells reach, in the image's unit. ``rise`` is how far the largest reading
    rises, in what noise reaches: 1 is on the edge, 0 where nothing shows. In a twentieth of frames
    of 256 untouched cells one comes to 1.0, as the noise is told by few of them. ``together`` is
    the most cells within two rows and columns of one of them, itself counted, as far as 9: those
    that noise lets show lie apart.
    """

    mask: Mask
    level: float
    rise: float
    together: int


# Set from outside: within a NamedTuple every name is a field.
Showing.provides = {Mask: "mask"}  # type: ignore[attr-defined]


class AboveNoise:
    """Return the footprint of what rises above the noise in a frame.

    Parameters
    ----------
    pad : str or mapping
        Name of a pad, its YAML file, or the pad itself: what offsets, noise and bad elements it
        has learned are taken.
    deviations : float
        Standard deviations of noise that count as none.

    Notes
    -----
    The zero and the noise are those of the frame's own closest quarter of readings, which is taken
    to be untouched; where these are all the same and the least, the noise is what lies just above
    (`clipped_noise`). Of 32 cells or fewer a reading must rise half as much again. Where fewer than
    four of them lie below the zero, or none rises so far, the lowest three or four tell the noise
    (`BY_LOWEST`), or those farthest from the largest where readings fall from ring to ring around
    it; where the lowest are the same the largest must reach `noise_level`. Cells that are dead far
    below the others are left out (`dead_below`), and rows and columns that rest above the others
    are brought back (`hot_lines`).
    ``level`` is the largest that any element must reach, in the image's unit.
    """

    stateless = True

    def __init__(
        self,
        *,
        pad: str | dict[str, Any] = "thesis",
        deviations: Annotated[float, Gt(0)] = SHOWS,
    ) -> None:
        self._pad, self._deviations = load_pad(pad), deviations

    def __call__(self, image: Image) -> Showing:
        """Return the footprint, its level, how far it rises, and how many of it lie together.

        Parameters
        ----------
        image : Image
            Readings that rise with load, in any quantity; invalid cells are not touched.

        Raises
        ------
        RuleError
            If a pad was learned, of another shape, pitch or quantity.
        ValueError
            If a valid cell is not finite or beyond 1e100.
        Degenerate
            If no cell is valid, or fewer than five are and no pad has learned their noise.
        """
        its = taught(self._pad, image)
        few = image.values.size <= FEW_CELLS and (its is None or its.noise is None)
        if few:
            _refuse_fewest(image)
        if its is None:
            image = without_dead(image)
            deviations = self._deviations * FOR_FEW if few else self._deviations
            found = rise_of(image, deviations, False)[:6]
            zero, least, count, near, most, shows = _of_few(image, found) if few else found
            mask = quick_mask(shows, image.pitch_cm, image.origin_cm, count)
            return Showing(mask, zero + least, min(most / max(least, TINY), MOST_RISE), near)
        risen = risen_by_element(image, its, self._deviations)
        mask = Mask(risen.shows, image.pitch_cm, image.origin_cm)
        near = together.call(risen.shows)
        each = risen.least if isinstance(risen.least, float) else risen.least[risen.shows]
        level = risen.zero + float(np.max(risen.least))
        with np.errstate(over="ignore"):
            rises = risen.above[risen.shows] / np.maximum(each, TINY)
        return Showing(mask, level, min(float(rises.max(initial=0.0)), MOST_RISE), near)


def _refuse_fewest(image: Image) -> None:
    """Raise where some cells are valid, but too few to tell noise from a load."""
    n = image.values.size if image.valid is None else int(np.count_nonzero(image.valid))
    if 0 < n < FEWEST_CELLS:
        raise Degenerate(
            f"{n} valid {'cell tells' if n == 1 else 'cells tell'} no noise, so nothing says what "
            f"is touched: at least {FEWEST_CELLS} do, or a pad that has learned it (learn-pad "
            "--empty); of few cells the step 'load' gives the centre of pressure"
        )


def _of_few(image: Image, found: Found) -> Found:
    """Return what shows of few cells: by the lowest, where no noise is told or all is below it."""
    zero, least, count, _, most, shows = found
    values = image.values if image.valid is None else image.values[image.valid]
    ordered = in_order(np.asarray(values, np.float64).ravel())
    is_told = least > 0.5 * least_step(ordered)
    if (is_told and count) or not ordered.size:
        return found
    # Whole numbers are counts, whose noise no range may tell; at 0 they may be cut off, or a mask.
    step = 1.0 if ordered[0] != 0.0 and (ordered == np.rint(ordered)).all() else 0.0
    above = ordered - ordered[0]
    reach = _reach_of_lowest(above, step)
    if reach is None and values.ndim == 2 and ordered.size >= FEWEST_IN_RINGS:
        reach = _reach_of_rings(values - ordered[0])
    if reach is not None:
        shows = image.values > ordered[0] + reach
        shows = shows if image.valid is None else shows & image.valid
        its = int(np.count_nonzero(shows)), together.call(shows), float(above[-1])
        return float(ordered[0]), reach, *its, shows
    no_range = max(float(above[BY_LOWEST[0][0] - 1]), step) == 0.0
    if is_told or (no_range and zero + most >= noise_level(image)):
        return found
    return zero, least, 0, 0, 0.0, np.zeros_like(shows)


def _reach_of_lowest(above: NDArray[np.float64], step: float) -> float | None:
    """Return how far noise reaches by the lowest of few cells; none if nothing stands above."""
    n = above.size
    for lowest, each, most in BY_LOWEST:
        if 2 * lowest <= n + 1:
            its_range = max(float(above[max(lowest, n // 4) - 1]), step)
            reach = min(each * n, most) * its_range
            if 0.0 < reach < above[-1]:
                return reach / STANDS
    return None


def _reach_of_rings(above: NDArray[np.float64]) -> float | None:
    """Return what cells farthest from the largest reach; none unless they fall from ring to ring.

    A load that leaves hardly a cell untouched does so.
    """
    rows, columns = np.indices(above.shape)
    row, column = divmod(int(above.argmax()), above.shape[1])
    away = (rows - row) ** 2 + (columns - column) ** 2
    rings = [above[away == far] for far in np.unique(away)]
    falls = all(far.max() < near.min() for near, far in pairwise(rings))
    return float(rings[-1].max()) if falls else None
