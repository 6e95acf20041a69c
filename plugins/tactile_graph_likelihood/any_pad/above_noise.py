"""Step ``above_noise``: what is touched, by the noise in the frame itself."""

from __future__ import annotations

from typing import Annotated, Any, NamedTuple

import numpy as np
from annotated_types import Gt
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.wires import Image, Mask
from tactile_graph_likelihood.any_pad.frame_noise import FrameNoise, frame_noise
from tactile_graph_likelihood.any_pad.learned_pad import Taught, taught
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.readings import LARGEST
from tactile_graph_pads.pad import Pad, load_pad

SHOWS = 4.0
"""Standard deviations of noise above zero from which on a reading is one."""


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


class Showing(NamedTuple):
    """A footprint of what rises above the noise; a port that takes a mask takes it as it is.

    ``level`` is what its cells reach, in the image's unit. ``rise`` is how far the largest reading
    rises, in what noise reaches: 1 is on the edge, 0 where nothing shows. In a twentieth of frames
    of 256 untouched cells one comes to 1.0, as the noise is told by few of them.
    """

    mask: Mask
    level: float
    rise: float


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
        """Return the footprint, its level, and how far it rises.

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
        if isinstance(found.least, float):
            most = float(found.above[found.shows].max()) if mask.count else 0.0
            rise = most / max(found.least, TINY)
            return Showing(mask, found.zero + found.least, min(rise, MOST_RISE))
        level = found.zero + float(np.max(found.least))
        with np.errstate(over="ignore"):
            rises = found.above[found.shows] / np.maximum(found.least[found.shows], TINY)
        return Showing(mask, level, min(float(rises.max(initial=0.0)), MOST_RISE))
