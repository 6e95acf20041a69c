"""Values of several frames, kept as arrays: what steps take and give that answer a block at once.

The value of a frame is made only when somebody asks for it, and is then the very value that the
step gives for that frame alone.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields
from operator import attrgetter
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires.image import Image, Mask, cells_of, unmasked
from tactile_graph.wires.native import NATIVE, native
from tactile_graph.wires.points import Points
from tactile_graph.wires.shapes import Polygon

Rows = NDArray[np.intp]
"""Numbers of frames within a stack, rising."""


class Stack(ABC):
    """Values of one kind, one for each of several frames."""

    item: ClassVar[type] = object
    """What the values are."""

    @abstractmethod
    def __len__(self) -> int:
        """Return the number of frames."""

    @abstractmethod
    def __getitem__(self, i: int) -> Any:
        """Return the value of a frame."""

    @abstractmethod
    def take(self, rows: Rows) -> Self:
        """Return the values of some of the frames."""

    @classmethod
    @abstractmethod
    def of(cls, values: Sequence[Any]) -> Stack:
        """Return values as a stack; they are alike in whatever they have in common."""

    def __iter__(self) -> Iterator[Any]:
        """Yield the value of each frame."""
        return (self[i] for i in range(len(self)))

    def field(self, name: str) -> Stack | None:
        """Return a field of each value; None where no array knows it."""
        return None


class Answered(NamedTuple):
    """What a stacked form gives that leaves some frames to the step itself.

    Attributes
    ----------
    values : Stack
        Of all frames; those of the others are not looked at.
    done : ndarray of bool, shape (n,)
        Which frames are answered.
    """

    values: Stack
    done: NDArray[np.bool_]


class Listed(Stack):
    """Any values, one after the other."""

    def __init__(self, values: Sequence[Any]) -> None:
        self.values = values

    @classmethod
    def of(cls, values: Sequence[Any]) -> Listed:
        """Return values as a stack."""
        return cls(values)

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, i: int) -> Any:
        return self.values[i]

    def take(self, rows: Rows) -> Listed:
        """Return the values of some of the frames."""
        return Listed([self.values[i] for i in rows.tolist()])


class Column(Stack):
    """Single numbers, each Python's own when taken out: ``int``, ``float`` or ``bool``.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Takes ownership: it becomes read-only.
    """

    def __init__(self, values: NDArray[Any]) -> None:
        self.values = _frozen(values)

    @classmethod
    def of(cls, values: Sequence[Any]) -> Column:
        """Return numbers of one type as a stack."""
        return cls(np.array(values))

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, i: int) -> Any:
        return self.values[i].item()

    def __iter__(self) -> Iterator[Any]:
        return iter(self.values.tolist())

    def take(self, rows: Rows) -> Column:
        """Return the numbers of some of the frames."""
        return Column(self.values[rows])


class _OnGrid(Stack):
    """Cells of several frames on one grid, shape (n, rows, columns)."""

    values: NDArray[Any]
    pitch_cm: tuple[float, float]
    origin_cm: tuple[float, float]

    def __len__(self) -> int:
        return len(self.values)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Frames, rows and columns."""
        n, rows, columns = self.values.shape
        return n, rows, columns


class ImageStack(_OnGrid):
    """Images of one shape, grid and quantity. Takes ownership: the arrays become read-only.

    Parameters
    ----------
    values : ndarray, shape (n, rows, columns)
    pitch_cm, origin_cm, quantity
        As of an `Image`, the same for all.
    valid : ndarray of bool, shape (n, rows, columns), optional
        None where all cells of all frames are good.
    images : sequence of Image, optional
        The images themselves, where they are there already.
    """

    item = Image

    def __init__(
        self,
        values: NDArray[Any],
        pitch_cm: tuple[float, float] = (1.0, 1.0),
        origin_cm: tuple[float, float] = (0.0, 0.0),
        quantity: str = "raw",
        valid: NDArray[np.bool_] | None = None,
        images: Sequence[Image] | None = None,
    ) -> None:
        values, valid = unmasked(values, valid)
        self.values = _frozen(values)
        self.pitch_cm, self.origin_cm, self.quantity = pitch_cm, origin_cm, quantity
        self.valid = None if valid is None else _frozen(valid)
        self._images = images

    @classmethod
    def of(cls, images: Sequence[Image]) -> ImageStack:
        """Return images as a stack; all are alike in shape, type, grid, quantity and validity."""
        first = images[0]
        valid = None if first.valid is None else np.array([i.valid for i in images])
        values = np.array([i.values for i in images])
        return cls(values, first.pitch_cm, first.origin_cm, first.quantity, valid, images)

    def __getitem__(self, i: int) -> Image:
        if self._images is not None:
            return self._images[i]
        valid = None if self.valid is None else self.valid[i]
        return Image(self.values[i], self.pitch_cm, self.origin_cm, self.quantity, valid)

    def take(self, rows: Rows) -> ImageStack:
        """Return the images of some of the frames."""
        valid = None if self.valid is None else self.valid[rows]
        images = None if self._images is None else [self._images[i] for i in rows.tolist()]
        grid = (self.pitch_cm, self.origin_cm, self.quantity)
        return ImageStack(self.values[rows], *grid, valid, images)


