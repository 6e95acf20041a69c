"""The thesis' circuit as its results show it: a divider against a bias resistor, idle rows low.

An element shares its column's bias resistor with the others of its column, so a loaded column
shadows itself; nothing leaks between columns (thesis section 2.3.2 and figures 2.7 to 2.11). The
converters of its section 2.2.2 would not couple: they are `feedback`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar, Literal

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph_pads.circuits.driven import driven_inverse, driven_ratio
from tactile_graph_pads.circuits.inverse import Inverse

Array = NDArray[np.float64]


@compiled_later
def ratio_kernel(siemens: Array, reference_s: float, gain: float) -> Array:
    """Return the measured share of the supply, ``gain g_ij / (G_ref + sum_k g_kj)``."""
    rows, columns = siemens.shape
    sums = np.full(columns, reference_s)
    for r in range(rows):
        for c in range(columns):
            sums[c] += siemens[r, c]
    out = np.empty((rows, columns))
    for r in range(rows):
        for c in range(columns):
            out[r, c] = gain * siemens[r, c] / sums[c]
    return out


@compiled_later
def siemens_kernel(
    ratio: Array, reference_s: float, gain: float
) -> tuple[Array, NDArray[np.bool_]]:
    """Return the conductances and which columns are possible: `ratio_kernel` inverted."""
    rows, columns = ratio.shape
    scale = np.zeros(columns)
    for r in range(rows):
        for c in range(columns):
            scale[c] += ratio[r, c]
    for c in range(columns):
        left = 1.0 - scale[c] / gain
        scale[c] = reference_s / (left * gain) if left > 0.0 else 0.0
    siemens = np.zeros((rows, columns))
    valid = np.empty((rows, columns), np.bool_)
    for r in range(rows):
        for c in range(columns):
            valid[r, c] = scale[c] > 0.0
            siemens[r, c] = ratio[r, c] * scale[c]
    return siemens, valid


@dataclass(frozen=True)
class Divider:
    """Supply over element over bias resistor; the other rows low, the other columns open.

    Parameters
    ----------
    kind : "divider"
    bias_ohm : float
        Resistor from the column to ground; 33 kOhm in the thesis (section 2.3.2).
    supply_v : float
        What drives the row.
    driver_ohm : float
        Resistance of each row's driver, idle ones too. Above 0 the columns couple through the
        rows and the inverse iterates.
    mux_ohm : float
        Resistance of the multiplexer between column and bias resistor.
    """

    kind: Literal["divider"] = "divider"
    bias_ohm: Annotated[float, Gt(0)] = 33e3
    supply_v: Annotated[float, Gt(0)] = 5.0
    driver_ohm: Annotated[float, Ge(0)] = 0.0
    mux_ohm: Annotated[float, Ge(0)] = 0.0
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    @cached_property
    def reference_s(self) -> float:
        """Conductance from column to ground while it is read."""
        return 1.0 / (self.bias_ohm + self.mux_ohm)

    @cached_property
    def gain(self) -> float:
        """Share of the column's voltage that stands over the bias resistor."""
        return self.bias_ohm * self.reference_s

    def ratio(self, siemens: Array) -> Array:
        """Return what each element measures as, in shares of the supply, shape (rows, columns)."""
        if self.driver_ohm > 0.0:
            return driven_ratio(siemens, 1.0 / self.driver_ohm, self.reference_s, self.gain)
        return ratio_kernel(siemens, self.reference_s, self.gain)

    def inverse(self, ratio: Array, start: Array | None = None) -> Inverse:
        """Return the conductances that measure as ``ratio``.

        Parameters
        ----------
        ratio : ndarray of float64, shape (rows, columns)
            Measured volts over supply volts.
        start : ndarray of float64, shape (rows, columns), optional
            Conductances to start from, where drivers have resistance.

        Notes
        -----
        ``g_ij = v_ij G_ref / (1 - T_j)`` with ``T_j = sum_i v_ij``, exact for ideal drivers. A
        column with T_j at or above 1 is impossible and comes out invalid, never clipped.
        """
        siemens, valid = siemens_kernel.call(ratio, self.reference_s, self.gain)
        if self.driver_ohm == 0.0:
            return Inverse(siemens, valid)
        guess = siemens if start is None else start
        return driven_inverse(
            ratio, valid, guess, 1.0 / self.driver_ohm, self.reference_s, self.gain
        )
