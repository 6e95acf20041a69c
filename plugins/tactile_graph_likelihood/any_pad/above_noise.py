"""Step ``above_noise``: what is touched, by the noise in the frame itself."""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

import numpy as np
from annotated_types import Gt

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
lies far closer than noise does. Of empty frames of 9 to 32 cells 2 to 3 % at most then seem touched
to the pipelines `locate`; 34 % of 9, 12 % of 16 and 5 % of 25 cells would."""


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
    (`clipped_noise`). Of 32 cells or fewer a reading must rise half as much again, and where fewer
    than four lie below the zero the largest must reach `noise_level`, too. Cells that are dead far
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
            zero, least, count, near, most, shows, _ = rise_of(image, deviations, False)
            if few and count and _seems_without_noise(image, least, zero + most):
                count, near, most, shows = 0, 0, 0.0, np.zeros_like(shows)
            mask = quick_mask(shows, image.pitch_cm, image.origin_cm, count)
            return Showing(mask, zero + least, min(most / max(least, TINY), MOST_RISE), near)
        found = risen_by_element(image, its, self._deviations)
        mask = Mask(found.shows, image.pitch_cm, image.origin_cm)
        near = together.call(found.shows)
        each = found.least if isinstance(found.least, float) else found.least[found.shows]
        level = found.zero + float(np.max(found.least))
        with np.errstate(over="ignore"):
            rises = found.above[found.shows] / np.maximum(each, TINY)
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


def _seems_without_noise(image: Image, least: float, highest: float) -> bool:
    """Return whether few readings tell no noise, and none reaches the level above theirs."""
    values = image.values if image.valid is None else image.values[image.valid]
    step = least_step(in_order(np.asarray(values, np.float64).ravel()))
    return least <= 0.5 * step and highest < noise_level(image)
