"""What all hulls share."""

import numpy as np

from tactile_graph_hull.corners import finished, in_range


def regular(n):
    angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return np.column_stack([-np.cos(angle), np.sin(angle)])


def test_no_tolerance_keeps_every_corner():
    corners = regular(7)
    assert finished(corners, 0.0) is corners


def test_clear_corners_all_stay():
    corners = regular(200)
    assert np.array_equal(finished(corners, 8.0), corners)


def test_corners_within_rounding_of_their_neighbours_line_go():
    dent = 2.0**-51
    square = np.array([[0.0, 0], [-dent, 0.5], [0, 1], [0.4, 1 + dent], [1, 1], [1, 0]])
    assert finished(square, 8.0).tolist() == [[0, 0], [0, 1], [1, 1], [1, 0]]


def test_first_corner_is_the_lowest_of_those_that_stay():
    dent = 2.0**-51
    corners = np.array([[-dent, 0.5], [0, 1], [1, 1], [1, 0], [0.0, 0]])
    assert finished(corners, 8.0).tolist() == [[0, 0], [0, 1], [1, 1], [1, 0]]


def test_sliver_thinner_than_rounding_is_a_line_of_two_corners():
    corners = np.array([[0.0, 0], [1, 1 + 2.0**-51], [3, 3], [2, 2 - 2.0**-51]])
    assert finished(corners, 8.0).tolist() == [[0, 0], [3, 3]]


def test_slow_bend_is_not_straightened():
    """Each corner is within rounding of its neighbours' line, the arc as a whole is not."""
    angle = np.linspace(0.0, 1e-5, 4000)  # bows by 1.2e-11, 2e-17 from corner to corner
    arc = np.column_stack([-np.cos(angle), np.sin(angle)])
    corners = finished(np.vstack([arc, [[1.0, 0.0]]]), 8.0)
    kept = corners[np.lexsort((corners[:, 1],))]
    kept = kept[kept[:, 0] < 0.0]
    assert 20 < len(kept) < 4000
    bowed = np.interp(arc[:, 1], kept[:, 1], kept[:, 0]) - arc[:, 0]
    assert np.abs(bowed).max() <= 16 * 2.0**-52  # of the 1e-11 that the arc bows


def test_range_is_where_products_are_exact():
    assert in_range(np.array([[0.0, 1.0], [2.0**-430, 2.0**480]]))
    for bad in (2.0**-431, 2.0**481, np.nan, np.inf):
        assert not in_range(np.array([[0.0, 1.0], [1.0, bad]]))
    assert not in_range(np.empty((0, 2)))
