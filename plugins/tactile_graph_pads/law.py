"""``ForceLaw``: the resistance of an element against the force on it, and back, exactly.

Three pieces that meet with equal value and slope: a turn-on that falls off faster than any
power, the power law, and a saturation that levels off. Each has a closed inverse.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later

Array = NDArray[np.float64]

LEAST_ROOM = 1e-12
"""Of the conductance left above saturation: below it rounding decides, so no load is told."""


@compiled_later
def conductance_kernel(load_g: Array, law: Array) -> Array:
    """Return the conductance in siemens of each element under ``load_g``; ``law`` as packed."""
    p, log_c, log_on, bend, log_sat, headroom = law
    out = np.zeros(load_g.shape)
    for r in range(load_g.shape[0]):
        for c in range(load_g.shape[1]):
            load = load_g[r, c]
            if load <= 0.0:
                continue
            x = math.log(load)
            below = min(x - log_on, 0.0)
            over = max(x - log_sat, 0.0)
            g = math.exp(log_c + p * (x - over) - bend * below * below)
            if over > 0.0:
                g *= 1.0 - headroom * math.expm1(-p / headroom * over)
            out[r, c] = g
    return out


@compiled_later
def load_kernel(siemens: Array, law: Array) -> Array:
    """Return the force in grams behind each conductance; inf where no force can reach it."""
    p, log_c, log_on, bend, log_sat, headroom = law
    out = np.zeros(siemens.shape)
    for r in range(siemens.shape[0]):
        for c in range(siemens.shape[1]):
            g = siemens[r, c]
            if g <= 0.0:
                continue
            y = math.log(g) - log_c
            drop = y - p * log_on
            excess = y - p * log_sat
            if drop < 0.0 and bend > 0.0:
                x = log_on + 2.0 * drop / (p + math.sqrt(p * p - 4.0 * bend * drop))
            elif excess > 0.0:
                room = 1.0 - (math.exp(excess) - 1.0) / headroom
                x = log_sat - headroom / p * math.log(room) if room > LEAST_ROOM else math.inf
            else:
                x = y / p
            out[r, c] = math.exp(x)
    return out


@dataclass(frozen=True)
class ForceLaw:
    """Resistance against force: a power law through one or two points, with its two ends.

    Parameters
    ----------
    load_g, resistance_ohm : float
        A point on the power law; the thesis gives 100 g at 80 kOhm (section 2.3.2).
    load2_g, resistance2_ohm : float
        A second point, 2 kg at 1 kOhm; makes the exponent unless that is given.
    exponent : float, optional
        ``R ~ F^-exponent`` through the first point. Thesis section 2.1.1 names 2, the maker's
        guide about 1; the two points give 1.463.
    turn_on_g : float
        Below it the resistance rises faster than the power law; 0 for none.
    turn_on_bend : float
        How fast: ``ln R`` gains ``turn_on_bend * ln(F / turn_on_g)**2``.
    saturation_g : float
        Above it the resistance levels off; infinite for none.
    saturation_headroom : float
        Conductance still to be gained above that load, as a share of the one reached there.
    repeatability : float
        Standard deviation of ln R between readings of the same load (the maker states 2 to 15 %).
    """

    load_g: Annotated[float, Gt(0)] = 100.0
    resistance_ohm: Annotated[float, Gt(0)] = 80e3
    load2_g: Annotated[float, Gt(0)] = 2000.0
    resistance2_ohm: Annotated[float, Gt(0)] = 1e3
    exponent: Annotated[float, Gt(0)] | None = None
    turn_on_g: Annotated[float, Ge(0)] = 10.0
    turn_on_bend: Annotated[float, Ge(0)] = 4.0
    saturation_g: Annotated[float, Gt(0)] = 10_000.0
    saturation_headroom: Annotated[float, Gt(0)] = 0.5
    repeatability: Annotated[float, Ge(0)] = 0.0
    may_be_infinite: ClassVar[tuple[str, ...]] = ("saturation_g",)
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    def __post_init__(self) -> None:
        if self.exponent is None:
            ratio_f, ratio_r = (
                self.load2_g / self.load_g,
                self.resistance_ohm / self.resistance2_ohm,
            )
            if ratio_f == 1.0 or math.log(ratio_r) / math.log(ratio_f) <= 0.0:
                raise ValueError(
                    f"law: the points {self.load_g:g} g at {self.resistance_ohm:g} Ohm and "
                    f"{self.load2_g:g} g at {self.resistance2_ohm:g} Ohm give no falling "
                    "resistance; the heavier load needs the lower resistance, or give exponent"
                )
        if self.turn_on_g >= self.saturation_g:
            raise ValueError(
                f"law: turn_on_g must be below saturation_g, got {self.turn_on_g:g} "
                f"and {self.saturation_g:g}"
            )

    @property
    def power(self) -> float:
        """Exponent of the power law, about 1.46 through the thesis' two points."""
        if self.exponent is not None:
            return self.exponent
        return math.log(self.resistance_ohm / self.resistance2_ohm) / math.log(
            self.load2_g / self.load_g
        )

    @cached_property
    def packed(self) -> Array:
        """The law's numbers as the kernels take them."""
        log_c = -math.log(self.resistance_ohm) - self.power * math.log(self.load_g)
        has_turn_on = self.turn_on_g > 0.0 and self.turn_on_bend > 0.0
        packed = np.array(
            [
                self.power,
                log_c,
                math.log(self.turn_on_g) if has_turn_on else -1e300,
                self.turn_on_bend if has_turn_on else 0.0,
                math.log(self.saturation_g),
                self.saturation_headroom,
            ]
        )
        packed.setflags(write=False)
        return packed

    @property
    def max_siemens(self) -> float:
        """Conductance no load can reach."""
        p, log_c, _, _, log_sat, headroom = self.packed
        return float(math.exp(log_c + p * log_sat) * (1.0 + headroom))

    def conductance_s(self, load_g: Array) -> Array:
        """Return the conductance of elements under ``load_g``, shape (rows, columns), in siemens.

        Parameters
        ----------
        load_g : ndarray of float64, shape (rows, columns)
            Grams on each element; 0 or less conducts nothing.
        """
        return conductance_kernel(np.ascontiguousarray(load_g, dtype=np.float64), self.packed)

    def load_of(self, siemens: Array) -> Array:
        """Return the grams behind each conductance, the exact inverse of `conductance_s`.

        Parameters
        ----------
        siemens : ndarray of float64, shape (rows, columns)
            Conductances; 0 or less gives 0 g, `max_siemens` or more gives inf.
        """
        return load_kernel.call(np.ascontiguousarray(siemens, dtype=np.float64), self.packed)

    def resistance_at(self, load_g: float) -> float:
        """Return the resistance in ohm under one load; inf at 0."""
        siemens = float(self.conductance_s(np.array([[load_g]]))[0, 0])
        return 1.0 / siemens if siemens > 0.0 else math.inf
