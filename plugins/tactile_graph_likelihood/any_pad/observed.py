"""From an image of any quantity to readings with their noise: what shows, and what could have."""

from __future__ import annotations

import math

import numpy as np

from tactile_graph.errors import Degenerate, RuleError
from tactile_graph.wires import Image
from tactile_graph_likelihood.any_pad.above_noise import risen
from tactile_graph_likelihood.any_pad.learned_pad import LAWFUL
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.element_terms import OFF, ON, OVER, UNDER, UNKNOWN
from tactile_graph_likelihood.single.problem import LARGE_PAD
from tactile_graph_likelihood.single.readings import Readings, TurnOn, grid_of
from tactile_graph_pads.pad import Pad

SPACED = 4
"""Least readings by whose spacing the least load that shows is extrapolated."""

GAPS = 2.0
"""Mean spacings of the least readings by which what shows may lie below all of them."""

SAME = 0.02
"""Of a pitch: by how much it may differ from the pad's and be taken for it."""

ALIKE, FEWEST_ALIKE, SHARE_ALIKE = 0.04, 5, 0.15
"""Span of the logarithm, and number, of readings that are so alike that they all read the most."""

BEYOND, SHARE_BEYOND = 3, 0.03
"""Readings beyond them that may be strays."""

NEARLY = 0.03
"""Of a cell's width, by which its height may differ: sizes come out wrong by half of that."""

LEAST = 1e-300
"""Load, in whatever unit, whose logarithm is taken for that of all below."""

MISFIT = 1e-3
"""Relative misfit of a circuit's inverse from which on volts are not that circuit's."""


