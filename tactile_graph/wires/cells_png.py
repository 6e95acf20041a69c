"""A grid of values as a small PNG to put into a page, one pixel a cell."""

from __future__ import annotations

import base64
import struct
import zlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Colour = tuple[int, int, int]
Palette = NDArray[np.uint8]

MASK_ON, MASK_OFF = "#37474f", "#eceff1"
LEVELS = 64
_HEAT: Sequence[Colour] = (
    (68, 1, 84), (70, 50, 127), (54, 92, 141), (39, 127, 142), (31, 161, 135), (74, 194, 109),
    (159, 218, 58), (253, 231, 37),
)  # fmt: skip
_PALE: Sequence[Colour] = ((255, 255, 255), (205, 210, 216), (176, 183, 192))
_TWO_WAYS: Sequence[Colour] = (
    (5, 80, 160), (85, 155, 205), (190, 215, 235), (245, 245, 245), (250, 210, 180), (235, 135, 75),
    (165, 60, 0),
)  # fmt: skip
BROKEN: Colour = (120, 120, 120)


def _ramp(stops: Sequence[Colour]) -> Palette:
    """Return ``LEVELS`` colours between the stops, and that of a cell without a value."""
    at = np.linspace(0.0, len(stops) - 1.0, LEVELS)
    known = np.array(stops, dtype=np.float64)
    mixed = [np.interp(at, np.arange(len(stops)), known[:, i]) for i in range(3)]
    return np.vstack([np.rint(np.stack(mixed, axis=1)), [BROKEN]]).astype(np.uint8)


HEAT, PALE, TWO_WAYS = _ramp(_HEAT), _ramp(_PALE), _ramp(_TWO_WAYS)
YES_NO: Palette = np.array([list(bytes.fromhex(c[1:])) for c in (MASK_OFF, MASK_ON)], np.uint8)


def heat_stops() -> list[str]:
    """Return the colours of the heat map from low to high, as CSS takes them."""
    return [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in _HEAT]


def levels(
    values: NDArray[np.floating], low: float, high: float, valid: NDArray[np.bool_] | None = None
) -> NDArray[np.uint8]:
    """Return each cell's place in a ramp from ``low`` to ``high``; unknown cells beyond it."""
    known = np.isfinite(values) if valid is None else np.isfinite(values) & valid
    span = high - low if high > low else 1.0
    share = np.clip((np.where(known, values, low) - low) / span, 0.0, 1.0)
    return np.where(known, np.rint(share * (LEVELS - 1)), LEVELS).astype(np.uint8)


def data_uri(cells: NDArray[np.uint8], palette: Palette) -> str:
    """Return cells, each a row of the palette, as a PNG to put into ``href``."""
    used, places = np.unique(cells, return_inverse=True)
    png = _png(places.reshape(cells.shape).astype(np.uint8), palette[used])
    return "data:image/png;base64," + base64.b64encode(png).decode()


def _png(cells: NDArray[np.uint8], palette: Palette) -> bytes:
    rows, columns = cells.shape
    depth = 1 if len(palette) <= 2 else 4 if len(palette) <= 16 else 8
    bits = np.unpackbits(cells[:, :, None], axis=2)[:, :, 8 - depth :].reshape(rows, -1)
    lines = np.packbits(bits, axis=1)
    raw = np.hstack([np.zeros((rows, 1), np.uint8), lines]).tobytes()
    head = struct.pack(">IIBBBBB", columns, rows, depth, 3, 0, 0, 0)
    parts = (
        (b"IHDR", head),
        (b"PLTE", palette.tobytes()),
        (b"IDAT", zlib.compress(raw, 9)),
        (b"IEND", b""),
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(k, d) for k, d in parts)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
