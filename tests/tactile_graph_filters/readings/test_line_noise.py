"""Hum and drift that lift lines of a pad above where it cuts off, and loads that look alike."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_clipped import EVERY, disc, given, legs, soles
from helpers_modes import plainly
from tactile_graph_filters.readings.clipped_noise import clipped_noise
from tactile_graph_filters.readings.line_noise import cut_off_noise, line_noise

pytestmark = pytest.mark.usefixtures("plain_kernels")


def hum(rng: np.random.Generator, steps: float, turn: float, white: float) -> np.ndarray:
    """Return 50 Hz hum that turns by so much from row to row, in steps, with noise of its own."""
    its = steps * np.sin(rng.uniform(0.0, 2.0 * np.pi) + turn * np.arange(16))
    return its[:, None] + rng.normal(0.0, white, (16, 16))


def pink(rng: np.random.Generator, steps: float) -> np.ndarray:
    """Return 1/f noise along the order in which cells are read."""
    frequency = np.fft.rfftfreq(256)
    frequency[0] = frequency[1]
    phases = rng.normal(size=129) + 1j * rng.normal(size=129)
    its = np.fft.irfft(phases / np.sqrt(frequency), 256).reshape(16, 16)
    return steps * its / its.std()


def read(values: np.ndarray) -> np.ndarray:
    return np.clip(np.round(values), 0.0, 4095.0)


def hidden(noises: list[np.ndarray], load: np.ndarray, by_columns: bool = False) -> float:
    """Return in which share of frames all but one of the cells that nothing touches are noise."""
    found = []
    for noise in noises:
        values = read(noise + load)
        frame = values.T.copy() if by_columns else values
        least = 4.0 * cut_off_noise.reference(*given(frame))
        found.append(np.count_nonzero(values[load == 0.0] > max(least, 0.5)) <= 1)
    return float(np.mean(found))


@pytest.mark.parametrize(
    ("steps", "turn", "white"),
    [(1.0, 0.41, 0.5), (5.0, 0.41, 2.0), (5.0, 1.0, 2.0), (40.0, 0.41, 9.0), (40.0, 3.0, 9.0)],
)
@pytest.mark.parametrize("radius", [0.0, 2.5, 3.5])
@pytest.mark.parametrize("by_columns", [False, True])
def test_hum_of_any_turn_and_size_is_noise(
    steps: float, turn: float, white: float, radius: float, by_columns: bool
) -> None:
    rng = np.random.default_rng(1)
    noises = [hum(rng, steps, turn, white) for _ in range(20)]
    assert hidden(noises, 1500.0 * disc(radius), by_columns) >= 0.85


@pytest.mark.parametrize("radius", [0.0, 2.5, 3.5])
def test_so_is_what_drifts_along_the_order_in_which_cells_are_read(radius: float) -> None:
    rng = np.random.default_rng(2)
    noises = [pink(rng, 5.0) for _ in range(40)]
    assert hidden(noises, 1500.0 * disc(radius)) >= 0.75


@pytest.mark.parametrize("radius", [0.0, 4.5])
def test_noise_that_is_anywhere_is_told_as_before(radius: float) -> None:
    rng = np.random.default_rng(3)
    for _ in range(20):
        args = given(read(rng.normal(300.0 * disc(radius), 2.0)))
        assert cut_off_noise.reference(*args) == clipped_noise.reference(*args) > 0.0


def plates(rng: np.random.Generator) -> list[np.ndarray]:
    """Return uneven plates on a pad that reads nothing elsewhere, light ones and heavy ones."""
    y, x = np.mgrid[:16, :16]
    found = []
    for _ in range(60):
        across, down = rng.uniform(1.5, 7.0, 2)
        turn, (left, top) = rng.uniform(0.0, np.pi), rng.uniform(4.0, 12.0, 2)
        u = np.cos(turn) * (x - left) + np.sin(turn) * (y - top)
        v = np.cos(turn) * (y - top) - np.sin(turn) * (x - left)
        inside = (np.abs(u) < across) & (np.abs(v) < down) & (rng.random((16, 16)) > 0.1)
        gains = np.exp(rng.normal(0.0, 0.4, (16, 16)))
        found.append(read(inside * gains * np.exp(rng.uniform(1.0, 7.0))))
    return [its for its in found if its.any()]


def test_loads_on_a_pad_that_reads_nothing_elsewhere_are_none() -> None:
    rng = np.random.default_rng(4)
    told = line_noise.reference
    for values in plates(rng):
        assert told(values, EVERY, 0.0, 1.0) == told(values.T, EVERY, 0.0, 1.0) == 0.0


@pytest.mark.parametrize("steps", [2.0, 4.0, 8.0])
@pytest.mark.parametrize("rows", [slice(2, 6), slice(4, 11), slice(0, 5)])
def test_a_rod_from_edge_to_edge_is_none(steps: float, rows: slice) -> None:
    rod = np.zeros((16, 16))
    rod[rows] = np.ceil(steps * np.random.default_rng(5).uniform(0.6, 1.0, rod[rows].shape))
    for values in (rod, rod.T.copy()):
        assert cut_off_noise.reference(*given(values)) == 0.0


def soft_loads(rng: np.random.Generator, peak: float, gains: float) -> list[np.ndarray]:
    """Return soft bars, wedges and rollers that reach across all columns of uneven cells."""
    rows = np.arange(16.0)[:, None]
    found = []
    for _ in range(20):
        uneven = np.exp(rng.normal(0.0, gains, (16, 16)))
        bar = np.exp(-(((rows - rng.uniform(3.0, 12.0)) / rng.uniform(1.5, 3.0)) ** 2) / 2.0)
        wedge = np.clip((rows - rng.uniform(2.0, 8.0)) / 8.0, 0.0, None)
        rollers = np.exp(-((rows - 4.0) ** 2) / 2.0) + np.exp(-((rows - 11.0) ** 2) / 2.0)
        noise = rng.normal(-2.0, 1.0, (16, 16))
        found += [read(peak * uneven * its + noise) for its in (bar, wedge, rollers)]
    return found


@pytest.mark.parametrize("noise", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("peak", [6.0, 8.0, 10.0])
def test_bars_of_a_few_counts_that_stand_out_far_are_none(peak: float, noise: float) -> None:
    rng, rows = np.random.default_rng(7), np.arange(16.0)[:, None]
    told = []
    for _ in range(40):
        bar = peak * np.exp(-(((rows - rng.uniform(4.8, 11.2)) / 2.0) ** 2) / 2.0)
        uneven = np.exp(rng.normal(0.0, 0.1, (16, 16)))
        values = read(bar * uneven + rng.normal(0.0, noise, (16, 16)))
        told.append(line_noise.reference(values, EVERY, 0.0, 1.0) > 0.0)
    assert np.mean(told) < 0.15


@pytest.mark.parametrize("peak", [50.0, 200.0, 1000.0])
@pytest.mark.parametrize("gains", [0.2, 0.4])
def test_soft_loads_from_edge_to_edge_of_uneven_cells_are_none(peak: float, gains: float) -> None:
    loads = soft_loads(np.random.default_rng(6), peak, gains)
    frames = [frame for values in loads for frame in (values, values.T.copy())]
    told = [line_noise.reference(frame, EVERY, 0.0, 1.0) > 0.0 for frame in frames]
    assert np.mean(told) < 0.05


@pytest.mark.parametrize("loads", [legs(1), legs(3), soles()], ids=["legs", "stool", "soles"])
def test_loads_of_few_steps_side_by_side_are_none(loads: np.ndarray) -> None:
    for values in (loads, loads.T.copy()):
        assert cut_off_noise.reference(*given(values)) == 0.0


@pytest.mark.parametrize("seed", range(20))
def test_lines_are_told_alike_in_loops(seed: int) -> None:
    rng = np.random.default_rng(seed)
    noise = hum(rng, rng.uniform(0.0, 20.0), rng.uniform(0.0, 3.0), 2.0)
    values = read(noise + 1500.0 * disc(rng.uniform(0.0, 5.0)))
    for cells in (EVERY, rng.random((16, 16)) < 0.9):
        args = given(values, cells)
        assert plainly(cut_off_noise)(*args) == cut_off_noise.reference(*args)
