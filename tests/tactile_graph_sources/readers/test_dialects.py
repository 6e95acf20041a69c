"""Files in many dialects: each is read right, or refused with the remedy."""

from __future__ import annotations

import json
import warnings
from importlib.util import find_spec
from pathlib import Path
from unittest.mock import patch

import numpy as np
import pytest

from helpers_dialects import (
    Dialect,
    became,
    cell_array,
    dialects,
    flat,
    long,
    matlab,
    mutated,
    picture,
)
from helpers_export_dialects import export_dialects
from helpers_more_dialects import more_dialects
from helpers_recordings import frames_of, npz_bytes, write
from helpers_stranger_dialects import stranger_dialects
from tactile_graph.errors import DataError
from tactile_graph.steps import Report
from tactile_graph_sources.readers.arrays.matlab import frames_first
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.words import dialect as dialect_module
from tactile_graph_sources.readers.words.told import Told

FILES = dialects()
HDF5 = find_spec("h5py") is not None
MORE = [*more_dialects(HDF5), *export_dialects(HDF5), *stranger_dialects()]


@pytest.mark.parametrize("dialect", [*FILES, *MORE], ids=lambda d: d.name)
def test_a_file_is_read_right_or_refused_with_what_to_say(dialect: Dialect, tmp_path: Path) -> None:
    found = became(dialect, tmp_path)
    assert found.fits(dialect), found
    if dialect.refused and dialect.told:
        again = became(dialect, tmp_path, dialect.told)
        assert again.outcome == "read", again


def test_there_are_enough_of_them_and_most_are_read() -> None:
    assert len(FILES) >= 40
    assert sum(not d.refused for d in FILES) > 0.75 * len(FILES)


@pytest.mark.slow
def test_damaged_copies_give_frames_or_a_data_error_and_no_warning(tmp_path: Path) -> None:
    rng = np.random.default_rng(5)
    read = 0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for k in range(4 * len(FILES)):
            path = write(tmp_path, mutated(FILES[k % len(FILES)].content, rng))
            try:
                frames, _ = frames_of(path)
            except DataError:
                continue
            read += 1
            assert all(np.isfinite(f.image.values).all() for f in frames)
    assert read > len(FILES)


SQUARE = np.round(FILES[0].values)
OBLONG = next(d for d in FILES if d.name == "frame,row,col,value").values


def text_of(path: Path, content: str) -> Path:
    return write(path, content)


# -- what is assumed is said, and how the format was recognised --------------------------------


def test_the_output_names_the_format_and_what_is_assumed(tmp_path: Path) -> None:
    path = text_of(tmp_path, flat(SQUARE, [f"{1000 + 20 * k}" for k in range(20)]))
    _, report = frames_of(path)
    assert report.counts == {
        "recordings read as table, one frame a line": 1,
        "recordings with times assumed to be in milliseconds": 1,
        "recordings whose pitch is assumed to be 1 cm": 1,
    }


