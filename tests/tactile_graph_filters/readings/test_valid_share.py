"""The share of cells that are known."""

import numpy as np
import pytest

from tactile_graph.errors import RuleError
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.readings.valid_share import valid_share


def test_counts_the_valid_cells_of_the_image_or_of_a_mask():
    valid = np.array([[True, False, True, True]])
    image = Image(np.zeros((1, 4)), valid=valid)
    mask = Mask(np.array([[True, True, False, False]]))
    assert valid_share(image) == (0.75, 3, 4)
    assert valid_share(image, mask) == (0.5, 1, 2)


def test_all_are_valid_where_none_is_said_not_to_be():
    image = Image(np.zeros((2, 3)))
    assert valid_share(image) == (1.0, 6, 6)
    assert valid_share(image, Mask(np.eye(2, 3, dtype=bool))) == (1.0, 2, 2)


def test_of_no_cell_the_share_is_whole():
    image = Image(np.zeros((1, 2)), valid=np.zeros((1, 2), bool))
    assert valid_share(image, Mask(np.zeros((1, 2), bool))) == (1.0, 0, 0)
    assert valid_share(image).share == 0.0


def test_another_grid_is_refused():
    with pytest.raises(RuleError, match="shape"):
        valid_share(Image(np.zeros((2, 2))), Mask(np.ones((2, 3), bool)))
