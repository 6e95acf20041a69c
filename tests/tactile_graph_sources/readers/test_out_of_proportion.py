"""Files that would take far more time or memory than they are large are refused before the work."""

from __future__ import annotations

import io
import json
import os
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_dialects import npz, picture, zipped
from helpers_recordings import frames_of, write
from tactile_graph.errors import DataError, TactileGraphError, UsageError
from tactile_graph_pads.pad import load_pad
from tactile_graph_sources.devices.preset_file import load_preset, read_preset
from tactile_graph_sources.readers import head
from tactile_graph_sources.readers.arrays import archive, hdf5, zarr_arrays
from tactile_graph_sources.readers.arrays import npz as npz_reader
from tactile_graph_sources.readers.arrays.archive import opened
from tactile_graph_sources.readers.logs import mcap_chunks
from tactile_graph_sources.readers.text import json_stack
from tactile_graph_sources.scene import load_scene
from tactile_graph_sources.stores.journal import read_journal


def refused(folder: Path, content: str | bytes) -> str:
    with pytest.raises(DataError) as told:
        frames_of(write(folder, content))
    return told.value.what


def test_an_array_whose_axes_are_none_of_a_stack_is_not_unpacked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    loaded: list[str] = []
    monkeypatch.setattr(npz_reader.Archive, "load", lambda self, name: loaded.append(name))
    assert "has shape (5000,)" in refused(tmp_path, npz(values=np.zeros(5000)))
    assert loaded == []


@pytest.mark.parametrize(
    "names", [("frame0", "frame1", "frame2"), ("values", "valid"), ("cap", "ftir")]
)
def test_arrays_that_only_together_unpack_to_far_too_much_are_refused_before_any_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: tuple[str, ...]
) -> None:
    """Each stays below the bound."""
    loaded: list[str] = []
    monkeypatch.setattr(npz_reader.Archive, "load", lambda self, name: loaded.append(name))
    monkeypatch.setattr(npz_reader, "LARGE", 1_000_000)
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **{n: np.zeros((300, 300)) for n in names})
    told = f"arrays {names[0]!r} to {names[-1]!r} unpack to {len(names) * 0.72:.0f} MB, "
    assert told in refused(tmp_path, buffer.getvalue())
    assert loaded == []


def test_datasets_that_only_together_unpack_to_far_too_much_are_refused(tmp_path: Path) -> None:
    """Each is as large as one alone may be."""
    h5py = pytest.importorskip("h5py", reason="the 'hdf5' extra is not installed")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        for i in range(4):
            file.create_dataset(f"frame{i}", (4_000, 2_000), "f8", chunks=(4, 4))
    told = "datasets 'frame0', 'frame1', 'frame2' and 1 more unpack to 256 MB, of which 0.0 are wri"
    with pytest.raises(DataError, match=told):
        frames_of(tmp_path / "a.h5")


@pytest.mark.slow
@pytest.mark.parametrize(("n", "kind"), [(5, "S100000000"), (10_000_000, "S4")])
def test_times_that_are_texts_are_not_unpacked_out_of_proportion(
    tmp_path: Path, n: int, kind: str
) -> None:
    """A text takes some bytes, however short it is."""
    h5py = pytest.importorskip("h5py", reason="the 'hdf5' extra is not installed")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["values"] = np.ones((5, 4, 4))
        file.create_dataset("time", (n,), kind, chunks=(1 if n == 5 else 1000,))
    with pytest.raises(DataError, match=r"dataset 'time' unpacks to (500|1,200) MB, of which 0.0 "):
        frames_of(tmp_path / "a.h5")
    zarr = pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
    root = zarr.open_group(tmp_path / "a.zarr", mode="w", zarr_format=2)
    root.create_array("values", shape=(5, 4, 4), dtype="f8")[:] = 1.0
    root.create_array("time", shape=(n,), chunks=(1 if n == 5 else 1000,), dtype=kind)
    with pytest.raises(DataError, match=r"array 'time' would unpack to (500|1,200) MB, of which "):
        frames_of(tmp_path / "a.zarr")


def test_texts_that_are_all_one_long_text_are_not_read_to_their_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    h5py = pytest.importorskip("h5py", reason="the 'hdf5' extra is not installed")
    monkeypatch.setattr(hdf5, "LARGE", 4_000_000)
    path, n, long = tmp_path / "a.h5", 3000, 100_000
    with h5py.File(path, "w") as file:
        file["values"] = np.ones((5, 4, 4))
        file["time"] = np.array(["x" * long, *["y"] * (n - 1)], h5py.string_dtype())
        offset = file["time"].id.get_offset()
    content = bytearray(path.read_bytes())
    content[offset : offset + 16 * n] = content[offset : offset + 16] * n
    path.write_bytes(content)
    with pytest.raises(
        DataError, match=r"texts of 'time' unpack to more than \d+ MB, of which 0\.\d"
    ):
        frames_of(path)


