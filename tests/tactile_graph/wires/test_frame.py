"""Frames are made around copies, with broken cells masked, and are frozen."""

from __future__ import annotations

import math
import re
import warnings
from typing import Any

import numpy as np
import pytest

from tactile_graph import Frame, Image, Mask, Points
from tactile_graph.wires import Circle, Ellipse, Rectangle, TrueObject


def test_values_are_copied_and_frozen() -> None:
    values = np.arange(6, dtype=np.int16).reshape(2, 3)
    frame = Frame.of(values, 1.3)
    values[0, 0] = 99
    assert frame.image.values[0, 0] == 0.0
    assert frame.image.values.dtype == np.float64
    assert values.flags.writeable
    with pytest.raises(ValueError, match="read-only"):
        frame.image.values[0, 0] = 1.0


def test_cells_that_are_no_number_become_invalid_and_hold_zero() -> None:
    frame = Frame.of(np.array([[1.0, np.nan], [np.inf, -np.inf]]))
    assert frame.image.values.tolist() == [[1.0, 0.0], [0.0, 0.0]]
    assert frame.image.valid is not None
    assert frame.image.valid.tolist() == [[True, False], [False, False]]
    assert not frame.image.valid.flags.writeable


def test_a_frame_full_of_nan_is_all_invalid_without_a_warning() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        image = Frame.of(np.full((16, 16), np.nan)).image
        assert image.valid is not None
        assert not image.valid.any()
        assert (image.total, image.peak) == (0.0, 0.0)


def test_good_values_have_no_mask() -> None:
    assert Frame.of(np.ones((2, 2))).image.valid is None


@pytest.mark.parametrize("shape", [(), (4,), (2, 2, 2), (0, 3), (3, 0), (0, 0)])
def test_values_that_are_no_matrix_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(
        ValueError, match=r"a frame takes values of shape \(rows, columns\), got \("
    ):
        Frame.of(np.zeros(shape))


@pytest.mark.parametrize("pitch", [1.3, 1, np.float64(1.3), np.int64(2), (1.3, 0.9), [1.0, 2.0]])
def test_a_pitch_may_be_one_number_or_two(pitch: Any) -> None:
    x, y = Frame.of(np.ones((2, 2)), pitch).image.pitch_cm
    assert (x, y) == tuple(np.broadcast_to(pitch, 2))
    assert type(x) is float


@pytest.mark.parametrize("pitch", [0, -1.0, np.nan, (1.0, 0.0)])
def test_a_pitch_that_is_no_length_is_refused(pitch: Any) -> None:
    with pytest.raises(ValueError, match="a pitch must be > 0 cm, got "):
        Frame.of(np.zeros((2, 2)), pitch)


@pytest.mark.parametrize("pitch", [np.inf, 1e300, 1e-300, (1.0, 1e7)])
def test_a_pitch_that_no_pad_has_is_refused(pitch: Any) -> None:
    with pytest.raises(ValueError, match=r"a pitch must be within 1e-06 to 1e\+06 cm, got "):
        Frame.of(np.zeros((2, 2)), pitch)


@pytest.mark.parametrize(
    ("values", "got"),
    [
        (np.ones((2, 2)) + 1j, "complex128"),
        (np.array([["1", "2"]]), "str"),
        (np.array([[1.0, 2j]], dtype=object), "object|complex"),
        (np.array([["pad", 1.0]], dtype=object), "could not convert"),
    ],
)
def test_what_is_no_real_number_is_refused(values: Any, got: str) -> None:
    with pytest.raises(ValueError, match=f"a frame takes real numbers.*({got})"):
        Frame.of(values)


def test_an_image_has_a_pitch_of_its_own_and_is_no_bare_values() -> None:
    image = Image(np.ones((2, 2)), (0.5, 0.5))
    with pytest.raises(ValueError, match=r"bare values, got an Image; write Frame\(image\)"):
        Frame.of(image)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"bare values, got a Mask; take its \.values"):
        Frame.of(image.mask(np.ones((2, 2), bool)))  # type: ignore[arg-type]


