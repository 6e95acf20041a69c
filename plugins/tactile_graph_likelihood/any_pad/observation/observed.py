"""From an image of any quantity to readings with their noise: what shows, and what could have."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.errors import Degenerate
from tactile_graph.steps.rules import Grid, require_square
from tactile_graph.wires import Image
from tactile_graph_filters.readings.dead_below import without_dead
from tactile_graph_likelihood.any_pad.observation.filtered import is_filtered
from tactile_graph_likelihood.any_pad.observation.learned_pad import LAWFUL
from tactile_graph_likelihood.any_pad.observation.rising import EVERY, SHOWS, Risen, risen
from tactile_graph_likelihood.any_pad.observation.shown import (
    LEAST,
    loads_behind,
    shown_loads,
    told_of_elements,
)
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.density.element_terms import OFF, ON, OVER, UNDER, UNKNOWN
from tactile_graph_likelihood.single.readings import (
    MANY,
    Gap,
    Readings,
    TurnOn,
    grid_of,
)
from tactile_graph_pads.circuits import Inverse
from tactile_graph_pads.circuits.ghosts import GHOSTS, ghosts
from tactile_graph_pads.circuits.nearest import MOST_NOISES
from tactile_graph_pads.pad import Pad

SAME = 0.02
"""Of a pitch: by how much it may differ from the pad's and be taken for it."""

UNSCALED, UNSCALED_STD = ("counts", "raw"), 0.05
"""Quantities that no scale is told of, and how uncertain that leaves an outline's lengths, over the
pitch: where a circuit bends readings at their least, the rim shows too little."""

GAP, GAP_STD, TOLD_GAP_STD = 0.12, 0.12, 0.08
"""Of a pitch: what is believed of the gap of elements that nothing is told of, how far it may be
off, and how far one may be off that is told of a pad of that pitch."""

NEARLY = 0.03
"""Of a cell's longer side, by which the other may be shorter: sizes come out wrong by half of
that."""

NearlySquare = Annotated[Image, Grid(square_to=NEARLY)]
"""An image in any quantity that rises with load."""

UNIFORM = np.array([OFF, ON, UNKNOWN, OFF, ON], np.uint8)
"""What states come to where all elements show from the same load: `UNDER` and `OVER` are none."""

MISFIT = 1e-3
"""Relative misfit of a circuit's inverse from which on volts are not that circuit's."""


class _Loads(NamedTuple):
    """Loads, the load that each would have shown as its least, and which are known, and show.

    The second has one row where columns are alike.
    """

    loads: Values
    least: Values
    known: NDArray[np.bool_]
    shows: NDArray[np.bool_]


def observed(
    image: Image, pad: Pad, gap_cm: float | None = None, *, evened: bool = True
) -> Readings:
    """Return what an image shows, whatever its quantity.

    Parameters
    ----------
    image : Image
        Volts are freed of the pad's circuit, unless most of them cannot be its, and conductances
        turned into loads by its law: of a floating circuit, whose inverse noise upsets, those
        within the noise that the pad states. Any other quantity is taken to rise with load from the
        frame's own zero, in rows and columns that rest higher from theirs (`hot_lines`). Invalid
        cells say nothing, nor do those that are dead far below the others (`dead_below`).
    pad : Pad
        What it has learned of its elements from recordings is applied, see `taught`.
    gap_cm : float, optional
        Distance of neighbouring elements' edges, less than the pitch; the pad's if not given, none
        where the image's pitch is not the pad's.
    evened : bool
        Whether loads are divided by gains that the pad has learned.

    Returns
    -------
    Readings
        Elements whose reading is no more than noise are `UNDER` the load that would have shown in
        their column; where more than 4096 are touched, all show from the same.

    Raises
    ------
    RuleError
        If the cells are not nearly square, the gap leaves no element, or the pad was learned, of
        another shape, pitch or quantity.
    DataError
        If a valid cell is not finite or beyond 1e100.
    Degenerate
        If nothing shows.
    """
    require_square(image, NEARLY)
    gap = None
    if gap_cm is None:
        gap = gap_by(pad, image.pitch_cm)
        gap_cm = gap.middle_cm if gap.is_told else 0.0
    grid = grid_of(image, gap_cm)
    if pad.learned is None:
        image = without_dead(image)
    rise = risen(image, pad)
    if not rise.above.size:
        raise Degenerate("the image has no element: no outline fits")
    found = _readings(image, pad, grid, rise, _known_loads(image, pad, rise, evened))
    if found.is_wide:  # where a limit holds readings, the rim tells little of the gap
        held = found.logs if (found.states == OVER).any() else None
        return uniform(found)._replace(gap=gap, unheld=held)
    unsure_cm = UNSCALED_STD * float(grid[2]) if image.quantity in UNSCALED else 0.0
    return found._replace(gap=gap, length_std_cm=unsure_cm)