def test_frames_without_contacts_are_assumed_square_and_it_is_said(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    path = text_of(tmp_path, flat(rng.integers(0, 9, (300, 10, 10)).astype(float)))
    frames, report = frames_of(path)
    assert frames[0].image.shape == (10, 10)
    assert report.counts["recordings with frames assumed to be square, 10 x 10"] == 1


def test_words_and_names_that_contradict_each_other_are_both_named(tmp_path: Path) -> None:
    names = ",".join(f"r{r}c{c}" for r in range(6) for c in range(10))
    path = text_of(tmp_path, "Rows: 10\nColumns: 6\n" + flat(OBLONG, header=names))
    with pytest.raises(
        DataError,
        match=r"r0c0 to r5c9\) say 6 x 10 cells, the words before the table 10 x 6",
    ):
        frames_of(path)
    with pytest.raises(DataError, match="say 6 x 10 cells, the settings 5 x 12"):
        frames_of(text_of(tmp_path, flat(OBLONG, header=names)), rows=5, columns=12)


def test_a_finger_called_index_numbers_no_frames(tmp_path: Path) -> None:
    values = np.random.default_rng(0).integers(0, 90, (30, 2, 2)).astype(float)
    path = text_of(tmp_path, flat(values, header="thumb,index,middle,ring"))
    frames, _ = frames_of(path, rows=2, columns=2)
    np.testing.assert_array_equal([f.image.values for f in frames], values)


def test_a_cell_without_a_column_is_invalid(tmp_path: Path) -> None:
    names = [f"r{r}c{c}" for r in range(6) for c in range(10)]
    lines = flat(OBLONG, header=",".join(names)).splitlines()
    text = "\n".join(",".join(line.split(",")[:-3] + line.split(",")[-2:]) for line in lines)
    frames, _ = frames_of(text_of(tmp_path, text))
    valid = frames[0].image.valid
    assert valid is not None
    assert np.argwhere(~valid).tolist() == [[5, 7]]


def test_too_few_named_cells_for_their_grid_are_asked_about(tmp_path: Path) -> None:
    path = text_of(tmp_path, "r0c0,r5c5,r9c9\n1,2,3\n4,5,6\n7,8,9\n")
    with pytest.raises(DataError, match="say 10 x 10 cells, of which it holds 3"):
        frames_of(path)


def test_cells_in_no_steady_order_without_a_number_are_refused(tmp_path: Path) -> None:
    head, *lines = long(OBLONG, "row,col,adc", "rcv").splitlines()
    rng = np.random.default_rng(1)
    shuffled = [lines[k] for k in rng.permutation(len(lines))]
    path = text_of(tmp_path, "\n".join([head, *shuffled]))
    with pytest.raises(DataError, match="no steady order and no column numbers the frames"):
        frames_of(path)
    timed = [f"{0.001 * k:.3f},{line}" for k, line in enumerate(shuffled)]
    path = text_of(tmp_path, "\n".join([f"time_s,{head}", *timed]))
    with pytest.raises(DataError, match="its times change after 1 cells"):
        frames_of(path)


def test_midnight_passes_in_times_of_day(tmp_path: Path) -> None:
    stamps = [f"23:59:59.{k}" if k < 10 else f"00:00:00.{k - 10}" for k in range(20)]
    frames, _ = frames_of(text_of(tmp_path, flat(SQUARE, stamps, "Uhrzeit," + "v," * 63 + "v")))
    assert [f.time_s for f in frames] == pytest.approx([0.1 * k for k in range(20)])


def test_a_time_that_is_none_costs_its_frame(tmp_path: Path) -> None:
    stamps = ["10:00:00", "10:00:01", "later", *(f"10:00:{k:02d}" for k in range(3, 20))]
    path = text_of(tmp_path, flat(SQUARE, stamps, "Uhrzeit," + "v," * 63 + "v"))
    frames, report = frames_of(path)
    assert len(frames) == 19
    assert report.troubles == [(f"{path}:4", "'later' is no time of day")]


def test_a_climbing_column_and_a_sum_behind_the_cells_are_no_cells(tmp_path: Path) -> None:
    lines = flat(SQUARE).splitlines()
    path = text_of(tmp_path, "".join(f"{x},{0.02 * k:.2f}\n" for k, x in enumerate(lines)))
    frames, _ = frames_of(path)
    assert [f.time_s for f in frames] == pytest.approx([0.02 * k for k in range(20)])
    np.testing.assert_array_equal([f.image.values for f in frames], SQUARE)
    path = text_of(tmp_path, "".join(f"{x},7\n" for x in lines))
    with pytest.raises(DataError, match="20 lines of 65 values could be one matrix"):
        frames_of(path)
    with pytest.raises(DataError, match="a line is 65 values, 64 of them cells by the settings"):
        frames_of(path, rows=8, columns=8)
    frames, _ = frames_of(path, rows=8, columns=8, cells="1-64")
    np.testing.assert_array_equal([f.image.values for f in frames], SQUARE)


# -- the settings ------------------------------------------------------------------------------


def test_order_transpose_and_flips_turn_the_cells(tmp_path: Path) -> None:
    path = text_of(tmp_path, flat(OBLONG, order="F"))
    told = {"rows": 6, "columns": 10, "order": "columns"}
    np.testing.assert_array_equal(frames_of(path, **told)[0][0].image.values, OBLONG[0])
    frames, _ = frames_of(path, **told, transpose=True, flip="rows", pitch_cm=(0.5, 0.7))
    np.testing.assert_array_equal(frames[0].image.values, OBLONG[0].T[::-1])
    assert frames[0].image.pitch_cm == (0.5, 0.7)
    frames, _ = frames_of(path, **told, flip="both")
    np.testing.assert_array_equal(frames[0].image.values, OBLONG[0][::-1, ::-1])
    frames, _ = frames_of(path, **told, flip="columns", skip=3)
    np.testing.assert_array_equal(frames[0].image.values, OBLONG[3][:, ::-1])
    assert [f.index for f in frames] == list(range(9))


def test_a_files_own_pitch_and_origin_are_exchanged_with_its_rows_and_columns(
    tmp_path: Path,
) -> None:
    own = {"pitch_cm": np.array([0.5, 0.7]), "origin_cm": np.array([3.0, 9.0])}
    path = write(tmp_path, npz_bytes(values=OBLONG, quantity=np.array("counts"), **own), "own.npz")
    image = frames_of(path, transpose=True)[0][0].image
    assert (image.pitch_cm, image.origin_cm) == ((0.7, 0.5), (9.0, 3.0))
    image = frames_of(path, transpose=True, origin_cm=(1.0, 2.0))[0][0].image
    assert image.origin_cm == (1.0, 2.0)
    image = frames_of(path, flip="both")[0][0].image
    assert (image.pitch_cm, image.origin_cm) == ((0.5, 0.7), (3.0, 9.0))


def test_columns_are_told_by_name_or_number(tmp_path: Path) -> None:
    names = "when," + ",".join(f"s{k}" for k in range(60)) + ",note"
    text = flat(OBLONG, (f"{20 * k}" for k in range(12)), names).replace("\n", ",9\n")
    path = text_of(tmp_path, text.replace("note,9", "note"))
    told = {"rows": 6, "columns": 10, "time_column": "when", "time_unit": "ms"}
    for cells in ("s*", "2-61"):
        frames, _ = frames_of(path, **told, cells=cells)
        np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
        assert frames[2].time_s == pytest.approx(0.04)
    with pytest.raises(DataError, match=r"time_column: there is no column 'wen'.*mean 'when'\?"):
        frames_of(path, time_column="wen")
    with pytest.raises(DataError, match=r"cells: no column is 'q\*'; there are note, s0, s1"):
        frames_of(path, cells="q*")


def test_a_format_of_times_is_told(tmp_path: Path) -> None:
    stamps = [f"20240501-1000{k:02d}" for k in range(20)]
    path = text_of(tmp_path, flat(SQUARE, stamps, "when," + "v," * 63 + "v"))
    told = {"time_column": "when", "time_format": "%Y%m%d-%H%M%S"}
    frames, _ = frames_of(path, **told)
    assert [f.time_s for f in frames] == list(range(20))


def test_frame_and_value_columns_of_a_long_table_are_told(tmp_path: Path) -> None:
    path = text_of(tmp_path, long(OBLONG, "take,row,col,left,right", "krcvv"))
    with pytest.raises(DataError, match="could be any of take, left, right; give value_column"):
        frames_of(path)
    frames, _ = frames_of(path, frame_column="take", value_column="right")
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)


