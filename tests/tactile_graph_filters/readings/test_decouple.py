import math

import numpy as np
import pytest

from helpers_filters import image_of, same_grid
from tactile_graph.errors import DataError, Degenerate
from tactile_graph_filters.readings.decouple import Decouple
from tactile_graph_pads.circuits import Divider, Floating


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
    from tactile_graph_pads.circuits import Inverse

    poor = Inverse(np.ones((1, 2)), np.ones((1, 2), bool), residual=0.2, iterations=7)
    monkeypatch.setattr(Floating, "inverse", lambda self, ratio, start=None: poor)
    monkeypatch.setattr(Floating, "nearest", lambda self, ratio, noise, seen: (poor, 3.0))
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


FLOATING = {
    "circuit": {"kind": "floating"},
    "converter": {"bits": 12, "low_v": 0.0, "high_v": 5.0},
    "scan": {"samples": 1, "noise_v": 0.001},
}


def disc_siemens(seed: int) -> np.ndarray:
    """Return a disc of some 50 elements that conduct unevenly; the others hardly do."""
    rng = np.random.default_rng(seed)
    row, column = np.indices((16, 16))
    inside = np.hypot(row - 7.0, column - 8.0) < 4.0
    return np.where(inside, 1e-5 * np.exp(rng.normal(0.0, 0.4, (16, 16))), 1e-10)


def measured(circuit, siemens: np.ndarray, seed: int) -> np.ndarray:
    noise = np.random.default_rng(seed).normal(0.0, 0.001, siemens.shape)
    step = 5.0 / 4096
    return np.maximum(np.round((5.0 * circuit.ratio(siemens) + noise) / step) * step, 0.0)


@pytest.mark.parametrize("seed", range(3))
def test_ghosts_come_out_of_noisy_voltages_in_steps(seed):
    siemens = disc_siemens(seed)
    volts = measured(Floating(), siemens, seed)
    assert volts[siemens == 1e-10].max() > 0.05
    found = Decouple(pad=FLOATING)(image_of(volts)).values
    assert np.abs(found - siemens).sum() < 0.03 * siemens.sum()
    assert found.min() >= 0.0
    assert found[siemens == 1e-10].max() < 0.03 * siemens.max()


def test_an_element_that_was_not_read_does_not_keep_the_others_from_being_found():
    siemens = disc_siemens(4)
    volts, valid = measured(Floating(), siemens, 4), np.ones((16, 16), bool)
    volts[7, 8], valid[7, 8], siemens[7, 8] = math.nan, False, 0.0
    image = Decouple(pad=FLOATING)(image_of(volts, valid=valid))
    assert not image.valid[7, 8]
    assert np.abs(image.values - siemens).sum() < 0.05 * siemens.sum()


@pytest.mark.slow
def test_voltages_of_another_circuit_are_told_from_noise():
    volts = measured(Divider(), disc_siemens(5), 5)
    with pytest.raises(
        Degenerate, match=r"nearest .* times the noise of 0\.0011 V that .* circuit's"
    ):
        Decouple(pad=FLOATING)(image_of(volts))
