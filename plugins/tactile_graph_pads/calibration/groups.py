"""Observations out of recordings: which elements bore the load, and what they read."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.wires import Frame, Image
from tactile_graph_pads.calibration.points import Observation
from tactile_graph_pads.pad import Pad
from tactile_graph_pads.same_pad import check_same_pad

Array = NDArray[np.float64]
LEAST_SHARE = 0.5
"""Of what all elements read, so much must come from the group, or the load lies elsewhere too."""
_NOTHING = 0.02


class _Reading(NamedTuple):
    load_g: float
    place: tuple[int, int, str]
    values: Array
    source: str


@dataclass(frozen=True, eq=False)
class Empty:
    """What the empty pad reads, as recorded.

    Parameters
    ----------
    image : Image
        The median of each element; none is missing.
    source : str
        The recording, for errors.
    """

    image: Image
    source: str


def empty_of(frames: Sequence[Frame], source: str) -> Empty:
    """Return the median of each element over the frames in which it was read.

    Raises
    ------
    DataError
        If there is no frame, or an element was read in none.
    """
    if not frames:
        raise DataError(source, "holds no frame")
    first = frames[0].image
    read = np.stack([np.asarray(f.image.values, dtype=np.float64) for f in frames])
    for values, frame in zip(read, frames, strict=True):
        if frame.image.valid is not None:
            values[~frame.image.valid] = np.nan
    missing = np.isnan(read).all(axis=0)
    if missing.any():
        row, column = np.argwhere(missing)[0].tolist()
        n = int(missing.sum())
        which = "1 element is" if n == 1 else f"{n} elements are"
        raise DataError(
            source,
            f"{which} missing in all {len(frames)} frames of the empty pad, first row {row}, "
            f"column {column}: what is to be taken off there is not known; record the empty pad "
            "again with every element read",
        )
    middle = np.nanmedian(read, axis=0)
    return Empty(Image(middle, first.pitch_cm, first.origin_cm, first.quantity), source)


@dataclass(frozen=True)
class GroupReader:
    """Reads the loaded group of elements out of frames.

    Parameters
    ----------
    group : (int, int), optional
        Rows and columns of elements that are loaded together; None for the whole pad.
    at : (int, int), optional
        Row and column of the group's top left element; found in each frame if not given.
    pad : Pad, optional
        Its converter turns counts into volts, its circuit decouples.
    decouple : bool
        Whether the circuit's crosstalk is taken out.
    full_scale : float, optional
        The reading at and above which an element is saturated, as recorded; a pad's converter
        says it.
    empty : Empty, optional
        What the empty pad reads.
    """

    group: tuple[int, int] | None = (2, 2)
    at: tuple[int, int] | None = None
    pad: Pad | None = None
    decouple: bool = False
    full_scale: float | None = None
    empty: Empty | None = None

    def observations(
        self, frames: Iterable[Frame], load_g: float | None, source: str
    ) -> Iterator[Observation]:
        """Yield one observation for each placement: frames in a row alike in load and place.

        Parameters
        ----------
        frames : iterable of Frame
        load_g : float, optional
            What lies on the group in all; each frame's truth says it if not given. Frames whose
            truth is an empty pad are left out.
        source : str
            The recording, for errors.

        Raises
        ------
        DataError
            If a frame has no known load, reads nothing, is saturated, or is loaded elsewhere too.
        """
        held: list[_Reading] = []
        for frame in frames:
            where = f"{source}, frame {frame.index}"
            total_g = _true_load_g(frame, where) if load_g is None else load_g
            if total_g == 0.0 and load_g is None:
                continue
            seen = self._read(frame, total_g, where)
            if held and (seen.load_g, seen.place) != (held[0].load_g, held[0].place):
                yield _mean(held)
                held = []
            held.append(seen)
        if held:
            yield _mean(held)

    def _read(self, frame: Frame, total_g: float, where: str) -> _Reading:
        image = frame.image
        if image.valid is not None and not image.valid.all():
            raise DataError(where, f"{int((~image.valid).sum())} elements are missing")
        recorded = np.asarray(image.values, dtype=np.float64)
        quantity = self.recorded_as(image.quantity)
        values = self._as_read(recorded, quantity, where)
        if self.empty is not None and self.offset is not None:
            rest = self.empty
            check_same_pad(
                rest.image, image, rest.source, where, read_as=self.read_as, pitch_known=False
            )
            values = values - self.offset
        corner = self._corner(values, where)
        rows, columns = self.group or values.shape
        block = (slice(corner[0], corner[0] + rows), slice(corner[1], corner[1] + columns))
        if not values[block].mean() > 0.0:
            got = f"{values[block].mean():.4g} on average"
            raise DataError(where, f"{total_g:g} g read nothing ({got}): did the load lie there?")
        self._check_saturated(recorded[block], quantity, total_g, where)
        # the same elements under an object put down anew are another placement
        place = (*corner, repr(frame.truth))
        return _Reading(total_g / (rows * columns), place, values[block].ravel(), where)

    def recorded_as(self, quantity: str) -> str:
        """Return what recorded values are: where a pad is named, its counts if nothing says."""
        return "counts" if quantity == "raw" and self.pad is not None else quantity

    def read_as(self, quantity: str) -> str:
        """Return the quantity that the curve is to read, of recordings in one."""
        recorded = self.recorded_as(quantity)
        if self.pad is None or recorded not in ("counts", "volt"):
            return recorded
        return "siemens" if self.decouple else "volt"

    @cached_property
    def offset(self) -> Array | None:
        """What each element of the empty pad reads, in what the curve is to read."""
        if self.empty is None:
            return None
        values = np.asarray(self.empty.image.values, dtype=np.float64)
        quantity = self.recorded_as(self.empty.image.quantity)
        return self._as_read(values, quantity, self.empty.source)

    def _as_read(self, recorded: Array, quantity: str, where: str) -> Array:
        """Return what the curve is to read: volts where a pad is known, else as recorded."""
        if self.pad is None or quantity not in ("counts", "volt"):
            if self.decouple:
                raise DataError(where, f"only counts and volts can be decoupled, got {quantity}")
            return recorded
        return self._to_read(recorded, quantity, where)

    def _to_read(self, recorded: Array, quantity: str, where: str) -> Array:
        assert self.pad is not None
        volts = self.pad.converter.volts(recorded) if quantity == "counts" else recorded
        if not self.decouple:
            return volts
        found = self.pad.circuit.inverse(volts / self.pad.circuit.supply_v)
        if not found.valid.all() or found.residual > 1e-3:
            raise DataError(
                where,
                f"is impossible for the pad's {self.pad.circuit.kind} circuit: saturated, or "
                "another circuit's volts",
            )
        return found.siemens

    def _corner(self, values: Array, where: str) -> tuple[int, int]:
        if self.group is None:
            return (0, 0)
        rows, columns = self.group
        if rows > values.shape[0] or columns > values.shape[1]:
            raise DataError(where, f"a group of {rows}x{columns} is larger than {values.shape}")
        loud = np.where(values > _NOTHING * values.max(), np.maximum(values, 0.0), 0.0)
        sums = sliding_window_view(loud, self.group).sum(axis=(2, 3))
        if self.at is None:
            row, column = divmod(int(sums.argmax()), sums.shape[1])
        else:
            row, column = self.at
            if row >= sums.shape[0] or column >= sums.shape[1]:
                raise DataError(where, f"a group at {self.at} reaches over the edge of the pad")
        share = sums[row, column] / loud.sum() if loud.any() else 1.0
        if share < LEAST_SHARE:
            raise DataError(
                where,
                f"the load is not on one group: the {rows}x{columns} elements from row {row}, "
                f"column {column} on hold {100 * share:.0f} % of all readings, at least "
                f"{100 * LEAST_SHARE:.0f} % are needed; say how many elements are loaded "
                "together, name the pad, or take off what the empty pad reads",
            )
        return row, column

    def _check_saturated(self, recorded: Array, quantity: str, total_g: float, where: str) -> None:
        top, slack = self.full_scale, 0.0
        if top is None and self.pad is not None and self.pad.converter.bits is not None:
            converter = self.pad.converter
            top, slack = (
                (converter.max_v, 0.5 * converter.step_v)
                if quantity == "volt"
                else (2.0**self.pad.converter.bits - 1.0, 0.5)
            )
        # noise around full scale is cut off on one side, so the mean lies a little below it
        if top is not None and recorded.max() >= top - slack:
            raise DataError(
                where,
                f"saturated: under {total_g:g} g an element reads {recorded.max():.5g}, and "
                f"{top:.5g} is all it can; leave this load out",
            )


def _true_load_g(frame: Frame, where: str) -> float:
    if frame.truth is None:
        raise DataError(
            where, "has no known load: give it as FILE=GRAMS, or a recording that holds the truth"
        )
    if len(frame.truth) > 1:
        raise DataError(where, f"holds {len(frame.truth)} objects, a calibration takes one")
    weights = [thing.weight_g for thing in frame.truth]
    if None in weights:
        raise DataError(where, "its object has no known weight")
    return float(sum(w for w in weights if w is not None))


def _mean(held: list[_Reading]) -> Observation:
    values = np.mean([seen.values for seen in held], axis=0)
    return Observation(held[0].load_g, values, held[0].source)
