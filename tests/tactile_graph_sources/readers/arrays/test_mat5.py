"""MATLAB's files against SciPy's reader, and damaged ones that SciPy's does not survive."""

from __future__ import annotations

import io
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.io import loadmat
from scipy.sparse import csc_matrix

from helpers_dialects import OBLONG, cell_array, matlab
from helpers_recordings import frames_of, write
from tactile_graph.errors import DataError
from tactile_graph_sources.readers.arrays import mat5
from tactile_graph_sources.readers.arrays.mat5 import DamagedError, Unread, variables

DTYPES = ("f8", "f4", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "?")


def read(content: bytes, folder: Path) -> dict[str, Any]:
    return variables(write(folder, content))


def oracle(content: bytes) -> dict[str, Any]:
    loaded = loadmat(io.BytesIO(content), simplify_cells=True)
    return {k: v for k, v in loaded.items() if not k.startswith("__")}


@pytest.mark.slow
@given(
    array=st.sampled_from(DTYPES).flatmap(
        lambda d: hnp.arrays(d, hnp.array_shapes(min_dims=2, max_dims=4, max_side=5))
    ),
    packed=st.booleans(),
)
def test_arrays_of_any_type_and_shape_are_those_scipy_reads(
    array: np.ndarray, packed: bool, tmp_path_factory: pytest.TempPathFactory
) -> None:
    content = matlab(packed, a=array)
    found = read(content, tmp_path_factory.mktemp("mat"))["a"]
    np.testing.assert_array_equal(found, oracle(content)["a"])
    np.testing.assert_array_equal(found, np.squeeze(array))


@pytest.mark.parametrize("packed", [False, True])
def test_structs_cells_and_texts_are_those_scipy_reads(packed: bool, tmp_path: Path) -> None:
    inner = {"gain": 2.5, "name": "größe", "list": cell_array([np.eye(2), "x", np.arange(3.0)])}
    content = matlab(packed, s={"inner": inner, "n": np.int16(4)}, word="kPa", z=np.array([1 + 2j]))
    found, truth = read(content, tmp_path), oracle(content)
    assert found["word"] == truth["word"] == "kPa"
    assert found["s"]["inner"]["name"] == truth["s"]["inner"]["name"] == "größe"
    assert found["s"]["inner"]["gain"] == 2.5
    assert found["s"]["n"] == 4
    for mine, its in zip(found["s"]["inner"]["list"], truth["s"]["inner"]["list"], strict=True):
        np.testing.assert_array_equal(mine, its)
    assert found["z"] == Unread("complex", (1, 1))


@pytest.mark.parametrize(
    ("value", "told"),
    [
        (np.ones((5, 7)) * 1j, r"'x' of shape \(5, 7\) is complex, .* x = abs\(x\); save\('out"),
        (csc_matrix(np.eye(5)), r"'x' of shape \(5, 5\) is sparse, .* x = full\(x\); save\('out"),
    ],
)
@pytest.mark.parametrize("packed", [False, True])
def test_matrices_of_a_kind_that_is_not_read_are_named(
    value: Any, told: str, packed: bool, tmp_path: Path
) -> None:
    path = write(tmp_path, matlab(packed, x=value, t=np.arange(5.0)))
    with pytest.raises(DataError, match=told):
        frames_of(path)
    path = write(tmp_path, matlab(packed, x=value, real=np.ones((4, 6, 6))))
    assert len(frames_of(path)[0]) == 4
    with pytest.raises(DataError, match=told):
        frames_of(path, sensor="x")


