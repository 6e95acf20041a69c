"""``Image`` and ``Mask``: a pad's values, or a yes/no per cell, with their place on the pad."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, NoReturn

import numpy as np
from numpy.typing import DTypeLike, NDArray

from tactile_graph.quantities import QuantityName, unit_of
from tactile_graph.wires.native import NATIVE, native

_WORD = np.dtype(np.uint64)


def cells_of(words: NDArray[np.uint64], columns: int) -> NDArray[np.bool_]:
    """Return the cells of rows that are words, bit c being column c: a further axis of them."""
    raw = words.astype("<u8", copy=False).view(np.uint8).reshape(*words.shape, 8)
    return np.unpackbits(raw, axis=-1, count=columns, bitorder="little").view(np.bool_)


def unmasked(
    values: NDArray[Any], valid: NDArray[np.bool_] | None
) -> tuple[NDArray[Any], NDArray[np.bool_] | None]:
    """Return the values of a masked array as a plain one; its masked cells are invalid, and 0.

    Arrays of any other kind, as a `numpy.matrix`, whose product is another, become plain ones, too.
    """
    if type(values) is np.ndarray:
        return values, valid
    if not isinstance(values, np.ma.MaskedArray):
        return np.asarray(values), valid
    there = ~np.ma.getmaskarray(values)
    if not there.all():
        valid = there if valid is None else valid & there
    plain: NDArray[Any] = values.filled(0)
    return plain, valid


class _Gridded:
    """What images and masks share: cells of ``pitch_cm`` from ``origin_cm`` on."""

    __slots__ = ("origin_cm", "pitch_cm")
    fields_told: ClassVar[tuple[str, ...]] = ("origin_cm", "pitch_cm", "values")
    if TYPE_CHECKING:

        @property
        def values(self) -> NDArray[Any]: ...

    pitch_cm: tuple[float, float]
    origin_cm: tuple[float, float]

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(f"{type(self).__name__} is frozen: cannot set {name!r}")

    def __delattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"{type(self).__name__} is frozen: cannot delete {name!r}")

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        rows, columns = self.values.shape
        return rows, columns

    @property
    def rows(self) -> int:
        """Number of rows."""
        return int(self.shape[0])

    @property
    def columns(self) -> int:
        """Number of columns."""
        return int(self.shape[1])

    @property
    def cell_area_cm2(self) -> float:
        """Area of one cell, gaps between the elements included."""
        return self.pitch_cm[0] * self.pitch_cm[1]

    @property
    def extent_cm(self) -> tuple[float, float, float, float]:
        """Left, right, bottom and top edge on the pad (y down), as matplotlib takes them."""
        x, y = self.origin_cm
        rows, columns = self.shape
        return (x, x + columns * self.pitch_cm[0], y + rows * self.pitch_cm[1], y)

    @property
    def x_cm(self) -> NDArray[np.float64]:
        """Cell centres along x, shape (columns,)."""
        return np.asarray(self.origin_cm[0] + (np.arange(self.columns) + 0.5) * self.pitch_cm[0])

    @property
    def y_cm(self) -> NDArray[np.float64]:
        """Cell centres along y (down), shape (rows,)."""
        return np.asarray(self.origin_cm[1] + (np.arange(self.rows) + 0.5) * self.pitch_cm[1])


class Image(_Gridded):
    """Values of a pad or of a part of it. Takes ownership: the arrays become read-only.

    Parameters
    ----------
    values : ndarray, shape (rows, columns)
        One number per cell; row 0 is the top of the pad. What no machine code takes is
        copied: half and quadruple precision becomes double, another machine's byte order this
        one's. Masked cells of a masked array become invalid.
    pitch_cm : (float, float)
        Distance of neighbouring cells along x and y.
    origin_cm : (float, float)
        Top left corner of the first cell, in pad coordinates (x right, y down).
    quantity : str
        What the values mean, one of `tactile_graph.vocabulary.QUANTITIES`.
    valid : ndarray of bool, shape (rows, columns), optional
        False where a cell is missing or broken (its value is then 0); None where all are good.
    """

    __slots__ = ("quantity", "valid", "values")
    fields_told: ClassVar[tuple[str, ...]] = ("quantity", "valid", *_Gridded.fields_told)
    columns_shown: ClassVar[tuple[str, ...]] = ("total", "peak")
    image_unit: ClassVar[tuple[str, ...]] = ("total", "peak")
    quantity: QuantityName
    valid: NDArray[np.bool_] | None
    values: NDArray[Any]

    def __init__(
        self,
        values: NDArray[Any],
        pitch_cm: tuple[float, float] = (1.0, 1.0),
        origin_cm: tuple[float, float] = (0.0, 0.0),
        quantity: str = "raw",
        valid: NDArray[np.bool_] | None = None,
    ) -> None:
        if values.__class__ is not np.ndarray:
            values, valid = unmasked(values, valid)
        if values.dtype not in NATIVE:
            values = native(values)
        values.setflags(False)  # type: ignore[call-arg]  # by keyword it takes twice as long
        if valid is not None:
            valid.setflags(False)  # type: ignore[call-arg]
        _set_values(self, values)
        _set_pitch(self, pitch_cm)
        _set_origin(self, origin_cm)
        _set_quantity(self, quantity)
        _set_valid(self, valid)

    def with_values(
        self,
        values: NDArray[Any],
        quantity: str | None = None,
        valid: NDArray[np.bool_] | None = None,
    ) -> Image:
        """Return an image on the same grid; ``valid`` and ``quantity`` stay unless given."""
        return Image(
            values,
            self.pitch_cm,
            self.origin_cm,
            self.quantity if quantity is None else quantity,
            self.valid if valid is None else valid,
        )

    def __reduce__(self) -> tuple[type[Image], tuple[Any, ...]]:
        """Copy and pickle by what it is made of: another process's image is as frozen."""
        return Image, (self.values, self.pitch_cm, self.origin_cm, self.quantity, self.valid)

    def mask(self, values: NDArray[np.bool_]) -> Mask:
        """Return a mask on the same grid."""
        return Mask(values, self.pitch_cm, self.origin_cm)

    def filled(self, fill: float = 0.0) -> NDArray[Any]:
        """Return the values with ``fill`` in the invalid cells; no copy if all are good."""
        return self.values if self.valid is None else np.where(self.valid, self.values, fill)

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        """Return the values for NumPy, NaN in the invalid cells.

        Raises
        ------
        ValueError
            If cells are invalid, and no copy may be made or the type has no NaN.
        """
        values = self.filled(math.nan)
        if self.valid is not None:
            if copy is False:
                raise ValueError("an image with invalid cells needs a copy, which has NaN in them")
            if not self.valid.all() and dtype is not None and np.dtype(dtype).kind not in "fcO":
                raise ValueError(
                    f"cells are invalid, and {np.dtype(dtype)} has no NaN; filled() has 0 in them"
                )
        return np.array(values, dtype=dtype, copy=copy)

    @property
    def unit(self) -> str:
        """Unit of the values; the quantity itself where that is its own unit."""
        return unit_of(self.quantity)

    @property
    def total(self) -> float:
        """Sum over the valid cells, in units of the quantity."""
        return float(self.values.sum() if self.valid is None else self.values[self.valid].sum())

    @property
    def peak(self) -> float:
        """Largest valid value, in units of the quantity; 0 where no cell is valid."""
        values = self.values if self.valid is None else self.values[self.valid]
        return float(values.max()) if values.size else 0.0

    def _repr_html_(self) -> str:
        from tactile_graph.wires.notebook import image_html

        return image_html(self)

    def __repr__(self) -> str:
        return (
            f"<Image {self.rows}x{self.columns} {self.quantity}, pitch {self.pitch_cm} cm, "
            f"origin {self.origin_cm} cm>"
        )


