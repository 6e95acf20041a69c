"""Broyden, Fletcher, Goldfarb and Shanno's search for a rectangle's five unknowns."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph_fitters.rectangle.rectangle_likelihood import Window, cost

Values = NDArray[np.float64]

N = 5
# How far the search first goes per unit of slope, relative to a cell: squares of about a fifth
# of a cell, and of a few degrees.
FIRST = (0.024, 0.024, 0.03, 0.024, 0.0015)
LONGEST = 0.8  # of one step, in cells, the angle counted at 6 cells from the centre


@compiled_later
def _restart(inverse: Values, cell: float) -> None:
    """Set the inverse second derivatives to their first guess."""
    for i in range(N):
        for k in range(N):
            inverse[i, k] = 0.0
        inverse[i, i] = FIRST[i] * (cell * cell if i < 4 else 1.0)


@compiled_later
def _direction(inverse: Values, slope: Values, cell: float, step: Values) -> float:
    """Write the step the search takes next, none too long; return the slope along it."""
    along = longest = 0.0
    for i in range(N):
        step[i] = 0.0
        for k in range(N):
            step[i] -= inverse[i, k] * slope[k]
        along += step[i] * slope[i]
        longest = max(longest, abs(step[i]) / cell if i < 4 else 6.0 * abs(step[i]))
    if longest > LONGEST:
        for i in range(N):
            step[i] *= LONGEST / longest
        along *= LONGEST / longest
    return along


@compiled_later
def _learn(inverse: Values, moved: Values, change: Values) -> None:
    """Update the inverse second derivatives by what a step has shown."""
    curve = 0.0
    for i in range(N):
        curve += moved[i] * change[i]
    if curve <= 1e-10:
        return
    turned = np.zeros(N)
    around = 0.0
    for i in range(N):
        for k in range(N):
            turned[i] += inverse[i, k] * change[k]
        around += change[i] * turned[i]
    share = (1.0 + around / curve) / curve
    for i in range(N):
        for k in range(N):
            inverse[i, k] += (
                share * moved[i] * moved[k] - (turned[i] * moved[k] + moved[i] * turned[k]) / curve
            )


@compiled_later
def minimise(
    p: Values, window: Window, law: Values, cell: float, tolerance: float, most: int
) -> tuple[float, int]:
    """Bring ``p`` to a minimum; return the cost there and the rounds made, < 0 if given up."""
    logs, states, xs, ys = window.logs, window.states, window.x_cm, window.y_cm
    inverse, slope, new_slope = np.empty((N, N)), np.empty(N), np.empty(N)
    step, moved, change, trial = np.empty(N), np.empty(N), np.empty(N), np.empty(N)
    _restart(inverse, cell)
    now = cost(p, logs, states, xs, ys, law, slope)
    for rounds in range(1, most + 1):
        along = _direction(inverse, slope, cell, step)
        if along >= 0.0:
            _restart(inverse, cell)
            along = _direction(inverse, slope, cell, step)
        if -along < tolerance:
            return now, rounds
        share = 1.0
        found = False
        new = now
        for _ in range(12):
            for i in range(N):
                trial[i] = p[i] + share * step[i]
            # No side may vanish: the cost is level once the rectangle covers nothing.
            trial[2], trial[3] = max(trial[2], 0.1 * cell), max(trial[3], 0.1 * cell)
            new = cost(trial, logs, states, xs, ys, law, new_slope)
            if new <= now + 1e-4 * share * along:
                found = True
                break
            excess = new - now - share * along
            share *= max(0.1, min(0.5, -0.5 * share * along / excess)) if excess > 0.0 else 0.5
        if not found:  # at a kink, where the slope does not tell the way down
            return now, rounds
        for i in range(N):
            moved[i], change[i] = trial[i] - p[i], new_slope[i] - slope[i]
            p[i], slope[i] = trial[i], new_slope[i]
        if now - new < 0.1 * tolerance:
            return new, rounds
        now = new
        _learn(inverse, moved, change)
    return now, -most
