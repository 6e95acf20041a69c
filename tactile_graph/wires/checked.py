"""What frames are made of as people hand it in, and what of it makes none."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import shown
from tactile_graph.quantities import checked_quantity
from tactile_graph.wires.image import Image

LARGEST = 1e100
"""Beyond this, what a sensor gave is no reading."""
PITCHES_CM = (1e-6, 1e6)
"""The least and the greatest pitch of a frame."""
FARTHEST_CM = 1e9
"""Of a frame's origin; beyond it, places on the frame could not be told apart."""


def checked_image(image: Image) -> Image:
    """Return the image, or one that is right where `Frame.of` would make it so.

    Cells that are no reading become invalid; those that are invalid hold 0.

    Raises
    ------
    ValueError
        As of `Frame.of`, and if ``valid`` is no bool for each cell.
    """
    values, valid = image.values, image.valid
    if values.dtype.kind not in "biuf":
        raise ValueError(f"a frame takes real numbers, got {values.dtype.name}")
    if valid is not None and (valid.shape != values.shape or valid.dtype != np.bool_):
        got = f"{valid.dtype.name} of shape {valid.shape}"
        raise ValueError(f"valid must be a bool for each cell, shape {values.shape}, got {got}")
    pitch, origin = checked_pitch(image.pitch_cm), checked_origin(image.origin_cm)
    quantity = checked_name(image.quantity)
    size = np.abs(values.astype(np.float64, copy=False))
    placed = _is(image.pitch_cm, pitch) and _is(image.origin_cm, origin)
    if placed and valid is None and _are_readings(size):  # as nearly all are: the shortest way
        return image
    good = size <= LARGEST
    if not good.all():
        valid = good if valid is None else good & valid
    empty = size < 1.0 / LARGEST if valid is None else (size < 1.0 / LARGEST) | ~valid
    if size[empty].any():
        values = values.copy()
        values[empty] = 0
    elif placed:
        return image
    return Image(values, pitch, origin, quantity, valid)


def _are_readings(size: NDArray[np.float64]) -> bool:
    """Return whether no size is too large, or so small that it is next to nothing, or NaN."""
    n_small = np.count_nonzero(size < 1.0 / LARGEST)
    return bool(size.max(initial=0.0) <= LARGEST) and n_small + np.count_nonzero(size) == size.size


def _is(given: object, pair: tuple[float, float]) -> bool:
    return isinstance(given, tuple) and given == pair


def checked_pitch(pitch_cm: Any) -> tuple[float, float]:
    """Return a pitch along x and y; it may be given as one number for both.

    Raises
    ------
    ValueError
        If it is no length, or none that a pad has.
    """
    try:
        x, y = pitch_cm if isinstance(pitch_cm, tuple) else np.broadcast_to(pitch_cm, 2)
        if isinstance(x, str) or isinstance(y, str):
            raise TypeError
        x, y = float(x), float(y)
    except (TypeError, ValueError):
        told = f"a pitch is one number or two, of cm along x and y, got {shown(pitch_cm)}"
        raise ValueError(told) from None
    if not (x > 0.0 and y > 0.0):
        raise ValueError(f"a pitch must be > 0 cm, got {pitch_cm}")
    low, high = PITCHES_CM
    if not (low <= x <= high and low <= y <= high):
        raise ValueError(f"a pitch must be within {low:g} to {high:g} cm, got {pitch_cm}")
    return x, y


def checked_origin(origin_cm: Any) -> tuple[float, float]:
    """Return an origin.

    Raises
    ------
    ValueError
        If it is no place, or too far away.
    """
    try:
        x, y = origin_cm
        near = abs(x) <= FARTHEST_CM and abs(y) <= FARTHEST_CM
    except (TypeError, ValueError):
        told = f"an origin is two numbers, of cm along x and y, got {shown(origin_cm)}"
        raise ValueError(told) from None
    if not near:
        raise ValueError(f"an origin must be within {FARTHEST_CM:g} cm, got {origin_cm} cm")
    return origin_cm if isinstance(origin_cm, tuple) else (float(x), float(y))


def checked_name(quantity: Any) -> str:
    """Return the name of a quantity.

    Raises
    ------
    ValueError
        If nobody knows it.
    """
    if not isinstance(quantity, str):
        raise ValueError(f"a quantity is named by a text, got {shown(quantity)}")
    return checked_quantity(quantity)


def check_place_in_time(rest: Mapping[str, Any]) -> None:
    """Check a frame's index, times and label.

    Parameters
    ----------
    rest : mapping
        Of those that are given.

    Raises
    ------
    ValueError
        If one is not what it must be.
    """
    for name in ("time_s", "device_time_s"):
        time_s = rest.get(name)
        try:
            finite = time_s is None or isfinite(time_s)
        except TypeError:
            told = f"{name} must be a number of seconds, got {shown(time_s)}"
            raise ValueError(told) from None
        if not finite:
            raise ValueError(f"{name} must be finite, got {time_s}")
    index = rest.get("index", 0)
    if not isinstance(index, int | np.integer):
        raise ValueError(f"an index must be a whole number, got {shown(index)}")
    if index < 0:
        raise ValueError(f"an index counts from 0, got {index}")
    label = rest.get("label", "")
    if not isinstance(label, str):
        raise ValueError(f"a label must be a text, got {shown(label)}")
