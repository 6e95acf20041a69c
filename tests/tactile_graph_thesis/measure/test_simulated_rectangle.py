"""Figures 5.8 and 5.9 and the study of section 5.4.1."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph_mrf.energy.line_field import LineField
from tactile_graph_thesis.measure.restorations import Restoration
from tactile_graph_thesis.measure.simulated_rectangle import (
    CHOSEN,
    FLOOR,
    HOT,
    MODEL,
    N_LEVELS,
    NOISE,
    RECTANGLE,
    TOP,
    VARIED,
    cells_amiss,
    figure_5_8,
    schedules,
    state_spaces,
)

pytestmark = pytest.mark.usefixtures("warm_kernels")


def rms(made: Restoration, which: str) -> float:
    assert made.truth is not None
    return float(np.sqrt(np.mean((getattr(made, which).values - made.truth.values) ** 2)))


def test_image_model_and_schedules_are_those_told() -> None:
    assert (FLOOR, TOP, NOISE) == (50.0, 150.0, 15.0)
    assert (slice(5, 11), slice(3, 13)) == RECTANGLE
    assert (MODEL.n_levels, MODEL.lambda_d, MODEL.lambda_l) == (200, 1.0, 1000.0)
    assert tuple(CHOSEN) == (5.0, 0.9, 110)
    assert {what: tuple(s) for what, s in VARIED.items()} == {
        "start temperature": (2.0, 0.9, 110),
        "cooling": (5.0, 0.95, 110),
        "iterations": (5.0, 0.9, 95),
    }
    assert N_LEVELS == (50, 100, 150, 200, 250)


@pytest.mark.slow  # much is compiled
@pytest.mark.parametrize("seed", range(3))
def test_the_line_field_of_least_energy_is_exactly_the_rectangle(seed: int) -> None:
    made = figure_5_8(seed, "restore")
    on = np.zeros((16, 16), bool)
    on[RECTANGLE] = True
    np.testing.assert_array_equal(made.lines.horizontal, on[:-1] ^ on[1:])
    np.testing.assert_array_equal(made.lines.vertical, on[:, :-1] ^ on[:, 1:])
    assert cells_amiss(made) == 0


@pytest.mark.slow  # much is compiled
def test_a_line_that_lacks_makes_cells_amiss() -> None:
    made = figure_5_8(0, "restore")
    vertical = made.lines.vertical.copy()
    vertical[7, 2] = False
    assert cells_amiss(made._replace(lines=LineField.of(made.lined, made.lines.horizontal,
                                                         vertical))) > 0  # fmt: skip
    every = LineField(np.ones((15, 16), np.bool_), np.ones((16, 15), np.bool_))
    assert cells_amiss(made._replace(lines=every)) > 0


@pytest.mark.slow
def test_without_lines_the_image_is_blurred_and_with_them_it_is_not() -> None:
    made = figure_5_8(1, "annealed")
    assert rms(made, "lined") < 0.6 * rms(made, "observed")
    assert rms(made, "smooth") > 1.5 * rms(made, "lined")


@pytest.mark.slow  # much is compiled
def test_the_ways_see_the_same_and_end_the_lower_the_hotter_they_began() -> None:
    made = [figure_5_8(2, way) for way in ("thesis", "annealed", "restore")]  # type: ignore[arg-type]
    for one in made[1:]:
        np.testing.assert_array_equal(one.observed.values, made[0].observed.values)
    energies = [one.energy for one in made]
    assert energies == sorted(energies, reverse=True)


@pytest.mark.slow
def test_two_start_temperatures_of_the_thesis_do_alike_and_a_hot_one_does_not() -> None:
    chosen, two, slower, fewer, hot = schedules(40, 16)
    assert [tuple(one.schedule) for one in (chosen, hot)] == [tuple(CHOSEN), tuple(HOT)]
    assert chosen.rms_levels.mean() == pytest.approx(10.3, abs=1.0)
    assert abs(two.off_chosen_levels) < 1.0
    assert abs(slower.off_chosen_levels) < 1.0
    assert abs(fewer.off_chosen_levels) < 0.01
    assert hot.off_chosen_levels < -3.0
    assert hot.energy < 0.6 * chosen.energy
    assert two.rms_levels.mean() - chosen.rms_levels.mean() == pytest.approx(two.off_chosen_levels)


@pytest.mark.slow
def test_a_finer_state_space_changes_the_image_less_and_less() -> None:
    found = state_spaces(3, 4)
    assert tuple(one.n_levels for one in found) == N_LEVELS
    off = [one.off_finest for one in found]
    assert off == sorted(off, reverse=True)
    assert (off[0] > 1.0, off[3] < 0.6, off[4]) == (True, True, 0.0)
    assert [round(one.step_percent, 2) for one in found] == [2.04, 1.01, 0.67, 0.50, 0.40]