def test_an_object_is_named_and_hides_nothing_else(tmp_path: Path) -> None:
    """MATLAB's strings, tables and dates have a name and no size."""
    body = b"".join(
        struct.pack("<II", kind, len(data)) + data.ljust(-(-len(data) // 8) * 8, b"\0")
        for kind, data in (
            (6, struct.pack("<II", 17, 0)),
            (1, b"when"),
            (1, b"MCOS"),
            (1, b"datetime"),
        )
    )
    element = struct.pack("<II", 14, len(body)) + body
    alone, beside = matlab()[:128] + element, matlab(real=np.ones((4, 6, 6))) + element
    with pytest.raises(DataError, match="its variable 'when' is an object, no matrix of real numb"):
        frames_of(write(tmp_path, alone))
    assert len(frames_of(write(tmp_path, beside))[0]) == 4


def test_the_other_byte_order_is_read(tmp_path: Path) -> None:
    def element(kind: int, data: bytes) -> bytes:
        return np.array([kind, len(data)], ">u4").tobytes() + data + b"\0" * (-len(data) % 8)

    values = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
    parts = element(6, np.array([6, 0], ">u4").tobytes())
    parts += element(5, np.array(values.shape, ">i4").tobytes())
    parts += element(1, b"a") + element(9, values.ravel(order="F").astype(">f8").tobytes())
    head = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x01\x00MI"
    np.testing.assert_array_equal(read(head + element(14, parts), tmp_path)["a"], values)


def test_what_unpacks_to_too_much_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mat5, "LARGE", 1_000_000)
    monkeypatch.setattr(mat5, "MOST_TIMES", 2)
    with pytest.raises(DamagedError, match="it unpacks to more than 1 MB"):
        read(matlab(True, a=np.zeros(200_000)), tmp_path)
    assert len(read(matlab(True, a=np.zeros(100_000)), tmp_path)["a"]) == 100_000


def test_very_many_small_matrices_are_refused_before_they_are_looked_at(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mat5, "MOST_MATRICES", 40)
    cells = cell_array([np.eye(2)] * 50)
    with pytest.raises(DamagedError, match="more than 40 matrices; save them as one"):
        read(matlab(False, c=cells), tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("packed", [False, True])
def test_any_byte_may_be_wrong_without_anything_but_damage_to_tell(
    packed: bool, tmp_path: Path
) -> None:
    rng = np.random.default_rng(3)
    whole = matlab(packed, s={"p": np.arange(24.0).reshape(2, 3, 4), "unit": "kPa"},
                   c=cell_array([np.eye(2), np.eye(3)]))  # fmt: skip
    refused = 0
    for at in range(128, len(whole)):
        data = bytearray(whole)
        data[at] = int(rng.integers(256))
        try:
            read(bytes(data), tmp_path)
        except DamagedError:
            refused += 1
    for end in range(128, len(whole), 7):
        with pytest.raises(DamagedError, match=r"cut off|incomplete|damaged|missing|no size|bytes"):
            read(whole[:end] + b"\0", tmp_path)
    assert refused > 30


def test_structs_too_deep_or_too_many_end_at_once(tmp_path: Path) -> None:
    value: Any = np.eye(2)
    for _ in range(40):
        value = cell_array([value])
    with pytest.raises(DamagedError, match="too deep"):
        read(matlab(a=value), tmp_path)
    claimed = bytearray(matlab(a=cell_array([np.eye(2)])))
    at = claimed.find(np.array([1, 1], "<i4").tobytes(), 128)
    claimed[at : at + 8] = np.array([1 << 15, 1 << 15], "<i4").tobytes()
    with pytest.raises(DamagedError, match="cells are missing"):
        read(bytes(claimed), tmp_path)


def test_a_packed_part_that_is_damaged_says_so(tmp_path: Path) -> None:
    data = zlib.compress(b"\0" * 100)
    head = matlab(a=1.0)[:128]
    packed = head + np.array([15, len(data)], "<u4").tobytes() + data[:-6] + b"\1\2\3\4\5\6"
    with pytest.raises(DamagedError):
        read(packed, tmp_path)


def test_the_order_of_cells_in_a_row_is_told_where_it_may_be_matlabs(tmp_path: Path) -> None:
    """What ``reshape(frames, [], n).'`` gives comes column by column."""
    order = "order=columns where they come column by column, as MATLAB's reshape puts them"
    path = write(tmp_path, matlab(p=OBLONG.transpose(0, 2, 1).reshape(len(OBLONG), -1)))
    with pytest.raises(DataError, match=rf"give rows and columns \(and {order}\)"):
        frames_of(path)
    _, report = frames_of(path, rows=6, columns=10)
    assert report.counts[f"recordings with cells assumed to come row by row ({order})"] == 1
    frames, report = frames_of(path, rows=6, columns=10, order="columns")
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
    assert not any("row by row" in what for what in report.counts)
