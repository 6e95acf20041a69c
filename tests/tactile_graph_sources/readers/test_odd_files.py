"""Files that people really have, and that hold less than they seem to: each says what is wrong."""

from __future__ import annotations

import os
import zipfile
from pathlib import Path

import numpy as np
import pytest

from tactile_graph.errors import DataError
from tactile_graph.steps import Report
from tactile_graph_sources.readers.words.dialect import Dialect
from tactile_graph_sources.recording import recording


def refused(path: Path) -> str:
    with pytest.raises(DataError) as caught:
        list(recording(path=path, report=Report()))
    return caught.value.what


def test_a_quoted_number_with_a_comma_is_no_number_and_never_two(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text('"1,000","2,000","3,000","4,000"\n')
    assert "line 1, column 1: '1,000' is no number" in refused(path)
    path.write_text('"0.5","1.5"\n2.5,3.5\n')
    assert [f.image.values.tolist() for f in recording(path=path, report=Report())] == [
        [[0.5, 1.5], [2.5, 3.5]]
    ]
    assert Dialect().fields('"1,2') == ["1", "2"]  # one quote alone means nothing


@pytest.mark.parametrize("before", [b"\0", b"\0\0\xff\0", b"\0" * 900, b"boot\0\r\n"])
@pytest.mark.parametrize("place", [0, 2, 5])
def test_zeros_that_a_device_sends_at_a_reset_cost_a_line_at_most(
    before: bytes, place: int, tmp_path: Path
) -> None:
    y, x = np.mgrid[:8, :8]
    values = [
        np.round(800 * np.exp(-((y - 2) ** 2 + (x - 5 + 0.1 * k) ** 2) / 9)) for k in range(30)
    ]
    lines = [
        f"{20 * k},{','.join(f'{v:.0f}' for v in m.ravel())}\r\n".encode()
        for k, m in enumerate(values)
    ]
    lines[place] = before + lines[place]
    path = tmp_path / "serial.log"
    path.write_bytes(b"".join(lines))
    report = Report()
    frames = list(recording(path=path, report=report))
    lost = [] if before.endswith(b"\n") else [place]
    expected = np.delete(values, lost, axis=0)
    np.testing.assert_array_equal([f.image.values for f in frames], expected)
    assert [where for where, _ in report.troubles if lost] == [f"{path}:{k + 1}" for k in lost]


@pytest.mark.parametrize(
    "content",
    [
        np.arange(900, dtype="<u2").tobytes(),
        np.linspace(0, 50, 900).astype("<f4").tobytes(),
        bytes(np.random.default_rng(0).integers(0, 60, 4000, dtype=np.uint8)),
        b"1,2,3\n" * 20 + bytes(range(256)) * 4,
        b"log.csv".ljust(257, b"\0") + b"ustar" + bytes(250) + b"1,2,3,4\n" * 500,
    ],
    ids=["shorts", "floats", "bytes", "words and bytes", "tar"],
)
def test_binary_data_stay_binary_whatever_texts_are_in_them(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "a.bin"
    path.write_bytes(content)
    assert "binary data" in refused(path)


def test_arrays_that_cannot_be_read_say_why(tmp_path: Path) -> None:
    path = tmp_path / "a.npy"
    np.save(path, np.zeros((4, 4)))
    path.write_bytes(path.read_bytes()[:-8])
    assert refused(path) == (
        "its array cannot be read: the file is cut off: it holds less than its header says"
    )
    np.save(path, np.array([[1, None]], dtype=object))
    assert refused(path) == (
        "its array cannot be read: it holds Python objects, not numbers; save frames of one shape, "
        "in Python: numpy.save('out.npy', numpy.stack(frames))"
    )
    for shape, told in (
        ("(2, 8, 8)" + 12_000 * " ", "its header has 120"),
        ("(-1, 16, 16)", "it is damaged: its header says a shape that no array has"),
    ):
        head = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}}}\n".encode()
        size = len(head).to_bytes(2, "little")
        path.write_bytes(b"\x93NUMPY\x01\x00" + size + head + bytes(4096))
        assert refused(path).startswith(f"its array cannot be read: {told}")
        assert "pickle" not in refused(path)
    np.save(path, np.zeros((0, 4, 4)))
    assert refused(path) == "its array has shape (0, 4, 4): it holds no cell"


def test_a_pipe_is_told_to_be_saved_first(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    assert refused(tmp_path / "pipe") == "is no plain file; save what it gives as a file first"
    assert refused(tmp_path / "pipes") == "there is no such file; did you mean 'pipe'?"


@pytest.mark.slow  # much is packed
def test_an_archive_of_nearly_nothing_is_refused_before_it_is_unpacked(tmp_path: Path) -> None:
    path = tmp_path / "bomb.npz"
    shape = {"descr": "<f8", "fortran_order": False, "shape": (300, 400, 400)}
    with (
        zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open("frames.npy", "w", force_zip64=True) as member,
    ):
        np.lib.format.write_array_header_1_0(member, shape)
        for _ in range(300):
            member.write(bytes(8 * 400 * 400))
    with pytest.raises(DataError, match=r"unpacks to 384 MB, \d+ times what is packed"):
        next(recording(path=path, report=Report()))


def test_an_archive_of_thousands_of_arrays_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "many.npz"
    with zipfile.ZipFile(path, "w") as archive:
        for k in range(1001):
            archive.writestr(f"a{k}.npy", b"")
    with pytest.raises(DataError, match="holds 1001 members; allowed are 1000"):
        next(recording(path=path, report=Report()))


def test_a_pitch_that_no_pad_has_is_refused(tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", values=np.ones((2, 3, 3)), pitch_cm=np.array([1e300, 1e300]))
    with pytest.raises(DataError, match=r"a pitch of 1e\+300 x 1e\+300 cm; allowed are 1e-06 to"):
        next(recording(path=tmp_path / "a.npz", report=Report()))


@pytest.mark.parametrize("between", ["\n", "\n\n"])
def test_lines_that_are_all_alike_and_count_up_are_readings(tmp_path: Path, between: str) -> None:
    """Not one of them is left if they are taken for a header that comes again."""
    path = tmp_path / "a.csv"
    path.write_text(between.join(["1,2,3,4"] * 6) + "\n")
    frames = list(recording(path=path, report=Report(), rows=2, columns=2))
    assert len(frames) == 6
    assert {tuple(f.image.values.ravel()) for f in frames} == {(1.0, 2.0, 3.0, 4.0)}
