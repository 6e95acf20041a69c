"""What is written is read back whole, and a file is never there in half."""

from __future__ import annotations

import tracemalloc
import zlib
from collections.abc import Iterator
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest

from helpers_recordings import frames_of
from tactile_graph.errors import UsageError
from tactile_graph.wires import Circle, Ellipse, Frame, Image, Polygon, Rectangle, TrueObject
from tactile_graph_sources.writers.write_npz import LEVEL, write_npz

SHAPES = (
    Circle(1.0, 2.0, 3.0),
    Ellipse(1.0, 2.0, 3.0, 1.5, 0.25),
    Rectangle(1.0, 2.0, 3.0, 1.5, -0.25),
    Polygon(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.5]])),
)


def film(n: int = 4) -> list[Frame]:
    rng = np.random.default_rng(1)
    frames = []
    for k in range(n):
        values, valid = rng.uniform(size=(5, 7)), rng.uniform(size=(5, 7)) > 0.1
        values[~valid] = 0.0
        image = Image(values, (1.3, 1.2), (-0.15, 0.4), "volt", valid if k else None)
        truth = None if k == 2 else tuple(TrueObject(s, 10.0 * k, "disc") for s in SHAPES[: k + 1])
        frames.append(
            Frame(
                image,
                k,
                None if k == 1 else 0.5 * k,
                truth,
                7.0 + k,
                k == 3,
                "left" if k else "",
                k == 2,
                own_number=None if k == 2 else 2**53 + k,
            )
        )
    return frames


def same(one: TrueObject, other: TrueObject) -> bool:
    if isinstance(one.shape, Polygon) and isinstance(other.shape, Polygon):
        shapes = bool((one.shape.xy_cm == other.shape.xy_cm).all())
    else:
        shapes = one.shape == other.shape
    return shapes and (one.weight_g, one.name) == (other.weight_g, other.name)


def test_frames_come_back_with_everything_they_had(tmp_path: Path) -> None:
    path = tmp_path / "film.npz"
    assert write_npz(path, iter(film())) == 4
    frames, report = frames_of(path)
    assert not report.troubles
    assert report.n_expected == 4
    for got, put in zip(frames, film(), strict=True):
        np.testing.assert_array_equal(got.image.values, put.image.values)
        np.testing.assert_array_equal(got.image.filled(-1.0), put.image.filled(-1.0))
        for name in ("pitch_cm", "origin_cm", "quantity"):
            assert getattr(got.image, name) == getattr(put.image, name)
        for name in ("index", "time_s", "device_time_s", "gap", "label", "doubtful", "own_number"):
            assert getattr(got, name) == getattr(put, name)
        assert (got.truth is None) == (put.truth is None)
        assert all(map(same, got.truth or (), put.truth or ()))
        assert len(got.truth or ()) == len(put.truth or ())


def test_a_writer_that_fails_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "film.npz"
    write_npz(path, film())
    before = path.read_bytes()

    def breaking() -> Iterator[Frame]:
        yield from film(2)
        raise RuntimeError("unplugged")

    with pytest.raises(RuntimeError, match="unplugged"):
        write_npz(path, breaking())
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("os.replace", lambda *_: (_ for _ in ()).throw(OSError("disk full")))
        with pytest.raises(UsageError, match=r"film\.npz: cannot be written: disk full"):
            write_npz(path, film(2))
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["film.npz"]


def test_the_same_frames_give_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        write_npz(tmp_path / name, film())
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_frames_of_two_grids_or_none_are_refused(tmp_path: Path) -> None:
    other = Frame.of(np.zeros((3, 3)))
    with pytest.raises(ValueError, match=r"frame 4 is <Image 3x3 raw.*a recording has one grid"):
        write_npz(tmp_path / "x.npz", [*film(), other])
    with pytest.raises(ValueError, match="there is no frame to write"):
        write_npz(tmp_path / "x.npz", [])
    assert not list(tmp_path.iterdir())


def test_numpy_is_handed_the_arrays_alone(tmp_path: Path) -> None:
    """Before 2.2 it takes whatever else it is handed for one more of them."""
    write_npz(tmp_path / "a.npz", film())
    with np.load(tmp_path / "a.npz") as packed:
        assert "allow_pickle" not in packed.files
        assert "values" in packed.files


def test_arrays_are_those_that_numpy_would_write(tmp_path: Path) -> None:
    mixed = [
        Frame(Image(np.full((2, 3), k, dtype), (1.0, 1.0), (0.0, 0.0), "raw"))
        for k, dtype in enumerate(("f4", "f8"))
    ]
    for frames in (
        film(),
        mixed,
        [Frame.of(v) for v in np.random.default_rng(0).normal(size=(200, 4, 4))],
    ):
        write_npz(tmp_path / "ours.npz", frames)
        with np.load(tmp_path / "ours.npz") as ours:
            np.savez_compressed(tmp_path / "theirs.npz", **ours)
            np.testing.assert_array_equal(ours["values"], [f.image.values for f in frames])
        with ZipFile(tmp_path / "ours.npz") as one, ZipFile(tmp_path / "theirs.npz") as other:
            assert one.namelist() == other.namelist()
            assert all(one.read(name) == other.read(name) for name in one.namelist())


def test_frames_are_packed_without_a_second_copy_of_them(tmp_path: Path) -> None:
    values = np.zeros((1000, 32, 32))
    values[:, 3:9, 5:8] = 0.5
    frames = [Frame.of(v) for v in values]
    tracemalloc.start()
    try:
        write_npz(tmp_path / "a.npz", frames)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 0.3 * values.nbytes


def test_packing_takes_the_middle_way_of_zlib(tmp_path: Path) -> None:
    values = np.round(np.random.default_rng(0).normal(size=(50, 16, 16)), 2)
    write_npz(tmp_path / "a.npz", [Frame.of(v) for v in values])
    with ZipFile(tmp_path / "a.npz") as packed:
        info, text = packed.getinfo("values.npy"), packed.read("values.npy")
    pack = zlib.compressobj(LEVEL, zlib.DEFLATED, -15)
    assert info.compress_size == len(pack.compress(text) + pack.flush())
