"""Arrays that are legal and seldom: each is read as what it is, or refused with what to do."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_dialects import OBLONG, matlab
from helpers_recordings import frames_of, npy_bytes, npz_bytes, write
from tactile_graph.errors import DataError

Save = Callable[[Path, np.ndarray], Path]
FIELDS = np.zeros(12, [("t", "f8"), ("cells", "f8", (6, 10))])
DATES = OBLONG.astype("i8").astype("M8[s]")


def npy(folder: Path, values: np.ndarray) -> Path:
    return write(folder, npy_bytes(values))


def npz(folder: Path, values: np.ndarray) -> Path:
    return write(folder, npz_bytes(**{"mein Würfel 1": values}))


def hdf5(folder: Path, values: np.ndarray) -> Path:
    h5py = pytest.importorskip("h5py", reason="the 'hdf5' extra is not installed")
    with h5py.File(folder / "a.h5", "w") as file:
        file["mein Würfel 1"] = values
    return folder / "a.h5"


def zarr(folder: Path, values: np.ndarray) -> Path:
    library: Any = pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
    group = library.open_group(str(folder / "a.zarr"), mode="w", zarr_format=2)
    group.create_array("mein Würfel 1", data=values)
    return folder / "a.zarr"


SLOW_ZARR = pytest.param(zarr, marks=pytest.mark.slow)  # to import it takes a second


@pytest.mark.parametrize("save", [npy, npz, hdf5, SLOW_ZARR])
@pytest.mark.parametrize(
    "values",
    [
        OBLONG[:1],
        OBLONG[:, None],
        OBLONG[..., None],
        OBLONG.astype(">f8"),
        OBLONG.astype(">u2"),
        np.greater(OBLONG, 100),
        OBLONG.astype("f2"),
        np.asfortranarray(OBLONG),
        np.where(np.greater(OBLONG, 100), np.nan, OBLONG),
    ],
    ids=["one", "4-D", "4-D last", "big", "big u2", "bool", "f2", "fortran", "nan"],
)
def test_any_type_and_order_of_numbers_gives_their_values(
    tmp_path: Path, save: Save, values: np.ndarray
) -> None:
    frames, _ = frames_of(save(tmp_path, values))
    right = values.reshape(-1, *OBLONG.shape[1:]).astype(float)
    np.testing.assert_array_equal([f.image.values for f in frames], np.nan_to_num(right))
    for frame, matrix in zip(frames, right, strict=True):
        valid = np.ones_like(matrix, bool) if frame.image.valid is None else frame.image.valid
        np.testing.assert_array_equal(valid, np.isfinite(matrix))


@pytest.mark.parametrize(
    ("save", "values", "told"),
    [
        (npy, FIELDS, r"its array has fields \(t, cells\); .* array\['cells'\]"),
        (npy, np.array(3.0), "its array is one number, no matrix"),
        (npz, FIELDS, r"\(12,\) of fields \(t, cells\); save the field of 'mein Würfel 1' with"),
        (npz, OBLONG.astype(str), r"of text; save 'mein Würfel 1' as numbers"),
        (npz, DATES, r"mein Würfel 1 \(12, 6, 10\) of dates"),
        (hdf5, np.stack([OBLONG, OBLONG], 1), "save each sensor of 'mein Würfel 1' as a new dat"),
        (hdf5, np.stack([OBLONG, OBLONG], -1), r"'mein Würfel 1' .* array\[..., channel\]"),
        (hdf5, OBLONG[:, :1], r"\(12, 1, 10\); 'mein Würfel 1' is read where sensor names it"),
        pytest.param(
            zarr, OBLONG[:0], r"arrays: mein Würfel 1 \(0, 6, 10\)", marks=pytest.mark.slow
        ),
        pytest.param(zarr, DATES, r"1 \(\(12, 6, 10\), dates\)", marks=pytest.mark.slow),
    ],
)
def test_what_is_no_stack_of_numbers_says_what_it_is(
    tmp_path: Path, save: Save, values: np.ndarray, told: str
) -> None:
    with pytest.raises(DataError, match=told):
        frames_of(save(tmp_path, values))


def test_a_line_of_cells_is_read_where_its_name_is_told(tmp_path: Path) -> None:
    frames, _ = frames_of(hdf5(tmp_path, OBLONG[:, :1]), sensor="mein Würfel 1")
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG[:, :1])


def test_an_array_with_fields_in_a_file_like_ours_names_them(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"array 'values' has fields \(t, cells\)"):
        frames_of(write(tmp_path, npz_bytes(values=FIELDS)))


@pytest.mark.slow
def test_sensors_in_a_matlab_variable_of_four_axes_are_told_to_be_saved_alone(
    tmp_path: Path,
) -> None:
    two = np.stack([OBLONG, OBLONG], axis=1)
    with pytest.raises(DataError, match="save each sensor of 'p' as a new variable"):
        frames_of(write(tmp_path, matlab(p=two)))


OWN = {"quantity": "kilopascal", "pitch_cm": np.array([0.5, 0.7]), "origin_cm": np.array([1, 2.0])}
TIMED = {**OWN, "time_s": np.arange(12) * 0.1}


def npz_with(folder: Path) -> Path:
    return write(folder, npz_bytes(frames=OBLONG, device_time_s=np.arange(12.0) + 9, **TIMED))


def matlab_with(folder: Path) -> Path:
    return write(folder, matlab(frames=OBLONG, **TIMED))


def json_with(folder: Path) -> Path:
    told = {"frames": OBLONG, **TIMED}
    plain = {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in told.items()}
    return write(folder, json.dumps(plain))


def hdf5_with(folder: Path) -> Path:
    path = hdf5(folder, OBLONG)
    with pytest.importorskip("h5py").File(path, "a") as file:
        for name, value in TIMED.items():
            file[name] = value
    return path


def hdf5_attributes(folder: Path) -> Path:
    path = hdf5(folder, OBLONG)
    with pytest.importorskip("h5py").File(path, "a") as file:
        file.attrs.update(OWN)
        file["time_s"] = TIMED["time_s"]
    return path


def hdf5_of_matlab(folder: Path) -> Path:
    path = hdf5_with(folder)
    with pytest.importorskip("h5py").File(path, "a") as file:
        del file["quantity"]
        file["quantity"] = np.array([[ord(c)] for c in OWN["quantity"]], np.uint16)
        file["quantity"].attrs["MATLAB_class"] = np.bytes_(b"char")
    return path


def zarr_with(folder: Path) -> Path:
    library: Any = pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
    path = zarr(folder, OBLONG)
    group = library.open_group(str(path), mode="a")
    group.create_array("time_s", data=TIMED["time_s"])
    plain = {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in OWN.items()}
    group.attrs.update({**plain, "ragged": [[1, 2], [3]]})
    return path


@pytest.mark.parametrize(
    "made",
    [
        npz_with,
        pytest.param(matlab_with, marks=pytest.mark.slow),  # scipy is slow to import
        json_with,
        hdf5_with,
        hdf5_attributes,
        hdf5_of_matlab,
        pytest.param(zarr_with, marks=pytest.mark.slow),
    ],
)
def test_our_own_words_are_taken_whatever_the_stack_is_called(
    tmp_path: Path, made: Callable[[Path], Path]
) -> None:
    frames, _ = frames_of(made(tmp_path))
    image = frames[0].image
    assert (image.quantity, image.pitch_cm, image.origin_cm) == ("kilopascal", (0.5, 0.7), (1, 2))
    assert [f.time_s for f in frames[:2]] == [0.0, 0.1]
    np.testing.assert_array_equal(image.values, OBLONG[0])


@pytest.mark.parametrize(
    ("told", "quantity", "factor"),
    [
        ({"quantity": "kPa"}, "kilopascal", 1.0),
        ({"quantity": b"volt", "unit": "mV"}, "volt", 1e-3),
        ({"unit": "mV", "quantity": "volt"}, "volt", 1e-3),
        ({"quantity": "siemens", "unit": "furlong"}, "siemens", 1.0),
        ({"quantity": "much"}, "raw", 1.0),
        ({"quantity": 7}, "raw", 1.0),
    ],
)
def test_a_quantity_is_one_we_know_or_that_of_a_unit(
    tmp_path: Path, told: dict[str, Any], quantity: str, factor: float
) -> None:
    frames, _ = frames_of(write(tmp_path, npz_bytes(frames=OBLONG, **told)))
    assert frames[0].image.quantity == quantity
    np.testing.assert_allclose(frames[0].image.values, OBLONG[0] * factor)


@pytest.mark.parametrize(
    ("unit", "factor"), [("milliseconds since 2024-01-01", 1e-3), ("s", 1.0), ("odd", 1.0)]
)
def test_the_unit_of_times_is_that_of_their_attribute(
    tmp_path: Path, unit: str, factor: float
) -> None:
    """As xarray and netCDF say it; without it a rate of 0.2 per second would look like seconds."""
    h5py = pytest.importorskip("h5py", reason="the 'hdf5' extra is not installed")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["p"] = OBLONG
        file["time"] = np.arange(12) * 0.2
        file["time"].attrs["units"] = unit
        file["p"].attrs["nothing"] = h5py.Empty("f4")
    frames, _ = frames_of(tmp_path / "a.h5")
    assert frames[5].time_s == pytest.approx(1.0 * factor)
