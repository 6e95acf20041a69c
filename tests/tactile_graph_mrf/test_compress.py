"""The logarithmic scale: no unit in it, and noise alone is told from a load."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.errors import Degenerate
from tactile_graph.wires import Image
from tactile_graph_mrf.compress import compress


def volts() -> np.ndarray:
    rng = np.random.default_rng(0)
    values = 2e-4 * rng.standard_normal((8, 8))
    values[2:5, 2:6] += 0.3 * np.exp(0.7 * rng.standard_normal((3, 4)))
    return values


def test_another_unit_of_the_readings_changes_nothing() -> None:
    one, other = compress(Image(volts())), compress(Image(1000.0 * volts()))
    np.testing.assert_allclose(other.image.values, one.image.values, atol=1e-12)
    assert one.stands_out
    assert other.stands_out


def test_a_factor_between_strong_readings_becomes_a_constant_difference() -> None:
    values = np.array([[0.0, 0.1, 0.2, 0.4, 1.0]])
    steps = np.diff(compress(Image(values), share=1e-4).image.values[0, 1:])
    np.testing.assert_allclose(steps, np.log([2.0, 2.0, 2.5]), atol=1e-4)


def test_a_large_share_leaves_the_scale_even() -> None:
    values = np.array([[0.0, 0.5, 1.0]])
    low, middle, high = compress(Image(values), share=100.0).image.values[0].tolist()
    assert low == 0.0
    assert middle / high == pytest.approx(0.5, rel=1e-4)


def test_the_scale_begins_no_lower_than_the_noise() -> None:
    values = np.array([[-0.05, 0.05, 1.0]])
    low, noise, _ = compress(Image(values), share=1e-6).image.values[0].tolist()
    assert noise == pytest.approx(np.arcsinh(1.0))
    assert low == -noise


@pytest.mark.parametrize("seed", range(20))
def test_noise_alone_does_not_stand_out(seed: int) -> None:
    noise = np.random.default_rng(seed).standard_normal((16, 16))
    assert not compress(Image(noise)).stands_out


@pytest.mark.parametrize("values", [np.zeros((3, 3)), np.full((3, 3), -1.0), np.zeros((0, 4))])
def test_nothing_above_zero_gives_an_even_image(values: np.ndarray) -> None:
    made = compress(Image(values))
    assert not made.stands_out
    np.testing.assert_array_equal(made.image.values, np.zeros(values.shape))


def test_where_no_cell_is_valid_nothing_says_that_the_pad_is_empty() -> None:
    for image in (Image(np.zeros((2, 2)), valid=np.zeros((2, 2), bool)), Image([[np.nan]])):
        with pytest.raises(Degenerate, match="no cell of the image is valid, so nothing says"):
            compress(image)


def test_what_is_not_known_stays_unknown_and_sets_no_scale() -> None:
    values = np.array([[0.0, 9.0, np.nan, 1.0]])
    valid = np.array([[True, False, True, True]])
    made = compress(Image(values, valid=valid), share=0.5)
    assert made.image.quantity == "level"
    assert made.image.values[0, 3] == np.arcsinh(2.0)
    assert made.image.values[0, 2] == 0.0
    assert not made.image.valid[0, 2]
    assert made.image.valid is not None
    assert not made.image.valid[0, 1]


def test_one_cell_far_below_zero_does_not_hide_a_load():
    rng = np.random.default_rng(3)
    values = rng.normal(0.0, 0.01, (16, 16))
    values[4:9, 4:9] += 1.0
    whole = compress(Image(values.copy()))
    values[12, 12] = -3.0
    broken = compress(Image(values))
    assert whole.stands_out
    assert broken.stands_out
    assert broken.image.valid is not None
    assert np.argwhere(~broken.image.valid).tolist() == [[12, 12]]
    assert np.array_equal(broken.image.values[:12], whole.image.values[:12])


def test_noise_alone_leaves_every_cell_valid_and_nothing_stands_out():
    for seed in range(50):
        values = np.random.default_rng(seed).normal(0.0, 0.01, (16, 16))
        made = compress(Image(values))
        assert made.image.valid is None
        assert not made.stands_out


@pytest.mark.parametrize(("n_cells", "is_broken"), [(31, False), (32, True)])
def test_of_fewer_than_32_cells_none_is_called_broken(n_cells: int, is_broken: bool) -> None:
    values = np.linspace(0.1, 1.0, n_cells)[None, :]
    values[0, 4] = -3.0
    made = compress(Image(values))
    assert made.stands_out == is_broken
    if is_broken:
        assert np.flatnonzero(~made.image.valid[0]).tolist() == [4]
    else:
        assert made.image.valid is None


@pytest.mark.parametrize(("n_broken", "n_left_out"), [(2, 2), (3, 3), (4, 0)])
def test_one_cell_in_a_hundred_and_one_more_may_be_broken(n_broken: int, n_left_out: int) -> None:
    values = np.linspace(-0.1, 1.0, 200)[None, :]
    values[0, 50 : 50 + n_broken] = -3.0
    made = compress(Image(values))
    found = 0 if made.image.valid is None else np.count_nonzero(~made.image.valid)
    assert found == n_left_out


@pytest.mark.parametrize(("factor", "is_broken"), [(3.9, False), (4.0, False), (4.1, True)])
def test_broken_reads_more_than_so_many_times_as_low(factor: float, is_broken: bool) -> None:
    values = np.linspace(0.1, 1.0, 64)[None, :]
    values[0, 3], values[0, 7] = -0.125, -0.125 * factor
    made = compress(Image(values), share=0.005, times=4.0)
    noise = 0.125 if is_broken else 0.125 * factor
    assert (made.image.valid is not None) == is_broken
    assert made.image.values[0, -1] == np.arcsinh(1.0 / noise)


def test_no_cell_is_broken_where_all_read_above_zero() -> None:
    values = np.linspace(0.5, 1.0, 64)[None, :]
    values[0, 0] = 1e-3
    made = compress(Image(values))
    assert made.image.valid is None
    assert made.image.values[0, 0] == pytest.approx(np.arcsinh(0.2))
