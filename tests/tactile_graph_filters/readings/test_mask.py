import pytest

from helpers_filters import image_of, same_grid
from tactile_graph.errors import DataError
from tactile_graph_filters.readings.mask import mask

VALUES = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]


def test_listed_elements_and_lines_become_invalid_and_hold_zero():
    image = image_of(VALUES)
    found = mask(image, cells=((0, 1),), rows=(1,), columns=(2,))
    assert found.valid.tolist() == [[True, False, False], [False, False, False]]
    assert found.values.tolist() == [[1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]
    assert same_grid(image, found)


def test_what_was_invalid_stays_so():
    image = image_of([[0.0, 2.0]], valid=[[False, True]])
    assert mask(image).valid.tolist() == [[False, True]]


@pytest.mark.parametrize("bad", [{"cells": ((2, 0),)}, {"rows": (2,)}, {"columns": (3,)}])
def test_an_element_that_is_not_there_is_refused(bad):
    with pytest.raises(DataError, match=r"row \d, column \d is not on an image of 2 x 3"):
        mask(image_of(VALUES), **bad)
