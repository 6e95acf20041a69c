import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from helpers_filters import image_of
from tactile_graph.errors import Degenerate
from tactile_graph_filters.thresholds.threshold_variable import threshold_variable

READINGS = arrays(np.float64, (5, 6), elements=st.floats(0, 1e3))


@pytest.mark.slow
@given(READINGS, st.floats(0.01, 0.99), st.floats(0, 10))
def test_the_level_fulfils_its_law_and_no_lower_one_does(values, fraction, floor):
    mask, level = threshold_variable(image_of(values), fraction=fraction, floor=floor)

    def law(at):
        reached = values[(values >= at) & (values > 0)]
        return max(floor, fraction * reached.mean())

    if not mask.count:
        assert not ((values > 0) & (values >= floor)).any()
        assert level == floor
        return
    assert level == pytest.approx(law(level), rel=1e-12, abs=1e-300)
    lower = [v for v in np.unique(values) if floor <= v < level and v > 0]
    assert all(law(v) > v for v in lower)


def test_it_scales_with_the_weight():
    values = np.random.default_rng(1).random((8, 8)) + 0.2
    light, heavy = (threshold_variable(image_of(k * values), fraction=0.5) for k in (1.0, 40.0))
    assert heavy.level == pytest.approx(40.0 * light.level)
    assert np.array_equal(light.mask.values, heavy.mask.values)


def test_fraction_is_the_least_covered_share_of_an_element():
    values = np.zeros((7, 7))
    values[1:6, 1:6] = 10.0
    values[1:6, 6] = [4.9, 5.2, 5.2, 5.2, 4.9]
    whole, weak = (threshold_variable(image_of(values), fraction=f).mask for f in (0.55, 0.5))
    assert not whole.values[:, 6].any()
    assert weak.values[1:6, 6].all()
    assert whole.count == 25


def test_an_unloaded_pad_gives_an_empty_footprint_at_the_floor():
    mask, level = threshold_variable(image_of(np.full((4, 4), 0.002)), floor=0.01)
    assert (mask.count, level) == (0, 0.01)


def test_a_level_too_small_for_a_number_still_leaves_out_unloaded_cells():
    mask, level = threshold_variable(image_of([[0.0, 5e-324]]))
    assert mask.values.tolist() == [[False, True]]
    assert level > 0


def test_no_valid_cell_is_degenerate():
    with pytest.raises(Degenerate, match="no load to go by"):
        threshold_variable(image_of([[0.0]], valid=[[False]]))
