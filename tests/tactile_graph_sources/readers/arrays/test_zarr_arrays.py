"""Zarr arrays of other programs, and groups of them, are read as HDF5 files are."""

from __future__ import annotations

import json
import pickle
import sys
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest

from helpers_dialects import OBLONG
from helpers_recordings import frames_of
from tactile_graph.errors import DataError, UsageError
from tactile_graph_sources.readers.arrays import zarr_arrays

zarr: Any = pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
Version = Literal[2, 3]


def group(path: Path, version: Version = 3, **arrays: np.ndarray) -> Path:
    made = zarr.open_group(str(path), mode="w", zarr_format=version)
    for name, values in arrays.items():
        made.create_array(name.replace("__", "/"), data=values)
    return path


@pytest.mark.slow
@pytest.mark.parametrize("version", [2, 3])
def test_an_array_and_the_only_stack_of_a_group_are_read(tmp_path: Path, version: Version) -> None:
    bare = tmp_path / "bare.zarr"
    zarr.create_array(str(bare), data=OBLONG, chunks=(5, 4, 10), zarr_format=version)
    path = group(tmp_path / "g.zarr", version, run__p=OBLONG, run__time_ms=20.0 * np.arange(12))
    for one in (bare, path, path / "run" / "p"):
        frames, report = frames_of(one)
        np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
        assert report.counts["recordings read as Zarr of another program"] == 1
    assert frames_of(path)[0][3].time_s == pytest.approx(0.06)


def test_dates_are_times_and_attributes_say_the_unit(tmp_path: Path) -> None:
    time = np.datetime64("2024-01-01", "ns") + np.arange(12) * np.timedelta64(20, "ms")
    path = group(tmp_path / "a.zarr", 2, p=OBLONG, time=time)
    zarr.open_group(str(path))["p"].attrs["unit"] = "kPa"
    frames, _ = frames_of(path)
    assert frames[3].time_s == pytest.approx(0.06)
    assert frames[0].image.quantity == "kilopascal"


def test_several_arrays_are_asked_about_and_others_named(tmp_path: Path) -> None:
    path = group(tmp_path / "a.zarr", left=OBLONG, right=OBLONG + 1)
    with pytest.raises(DataError, match=r"several arrays could be it \(left \(12, 6, 10\)"):
        frames_of(path)
    np.testing.assert_array_equal(
        [f.image.values for f in frames_of(path, sensor="right")[0]], OBLONG + 1
    )
    path = group(tmp_path / "b.zarr", z=OBLONG + 1j, line=np.arange(5.0))
    with pytest.raises(
        DataError, match=r"its arrays: line \(5,\), z \(\(12, 6, 10\), complex\); of"
    ):
        frames_of(path)
    with pytest.raises(DataError, match="no matrix or stack of matrices in it; its arrays: none"):
        frames_of(group(tmp_path / "c.zarr"))


def test_frames_that_are_numbered_are_one_recording(tmp_path: Path) -> None:
    path = group(tmp_path / "a.zarr", **{f"frame_{k}": f for k, f in enumerate(OBLONG)})
    np.testing.assert_array_equal([f.image.values for f in frames_of(path)[0]], OBLONG)


def test_frames_along_the_last_axis_are_turned_where_that_is_told(tmp_path: Path) -> None:
    path = group(tmp_path / "a.zarr", p=np.moveaxis(OBLONG, 0, -1))
    frames, _ = frames_of(path, rows=6, columns=10)
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)