def gap_by(pad: Pad, pitch_cm: tuple[float, float]) -> Gap:
    """Return what is believed of the gap of elements of some pitch, by a pad that may be another.

    Parameters
    ----------
    pad : Pad
    pitch_cm : (float, float)
        Across and down.
    """
    across, down = pitch_cm
    pitch = math.sqrt(across * down)
    if abs(across - pad.geometry.pitch_cm) < SAME * across:
        return Gap(pad.geometry.gap_cm, TOLD_GAP_STD * pitch, True)
    return Gap(GAP * pitch, GAP_STD * pitch, False)


def _readings(image: Image, pad: Pad, grid: Values, rise: Risen, told: _Loads) -> Readings:
    """Return what is seen of an image by its loads, its gap left open."""
    loads, least_loads, known, shows = told
    seen, floor = shown_loads.direct(loads, least_loads, shows, known)
    if not seen.size:
        raise Degenerate("no reading rises above the noise: no outline fits")
    turn_on = _turn_on(pad, least_loads) if image.quantity in LAWFUL else None
    logs_seen = np.log(seen)
    ordered = logs_seen.copy()
    ordered.sort()
    (edge, ceiling), logs, states = told_of_elements.direct(
        logs_seen, ordered, np.log(floor), shows, known,
        -math.inf if turn_on is None else turn_on.log_load,
    )  # fmt: skip
    filtered = False
    # A pad that was learned knows its images as they come.
    if rise.taught is None and isinstance(rise.least, float):
        values = np.ascontiguousarray(image.values, dtype=np.float64)
        values.setflags(write=False)
        filtered = is_filtered.direct(values, states, rise.zero, rise.least)
    across, down = image.pitch_cm
    found = Readings(
        grid, logs, states, seen.size, down / across, edge, turn_on, filtered=filtered,
        ghosts=seen.size <= MANY and ghosts.call(loads, shows, known) == GHOSTS,
    )  # fmt: skip
    if ceiling < math.inf and not found.is_wide:
        unheld = logs.copy()
        unheld[found.shows] = logs_seen
        found = found._replace(unheld=unheld, noise=float(np.median(least_loads)) / SHOWS)
    return found


def _known_loads(image: Image, pad: Pad, rise: Risen, evened: bool) -> _Loads:
    """Return loads, of the elements that are valid and good alone, over the gains of these."""
    loads, least_loads, known, shows = _loads(image, rise.above, rise.least, rise.shows, pad)
    if image.valid is not None:
        known = _both(known, image.valid)
    if (its := rise.taught) is not None:
        known = _both(known, its.good)
        if evened:
            loads, least_loads = loads / its.gain, least_loads / its.gain
    return _Loads(loads, least_loads, known, shows)


