"""From loads to what shows of them: loops and machine code against what they are said to do."""

import math

import numpy as np
import pytest

from helpers_modes import held, plainly
from tactile_graph_likelihood.any_pad.observation.rising import EVERY
from tactile_graph_likelihood.any_pad.observation.shown import (
    LEAST,
    loads_behind,
    shown_loads,
    told_of_elements,
)
from tactile_graph_likelihood.single.density.element_terms import ON, OVER, UNDER, UNKNOWN
from tactile_graph_pads.pad import load_pad

PAD = load_pad("thesis")
SUPPLY_V = PAD.circuit.supply_v


def volts(rng, shape=(16, 16)):
    """What shows of loads on a quarter of a pad, and nothing elsewhere."""
    load = np.zeros(shape)
    rows, columns = shape
    load[: rows // 2, columns // 2 :] = 50.0 * rng.lognormal(
        size=(rows // 2, columns - columns // 2)
    )
    return SUPPLY_V * PAD.circuit.ratio(PAD.law.conductance_s(load))


def behind(kernel, above, least, siemens=None):
    found = PAD.circuit.inverse(above / SUPPLY_V)
    siemens = found.siemens if siemens is None else siemens
    return kernel(above, siemens, found.valid, least, PAD.law.packed)


def told(rng, shape, share):
    """What `told_of_elements` takes of a frame, its ceiling not always reached."""
    shows = rng.random(shape) < share
    shows.flat[0] = True
    known = held(rng.random(shape) < 0.9)
    n = int(np.count_nonzero(shows & known))
    seen = np.minimum(rng.standard_normal(n), rng.choice([0.1, 9.0]))
    floor = rng.standard_normal((1, shape[1]))
    return seen, np.sort(seen), floor, shows, known, rng.choice([-math.inf, -1.0])


def test_loads_are_those_of_the_law_and_a_columns_least_is_worth_what_shows_there():
    above = volts(np.random.default_rng(1))
    believed, loads, least, possible = behind(plainly(loads_behind), above, np.array([[0.01]]))
    siemens = PAD.circuit.inverse(above / SUPPLY_V).siemens
    assert believed
    assert possible.all()
    np.testing.assert_array_equal(loads, PAD.law.load_of(siemens))
    ratio = np.divide(siemens, above, out=np.zeros(above.shape), where=above > 0.0).max(axis=0)
    ratio[:8] = ratio[8:].min()  # the bare columns
    np.testing.assert_array_equal(least, PAD.law.load_of(0.01 * ratio[None]))


def test_volts_that_are_mostly_not_the_circuits_are_not_believed():
    above = np.full((16, 16), 2.0)  # 32 V over one resistor
    assert not behind(plainly(loads_behind), above, np.array([[0.01]]))[0]
    above[:, 2:] = 0.01
    assert behind(plainly(loads_behind), above, np.array([[0.01]]))[0]


def test_a_conductance_beyond_the_law_is_impossible():
    above = volts(np.random.default_rng(2))
    siemens = PAD.circuit.inverse(above / SUPPLY_V).siemens.copy()
    siemens[1, 9] = 2.0 * PAD.law.max_siemens
    _, loads, _, possible = behind(plainly(loads_behind), above, np.array([[0.01]]), siemens)
    assert loads[1, 9] == math.inf
    assert np.argwhere(~possible).tolist() == [[1, 9]]


def test_only_known_loads_are_shown_in_the_order_of_their_elements():
    loads = np.array([[3.0, 0.0, 5.0], [7.0, 11.0, 13.0]])
    shows = np.array([[True, True, False], [True, True, True]])
    known = held(np.array([[True, True, True], [True, False, True]]))
    seen, floor = plainly(shown_loads)(loads, np.array([[0.0, 2.0, 3.0]]), shows, known)
    assert seen.tolist() == [3.0, LEAST, 7.0, 13.0]
    assert floor.tolist() == [[LEAST, 2.0, 3.0]]
    assert plainly(shown_loads)(loads, floor, shows, EVERY)[0].tolist() == [3.0, LEAST, 7, 11, 13]


@pytest.mark.parametrize("seed", range(6))
def test_states_say_what_shows_what_could_have_and_what_reads_the_most(seed):
    seen, ordered, floor, shows, known, turn_on = told(np.random.default_rng(seed), (16, 16), 0.4)
    (edge, _), logs, states = plainly(told_of_elements)(seen, ordered, floor, shows, known, turn_on)
    on = shows & known
    assert edge <= ordered[0]
    np.testing.assert_array_equal(states == UNKNOWN, ~known)
    np.testing.assert_array_equal(states == UNDER, known & ~shows)
    np.testing.assert_array_equal(np.isin(states, (ON, OVER)), on)
    np.testing.assert_array_equal(logs[states == ON], seen[states[on] == ON])
    ends = np.unique(logs[states == OVER])
    assert len(ends) == (ordered[-1] <= 0.1)
    assert len(ends) == 0 or (logs[states == ON] < ends[0]).all()
    hidden = np.maximum(np.broadcast_to(floor, (16, 16)), edge)
    np.testing.assert_array_equal(logs[~on], hidden[~on])


@pytest.mark.slow  # much is compiled
@pytest.mark.parametrize("shape", [(1, 1), (3, 7), (16, 16), (40, 33)])
@pytest.mark.parametrize("each", [False, True])
def test_loops_and_machine_code_answer_to_the_bit(shape, each):
    rng = np.random.default_rng(3)
    above, least = volts(rng, shape), np.array([[0.01]])
    if each:
        least = 0.01 + 0.001 * rng.random(shape)
    one, other = (
        behind(plainly(loads_behind), above, least),
        behind(loads_behind.compiled, above, least),
    )
    assert one[0] == other[0]
    for a, b in zip(one[1:], other[1:], strict=True):
        np.testing.assert_array_equal(a, b)
    given = one[1], one[2], above > 0.0, held(one[3].copy())
    for a, b in zip(plainly(shown_loads)(*given), shown_loads.compiled(*given), strict=True):
        np.testing.assert_array_equal(a, b)
    for share in (0.01, 0.3, 1.0):
        given = told(rng, shape, share)
        if not len(given[0]):
            continue
        one, other = plainly(told_of_elements)(*given), told_of_elements.compiled(*given)
        for a, b in zip(one, other, strict=True):
            np.testing.assert_array_equal(a, b)
