"""Idle rows and columns left open: each reading is the whole network between two lines.

Current finds detours through other elements, so three loaded corners of a rectangle make a ghost
at the fourth (D'Alessio 1999; Medrano-Sanchez 2019, 10.1109/JSEN.2019.2918592).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_twin_of
from tactile_graph_pads.circuits.inverse import Inverse
from tactile_graph_pads.circuits.nearest import nearest_above
from tactile_graph_pads.circuits.newton import solve_log

Array = NDArray[np.float64]

NEGLIGIBLE = 1e-100
"""Conductance over the frame's largest below which an element conducts nothing."""

NONE_BY_NOISE = 1e-9
"""The same where noise hides more than that."""


@np.errstate(over="ignore")  # a conductance near 0 has a resistance that is infinite
def _equivalent(siemens: Array) -> Array:
    """Return the conductance between each row and column through the whole network.

    Parameters
    ----------
    siemens : ndarray of float64, shape (rows, columns)

    Notes
    -----
    For each column as ground the other columns' stars become meshes between the rows, then the
    rows are eliminated; no step subtracts, so every entry keeps its digits (see `network`).
    """
    rows, columns = siemens.shape
    total = siemens.sum(axis=0)
    share = siemens / np.where(total > 0.0, total, 1.0)
    others = 1.0 - np.eye(columns)
    mesh = np.zeros((columns, rows, rows + 1))
    mesh[:, :, :rows] = (share * others[:, None, :]) @ siemens.T
    mesh[:, :, rows] = siemens.T
    mesh[:, np.arange(rows), np.arange(rows)] = 0.0
    factor = np.zeros((columns, rows, rows)) + np.eye(rows)
    resistance = np.zeros((columns, rows))
    for k in range(rows):
        row = mesh[:, k, k + 1 :]
        pivot = row.sum(axis=1)
        ground = np.where(pivot > 0.0, pivot, 1.0)
        part = row[:, :-1] / ground[:, None]
        mesh[:, k + 1 :, k + 1 :] += part[:, :, None] * row[:, None, :]
        factor[:, k + 1 :, : k + 1] += part[:, :, None] * factor[:, None, k, : k + 1]
        seen = factor[:, k, : k + 1] ** 2
        open_end = np.where(seen > 0.0, np.inf, 0.0)
        resistance[:, : k + 1] += np.where(pivot[:, None] > 0.0, seen / ground[:, None], open_end)
    return np.ascontiguousarray(1.0 / resistance.T)


@compiled_twin_of(_equivalent)
def equivalent_s(siemens: Array) -> Array:  # noqa: D103
    rows, columns = siemens.shape
    out = np.zeros((rows, columns))
    total = np.zeros(columns)
    for r in range(rows):
        for c in range(columns):
            total[c] += siemens[r, c]
    for ground in range(columns):
        mesh = np.zeros((rows, rows + 1))
        for c in range(columns):
            if c == ground or total[c] <= 0.0:
                continue
            for a in range(rows):
                share = siemens[a, c] / total[c]
                if share > 0.0:
                    for b in range(a + 1, rows):
                        mesh[a, b] += share * siemens[b, c]
        for a in range(rows):
            mesh[a, rows] = siemens[a, ground]
            for b in range(a):
                mesh[a, b] = mesh[b, a]
        factor = np.zeros((rows, rows))
        resistance = np.zeros(rows)
        for k in range(rows):
            factor[k, k] = 1.0
            pivot = 0.0
            for b in range(k + 1, rows + 1):
                pivot += mesh[k, b]
            for i in range(k + 1):
                seen = factor[k, i] * factor[k, i]
                if pivot > 0.0:
                    resistance[i] += seen / pivot
                elif seen > 0.0:
                    resistance[i] = np.inf
            if pivot <= 0.0:
                continue
            for a in range(k + 1, rows):
                part = mesh[k, a] / pivot
                if part > 0.0:
                    for b in range(k + 1, rows + 1):
                        mesh[a, b] += part * mesh[k, b]
                    for i in range(k + 1):
                        factor[a, i] += part * factor[k, i]
        for a in range(rows):
            out[a, ground] = 1.0 / resistance[a]
    return out


def _log_jacobian(siemens: Array, on: NDArray[np.bool_], equivalent: Array) -> Array:
    """Return d ln G_eq / d ln g over the conducting elements, shape (n, n)."""
    return np.asarray(_slopes(siemens, on) * siemens[on] * equivalent[on][:, None])


def _slopes(siemens: Array, on: NDArray[np.bool_]) -> Array:
    """Return how equivalent resistances fall with conductances, shape (n, n).

    ``dR_e / dg_f = -(E^T L+ E)_ef^2`` with L+ the pseudoinverse of the network's Laplacian.
    """
    rows, columns = siemens.shape
    laplacian = np.zeros((rows + columns, rows + columns))
    laplacian[:rows, rows:] = -siemens
    laplacian[rows:, :rows] = -siemens.T
    np.fill_diagonal(laplacian, np.concatenate([siemens.sum(axis=1), siemens.sum(axis=0)]))
    plus = np.linalg.pinv(laplacian, rcond=1e-15, hermitian=True)
    i, j = np.nonzero(on)
    j = j + rows
    drop = plus[:, i] - plus[:, j]
    transfer = drop[i] - drop[j]
    return np.asarray(transfer**2)


