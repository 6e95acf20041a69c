"""A box cut out of a partition is a copy of its own."""

import numpy as np

from tactile_graph_filters.parting.partition import Partition, cut_out


def test_a_box_holds_the_rows_and_columns_named_and_leaves_the_whole_alone() -> None:
    owner = np.arange(12, dtype=np.int32).reshape(3, 4)
    whole = Partition(owner, owner * 0.5, owner % 2 == 0)
    part = cut_out(whole, 1, 2, 0, 1)
    np.testing.assert_array_equal(part.owner, [[4, 5], [8, 9]])
    np.testing.assert_array_equal(part.values, [[2.0, 2.5], [4.0, 4.5]])
    np.testing.assert_array_equal(part.known, [[True, False], [True, False]])
    part.owner[:] = 0
    assert owner.sum() == 66