@pytest.mark.slow
def test_many_texts_of_any_length_are_times(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py", reason="the 'hdf5' extra is not installed")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["values"] = np.ones((3000, 4, 4))
        file["time"] = np.array([str(i / 100) for i in range(3000)], h5py.string_dtype())
    found, _ = frames_of(tmp_path / "a.h5")
    assert [f.time_s for f in found[:3]] == [0.0, 0.01, 0.02]
    assert found[-1].time_s == pytest.approx(29.99)


def test_texts_of_even_steps_that_pack_to_next_to_nothing_are_times(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is written beside them counts as well."""
    h5py = pytest.importorskip("h5py", reason="the 'hdf5' extra is not installed")
    zarr = pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
    for reader in (hdf5, zarr_arrays):
        monkeypatch.setattr(reader, "LARGE", 10_000)
    n = 2000
    step = np.timedelta64(10, "ms")
    times = (np.datetime64("2024-01-01T12:00:00.000") + np.arange(n) * step).astype("S23")
    values = np.random.default_rng(0).integers(0, 255, (n, 4, 4)).astype("u1")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["values"] = values
        packed = {"compression": "gzip", "compression_opts": 9, "shuffle": True, "chunks": (n,)}
        times_of = file.create_dataset("time", data=times, **packed)
        assert 120 * n > 200 * times_of.id.get_storage_size()
    root = zarr.open_group(tmp_path / "a.zarr", mode="w", zarr_format=2)
    root.create_array("values", data=values)
    root.create_array("time", data=times, chunks=(n,))
    assert 120 * n > 200 * root["time"].nbytes_stored()
    for name in ("a.h5", "a.zarr"):
        found, _ = frames_of(tmp_path / name)
        assert found[-1].time_s == pytest.approx(0.01 * (n - 1))


def test_an_archive_with_a_long_list_of_members_is_not_listed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    content = zipped({f"{i}.txt": b"" for i in range(40)})
    monkeypatch.setattr(archive, "MOST_DIRECTORY", 1000)
    assert "its list of members has 0.0 MB; allowed are 0.001" in refused(tmp_path, content)


def test_an_archive_is_opened_once_for_all_its_pictures(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    n = 0

    def counted(path: Path) -> Any:
        nonlocal n
        n += 1
        return opened(path)

    monkeypatch.setattr("tactile_graph_sources.readers.arrays.pictures.opened", counted)
    one = picture(np.eye(4, dtype=np.uint8), "png")
    frames, _ = frames_of(write(tmp_path, zipped({f"{i}.png": one for i in range(9)})))
    assert len(frames) == 9
    assert n == 2  # to know the format, and to read it


def test_a_picture_is_refused_by_the_size_it_says(tmp_path: Path) -> None:
    whole = bytearray(picture(np.zeros((4, 4), np.uint8), "png"))
    whole[16:24] = struct.pack(">II", 9000, 9000)
    whole[29:33] = struct.pack(">I", zlib.crc32(whole[12:29]))
    assert refused(tmp_path, bytes(whole)) == "the picture has 9000 x 9000 pixels"


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("[" + "[]," * 90 + "[]]", "its JSON has 92 lists and objects and 90 commas"),
        ("[[" + "1," * 300 + "1]]", "its JSON has 300 commas and 2 lists; allowed are 100 a list"),
        ('{"a": [1\n' * 11, "it begins as JSON does, and is none"),
        (
            json.dumps({f"k{i}": [i, i, i] for i in range(20)}),
            "its JSON has 20 keys; allowed are 9",
        ),
    ],
)
def test_json_of_more_lists_than_numbers_is_refused(
    text: str, what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, value in {"FEW_LISTS": 30, "LONGEST_LIST": 100, "MOST_KEYS": 9}.items():
        monkeypatch.setattr(json_stack, name, value)
    monkeypatch.setattr(json_stack, "MOST_DAMAGED", 5)
    assert what in refused(tmp_path, text)


def test_of_very_short_lines_no_more_are_looked_at_than_tell_what_the_table_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(head, "MOST_LINES", 500)
    assert "500 lines of 1 values could be one matrix" in refused(tmp_path, "1\n" * 2000)
    frames, _ = frames_of(write(tmp_path, "1,2\n3,4\n\n" * 600))
    assert [f.image.shape for f in frames] == [(2, 2)] * 600


def test_a_dataset_that_was_never_written_or_lies_elsewhere_is_refused(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py", reason="the 'hdf5' extra is not installed")
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        file.create_dataset("values", (10**6, 16, 16), "f8", chunks=(1, 16, 16))
    with pytest.raises(DataError, match=r"unpacks to 2,048 MB, of which 0\.0 are written"):
        frames_of(path)
    with h5py.File(path, "w") as file:
        file.create_dataset("values", (2, 4, 4), "f8", external=[("/etc/passwd", 0, 256)])
    with pytest.raises(DataError, match="lies in other files; save its values in this one"):
        frames_of(path)
    (tmp_path / "other").write_bytes(np.array(0.3).tobytes())
    with h5py.File(path, "w") as file:
        file["values"] = np.ones((2, 4, 4))
        file.create_dataset("pitch_cm", (1,), "f8", external=[(str(tmp_path / "other"), 0, 8)])
    assert frames_of(path)[0][0].image.pitch_cm == (1.0, 1.0)


def test_an_hdf5_file_of_very_many_or_deep_groups_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    h5py = pytest.importorskip("h5py", reason="the 'hdf5' extra is not installed")
    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        file.create_group("/".join("abcdefgh"))
    monkeypatch.setattr(hdf5, "DEEPEST", 5)
    with pytest.raises(DataError, match="it holds groups more than 5 deep"):
        frames_of(path)
    monkeypatch.setattr(hdf5, "MOST_ITEMS", 3)
    with pytest.raises(DataError, match="it holds more than 3 groups and datasets"):
        frames_of(path)


@pytest.mark.parametrize("packing", ["zstd", "lz4", ""])
def test_a_chunk_of_an_mcap_log_is_looked_at_before_it_is_unpacked(
    packing: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("mcap", reason="the 'mcap' extra is not installed")
    import lz4.frame
    import zstandard

    zeros = bytes(1 << 20)
    pack = {"zstd": zstandard.compress, "lz4": lz4.frame.compress, "": bytes}[packing]
    packed = pack(zeros)
    said = len(zeros) if not packing else 100
    head = struct.pack("<QQQII", 0, 0, said, 0, len(packing)) + packing.encode()
    body = head + struct.pack("<Q", len(packed)) + packed
    log = b"\x89MCAP0\r\n" + struct.pack("<BQ", 6, len(body)) + body
    monkeypatch.setattr(mcap_chunks, "LARGE", 1000)
    monkeypatch.setattr(mcap_chunks, "MOST_TIMES", 0)
    assert "its chunks unpack to more than" in refused(tmp_path, log)


def sealed(text: bytes) -> bytes:
    return b"%08x %s\n" % (zlib.crc32(text), text)


@pytest.mark.parametrize(
    "text",
    [
        b'{"rows":' + b"[" * 5000 + b"]" * 5000 + b"}",
        b'{"rows":"ab","values":0}',
        b'{"rows":[3,2],"values":0}',
        b'{"rows":[0,2],"values":"x"}',
        b'{"rows":[0,2],"values":0,"lost":1}',
    ],
)
def test_a_line_of_a_journal_that_nobody_could_have_written_is_damage(
    text: bytes, tmp_path: Path
) -> None:
    (tmp_path / "frames.journal").write_bytes(
        sealed(b'{"attributes":{},"arrays":{}}') + sealed(text)
    )
    journal = read_journal(tmp_path)
    assert journal.blocks == ()
    assert journal.damaged == (2,)


@pytest.mark.parametrize("load", [load_pad, read_preset])
def test_a_pad_or_preset_without_an_end_is_refused(load: Any, tmp_path: Path) -> None:
    endless = tmp_path / "a.yaml"
    endless.symlink_to("/dev/zero")
    with pytest.raises(UsageError, match="is longer than 4000000 bytes"):
        load(endless)


@pytest.mark.parametrize("text", ["[" * 500, "a: &a [*a]", "!!python/name:os.system x"])
def test_a_preset_is_read_as_strictly_as_a_pipeline(text: str, tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text(text)
    with pytest.raises(TactileGraphError):
        load_preset(str(tmp_path / "a.yaml"))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
@pytest.mark.parametrize("load", [load_pad, load_scene])
def test_a_pad_and_a_scene_are_not_waited_for(tmp_path: Path, load: Any) -> None:
    os.mkfifo(tmp_path / "a.yaml")
    with pytest.raises(UsageError, match=r"a\.yaml' is a pipe; save what it gives as a file first"):
        load(str(tmp_path / "a.yaml"))