class Mask(_Gridded):
    """A yes/no per cell. Takes ownership: the array becomes read-only.

    Parameters
    ----------
    values : ndarray of bool, shape (rows, columns)
        Masked cells of a masked array are off.
    pitch_cm, origin_cm : (float, float)
        As in `Image`.
    count : int, optional
        Number of cells that are on, where whoever made the mask has counted them.
    """

    __slots__ = ("_cells", "_columns", "_count", "_words")
    WIDEST: ClassVar[int] = 64
    """Columns of a row that a machine word holds."""
    _cells: NDArray[np.bool_] | None
    _count: int | None
    _words: NDArray[np.uint64] | None
    _columns: int
    columns_shown: ClassVar[tuple[str, ...]] = ("count", "area_cm2")

    def __init__(
        self,
        values: NDArray[np.bool_],
        pitch_cm: tuple[float, float] = (1.0, 1.0),
        origin_cm: tuple[float, float] = (0.0, 0.0),
        count: int | None = None,
    ) -> None:
        if values.__class__ is not np.ndarray:
            values, _ = unmasked(values, None)
        values.setflags(False)  # type: ignore[call-arg]
        _set_cells(self, values)
        _set_pitch(self, pitch_cm)
        _set_origin(self, origin_cm)
        _set_count(self, count)
        _set_words(self, None)

    def __reduce__(self) -> tuple[type[Mask], tuple[Any, ...]]:
        """Copy and pickle by what it is made of."""
        return Mask, (self.values, self.pitch_cm, self.origin_cm, self._count)

    def with_values(self, values: NDArray[np.bool_]) -> Mask:
        """Return a mask on the same grid."""
        return Mask(values, self.pitch_cm, self.origin_cm)

    @property
    def values(self) -> NDArray[np.bool_]:
        """Whether each cell is on, shape (rows, columns)."""
        cells = self._cells
        if cells is None:
            assert self._words is not None
            cells = cells_of(self._words, self._columns)
            cells.setflags(False)  # type: ignore[call-arg]
            _set_cells(self, cells)
        return cells

    @property
    def words(self) -> NDArray[np.uint64] | None:
        """The rows as machine words, bit c being column c; None if the mask was not made of them.

        In order of memory, of the machine's own byte order.
        """
        return self._words

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        cells = self._cells
        if cells is None:
            assert self._words is not None
            return len(self._words), self._columns
        rows, columns = cells.shape
        return rows, columns

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        """Return the values for NumPy."""
        return np.array(self.values, dtype=dtype, copy=copy)

    @property
    def count(self) -> int:
        """Number of cells that are on."""
        count = self._count
        if count is None:
            count = int(np.count_nonzero(self.values))
            _set_count(self, count)
        return count

    @property
    def fraction(self) -> float:
        """Share of the cells that are on, 0 to 1."""
        size = self._cells.size if self._cells is not None else math.prod(self.shape)
        return self.count / size if size else 0.0

    @property
    def area_cm2(self) -> float:
        """Area of the cells that are on, gaps between the elements included."""
        return self.count * self.cell_area_cm2

    def _repr_html_(self) -> str:
        from tactile_graph.wires.notebook import mask_html

        return mask_html(self)

    def __repr__(self) -> str:
        return f"<Mask {self.rows}x{self.columns}, {self.count} on, pitch {self.pitch_cm} cm>"


