"""What the noise of a frame's volts comes to in the loads that were made of them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tactile_graph.errors import Degenerate, RuleError
from tactile_graph.steps.rules import require_same_shape
from tactile_graph.wires import Image
from tactile_graph_likelihood.any_pad.observation.frame_noise import frame_noise
from tactile_graph_likelihood.any_pad.observation.rising import SHOWS, risen
from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.density.element_terms import OFF, ON, UNDER
from tactile_graph_likelihood.single.readings import Readings
from tactile_graph_pads.pad import Pad

BARE = 4.0
"""Times the least that shows, or a step of the converter, up to which what most elements read is a
bare pad's offset."""


class NoiseBehind(NamedTuple):
    """What noise does to logarithms of loads; arrays have the frame's shape.

    ``least`` is the least that each element would have shown, ``width`` the standard deviation that
    noise gives to what it shows, 0 where it shows nothing.
    """

    least: Values
    width: Values


def told_alone(readings: Readings, least: float) -> NoiseBehind:
    """Return that all elements show from the same, and that nothing more is known of noise."""
    shape = readings.states.shape
    return NoiseBehind(np.full(shape, least), np.zeros(shape))


def noise_behind(
    readings: Readings, grams: Image, volts: Image, pad: Pad, least: float
) -> tuple[Readings, NoiseBehind]:
    """Return readings of which those that are no more than noise show nothing, and their noise.

    Parameters
    ----------
    readings : Readings
        Of ``grams``.
    grams, volts : Image
        Loads, and the readings that they were made of.
    pad : Pad
        Its law and circuit; what it has learned of its elements' noise is taken.
    least : float
        Logarithm of the least load that shows without noise.

    Notes
    -----
    What a column's noise stands for grows with what loads it: as much volts of a divider's element
    come from a hundred times the conductance where hardly a twentieth of the supply is left. Where
    less than a quarter of a frame seems bare its volts tell no noise, and readings stay.

    Raises
    ------
    RuleError
        If the images are not of the same shape, or the loads not in grams.
    Degenerate
        If nothing rises above the noise.
    """
    require_same_shape(image=grams, volts=volts)
    if grams.quantity != "gram":
        raise RuleError(f"volts: tell the noise of loads in gram alone, got {grams.quantity}")
    rise = risen(volts, pad)
    step = frame_noise(np.asarray(volts.filled(0.0), np.float64).ravel()).step
    if rise.zero > BARE * max(float(np.max(rise.least)), step):
        return readings, told_alone(readings, least)
    shows = (readings.states == ON) & (rise.above > 0.0)
    if not shows.any():
        raise Degenerate("no reading rises above the noise: no outline fits")
    siemens = pad.law.conductance_s(np.where(shows, grams.values, 0.0))
    per_volt = np.divide(siemens, rise.above, out=np.zeros(siemens.shape), where=shows).max(axis=0)
    per_volt[per_volt == 0.0] = per_volt[per_volt > 0.0].min()
    each = pad.law.load_of(np.atleast_2d(rise.least * per_volt))
    hidden = np.broadcast_to(np.log(np.maximum(each, math.exp(least))), siemens.shape)
    silent = (readings.states == OFF) | ((readings.states == ON) & ~shows)
    states = np.where(silent, np.uint8(UNDER), readings.states)
    logs = np.where(silent, hidden, readings.logs)
    noise = np.hypot(rise.least / SHOWS, step / math.sqrt(12.0))
    width = np.where(shows, _width(readings.logs, rise.above, noise, pad), 0.0)
    return readings._replace(logs=logs).with_states(states), NoiseBehind(hidden, width)


def _width(logs: Values, above: Values, noise: Values, pad: Pad) -> Values:
    """Return the standard deviation of loads' logarithms, given that of the volts behind them."""
    share = np.square(noise / np.maximum(above, noise))
    if pad.circuit.kind == "divider":  # each shares in the noise of its column
        left = np.maximum(pad.circuit.supply_v - above.sum(axis=0), noise)
        share = share + above.shape[0] * np.square(noise / left)
    power, _, turn_on, bend, *_ = pad.law.packed
    steepness = power + 2.0 * bend * np.maximum(turn_on - logs, 0.0)
    return np.asarray(np.sqrt(share) / steepness)
