import math

import numpy as np
import pytest

import references_filters as references
from helpers_filters import image_of, same_grid
from tactile_graph.errors import DataError
from tactile_graph_filters.readings.volts import Volts, to_volts


def test_twelve_bits_cover_five_volts_either_way():
    counts = image_of([[0, 2048, 2049, 4094]], "counts")
    image = Volts()(counts)
    step = 10 / 4096
    assert image.values == pytest.approx(np.array([[-5.0, 0.0, step, 5.0 - 2 * step]]))
    assert image.quantity == "volt"
    assert image.valid is None
    assert same_grid(counts, image)


def test_counts_that_the_converter_cannot_give_become_invalid():
    image = Volts()(image_of([[-1, 4096, 2048, 4095]], "counts"))
    assert image.valid.tolist() == [[False, False, True, False]]
    assert image.values.tolist() == [[0.0, 0.0, 0.0, 0.0]]


def test_the_last_count_can_be_kept():
    image = Volts(keep_full_scale=True)(image_of([[4095, 4096]], "counts"))
    assert image.valid.tolist() == [[True, False]]


def test_invalid_cells_stay_invalid_and_hold_zero():
    image = Volts()(image_of([[0, 3000]], "counts", valid=[[False, True]]))
    assert image.valid.tolist() == [[False, True]]
    assert image.values[0, 0] == 0.0


def test_nan_is_refused():
    with pytest.raises(DataError, match="row 0, column 0: must be a number, got nan"):
        Volts()(image_of([[math.nan, 1.0]], "counts"))


def test_an_ideal_converter_gives_volts_as_they_are():
    image = Volts(pad={"converter": {"bits": None}})(image_of([[-7.0, 1e9]], "counts"))
    assert image.values.tolist() == [[-7.0, 1e9]]
    assert image.valid is None


def test_it_counts_and_scales_as_the_reference_does():
    pytest.importorskip("numba")
    counts = np.random.default_rng(0).normal(0.0, 5.0, (6, 9))
    outs = np.empty((3, 6, 9))
    given = (counts, 2.0, 0.1, -3.0, 4.0)
    kernels = (references.to_volts, to_volts.loops, to_volts.compiled)
    assert len({which(*given, out) for which, out in zip(kernels, outs, strict=True)}) == 1
    assert np.array_equal(outs[0], outs[1])
    assert np.array_equal(outs[0], outs[2])
