import cProfile
import pstats
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers_filters import drawn, image_of, mask_of, masks
from helpers_objects import discs, footprint, frames
from tactile_graph.errors import DataError, RuleError
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.contacts.contacts import contacts
from tactile_graph_filters.parting.basins import basins, taps_of
from tactile_graph_filters.parting.filled_hull import misfit
from tactile_graph_filters.parting.joined_basins import _joined_plain, joined
from tactile_graph_filters.parting.split_contacts import SplitContacts

pytestmark = pytest.mark.usefixtures("warm_kernels")

SPLIT = SplitContacts()
NARROW = drawn("""
    .###......###.
    #####....#####
    ##############
    ##############
    #####....#####
    .###......###.
""")
WIDE = drawn("""
    ..######..
    .########.
    ##########
    ####.#####
    #####.####
    ##########
    #.########
    .########.
    ..######..
""")
BAR = drawn("""
    ###
    ###
    ###
    ...
    ###
""")
TORN = drawn("""
    .####.
    ######
    ######
    ##..#.
    ######
    ######
    .####.
""")


def even(mask):
    return image_of(mask.values.astype(float))


@pytest.mark.slow
def test_two_discs_joined_by_a_neck_are_two_contacts_of_half_the_cells_each():
    found = SPLIT(even(NARROW), NARROW)
    assert found.count == 2
    assert [c.n_cells for c in found.contacts] == [NARROW.count // 2] * 2
    left, right = found.contacts
    assert left.x_cm < right.x_cm
    assert left.y_cm == pytest.approx(right.y_cm)


@pytest.mark.slow
@pytest.mark.parametrize(
    "mask",
    [WIDE, TORN, BAR],
    ids=["with voids", "nearly torn", "a piece torn off by a row of voids"],
)
def test_one_object_stays_one_contact(mask):
    found = SPLIT(even(mask), mask)
    assert found.count == 1
    assert found.contacts[0].n_cells == mask.count


def test_what_no_cell_bridges_within_reach_stays_apart():
    image = discs(16, 16, (3, 3, 2.2), (12, 12, 2.2))
    assert SPLIT(image, footprint(image)).count == 2


def test_a_low_reading_between_two_blocks_is_a_gap():
    values = np.ones((5, 9))
    values[:, 4] = 0.02
    image = image_of(values)
    whole = mask_of(values > 0)
    assert SPLIT(even(whole), whole).count == 1
    assert SPLIT(image, whole).count == 2


@pytest.mark.slow
def test_voids_and_hold_decide_how_willingly_it_splits():
    counts = [
        SplitContacts(hold=hold, recut=False)(even(NARROW), NARROW).count
        for hold in (0.0, 0.6, 50.0)
    ]
    assert counts[0] >= counts[1] == 2 > counts[2] == 1
    images = [f.image for f in frames("discs", 9, 3, voids=0.3)]
    totals = [
        sum(SplitContacts(voids=v, recut=False)(i, footprint(i)).count for i in images)
        for v in (0.0, 0.3, 1.0)
    ]
    assert totals[0] > totals[1] >= totals[2] == len(images)


def test_small_contacts_are_left_out():
    mask = drawn("""
        ####......
        ####......
        ####......
        .........#
    """)
    assert SPLIT(even(mask), mask).count == 1
    assert SplitContacts(min_cells=1)(even(mask), mask).count == 2


@pytest.mark.parametrize(
    ("small", "count"),
    [
        ("......#./......##", 2),
        ("....#.../...##...", 1),  # a piece that may have been torn off
        (".....#.#/......#.", 2),
        (".....#.#/.......#", 1),  # strays
        ("......../......##", 1),
    ],
)
def test_three_cells_side_by_side_are_an_object_where_nothing_else_is_near(small, count):
    mask = drawn("\n".join(["###.....", "###.....", "###.....", "........", *small.split("/")]))
    assert SPLIT(even(mask), mask).count == count
    assert SplitContacts(min_cells=4)(even(mask), mask).count == 1


def test_margin_widens_each_contacts_own_image():
    found = SplitContacts(margin=1)(even(NARROW), NARROW).contacts
    assert [c.box for c in found] == [(0, 6, 0, 8), (0, 6, 6, 14)]
    assert found[0].image.total == found[0].n_cells


def test_an_invalid_cell_is_no_gap():
    values = np.ones((6, 9))
    values[:, 4] = 0.0
    valid = np.ones((6, 9), bool)
    gap = mask_of(values > 0)
    assert SPLIT(image_of(values), gap).count == 2
    valid[:, 4] = False
    assert SPLIT(image_of(values, valid=valid), gap).count == 1


def test_nothing_on_is_no_contact():
    assert SPLIT(image_of(np.zeros((4, 4))), mask_of(np.zeros((4, 4)))) == ((), 0)


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (9, 1), (2, 2), (16, 16)])
def test_a_full_mask_of_any_shape_is_one_contact(shape):
    mask = mask_of(np.ones(shape))
    found = SplitContacts(min_cells=1)(even(mask), mask)
    assert [c.n_cells for c in found.contacts] == [mask.count]


