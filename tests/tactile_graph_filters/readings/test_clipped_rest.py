"""What a device cut off of noise is put back; loads on pads that truly read zero are left."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from tactile_graph.wires import Image
from tactile_graph_filters.readings.clipped_rest import cut_off_below
from tactile_graph_filters.readings.load import Load, LoadOf, counts_cells_at_rest
from tactile_graph_filters.thresholds.noise_level import noise_level

SHAPE = (48, 18)
Y, X = np.mgrid[: SHAPE[0], : SHAPE[1]]
Made = Callable[[np.random.Generator], NDArray[np.float64]]
ANYWHERE = np.ones(SHAPE, np.bool_)


def load_of(values: NDArray[np.float64], valid: NDArray[np.bool_] = ANYWHERE) -> Load:
    image = Image(values, valid=valid)
    return LoadOf()(image, image.mask(values >= noise_level(image)))


def pressed(values: NDArray[np.float64]) -> NDArray[np.float64]:
    values[2:8, 5:13] += 30.0
    return values


def bump(width: float, height: float) -> NDArray[np.float64]:
    return height * np.exp(-((Y - 20) ** 2 + (X - 8) ** 2) / 2 / width**2)


@pytest.mark.parametrize("step", [0.1, 0.5, 1.0])
@pytest.mark.parametrize("offset", [0.0, 0.3, 0.7])
def test_a_clipped_pad_s_load_is_that_of_the_same_pad_unclipped(offset: float, step: float) -> None:
    for seed in range(3):
        whole = pressed(np.random.default_rng(seed).normal(offset, 1.0, SHAPE))
        clipped, unclipped = load_of(np.maximum((whole / step).round() * step, 0.0)), load_of(whole)
        noise = np.sqrt(whole.size)
        assert clipped.total == pytest.approx(unclipped.total, abs=3.0 * noise)
        assert clipped.x_cm == pytest.approx(9.0, abs=0.4)
        assert clipped.y_cm == pytest.approx(5.0, abs=0.4)


@pytest.mark.parametrize(
    "valid",
    [ANYWHERE, X < 12, np.random.default_rng(0).random(SHAPE) < 0.4],
    ids=["all", "two thirds", "two fifths, anywhere"],
)
def test_clipped_noise_alone_is_no_load_and_a_press_is_all_of_it(valid: NDArray[np.bool_]) -> None:
    for seed in range(3):
        noise = np.random.default_rng(seed).normal(0.0, 1.0, SHAPE)
        empty = load_of(np.maximum(noise, 0.0), valid)
        assert (empty.loaded, empty.x_cm) == (False, None)
        found = load_of(np.maximum(pressed(noise), 0.0), valid)
        n = np.count_nonzero(valid[2:8, 5:13])
        assert found.loaded
        assert found.total == pytest.approx(30.0 * n, abs=4.0 * np.sqrt(np.count_nonzero(valid)))


@pytest.mark.parametrize("dead", [X < 4, np.random.default_rng(0).random(SHAPE) < 0.3])
def test_dead_cells_that_read_zero_are_no_noise(dead: NDArray[np.bool_]) -> None:
    for seed in range(3):
        noise = np.where(dead, 0.0, np.random.default_rng(seed).normal(0.0, 1.0, SHAPE))
        assert not load_of(np.maximum(noise, 0.0)).loaded
        whole = pressed(noise)
        assert load_of(np.maximum(whole, 0.0)).total == pytest.approx(whole.sum(), abs=90.0)


def test_the_soft_edge_of_a_load_on_clipped_noise_stays_part_of_it() -> None:
    for seed in range(3):
        whole = np.random.default_rng(seed).normal(0.0, 1.0, SHAPE) + bump(3.0, 60.0)
        assert load_of(np.maximum(whole, 0.0)).total == pytest.approx(whole.sum(), abs=60.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    "made",
    [
        lambda rng: np.floor(bump(3.0, 60.0)),
        lambda rng: np.floor(bump(8.0, 60.0) * rng.lognormal(0.0, 0.1, SHAPE)),
        lambda rng: np.maximum(X - 7.0, 0.0) * rng.lognormal(0.0, 0.1, SHAPE),
        lambda rng: np.floor(np.maximum(3.0 * np.sin(X) * np.sin(0.7 * Y), 0.0)),
        lambda rng: np.where(rng.random(SHAPE) < 0.1, rng.uniform(5.0, 50.0, SHAPE), 0.0),
        lambda rng: np.where(rng.random(SHAPE) < 0.3, rng.uniform(0.0, 50.0, SHAPE), 0.0),
        lambda rng: np.where(rng.random(SHAPE) < 0.5, rng.uniform(0.0, 50.0, SHAPE), 0.0),
        lambda rng: np.where(rng.random(SHAPE) < 0.5, 4.0, 0.0),
        lambda rng: np.where(X < 9, rng.uniform(1.0, 3.0, SHAPE), 0.0),
        lambda rng: np.kron(rng.random((24, 9)) < 0.4, np.ones((2, 2))) * rng.random(SHAPE),
    ],
    ids=["soft", "softer", "wedge", "folds", "few cells", "more", "half", "switches", "half a bed",
         "blocks"],
)  # fmt: skip
def test_loads_on_a_pad_that_truly_reads_zero_are_left_as_they_are(made: Made) -> None:
    for seed in range(3):
        values = made(np.random.default_rng(seed)) * 1.0
        for level in (noise_level(Image(values)), 5.0, np.inf):
            assert cut_off_below(values, ANYWHERE, values >= level) == 0.0
        assert load_of(values).total == pytest.approx(values.sum())


@pytest.mark.parametrize("offset", [0.5, 2.0])
def test_a_light_load_on_a_whole_clipped_pad_is_a_load(offset: float) -> None:
    whole = np.random.default_rng(0).normal(offset, 1.0, SHAPE)
    found = load_of(np.maximum(whole, 0.0))
    assert found.loaded
    assert found.total == pytest.approx(whole.sum(), abs=60.0)


@pytest.mark.parametrize("scale", [1e-300, 1e-12, 1e150, 1e303])
def test_it_is_as_well_in_any_unit(scale: float) -> None:
    values = np.maximum(pressed(np.random.default_rng(0).normal(0.0, 1.0, SHAPE)), 0.0)
    on = values > 20.0
    expected = scale * cut_off_below(values, ANYWHERE, on)
    assert cut_off_below(values * scale, ANYWHERE, on) == pytest.approx(expected)
    assert expected < 0.0


@pytest.mark.parametrize("n_values", [2, 3, 5])
def test_pads_of_few_values_raise_nothing(n_values: int) -> None:
    for seed in range(10):
        rng = np.random.default_rng(seed)
        among = np.append(rng.lognormal(0.0, 3.0, n_values - 1), 0.0)
        values = rng.choice(among, SHAPE)
        assert cut_off_below(values, ANYWHERE, values > among[0]) <= 0.0


@pytest.mark.parametrize("press", [0.0, 30.0])
def test_what_is_left_out_as_noise_is_told_and_by_what_it_is_counted(press: float) -> None:
    values = np.random.default_rng(0).normal(0.0, 1.0, SHAPE)
    values[2:8, 5:13] += press
    image = Image(np.maximum(values, 0.0))
    told = counts_cells_at_rest(image, load_of(image.values))
    assert told.startswith("the total leaves out 3")
    assert "without a footprint at the port 'mask' it is the sum of all" in told
    for other in (LoadOf()(image), LoadOf(above=0.5)(image)):
        assert "leaves out 3" not in counts_cells_at_rest(image, other)