def test_places_and_times_that_are_not_finite_are_refused() -> None:
    for x in (np.nan, 1e300):
        with pytest.raises(ValueError, match="an origin must be within 1e\\+09 cm"):
            Frame.of(np.zeros((2, 2)), origin_cm=(x, 0.0))
    with pytest.raises(ValueError, match="device_time_s must be finite, got nan"):
        Frame.of(np.zeros((2, 2)), device_time_s=np.nan)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"pitch_cm": "2"}, r"a pitch is one number or two, of cm along x and y, got '2'"),
        ({"pitch_cm": (1.0, 2.0, 3.0)}, r"a pitch is one number or two, .* got \(1.0, 2.0, 3.0\)"),
        ({"pitch_cm": None}, r"a pitch is one number or two, .* got None"),
        ({"origin_cm": 1.0}, r"an origin is two numbers, of cm along x and y, got 1.0"),
        ({"origin_cm": ("0", "0")}, r"an origin is two numbers"),
        ({"quantity": None}, r"a quantity is named by a text, got None"),
        ({"index": 1.5}, r"an index must be a whole number, got 1.5"),
        ({"index": "a"}, r"an index must be a whole number, got 'a'"),
        ({"index": -1}, r"an index counts from 0, got -1"),
        ({"time_s": "1"}, r"time_s must be a number of seconds, got '1'"),
        ({"label": 3}, r"a label must be a text, got 3"),
    ],
)
def test_what_is_of_the_wrong_type_is_told(given: dict[str, Any], told: str) -> None:
    with pytest.raises(ValueError, match=told):
        Frame.of(np.ones((2, 2)), **given)


def test_readings_whose_squares_are_no_numbers_are_none() -> None:
    image = Frame.of(np.array([[1e300, 1e-300, 1.0, -1e101]])).image
    assert image.values.tolist() == [[0.0, 0.0, 1.0, 0.0]]
    assert image.valid is not None
    assert image.valid.tolist() == [[False, True, True, False]]


def test_a_quantity_that_is_none_is_refused() -> None:
    with pytest.raises(ValueError, match="unknown quantity 'volts'; did you mean 'volt'"):
        Frame.of(np.ones((2, 2)), quantity="volts")


def test_a_frame_carries_what_it_is_told() -> None:
    frame = Frame.of([[1]], index=4, time_s=0.5, label="left")  # type: ignore[arg-type]
    assert (frame.index, frame.time_s, frame.label, frame.truth) == (4, 0.5, "left", None)
    assert (frame.with_index(7).index, frame.with_index(7).image) == (7, frame.image)


@pytest.mark.parametrize(
    "record",
    [Image(np.ones((1, 1))), Mask(np.ones((1, 1), dtype=bool)), Points(np.ones((1, 2)))],
    ids=lambda r: type(r).__name__,
)
def test_records_are_frozen(record: Any) -> None:
    name = "xy_cm" if isinstance(record, Points) else "values"
    with pytest.raises(AttributeError, match=f"is frozen: cannot set '{name}'"):
        setattr(record, name, np.ones((1, 1)))
    with pytest.raises(ValueError, match="read-only"):
        getattr(record, name)[0, 0] = 0
    if not isinstance(record, Points):
        with pytest.raises(AttributeError, match="is frozen: cannot delete 'values'"):
            del record.values


def test_places_follow_from_pitch_and_origin() -> None:
    image = Image(np.zeros((2, 3)), (1.3, 2.0), (10.0, 20.0))
    assert image.x_cm.tolist() == pytest.approx([10.65, 11.95, 13.25])
    assert image.y_cm.tolist() == [21.0, 23.0]
    assert image.extent_cm == pytest.approx((10.0, 13.9, 24.0, 20.0))
    assert image.cell_area_cm2 == pytest.approx(2.6)
    assert (image.rows, image.columns, image.shape) == (2, 3, (2, 3))


def test_sums_leave_invalid_cells_out() -> None:
    image = Image(np.array([[1.0, 5.0]]), valid=np.array([[True, False]]))
    assert (image.total, image.peak) == (1.0, 1.0)
    assert image.filled(-1.0).tolist() == [[1.0, -1.0]]


