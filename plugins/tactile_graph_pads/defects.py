"""``Defects``: what is wrong with a pad as built, known or drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, NamedTuple

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray

from tactile_graph_pads.geometry import Geometry

Array = NDArray[np.float64]
Index = Annotated[int, Ge(0)]
Positive = Annotated[float, Gt(0)]


@dataclass(frozen=True)
class Hot:
    """An element with a leak beside it, which reads as loaded when it is not.

    Parameters
    ----------
    row, column : int
        The element, counted from 0.
    resistance_ohm : float
        Resistance of the leak.
    """

    row: Index
    column: Index
    resistance_ohm: Positive
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}


class Built(NamedTuple):
    """One pad as built: what its defects came out as, each shape (rows, columns)."""

    gain: Array
    leak_s: Array
    preload_g: Array
    noise: Array


@dataclass(frozen=True)
class Defects:
    """Known and random faults of a pad.

    Parameters
    ----------
    dead_rows, dead_columns : tuple of int
        Lines that are broken: their elements conduct nothing.
    dead_elements : tuple of (int, int)
        Single elements, (row, column), that conduct nothing.
    hot : tuple of Hot
        Elements with a leak.
    row_gain, column_gain : tuple of float
        Factors of the conductance, one a line; empty for none.
    row_gain_sigma, column_gain_sigma, element_gain_sigma : float
        Standard deviation of the logarithm of further factors, drawn once for a pad.
    preload_g : float
        Load on each element from the pad's own cover.
    preload_sigma : float
        Standard deviation of the logarithm of that load from element to element.
    noisy_rows : tuple of int
        Rows whose readings scatter ``noise_factor`` times as much.
    noise_factor : float
        See ``noisy_rows``; ten in one public data set.
    """

    dead_rows: tuple[Index, ...] = ()
    dead_columns: tuple[Index, ...] = ()
    dead_elements: tuple[tuple[Index, Index], ...] = ()
    hot: tuple[Hot, ...] = ()
    row_gain: tuple[Positive, ...] = ()
    column_gain: tuple[Positive, ...] = ()
    row_gain_sigma: Annotated[float, Ge(0)] = 0.0
    column_gain_sigma: Annotated[float, Ge(0)] = 0.0
    element_gain_sigma: Annotated[float, Ge(0)] = 0.0
    preload_g: Annotated[float, Ge(0)] = 0.0
    preload_sigma: Annotated[float, Ge(0)] = 0.0
    noisy_rows: tuple[Index, ...] = ()
    noise_factor: Annotated[float, Ge(0)] = 10.0
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    def built(self, geometry: Geometry, rng: np.random.Generator | None = None) -> Built:
        """Return one pad with these defects; without ``rng`` the random ones stay at their middle.

        Parameters
        ----------
        geometry : Geometry
        rng : numpy.random.Generator, optional
            Draws the random gains and the preload.
        """
        rows, columns = geometry.shape

        def draw(*shape: int) -> Array:
            return np.zeros(shape) if rng is None else rng.standard_normal(shape)

        gain = np.exp(
            self.row_gain_sigma * draw(rows, 1)
            + self.column_gain_sigma * draw(1, columns)
            + self.element_gain_sigma * draw(rows, columns)
        )
        if self.row_gain:
            gain *= np.array(self.row_gain)[:, None]
        if self.column_gain:
            gain *= np.array(self.column_gain)[None, :]
        leak = np.zeros(geometry.shape)
        for hot in self.hot:
            leak[hot.row, hot.column] += 1.0 / hot.resistance_ohm
        for dead in (gain, leak):
            dead[list(self.dead_rows), :] = 0.0
            dead[:, list(self.dead_columns)] = 0.0
        for row, column in self.dead_elements:
            gain[row, column] = 0.0
        preload = self.preload_g * np.exp(self.preload_sigma * draw(rows, columns))
        noise = np.ones(geometry.shape)
        noise[list(self.noisy_rows), :] = self.noise_factor
        return Built(gain, leak, preload, noise)
