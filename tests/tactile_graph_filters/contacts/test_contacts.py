import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from helpers_filters import ORIGIN, PITCH, drawn, image_of, masks, random_mask
from helpers_modes import held
from tactile_graph.errors import DataError, RuleError
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.contacts.contacts import Contact, contacts
from tactile_graph_filters.contacts.labels import label

MASK = drawn("""
    ##....
    ##..#.
    ..#.#.
    ......
""")
EIGHT = np.ones((3, 3))


def loads():
    return image_of(np.where(MASK.values, np.arange(24.0).reshape(4, 6) + 1, 0.0), "gram")


def test_cells_that_touch_at_a_corner_belong_together_or_not():
    assert contacts(loads(), MASK).count == 2
    assert contacts(loads(), MASK, connectivity=4).count == 3


def test_a_contact_tells_area_load_peak_and_centres():
    first = contacts(loads(), MASK, connectivity=4).contacts[0]
    weights = np.array([1.0, 2.0, 7.0, 8.0])
    assert (first.number, first.n_cells, first.load, first.peak) == (1, 4, 18.0, 8.0)
    assert first.area_cm2 == pytest.approx(4 * PITCH[0] * PITCH[1])
    assert first.centroid_x_cm == pytest.approx(ORIGIN[0] + PITCH[0])
    assert first.centroid_y_cm == pytest.approx(ORIGIN[1] + PITCH[1])
    column = (weights @ [0, 1, 0, 1]) / 18 + 0.5
    row = (weights @ [0, 0, 1, 1]) / 18 + 0.5
    assert (first.x_cm, first.y_cm) == pytest.approx(
        (ORIGIN[0] + column * PITCH[0], ORIGIN[1] + row * PITCH[1])
    )


def test_its_own_image_and_mask_hold_nothing_of_its_neighbours():
    mask = drawn("""
        ####
        #...
        #.##
        #.##
    """)
    big, small = contacts(image_of(np.ones((4, 4)), "gram"), mask, connectivity=4).contacts
    assert big.box == (0, 4, 0, 4)
    assert big.mask.count == big.image.total == 7
    assert small.mask.values.tolist() == [[True, True], [True, True]]
    assert small.image.origin_cm == pytest.approx(
        (ORIGIN[0] + 2 * PITCH[0], ORIGIN[1] + 2 * PITCH[1])
    )
    assert small.image.quantity == "gram"


def test_margin_widens_the_box_as_far_as_the_image_goes():
    found = contacts(loads(), MASK, connectivity=4, margin=1).contacts
    assert [c.box for c in found] == [(0, 3, 0, 3), (0, 4, 3, 6), (1, 4, 1, 4)]
    assert found[2].mask.values.sum() == 1


def test_small_contacts_are_left_out_and_not_counted():
    found = contacts(loads(), MASK, connectivity=4, min_cells=2)
    assert found.count == len(found.contacts) == 2
    assert [c.number for c in found.contacts] == [1, 2]


def test_nothing_on_is_no_contact_and_no_error():
    assert contacts(loads(), MASK.with_values(np.zeros((4, 6), bool))) == ((), 0)


def test_without_a_load_above_zero_the_centre_is_the_centroid():
    only = contacts(image_of([[-1.0, -1.0, 0.0]]), drawn("##.")).contacts[0]
    assert only.x_cm == only.centroid_x_cm == pytest.approx(ORIGIN[0] + PITCH[0])
    assert (only.load, only.peak) == (-2.0, -1.0)


def test_ports_for_an_image_or_a_mask_take_a_contact():
    assert Contact.provides == {Image: "image", Mask: "mask"}
    one = contacts(loads(), MASK).contacts[0]
    assert isinstance(one.image, Image)
    assert isinstance(one.mask, Mask)
    assert all(hasattr(one, name) for name in Contact.columns_shown)


def test_nan_in_a_contact_is_refused():
    with pytest.raises(DataError, match="row 0, column 0: must be a number, got nan"):
        contacts(image_of([[math.nan, 1.0]]), drawn("##"))