def test_a_true_shape_with_its_shorter_side_first_is_the_same_one_turned() -> None:
    bar = TrueObject(Rectangle(3.0, 4.0, 2.0, 6.0, 0.3)).shape
    assert bar == Rectangle(3.0, 4.0, 6.0, 2.0, 0.3 + math.pi / 2)
    egg = TrueObject(Ellipse(3.0, 4.0, 2.0, 6.0, 0.3)).shape
    assert egg == Ellipse(3.0, 4.0, 6.0, 2.0, 0.3 + math.pi / 2)
    corners = [
        np.asarray(sorted(s.outline_cm().tolist())) for s in (bar, Rectangle(3, 4, 2, 6, 0.3))
    ]  # type: ignore[union-attr]
    np.testing.assert_allclose(*corners)
    for shape in (Rectangle(3.0, 4.0, 6.0, 2.0, 0.3), Ellipse(3.0, 4.0, 2.0, 2.0, 0.3)):
        assert TrueObject(shape).shape is shape


@pytest.mark.parametrize("dtype", [float, int, object])
def test_masked_cells_are_invalid_as_nan_cells_are(dtype: type) -> None:
    masked = np.ma.masked_equal(np.array([[1, 65535], [3, 4]], dtype=dtype), 65535)
    image = Frame.of(masked).image
    assert type(image.values) is np.ndarray
    assert image.valid is not None
    assert image.valid.tolist() == [[True, False], [True, True]]
    assert image.total == 8.0
    assert image.values[0, 1] == 0.0


@pytest.mark.parametrize("dtype", [float, int, object])
def test_masked_cells_of_rows_are_invalid_too(dtype: type) -> None:
    masked = np.ma.masked_equal(np.array([[1, 65535], [3, 4]], dtype=dtype), 65535)
    for rows in (list(masked), (masked[0], [3, 4])):
        image = Frame.of(rows).image  # type: ignore[arg-type]
        assert image.valid is not None
        assert image.valid.tolist() == [[True, False], [True, True]]
        assert image.values.tolist() == [[1.0, 0.0], [3.0, 4.0]]
    assert masked.data[0, 1] == 65535
    assert Frame.of(np.ma.array([[1.0, 2.0]])).image.valid is None


@pytest.mark.parametrize(
    ("shape", "told"),
    [
        (Circle(math.nan, 1.0, 2.0), "a true Circle: x_cm must be a finite number, got nan"),
        (Circle(1.0, 1.0, -2.0), "a true Circle: radius_cm must be at least 0, got -2.0"),
        (Circle(1.0, "1", 2.0), "a true Circle: y_cm must be a finite number, got '1'"),
        (Ellipse(1.0, 1.0, 2.0, -1.0, 0.0), "a true Ellipse: semi_minor_cm must be at least 0"),
        (Rectangle(1.0, 1.0, math.inf, 1.0, 0.0), "a true Rectangle: length_cm must be a finite"),
    ],
)
def test_what_truly_lay_there_has_a_place_and_a_size(shape: Any, told: str) -> None:
    with pytest.raises(ValueError, match=re.escape(told)):
        TrueObject(shape)
    assert TrueObject(Circle(-3, np.float32(1.0), 0)).weight_g is None


def test_a_truth_is_a_tuple_of_true_objects() -> None:
    disc = Circle(1.0, 1.0, 0.5)
    for truth, told in (
        (TrueObject(disc), r"truth is a tuple of TrueObject, got .*; give \(TrueObject\(…\),\)"),
        ((disc,), r"truth is a tuple of TrueObject, got Circle.*; give TrueObject\(shape\)"),
        ("circle", "truth is a tuple of TrueObject, got 'circle'"),
    ):
        with pytest.raises(ValueError, match=told):
            Frame.of(np.eye(2), truth=truth)
    true = TrueObject(disc)
    assert Frame.of(np.eye(2), truth=[true]).truth == Frame.of(np.eye(2), truth=(true,)).truth
    assert Frame.of(np.eye(2), truth=()).truth == ()


@pytest.mark.slow
def test_what_pandas_says_is_missing_is_invalid_as_nan_is() -> None:
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame({"a": [1, 2], "b": [3, None]}, dtype="Int64")
    for given in (table, table.to_numpy(), table.astype("Float64")):
        image = Frame.of(given).image
        assert image.values.tolist() == [[1.0, 3.0], [2.0, 0.0]]
        assert image.valid is not None
        assert image.valid.tolist() == [[True, True], [True, False]]
