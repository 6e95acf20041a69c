"""Where readings begin: what that says of a law's turn-on and exponent."""

from __future__ import annotations

import math
from itertools import product
from typing import NamedTuple

import numpy as np

from tactile_graph.compiled import compiled_as_is, compiled_later
from tactile_graph_likelihood.any_pad.observation.shown import GAPS, SPACED
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.density.element_terms import ON, States
from tactile_graph_likelihood.single.readings import Readings

FEW = 2
"""Readings below the told turn-on, for the law there to be in question."""

AS_TOLD = 2.5
"""Nats by which a law that is no steeper below its turn-on must explain readings better, to be as
probable as the told one."""

SURE = 0.02
"""Probability below which one of the two is none."""

LEAST_STD = 0.1
"""Of ln load: no turn-on is known better."""

OTHER = (0.3, 0.2, 0.2)
"""Probability that exponent, gains or turn-on are quite other than told, each for itself."""

AS_IS, AS_ELSE = (0.07, 0.07, 0.1), (0.3, 0.4, 1.5)
"""Deviations of the logarithms of exponent, sigma and turn-on as told, and of others."""

EVEN, EVEN_STD = 0.1, 2.0
"""Probability that a pad is quite even, and the deviation of the logarithm of sigma then: elements
of calibrated and capacitive pads vary by a hundredth to a tenth."""


LEAST_REACH = 0.1
"""Of the told distance of the turn-on below the load by which the law is known."""


class Edge(NamedTuple):
    """How far above the told turn-on readings begin, and its deviation, both of ln load.

    ``arm`` is how far that turn-on lies below the load by which the law is known.
    """

    off: float
    std: float
    arm: float


def unbent(readings: Readings) -> tuple[Readings, float] | None:
    """Return readings as by a law that is no steeper below its turn-on.

    Returns
    -------
    (Readings, float) or None
        And the log of how much denser these readings lie by that law than by the told one. None
        where the told law is no steeper there, or hardly anything reads less than its turn-on.
    """
    turn_on = readings.turn_on
    if turn_on is None or turn_on.bend <= 0.0:
        return None
    if readings.least_log is not None and readings.least_log >= turn_on.log_load:
        return None
    low = lows.call(readings.logs, readings.states, turn_on.log_load)
    if len(low) < FEW:
        return None
    return straightened(readings, 1.0), float(np.log1p(-2.0 * turn_on.bend * low).sum())


def straightened(readings: Readings, share: float) -> Readings:
    """Return readings as by a law with so much less of what is left of a bend below its turn-on."""
    turn_on = readings.turn_on
    if turn_on is None or turn_on.bend <= 0.0:
        return readings
    first, left = turn_on.log_load, (1.0 - share) * turn_on.bend
    taken = turn_on.bend / turn_on.chance - turn_on.bend
    by, least_log = (first, taken, share * turn_on.bend), readings.least_log
    return readings._replace(
        logs=straight_logs.call(readings.logs, *by),
        least_log=None if least_log is None else straight.call(least_log, *by),
        turn_on=turn_on._replace(
            bend=left,
            hidden=straight.call(turn_on.hidden, *by),
            chance=turn_on.chance * (1.0 - share),
        ),
    )


@compiled_as_is
def straight(log: float, first: float, taken: float, more: float) -> float:
    """Return the logarithm of a load less ``more`` times its squared distance below ``first``.

    The distance is as told: before a bend of ``taken`` was taken off.
    """
    low = min(log - first, 0.0)
    told = low if taken <= 0.0 else (1.0 - math.sqrt(1.0 - 4.0 * taken * low)) / (2.0 * taken)
    return log - more * (told * told)


@compiled_as_is
def straight_logs(logs: Values, first: float, taken: float, more: float) -> Values:
    """Return `straight` of each of some logarithms, shape (rows, columns)."""
    out = np.empty(logs.shape)
    for i in range(logs.shape[0]):
        for j in range(logs.shape[1]):
            out[i, j] = straight(logs[i, j], first, taken, more)
    return out


@compiled_later
def lows(logs: Values, states: States, first: float) -> Values:
    """Return how far below ``first`` those readings lie that do, shape (N,), in order."""
    found, n = np.empty(logs.size), 0
    for i in range(logs.shape[0]):
        for j in range(logs.shape[1]):
            found[n] = logs[i, j] - first
            n += 1 if states[i, j] == ON and found[n] < 0.0 else 0
    return found[:n]


def chance_of_a_bend(gain: float) -> float:
    """Return the probability of the told law's bend.

    Parameters
    ----------
    gain : float
        Nats by which the law without it explains readings better.
    """
    return 1.0 / (1.0 + math.exp(min(max(gain - AS_TOLD, -50.0), 50.0)))