@pytest.mark.slow
def test_a_stack_is_read_piece_by_piece(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    most = 0
    sliced = zarr.Array.__getitem__

    def counted(self: Any, key: Any) -> Any:
        nonlocal most
        found = sliced(self, key)
        most = max(most, np.size(found))
        return found

    values = np.random.default_rng(0).integers(0, 99, (3000, 6, 10))
    path = tmp_path / "a.zarr"
    zarr.create_array(str(path), data=values, chunks=(100, 6, 10))
    monkeypatch.setattr(zarr.Array, "__getitem__", counted)
    monkeypatch.setattr("tactile_graph_sources.readers.reading.MOST_FRAMES", 250)
    frames, _ = frames_of(path)
    np.testing.assert_array_equal([f.image.values for f in frames], values)
    assert 0 < most <= 400 * 60


def test_a_codec_that_could_run_a_program_is_not_used(tmp_path: Path) -> None:
    class Evil:
        def __reduce__(self) -> tuple[Any, ...]:
            return (Path.touch, (tmp_path / "it-ran",))

    path = tmp_path / "a.zarr"
    zarr.create_array(str(path), data=OBLONG, zarr_format=2, compressors=None, chunks=(12, 6, 10))
    told = json.loads((path / ".zarray").read_text())
    (path / ".zarray").write_text(json.dumps({**told, "compressor": {"id": "pickle"}}))
    (path / "0.0.0").write_bytes(pickle.dumps(Evil()))
    with pytest.raises(DataError, match="pickle"):  # Zarr's newer versions refuse it themselves
        frames_of(path)
    assert not (tmp_path / "it-ran").exists()


@pytest.mark.parametrize("version", [2, 3])
def test_a_codec_that_is_none_of_the_known_ones_is_named(
    tmp_path: Path, version: Version, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = group(tmp_path / "a.zarr", version, p=OBLONG)
    monkeypatch.setattr(zarr_arrays, "_CODECS", {"bytes"})
    packed = {2: "blosc", 3: "zstd"}[version]
    told = rf"p \(\(12, 6, 10\), packed by {packed}\); of 'p': save it packed by zstd"
    with pytest.raises(DataError, match=told):
        frames_of(path)


def test_arrays_far_larger_than_what_is_written_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.zarr"
    zarr.create_array(str(path), shape=(10**6, 16, 16), chunks=(10**6, 16, 16), dtype="f8")
    with pytest.raises(
        DataError, match=r"array 'a' would unpack to 2,048 MB, of which 0\.0 are wri"
    ):
        frames_of(path)
    path = tmp_path / "b.zarr"
    zarr.create_array(str(path), shape=(1000, 16, 16), chunks=(1, 1, 1), dtype="f8")
    with pytest.raises(DataError, match=r"would be of 256,000 pieces"):
        frames_of(path)
    monkeypatch.setattr(zarr_arrays, "MOST_ITEMS", 3)
    many = group(tmp_path / "c.zarr", **{f"a{k}": OBLONG for k in range(4)})
    with pytest.raises(DataError, match="it holds more than 3 groups and arrays"):
        frames_of(many)


def test_a_damaged_store_says_so(tmp_path: Path) -> None:
    path = group(tmp_path / "a.zarr", p=OBLONG)
    chunk = next(p for p in (path / "p" / "c").rglob("*") if p.is_file())
    chunk.write_bytes(chunk.read_bytes()[:20])
    with pytest.raises(DataError, match="the Zarr store cannot be read"):
        frames_of(path)


def test_without_the_library_it_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = group(tmp_path / "a.zarr", 2, p=OBLONG)
    monkeypatch.setitem(sys.modules, "zarr", None)
    with pytest.raises(
        UsageError, match=r"need the 'zarr' extra: pip install \"tactile-graph\[zarr"
    ):
        frames_of(path)


def test_times_in_bytes_are_read_as_texts(tmp_path: Path) -> None:
    stamps = np.array([f"12:00:{k:02d}" for k in range(12)], "S8")
    frames, _ = frames_of(group(tmp_path / "a.zarr", 2, p=OBLONG, time=stamps))
    assert [f.time_s for f in frames] == [1.0 * k for k in range(12)]


@pytest.mark.parametrize("version", [2, 3])
def test_chunks_that_are_not_there_are_told(tmp_path: Path, version: Version) -> None:
    """They may be lost, or hold what Zarr leaves out: nothing tells which."""
    path = tmp_path / "p.zarr"
    array = zarr.create_array(
        str(path), data=OBLONG + 1.0, chunks=(2, 6, 10), zarr_format=version, fill_value=0.0
    )
    (path / array.metadata.encode_chunk_key((3, 0, 0))).unlink()
    frames, report = frames_of(path)
    np.testing.assert_array_equal(frames[5].image.values, OBLONG[5] + 1.0)
    assert not np.any(frames[6].image.values)
    told = [text for text in report.counts if "not there" in text]
    assert told == [
        "recordings with 1 of 6 chunks of array 'p' not there, from [6, 0, 0] on: read as its fill "
        "value, 0.0, be they lost, or left out for holding nothing else"
    ]
    assert told[0] not in report.assumed


def test_of_a_whole_array_no_chunk_is_told_of(tmp_path: Path) -> None:
    for name, options in (("a", {"chunks": (5, 4, 3)}),
                          ("b", {"chunks": (2, 3, 5), "shards": (4, 6, 10)})):  # fmt: skip
        zarr.create_array(str(tmp_path / name), data=OBLONG + 1.0, **options)
        assert not any("not there" in text for text in frames_of(tmp_path / name)[1].counts)
    path = group(tmp_path / "g.zarr", run__p=OBLONG + 1.0)
    assert not any("not there" in text for text in frames_of(path)[1].counts)
