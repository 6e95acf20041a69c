"""Values that HDF5 and Zarr hold packed, by scale, offset and numbers that stand for none."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_dialects import OBLONG
from helpers_recordings import frames_of
from tactile_graph.errors import DataError
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.arrays.packing import Packing, packing_of

h5py = pytest.importorskip("h5py", reason="the 'hdf5' extra is not installed")
PACKED = np.round((OBLONG - 5.0) / 0.1).astype(np.int16)
PACKED[:, 0, 0] = -32768
ABOUT: dict[str, Any] = {"scale_factor": 0.1, "add_offset": 5.0, "units": "kPa"}
TIMES = np.arange(12, dtype=np.int16)
TIMES[4] = -1


def hdf5(folder: Path, **about: Any) -> Path:
    with h5py.File(folder / "a.h5", "w") as file:
        file["p"], file["time"] = PACKED, TIMES
        file["p"].attrs.update(about)
        file["time"].attrs.update(scale_factor=0.5, missing_value=np.int16(-1), units="s")
    return folder / "a.h5"


def zarr_2(folder: Path, fill: int, **about: Any) -> Path:
    zarr: Any = pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
    group = zarr.open_group(str(folder / "a.zarr"), mode="w", zarr_format=2)
    p = group.create_array("p", shape=PACKED.shape, dtype="i2", chunks=(5, 6, 10), fill_value=fill)
    p[:] = PACKED
    p.attrs.update(_ARRAY_DIMENSIONS=["time", "y", "x"], **about)
    group.create_array("time", data=TIMES).attrs.update(
        scale_factor=0.5, missing_value=-1, units="s"
    )
    return folder / "a.zarr"


def check(frames: list[Frame]) -> None:
    values = np.array([f.image.values for f in frames])
    np.testing.assert_allclose(values[:, 1:], OBLONG[:, 1:])
    valid = [f.image.valid for f in frames]
    assert all(v is not None and not v[0, 0] and v.sum() == 59 for v in valid)
    assert frames[0].image.quantity == "kilopascal"
    assert [f.time_s for f in frames] == [0.5 * k if k != 4 else None for k in range(12)]


def test_packed_values_and_times_are_unpacked_and_told(tmp_path: Path) -> None:
    frames, report = frames_of(hdf5(tmp_path, _FillValue=np.int16(-32768), **ABOUT))
    check(frames)
    assert report.counts["recordings with values unpacked, as the file says: numbers x 0.1 + 5"]
    assert not [what for what in report.counts if "not applied" in what]


@pytest.mark.slow
@pytest.mark.parametrize(("fill", "more"), [(0, {"_FillValue": -32768}), (-32768, {})])
def test_values_packed_in_zarr_are_unpacked_piece_by_piece(
    fill: int, more: dict[str, int], tmp_path: Path
) -> None:
    check(frames_of(zarr_2(tmp_path, fill, **ABOUT, **more))[0])


@pytest.mark.parametrize("scale", ["two", 0.0, np.nan, [0.1, 0.2]])
def test_a_scale_that_is_none_is_refused(scale: object, tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"scale_factor of 'p' is .*; write a number, or take it"):
        frames_of(hdf5(tmp_path, scale_factor=scale))


def test_numbers_of_an_unsigned_type_are_read_as_such() -> None:
    said = {"_Unsigned": "true", "_FillValue": np.int8(-1)}
    packing = packing_of("a.nc", "p", np.dtype("i1"), said)
    values = packing.unpacked(np.array([1, -2, -1], np.int8))
    np.testing.assert_array_equal(values, [1.0, 254.0, np.nan])
    assert packing_of("a.nc", "p", np.dtype("f4"), {}) == Packing()
    assert packing_of("a.zarr", "p", np.dtype("i2"), {"scale_factor": None}) == Packing()
