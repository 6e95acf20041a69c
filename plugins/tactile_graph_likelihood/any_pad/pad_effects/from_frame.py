"""What the fit of an outline says of the pad: its unevenness, its strays, what hangs together."""

from __future__ import annotations

import math
from typing import NamedTuple

from tactile_graph.compiled import compiled_later
from tactile_graph_likelihood.any_pad.pad_effects.turn_on import (
    chance_of_an_even_pad,
    contrast_by,
    edge_of,
    log_density_of_gains,
    straightened,
)
from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE, Values
from tactile_graph_likelihood.single.changed import changed
from tactile_graph_likelihood.single.density.element_terms import CONTRAST, ON, OVER, States
from tactile_graph_likelihood.single.model import Model
from tactile_graph_likelihood.single.noise import SPREADS, Noise
from tactile_graph_likelihood.single.readings import Readings

LAW = 0.35
"""Of ln sigma that is not as told, the share that is the law's exponent, not the gains'."""

LAWLESS, LAWLESS_STD = 0.25, 0.45
"""The same of readings that no law is told of, where they scatter less than told, and the standard
deviation of that share: a pad that is more even, or whose readings go with a root of the load."""

EVENED, EVENED_STD = -0.3, 0.17
"""What foam, which spreads loads that are uneven, adds to ln sigma, and its deviation."""

MOST_TOLD = 6.0
"""Nats that readings' scatter may say for or against foam."""

FITTED = 3.0
"""Numbers of an outline, by which fewer residuals than readings are free."""

NORMAL = 1.4826
"""Standard deviation over the median distance from the median."""

FEWEST = 6
"""Readings, for sigma to be taken from them."""

TOLD_STRAYS = 50.0
"""Bare elements that what is told of strays is worth."""

MOST_STRAYS = 0.3

PAIRS = 1.6
"""Pairs of neighbours for each touched element."""

CHANCE = 1.0
"""Standard deviations of neighbours' likeness that are put down to chance."""

LEAST_ALIKE, MOST_ALIKE = 0.03, 0.95
"""Correlation of neighbours below which it is none, and to which it is held."""


class Contrast(NamedTuple):
    """The power of coverage that readings go with, and its standard deviation."""

    power: float
    std: float = SPREADS[CONTRAST]


AS_LOADS = Contrast(1.0)
"""Of readings that are loads."""


def learned(
    told: Noise, scatter: Values, touched: int, strays: float, contrast: Contrast = AS_LOADS,
    shared: float = 1.0,
) -> Noise:  # fmt: skip
    """Return the noise that a fit has found.

    Parameters
    ----------
    told : Noise
    scatter : ndarray, shape (2,)
        Ln sigma and the voids' log odds.
    touched : int
        Readings that show.
    strays : float
    contrast : Contrast
    shared : float
        By how many times less elements are worth, as neighbours share their gains.
    """
    sigma = _freed(float(scatter[0]), touched) * math.sqrt(shared)
    voids = 1.0 / (1.0 + math.exp(-scatter[1]))
    power, std = contrast
    return changed(told, sigma=sigma, voids=voids, strays=strays, contrast=power, contrast_std=std)


def contrast_of(told: Noise, log_sigma: float, readings: Readings, law: float = LAW) -> Contrast:
    """Return the law's exponent over the told one.

    Parameters
    ----------
    told : Noise
    log_sigma : float
        Ln of a fit's sigma.
    readings : Readings
    law : float
        Of ln sigma that is not as told, the share that is the law's exponent, not the gains'; 0
        where it is none.

    Notes
    -----
    Readings that scatter more or less than told may do so since gains do, or since the law's
    exponent is another. Where readings begin tells which (`contrast_by`), if that is seen: by the
    told law or, as far as its bend is improbable, by that without. Readings that no law is told of
    and that scatter less may be those of an even pad, or go with a root of the load: nobody knows.
    The less they scatter, the more probable is a pad that is quite even.
    """
    if law <= 0.0:
        return AS_LOADS
    other = math.log(_freed(log_sigma, readings.touched) / told.sigma)
    turn_on = readings.turn_on
    if turn_on is None and other < 0.0:
        share = LAWLESS * (1.0 - chance_of_an_even_pad(other, readings.touched))
        return Contrast(1.0 + share * other, math.hypot(SPREADS[CONTRAST], LAWLESS_STD * other))
    begin = readings.through_foam or readings
    if (edge := edge_of(begin)) is not None:
        return Contrast(contrast_by(other, edge, readings.touched))
    unseen = 1.0 + law * (1.0 - chance_of_an_even_pad(other, readings.touched)) * other
    if turn_on is None or turn_on.chance >= 1.0:
        return Contrast(unseen)
    if (edge := edge_of(straightened(begin, 1.0))) is None:
        return Contrast(unseen)
    straight = contrast_by(other, edge, readings.touched)
    return Contrast(turn_on.chance * unseen + (1.0 - turn_on.chance) * straight)