@pytest.mark.parametrize("value", [0.0, -1.0])
def test_readings_without_load_split_by_their_cells_alone(value):
    image = image_of(np.full(NARROW.shape, value))
    found = SPLIT(image, NARROW)
    assert sum(c.n_cells for c in found.contacts) == NARROW.count
    assert found.contacts[0].x_cm == found.contacts[0].centroid_x_cm


def test_different_shapes_are_refused():
    with pytest.raises(RuleError, match="must have the same shape"):
        SPLIT(image_of([[1.0]]), drawn("##"))


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_what_is_no_number_is_refused_in_the_mask_and_ignored_outside(bad):
    values = np.ones((3, 4))
    values[1, 1] = bad
    on = np.ones((3, 4), bool)
    with pytest.raises(DataError, match="row 1, column 1"):
        SPLIT(image_of(values), mask_of(on))
    on[1, 1] = False
    assert SPLIT(image_of(values), mask_of(on)).count == 1


@pytest.mark.slow
@settings(max_examples=30, deadline=None)
@given(masks(10), st.integers(0, 9))
def test_every_cell_is_in_exactly_one_contact_and_sums_are_those_of_its_cells(mask, seed):
    image = image_of(np.random.default_rng(seed).random(mask.shape) + 0.01)
    found = SplitContacts(min_cells=1)(image, mask).contacts
    covered = np.zeros(mask.shape, int)
    for one in found:
        top, bottom, left, right = one.box
        covered[top:bottom, left:right] += one.mask.values
        assert one.load == pytest.approx(one.image.total)
        assert one.peak == pytest.approx(one.image.peak)
    assert np.array_equal(covered, mask.values.astype(int))
    firsts = [np.flatnonzero(c._labels.ravel() == c.number)[0] for c in found]
    assert all(a < b for a, b in pairwise(firsts))


def test_without_anything_to_split_it_says_what_contacts_says():
    image = discs(16, 16, (3, 3, 2.2), (12, 12, 2.2))
    mine, plain = (step(image, footprint(image)).contacts for step in (SPLIT, contacts))
    for a, b in zip(mine, plain, strict=True):
        for name in ("number", "n_cells", "area_cm2", "load", "peak", "box"):
            assert getattr(a, name) == getattr(b, name)
        for name in ("x_cm", "y_cm", "centroid_x_cm", "centroid_y_cm"):
            assert getattr(a, name) == pytest.approx(getattr(b, name))


@pytest.mark.slow  # much is parted
def test_six_objects_are_counted_right_in_nine_scenes_of_ten():
    right = [SPLIT(f.image, footprint(f.image)).count == 6 for f in frames("six", 40, 11)]
    assert np.mean(right) >= 0.9


