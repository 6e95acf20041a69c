"""Groups of basins looked at again: joined where they are one object, cut where they are two."""

import numpy as np
import pytest

from helpers_filters import drawn, image_of
from helpers_modes import plainly
from helpers_objects import footprint, frames
from tactile_graph_filters.parting.hull_terms import (
    AREA,
    CELLS,
    LOGS,
    LONG,
    NOTCHES,
    WEAK,
    Levels,
    hull_area,
    hull_terms,
)
from tactile_graph_filters.parting.partition import Partition
from tactile_graph_filters.parting.split_contacts import SplitContacts
from tactile_graph_filters.parting.straight_cuts import (
    REACH_CELLS,
    best_join,
    boxes_of,
    cut_best,
    joined_and_cut,
)
from tactile_graph_filters.parting.two_or_one import (
    NAMES,
    WEIGHTS,
    cut_terms,
    log_odds,
    most_odds,
    seam,
)

pytestmark = pytest.mark.usefixtures("warm_kernels")

LOBES = drawn("""
    .###...###.
    ####..#####
    ###########
    ####..#####
    .###...###.
""")
SLAB = drawn("""
    ###########
    ##.########
    ######.####
    ###########
""")
LEVELS = Levels(weak=0.5, full=0.5, floor=1e-3)


def groups_of(mask, *lefts):
    """Return group 1 up to the first column named, 2 up to the next, and so on."""
    columns = np.arange(mask.shape[1])
    number = 1 + np.searchsorted(np.array(lefts), columns, side="right")
    return np.where(mask.values, number, 0).astype(np.int32)


def odds(mask, at, values=None):
    owner = groups_of(mask, at)
    load = mask.values.astype(float) if values is None else values
    known = np.ones(mask.shape, bool)
    cells = Partition(owner, load, known)
    return log_odds(cells, 1, 2, LEVELS, hull_terms(cells, 1, 2, LEVELS))


def recut(mask, owner, values=None, **limits):
    load = mask.values.astype(float) if values is None else values
    known = np.ones(mask.shape, bool)
    cut_above, join_below = limits.get("cut_above", 0.0), limits.get("join_below", -1.0)
    joined_and_cut(Partition(owner, load, known), 0.5, 0.5, cut_above, join_below)
    return [np.count_nonzero(owner == k) for k in np.unique(owner[owner > 0])]


@pytest.mark.parametrize("twin", ["loops", "compiled"])
def test_the_terms_of_a_square_with_a_notch_and_a_weak_cell(twin):
    if twin == "compiled":
        pytest.importorskip("numba")
    owner = np.ones((5, 5), np.int32)
    owner[0, 2], owner[2, 3], owner[4, 2] = 0, 0, 2
    values = np.where(owner == 1, np.e, 0.0)
    values[2, 2] = 0.25
    known = np.ones((5, 5), bool)
    cells = Partition(owner, values, known)
    terms = getattr(hull_terms, twin)(cells, 1, 1, LEVELS)
    mean = (21 * np.e + 0.25) / 22
    assert terms[CELLS] == 22
    assert terms[LOGS] == pytest.approx(21 + np.log(0.25))
    assert terms[AREA] == 16.0
    assert terms[NOTCHES] == 1.0  # the cell held by another is no notch, nor the hole inside
    assert terms[WEAK] == pytest.approx(1 - 0.25 / (0.5 * mean))
    known[0, 2] = False
    assert getattr(hull_terms, twin)(cells, 1, 1, LEVELS)[NOTCHES] == 0.0


def test_a_bar_is_as_long_as_its_second_moments_say():
    owner = np.ones((2, 8), np.int32)
    terms = hull_terms(Partition(owner, owner * 1.0, owner > 0), 1, 1, LEVELS)
    assert terms[LONG] == pytest.approx(np.log(8 / 2))


