import numpy as np
import pytest

from helpers_filters import image_of
from tactile_graph.errors import Degenerate
from tactile_graph_filters.thresholds.threshold_valley import (
    smooth_until_two_peaks,
    threshold_valley,
)


def two_groups(seed=0, n=32):
    rng = np.random.default_rng(seed)
    on = rng.random((n, n)) < 0.4
    return np.where(on, rng.normal(10.0, 1.0, (n, n)), rng.normal(2.0, 1.0, (n, n))), on


@pytest.mark.parametrize("seed", range(5))
def test_the_level_lies_in_the_valley_between_object_and_background(seed):
    values, on = two_groups(seed)
    mask, level = threshold_valley(image_of(values))
    assert 4.5 < level < 8.0
    assert np.mean(mask.values != on) < 0.005


def test_an_empty_stretch_between_two_levels_is_cut_in_its_middle():
    _, level = threshold_valley(image_of([[0.0] * 5 + [100.0] * 3]), n_bins=100)
    assert level == pytest.approx(50.0)


def test_wider_bins_make_a_coarser_level():
    values, _ = two_groups()
    low, high = values.min(), values.max()
    _, level = threshold_valley(image_of(values), n_bins=5)
    assert np.isclose((level - low) / (high - low) * 5 % 1.0, [0.0, 1.0], atol=1e-9).any()


def test_one_peak_has_no_valley():
    values = np.repeat(np.arange(7.0), [1, 2, 4, 8, 4, 2, 1])[None, :]
    with pytest.raises(Degenerate, match="7 bins from 0 to 6 has one peak after at most 1000"):
        threshold_valley(image_of(values), n_bins=7)


def test_too_many_peaks_without_smoothing_are_reported():
    values = np.repeat(np.arange(7.0), [8, 1, 8, 1, 8, 1, 8])[None, :]
    with pytest.raises(Degenerate, match="has 4 peaks after at most 0 smoothings"):
        threshold_valley(image_of(values), n_bins=7, smoothing=0)


def test_an_unloaded_pad_is_degenerate():
    with pytest.raises(Degenerate, match="every valid cell holds 0"):
        threshold_valley(image_of(np.zeros((4, 4))))


@pytest.mark.slow
@pytest.mark.parametrize("most", [0, 1, 7, 1000])
@pytest.mark.parametrize("seed", range(4))
def test_the_twins_agree(seed, most):
    pytest.importorskip("numba")
    counts = np.random.default_rng(seed).integers(0, 5, 40).astype(float)
    other = counts.copy()
    smooth_until_two_peaks.reference(counts, most)
    smooth_until_two_peaks.compiled(other, most)
    assert np.array_equal(counts, other)
