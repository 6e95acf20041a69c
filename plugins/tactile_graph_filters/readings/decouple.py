"""Step ``decouple``: the conductance of each element, its circuit's crosstalk taken out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from annotated_types import Gt
from numpy.typing import NDArray

from tactile_graph.errors import Degenerate
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.wires import Image
from tactile_graph_filters.nan import finite, refuse_nan

if TYPE_CHECKING:
    from tactile_graph_pads.circuits import Inverse


class Decouple:
    """Return the conductances that measure as the given voltages, by the circuit's inverse.

    Parameters
    ----------
    pad : str or mapping
        Name of a pad, its YAML file, or the pad itself: its circuit is meant. The wrong circuit
        makes things worse, not better.
    max_residual : float
        Largest relative misfit at which an inverse that iterates counts as found. Where it is
        larger, the conductances nearest to the voltages are, if what they miss is noise.

    Notes
    -----
    The divider's inverse (thesis section 2.3) is in closed form and exact; the floating
    circuit's is a damped Newton iteration in log conductance, started anew at every frame so
    that a frame's answer depends on no other. Voltages with noise or in a converter's steps are no
    network's: least squares then finds the nearest conductances, none below 0, and they are
    taken if their root mean square misfit is at most twice the noise and the rounding that the
    pad's `scan` and `converter` state. Where the data are impossible (a column of the
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

        its = load_pad(pad)
        self._circuit, self._noise_v = its.circuit, its.noise_v
        self._max_residual = max_residual

    def __call__(
        self, image: Annotated[Image, Quantity("volt")]
    ) -> Annotated[Image, Quantity("siemens"), Grid.like("image")]:
        """Return the image in siemens.

        Raises
        ------
        Degenerate
            If the inverse iterates and comes neither closer than ``max_residual`` nor within
            the pad's noise.
        DataError
            If a valid cell holds NaN or infinity.
        """
        volts = image.filled(0.0)
        if not finite(volts):
            refuse_nan(image, infinite=True)
        found = self._circuit.inverse(volts / self._circuit.supply_v)
        if found.residual > self._max_residual:
            found = self._nearest(volts, image.valid, found)
        siemens, valid = found.siemens, image.valid
        if np.count_nonzero(found.valid) != volts.size:
            valid = found.valid if valid is None else valid & found.valid
        if valid is not None:
            siemens = np.where(valid, siemens, 0.0)
        return Image(siemens, image.pitch_cm, image.origin_cm, "siemens", valid)

    def _nearest(
        self, volts: NDArray[np.float64], valid: NDArray[np.bool_] | None, missed: Inverse
    ) -> Inverse:
        """Return the conductances nearest to voltages that are no network's, if noise made them so.

        Raises
        ------
        Degenerate
            If they are farther off than that.
        """
        from tactile_graph_pads.circuits.nearest import MOST_NOISES

        said = (
            f"the inverse of the {self._circuit.kind} circuit stopped after"
            f" {missed.iterations} steps at a misfit of {missed.residual:.2g},"
            f" allowed is {self._max_residual:.2g}"
        )
        circuit, noise = self._circuit, self._noise_v / self._circuit.supply_v
        if circuit.kind == "floating" and noise > 0.0 and missed.valid.any():
            seen = np.ones(volts.shape, np.bool_) if valid is None else valid
            found, off = circuit.nearest(volts / circuit.supply_v, noise, seen)
            if off <= MOST_NOISES:
                return found
            said += (
                f"; the nearest conductances miss the voltages by {off:.3g} times the noise of"
                f" {self._noise_v:.2g} V that the pad's scan and converter state, allowed is"
                f" {MOST_NOISES:g}"
            )
        raise Degenerate(f"{said}: are these that circuit's voltages?")