def observed(image: Image, pad: Pad, gap_cm: float | None = None) -> Readings:
    """Return what an image shows, whatever its quantity.

    Parameters
    ----------
    image : Image
        Volts are freed of the pad's circuit, unless most of them cannot be its, and conductances
        turned into loads by its law; any other quantity is taken to rise with load from the
        frame's own zero. Invalid cells say nothing.
    pad : Pad
        What it has learned of its elements from recordings is applied, see `taught`.
    gap_cm : float, optional
        Distance of neighbouring elements' edges, less than the pitch; the pad's if not given, none
        where the image's pitch is not the pad's.

    Returns
    -------
    Readings
        Elements whose reading is no more than noise are `UNDER` the load that would have shown in
        their column; of more than 1024 elements, all show from the same.

    Raises
    ------
    RuleError
        If the cells are not nearly square, or the gap leaves no element.
    DataError
        If a valid cell is not finite or beyond 1e100.
    Degenerate
        If nothing shows.
    """
    across, down = image.pitch_cm
    if abs(across - down) > NEARLY * across:
        raise RuleError(f"needs nearly square cells, got a pitch of {across:g} by {down:g} cm")
    if gap_cm is None:
        gap_cm = pad.geometry.gap_cm if abs(across - pad.geometry.pitch_cm) < SAME * across else 0.0
    grid = grid_of(image, gap_cm)
    above, least, shows, _, its = risen(image, pad)
    if not above.size:
        raise Degenerate("the image has no element: no outline fits")
    loads, least_loads, possible = _loads(image.quantity, above, least, pad)
    known = possible if image.valid is None else image.valid & possible
    if its is not None:
        known = known & its.good
        loads, least_loads = loads / its.gain, least_loads / its.gain
    shows = shows & known
    touched = int(np.count_nonzero(shows))
    if touched == 0:
        raise Degenerate("no reading rises above the noise: no outline fits")
    logs = np.log(np.where(shows, np.maximum(loads, LEAST), 1.0))
    lawful = image.quantity in LAWFUL and pad.law.turn_on_g > 0.0
    edge = least_that_shows(logs[shows], math.log(pad.law.turn_on_g) if lawful else -math.inf)
    turn_on = None
    if lawful:
        hidden = np.sort(least_loads, axis=None)
        turn_on = _turn_on(pad, float(hidden[len(hidden) // 2]))
    logs = np.where(shows, logs, np.maximum(np.log(np.maximum(least_loads, LEAST)), edge))
    states = np.where(shows, np.uint8(ON), np.uint8(UNDER))
    states[~known] = UNKNOWN
    ceiling = ceiling_of(logs[shows])
    if ceiling < math.inf:
        states[shows & (logs >= ceiling)] = OVER
        logs = np.where(states == OVER, ceiling, logs)
    found = Readings(grid, logs, states, touched, down / across, edge, turn_on)
    return uniform(found) if states.size > LARGE_PAD else found


def _turn_on(pad: Pad, hidden_g: float) -> TurnOn:
    """Return what is told of a law at its least loads, with the load that noise hides."""
    law = pad.law
    arm, hidden = math.log(law.load_g / law.turn_on_g), math.log(max(hidden_g, LEAST))
    return TurnOn(math.log(law.turn_on_g), law.turn_on_bend / law.power, arm, hidden)


def _loads(
    quantity: str, above: Values, least: float | Values, pad: Pad
) -> tuple[Values, Values, np.ndarray]:
    """Return loads, the load that each element would have shown as ``least``, and what is possible.

    The second has one row where columns are alike. What has no law is its own load; so are volts
    that are not the circuit's.
    """
    every = np.ones(above.shape, np.bool_)
    if quantity not in ("volt", "siemens"):
        return above, np.atleast_2d(least), every
    siemens, valid, from_s = above, every, least
    if quantity == "volt":
        found = pad.circuit.inverse(above / pad.circuit.supply_v)
        possible = np.count_nonzero(found.valid & (above > 0.0))
        if found.residual > MISFIT or 2 * possible < np.count_nonzero(above):
            return above, np.atleast_2d(least), every
        siemens, valid = np.where(found.valid, found.siemens, 0.0), found.valid
        from_s = least * _siemens_per_volt(siemens, above)
    loads = pad.law.load_of(siemens)
    least_loads = pad.law.load_of(np.atleast_2d(from_s))  # a row where columns are alike
    return loads, least_loads, valid & np.isfinite(loads)


def _siemens_per_volt(siemens: Values, above: Values) -> Values:
    """Return what a volt stands for in each column, by what shows there, shape (columns,)."""
    ratio = np.divide(siemens, above, out=np.zeros(above.shape), where=above > 0.0)
    found = ratio.max(axis=0)
    bare = found <= 0.0
    if not bare.all():
        found[bare] = found[~bare].min()
    return np.asarray(found)


def least_that_shows(logs: Values, told: float) -> float:
    """Return the logarithm of the least load that shows, by the least readings and what is told.

    Parameters
    ----------
    logs : ndarray, shape (N,)
        Logarithms of the readings.
    told : float
        Logarithm of the turn-on load, -inf where nothing is known of one.

    Notes
    -----
    A threshold lies below the least reading by about the mean spacing of the least few (D. S.
    Robson and J. H. Whitlock 1964, 10.1093/biomet/51.1-2.33). What is told is taken as far as it
    lies within twice that.
    """
    m = min(SPACED, len(logs) - 1)
    lowest = np.sort(np.partition(logs, m)[: m + 1]) if m > 0 else logs
    spacing = float(lowest[-1] - lowest[0]) / m if m > 0 else 1.0
    bottom = float(lowest[0])
    return min(max(told, bottom - GAPS * spacing), bottom) if told > -math.inf else bottom - spacing


def ceiling_of(logs: Values) -> float:
    """Return the logarithm of the load at which readings end, infinite where they do not.

    They do where many are alike and hardly any are larger.
    """
    values = np.sort(logs)
    n = len(values)
    many = max(FEWEST_ALIKE, math.ceil(SHARE_ALIKE * n))
    if n < many:
        return math.inf
    widths = values[many - 1 :] - values[: n - many + 1]
    at = int(widths.argmin())
    if widths[at] > ALIKE:
        return math.inf
    last = int(np.searchsorted(values, values[at] + 2.0 * ALIKE, side="right"))
    ends = n - last <= BEYOND + SHARE_BEYOND * n
    return float(values[at]) - 0.5 * ALIKE if ends else math.inf


def uniform(readings: Readings) -> Readings:
    """Return readings whose elements all show from the same load: what large pads' kernels take."""
    under = readings.states == UNDER
    least_log = float(np.median(readings.logs[under])) if under.any() else readings.least_log
    states = np.where(under, OFF, np.where(readings.states == OVER, ON, readings.states))
    return readings._replace(states=states.astype(np.uint8), least_log=least_log)