class MaskStack(Stack):
    """Masks of one shape and grid. Takes ownership: the arrays become read-only.

    They are kept as cells, or with the cells of a row as the bits of one machine word, or both:
    whichever is asked for is made of the other.

    Parameters
    ----------
    values : ndarray of bool, shape (n, rows, columns)
    pitch_cm, origin_cm
        As of a `Mask`, the same for all.
    counts : ndarray of int64, shape (n,)
        How many cells of each are on.
    """

    item: ClassVar[type] = Mask
    WIDEST = Mask.WIDEST
    """Columns that go into a word."""

    def __init__(
        self,
        values: NDArray[np.bool_],
        pitch_cm: tuple[float, float],
        origin_cm: tuple[float, float],
        counts: NDArray[np.int64],
    ) -> None:
        n, rows, columns = values.shape
        self._shape = (n, rows, columns)
        self._values: NDArray[np.bool_] | None = _frozen(values)
        self._words: NDArray[np.uint64] | None = None
        self.counts = _frozen(counts)
        self.pitch_cm, self.origin_cm = pitch_cm, origin_cm

    @classmethod
    def packed(
        cls,
        words: NDArray[np.uint64],
        columns: int,
        pitch_cm: tuple[float, float],
        origin_cm: tuple[float, float],
        counts: NDArray[np.int64],
    ) -> MaskStack:
        """Return masks of at most 64 columns by `words`, shape (n, rows)."""
        made = cls.__new__(cls)
        made._shape = (*words.shape, columns)
        made._values, made._words, made.counts = None, _frozen(words), _frozen(counts)
        made.pitch_cm, made.origin_cm = pitch_cm, origin_cm
        return made

    @classmethod
    def of(cls, values: Sequence[Mask]) -> MaskStack:
        """Return masks of one shape and grid as a stack."""
        counts = np.array([mask.count for mask in values])
        cells = np.array([mask.values for mask in values])
        return cls(cells, values[0].pitch_cm, values[0].origin_cm, counts)

    def __len__(self) -> int:
        return int(self._shape[0])

    @property
    def shape(self) -> tuple[int, int, int]:
        """Frames, rows and columns."""
        return self._shape

    @property
    def values(self) -> NDArray[np.bool_]:
        """The cells, shape (n, rows, columns)."""
        if self._values is None:
            self._values = self._cells(self._words)
        return self._values

    def _cells(self, words: Any) -> NDArray[np.bool_]:
        """Return the cells of rows, a further axis of them."""
        return _frozen(cells_of(words, self._shape[2]))

    @property
    def words(self) -> NDArray[np.uint64] | None:
        """The rows, shape (n, rows): bit c is column c; None where there are over 64 columns."""
        if self._words is None and self._shape[2] <= self.WIDEST:
            n, rows, columns = self._shape
            raw = np.zeros((n, rows, 8), np.uint8)
            cells = self.values if columns % 8 else self.values.reshape(-1)  # that is faster
            bits = np.packbits(cells, axis=-1, bitorder="little")
            width = -(-columns // 8)
            raw[:, :, :width] = bits.reshape(n, rows, width)
            self._words = _frozen(self._little(raw.view("<u8").reshape(n, rows)).astype(np.uint64))
        return self._words

    @staticmethod
    def _little(words: Any) -> NDArray[Any]:
        return np.asarray(words).astype("<u8", copy=False)

    def __getitem__(self, i: int) -> Mask:
        if self._values is None and self._words is not None:  # the others' may never be asked for
            cells = self._cells(self._words[i])
        else:
            cells = self.values[i]
        return Mask(cells, self.pitch_cm, self.origin_cm, int(self.counts[i]))

    def __iter__(self) -> Iterator[Mask]:
        """Yield the mask of each frame."""
        grid = (self.pitch_cm, self.origin_cm)
        for cells, count in zip(self.values, self.counts.tolist(), strict=True):
            yield Mask(cells, *grid, count)

    def take(self, rows: Rows) -> MaskStack:
        """Return the masks of some of the frames."""
        grid, counts = (self.pitch_cm, self.origin_cm), self.counts[rows]
        if self._values is None and self._words is not None:
            return MaskStack.packed(self._words[rows], self._shape[2], *grid, counts)
        return MaskStack(self.values[rows], *grid, counts)

    def field(self, name: str) -> Stack | None:
        """Return the counts, and what follows from them."""
        _, rows, columns = self.shape
        if name == "count":
            return Column(self.counts)
        if name == "fraction" and rows * columns:
            return Column(self.counts / (rows * columns))
        if name == "area_cm2":
            return Column(self.counts * (self.pitch_cm[0] * self.pitch_cm[1]))
        return None


class PointsStack(Stack):
    """Points of several frames, one frame's behind the other's.

    Parameters
    ----------
    xy_cm : ndarray of float64, shape (all points, 2)
        Takes ownership: the arrays become read-only.
    starts : ndarray of int64, shape (n + 1,)
        Where in ``xy_cm`` each frame's points begin, and where the last one's end.
    """

    item: ClassVar[type] = Points

    def __init__(self, xy_cm: NDArray[np.float64], starts: NDArray[np.int64]) -> None:
        self.xy_cm, self.starts = _frozen(xy_cm), _frozen(starts)

    @classmethod
    def of(cls, values: Sequence[Any]) -> Self:
        """Return what has points or corners as a stack."""
        starts = np.cumsum([0, *(value.count for value in values)])
        return cls(np.concatenate([value.xy_cm for value in values]), starts)

    def __len__(self) -> int:
        return len(self.starts) - 1

    def __getitem__(self, i: int) -> Any:
        return type(self).item(self.xy_cm[self.starts[i] : self.starts[i + 1]])

    def take(self, rows: Rows) -> Self:
        """Return the points of some of the frames."""
        first, n = self.starts[rows], np.diff(self.starts)[rows]
        starts = np.concatenate([[0], np.cumsum(n)])
        where = np.repeat(first - starts[:-1], n) + np.arange(starts[-1])
        return type(self)(self.xy_cm[where], starts)

    def field(self, name: str) -> Stack | None:
        """Return how many points there are."""
        return Column(np.diff(self.starts)) if name == "count" else None


class PolygonStack(PointsStack):
    """Polygons of several frames by their corners, as `PointsStack` has points."""

    item = Polygon

    def field(self, name: str) -> Stack | None:
        """Return how many corners there are, or the corners as points."""
        return PointsStack(self.xy_cm, self.starts) if name == "points" else super().field(name)


class RecordStack(Stack):
    """Records of single numbers, a column for each field.

    Parameters
    ----------
    made : callable
        Makes a record of its fields, in the order of ``columns``; a class usually.
    columns : mapping of str to ndarray, shape (n,)
        By field. Takes ownership: the arrays become read-only.
    """

    def __init__(self, made: Callable[..., Any], columns: Mapping[str, NDArray[Any]]) -> None:
        self.made = made
        self.columns = {name: _frozen(column) for name, column in columns.items()}

    @classmethod
    def of(cls, values: Sequence[Any]) -> RecordStack:
        """Return records of one dataclass as a stack."""
        names = [field.name for field in fields(values[0])]
        columns = {name: np.array([getattr(v, name) for v in values]) for name in names}
        return cls(type(values[0]), columns)

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def __getitem__(self, i: int) -> Any:
        return self.made(*[column[i].item() for column in self.columns.values()])

    def __iter__(self) -> Iterator[Any]:
        return map(self.made, *[column.tolist() for column in self.columns.values()])

    def take(self, rows: Rows) -> RecordStack:
        """Return the records of some of the frames."""
        return RecordStack(self.made, {k: column[rows] for k, column in self.columns.items()})

    def field(self, name: str) -> Stack | None:
        """Return a field of each record."""
        return Column(self.columns[name]) if name in self.columns else None


def field_of(values: Stack, path: Sequence[str]) -> Stack:
    """Return a field (of a field) of each value, by arrays as far as they know it.

    Raises
    ------
    Exception
        Whatever a value's own property raises.
    """
    for k, name in enumerate(path):
        known = values.field(name)
        if known is None:
            return Listed([*map(attrgetter(".".join(path[k:])), values)])
        values = known
    return values


def _frozen(array: NDArray[Any]) -> NDArray[Any]:
    if array.dtype not in NATIVE:
        array = native(array)
    array.setflags(write=False)
    return array
