"""``Image``: values that every step and every kernel takes."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

from tactile_graph.wires import (
    Image,
    Mask,
    Points,
    Polygon,
    packed_mask,
    quick_image,
    quick_mask,
    quick_points,
    quick_polygon,
)
from tactile_graph.wires.stacks import ImageStack


@pytest.mark.parametrize("kind", [np.float16, np.longdouble])
def test_what_no_machine_code_takes_becomes_double(kind: Any) -> None:
    image = Image(np.array([[0.5, 2.0]], dtype=kind))
    assert image.values.dtype == np.float64
    assert image.values.tolist() == [[0.5, 2.0]]
    assert not image.values.flags.writeable


@pytest.mark.parametrize("kind", ["i2", "u4", "f4", "f8", "f2"])
def test_wires_hold_numbers_in_the_machines_byte_order(kind: str) -> None:
    given = np.array([[1, 2]], dtype=np.dtype(kind).newbyteorder())
    held = [
        Image(given).values, Points(given).xy_cm, Polygon(given).xy_cm,
        ImageStack(given[None]).values[0],
    ]  # fmt: skip
    for values in held:
        assert values.dtype.isnative
        assert values.dtype == (np.float64 if kind == "f2" else np.dtype(kind))
        assert values.tolist() == [[1, 2]]
        assert not values.flags.writeable


@pytest.mark.parametrize("kind", [np.int16, np.float32, np.bool_])
def test_other_numbers_are_taken_as_they_are(kind: Any) -> None:
    values = np.array([[0, 1]], dtype=kind)
    assert Image(values).values is values


def test_wires_made_at_once_equal_those_of_their_classes_and_are_frozen() -> None:
    grid, cells, xy = ((1.3, 1.2), (-0.1, 0.2)), np.eye(3) > 0, np.arange(6.0).reshape(3, 2)
    valid = ~cells
    pairs = [
        (quick_mask(cells, *grid, 3), Mask(cells, *grid, 3)),
        (quick_image(np.eye(3), *grid, "volt", valid), Image(np.eye(3), *grid, "volt", valid)),
        (quick_points(xy), Points(xy)),
        (quick_polygon(xy), Polygon(xy)),
    ]
    for quick, usual in pairs:
        assert type(quick) is type(usual)
        assert repr(quick) == repr(usual)
        assert pickle.dumps(quick) == pickle.dumps(usual)
        array = "values" if hasattr(quick, "values") else "xy_cm"
        assert not getattr(quick, array).flags.writeable
        with pytest.raises(AttributeError):
            setattr(quick, array, None)


@pytest.mark.parametrize("columns", [1, 7, 8, 33, 64])
def test_a_mask_of_packed_rows_is_the_mask_of_its_cells(columns: int) -> None:
    cells = np.random.default_rng(columns).random((5, columns)) < 0.5
    words = np.array([sum(int(on) << c for c, on in enumerate(row)) for row in cells], np.uint64)
    grid, count = ((1.0, 1.0), (0.0, 0.0)), int(cells.sum())
    mask, usual = packed_mask(words, columns, *grid, count), Mask(cells, *grid)
    before = (mask.shape, mask.count, mask.fraction, mask.area_cm2, mask.extent_cm)
    np.testing.assert_array_equal(mask.values, cells)
    after = (mask.shape, mask.count, mask.fraction, mask.area_cm2, mask.extent_cm)
    expected = (usual.shape, usual.count, usual.fraction, usual.area_cm2, usual.extent_cm)
    assert before == after == expected
    assert mask.values is mask.values
    assert not mask.values.flags.writeable
    assert usual.words is None
    again = pickle.loads(pickle.dumps(mask))
    np.testing.assert_array_equal(again.values, cells)


def test_packed_rows_are_laid_out_as_kernels_take_them() -> None:
    spread = np.arange(6, dtype=np.int64)[::2]
    mask = packed_mask(spread, 3, (1.0, 1.0), (0.0, 0.0), 2)
    assert mask.words is not None
    assert mask.words.flags.c_contiguous
    assert mask.words.dtype == np.uint64
    assert mask.words.tolist() == [0, 2, 4]


def test_masked_cells_of_an_image_are_invalid_and_those_of_a_mask_off() -> None:
    values = np.ma.masked_equal(np.array([[1.0, 9.0], [3.0, 4.0]]), 9.0)
    valid = np.array([[True, True], [True, False]])
    image = Image(values, valid=valid)
    assert type(image.values) is np.ndarray
    assert not image.values.flags.writeable
    assert image.valid is not None
    assert image.valid.tolist() == [[True, False], [True, False]]
    assert image.total == 4.0
    assert Image(np.ma.array([[1.0, 2.0]])).valid is None
    assert Mask(values > 0.5).count == 3
    stack = ImageStack(np.ma.stack([values, values]))
    assert type(stack.values) is np.ndarray
    assert stack.valid is not None
    assert stack[1].total == 8.0


def test_numpy_sees_values_with_nan_in_invalid_cells() -> None:
    values, valid = np.arange(6.0).reshape(2, 3), np.ones((2, 3), bool)
    good = Image(values)
    assert np.asarray(good) is good.values
    assert np.array(good).flags.writeable
    assert np.asarray(good, dtype=np.float32).dtype == np.float32
    np.testing.assert_array_equal(np.asarray(good.mask(values > 1.0)), values > 1.0)
    valid[0, 1] = False
    holey = Image(values, valid=valid)
    np.testing.assert_array_equal(np.asarray(holey), [[0.0, np.nan, 2.0], [3.0, 4.0, 5.0]])
    with pytest.raises(ValueError, match=r"cells are invalid, and int64 has no NaN; filled\(\)"):
        np.asarray(holey, dtype=np.int64)
    with pytest.raises(ValueError, match="an image with invalid cells needs a copy"):
        np.array(holey, copy=False)


@pytest.mark.filterwarnings("ignore:the matrix subclass:PendingDeprecationWarning")
def test_a_matrix_is_held_as_a_plain_array_whose_product_is_element_by_element() -> None:
    given = np.matrix([[1.0, 2.0], [3.0, 4.0]])
    held = [Image(given).values, Image(np.zeros((2, 2))).with_values(given).values]
    for values in held:
        assert type(values) is np.ndarray
        assert (values * values).tolist() == [[1.0, 4.0], [9.0, 16.0]]
