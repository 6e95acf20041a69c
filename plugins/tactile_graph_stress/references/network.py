"""The decouplers' nodal equations, solved backwards to 50 digits."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_stress.references.stationary import DIGITS, SETTLED, STEP

Values = NDArray[np.float64]


class Conductances(NamedTuple):
    """What readings stand for, and how much they move with them.

    Parameters
    ----------
    siemens : list of lists of mpf
    condition : float
        Largest sum, over the readings, of the relative change of one conductance for a relative
        change of each.
    """

    siemens: list[list[Any]]
    condition: float


def conductances(circuit: Any, volts: Values, near_s: Values) -> Conductances | None:
    """Return the conductances that measure exactly as ``volts``.

    Newton's method on the logarithms, the network solved node by node for each element
    (`tactile_graph_pads.circuits.nodal`); None if it does not settle.

    Parameters
    ----------
    circuit : Divider, Floating or Feedback
    volts : ndarray, shape (rows, columns)
        All above 0.
    near_s : ndarray, shape (rows, columns)
        Conductances to start from, all above 0.
    """
    from mpmath import exp, inverse, log, lu_solve, matrix, mp, mpf, norm

    rows, columns = volts.shape
    n = rows * columns
    with mp.workdps(DIGITS):
        supply = mpf(circuit.supply_v)
        target = matrix([log(mpf(float(v)) / supply) for v in volts.ravel()])
        x = matrix([log(mpf(float(s))) for s in near_s.ravel()])

        def model(logs: Any) -> Any:
            return matrix([log(v) for v in _ratios(circuit, [exp(v) for v in logs], columns)])

        for _ in range(25):
            here = model(x)
            slopes = matrix(n, n)
            for k in range(n):
                moved = x.copy()
                moved[k] += mpf(STEP)
                slopes[:, k] = (model(moved) - here) / mpf(STEP)
            step = lu_solve(slopes, target - here)
            x += step
            if norm(step) < SETTLED:
                back = inverse(slopes)
                rows_of = (sum(abs(back[i, k]) for k in range(n)) for i in range(n))
                flat = [exp(v) for v in x]
                grid = [flat[i * columns : (i + 1) * columns] for i in range(rows)]
                return Conductances(grid, float(max(rows_of)))
        return None


def readings(circuit: Any, siemens: Values) -> Values:
    """Return the volts that conductances measure as, rounded once."""
    from mpmath import mp, mpf

    with mp.workdps(DIGITS):
        flat = [mpf(float(s)) for s in siemens.ravel()]
        ratios = _ratios(circuit, flat, siemens.shape[1])
        supply = mpf(circuit.supply_v)
        return np.array([float(v * supply) for v in ratios]).reshape(siemens.shape)


def _ratios(circuit: Any, flat: list[Any], columns: int) -> list[Any]:
    from mpmath import mpf

    from tactile_graph_pads.circuits.nodal import measured_ratio

    grid = [flat[i : i + columns] for i in range(0, len(flat), columns)]
    found = measured_ratio(
        circuit.kind,
        grid,
        mpf(circuit.bias_ohm),
        mpf(circuit.driver_ohm),
        mpf(getattr(circuit, "mux_ohm", 0.0)),
    )
    return [v for row in found for v in row]