def evened_by_foam(by_foam: float, by_face: float, touched: int) -> float:
    """Return by how much readings' scatter makes foam more probable than a round face.

    Parameters
    ----------
    by_foam, by_face : float
        Ln sigma of a fit under foam, and of a round face, over the told one.
    touched : int
        Readings that tell it.
    """
    foam = log_density_of_gains(by_foam - EVENED, touched, EVENED_STD)
    found = foam - log_density_of_gains(by_face, touched)
    return math.exp(min(max(found, -MOST_TOLD), MOST_TOLD))


def _freed(log_sigma: float, touched: int) -> float:
    """Return sigma as if no number were fitted to its readings."""
    return math.exp(log_sigma) * math.sqrt(1.0 + FITTED / max(touched, FEWEST))


def strays_beyond(model: Model, readings: Readings, p: Values) -> float:
    """Return the share of strays, by what reads beyond the box around an outline."""
    inside, shows = within.call(readings.states, readings.grid, p, *half_extents(model.kind, p))
    beyond, bare = readings.touched - shows, readings.states.size - inside
    found = (beyond + TOLD_STRAYS * model.noise.strays) / (bare + TOLD_STRAYS)
    return min(found, MOST_STRAYS)


@compiled_later
def within(states: States, grid: Values, p: Values, wide: float, high: float) -> tuple[int, int]:
    """Return how many elements a box around a point touches, and how many of them show."""
    rows, columns = states.shape
    x, y, pitch, side = p[0] - grid[0], p[1] - grid[1], grid[2], grid[3]
    r0 = max(math.ceil((y - high - side) / pitch), 0)
    r1 = min(max(math.floor((y + high) / pitch) + 1, 0), rows)
    c0 = max(math.ceil((x - wide - side) / pitch), 0)
    c1 = min(max(math.floor((x + wide) / pitch) + 1, 0), columns)
    shows = 0
    for i in range(r0, r1):
        for j in range(c0, c1):
            shows += 1 if states[i, j] == ON or states[i, j] == OVER else 0
    return max(r1 - r0, 0) * max(c1 - c0, 0), shows


def is_partly_hidden(kind: int, readings: Readings, p: Values) -> bool:
    """Return whether an outline reaches more than half a pitch beyond the pad's edge.

    Then nobody knows where on it its pressure is measured. A disc's rim says where it ends.
    """
    return kind != DISC and room_on_pad(kind, readings, p) < -0.5


def room_on_pad(kind: int, readings: Readings, p: Values) -> float:
    """Return how many pitches an outline is away from the pad's edge; below 0 it is beyond."""
    left, top, pitch = readings.grid[:3].tolist()
    (x, y), (wide, high) = p[:2].tolist(), half_extents(kind, p)
    width, height = readings.size_cm
    room_x = min(x - left, left + width - x) - wide
    room_y = min(y - top, top + height - y) - high
    return float(min(room_x, room_y) / pitch)


def half_extents(kind: int, p: Values) -> tuple[float, float]:
    """Return half the width and height of an outline: no kernel, which would take a second more."""
    if kind == DISC:
        return float(p[2]), float(p[2])
    cos, sin = abs(math.cos(p[4])), abs(math.sin(p[4]))
    if kind == RECTANGLE:
        return p[2] * cos + p[3] * sin, p[2] * sin + p[3] * cos
    return math.hypot(p[2] * cos, p[3] * sin), math.hypot(p[2] * sin, p[3] * cos)


def lines(middle: float, half: float, pitch: float, side: float) -> slice:
    """Return the rows or columns of elements that a stretch touches."""
    first = math.ceil((middle - half - side) / pitch)
    return slice(max(first, 0), max(math.floor((middle + half) / pitch) + 1, 0))


def variance_inflation(neighbours: float, touched: int) -> float:
    """Return by how much what hangs together widens an outline's variance, at least 1.

    Parameters
    ----------
    neighbours : float
        How alike neighbours' residuals are, as in `GoodnessOfFit`.
    touched : int

    Notes
    -----
    Where neighbours correlate by rho, and further elements as under a Gaussian, elements along a
    rim are worth ``sqrt(pi / -ln rho)`` times fewer.
    """
    alike = (neighbours - CHANCE) / math.sqrt(PAIRS * max(touched, 1))
    if alike <= LEAST_ALIKE:
        return 1.0
    return max(1.0, math.sqrt(math.pi / -math.log(min(alike, MOST_ALIKE))))
