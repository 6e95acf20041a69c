"""How likely what the elements read is, given the load that is expected on each.

An element of expected load m reads nothing with the probability v of a void, else m times a
lognormal gain; what falls below the least load that shows reads as nothing too. With the
probability e of a stray an element reads something that has nothing to do with the object, its
logarithm uniform over `SPAN`. All is relative to a pad on which every reading is a stray.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_as_is, compiled_later
from tactile_graph_likelihood.geometry.outlines import Values

OFF, ON, UNKNOWN, UNDER, OVER = range(5)
"""What is known of an element: reads nothing, reads a load, broken or saturated, reads nothing, as
far as its own least load goes, or a load at which readings end."""

States: TypeAlias = NDArray[np.uint8]

SIGMA, VOIDS, STRAYS, LEAST, FOAM, FALL, LEAN_X, LEAN_Y, CONTRAST = range(9)
"""Places in a noise vector: width of ln gain, share of voids, probability of a stray, logarithm
of the least load that shows, width of a foam blur in cells; `pressure`'s fall and lean; the power
of coverage that readings go with, 1 where they are loads."""

SPAN = math.log(1e4)
"""Width of the logarithm of a stray's load, and of the prior of a covered element's load."""

HIGH = 0.5
"""Share of strays that read the most that an element can."""

ROOT_TWO_PI = math.sqrt(2.0 * math.pi)
SQRT_HALF = math.sqrt(0.5)


@compiled_as_is
def on_level(noise: Values) -> float:
    """Return the log of the densest reading's likelihood over a stray's."""
    peak = (1.0 - noise[STRAYS]) * (1.0 - noise[VOIDS]) / (noise[SIGMA] * ROOT_TWO_PI)
    return math.log(peak) - math.log(noise[STRAYS] / SPAN)


@compiled_as_is
def over_odds(noise: Values) -> float:
    """Return how much likelier an element reads the most, where it bears that, than by a stray."""
    odds: float = (1.0 - noise[STRAYS]) * (1.0 - noise[VOIDS]) / (HIGH * noise[STRAYS])
    return odds


@compiled_later
def terms(
    expected: Values, row: int, column: int, logs: Values, states: States, noise: Values
) -> float:
    """Return the log likelihood of a window's readings over that of a bare pad.

    Parameters
    ----------
    expected : ndarray, shape (rows, columns)
        Load expected on each element of the window, in the image's unit; 0 where bare.
    row, column : int
        Where the window begins.
    logs : ndarray, shape (all rows, all columns)
        Logarithm of each reading that shows; of an element's own least load where it is `UNDER`, of
        the load at which readings end where it is `OVER`.
    states : ndarray of uint8, the same shape
        As named by `OFF`, `ON` and so on.
    noise : ndarray, shape (9,)
        As named by `SIGMA`, `VOIDS` and so on.

    Notes
    -----
    With mu = ln m, u = (ln l - mu) / sigma and z = (mu - ln l_least) / sigma, an element adds
    ``ln(1 + (1 - e) (1 - v) N(u) / sigma / (e / SPAN))`` where it reads l and
    ``ln(1 - (1 - v) Phi(z))`` where it reads nothing. Where it reads the most, it adds
    ``ln(1 + (1 - e) (1 - v) Phi(z) / (e HIGH))``, z being from there.
    """
    # Factors are multiplied up, and their logarithm taken now and then.
    sigma, present = noise[SIGMA], 1.0 - noise[VOIDS]
    level, odds = on_level(noise), over_odds(noise)
    total, product = 0.0, 1.0
    load, mu, off, known = -1.0, 0.0, 0.0, math.nan
    for i in range(expected.shape[0]):
        for j in range(expected.shape[1]):
            m = expected[i, j]
            if m <= 0.0:
                continue
            state = states[row + i, column + j]
            if state == UNKNOWN:
                continue
            if m != load:
                load, mu, known = m, math.log(m), math.nan
            if state == ON:
                u = (logs[row + i, column + j] - mu) / sigma
                a = level - 0.5 * u * u
                if a > 30.0:
                    total += a
                elif a > -30.0:
                    product *= 1.0 + math.exp(a)
            elif state == OVER:
                z = (mu - logs[row + i, column + j]) / sigma
                product *= 1.0 + odds * 0.5 * math.erfc(-SQRT_HALF * z)
            else:
                least = logs[row + i, column + j] if state == UNDER else noise[LEAST]
                if least != known:
                    z = (mu - least) / sigma
                    off = 1.0 - present * 0.5 * math.erfc(-SQRT_HALF * z)
                    known = least
                product *= off
            if not 1e-200 < product < 1e200:
                total += math.log(product)
                product = 1.0
    return total + math.log(product)


@compiled_as_is
def bare(states: States, noise: Values) -> float:
    """Return the log likelihood of a whole image's readings where nothing lies on the pad."""
    stray = math.log(noise[STRAYS] / SPAN)
    none = math.log(1.0 - noise[STRAYS])
    total = 0.0
    for i in range(states.shape[0]):
        for j in range(states.shape[1]):
            if states[i, j] == ON:
                total += stray
            elif states[i, j] != UNKNOWN:
                total += none
    return total
