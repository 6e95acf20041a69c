"""Messages of ROS 1, and of ROS 2 in CDR, without ROS: images of one channel, arrays of numbers.

OMG, DDS-XTypes 1.3, chapter 7.4: numbers are aligned to their own size, counted from behind the
four bytes of the head. ROS 1 writes them little-endian, one behind the other, without a head. The
definitions are those of sensor_msgs and std_msgs, whose header in ROS 1 counts messages, too.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
_ENCODINGS = {
    "mono8": "u1", "8UC1": "u1", "8SC1": "i1", "mono16": "u2", "16UC1": "u2", "16SC1": "i2",
    "32SC1": "i4", "32FC1": "f4", "64FC1": "f8",
}  # fmt: skip
_ARRAYS = {
    "Float32": "f4", "Float64": "f8", "UInt8": "u1", "Int8": "i1", "UInt16": "u2", "Int16": "i2",
    "UInt32": "u4", "Int32": "i4", "UInt64": "u8", "Int64": "i8",
}  # fmt: skip


def decoder_of(encoding: str, schema: str) -> Callable[[bytes], Array] | None:
    """Return what makes an array of a message; None where it is of a type that is not read.

    What it returns raises ValueError at a damaged message.
    """
    cursor = {"cdr": _Cursor, "ros1": _CursorOfRos1}.get(encoding)
    package, _, name = schema.partition("/msg/" if encoding == "cdr" else "/")
    if cursor is None:
        return None
    if (package, name) == ("sensor_msgs", "Image"):
        return lambda data: _image(cursor(data))
    kind = _ARRAYS.get(name.removesuffix("MultiArray")) if name.endswith("MultiArray") else None
    if package != "std_msgs" or kind is None:
        return None
    return lambda data: _multi_array(cursor(data), kind)


class _Cursor:
    """Reads one value after the other."""

    header_size = 2
    """Numbers of a header before its text: second, nanosecond."""

    def __init__(self, data: bytes) -> None:
        if len(data) < 4:
            raise ValueError("it is cut off")
        self._data = memoryview(data)[4:]
        self._order = "<" if data[1] & 1 else ">"
        self._at = 0

    def uint32(self) -> int:
        value: int = struct.unpack(f"{self._order}I", self._taken(4, 4))[0]
        return value

    def uint8(self) -> int:
        return self._taken(1, 1)[0]

    def text(self) -> str:
        return bytes(self._taken(self.uint32(), 1)).rstrip(b"\0").decode("utf-8", "replace")

    def numbers(self, n: int, kind: str) -> Array:
        dtype = np.dtype(self._order + kind)
        return np.frombuffer(self._taken(n * dtype.itemsize, dtype.itemsize), dtype)

    def _taken(self, size: int, aligned: int) -> memoryview:
        start = -(-self._at // aligned) * aligned
        if start + size > len(self._data):
            raise ValueError("it is cut off")
        self._at = start + size
        return self._data[start : self._at]


class _CursorOfRos1(_Cursor):
    """The same for messages of ROS 1."""

    header_size = 3
    """The number of the message before these two."""

    def __init__(self, data: bytes) -> None:
        self._data = memoryview(data)
        self._order = "<"
        self._at = 0

    def _taken(self, size: int, aligned: int) -> memoryview:
        return super()._taken(size, 1)


def _image(cursor: _Cursor) -> Array:
    """Return the pixels of a ``sensor_msgs/msg/Image``, shape (rows, columns)."""
    for _ in range(cursor.header_size):
        cursor.uint32()
    cursor.text()  # the frame of reference
    rows, columns, encoding = cursor.uint32(), cursor.uint32(), cursor.text()
    big, step, size = cursor.uint8() != 0, cursor.uint32(), cursor.uint32()
    kind = _ENCODINGS.get(encoding)
    if kind is None:
        raise ValueError(f"an image of {encoding}")
    width = columns * np.dtype(kind).itemsize
    if size < rows * step or step < width:
        raise ValueError("an image is cut off")
    lines = cursor.numbers(rows * step, "u1").reshape(rows, step)[:, :width]
    dtype = np.dtype((">" if big else "<") + kind)
    return np.ascontiguousarray(lines).view(dtype).reshape(rows, columns)


def _multi_array(cursor: _Cursor, kind: str) -> Array:
    """Return the numbers of a ``std_msgs/msg/…MultiArray``, as a matrix where it has two axes."""
    sizes = []
    for _ in range(cursor.uint32()):
        cursor.text()
        sizes.append(cursor.uint32())
        cursor.uint32()  # the stride: rows follow one another
    offset, n = cursor.uint32(), cursor.uint32()
    values = cursor.numbers(n, kind)[offset:]
    two = len(sizes) == 2 and sizes[0] * sizes[1] == len(values)
    return values.reshape(sizes) if two else values