@pytest.mark.slow  # much is parted
def test_single_objects_of_the_thesis_mostly_stay_whole():
    right = [SPLIT(f.image, footprint(f.image)).count == 1 for f in frames("discs", 30, 5)]
    assert np.mean(right) >= 0.85


@pytest.mark.slow  # much is parted
@pytest.mark.usefixtures("plain_kernels")
def test_both_twins_agree_on_uneven_scenes():
    pytest.importorskip("numba")
    rng = np.random.default_rng(0)
    rules = np.array([0.3, 0.5, 8.0, 0.6, 0.0])
    for n, frame in enumerate(frames("six", 12, 2)):
        image: Image = frame.image
        mask: Mask = footprint(image)
        if n % 3 == 2:  # hopeless scatter, where hulls overlap and groups are many
            mask = image.mask(rng.random(image.shape) < 0.45)
        values = np.where(mask.values, np.maximum(image.values, 0.05), 0.0)
        known = rng.random(image.shape) < 0.9
        rules[4] = 0.5 * np.median(values[mask.values])
        owners = []
        for twin in ("reference", "compiled"):
            owner = np.empty(image.shape, np.int32)
            count = getattr(basins, twin)(values, mask.values, taps_of(0.6), owner)
            energy = getattr(joined, twin)(owner, count, values, known, rules)
            owners.append((count, energy, owner))
        assert owners[0][0] == owners[1][0]
        assert owners[0][1] == pytest.approx(owners[1][1], abs=1e-6)
        assert np.array_equal(owners[0][2], owners[1][2])


def calls_to_join(n):
    """Return how many calls the plain code makes of a strip of n groups that nothing joins."""
    owner = np.zeros((4 * n, 1), np.int32)
    owner[::4, 0] = np.arange(1, n + 1)
    values = (owner > 0).astype(float)
    rules = np.array([0.3, 0.5, 8.0, 0.5, 0.0])
    profile = cProfile.Profile()
    profile.runcall(_joined_plain, owner, n, values, np.ones(owner.shape, bool), rules)
    return pstats.Stats(profile).total_calls


@pytest.mark.slow
@pytest.mark.usefixtures("plain_kernels")
def test_plain_joining_takes_in_proportion_to_the_groups():
    """Far groups are told by their boxes, all at once, not pair by pair from the cells."""
    assert calls_to_join(120) < 3 * calls_to_join(60)


@pytest.mark.usefixtures("plain_kernels")
@pytest.mark.parametrize("twin", ["reference", "compiled"])
def test_misfit_counts_what_a_hull_lacks(twin):
    """By hand: a 5 x 5 square without its middle and one cell of its rim, one foreign cell."""
    if twin == "compiled":
        pytest.importorskip("numba")
    owner = np.ones((5, 5), np.int32)
    owner[2, 2] = owner[0, 2] = 0
    owner[4, 2] = 2
    values = np.where(owner > 0, 1.0, 0.0)
    values[1, 1] = 0.0
    known = np.ones((5, 5), bool)
    group = np.array([1, 1, 1], np.int32)
    left, right = np.zeros(5, np.int64), np.full(5, 4, np.int64)
    rules = np.array([0.3, 0.5, 8.0, 0.5, 0.0])
    found = getattr(misfit, twin)(owner, values, known, group, left, right, rules)
    assert found == pytest.approx(1.0 + 1.2 + 3.0 + 2.0 - 0.3 * 9)
    known[2, 2] = known[0, 2] = False
    found = getattr(misfit, twin)(owner, values, known, group, left, right, rules)
    assert found == pytest.approx(3.0 + 2.0 - 0.3 * 8)
    owner[:] = 0
    owner[0, 0] = owner[0, 1] = 1
    right[:], right[0] = -1, 1
    found = getattr(misfit, twin)(owner, values, known, group, left, right, rules)
    assert found == pytest.approx(10.0 * (1 - 2 / 8))
