"""``Bench``: one pad as built, on which objects are put down and read."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Shape
from tactile_graph_pads.pad import Pad

Array = NDArray[np.float64]
ON_ONE_PAD = "Ours is one simulated pad, drawn from the seed; another seed gives another pad."
"""How what is read on a bench differs from the thesis'."""


class Bench:
    """A pad with its unevenness drawn once, as it stays for a whole study.

    Parameters
    ----------
    pad : Pad
    rng : numpy.random.Generator
    """

    def __init__(self, pad: Pad, rng: np.random.Generator) -> None:
        self.pad, self.rng = pad, rng
        self.built = pad.built(rng)
        self._fields = pad.unevenness.draw(pad.geometry, rng)

    def gains(self) -> Array:
        """Return the elements' gains for an object that is put down anew."""
        placement = self.pad.unevenness.draw(self.pad.geometry, self.rng)
        return self.pad.unevenness.gains(self._fields, placement)

    def load_g(
        self, shape: Shape, weight_g: float, gains: Array, offset_cm: tuple[float, float] = (0, 0)
    ) -> Array:
        """Return what each element bears of an object, shape (rows, columns), in grams.

        Parameters
        ----------
        shape : Circle, Ellipse, Rectangle or Polygon
        weight_g : float
        gains : ndarray, shape (rows, columns)
        offset_cm : (float, float)
            Where its centre of pressure lies from its centre.
        """
        return self.pad.contact.load_g(shape, weight_g, self.pad.geometry, gains, offset_cm)

    def volts(self, load_g: Array) -> Array:
        """Return one scan of the pad under these loads, shape (rows, columns)."""
        pad = self.pad
        siemens = pad.conductance_s(load_g, self.built)
        if pad.law.repeatability > 0.0:
            siemens *= np.exp(pad.law.repeatability * self.rng.standard_normal(siemens.shape))
        counts = pad.scan.counts(pad.volts_of(siemens), pad.converter, self.rng, self.built.noise)
        return pad.converter.volts(counts)

    def siemens(self, volts: Array) -> tuple[Array, NDArray[np.bool_]]:
        """Return the conductances behind a scan, decoupled, and which of them are possible.

        Parameters
        ----------
        volts : ndarray, shape (rows, columns)
        """
        found = self.pad.circuit.inverse(volts / self.pad.circuit.supply_v)
        return found.siemens, found.valid
