"""Every column held at virtual ground by an amplifier that turns its current into a voltage.

The current to voltage converter of thesis section 2.2.2. With ideal parts nothing couples; a row
driver's resistance lets the elements of a row share its voltage drop. The thesis' site isolation
(section 6.1.1) is another circuit, a divider whose idle rows are fed the voltage that is read.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray

from tactile_graph_pads.circuits.inverse import Inverse

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Feedback:
    """Supply over element into a virtual ground; output is the current times the bias resistor.

    Parameters
    ----------
    kind : "feedback"
    bias_ohm : float
        Feedback resistor of the column's amplifier.
    supply_v : float
        What drives the row; the output may exceed it up to what the converter takes.
    driver_ohm : float
        Resistance of each row's driver.
    """

    kind: Literal["feedback"] = "feedback"
    bias_ohm: Annotated[float, Gt(0)] = 1e3
    supply_v: Annotated[float, Gt(0)] = 5.0
    driver_ohm: Annotated[float, Ge(0)] = 0.0
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    def ratio(self, siemens: Array) -> Array:
        """Return what each element measures as, in shares of the supply, shape (rows, columns)."""
        drop = 1.0 + self.driver_ohm * siemens.sum(axis=1, keepdims=True)
        return np.asarray(self.bias_ohm * siemens / drop)

    def inverse(self, ratio: Array, start: Array | None = None) -> Inverse:
        """Return the conductances that measure as ``ratio``.

        Parameters
        ----------
        ratio : ndarray of float64, shape (rows, columns)
            Measured volts over supply volts.
        start : ndarray of float64, optional
            Not needed; taken so that all circuits are called alike.

        Notes
        -----
        ``g_ij = w_ij / (1 - R_driver sum_j w_ij)`` with ``w = ratio / R_bias``, exact. A row
        whose driver would have to drop the whole supply is impossible and comes out invalid.
        """
        apparent = ratio / self.bias_ohm
        left = 1.0 - self.driver_ohm * apparent.sum(axis=1, keepdims=True)
        possible = left > 0.0
        valid = np.broadcast_to(possible, ratio.shape).copy()
        return Inverse(np.where(valid, apparent / np.where(possible, left, 1.0), 0.0), valid)