@pytest.mark.parametrize(
    ("name", "quantity", "factor"),
    [
        ("R{0}C{1} (N/cm2)", "kilopascal", 10.0),
        ("R{0}C{1} [N/cm²]", "kilopascal", 10.0),
        ("R{0}C{1} N/cm2", "kilopascal", 10.0),
        ("C{1}R{0} (cmH2O)", "kilopascal", 0.0980665),
        ("x{1}y{0} (kPa)", "kilopascal", 1.0),
        ("R{0}C{1} (kips/ft2)", "raw", 1.0),
        ("p[r{0}][c{1}]", "raw", 1.0),
    ],
)
def test_a_unit_behind_the_names_of_cells_hides_no_place(
    name: str, quantity: str, factor: float, tmp_path: Path
) -> None:
    names = [name.format(r + 1, c + 1) for c in range(10) for r in range(6)]
    turned = np.moveaxis(OBLONG, 1, 2)
    text = flat(turned, (f"{k / 10:.1f}" for k in range(len(OBLONG))), ",".join(["t (s)", *names]))
    path = write(tmp_path, text.encode("latin-1"))
    for told in ({}, {"rows": 6, "columns": 10}):
        frames, _ = frames_of(path, **told)
        np.testing.assert_allclose([f.image.values for f in frames], OBLONG * factor)
        assert {f.image.quantity for f in frames} == {quantity}
    with pytest.raises(DataError, match="say 6 x 10 cells, the settings 10 x 6"):
        frames_of(path, rows=10, columns=6)


