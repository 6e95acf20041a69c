import numpy as np
import pytest
from hypothesis import given, settings

from helpers_filters import drawn, image_of, mask_of, masks
from helpers_objects import discs, footprint
from tactile_graph.errors import DataError, RuleError
from tactile_graph_filters.parting.split_watershed import _flooded, split_watershed

PAIR = discs(40, 60, (20, 18, 12), (20, 41, 12))


@pytest.mark.parametrize("by", ["distance", "load", "both"])
def test_two_touching_discs_are_cut_in_the_middle(by):
    found = split_watershed(PAIR, footprint(PAIR), by=by, neck=0.8)
    if by == "load":  # an even load has no valley
        assert found.count == 1
        return
    assert found.count == 2
    assert [c.centroid_x_cm for c in found.contacts] == pytest.approx(
        [-0.15 + 1.3 * 18.5, -0.15 + 1.3 * 41.5], abs=0.6
    )


def test_a_valley_in_the_load_cuts_where_the_outline_has_no_neck():
    values = np.ones((12, 30))
    values[:, 13:17] = 0.1
    whole = mask_of(np.ones((12, 30)))
    assert split_watershed(image_of(values), whole, by="load").count == 2
    assert split_watershed(image_of(values), whole, by="distance").count == 1


def test_one_disc_with_voids_is_not_split_once_gaps_are_bridged():
    image = discs(30, 30, (15, 15, 12))
    holes = np.random.default_rng(1).random((30, 30)) < 0.12
    values = np.where(holes, 0.0, image.values)
    torn = image_of(values)
    on = mask_of(values > 0)
    assert split_watershed(torn, on, by="distance", bridge_cells=0).count > 1
    found = split_watershed(torn, on, by="distance", bridge_cells=1)
    assert found.count == 1
    assert found.contacts[0].n_cells == on.count


def test_gaps_longer_than_the_pad_are_no_longer_than_it():
    """A square of 2 000 001 cells a side would take terabytes."""
    mask = drawn("""
        ##...##
        ##...##
    """)
    image = image_of(np.where(mask.values, 1.0, 0.0))
    whole, huge = (split_watershed(image, mask, bridge_cells=n) for n in (7, 1_000_000))
    assert [c.box for c in huge.contacts] == [c.box for c in whole.contacts]


def test_neck_says_how_narrow_a_neck_is():
    counts = [
        split_watershed(PAIR, footprint(PAIR), by="distance", neck=neck).count
        for neck in (0.2, 0.8)
    ]
    assert counts == [1, 2]


def test_nothing_on_is_no_contact():
    assert split_watershed(image_of(np.zeros((3, 3))), mask_of(np.zeros((3, 3)))) == ((), 0)


def test_readings_without_load_are_flooded_all_the_same():
    mask = drawn("###")
    assert split_watershed(image_of(np.zeros((1, 3))), mask).count == 1


def test_small_contacts_are_left_out():
    mask = drawn("""
        ##.....
        ##....#
    """)
    assert split_watershed(image_of(np.ones((2, 7))), mask, min_cells=2).count == 1


@settings(max_examples=20, deadline=None)
@given(masks(9))
def test_every_cell_is_in_exactly_one_contact(mask):
    for by in ("distance", "load", "both"):
        found = split_watershed(image_of(mask.values.astype(float)), mask, by=by).contacts
        assert sum(c.n_cells for c in found) == mask.count


def test_different_shapes_are_refused():
    with pytest.raises(RuleError, match="must have the same shape"):
        split_watershed(image_of([[1.0]]), drawn("##"))


def test_nan_in_the_mask_is_refused():
    with pytest.raises(DataError, match="row 0, column 0: must be a number, got nan"):
        split_watershed(image_of([[np.nan, 1.0]]), drawn("##"))


def test_each_cell_belongs_to_the_peak_it_climbs_to():
    height = np.array([[9.0, 8.0, 7.0, 6.0, 5.0, 1.0, 9.0]])
    labels = _flooded(height, height > 0, 0.5)[0].tolist()
    assert labels[:5] == [1] * 5
    assert labels[6] == 2


def test_cells_that_touch_at_a_corner_are_flooded_from_one_peak():
    height = np.array([[9.0, 0.0, 0.0], [0.0, 6.0, 0.0], [0.0, 0.0, 3.0]])
    np.testing.assert_array_equal(_flooded(height + 1e-9, height > 0, 0.5), np.diag([1, 1, 1]))
