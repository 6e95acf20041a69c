"""What recordings have taught about a pad, applied to its images and to what is found in them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import RuleError
from tactile_graph.wires import Image
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.posterior import Posterior
from tactile_graph_pads.learned import Learned
from tactile_graph_pads.learning.place import PlaceCorrection, read_place
from tactile_graph_pads.pad import Pad

Found = TypeVar("Found", bound=Posterior)


LAWFUL = ("volt", "siemens", "gram")
"""Quantities of readings with a law: by it an outline is placed better than by a correction, which
was learned for the centroids of contacts."""

LEAST_UNEVEN = 0.3
"""Of a told unevenness, what is left of it at least once elements are evened."""


class Taught(NamedTuple):
    """What is known of an image's elements; arrays have its shape.

    Parameters
    ----------
    offset : ndarray
        In the image's unit; 0 where elements are stuck, whose reading pulls on others.
    gain : ndarray
        By which loads are divided.
    noise : ndarray, optional
        Standard deviation of a reading, in the image's unit.
    least : float
        Reading above the offset from which the pad is touched, in the image's unit.
    good, stuck : ndarray of bool
    """

    offset: Values | float
    gain: Values | float
    noise: Values | None
    least: float
    good: NDArray[np.bool_]
    stuck: NDArray[np.bool_]


PAD_HINT = "the pad says nothing of other readings: leave it out, or say what the values are"


def taught(pad: Pad, image: Image) -> Taught | None:
    """Return what recordings have taught about an image's elements; None of a pad not learned.

    Parameters
    ----------
    pad : Pad
        Its section ``learned`` is asked, if it has one.
    image : Image
        As recorded, or in siemens or grams made of that.

    Raises
    ------
    RuleError
        If the image has another shape or pitch than the pad, or a quantity the pad says nothing
        of.
    """
    learned = pad.learned
    if learned is None:
        return None
    if image.shape != (learned.rows, learned.columns):
        rows, columns = image.shape
        raise RuleError(
            f"the pad was learned with {learned.rows} x {learned.columns} elements, got "
            f"{rows} x {columns}: take the pad that was learned from such recordings, or none"
        )
    learned.require_pitch(image)
    known = known_quantities(pad)
    if image.quantity not in known:
        raise RuleError(
            f"the pad was learned from readings in {learned.reading}, got {image.quantity}; "
            f"{PAD_HINT}"
        )
    return _of_elements(learned, image.quantity)


def known_quantities(pad: Pad) -> tuple[str, ...]:
    """Return the quantities of images that a learned pad says something of; none of any other."""
    learned = pad.learned
    if learned is None:
        return ()
    known: list[str] = [learned.reading, learned.gain_of or learned.reading]
    if learned.reading in ("volt", "counts"):
        known += ["siemens", "gram"]
    if learned.curve:
        known.append("gram")
    return tuple(dict.fromkeys(known))


def _of_elements(learned: Learned, quantity: str) -> Taught:
    offset, noise, good, stuck = learned.at_rest
    load = "gram" if quantity in LAWFUL else quantity
    gain = learned.table.gain if learned.gain_of == load else 1.0
    if quantity != learned.reading:
        return Taught(0.0, gain, None, 0.0, good, stuck)
    return Taught(offset, gain, noise, learned.touched_from, good, stuck)


def unevenness_left(pad: Pad, sigma: float) -> float:
    """Return what is left of a pad's unevenness once its learned gains are divided by.

    Parameters
    ----------
    pad : Pad
    sigma : float
        Standard deviation of the logarithm of an element's gain, as told.
    """
    learned = pad.learned
    if learned is None or learned.gain_of is None:
        return sigma
    variance = float(np.var(np.log(learned.table.gain[learned.table.good])))
    return max(math.sqrt(max(sigma * sigma - variance, 0.0)), LEAST_UNEVEN * sigma)


class Placing:
    """Posteriors moved to where objects at known places taught that they lie, and as sure.

    Parameters
    ----------
    pad : Pad
        Of one that has learned no correction of place, or whose readings have a law, posteriors
        stay as they are.

    Raises
    ------
    DataError
        If the correction's file cannot be read.
    """

    def __init__(self, pad: Pad) -> None:
        self._pad, self._place = pad, None
        if pad.learned is not None and pad.learned.place and pad.learned.reading not in LAWFUL:
            self._place = read_place(Path(pad.learned.place))

    def __call__(self, image: Image, found: Sequence[Found]) -> list[Found]:
        """Return the posteriors of all objects of an image, each at its corrected place."""
        place, learned = self._place, self._pad.learned
        if place is None or learned is None or image.quantity != learned.reading or not found:
            return [*found]
        its = taught(self._pad, image)
        return [*found] if its is None else _moved(image, found, place, its)


def _moved(
    image: Image, found: Sequence[Found], place: PlaceCorrection, its: Taught
) -> list[Found]:
    good = its.good if image.valid is None else its.good & image.valid
    values = np.where(good, image.filled(0.0) - its.offset, 0.0) / its.gain
    pitch, origin = np.array(image.pitch_cm), np.array(image.origin_cm)
    centres = np.array([its.mean[:2] for its in found])
    new = place.correct(values, good, (centres - origin) / pitch - 0.5)
    places, stds = origin + (new.centres + 0.5) * pitch, new.std_cells * pitch
    return [at(one, to, std) for one, to, std in zip(found, places, stds, strict=True)]


def at(found: Found, centre_cm: Values, std_cm: Values) -> Found:
    """Return a posterior whose centre lies elsewhere and is known as surely as told.

    Parameters
    ----------
    found : Posterior
        Of an outline with a centre.
    centre_cm, std_cm : ndarray, shape (2,)
        Mean and standard deviation of the centre's x and y.
    """
    wider = np.ones(len(found.mean))
    wider[:2] = std_cm / np.array([found.std(0), found.std(1)])
    mean, top = found.mean.copy(), found.most_likely.copy()
    mean[:2] = centre_cm
    top[:2] += centre_cm - found.mean[:2]
    points = mean + (found.points - found.mean) * wider
    covariance = found.covariance * np.outer(wider, wider)
    return replace(found, mean=mean, most_likely=top, points=points, covariance=covariance)