# The slots' own setters: the one way past the frozen __setattr__, at half a dataclass's cost.
_slots: Mapping[str, Any] = {**vars(_Gridded), **vars(Mask), **vars(Image)}
_set_values = _slots["values"].__set__
_set_pitch = _slots["pitch_cm"].__set__
_set_origin = _slots["origin_cm"].__set__
_set_quantity = _slots["quantity"].__set__
_set_valid = _slots["valid"].__set__
_set_cells = _slots["_cells"].__set__
_set_words = _slots["_words"].__set__
_set_count = _slots["_count"].__set__


# -- made at once ------------------------------------------------------------------------------
# While its parts are set a wire is open: Python then sets each by one instruction, where the slots'
# setters are a call each. Both __setattr__ and __delattr__ must be plain for that.


class _OpenImage(Image):
    __slots__ = ()
    __init__ = object.__init__
    __setattr__ = object.__setattr__  # type: ignore[assignment]
    __delattr__ = object.__delattr__  # type: ignore[assignment]


class _OpenMask(Mask):
    __slots__ = ()
    __init__ = object.__init__
    __setattr__ = object.__setattr__  # type: ignore[assignment]
    __delattr__ = object.__delattr__  # type: ignore[assignment]


def quick_image(
    values: NDArray[Any],
    pitch_cm: tuple[float, float],
    origin_cm: tuple[float, float],
    quantity: QuantityName,
    valid: NDArray[np.bool_] | None = None,
) -> Image:
    """Return ``Image(values, pitch_cm, origin_cm, quantity, valid)`` in half the time.

    Values must be whole numbers or of single or double precision, in the machine's byte order:
    others are not made so. The array is a plain one: no cells of it are masked.
    """
    values.setflags(False)  # type: ignore[call-arg]
    if valid is not None:
        valid.setflags(False)  # type: ignore[call-arg]
    image: Any = _OpenImage()
    image.values = values
    image.pitch_cm = pitch_cm
    image.origin_cm = origin_cm
    image.quantity = quantity
    image.valid = valid
    image.__class__ = Image
    return image  # type: ignore[no-any-return]


def quick_mask(
    values: NDArray[np.bool_],
    pitch_cm: tuple[float, float],
    origin_cm: tuple[float, float],
    count: int | None = None,
) -> Mask:
    """Return ``Mask(values, pitch_cm, origin_cm, count)`` in half the time."""
    values.setflags(False)  # type: ignore[call-arg]
    mask: Any = _OpenMask()
    mask._cells = values
    mask.pitch_cm = pitch_cm
    mask.origin_cm = origin_cm
    mask._count = count
    mask._words = None
    mask.__class__ = Mask
    return mask  # type: ignore[no-any-return]


def packed_mask(
    words: NDArray[np.uint64],
    columns: int,
    pitch_cm: tuple[float, float],
    origin_cm: tuple[float, float],
    count: int,
) -> Mask:
    """Return a mask whose rows are machine words; its cells are unpacked when asked for.

    Parameters
    ----------
    words : ndarray of uint64, shape (rows,)
        Bit c is column c; higher ones are 0. Takes ownership: the array becomes read-only.
    columns : int
        At most `Mask.WIDEST`.
    pitch_cm, origin_cm : (float, float)
    count : int
        Number of bits that are 1.
    """
    if words.dtype is not _WORD or words.ndim != 1 or not words.flags.c_contiguous:
        words = np.ascontiguousarray(words, np.uint64).reshape(-1)  # kernels do not look at them
    words.setflags(False)  # type: ignore[call-arg]
    mask: Any = _OpenMask()
    mask._cells = None
    mask._words = words
    mask._columns = columns
    mask.pitch_cm = pitch_cm
    mask.origin_cm = origin_cm
    mask._count = count
    mask.__class__ = Mask
    return mask  # type: ignore[no-any-return]