def _both(known: NDArray[np.bool_], also: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the elements that count by both; kernels take them as frames hold them."""
    both = np.array(also, order="C") if known is EVERY else np.ascontiguousarray(known & also)
    both.setflags(write=False)
    return both


def _turn_on(pad: Pad, least_loads: Values) -> TurnOn | None:
    """Return what is told of a law at its least loads, with the load that noise hides."""
    law = pad.law
    if not law.turn_on_g > 0.0:
        return None
    ordered = least_loads.flatten()
    ordered.sort()
    hidden_g = float(ordered[len(ordered) // 2])
    arm, hidden = math.log(law.load_g / law.turn_on_g), math.log(max(hidden_g, LEAST))
    return TurnOn(math.log(law.turn_on_g), law.turn_on_bend / law.power, arm, hidden)


def _loads(
    image: Image, above: Values, least: float | Values, shows: NDArray[np.bool_], pad: Pad
) -> _Loads:
    """Return loads, those that ``least`` come to, what is possible, and what shows.

    What has no law is its own load; so are volts that are not the circuit's. Last comes what
    ``shows`` that is no ghost.
    """
    least_each = np.array([[least]]) if isinstance(least, float) else least
    if image.quantity == "siemens":
        loads = pad.law.load_of(above)
        possible = np.isfinite(loads)
        possible.setflags(write=False)
        return _Loads(loads, pad.law.load_of(least_each), possible, shows)
    if image.quantity == "volt":
        found = pad.circuit.inverse(above / pad.circuit.supply_v)
        if found.residual <= MISFIT:
            believed, loads, least_loads, possible = loads_behind.call(
                above, found.siemens, found.valid, least_each, pad.law.packed
            )
            if believed:
                possible.setflags(write=False)
                return _Loads(loads, least_loads, possible, shows)
        elif (behind := _behind_noise(image, above, least_each, found, pad)) is not None:
            siemens, least_s = behind
            loads = pad.law.load_of(siemens)
            possible = np.isfinite(loads)
            possible.setflags(write=False)
            return _Loads(loads, pad.law.load_of(least_s), possible, shows & (siemens > least_s))
    return _Loads(above, least_each, EVERY, shows)


def _behind_noise(
    image: Image, above: Values, least: Values, missed: Inverse, pad: Pad
) -> tuple[Values, Values] | None:
    """Return the conductances nearest to a floating circuit's volts, None if not within noise.

    The second are those of elements each of which measures as ``least`` alone on the pad. Where
    bare elements conduct much, readings are a network's with what these read alone; then loads are
    what conducts more than they do, and than noise.
    """
    circuit = pad.circuit
    if circuit.kind != "floating" or pad.noise_v == 0.0 or not math.isfinite(missed.residual):
        return None
    ratio = least / circuit.supply_v
    least_s = ratio / (circuit.bias_ohm - circuit.series_ohm * ratio)
    siemens = _nearest(above, image.valid, pad)
    if siemens is not None:
        return siemens, least_s
    siemens = _nearest(np.asarray(image.filled(0.0), np.float64), image.valid, pad)
    if siemens is None:
        return None
    rise = risen(image.with_values(siemens, "siemens"), replace(pad, learned=None))
    return rise.above, np.maximum(least_s, rise.least)


def _nearest(volts: Values, valid: NDArray[np.bool_] | None, pad: Pad) -> Values | None:
    """Return the conductances of a floating circuit that measure so, None if not within noise."""
    circuit, ratio = pad.circuit, volts / pad.circuit.supply_v
    if circuit.kind != "floating" or float(ratio.max()) >= circuit.bias_ohm / circuit.series_ohm:
        return None
    seen = np.ones(volts.shape, np.bool_) if valid is None else valid
    found, off = circuit.nearest(ratio, pad.noise_v / circuit.supply_v, seen)
    return found.siemens if off <= MOST_NOISES else None


def uniform(readings: Readings) -> Readings:
    """Return readings whose elements all show from the same load, as blocks of them ask."""
    hidden = readings.logs[readings.states == UNDER]
    least_log = _median(hidden) if len(hidden) else readings.least_log
    return readings._replace(states=UNIFORM[readings.states], least_log=least_log)


def _median(values: Values) -> float:
    """Return the median of values that are put in another order: a copy takes longer than it."""
    above = len(values) // 2
    below = above - 1 + len(values) % 2
    values.partition((below, above))
    return 0.5 * float(values[below] + values[above])
