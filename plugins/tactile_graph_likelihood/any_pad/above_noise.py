"""Step ``above_noise``: what is touched, by the noise in the frame itself."""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

import numpy as np
from annotated_types import Gt
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of
from tactile_graph.errors import DataError
from tactile_graph.wires import Image, Mask
from tactile_graph_likelihood.any_pad.clump import NEAR
from tactile_graph_likelihood.any_pad.frame_noise import FrameNoise, frame_noise
from tactile_graph_likelihood.any_pad.learned_pad import Taught, taught
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.readings import LARGEST
from tactile_graph_pads.pad import Pad, load_pad

SHOWS = 4.0
"""Standard deviations of noise above zero from which on a reading is one."""

MOST_TOGETHER = 9
"""More are not counted: whether it is one, a few or many says whether it may be noise."""

TINY = float(np.finfo(np.float64).tiny)
MOST_RISE = 1e6
"""Rise that is told of a frame without noise."""


class Risen(NamedTuple):
    """Readings above the frame's zero, 0 where no more than noise, and what is more, in its unit.

    ``least`` is what a reading must exceed, of all elements or of each; ``shows`` where it does;
    ``taught`` what recordings say of the elements, if they do. A stuck element keeps its reading,
    which is none of a load.
    """

    above: Values
    least: float | Values
    shows: NDArray[np.bool_]
    zero: float
    taught: Taught | None


def risen(image: Image, pad: Pad, deviations: float = SHOWS) -> Risen:
    """Return what rises above the noise of an image.

    Parameters
    ----------
    image : Image
        In any quantity that rises with load.
    pad : Pad
        Where it was learned from recordings of this quantity, its offsets are taken off, its noise
        is taken, and its bad elements show nothing.
    deviations : float
        Standard deviations of noise that count as none.

    Raises
    ------
    DataError
        If a valid cell is not finite or beyond 1e100.
    """
    values = np.ascontiguousarray(image.filled(0.0), dtype=np.float64)
    if not np.abs(values).max(initial=0.0) <= LARGEST:
        raise DataError("image", f"readings must be finite and at most {LARGEST:g}")
    its, known = taught(pad, image), image.valid
    if its is not None:
        values = values - its.offset
        known = its.good if known is None else its.good & known
    readings = values.ravel() if known is None else values[known]
    noise = frame_noise(readings) if readings.size else FrameNoise(0.0, 0.0, 0.0)
    least: float | Values = float(max(deviations * noise.sigma, 0.5 * noise.step))
    if its is not None and its.noise is not None:
        least = np.maximum(deviations * its.noise, max(its.least, 0.5 * noise.step))
    above = values - noise.zero
    shows = above > least
    kept = shows if its is None else shows & (its.good | its.stuck)
    if known is not None:
        shows &= known
    if image.valid is not None:
        kept = kept & image.valid
    return Risen(np.where(kept, above, 0.0), least, shows, noise.zero, its)


def _together_plain(shows: NDArray[np.bool_]) -> int:
    """Return the most of some cells, shape (rows, columns), within `NEAR` of one of them."""
    if not shows.any():
        return 0
    wide = np.pad(shows.astype(np.int64), NEAR)
    window = (2 * NEAR + 1, 2 * NEAR + 1)
    counts = np.lib.stride_tricks.sliding_window_view(wide, window).sum(axis=(2, 3))
    return min(int(counts[shows].max(initial=0)), MOST_TOGETHER)


@compiled_twin_of(_together_plain)
def together(shows):  # type: ignore[no-untyped-def]
    """Do the same in loops, which end as soon as there are enough."""
    rows, columns = shows.shape
    most = 0
    for r in range(rows):
        for c in range(columns):
            if not shows[r, c]:
                continue
            count = 0
            for i in range(max(0, r - NEAR), min(rows, r + NEAR + 1)):
                for j in range(max(0, c - NEAR), min(columns, c + NEAR + 1)):
                    count += shows[i, j]
            if count >= MOST_TOGETHER:
                return MOST_TOGETHER
            most = max(most, count)
    return most


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
    to be untouched. ``level`` is the largest that any element must reach, in the image's unit.
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
        ValueError
            If a valid cell is not finite or beyond 1e100.
        """
        found = risen(image, self._pad, self._deviations)
        mask = Mask(found.shows, image.pitch_cm, image.origin_cm)
        near = together.call(found.shows)
        if isinstance(found.least, float):
            most = float(found.above[found.shows].max()) if mask.count else 0.0
            rise = most / max(found.least, TINY)
            return Showing(mask, found.zero + found.least, min(rise, MOST_RISE), near)
        level = found.zero + float(np.max(found.least))
        with np.errstate(over="ignore"):
            rises = found.above[found.shows] / np.maximum(found.least[found.shows], TINY)
        return Showing(mask, level, min(float(rises.max(initial=0.0)), MOST_RISE), near)
