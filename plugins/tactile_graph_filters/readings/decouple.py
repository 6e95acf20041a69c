"""Step ``decouple``: the conductance of each element, its circuit's crosstalk taken out."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from annotated_types import Gt

from tactile_graph.errors import Degenerate
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.wires import Image
from tactile_graph_filters.nan import finite, refuse_nan


class Decouple:
    """Return the conductances that measure as the given voltages, by the circuit's inverse.

    Parameters
    ----------
    pad : str or mapping
        Name of a pad, its YAML file, or the pad itself: its circuit is meant. The wrong circuit
        makes things worse, not better.
    max_residual : float
        Largest relative misfit at which an inverse that iterates counts as found.

    Notes
    -----
    The divider's inverse (thesis section 2.3) is in closed form and exact; the floating
    circuit's is a damped Newton iteration in log conductance, started anew at every frame so
    that a frame's answer depends on no other. Where the data are impossible (a column of the
    divider whose voltages add up to the supply or more) the elements become invalid. An element
    that came in invalid counts as unloaded, which leaves its neighbours' shadowing by it in.
    """

    stateless = True

    def __init__(
        self,
        *,
        pad: str | dict[str, Any] = "thesis",
        max_residual: Annotated[float, Gt(0)] = 1e-3,
    ) -> None:
        from tactile_graph_pads.pad import load_pad

        self._circuit = load_pad(pad).circuit
        self._max_residual = max_residual

    def __call__(
        self, image: Annotated[Image, Quantity("volt")]
    ) -> Annotated[Image, Quantity("siemens"), Grid.like("image")]:
        """Return the image in siemens.

        Raises
        ------
        Degenerate
            If the inverse iterates and does not come closer than ``max_residual``.
        DataError
            If a valid cell holds NaN or infinity.
        """
        volts = image.filled(0.0)
        if not finite(volts):
            refuse_nan(image, infinite=True)
        found = self._circuit.inverse(volts / self._circuit.supply_v)
        if found.residual > self._max_residual:
            raise Degenerate(
                f"the inverse of the {self._circuit.kind} circuit stopped after"
                f" {found.iterations} steps at a misfit of {found.residual:.2g},"
                f" allowed is {self._max_residual:.2g}: are these that circuit's voltages?"
            )
        siemens, valid = found.siemens, image.valid
        if np.count_nonzero(found.valid) != volts.size:
            valid = found.valid if valid is None else valid & found.valid
        if valid is not None:
            siemens = np.where(valid, siemens, 0.0)
        return Image(siemens, image.pitch_cm, image.origin_cm, "siemens", valid)