def test_a_seam_is_as_long_as_what_meets_across_it_is_pressed():
    owner = np.array([[1, 2], [1, 2]], np.int32)
    values = np.array([[1.0, 1.0], [1.0, 0.25]])
    length, cells, logs = seam(Partition(owner, values, owner > 0), 1, 2, LEVELS)
    assert length == pytest.approx(1.0 + 0.5 + 0.7 * 0.5 + 0.7)
    assert (cells, logs) == (4, pytest.approx(np.log(0.25)))


def test_the_cut_at_the_neck_is_likelier_than_beside_it_and_a_slab_has_none():
    assert odds(LOBES, 5) > 0
    assert odds(LOBES, 5) > max(odds(LOBES, 3), odds(LOBES, 8))
    assert max(odds(SLAB, at) for at in range(2, 10)) < -1


def test_the_odds_weigh_what_the_terms_say():
    """A square of 4 by 4, even and whole, cut in a row of four and three rows of four."""
    owner = np.ones((4, 4), np.int32)
    owner[0] = 2
    cells = Partition(owner, np.ones((4, 4)), np.ones((4, 4), bool))
    settings = (cells, 1, 2, LEVELS, hull_terms(cells, 1, 2, LEVELS))
    terms = dict(zip(NAMES, cut_terms(*settings), strict=True))
    assert terms["constant"] == 1.0
    assert terms["hull gap"] == pytest.approx((9 - 6 - 0) / 4)
    assert terms["notches"] == terms["weak cells"] == terms["seam's readings"] == 0.0
    assert terms["seam"] == pytest.approx((4 + 6 * 0.7) / 4)
    assert terms["length"] == pytest.approx(np.log(4))
    assert terms["inverse of fewer cells"] == 0.25
    assert terms["log of fewer cells"] == pytest.approx(np.log(4))
    assert terms["log of all cells"] == pytest.approx(np.log(16))
    fitted = [3.68, 3.08, 2.44, 9.55, -1.42, -0.659, -3.24, -22.6, -1.84, -0.211]
    assert log_odds(*settings) == pytest.approx(np.dot(fitted, list(terms.values())))
    assert WEIGHTS.tolist() == fitted


@pytest.mark.usefixtures("plain_kernels")
@pytest.mark.parametrize("seed", range(8))
def test_no_cut_is_likelier_than_is_said_in_less_time(seed):
    rng = np.random.default_rng(seed)
    on = LOBES.values & (rng.random(LOBES.shape) < 0.9)
    load, known = on * rng.random(on.shape), np.ones(on.shape, bool)
    for at in range(3, 9):
        owner = np.where(on, np.where(np.arange(on.shape[1]) < at, 1, 2), 0).astype(np.int32)
        cells = Partition(owner, load, known)
        both = hull_terms(cells, 1, 2, LEVELS)
        fewer = min(np.count_nonzero(owner == 1), np.count_nonzero(owner == 2))
        found = log_odds(cells, 1, 2, LEVELS, both)
        assert most_odds(cells, 1, 2, LEVELS, both, fewer) >= found - 1e-9
        assert hull_area(owner, 1) == hull_terms(cells, 1, 1, LEVELS)[AREA]
    assert (WEIGHTS[2:4] > 0.0).all()
    assert WEIGHTS[NAMES.index("length")] < 0.0


def test_low_readings_along_the_cut_make_it_likelier():
    values = SLAB.values.astype(float)
    values[:, 4:6] *= 0.8  # neither weak nor less than a full contact
    assert odds(SLAB, 5, values) > odds(SLAB, 5) + 0.05
    values[:, 4:6] *= 0.3
    assert odds(SLAB, 5, values) > odds(SLAB, 5) + 0.5


@pytest.mark.slow
def test_one_group_of_two_objects_is_cut_and_two_groups_of_one_are_joined():
    assert sorted(recut(LOBES, groups_of(LOBES, 99))) in ([20, 21], [19, 22], [18, 23])
    assert recut(SLAB, groups_of(SLAB, 5)) == [SLAB.count]
    assert len(recut(LOBES, groups_of(LOBES, 5))) == 2


