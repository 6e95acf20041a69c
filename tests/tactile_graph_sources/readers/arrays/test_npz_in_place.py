"""Large arrays of an archive, taken as they lie in it, are the same, and as well vouched for."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tactile_graph.errors import DataError
from tactile_graph_sources.readers.arrays import npz
from tactile_graph_sources.readers.arrays.archive import opened


def loaded(path: Path) -> Any:
    with opened(path) as file:
        return npz.Archive(str(path), file).load("values")


@pytest.fixture
def small_ones_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(npz, "WORTH_MAPPING", 0)


@pytest.mark.parametrize("kind", ["<f8", ">f4", "<i2", "?", "c16"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_arrays_are_those_that_were_saved(
    kind: str, order: Any, tmp_path: Path, small_ones_too: None
) -> None:
    values = np.random.default_rng(0).integers(0, 2, (3, 5, 7)).astype(kind).copy(order)
    np.savez(tmp_path / "a.npz", a=np.arange(3), values=values)
    found = loaded(tmp_path / "a.npz")
    assert found.dtype == values.dtype
    np.testing.assert_array_equal(found, values)
    assert not found.flags.writeable
    assert not found.flags.owndata


def test_a_changed_byte_is_refused(tmp_path: Path, small_ones_too: None) -> None:
    path = tmp_path / "a.npz"
    np.savez(path, values=np.zeros((4, 5, 6)))
    raw = bytearray(path.read_bytes())
    raw[raw.index(b"descr") + 600] ^= 1
    path.write_bytes(raw)
    with pytest.raises(DataError, match=r"'values' cannot be read: Bad CRC-32 for file"):
        loaded(path)


def test_what_is_not_as_long_as_it_says_is_refused(tmp_path: Path, small_ones_too: None) -> None:
    np.save(tmp_path / "a.npy", np.zeros((4, 5, 6)))
    whole = (tmp_path / "a.npy").read_bytes()
    for raw, why in ((whole[:-8], "expected 960 bytes"), (whole + b"12345678", "holds more")):
        with zipfile.ZipFile(tmp_path / "a.npz", "w") as file:
            file.writestr("values.npy", raw)
        with pytest.raises(DataError, match=why):
            loaded(tmp_path / "a.npz")


def test_objects_are_never_unpickled(tmp_path: Path, small_ones_too: None) -> None:
    np.savez(tmp_path / "a.npz", values=np.array([[1, "two"], [None, 3.0]], object))
    with pytest.raises(DataError, match="Object arrays cannot be loaded"):
        loaded(tmp_path / "a.npz")


def test_packed_arrays_are_read(tmp_path: Path, small_ones_too: None) -> None:
    values = np.random.default_rng(0).random((3, 4, 5))
    np.savez_compressed(tmp_path / "a.npz", values=values)
    np.testing.assert_array_equal(loaded(tmp_path / "a.npz"), values)
