"""Footprints of many cells: looked at on coarser cells, each object at its own scale."""

import numpy as np
import pytest

from helpers_filters import image_of, mask_of
from helpers_objects import LEVEL_V, discs, frames
from tactile_graph_filters.parting.object_scale import Cells, parts, split_by_scale
from tactile_graph_filters.parting.split_contacts import SplitContacts

pytestmark = pytest.mark.usefixtures("warm_kernels")

SPLIT = SplitContacts()
FINE = SplitContacts(working_cells=10**6)


def uneven(image, seed, voids=0.16, spread=0.5):
    """Return the image as elements that differ, some without contact, would read it."""
    rng = np.random.default_rng(seed)
    gain = np.exp(spread * rng.standard_normal(image.shape)) * (rng.random(image.shape) >= voids)
    return image.with_values(image.values * gain)


def counts(step, images):
    return [step(i, i.mask(i.values >= LEVEL_V)).count for i in images]


def cells_of(on, values=None):
    on = np.asarray(on, bool)
    return Cells(on.astype(float) if values is None else values, on, np.ones(on.shape, bool))


def test_a_block_is_the_mean_of_its_cells_and_on_if_half_of_them_are():
    on = np.array([[1, 1, 0, 0, 1], [0, 0, 0, 1, 1], [1, 1, 1, 1, 0]], bool)
    known = np.array([[1, 1, 0, 0, 1], [1, 1, 0, 1, 1], [1, 1, 1, 1, 1]], bool)
    values = np.where(on, 4.0, 0.0)
    coarse = Cells(values, on, known).coarser(2)
    assert coarse.on.tolist() == [[True, False, True], [True, True, False]]
    assert coarse.values.tolist() == [[2.0, 0.0, 2.0], [2.0, 2.0, 0.0]]
    assert coarse.known.tolist() == [[True, False, True], [True, True, False]]


def test_a_part_cut_out_holds_nothing_of_others_and_calls_their_cells_unknown():
    on = np.array([[1, 0, 1], [1, 1, 1]], bool)
    part = (np.array([0, 1, 1]), np.array([0, 0, 1]))
    held = cells_of(on).cut_out(part)
    assert held.on.tolist() == [[True, False], [True, True]]
    assert held.known.all()
    whole = cells_of(on).cut_out((np.array([0, 1]), np.array([0, 2])))
    assert whole.on.tolist() == [[True, False, False], [False, False, True]]
    assert whole.known.tolist() == [[True, True, False], [False, False, True]]


def test_gaps_of_two_cells_lie_within_a_part_and_of_three_between_parts():
    row = np.zeros((1, 12), bool)
    row[0, [0, 3, 7, 8]] = True
    assert [p[1].tolist() for p in parts(row)] == [[0, 3], [7, 8]]


@pytest.mark.slow
@pytest.mark.parametrize("size", [32, 64, 128])
def test_a_disc_on_a_pad_of_any_size_is_one_contact(size):
    middle, radius = size / 2, 0.25 * size
    images = [uneven(discs(size, size, (middle, middle, radius)), seed) for seed in range(12)]
    assert counts(SPLIT, images) == [1] * 12


@pytest.mark.slow
def test_what_falls_apart_in_detail_is_whole_on_coarser_cells():
    images = [uneven(discs(24, 24, (12, 12, 10)), seed, voids=0.45) for seed in range(8)]
    assert counts(SPLIT, images) == [1] * 8
    assert min(counts(FINE, images[:1])) > 4


@pytest.mark.slow  # parting is compiled
def test_two_large_discs_that_touch_are_two_contacts_of_the_right_cells():
    both = discs(64, 64, (20, 20, 11), (36, 40, 14))
    for seed in range(8):
        image = uneven(both, seed)
        found = SPLIT(image, image.mask(image.values >= LEVEL_V)).contacts
        assert len(found) == 2
        places = sorted((c.centroid_y_cm, c.centroid_x_cm) for c in found)
        wanted = [(1.3 * (y + 0.5) - 0.15, 1.3 * (x + 0.5) - 0.15) for y, x in ((20, 20), (36, 40))]
        assert np.abs(np.subtract(places, wanted)).max() < 1.3  # one cell