@pytest.mark.slow
def test_pieces_are_cut_again():
    three = drawn("""
        .###...###...###.
        ####..#####..####
        #################
        ####..#####..####
        .###...###...###.
    """)
    assert len(recut(three, groups_of(three, 99), cut_above=-3.0)) == 3
    assert len(recut(LOBES, groups_of(LOBES, 99), cut_above=-3.0)) == 2


def test_the_two_limits_say_how_willingly():
    assert recut(LOBES, groups_of(LOBES, 99), cut_above=50.0) == [LOBES.count]
    assert len(recut(SLAB, groups_of(SLAB, 5), cut_above=50.0, join_below=-50.0)) == 2


@pytest.mark.slow
def test_no_piece_is_smaller_than_three_cells():
    rng = np.random.default_rng(4)
    mask = image_of(rng.random((9, 9))).mask(rng.random((9, 9)) < 0.6)
    sizes = recut(mask, groups_of(mask, 99), cut_above=-50.0, join_below=-99.0)
    assert len(sizes) > 4
    assert min(sizes) >= 3
    assert sum(sizes) == mask.count


def patchy(seed):
    """Three groups of uneven readings side by side, 5 rows of 9 cells, a few of them off."""
    rng = np.random.default_rng(seed)
    owner = np.repeat([1, 2, 3], 3)[None, :].repeat(5, 0).astype(np.int32)
    owner[rng.random(owner.shape) < 0.12] = 0
    values = np.where(owner > 0, 0.1 + rng.random(owner.shape), 0.0)
    return Partition(owner, values, rng.random(owner.shape) < 0.95)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_the_two_that_are_least_likely_two_objects_are_joined_first(seed):
    cells = patchy(seed)
    every = {}
    for a, b in ((1, 2), (1, 3), (2, 3)):
        both = plainly(hull_terms)(cells, a, b, LEVELS)
        every[a, b] = plainly(log_odds)(cells, a, b, LEVELS, both)
    least = min((1, 2), (2, 3), key=every.__getitem__)  # 1 and 3 lie 3 cells apart
    assert plainly(best_join)(cells, 3, LEVELS, 1e3) == least
    assert plainly(best_join)(cells, 3, LEVELS, every[least]) == (0, 0)
    cells.owner[:, 3] = 0
    upright = Partition(*(np.ascontiguousarray(part.T) for part in cells))
    for one in (cells, upright):
        one.owner[one.owner == 3] = 0
        assert plainly(best_join)(one, 3, LEVELS, 1e3) == (1, 2)


@pytest.mark.parametrize(("gap", "pair"), [(2, (1, 2)), (3, (0, 0))])
def test_groups_more_than_two_cells_apart_are_not_joined(gap, pair):
    owner = np.zeros((3, 6 + gap), np.int32)
    owner[:, :3], owner[:, -3:] = 1, 2
    for turned in (owner, np.ascontiguousarray(owner.T)):
        cells = Partition(turned, (turned > 0) * 1.0, turned >= 0)
        assert plainly(best_join)(cells, 2, LEVELS, 1e3) == pair


def test_boxes_hold_each_group_and_nothing_where_there_is_none():
    owner = np.zeros((5, 7), np.int32)
    owner[1, 2] = owner[3, 4] = 1
    owner[0, 6] = 3
    boxes = plainly(boxes_of)(owner, 3)
    assert boxes[1:].tolist() == [[1, 3, 2, 4], [5, -1, 7, -1], [0, 0, 6, 6]]


