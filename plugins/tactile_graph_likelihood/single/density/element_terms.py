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

UNFELT = -8.0
"""Standard deviations of ln gain by which a load exceeds the least that shows, below which an
untouched element's term is 0 up to rounding."""

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
    shares: Values, load: float, row: int, column: int, logs: Values, states: States, noise: Values
) -> float:
    """Return the log likelihood of a window's readings over that of a bare pad.

    Parameters
    ----------
    shares : ndarray, shape (rows, columns)
        Of a fully covered element's load, on each element of the window; 0 where bare.
    load : float
        Logarithm of a fully covered element's, in the image's unit.
    row, column : int
        Where the window begins.
    logs : ndarray, shape (all rows, all columns)
        Logarithm of each reading that shows; of an element's own least load where it is `UNDER`, of
        the load at which readings end where it is `OVER`.
    states : ndarray of uint8, the same shape
        As named by `OFF`, `ON` and so on.
    noise : ndarray, shape (9,)
        As named by `SIGMA`, `VOIDS` and so on; its contrast is a power of the shares.

    Notes
    -----
    With mu = ln m, u = (ln l - mu) / sigma and z = (mu - ln l_least) / sigma, an element adds
    ``ln(1 + (1 - e) (1 - v) N(u) / sigma / (e / SPAN))`` where it reads l and
    ``ln(1 - (1 - v) Phi(z))`` where it reads nothing. Where it reads the most, it adds
    ``ln(1 + (1 - e) (1 - v) Phi(z) / (e HIGH))``, z being from there.
    """
    # What reads a load and what reads none are told apart without a branch, which would be guessed
    # wrongly at each void, and the logarithm of their factors is taken now and then.
    rows, columns = shares.shape
    per_sigma, half, least = 1.0 / noise[SIGMA], 0.5 * (1.0 - noise[VOIDS]), noise[LEAST]
    level, odds, contrast = on_level(noise), over_odds(noise), noise[CONTRAST]
    on, off, n_on, n_off = np.empty(rows * columns), np.empty(rows * columns), 0, 0
    total, product, last, mu = 0.0, 1.0, 1.0, load
    for i in range(rows):
        for j in range(columns):
            share = shares[i, j]
            if share <= 0.0:
                continue
            if share != last:
                last, mu = share, load + contrast * math.log(share)
            state, log = states[row + i, column + j], logs[row + i, column + j]
            on[n_on] = (log - mu) * per_sigma
            n_on += 1 if state == ON else 0
            off[n_off] = (mu - (log if state == UNDER else least)) * per_sigma
            n_off += 1 if state in (OFF, UNDER) and off[n_off] > UNFELT else 0
            if state == OVER:
                z = (mu - log) * per_sigma
                total += math.log(1.0 + odds * 0.5 * math.erfc(-SQRT_HALF * z))
    for k in range(n_on):
        a = level - 0.5 * on[k] * on[k]
        if a > 30.0:
            total += a
        else:
            product *= 1.0 + math.exp(a)
        if product > 1e200:
            total += math.log(product)
            product = 1.0
    for k in range(n_off):
        product *= 1.0 - half * math.erfc(-SQRT_HALF * off[k])
        if product < 1e-200:
            total += math.log(product)
            product = 1.0
    return total + math.log(product)