def edge_of(readings: Readings) -> Edge | None:
    """Return where readings begin, None where noise or the law's own turn-on hides it."""
    turn_on = readings.turn_on
    if turn_on is None:
        return None
    least = least_of.call(readings.logs, readings.states, SPACED + 1)
    m = len(least) - 1
    if m < 1:
        return None
    lowest = [log - turn_on.log_load for log in least.tolist()]
    if turn_on.bend > 0.0 and lowest[FEW - 1] < 0.0:
        return None
    bottom, spacing = lowest[0], (lowest[-1] - lowest[0]) / m
    if bottom - max(GAPS * spacing, LEAST_STD) <= turn_on.hidden - turn_on.log_load:
        return None
    if bottom <= GAPS * spacing:
        return Edge(min(bottom, 0.0), LEAST_STD, turn_on.arm)
    return Edge(bottom - spacing, max(spacing, LEAST_STD), turn_on.arm)


@compiled_later
def least_of(logs: Values, states: States, most: int) -> Values:
    """Return the least of the logarithms that show, ascending, so many at most."""
    least, n = np.full(most, np.inf), 0
    for i in range(logs.shape[0]):
        for j in range(logs.shape[1]):
            if states[i, j] != ON or logs[i, j] >= least[most - 1]:
                continue
            k = min(n, most - 1)
            while k > 0 and least[k - 1] > logs[i, j]:
                least[k] = least[k - 1]
                k -= 1
            least[k] = logs[i, j]
            n = min(n + 1, most)
    return least[:n]


def contrast_by(scatter: float, edge: Edge, touched: int) -> float:
    """Return the law's exponent over the told one.

    Parameters
    ----------
    scatter : float
        Ln of sigma over the told one.
    edge : Edge
    touched : int
        Readings that tell sigma.

    Notes
    -----
    With x the logarithm of the exponent over the told one, g that of the gains' sigma and t that of
    how far the turn-on lies below the load by which the law is known, all over what is told,
    readings scatter by x + g, and how far they reach below that load grows by x + t. Each of the
    three is about as told or, less probably, quite other; the mean of x follows by Bayes' rule.
    """
    reach = max(edge.arm - edge.off, LEAST_REACH * edge.arm)
    longer, its_variance = math.log(reach / edge.arm), (edge.std / reach) ** 2
    return math.exp(mean_over.call(WORLDS, scatter, longer, touched, its_variance, edge.arm))


@compiled_later
def mean_over(
    worlds: Values, scatter: float, longer: float, touched: int, variance: float, arm: float
) -> float:
    """Return the mean of x over all worlds, each a row of `WORLDS`; see `contrast_by`."""
    total = mean = 0.0
    for k in range(worlds.shape[0]):
        weight, exponent, gains, begin = worlds[k, 0], worlds[k, 1], worlds[k, 2], worlds[k, 3]
        first = exponent + gains + 0.5 / touched
        second = exponent + begin / (arm * arm) + variance
        determinant = first * second - exponent * exponent
        by_first = (second * scatter - exponent * longer) / determinant
        by_second = (first * longer - exponent * scatter) / determinant
        chance = weight * math.exp(-0.5 * (scatter * by_first + longer * by_second))
        chance /= math.sqrt(determinant)
        total += chance
        mean += chance * exponent * (by_first + by_second)
    return mean / total if total > 0.0 else 0.0


def chance_of_an_even_pad(scatter: float, touched: int) -> float:
    """Return the probability that a pad is quite even by how readings scatter alone.

    Parameters
    ----------
    scatter : float
        Ln of sigma over the told one.
    touched : int
        Readings that tell sigma.
    """
    even = usual = 0.0
    for weight, exponent, gains, _ in WORLDS.tolist():
        variance = exponent + gains + 0.5 / max(touched, 1)
        chance = weight * math.exp(-0.5 * scatter * scatter / variance) / math.sqrt(variance)
        if gains >= EVEN_STD**2:
            even += chance
        else:
            usual += chance
    return even / (even + usual)


def log_density_of_gains(log_sigma: float, touched: int, beside: float = 0.0) -> float:
    """Return the log density of a fit's ln sigma over the told one, by what is told of gains.

    Parameters
    ----------
    log_sigma : float
    touched : int
        Readings that tell it.
    beside : float
        Deviation that something else adds.
    """
    total = 0.0
    for weight, own in ((1.0 - OTHER[1], AS_IS[1]), (OTHER[1], AS_ELSE[1])):
        variance = own * own + beside * beside + 0.5 / max(touched, 1)
        total += weight * math.exp(-0.5 * log_sigma**2 / variance) / math.sqrt(variance)
    return math.log(max(total, 1e-300))


def _worlds() -> Values:
    """Return probability and variances of what is as told and what is not, in all ways, (12, 4)."""
    exponents, gains, begins = (
        [(1.0 - p, as_is), (p, as_else)]
        for p, as_is, as_else in zip(OTHER, AS_IS, AS_ELSE, strict=True)
    )
    gains = [((1.0 - EVEN) * p, std) for p, std in gains] + [(EVEN, EVEN_STD)]
    return np.array([
        (math.prod(p for p, _ in ways), *(std * std for _, std in ways))
        for ways in product(exponents, gains, begins)
    ])  # fmt: skip


WORLDS = _worlds()