@pytest.mark.slow
@pytest.mark.parametrize("is_turned", [False, True])
@pytest.mark.parametrize("seed", range(2))
def test_the_likeliest_of_all_straight_cuts_is_made(seed, is_turned):
    cells = patchy(seed)
    cells.owner[cells.owner == 2] = 1  # and 3 is somebody else's
    if is_turned:
        cells = Partition(*(np.ascontiguousarray(part.T[::-1]) for part in cells))
    rows, columns = np.nonzero(cells.owner == 1)
    both = plainly(hull_terms)(cells, 1, 1, LEVELS)
    every = {}
    for angle in np.arange(8) * np.pi / 8:
        across = np.cos(angle) * columns + np.sin(angle) * rows
        for at in np.arange(across.min() + 0.25, across.max(), 0.5):
            near = across < at
            if 3 <= near.sum() <= near.size - 3 and near.tobytes() not in every:
                owner = cells.owner.copy()
                owner[rows[near], columns[near]] = 4
                cut = Partition(owner, cells.values, cells.known)
                every[near.tobytes()] = plainly(log_odds)(cut, 4, 1, LEVELS, both), owner
    best, wanted = max(every.values(), key=lambda one: one[0])
    before = cells.owner.copy()
    assert not plainly(cut_best)(cells, 1, 4, LEVELS, best)
    np.testing.assert_array_equal(cells.owner, before)
    assert plainly(cut_best)(cells, 1, 4, LEVELS, best - 1e-6)
    np.testing.assert_array_equal(cells.owner, wanted)


@pytest.mark.slow  # much is compiled
@pytest.mark.parametrize("scene", ["six", "rectangle-2"])
def test_compiled_and_plain_agree(scene):
    pytest.importorskip("numba")
    for frame in frames(scene, 2, 8):
        mask, values = footprint(frame.image), np.maximum(frame.image.values, 0.0)
        known = np.ones(mask.shape, bool)
        first = SplitContacts(recut=False)(frame.image, mask).contacts[0]._labels
        owners = [first.copy(), first.copy()]
        twins = (plainly(joined_and_cut), joined_and_cut.compiled)
        for owner, twin in zip(owners, twins, strict=True):
            twin(Partition(owner, values * mask.values, known), 0.5, 0.3, -0.5, -1.0)
        assert np.array_equal(*owners)


@pytest.mark.slow
def test_touching_pairs_are_told_apart_more_often_and_single_objects_cut_no_more_often():
    """Discs of radius 3 to 4.4 cm that touch; long thin rectangles; discs of the thesis."""
    rng = np.random.default_rng(21)
    twins = []
    for _ in range(30):
        radius, angle = rng.uniform(3.0, 4.4), rng.uniform(0.0, np.pi)
        way = radius * np.array([np.cos(angle), np.sin(angle)])
        weight_g = round(60 * np.pi * radius**2)
        disc = {"shape": "disc", "radius_cm": radius, "weight_g": weight_g}
        places = [(10.25 + s * way).tolist() for s in (-1.0, 1.0)]
        twins += frames({"objects": [{**disc, "place": p} for p in places]}, 1, int(1e6 * angle))
    one_way, other = SplitContacts(), SplitContacts(recut=False)
    right = {}
    for name, found in (("pairs", twins), ("thin", list(frames("rectangle-2", 30, 3)))):
        for kind, step in (("new", one_way), ("old", other)):
            counts = [step(f.image, footprint(f.image)).count for f in found]
            right[name, kind] = np.mean([c == len(found[0].truth) for c in counts])
    assert right["pairs", "new"] >= 0.85
    assert right["pairs", "new"] > right["pairs", "old"]
    assert right["thin", "new"] >= 0.85
    assert right["thin", "new"] > right["thin", "old"]


@pytest.mark.usefixtures("plain_kernels")
@pytest.mark.parametrize("down", range(6))
@pytest.mark.parametrize("right", range(-5, 6))
def test_only_groups_near_each_other_may_be_one_wherever_on_the_pad(down, right):
    owner = np.zeros((6, 11), np.int32)
    owner[0, 5] = 1
    owner[down, 5 + right] = 3
    if not (owner == 1).any():
        return
    between = max(down, abs(right)) - 1
    cells = Partition(owner, (owner > 0).astype(float), np.ones(owner.shape, bool))
    expected = (1, 3) if between <= REACH_CELLS else (0, 0)
    for turned in (cells, Partition(*(np.ascontiguousarray(each.T) for each in cells))):
        assert plainly(best_join)(turned, 3, LEVELS, np.inf) == expected
