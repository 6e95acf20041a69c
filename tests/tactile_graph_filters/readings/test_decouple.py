import math

import numpy as np
import pytest

from helpers_filters import image_of, same_grid
from tactile_graph.errors import DataError, Degenerate
from tactile_graph_filters.readings.decouple import Decouple


def test_the_divider_is_undone_in_closed_form():
    volts = image_of([[1.0, 0.0], [2.0, 0.5]])
    image = Decouple()(volts)
    g_ref = 1 / 33e3
    expected = [[0.2 * g_ref / 0.4, 0.0], [0.4 * g_ref / 0.4, 0.1 * g_ref / 0.9]]
    assert image.values == pytest.approx(np.array(expected))
    assert image.quantity == "siemens"
    assert same_grid(volts, image)


def test_a_column_that_adds_up_to_the_supply_is_invalid_and_not_clipped():
    image = Decouple()(image_of([[3.0, 1.0], [2.0, 1.0]]))
    assert image.valid.tolist() == [[False, True], [False, True]]
    assert image.values[:, 0].tolist() == [0.0, 0.0]


def test_invalid_cells_stay_invalid():
    image = Decouple()(image_of([[0.0, 1.0], [2.0, 1.0]], valid=[[False, True], [True, True]]))
    assert image.valid.tolist() == [[False, True], [True, True]]


def test_an_inverse_that_does_not_come_close_enough_is_degenerate(monkeypatch):
    from tactile_graph_pads.circuits import Floating, Inverse

    poor = Inverse(np.ones((1, 2)), np.ones((1, 2), bool), residual=0.2, iterations=7)
    monkeypatch.setattr(Floating, "inverse", lambda self, ratio, start=None: poor)
    with pytest.raises(Degenerate, match=r"floating circuit stopped after 7 steps .* 0\.2, all"):
        Decouple(pad={"circuit": {"kind": "floating"}})(image_of([[1.0, 1.0]]))
    assert Decouple(pad={"circuit": {"kind": "floating"}}, max_residual=0.5)(
        image_of([[1.0, 1.0]])
    ).values.tolist() == [[1.0, 1.0]]


def test_nan_in_an_invalid_cell_does_no_harm():
    image = Decouple()(image_of([[math.nan], [1.0]], valid=[[False], [True]]))
    assert image.values[1, 0] == pytest.approx(0.2 / 0.8 / 33e3)


def test_nan_is_refused():
    with pytest.raises(DataError, match="row 1, column 0: must be a number, got nan"):
        Decouple()(image_of([[1.0, 1.0], [math.nan, 1.0]]))
