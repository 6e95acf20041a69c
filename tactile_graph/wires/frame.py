"""``Frame``: one image of a pad in time, and, if known, what truly lay there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import shown
from tactile_graph.wires.checked import (
    LARGEST,
    check_place_in_time,
    checked_name,
    checked_origin,
    checked_pitch,
)
from tactile_graph.wires.image import Image, Mask
from tactile_graph.wires.measure import Measured
from tactile_graph.wires.shapes import Shape, check_true, longer_side_first


@dataclass(frozen=True, slots=True)
class TrueObject:
    """An object that truly lay on the pad when the frame was taken.

    Its shape may be a plugin's own, which says by ``error_measures`` how it is measured. A
    rectangle or ellipse given with its shorter side first is turned by a quarter: it is the same
    shape, and answers are held against its longer side.

    Raises
    ------
    ValueError
        If its place or size is no finite number, or a size is less than 0.
    """

    shape: Shape | Measured
    weight_g: float | None = None
    name: str = ""

    def __post_init__(self) -> None:
        check_true(self.shape)
        object.__setattr__(self, "shape", longer_side_first(self.shape))


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """One image with its place in time.

    Parameters
    ----------
    image : Image
        Taken as it is: a cell that is no number must be invalid, as `of` makes it.
    index : int
        Number of the frame in its source, from 0.
    time_s : float
        When it was taken, in the source's own clock; None where the source keeps none.
    truth : tuple of TrueObject, optional
        What truly lay on the pad; None where nobody knows.
    device_time_s : float, optional
        The device's own time stamp, where it sends one.
    gap : bool
        True where frames were lost just before this one.
    label : str
        Which sensor or file the frame comes from, where a source has several.
    doubtful : bool
        True where the source cannot tell whether the values lie where they belong.
    mask : Mask, optional
        The cells of the contact whose image it is, where a pipeline runs for each contact; None for
        a frame that is whole.
    place : int, optional
        Which frame of its recording it is, from 0, where those that were left out count as well;
        None where the source leaves none out, and ``index`` says it.
    own_number : int, optional
        The number that the recording itself gives it.
    state_of : str, optional
        The sensor or file whose state steps go on with, where the label is what somebody said of
        that moment; None where the label is that sensor or file.
    """

    image: Image
    index: int = 0
    time_s: float | None = None
    truth: tuple[TrueObject, ...] | None = None
    device_time_s: float | None = None
    gap: bool = False
    label: str = ""
    doubtful: bool = False
    mask: Mask | None = None
    place: int | None = None
    own_number: int | None = None
    state_of: str | None = None
    provides: ClassVar[Mapping[type, str]] = {Image: "image"}
    columns_shown: ClassVar[tuple[str, ...]] = ()  # every table has what tells frames apart

    @classmethod
    def of(
        cls,
        values: NDArray[Any],
        pitch_cm: float | tuple[float, float] = 1.0,
        origin_cm: tuple[float, float] = (0.0, 0.0),
        quantity: str = "raw",
        **rest: Any,
    ) -> Frame:
        """Return a frame around a copy of ``values``, shape (rows, columns).

        Cells that are NaN, pandas' NA, infinite, beyond 1e100 or masked (of a NumPy masked array)
        become invalid and hold 0; squares of larger ones are no numbers any more. Those nearer to 0
        than 1e-100 hold 0 for the same reason.

        Raises
        ------
        ValueError
            If values are no real numbers, an image, or have no rows and columns, the pitch is not
            within 1e-6 to 1e6 cm, the origin not within 1e9 cm, a time not finite, the index no
            whole number from 0 on, the label no text, the truth no tuple of `TrueObject`, or nobody
            knows the quantity.
        """
        copy = _real(values)
        if copy.ndim != 2 or 0 in copy.shape:
            raise ValueError(f"a frame takes values of shape (rows, columns), got {copy.shape}")
        size = np.abs(copy)
        finite = size <= LARGEST
        valid = None if finite.all() else finite
        if valid is not None:
            copy[~valid] = 0.0  # a NaN left in place would spread through the first sum
        copy[size < 1.0 / LARGEST] = 0.0
        pitch, origin = checked_pitch(pitch_cm), checked_origin(origin_cm)
        check_place_in_time(rest)
        if rest.get("truth") is not None:
            rest["truth"] = _objects(rest["truth"])
        return cls(Image(copy, pitch, origin, checked_name(quantity), valid), **rest)

    def with_index(self, index: int) -> Frame:
        """Return the same frame under another number."""
        return replace(self, index=index)

    def numbered(self, index: int, n_places: int = 0) -> Frame:
        """Return the same frame under another number, behind so many more places."""
        if index == self.index and not (n_places and self.place is not None):
            return self
        place = None if self.place is None else self.place + n_places
        return replace(self, index=index, place=place)

    def _repr_html_(self) -> str:
        from tactile_graph.wires.notebook import frame_html

        return frame_html(self)


def _objects(truth: Any) -> tuple[TrueObject, ...]:
    """Return what truly lay on the pad; errors as of `Frame.of`."""
    listed = isinstance(truth, list | tuple)
    for one in truth if listed else (truth,):
        if not (listed and isinstance(one, TrueObject)):
            hint = "(TrueObject(…),)" if isinstance(one, TrueObject) else "TrueObject(shape)"
            raise ValueError(f"truth is a tuple of TrueObject, got {shown(one)}; give {hint}")
    return tuple(truth)


def _real(values: NDArray[Any]) -> NDArray[np.float64]:
    """Return a copy as float64, NaN in masked cells; errors as of `Frame.of`."""
    if isinstance(values, Image):
        raise ValueError("a frame takes bare values, got an Image; write Frame(image)")
    if isinstance(values, Mask):
        raise ValueError("a frame takes bare values, got a Mask; take its .values")
    if isinstance(values, list | tuple) and any(isinstance(r, np.ma.MaskedArray) for r in values):
        values = np.ma.array(values)
    given = np.asarray(values)
    if given.dtype.kind == "O" and given.size:  # pandas' word for a missing number is none
        given = np.frompyfunc(lambda x: np.nan if type(x).__name__ == "NAType" else x, 1, 1)(given)
    if given.dtype.kind not in "biufO" or (given.dtype.kind == "O" and np.iscomplexobj(given)):
        raise ValueError(f"a frame takes real numbers, got {given.dtype.name}")
    try:
        with np.errstate(over="ignore"):  # of a longer float than this: it becomes invalid
            copy = np.array(given, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(f"a frame takes real numbers: {error}") from None
    if isinstance(values, np.ma.MaskedArray):
        copy[np.ma.getmaskarray(values)] = np.nan
    return copy
