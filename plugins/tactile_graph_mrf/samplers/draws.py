"""Kernels that draw one label or line from its conditional distribution (Eq. 5.9, 5.10, 5.19).

Each takes one uniform number and inverts a cumulative sum, so that equal numbers give equal bits
whether compiled or not. Weights are those of ``exp(-beta (U - U_least))``: the largest is 1, which
is step 2 of section 5.2.3 done so that nothing overflows at any temperature. ``beta`` is the
inverse temperature. Each returns the label and whether no other was possible, its weight being
lost in the rounding of the sum.
"""

from __future__ import annotations

import math
from typing import Any

from tactile_graph.compiled import compiled_as_is
from tactile_graph_mrf.energy.conditionals import least_of

NEGLIGIBLE = 1e-19
"""Weight beside the largest one, 1, below which a level is never drawn."""
NEGLIGIBLE_LOG = 43.7
"""Minus its logarithm."""


@compiled_as_is
def run_of(weight: float, ratio: float, factor: float, count: int) -> float:
    """Return the sum of ``count`` weights outwards from the likeliest level.

    Each is the one before times a ratio that falls by ``factor`` each step. Four interleaved
    chains, for one waits on each product.
    """
    a, b = weight, weight * ratio
    c = b * ratio * factor
    square = factor * factor
    d = c * ratio * square
    fourth = square * square
    stride = ratio * ratio * ratio * ratio * fourth * square
    stride_b = stride * fourth
    stride_c = stride_b * fourth
    stride_d = stride_c * fourth
    fall = fourth * fourth * fourth * fourth
    total = 0.0
    for _ in range(count // 4):
        total += (a + b) + (c + d)
        a *= stride
        b *= stride_b
        c *= stride_c
        d *= stride_d
        stride *= fall
        stride_b *= fall
        stride_c *= fall
        stride_d *= fall
    rest = count % 4
    if rest > 0:
        total += a
    if rest > 1:
        total += b
    if rest > 2:
        total += c
    return total


@compiled_as_is
def weights_of_all(
    narrow: float, off: float, up: float, down: float, factor: float, above: int, below: int
) -> float:
    """Return the sum of exp(-narrow ((k + off)² - off²)) over k from -below to above.

    Over all whole k it is sqrt(pi / narrow) exp(narrow off²) to the last bit where ``narrow`` is
    at most 1/4 (Poisson's summation formula: the next term is exp(-pi² / narrow) of it). What
    lies beyond the ends is taken off again, unless it is most of it.
    """
    reach = math.sqrt(NEGLIGIBLE_LOG / max(narrow, 1e-300))
    steps = max(above, below) if reach > above + below else int(reach) + 2
    if narrow > 0.25 or abs(off) > 0.5 or max(above, below) < 0.5 * reach:
        risen = run_of(up, up * factor, factor, min(steps, above))
        return 1.0 + risen + run_of(down, down * factor, factor, min(steps, below))
    total = math.sqrt(math.pi / narrow) * math.exp(narrow * off * off)
    for side in (above, below):
        if side < steps:
            k = side + 1.0
            first = math.exp(-narrow * k * (k + 2.0 * off))
            ratio = math.exp(-narrow * (2.0 * k + 1.0 + 2.0 * off))
            total -= run_of(first, ratio, factor, steps - side)
        off = -off
    return total


@compiled_as_is
def draw_parabola(sharpness: float, mean: float, n_levels: int, beta: float, u: float) -> Any:
    """Draw a label of density exp(-beta sharpness (x - mean)²): a Gaussian on whole levels.

    A few exponentials, whatever the number of levels: outwards from the likeliest level, each
    weight is the one before times a ratio, and that ratio falls by the same factor each step.
    The levels are gone through from the likeliest one outwards. ``sharpness`` must be above 0.
    """
    mode = int(min(max(math.floor(mean + 0.5), 0.0), n_levels - 1.0))
    narrow = beta * sharpness
    off = mode - mean
    # A step off the end of the scale is never taken, but its weight could overflow.
    rise_up, rise_down = max(1.0 + 2.0 * off, 0.0), max(1.0 - 2.0 * off, 0.0)
    if narrow * min(rise_up, rise_down) > NEGLIGIBLE_LOG:
        return mode, True
    factor = math.exp(-2.0 * narrow)
    up, down = math.exp(-narrow * rise_up), math.exp(-narrow * rise_down)
    above, below = n_levels - 1 - mode, mode
    total = weights_of_all(narrow, off, up, down, factor, above, below)
    if total == 1.0:
        return mode, True
    left = u * total - 1.0
    if left < 0.0:
        return mode, False
    high, low, ratio_up, ratio_down = up, down, up * factor, down * factor
    last = mode
    for k in range(1, max(above, below) + 1):
        if k <= above and high >= NEGLIGIBLE:
            left -= high
            last = mode + k
            if left < 0.0:
                return last, False
            high *= ratio_up
            ratio_up *= factor
        if k <= below and low >= NEGLIGIBLE:
            left -= low
            last = mode - k
            if left < 0.0:
                return last, False
            low *= ratio_down
            ratio_down *= factor
        if high < NEGLIGIBLE and low < NEGLIGIBLE:
            break
    return last, False  # rounding left a crumb over: it belongs to the last level


@compiled_as_is
def draw_cost(costs: Any, kept: Any, beta: float, u: float) -> Any:
    """Draw a label of density exp(-beta costs[x]).

    Levels so dear that their weight is lost need no exponential. ``costs`` and ``kept`` (of
    whole numbers, as long) are used up.
    """
    least = least_of(costs)
    n_kept = 0
    total = 0.0
    for x in range(len(costs)):
        rise = costs[x] - least
        if beta * rise < NEGLIGIBLE_LOG:
            kept[n_kept] = x
            weight = math.exp(-beta * rise) if rise > 0.0 else 1.0
            costs[n_kept] = weight  # overwrites none that is still to be read
            total += weight
            n_kept += 1
    if total == 1.0:  # the weights of others, if any, are lost in the sum
        for s in range(n_kept):
            if costs[s] == 1.0:
                return kept[s], True
    left, last = u * total, kept[0]
    for s in range(n_kept):
        left -= costs[s]
        last = kept[s]
        if left < 0.0:
            break
    return last, False


@compiled_as_is
def draw_line(rise: float, beta: float, u: float) -> Any:
    """Draw whether a line is on that raises the energy by ``rise`` if so."""
    if abs(beta * rise) > NEGLIGIBLE_LOG:
        return rise < 0.0, True
    return u * (1.0 + math.exp(beta * rise)) < 1.0, False
