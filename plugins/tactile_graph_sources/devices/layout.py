"""A packet's layout, compiled into arrays: what must be where, and where the values are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph_sources.devices.checksums import VARIANTS, crc16
from tactile_graph_sources.devices.preset import (
    DTYPES,
    Cells,
    Checksum,
    Magic,
    Packet,
    Part,
    Preset,
    Skip,
    Value,
    unit_cells,
)
from tactile_graph_sources.devices.units import Units

ENOUGH_BITS = 24
"""Fixed bits that must follow a unit without a checksum: of a million frames, one in fifty hurt,
chance lets one in 800 such runs pass a wrong one."""
TAG_ROWS_AHEAD = 2
"""Rows of the next frame whose tags are looked at: one row of zeros mimics tag 0 when shifted."""


@dataclass(frozen=True)
class Place:
    """A number's place in a unit."""

    offset: int
    dtype: np.dtype[Any]
    value: Value

    def read(self, units: NDArray[np.uint8]) -> NDArray[Any]:
        """Return the number of each unit."""
        raw = units[:, self.offset : self.offset + self.dtype.itemsize]
        out: NDArray[Any] = np.ascontiguousarray(raw).view(self.dtype)[:, 0]
        return out


class Layout:
    """Where everything is in a unit of ``size`` bytes.

    A trailer without a header is moved to the front: the trailer of one unit is then the header
    of the next, so that one rule, the header look-ahead, serves both.
    """

    def __init__(self, preset: Preset) -> None:
        assert isinstance(preset.framer, Packet)
        self.parts = _trailer_first(preset.framer.layout)
        self.n_cells = unit_cells(preset)
        self.row_length = preset.geometry.columns
        by_row = preset.assembler == "rows"
        self.n_starts = preset.geometry.rows if by_row else preset.geometry.n_cells
        self.places: dict[str, Place] = {}
        self.crc: tuple[int, Checksum] | None = None
        self.mask = np.zeros(0, dtype=np.uint8)
        want: list[NDArray[np.uint8]] = []
        masks: list[NDArray[np.uint8]] = []
        offset = 0
        for part in self.parts:
            bytes_want, bytes_mask = self._part(part, offset, preset)
            want.append(bytes_want)
            masks.append(bytes_mask)
            offset += len(bytes_want)
        self.size = offset
        self.mask, self.want = np.concatenate(masks), np.concatenate(want)
        self.at = np.flatnonzero(self.mask)
        self.anchor = self._anchor()
        self.ahead = 0 if self.crc else self._ahead()
        # From the last on: tags of later rows are rarer among values than the first row's, 0.
        self.at_ahead = self.at[self.at < self.ahead][::-1]
        self.in_pieces = preset.assembler != "full"
        self.starts_ahead = self._starts_ahead()
        self.n_follow = self._n_follow()
        self.valid_range = preset.geometry.valid_range

    def _part(
        self, part: Part, offset: int, preset: Preset
    ) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
        """Note where a part is; return the bytes it must hold and the bits that are fixed."""
        if isinstance(part, Magic):
            return np.frombuffer(part.bytes, np.uint8), np.full(len(part.bytes), 255, np.uint8)
        if isinstance(part, Skip):
            return _free(part.size)
        if isinstance(part, Checksum):
            self.crc = (offset, part)
            return _free(2)
        dtype = np.dtype(DTYPES[part.type])
        if isinstance(part, Cells):
            self.cells_at, self.cells_dtype, self.cells = offset, dtype, part
            return self._tags(part, dtype, preset)
        self.places[part.part] = Place(offset, dtype, part)
        if part.equals is None:
            return _free(dtype.itemsize)
        fixed = np.array([part.equals], dtype=dtype).view(np.uint8)
        return fixed, np.full(len(fixed), 255, np.uint8)

    def _tags(
        self, part: Cells, dtype: np.dtype[Any], preset: Preset
    ) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
        if not part.row_tag:
            return _free(self.n_cells * dtype.itemsize)
        bits = 8 * dtype.itemsize - 4
        row = np.arange(self.n_cells) // preset.geometry.columns
        tags = ((row & 15) << bits).astype(dtype)
        return tags.view(np.uint8), np.full(self.n_cells, 15 << bits, dtype).view(np.uint8)

    def _anchor(self) -> bytes:
        """The fixed bytes a unit starts with; what the search looks for."""
        full = self.mask == 255
        n = len(full) if full.all() else int(np.argmin(full))
        return self.want[:n].tobytes()

    def _ahead(self) -> int:
        """How much of the next unit is looked at: its header, two rows of tags, or all of it."""
        if len(self.anchor) >= 2:
            return len(self.anchor)
        if self.cells.row_tag:
            row = self.row_length * self.cells_dtype.itemsize
            return min(self.size, self.cells_at + TAG_ROWS_AHEAD * row)
        return int(self.at[-1]) + 1 if len(self.at) else 0

    def _n_follow(self) -> int:
        """How many units must follow a good one; chance gets each past with 2 to the -bits.

        Pieces of a frame must besides come in order, which vouches for them.
        """
        if not self.ahead or self.in_pieces:
            return 1
        bits = int(np.unpackbits(self.mask[self.at_ahead]).sum())
        return -(-ENOUGH_BITS // bits)

    def _starts_ahead(self) -> Place | None:
        """Where the number of the next piece is in what is looked at of it, if it is there."""
        start = self.places.get("start")
        if not self.in_pieces or start is None:
            return None
        return start if start.offset + start.dtype.itemsize <= self.ahead else None

    def in_order(self, units: NDArray[np.uint8], heads: NDArray[np.uint8]) -> NDArray[np.bool_]:
        """Return which pieces, shape (k, size), have the next one's beginning behind them.

        A cut from the middle of a frame's last piece to that of another one leaves no other trace.
        """
        if self.starts_ahead is None:
            return np.ones(len(units), dtype=np.bool_)
        step = self.cells.count or 1
        here = self.starts_ahead.read(units).astype(np.int64) - self.starts_ahead.value.first
        there = self.starts_ahead.read(heads).astype(np.int64) - self.starts_ahead.value.first
        return np.asarray(there == (here + step) % self.n_starts)

    def ok(self, units: NDArray[np.uint8]) -> NDArray[np.bool_]:
        """Return which units, shape (k, size), hold what they must, checksum apart."""
        if len(self.at) == 0:
            good = np.ones(len(units), dtype=np.bool_)
        else:
            good = ((units[:, self.at] & self.mask[self.at]) == self.want[self.at]).all(axis=1)
        start = self.places.get("start")
        if start is not None:
            number = start.read(units).astype(np.int64) - start.value.first
            good &= (number >= 0) & (number < self.n_starts)
        return good

    def in_range(self, units: NDArray[np.uint8]) -> NDArray[np.bool_]:
        """Return which units hold no value outside the range that the preset allows."""
        if self.valid_range is None:
            return np.ones(len(units), dtype=np.bool_)
        low, high = self.valid_range
        cells = self.values(units)
        return np.asarray(((cells >= low) & (cells <= high)).all(axis=1))

    def ahead_ok(self, heads: NDArray[np.uint8]) -> NDArray[np.bool_]:
        """Return which beginnings, shape (k, >= ahead), look like a unit's."""
        at = self.at_ahead
        good: NDArray[np.bool_] = ((heads[:, at] & self.mask[at]) == self.want[at]).all(axis=1)
        return good

    def like_tags(self, units: NDArray[np.uint8]) -> NDArray[np.bool_]:
        """Return which units, shape (k, size), have tag-like bytes where values are.

        A phase off by an odd number of bytes takes low bytes for high ones. For it to fit, those
        of the first column must count up from row to row.
        """
        width = self.cells_dtype.itemsize
        row = self.row_length * width
        low = units[:, self.cells_at + width - 1 :: row] >> 4
        ups = (low[:, 1:] - low[:, :-1]) & 15 == 1
        return np.asarray(np.count_nonzero(ups, axis=1) >= low.shape[1] - 3)

    def count_of_headers(self, array: NDArray[np.uint8]) -> int:
        """Return how often the header occurs."""
        n = len(array) - len(self.anchor) + 1
        last = len(self.anchor) - 1
        fits = array[last : last + n] == self.anchor[last]
        if last:
            fits &= array[last - 1 : last - 1 + n] == self.anchor[last - 1]
        if last < 2:
            return int(np.count_nonzero(fits))
        places = np.flatnonzero(fits)
        for i in range(last - 1):
            places = places[array[places + i] == self.anchor[i]]
        return len(places)

    def beginnings(self, array: NDArray[np.uint8], start: int, stop: int) -> NDArray[np.int64]:
        """Return the places from ``start`` to ``stop`` of a stream that look like beginnings."""
        first, *others = self.at_ahead.tolist()
        fits = (array[start + first : stop + first] & self.mask[first]) == self.want[first]
        places = start + np.flatnonzero(fits)
        for at in others:
            places = places[(array[places + at] & self.mask[at]) == self.want[at]]
            if len(places) == 0:
                break
        return places

    def checksum_ok(self, units: NDArray[np.uint8]) -> NDArray[np.bool_]:
        """Return which units carry the right checksum; all where there is none."""
        if self.crc is None:
            return np.ones(len(units), dtype=np.bool_)
        offset, part = self.crc
        sent = _crc_field(units, offset, part)
        return np.asarray(sent == crc16(units[:, part.after : offset], part.variant))

    def matching_variants(self, unit: NDArray[np.uint8]) -> list[str]:
        """Return the checksum variants (and orders) that would fit a unit, for a hint."""
        if self.crc is None:
            return []
        offset, part = self.crc
        found = []
        for variant in VARIANTS:
            for after in range(3):
                got = crc16(unit[None, after:offset], variant)
                for order in ("be", "le"):
                    tried = part.model_copy(update={"order": order})
                    if got[0] == _crc_field(unit[None, :], offset, tried)[0]:
                        found.append(f"variant: {variant}, order: {order}, after: {after}")
        return found

    def units(self, rows: NDArray[np.uint8], end: int, broken: bool) -> Units:
        """Return good units; ``end`` is the stream place just after the last of them."""
        ends = end - self.size * np.arange(len(rows) - 1, -1, -1, dtype=np.int64)
        if not self.places:
            return Units(self.values(rows), ends, broken)

        def read(name: str) -> NDArray[np.int64] | None:
            place = self.places.get(name)
            return None if place is None else place.read(rows).astype(np.int64) - place.value.first

        return Units(
            self.values(rows),
            ends,
            broken,
            time=read("time"),
            sequence=read("sequence"),
            start=read("start"),
            device=read("device"),
        )

    def values(self, units: NDArray[np.uint8]) -> NDArray[Any]:
        """Return the cells of each unit, shape (k, m)."""
        size = self.n_cells * self.cells_dtype.itemsize
        raw = np.ascontiguousarray(units[:, self.cells_at : self.cells_at + size])
        cells: NDArray[Any] = raw.view(self.cells_dtype)
        if self.cells.mask is not None:
            cells = np.bitwise_and(cells, self.cells_dtype.type(self.cells.mask))
        return cells


def _free(size: int) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    return np.zeros(size, np.uint8), np.zeros(size, np.uint8)


def _crc_field(units: NDArray[np.uint8], offset: int, part: Checksum) -> NDArray[np.uint16]:
    raw = units[:, offset : offset + 2].astype(np.uint16)
    high, low = (0, 1) if part.order == "be" else (1, 0)
    return np.asarray((raw[:, high] << 8) | raw[:, low], dtype=np.uint16)


def _trailer_first(parts: tuple[Part, ...]) -> tuple[Part, ...]:
    has_crc = any(isinstance(p, Checksum) for p in parts)
    if not has_crc and isinstance(parts[-1], Magic) and not isinstance(parts[0], Magic):
        return (parts[-1], *parts[:-1])
    return parts
