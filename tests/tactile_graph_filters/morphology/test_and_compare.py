import pytest

from helpers_filters import drawn, image_of, mask_of, random_mask, same_grid
from tactile_graph.errors import RuleError
from tactile_graph_filters.images.low_pass import LowPass
from tactile_graph_filters.morphology.and_compare import and_compare


def test_only_cells_on_in_both_stay():
    a, b = random_mask(0), random_mask(1)
    both = and_compare(a, b)
    assert (both.values == (a.values & b.values)).all()
    assert same_grid(a, both)


def test_with_the_low_pass_it_removes_lone_cells_and_keeps_the_size():
    noisy = drawn("""
        #.......
        ..####..
        ..####.#
        ..####..
        ..####..
        ........
    """)
    cleaned = and_compare(noisy, LowPass()(noisy), level=0.4)
    assert cleaned.values[1:5, 2:6].all()
    assert cleaned.count == 16


def test_an_image_is_on_from_the_level_on_and_never_where_invalid():
    image = image_of([[0.49, 0.5, 0.9]], valid=[[True, True, False]])
    assert and_compare(image, mask_of([[1, 1, 1]])).values.tolist() == [[False, True, False]]
    assert and_compare(mask_of([[1, 1, 1]]), image, level=0.4).values.tolist() == [
        [True, True, False]
    ]


def test_different_shapes_are_refused():
    with pytest.raises(RuleError, match=r"must have the same shape, got \(1, 2\) and \(2, 1\)"):
        and_compare(mask_of([[1, 1]]), mask_of([[1], [1]]))