def test_different_shapes_are_refused():
    with pytest.raises(RuleError, match="must have the same shape"):
        contacts(image_of([[1.0]]), drawn("##"))


@pytest.mark.parametrize("twin", ["reference", "compiled"])
@pytest.mark.parametrize("eight", [False, True])
def test_both_twins_label_as_scipy_does(twin, eight):
    if twin == "compiled":
        pytest.importorskip("numba")
    for seed, shape in enumerate([(16, 16), (1, 1), (3, 40), (33, 9)]):
        on = random_mask(seed, shape, 0.5).values
        values = held(np.random.default_rng(seed).normal(size=shape))
        labels = np.empty(shape, np.int32)
        table = getattr(label, twin)(values, on, eight, labels)
        expected, n = ndimage.label(on, EIGHT if eight else None)
        assert np.array_equal(labels, expected)
        assert len(table) == n
        for k in range(n):
            part = labels == k + 1
            y, x = np.nonzero(part)
            load = np.maximum(values[part], 0)
            sums = [
                x.size, values[part].sum(), values[part].max(), x.sum(), y.sum(), load.sum(),
                load @ x, load @ y, y.min(), y.max(), x.min(), x.max(),
            ]  # fmt: skip
            assert table[k] == pytest.approx(sums)


@pytest.mark.parametrize("eight", [False, True])
def test_both_twins_sum_alike_to_the_last_bit(eight):
    """A frame's answer does not tell whether the frames before it had the loops compiled."""
    for seed, shape in enumerate([(16, 16), (3, 40), (33, 9)]):
        on = random_mask(seed, shape, 0.7).values
        values = np.random.default_rng(seed).normal(size=shape)
        plain, looped = (np.empty(shape, np.int32) for _ in range(2))
        sums = label.reference(values, on, eight, plain)
        assert np.array_equal(sums, label.loops(values, on, eight, looped))
        assert np.array_equal(plain, looped)


@settings(max_examples=40, deadline=None)
@given(masks(), st.booleans())
def test_the_contacts_cover_the_mask_exactly_once(mask, eight):
    image = image_of(mask.values.astype(float))
    found = contacts(image, mask, connectivity=8 if eight else 4).contacts
    covered = np.zeros(mask.shape, int)
    for one in found:
        top, bottom, left, right = one.box
        covered[top:bottom, left:right] += one.mask.values
    assert np.array_equal(covered, mask.values.astype(int))
    assert sum(c.load for c in found) == mask.count


def test_the_centre_of_load_lies_right_of_the_images_origin():
    (one,) = contacts(image_of(np.eye(1, 4, 2), "gram"), drawn("..#.")).contacts
    assert one.x_cm == pytest.approx(ORIGIN[0] + 2.5 * PITCH[0])
    assert one.y_cm == pytest.approx(ORIGIN[1] + 0.5 * PITCH[1])


@pytest.mark.parametrize("shape", [(1, 1), (1, 5), (4, 5), (5, 5)])
def test_of_cells_that_touch_at_corners_alone_each_is_a_contact(shape):
    """There are never more: so many the kernel has room for."""
    on = np.indices(shape).sum(axis=0) % 2 == 0
    labels = np.empty(shape, np.int32)
    sums = label.loops(on.astype(float), on, False, labels)
    assert labels.max() == len(sums) == np.count_nonzero(on)
    assert (labels > 0).tolist() == on.tolist()


@pytest.mark.parametrize("rest", [0.0, 500.0, -300.0])
def test_loads_that_count_what_cells_read_at_rest_are_told_of(rest):
    readings = np.random.default_rng(0).normal(rest, 1.0, (10, 16))
    empty = drawn("\n".join(["." * 16] * 10))
    for mask, load in ((empty, 0.0), (image_of(readings).mask(np.eye(10, 16) > 0), 80.0)):
        image = image_of(readings + np.where(mask.values, load, 0.0))
        told = contacts.notice(image, mask)
        assert ("'tare' takes that off" in told) == (rest != 0.0)
