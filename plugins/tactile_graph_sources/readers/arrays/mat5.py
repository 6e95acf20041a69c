"""The variables of a MATLAB file of version 5 to 7, read without trust in what it says of itself.

MathWorks, MAT-File Format, R2023b, chapter 1. SciPy's reader is no choice for files of strangers: a
damaged one ends the whole program.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

HEADER = 128
LARGE, MOST_TIMES = 128_000_000, 200
"""Bytes that may be unpacked however few are packed, and how many times these."""
DEEPEST, MOST_MATRICES, MOST_VALUES = 30, 30_000, 1 << 31
_TYPES = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8",
          13: "u8", 16: "u1", 17: "u2", 18: "u4"}  # fmt: skip
_CODECS = {16: "utf-8", 17: "utf-16", 18: "utf-32"}
_MATRIX, _PACKED = 14, 15
_CELL, _STRUCT, _CHAR, _NUMBERS = 1, 2, 4, range(6, 16)
_COMPLEX = 0x0800
_OPAQUE = 17
_UNREAD = {3: "an object", 5: "sparse", 16: "a function", _OPAQUE: "an object"}


class DamagedError(Exception):
    """The file is no file of this format, or is damaged."""


@dataclass(frozen=True)
class Unread:
    """A variable whose values are not read: ``kind`` says what it is, such as ``complex``."""

    kind: str
    shape: tuple[int, ...] = ()


class _Element(NamedTuple):
    kind: int
    data: memoryview
    after: int


def variables(path: Path) -> dict[str, Any]:
    """Return the variables of a file by name.

    Returns
    -------
    dict
        Arrays of numbers without axes of length 1, texts, structs as dicts, and cell arrays,
        arrays of structs and several rows of letters as lists in MATLAB's order. What is none of
        these (complex and sparse matrices, objects, functions) is an `Unread`, what is empty None.

    Raises
    ------
    DamagedError
        If it does not hold what it says.
    """
    data = path.read_bytes()
    order = "<" if data[126:128] == b"IM" else ">"
    found: dict[str, Any] = {}
    room = max(LARGE, MOST_TIMES * len(data))
    for element in _elements(memoryview(data)[HEADER:], order):
        inner = element
        if element.kind == _PACKED:
            unpacked = _unpacked(element.data, room)
            room -= len(unpacked)
            inner = _element(memoryview(unpacked), 0, order)
        if inner.kind == _MATRIX:
            name, value = _matrix(inner.data, order, 0)
            found[name] = value
    return found


def _unpacked(data: memoryview, most: int) -> bytes:
    """Return what is packed, once it is known to be no more than is allowed."""
    try:
        packed, n = zlib.decompressobj(), 0
        left: bytes | memoryview = data
        while left and n <= most:
            n += len(packed.decompress(left, 1 << 20))
            left = packed.unconsumed_tail
        if n > most:
            raise DamagedError(f"it unpacks to more than {most / 1e6:,.0f} MB")
        return zlib.decompress(data)
    except zlib.error as error:
        raise DamagedError(str(error)) from None


def _elements(data: memoryview, order: str) -> Iterator[_Element]:
    at = n = 0
    while at < len(data):
        n += 1
        if n > MOST_MATRICES:
            raise DamagedError(f"it holds more than {MOST_MATRICES} matrices; save them as one")
        element = _element(data, at, order)
        yield element
        at = element.after


def _element(data: memoryview, at: int, order: str) -> _Element:
    """Return the element at a place; all but those that are packed are padded to eight bytes."""
    if at + 8 > len(data):
        raise DamagedError("it is cut off")
    kind, size = np.frombuffer(data[at : at + 8], f"{order}u4").tolist()
    if kind >> 16:  # a small one: the size stands beside the type, the data behind
        size, kind, start, after = kind >> 16, kind & 0xFFFF, at + 4, at + 8
        if size > 4:
            raise DamagedError("a small element is too large")
    else:
        start = at + 8
        after = start + (size if kind == _PACKED else -(-size // 8) * 8)
    if start + size > len(data):
        raise DamagedError("it is cut off")
    return _Element(kind, data[start : start + size], after)


# -- matrices ------------------------------------------------------------------------------------


def _matrix(data: memoryview, order: str, depth: int) -> tuple[str, Any]:
    """Return name and value of a matrix, which in MATLAB everything is."""
    if depth > DEEPEST:
        raise DamagedError("its structs lie too deep in one another")
    if not len(data):
        return "", np.empty(0)
    flags, dims, name = (e.data for e in _first(data, order, 3))
    if len(flags) == 8 and np.frombuffer(flags, f"{order}u4")[0] & 0xFF == _OPAQUE:
        return bytes(dims).decode("latin-1"), Unread(_UNREAD[_OPAQUE])  # it has a name, no size
    if len(flags) != 8 or len(dims) % 4 or not 8 <= len(dims) <= 128:
        raise DamagedError("a matrix has no size")
    word = int(np.frombuffer(flags, f"{order}u4")[0])
    shape = tuple(np.frombuffer(dims, f"{order}i4").tolist())
    if min(shape) < 0 or math.prod(shape) > MOST_VALUES:
        raise DamagedError(f"a matrix says it has shape {shape}")
    rest = [*_elements(data, order)][3:]
    called = bytes(name).decode("latin-1")
    return called, _value(word, shape, rest, order, depth)


def _first(data: memoryview, order: str, n: int) -> list[_Element]:
    found = []
    for element in _elements(data, order):
        found.append(element)
        if len(found) == n:
            return found
    raise DamagedError("a matrix is cut off")


def _value(word: int, shape: tuple[int, ...], rest: list[_Element], order: str, depth: int) -> Any:
    kind = word & 0xFF
    if kind == _CELL:
        return _matrices(rest, math.prod(shape), order, depth)
    if kind == _STRUCT:
        return _structs(rest, math.prod(shape), order, depth)
    if kind in _UNREAD:
        return Unread(_UNREAD[kind], shape)
    if not rest:
        return None
    if word & _COMPLEX:
        return Unread("complex", shape)
    if kind == _CHAR:
        text = _text(rest[0], order)
        if len(shape) != 2 or shape[0] < 2 or len(text) != math.prod(shape):
            return text
        return [text[row :: shape[0]] for row in range(shape[0])]
    return np.squeeze(_array(rest[0], shape, order)) if kind in _NUMBERS else None


def _array(element: _Element, shape: tuple[int, ...], order: str) -> NDArray[Any]:
    dtype = _TYPES.get(element.kind)
    if dtype is None:
        raise DamagedError(f"numbers of type {element.kind}")
    kind = np.dtype(f"{order}{dtype}")
    if len(element.data) != math.prod(shape) * kind.itemsize:
        raise DamagedError(f"a matrix of shape {shape} holds {len(element.data)} bytes")
    return np.frombuffer(element.data, kind).reshape(shape, order="F")


def _text(element: _Element, order: str) -> str:
    codec = _CODECS.get(element.kind, "utf-16" if element.kind == 4 else "latin-1")
    if codec != "utf-8" and codec != "latin-1":
        codec += "-le" if order == "<" else "-be"
    return bytes(element.data).decode(codec, "replace")


def _matrices(elements: list[_Element], n: int, order: str, depth: int) -> list[Any]:
    if len(elements) < n or any(e.kind != _MATRIX for e in elements[:n]):
        raise DamagedError("cells are missing")
    return [_matrix(e.data, order, depth + 1)[1] for e in elements[:n]]


def _structs(rest: list[_Element], n: int, order: str, depth: int) -> Any:
    if len(rest) < 2 or len(rest[0].data) != 4:
        raise DamagedError("a struct has no fields")
    length = int(np.frombuffer(rest[0].data, f"{order}i4")[0])
    names = bytes(rest[1].data)
    if not 0 < length <= 4096 or len(names) % length:
        raise DamagedError("a struct's names are damaged")
    keys = [
        names[at : at + length].partition(b"\0")[0].decode("latin-1")
        for at in range(0, len(names), length)
    ]
    if not keys:
        return {}
    values = _matrices(rest[2:], n * len(keys), order, depth)
    made = [
        dict(zip(keys, values[at : at + len(keys)], strict=True))
        for at in range(0, len(values), len(keys))
    ]
    return made[0] if n == 1 else made