@dataclass(frozen=True)
class Floating:
    """Multiplexers on both sides: one row driven, one column read, all other lines open.

    Parameters
    ----------
    kind : "floating"
    bias_ohm : float
        Resistor from the read column to ground.
    supply_v : float
        What drives the row.
    driver_ohm, mux_ohm : float
        Resistances in series with the driven row and the read column.
    """

    kind: Literal["floating"] = "floating"
    bias_ohm: Annotated[float, Gt(0)] = 33e3
    supply_v: Annotated[float, Gt(0)] = 5.0
    driver_ohm: Annotated[float, Ge(0)] = 0.0
    mux_ohm: Annotated[float, Ge(0)] = 0.0
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    @property
    def series_ohm(self) -> float:
        """Everything in series with the network."""
        return self.bias_ohm + self.driver_ohm + self.mux_ohm

    def ratio(self, siemens: Array) -> Array:
        """Return what each element measures as, in shares of the supply, shape (rows, columns)."""
        through = equivalent_s(np.ascontiguousarray(siemens))
        return np.asarray(self.bias_ohm * through / (1.0 + self.series_ohm * through))

    def inverse(self, ratio: Array, start: Array | None = None) -> Inverse:
        """Return the conductances that measure as ``ratio``.

        Parameters
        ----------
        ratio : ndarray of float64, shape (rows, columns)
            Measured volts over supply volts; 0 or less, or 1e-100 of the largest, stands for an
            element that does not conduct.
        start : ndarray of float64, shape (rows, columns), optional
            Conductances to start from, such as the last frame's: takes a third of the time.

        Notes
        -----
        A reading above what a short circuit gives is impossible. As every reading depends on
        every element, the whole frame is then invalid. Noise can also make data that no network
        gives; the answer is then the nearest that Newton finds, and the residual says how near.
        """
        left = 1.0 - ratio * (self.series_ohm / self.bias_ohm)
        if (left <= 0.0).any():
            return Inverse(np.zeros(ratio.shape), np.zeros(ratio.shape, np.bool_), np.inf)
        valid = np.ones(ratio.shape, np.bool_)
        on = ratio > 0.0
        if not on.any():
            return Inverse(np.zeros(ratio.shape), valid)
        target = np.where(on, ratio / (self.bias_ohm * left), 0.0)
        # A network's conductance is in proportion to its parts': of a size near 1 none overflows.
        unit = float(target.max())
        if not unit > 0.0:
            return Inverse(np.zeros(ratio.shape), valid)
        target /= unit
        on &= target > NEGLIGIBLE
        siemens = np.zeros(ratio.shape)
        last: dict[str, Array] = {}

        def log_model(log_siemens: Array) -> Array:
            siemens[on] = np.exp(log_siemens)
            last["through"] = equivalent_s(siemens)
            return np.log(last["through"][on])

        def jacobian(log_siemens: Array) -> Array:
            siemens[on] = np.exp(log_siemens)
            return _log_jacobian(siemens, on, last["through"])

        if start is None:
            start = target * (target / np.where(on, equivalent_s(target), 1.0))
        else:
            start = start / unit
        first = np.log(np.where(start[on] > 0.0, start[on], target[on]))
        found = solve_log(np.log(target[on]), log_model, jacobian, first)
        siemens[on] = np.exp(found.log_siemens) * unit
        return Inverse(siemens, valid, found.residual, found.iterations)

    def nearest(self, ratio: Array, noise: float, seen: NDArray[np.bool_]) -> tuple[Inverse, float]:
        """Return the conductances that come nearest to noisy data, and their misfit over the noise.

        Parameters
        ----------
        ratio : ndarray of float64, shape (rows, columns)
            Measured volts over supply volts, less than a short circuit gives.
        noise : float
            Standard deviation of ``ratio``, above 0.
        seen : ndarray of bool, shape (rows, columns)
            Elements whose data count.

        Returns
        -------
        Inverse
            Nowhere negative; its residual is the largest misfit over the largest datum.
        float
            Root mean square of the misfits, in ``noise``. 1 or less is found.

        Notes
        -----
        Noise makes data that no network gives, and `inverse` follows it into logarithms of
        nothing. Conductances, unlike these, end at 0.
        """
        positive = np.where(seen, np.maximum(ratio, 0.0), 0.0)
        target = positive / (self.bias_ohm - self.series_ohm * positive)
        unit = float(target.max(initial=0.0))
        if not unit > 0.0:
            return Inverse(np.zeros(ratio.shape), np.ones(ratio.shape, np.bool_)), 0.0
        target /= unit
        every, bias, series = (
            np.ones(ratio.shape, np.bool_),
            self.bias_ohm * unit,
            self.series_ohm * unit,
        )
        weight = np.where(seen, 1.0 / noise, 0.0)

        def misfit(flat: Array) -> Array:
            through = equivalent_s(flat.reshape(ratio.shape))
            return np.ravel((ratio - bias * through / (1.0 + series * through)) * weight)

        def jacobian(flat: Array) -> Array:
            siemens = flat.reshape(ratio.shape)
            through = equivalent_s(siemens)
            by_ohm = bias * (through / (1.0 + series * through)) ** 2 * weight
            return np.asarray(np.ravel(by_ohm)[:, None] * _slopes(siemens, every))

        start = target * (target / np.where(target > 0.0, equivalent_s(target), 1.0))
        found = nearest_above(misfit, jacobian, np.ravel(start), NONE_BY_NOISE)
        flat = np.where(found.found > NONE_BY_NOISE, found.found * unit, 0.0)
        worst = float(np.abs(misfit(found.found)).max()) * noise / float(positive.max())
        n_seen = max(int(np.count_nonzero(seen)), 1)
        off = float(np.sqrt(found.mean_square * ratio.size / n_seen))
        return Inverse(flat.reshape(ratio.shape), every, worst, found.iterations), off