@pytest.mark.parametrize("kind", ["words", "long", "json", "npz", "mat", "h5"])
def test_a_unit_that_nobody_knows_is_told_whatever_says_it(kind: str, tmp_path: Path) -> None:
    path = tmp_path / f"film.{kind}"
    if kind == "words":
        path.write_text("Units: kips/ft2\n" + flat(SQUARE), encoding="utf-8")
    elif kind == "long":
        path.write_text(long(OBLONG, "frame,row,col,value [kips/ft2]", "krcv"), encoding="utf-8")
    elif kind == "json":
        path.write_text(json.dumps({"unit": "kips/ft2", "frames": SQUARE.tolist()}), "utf-8")
    elif kind == "npz":
        np.savez(path, frames=SQUARE, unit="kips/ft2")
    elif kind == "mat":
        path.write_bytes(matlab(frames=np.moveaxis(SQUARE, 0, -1), unit="kips/ft2"))
    else:
        hdf5(path, "kips/ft2", pressure=SQUARE)
    frames, report = frames_of(path)
    assert frames[0].image.quantity == "raw"
    assert report.counts["recordings with values in 'kips/ft2' taken as they are"] == 1


# -- arrays ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("shape", "words"),
    [
        ((16, 16, 500), "16 frames of 16 x 500, or 500 frames of 16 x 16 along the last axis"),
        ((500, 256), "one matrix, or 500 frames of 16 x 16 with their cells in a row"),
        ((12, 60), "one matrix, or 12 frames with their cells in a row"),
        ((41, 72, 3), "41 frames of 72 x 3, or a picture of 3 colours"),
    ],
)
def test_axes_that_can_be_read_two_ways_are_named_both_ways(
    shape: tuple[int, ...], words: str, tmp_path: Path
) -> None:
    np.save(tmp_path / "a.npy", np.zeros(shape))
    with pytest.raises(DataError, match=words):
        frames_of(tmp_path / "a.npy")