@pytest.mark.slow  # parting is compiled
def test_small_objects_side_by_side_are_not_lost_on_coarser_cells():
    """Twenty-four discs of some twelve cells, a cell or two apart: three hundred cells in all."""
    places = [(2.5 + 5.4 * i, 2.5 + 5.4 * j, 2.0) for i in range(4) for j in range(6)]
    image = uneven(discs(24, 36, *places), 3, voids=0.05)
    mask = image.mask(image.values >= LEVEL_V)
    assert mask.count > 250
    assert len(parts(mask.values)) < 4
    assert 22 <= SPLIT(image, mask).count <= 26


@pytest.mark.slow  # parting is compiled
def test_objects_of_unlike_size_are_each_looked_at_on_their_own_scale():
    image = discs(64, 64, (25, 25, 18), (55, 55, 2.2), (55, 8, 2.2))
    found = SPLIT(image, image.mask(image.values > 0)).contacts
    apart = parts(image.values > 0)
    assert len(apart) == 3
    assert sorted(c.n_cells for c in found) == sorted(p[0].size for p in apart)


@pytest.mark.slow  # parting is compiled
def test_up_to_the_working_cells_nothing_is_coarser():
    for frame in frames("six", 6, 4):
        mask = frame.image.mask(frame.image.values >= LEVEL_V)
        assert mask.count <= 100
        one, other = SPLIT(frame.image, mask), FINE(frame.image, mask)
        assert [c.box for c in one.contacts] == [c.box for c in other.contacts]


def test_every_cell_is_in_exactly_one_object_and_a_hopeless_split_ends():
    rng = np.random.default_rng(2)
    for _ in range(20):
        on = rng.random((40, 50)) < rng.uniform(0.05, 0.9)
        labels = split_by_scale(cells_of(on), lambda c: drawn_labels(c, rng), 16)
        assert np.array_equal(labels > 0, on)
        assert set(np.unique(labels[on])) == set(range(1, int(labels.max()) + 1))


def drawn_labels(cells, rng):
    """Number each cell that is on at random."""
    return np.where(cells.on, rng.integers(1, 5, cells.on.shape), 0).astype(np.int32)


def test_blocks_that_are_all_off_leave_a_part_whole():
    on = np.eye(60, dtype=bool)  # no block of 3 by 3 has half its cells on
    assert not cells_of(on).coarser(3).on.any()
    labels = split_by_scale(cells_of(on), lambda c: c.on.astype(np.int32), 7)
    assert np.array_equal(labels, on.astype(np.int32))


@pytest.mark.slow  # much is compiled
def test_a_full_pad_is_one_contact():
    mask = mask_of(np.ones((40, 60)))
    assert [c.n_cells for c in SPLIT(image_of(np.ones((40, 60))), mask).contacts] == [2400]


@pytest.mark.parametrize(("working_cells", "shape"), [(64, (8, 8)), (16, (4, 4)), (7, (2, 2))])
def test_so_many_cells_at_most_are_on_in_what_is_split(working_cells, shape):
    seen = []

    def whole(cells):
        seen.append(cells.values.copy())
        return cells.on.astype(np.int32)

    values = np.arange(64.0).reshape(8, 8)
    labels = split_by_scale(cells_of(np.ones((8, 8), bool), values), whole, working_cells)
    assert (labels == 1).all()
    n = 8 // shape[0]
    blocks = values.reshape(shape[0], n, shape[1], n).mean(axis=(1, 3))
    np.testing.assert_array_equal(seen[0], blocks)


def test_blocks_are_made_smaller_only_where_objects_on_them_have_too_few():
    """Of 400 cells on blocks of 4 by 4, each object must hold 12 blocks: two may be, three not."""
    for n_objects, shapes in ((1, [(5, 5)]), (2, [(5, 5)]), (3, [(5, 5), (7, 7)])):
        seen = []

        def split(cells, n=n_objects, seen=seen):
            seen.append(cells.on.shape)
            columns = np.arange(cells.on.shape[1]) * n // cells.on.shape[1]
            return np.broadcast_to(columns + 1, cells.on.shape).astype(np.int32)

        split_by_scale(cells_of(np.ones((20, 20))), split, 25)
        assert seen[: len(shapes)] == shapes
