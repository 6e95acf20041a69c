"""HDF5 files: what lies beside the stack does no harm, and what is not read is named."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_dialects import OBLONG
from helpers_recordings import frames_of
from tactile_graph.errors import DataError

h5py = pytest.importorskip("h5py", reason="the 'hdf5' extra is not installed")
Fill = Callable[[Any], object]


def made(path: Path, *fills: Fill) -> Path:
    with h5py.File(path, "w") as file:
        for fill in fills:
            fill(file)
    return path


def with_stack(file: Any) -> None:
    file["p"] = OBLONG


def empty(file: Any) -> None:
    file["note"] = h5py.Empty("f4")


def ragged(file: Any) -> None:
    rows = file.create_dataset("rows", (12,), h5py.vlen_dtype(np.float32))
    for k in range(12):
        rows[k] = np.arange(k + 1)


def text(file: Any) -> None:
    file["words"] = OBLONG.astype(str).astype(object)


def complex_(file: Any) -> None:
    file["z"] = OBLONG + 1j


def matlab_complex(file: Any) -> None:
    file["z"] = np.zeros((12, 6, 10), [("real", "f8"), ("imag", "f8")])


def soft(file: Any) -> None:
    file["gone"] = h5py.SoftLink("/nowhere/p")


def external(file: Any) -> None:
    file["elsewhere"] = h5py.ExternalLink("other.h5", "/p")


def dates(file: Any) -> None:
    days = np.arange("2024-01-01", "2024-01-13", dtype="M8[D]").astype("M8[s]")
    file["days"] = days.astype(h5py.opaque_dtype(days.dtype))


def fields(file: Any) -> None:
    file["records"] = np.zeros(12, [("t", "f8"), ("cells", "f8", (6, 10))])


def chars(file: Any) -> None:
    file["names"] = np.full((3, 5), 65, np.uint16)
    file["names"].attrs["MATLAB_class"] = np.bytes_("char")


OTHERS = [
    (empty, r"note \(empty\)$"),
    (ragged, r"rows \(\(12,\), objects or rows of unlike lengths\); of 'rows': save frames of one"),
    (text, r"words \(\(12, 6, 10\), text\); of 'words': save it as numbers"),
    (complex_, r"z \(\(12, 6, 10\), complex\); of 'z': save it as real numbers"),
    (matlab_complex, r"z \(\(12, 6, 10\), complex\); of 'z': save it as real numbers"),
    (soft, r"gone \(a link to '/nowhere/p', where there is nothing to read\)$"),
    (external, r"elsewhere \(a link to '/p' in the file 'other.h5', .* give that file"),
    (dates, r"days \(\(12,\), dates\)$"),
    (chars, r"names \(\(3, 5\), text\)"),
]


@pytest.mark.parametrize(("fill", "told"), OTHERS, ids=lambda v: getattr(v, "__name__", ""))
def test_what_is_not_read_is_named_and_does_no_harm_beside_a_stack(
    tmp_path: Path, fill: Fill, told: str
) -> None:
    made(tmp_path / "other.h5", with_stack)
    frames, _ = frames_of(made(tmp_path / "a.h5", with_stack, fill))
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
    with pytest.raises(
        DataError, match=f"no matrix or stack of matrices in it; its datasets: {told}"
    ):
        frames_of(made(tmp_path / "b.h5", fill))


def test_a_dataset_with_fields_does_no_harm_beside_a_stack(tmp_path: Path) -> None:
    frames, _ = frames_of(made(tmp_path / "a.h5", with_stack, fields))
    assert len(frames) == 12
    with pytest.raises(DataError, match=r"dataset 'records' has fields \(t, cells\); save the one"):
        frames_of(made(tmp_path / "b.h5", fields))


def test_a_dataset_that_is_not_read_and_asked_for_says_why(tmp_path: Path) -> None:
    path = made(tmp_path / "a.h5", with_stack, complex_, empty)
    with pytest.raises(
        DataError, match=r"dataset 'z' is not read: \(12, 6, 10\), complex; save it"
    ):
        frames_of(path, sensor="z")
    with pytest.raises(DataError, match="dataset 'note' is not read: empty"):
        frames_of(path, sensor="note")


def test_dates_beside_the_stack_are_its_times(tmp_path: Path) -> None:
    def timed(file: Any) -> None:
        times = np.datetime64("2024-01-01T00:00:00", "ms") + np.arange(12) * 20
        file["time"] = times.astype(h5py.opaque_dtype(times.dtype))

    frames, _ = frames_of(made(tmp_path / "a.h5", with_stack, timed))
    assert frames[3].time_s == pytest.approx(0.06)


def test_a_link_within_the_file_is_no_second_stack(tmp_path: Path) -> None:
    def linked(file: Any) -> None:
        file["soft"] = h5py.SoftLink("/p")
        file["hard"] = file["p"]

    assert len(frames_of(made(tmp_path / "a.h5", with_stack, linked))[0]) == 12


def test_a_stack_of_one_frame_is_read_and_one_of_none_is_named(tmp_path: Path) -> None:
    frames, _ = frames_of(made(tmp_path / "a.h5", lambda f: f.update({"p": OBLONG[:1]})))
    np.testing.assert_array_equal(frames[0].image.values, OBLONG[0])
    with pytest.raises(DataError, match=r"no matrix .*its datasets: p \(0, 6, 10\)"):
        frames_of(made(tmp_path / "b.h5", lambda f: f.update({"p": OBLONG[:0]})))


def test_far_too_many_values_are_refused_with_a_way_out(tmp_path: Path) -> None:
    def huge(file: Any) -> None:
        file.create_dataset("p", (2**40, 2**15, 2**15), "f4", chunks=(1, 64, 64))

    with pytest.raises(
        DataError, match=r"holds 1,18\d,[\d,]+ values; allowed are 500,000,000: save"
    ):
        frames_of(made(tmp_path / "a.h5", huge))


@pytest.mark.parametrize("name", ["background", "z/pose"])
def test_a_stack_of_one_frame_beside_the_frames_is_none(tmp_path: Path, name: str) -> None:
    def beside(file: Any) -> None:
        file[name] = OBLONG[:1] if name == "background" else np.eye(4)[None]

    frames, _ = frames_of(made(tmp_path / "a.h5", with_stack, beside))
    assert len(frames) == len(OBLONG)


def test_a_name_that_looks_like_a_number_is_typed_in_quotes(tmp_path: Path) -> None:
    def two(file: Any) -> None:
        file["08"], file["09"] = OBLONG, OBLONG[:, :4]

    with pytest.raises(DataError, match="several datasets") as got:
        frames_of(made(tmp_path / "a.h5", two))
    assert "(as typed: --with 'sensor=\"08\"')" in str(got.value)


def matlab_73(path: Path, items: list[np.ndarray], **variables: Any) -> Path:
    """Write what MATLAB 7.3 does of a cell array ``frames`` and of other variables."""
    with h5py.File(path, "w", userblock_size=512) as file:
        held = {f"#refs#/{chr(97 + k)}": m.T for k, m in enumerate(items)}
        for name, values in {**held, **variables}.items():
            file[name] = values
        refs = np.array([[file[name].ref for name in held]], dtype=h5py.ref_dtype)
        file.create_dataset("frames", data=refs.T).attrs["MATLAB_class"] = np.bytes_("cell")
    with path.open("r+b") as raw:
        raw.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")
    return path


def test_the_matrices_of_a_cell_array_of_matlab_are_the_frames(tmp_path: Path) -> None:
    path = matlab_73(tmp_path / "a.mat", [*OBLONG], t=0.1 * np.arange(12)[None])
    for settings in ({}, {"sensor": "frames"}):
        frames, _ = frames_of(path, **settings)
        np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
        assert frames[3].time_s == pytest.approx(0.3)


def test_what_a_cell_array_of_matlab_holds_is_never_offered_alone(tmp_path: Path) -> None:
    path = matlab_73(tmp_path / "a.mat", [OBLONG[0], OBLONG[1, :4]])
    with pytest.raises(DataError, match=r"its datasets: frames \(.*frames = cat\(3, frames") as got:
        frames_of(path)
    assert "#refs#" not in str(got.value)
    path = matlab_73(tmp_path / "b.mat", [*OBLONG], p=OBLONG)
    with pytest.raises(DataError, match=r"several datasets could be it \(frames .*, p \(") as got:
        frames_of(path)
    assert "#refs#" not in str(got.value)


def test_texts_in_a_cell_array_of_matlab_are_times(tmp_path: Path) -> None:
    path = matlab_73(tmp_path / "a.mat", [*OBLONG])
    with h5py.File(path, "a") as file:
        for k in range(12):
            letters = np.array([[ord(c)] for c in f"12:00:{k:02d}.5"], np.uint16)
            file[f"#refs#/t{k}"] = letters
            file[f"#refs#/t{k}"].attrs["MATLAB_class"] = np.bytes_("char")
        refs = np.array([[file[f"#refs#/t{k}"].ref for k in range(12)]], dtype=h5py.ref_dtype)
        file["time"] = refs
    frames, _ = frames_of(path)
    assert [f.time_s for f in frames] == [1.0 * k for k in range(12)]


def test_cells_that_are_empty_are_no_matrix_and_a_text_in_one_is_a_unit(tmp_path: Path) -> None:
    path = matlab_73(tmp_path / "a.mat", [np.zeros((1, 2))] * 2, p=OBLONG, t=np.arange(12.0)[None])
    with h5py.File(path, "a") as file:
        for name in ("a", "b"):
            file[f"#refs#/{name}"].attrs["MATLAB_empty"] = np.uint8(1)
        letters = np.array([[ord(c)] for c in "kPa"], np.uint16)
        file["#refs#/c"] = letters
        file["#refs#/c"].attrs["MATLAB_class"] = np.bytes_("char")
        file["unit"] = np.array([[file["#refs#/c"].ref]], dtype=h5py.ref_dtype)
    frames, _ = frames_of(path)
    np.testing.assert_array_equal([f.image.values.T for f in frames], OBLONG)
    assert frames[0].image.quantity == "kilopascal"


def refer_to_each(file: Any) -> None:
    """Write matrices that are numbered, and references to them in their order."""
    names = [f"frame_{k:02d}" for k in range(12)]
    for name, values in zip(names, OBLONG, strict=True):
        file[name] = values
    file["order"] = np.array([file[name].ref for name in names], dtype=h5py.ref_dtype)


def refer_nowhere(file: Any) -> None:
    with_stack(file)
    file["gone"] = np.arange(3.0)
    file["link"] = np.array([file["gone"].ref], dtype=h5py.ref_dtype)
    del file["gone"]


def refer_empty(file: Any) -> None:
    with_stack(file)
    file["link"] = h5py.Empty(h5py.ref_dtype)


def refer_to_a_text(file: Any) -> None:
    with_stack(file)
    file["#refs#/a"] = "noon"
    file["time"] = np.array([file["#refs#/a"].ref] * 12, dtype=h5py.ref_dtype)


@pytest.mark.parametrize("fill", [refer_to_each, refer_nowhere, refer_empty, refer_to_a_text])
def test_references_of_other_programs_do_no_harm_beside_frames(fill: Fill, tmp_path: Path) -> None:
    frames, _ = frames_of(made(tmp_path / "a.h5", fill))
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)


def kept(values: np.ndarray, **options: Any) -> Fill:
    """Make room for all values, and write half of them."""

    def fill(file: Any) -> None:
        dataset = file.create_dataset("p", values.shape, values.dtype, **options)
        dataset[: len(values) // 2] = values[: len(values) // 2]

    return fill


@pytest.mark.parametrize("dtype", ["f8", "f4", "u2"])
def test_frames_that_nobody_wrote_are_missing_not_zeros(tmp_path: Path, dtype: str) -> None:
    values = OBLONG.astype(dtype)
    frames, report = frames_of(made(tmp_path / "a.h5", kept(values, chunks=(1, 6, 10))))
    np.testing.assert_array_equal([f.image.values for f in frames[:6]], values[:6])
    assert [f.image.valid is None for f in frames] == 6 * [True] + 6 * [False]
    assert not any(f.image.valid.any() for f in frames[6:] if f.image.valid is not None)
    told = "6 of 12 chunks of dataset 'p' never written, whose values are taken for missing"
    whole = "(all of 6 of the 12 along its first axis)"
    assert report.counts[f"recordings with {told} {whole}"] == 1


def test_cells_that_nobody_wrote_are_missing_in_frames_of_others(tmp_path: Path) -> None:
    def fill(file: Any) -> None:
        dataset = file.create_dataset("p", OBLONG.shape, "f8", chunks=(5, 4, 10))
        dataset[5:, 4:] = OBLONG[5:, 4:]

    frames, _ = frames_of(made(tmp_path / "a.h5", fill))
    assert [int(f.image.valid.sum()) for f in frames if f.image.valid is not None] == (
        5 * [0] + 7 * [20]
    )
    np.testing.assert_array_equal(frames[7].image.values[4:], OBLONG[7, 4:])


def test_a_dataset_of_which_nothing_was_written_holds_no_value(tmp_path: Path) -> None:
    path = made(tmp_path / "a.h5", lambda file: file.create_dataset("p", OBLONG.shape, "f8"))
    frames, report = frames_of(path)
    assert not any(f.image.valid is None or f.image.valid.any() for f in frames)
    assert any("dataset 'p' never written" in told for told in report.counts)


@pytest.mark.parametrize("dated", [False, True])
def test_times_that_nobody_wrote_are_none(tmp_path: Path, dated: bool) -> None:
    def fill(file: Any) -> None:
        times = np.arange(12.0) + 1.0
        if dated:
            days = np.datetime64("2024-01-01", "s") + np.arange(12).astype("m8[s]")
            times = days.astype(h5py.opaque_dtype(days.dtype))
        dataset = file.create_dataset("time", (12,), times.dtype, chunks=(1,))
        for k in range(6):
            dataset[k] = times[k]

    frames, _ = frames_of(made(tmp_path / "a.h5", with_stack, fill))
    assert [f.time_s is None for f in frames] == 6 * [False] + 6 * [True]
    assert np.diff([f.time_s or 0.0 for f in frames[:6]]) == pytest.approx(1.0)


def in_one_chunk_that_is_longer(file: Any) -> None:
    file.create_dataset("p", data=OBLONG, chunks=(50, 6, 10), maxshape=(None, 6, 10))


def cut_to_size(file: Any) -> None:
    dataset = file.create_dataset("p", (40, 6, 10), "f8", chunks=(7, 4, 3), maxshape=(40, 6, 10))
    dataset[:12] = OBLONG
    dataset.resize(12, axis=0)


def zeros_between(file: Any) -> None:
    dataset = file.create_dataset("p", OBLONG.shape, "f8", chunks=(1, 6, 10), compression="gzip")
    for k, frame in enumerate(OBLONG):
        dataset[k] = frame


def compact(file: Any) -> None:
    how = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    how.set_layout(h5py.h5d.COMPACT)
    space = h5py.h5s.create_simple(OBLONG.shape)
    h5py.h5d.create(file.id, b"p", h5py.h5t.NATIVE_DOUBLE, space, how)
    file["p"][...] = OBLONG


@pytest.mark.parametrize(
    "fill", [with_stack, in_one_chunk_that_is_longer, cut_to_size, zeros_between, compact]
)
def test_of_what_was_written_nothing_is_missing(tmp_path: Path, fill: Fill) -> None:
    frames, report = frames_of(made(tmp_path / "a.h5", fill))
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
    assert all(f.image.valid is None for f in frames)
    assert not any("never written" in told for told in report.counts)