@pytest.mark.parametrize("shape", [(41, 72), (1, 64), (64, 64), (500, 12, 32), (5, 8, 8)])
def test_axes_that_can_be_read_one_way_are(shape: tuple[int, ...], tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", np.zeros(shape))
    frames, _ = frames_of(tmp_path / "a.npy")
    assert (len(frames), *frames[0].image.shape) == (shape if len(shape) == 3 else (1, *shape))


# -- JSON and pictures -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('{"a": [[1, 2], [3, 4]], "b": [[1, 2], [3, 4]]}', "several lists could be the frames"),
        ('{"a": 1}', "its JSON holds no list"),
        ('{"a": [["x", "y"]]}', "it holds no frames of numbers"),
        ('{"a" [1', "it begins as JSON does, and is none"),
        ("[]", "neither a list of frames nor an object around one"),
    ],
)
def test_json_without_frames_says_so(text: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(DataError, match=words):
        frames_of(text_of(tmp_path, text))


def test_a_damaged_entry_of_json_costs_only_itself(tmp_path: Path) -> None:
    text = '{"frames": [[[1, 2], [3, 4]], [[1, 2]], [[5, null], [7, 8]]]}'
    path = text_of(tmp_path, text)
    frames, report = frames_of(path)
    assert [f.image.values.tolist() for f in frames] == [[[1, 2], [3, 4]], [[5, 0], [7, 8]]]
    assert report.troubles == [(f"{path}:frame 1", "shape (1, 2), not (2, 2)")]
    path = text_of(tmp_path, '{"v": [[1, 2], [3, 4]]}\n{"v": \n{"v": [[5, 6], [7, 8]]}\n')
    frames, report = frames_of(path)
    assert len(frames) == 2
    assert report.troubles == [(f"{path}:2", "no JSON")]


def test_a_picture_that_cannot_be_read_says_why(tmp_path: Path) -> None:
    content = next(d.content for d in FILES if d.name == "PNG of 16 bits")
    with pytest.raises(DataError, match="the picture cannot be read"):
        frames_of(write(tmp_path, content[:60]))


def test_a_folder_of_pictures_is_read_in_the_order_of_their_numbers(tmp_path: Path) -> None:
    folder = tmp_path / "film"
    folder.mkdir()
    for k, values in enumerate(OBLONG):
        (folder / f"frame {k}.png").write_bytes(picture(values.astype(np.uint16), "png"))
    (folder / "notes.txt").write_text("nothing")
    frames, report = frames_of(folder)
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
    assert len(report.digests) == 12


# -- HDF5 --------------------------------------------------------------------------------------


def hdf5(path: Path, unit: str = "kPa", **datasets: np.ndarray) -> Path:
    h5py = pytest.importorskip("h5py", reason="the 'hdf5' extra is not installed")
    with h5py.File(path, "w") as file:
        for name, values in datasets.items():
            file[name] = values
        file.attrs["unit"] = unit
        file.attrs["pitch"] = "5 mm"
    return path


def test_hdf5_gives_its_stack_with_times_and_attributes(tmp_path: Path) -> None:
    path = hdf5(tmp_path / "a.h5", pressure=OBLONG, time_ms=20.0 * np.arange(12), n=np.int64(3))
    frames, report = frames_of(path)
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
    assert [f.time_s for f in frames] == pytest.approx([0.02 * k for k in range(12)])
    assert (frames[0].image.quantity, frames[0].image.pitch_cm) == ("kilopascal", (0.5, 0.5))
    assert report.counts == {"recordings read as HDF5 (.h5, .hdf5, MATLAB 7.3 .mat)": 1}


def test_several_stacks_of_hdf5_are_asked_about(tmp_path: Path) -> None:
    path = hdf5(tmp_path / "a.h5", left=OBLONG, right=OBLONG + 1)
    with pytest.raises(DataError, match=r"several datasets could be it \(left \(12, 6, 10\)"):
        frames_of(path)
    np.testing.assert_array_equal(frames_of(path, sensor="right")[0][0].image.values, OBLONG[0] + 1)
    with pytest.raises(DataError, match=r"no dataset 'rigth'.*did you mean 'right'"):
        frames_of(path, sensor="rigth")
    with pytest.raises(DataError, match="no matrix or stack of matrices in it; its datasets: a"):
        frames_of(hdf5(tmp_path / "b.h5", a=np.arange(5)))


def test_damaged_hdf5_says_so(tmp_path: Path) -> None:
    path = hdf5(tmp_path / "a.h5", left=OBLONG)
    path.write_bytes(path.read_bytes()[:900])
    with pytest.raises(DataError, match="the HDF5 file cannot be read"):
        frames_of(path)


# -- positions for rows and columns ------------------------------------------------------------


def placed(header: str, x0: float, step: float) -> str:
    lines = [
        f"{k},{x0 + step * c:g},{x0 + 2 * step * r:g},{v:.0f}"
        for (k, r, c), v in np.ndenumerate(OBLONG)
    ]
    return "\n".join([header, *lines]) + "\n"


@pytest.mark.parametrize(("x0", "step"), [(0.0, 5.0), (2.5, 5.0), (-10.0, 0.8)])
def test_positions_give_the_pitch(x0: float, step: float, tmp_path: Path) -> None:
    frames, _ = frames_of(text_of(tmp_path, placed("frame,x_mm,y_mm,p", x0, step)))
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
    assert frames[0].image.pitch_cm == pytest.approx((step / 10, step / 5))


def test_whole_numbers_without_a_unit_are_places_however_many_are_left_out(tmp_path: Path) -> None:
    frames, _ = frames_of(text_of(tmp_path, "row,col,adc\n0,0,5\n0,4,6\n2,0,7\n2,4,8\n4,4,9\n"))
    assert frames[0].image.shape == (5, 5)


def test_x_and_y_that_lie_anywhere_are_no_places(tmp_path: Path) -> None:
    lines = [f"{np.sin(k):.3f},{np.cos(k):.3f},9.81" for k in range(50)]
    with pytest.raises(DataError, match="under 'y' are no places on a grid"):
        frames_of(text_of(tmp_path, "\n".join(["x,y,z", *lines])))


def test_an_empty_column_in_front_is_no_cell(tmp_path: Path) -> None:
    text = "".join(f";{line.replace(',', ';')}\n" for line in flat(SQUARE).splitlines())
    frames, _ = frames_of(text_of(tmp_path, text))
    np.testing.assert_array_equal([f.image.values for f in frames], SQUARE)


def test_one_digit_too_many_in_a_row_does_not_blow_up_the_frames(tmp_path: Path) -> None:
    lines = long(OBLONG, "frame,row,col,adc", "krcv").splitlines()
    lines[100] = lines[100].replace(",", ",7", 1)
    path = text_of(tmp_path, "\n".join(lines))
    frames, report = frames_of(path)
    assert {f.image.shape for f in frames} == {(6, 10)}
    what = "no cell: its row or column is far beyond all others"
    assert report.troubles == [(f"{path}:101", what)]


# -- MATLAB ------------------------------------------------------------------------------------


def test_matlabs_frames_lie_where_times_say_whatever_is_square() -> None:
    reading = Reading(Head(Path("a.mat"), b"", Told()), Told(), Report())
    times = np.arange(16.0)
    values = np.zeros((16, 9, 9))
    assert frames_first(reading, np.zeros((9, 9, 16)), "p", times).shape == (16, 9, 9)
    assert frames_first(reading, values, "p", times).shape == (16, 9, 9)
    assert frames_first(reading, np.zeros((5, 6, 16)), "p", times).shape == (16, 5, 6)
    assert frames_first(reading, np.zeros((16, 6, 5)), "p", times).shape == (16, 6, 5)


def test_matlab_7_3_counts_the_other_way_round_and_its_axes_are_told_alike(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py", reason="the 'hdf5' extra is not installed")

    def saved(values: np.ndarray, name: str, **more: np.ndarray) -> Path:
        path = tmp_path / name
        with h5py.File(path, "w", userblock_size=512) as file:
            for key, array in {"p": values, **more}.items():
                file[key] = array.T  # as MATLAB writes what it indexes the other way round
        with path.open("r+b") as file:
            file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")
        return path

    last = np.moveaxis(OBLONG, 0, -1)
    frames, _ = frames_of(saved(last, "a.mat", time_s=np.arange(12.0)[None]))
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
    assert frames[3].time_s == 3.0
    with pytest.raises(DataError, match="12 frames of 6 x 10 along the last axis, or 6 frames of"):
        frames_of(saved(last, "b.mat"))
    again, _ = frames_of(tmp_path / "b.mat", rows=6, columns=10)
    np.testing.assert_array_equal([f.image.values for f in again], OBLONG)


def test_a_matlab_file_that_is_damaged_or_holds_no_numbers_says_so(tmp_path: Path) -> None:
    whole = matlab(True, p=OBLONG)
    with pytest.raises(DataError, match="the MATLAB file cannot be read"):
        frames_of(write(tmp_path, whole[:400]))
    with pytest.raises(DataError, match="no matrix or stack of matrices in it; its variables: n"):
        frames_of(write(tmp_path, matlab(n=3.0, words=cell_array(["a", "b"]), name="mat")))
    with pytest.raises(DataError, match="no variable 'q', there are p"):
        frames_of(write(tmp_path, whole), sensor="q")


def test_a_matrix_with_a_short_row_is_no_error_of_numpy_s(tmp_path: Path) -> None:
    """No whole matrix is among the first rows, so that there is nothing to look for sums in."""
    rows = [",".join(f"{v:.0f}" for v in row) for row in SQUARE[0]]
    rows[3] = rows[3].rpartition(",")[0]
    with pytest.raises(DataError, match="holds no whole frame"):
        frames_of(text_of(tmp_path, "\n".join(rows) + "\n"))


def test_in_lines_without_quotes_no_quoted_comma_is_sought() -> None:
    """The pattern takes longer than all else that is done to a line of many cells."""
    words_of = dialect_module.Dialect
    with patch.object(dialect_module, "_QUOTED_COMMA", None):
        assert words_of(",").fields("1,2.5,3") == ["1", "2.5", "3"]
        assert words_of(";").fields('"1";2,5') == ["1", "2,5"]
    assert words_of(",").fields('"1","2,5","3"') == ["1", "2,5", "3"]
