"""Step ``above_noise``: what is touched, by the noise in the frame itself."""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

import numpy as np
from annotated_types import Gt

from tactile_graph.wires import Image, Mask, quick_mask
from tactile_graph_filters.readings.dead_below import without_dead
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
    (`clipped_noise`). Cells that are dead far below the others are left out (`dead_below`), and
    rows and columns that rest above the others are brought back (`hot_lines`).
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
            If no cell is valid.
        """
        its = taught(self._pad, image)
        if its is None:
            image = without_dead(image)
            zero, least, count, near, most, shows, _ = rise_of(image, self._deviations, False)
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
