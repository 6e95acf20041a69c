"""How arrays hold values as smaller numbers, and which of them stand for none.

netCDF Climate and Forecast Metadata Conventions 1.11, sections 2.5.1 and 8.1, as netCDF4 and xarray
write them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import DataError

_SCALE, _OFFSET, _MISSING = "scale_factor", "add_offset", ("_FillValue", "missing_value")


class Packing(NamedTuple):
    """How the numbers of an array become values.

    Parameters
    ----------
    scale, offset : float
        A value is a number times the one, plus the other.
    missing : tuple of float
        Numbers that stand for no value.
    unsigned : bool
        Whether numbers below 0 are those of the unsigned type.
    """

    scale: float = 1.0
    offset: float = 0.0
    missing: tuple[float, ...] = ()
    unsigned: bool = False

    @property
    def said(self) -> str:
        """How numbers become values, in words; empty where they are the values."""
        if (self.scale, self.offset) == (1.0, 0.0):
            return ""
        return f"numbers x {self.scale:g} {'-' if self.offset < 0 else '+'} {abs(self.offset):g}"

    def unpacked(self, numbers: NDArray[Any]) -> NDArray[Any]:
        """Return values, NaN where there is none; what holds values already as it is."""
        if self.unsigned:
            numbers = numbers.view(numbers.dtype.str.replace("i", "u"))
        missing = np.zeros(numbers.shape, np.bool_)
        for one in self.missing:
            missing |= numbers == one
        if not (self.said or missing.any()):
            return numbers
        values = numbers.astype(np.float64)
        values *= self.scale
        values += self.offset
        values[missing] = np.nan
        return values


def packing_of(where: str, name: str, dtype: np.dtype[Any], said: Mapping[str, Any]) -> Packing:
    """Return how an array is packed, as its attributes say.

    Raises
    ------
    DataError
        If one of them is no number.
    """
    if dtype.kind not in "iuf":
        return Packing()
    scale, offset = (_number(where, name, said, key) for key in (_SCALE, _OFFSET))
    unsigned = dtype.kind == "i" and str(said.get("_Unsigned", "")).lower() == "true"
    found = [one for key in _MISSING if key in said for one in np.ravel(said[key]).tolist()]
    missing = [n for n in found if isinstance(n, int | float) and not np.isnan(n)]
    if unsigned:
        missing = [n % (1 << 8 * dtype.itemsize) for n in missing]
    return Packing(scale or 1.0, offset or 0.0, tuple(missing), unsigned)


def _number(where: str, name: str, said: Mapping[str, Any], key: str) -> float | None:
    """Return a number that an attribute says; None without that attribute."""
    value = said.get(key)
    if value is None:
        return None
    try:
        number = float(np.ravel(value).item())
    except (ValueError, TypeError):
        number = np.nan
    if not np.isfinite(number) or (key == _SCALE and number == 0.0):
        told = f"{key} of {name!r} is {str(value)[:30]!r}; write a number, or take it away"
        raise DataError(where, told)
    return number
