"""The step itself: formats by content, settings, files that are none, damage in vendors' files."""

from __future__ import annotations

import hashlib
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from helpers_recordings import (
    blobs,
    capfingerid_text,
    emed_text,
    flat_text,
    frames_of,
    long_text,
    npy_bytes,
    npz_bytes,
    pliance_text,
    popu_bed_text,
    stacked_text,
    tekscan_text,
    write,
    xsensor_text,
)
from tactile_graph import loads
from tactile_graph.cli import cli
from tactile_graph.engine.outcomes.outcome import Failed
from tactile_graph.errors import DataError
from tactile_graph.steps import Report
from tactile_graph.steps.signature import Kind, read_signature
from tactile_graph.wires import Frame
from tactile_graph_sources.recording import recording

WHOLE = np.random.default_rng(0).integers(0, 90, (3, 27, 15))
SMALL = blobs(3, 6, 5, decimals=0)
FORMATS: dict[str, bytes] = {
    "npy": npy_bytes(SMALL),
    "npz": npz_bytes(values=SMALL, pitch_cm=np.array([1.3, 1.3]), quantity=np.array("volt")),
    "capcontact": npz_bytes(cap=SMALL[0], ftir=np.kron(SMALL[0] < 100, np.ones((8, 8))) * 255.0),
    "bed mat": popu_bed_text(SMALL.astype(int)).encode(),
    "xsensor": xsensor_text({"LF": blobs(3, 6, 5), "RF": blobs(3, 6, 5, seed=1)}).encode(),
    "tekscan": tekscan_text(blobs(3, 6, 5), "KPa", "5.08 mm").encode(),
    "tekscan raw": tekscan_text(SMALL).encode(),
    "pliance": pliance_text(blobs(3, 6, 5, decimals=3)).encode(),
    "emed": emed_text(blobs(3, 6, 5)).encode("latin-1"),
    "capfingerid": capfingerid_text(WHOLE).encode(),
    "flat": flat_text(blobs(4, 8, 8)).encode(),
    "stacked": stacked_text(blobs(3, 6, 5)).encode(),
    "long": long_text(SMALL).encode(),
}


def test_it_is_a_source_with_settings() -> None:
    signature = read_signature("recording", recording)
    assert signature.kind is Kind.SOURCE
    assert signature.output is Frame
    assert signature.report == "report"
    names = tuple(s.name for s in signature.settings)
    assert names[:7] == ("path", "rows", "columns", "pitch_cm", "origin_cm", "quantity", "sensor")
    assert names[7:11] == ("order", "transpose", "flip", "skip")
    assert names[11:15] == ("frame_column", "time_column", "time_unit", "time_format")
    assert names[15:] == ("value_column", "cells", "first_cell", "invert_from", "pad", "missing")


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_is_known_by_content_whatever_the_file_is_called(
    name: str, tmp_path: Path
) -> None:
    path = write(tmp_path, FORMATS[name], "data.jpg")
    frames, report = frames_of(path)
    assert len(frames) == {"capcontact": 1, "xsensor": 6, "flat": 4}.get(name, 3)
    assert [f.index for f in frames] == list(range(len(frames)))
    assert report.digests == {str(path): hashlib.sha256(FORMATS[name]).hexdigest()}
    assert not report.troubles


@pytest.mark.slow
@pytest.mark.parametrize("name", FORMATS)
@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_a_cut_or_mutated_file_gives_frames_or_a_data_error(
    name: str, data: st.DataObject, tmp_path: Path
) -> None:
    """Any other exception, a warning, a NaN or an infinity would be a fault."""
    content = bytearray(FORMATS[name])
    for _ in range(data.draw(st.integers(0, 6))):
        at = data.draw(st.integers(0, len(content) - 1))
        content[at] = data.draw(
            st.sampled_from(b'-]0129BeE,;.\n\r\t "\x00\xff\xb2') | st.integers(0, 255)
        )
    content = content[: data.draw(st.just(len(content)) | st.integers(0, len(content)))]
    path = write(tmp_path, bytes(content))
    with suppress(DataError):
        frames, _ = frames_of(path)
        assert frames
        for frame in frames:
            assert np.isfinite(frame.image.values).all()
            assert frame.image.valid is None or not frame.image.values[~frame.image.valid].any()


@pytest.mark.parametrize(
    ("content", "found"),
    [
        (b"", "no recording: an empty file"),
        (b"\n\n \r\n", "no recording: only blank lines"),
        (b"\x7fELF\x00\x01\x02" * 50, "no recording: binary data starting"),
        (b"Dear all,\nplease find attached\n", "no recording: text starting 'Dear all,'"),
        (b"PK\x03\x04" + b"\x00" * 40, "the archive is damaged"),
        (b"\x93NUMPY\x01\x00", "its array cannot be read"),
    ],
)
def test_a_file_that_is_no_recording_is_named_with_what_was_found(
    content: bytes, found: str, tmp_path: Path
) -> None:
    path = write(tmp_path, content)
    with pytest.raises(DataError, match=found) as caught:
        frames_of(path)
    assert str(caught.value).startswith(f"{path}: ")
    if "no recording" in found:
        assert "XSENSOR .csv, Tekscan .asf/.csv, novel pliance .asc" in str(caught.value)


def test_missing_files_and_directories_are_named(tmp_path: Path) -> None:
    write(tmp_path, b"1,2", "walk.csv")
    with pytest.raises(DataError, match=r"there is no such file; did you mean 'walk.csv'\?"):
        frames_of(tmp_path / "walks.csv")
    with pytest.raises(DataError, match=r"there is no such file; no file fits this pattern"):
        frames_of(tmp_path / "*.csv")
    with pytest.raises(DataError, match="save what standard input gives as a file first"):
        frames_of(Path("-"))
    with pytest.raises(DataError, match=r"is a directory; give a file in it \(walk.csv\)$"):
        frames_of(tmp_path)
    write(tmp_path, b"1,2", "wander.csv")
    with pytest.raises(DataError, match=r"\(walk.csv, wander.csv\), or all of them: \S+/\*$"):
        frames_of(tmp_path)
    (tmp_path / "bare").mkdir()
    with pytest.raises(DataError, match="is a directory without a file in it; give a file"):
        frames_of(tmp_path / "bare")
    with pytest.raises(ValueError, match="path is an empty list"):
        frames_of([])


def test_a_missing_file_is_found_before_the_first_one_is_read(tmp_path: Path) -> None:
    good = write(tmp_path, FORMATS["flat"])
    with pytest.raises(DataError, match="there is no such file"):
        next(recording(path=[good, tmp_path / "none"], report=Report()))


def test_a_file_without_a_whole_frame_says_what_was_wrong_with_the_first(tmp_path: Path) -> None:
    text = tekscan_text(SMALL[:1]).replace("ROWS 6", "ROWS 7")
    with pytest.raises(
        DataError,
        match=r"looks like Tekscan .* no whole frame \(line 15: frame 1 has 6 rows, not 7\)",
    ):
        frames_of(write(tmp_path, text))


def test_several_files_are_numbered_on_and_labelled_by_file(tmp_path: Path) -> None:
    paths = [write(tmp_path, FORMATS["flat"], "a"), write(tmp_path, FORMATS["xsensor"], "b")]
    frames, report = frames_of(paths)
    assert [f.index for f in frames] == list(range(10))
    assert [f.label for f in frames[3:6]] == ["a", "b LF", "b RF"]
    assert len(report.digests) == 2


def test_settings_say_what_the_file_cannot(tmp_path: Path) -> None:
    path = write(tmp_path, FORMATS["flat"])
    frames, report = frames_of(path, pitch_cm=1.3, origin_cm=(-0.15, -0.15), quantity="volt")
    image = frames[0].image
    assert (image.pitch_cm, image.origin_cm, image.quantity) == ((1.3, 1.3), (-0.15, -0.15), "volt")
    assert report.counts == {"recordings read as table, one frame a line": 1}
    frames, report = frames_of(path)
    assert frames[0].image.pitch_cm == (1.0, 1.0)
    assert report.counts["recordings whose pitch is assumed to be 1 cm"] == 1


def test_a_quantity_against_the_files_own_is_refused(tmp_path: Path) -> None:
    path = write(tmp_path, FORMATS["tekscan"])
    with pytest.raises(DataError, match="its values are kilopascal, the settings say volt"):
        frames_of(path, quantity="volt")
    frames, _ = frames_of(path, quantity="raw")  # which claims nothing
    assert frames[0].image.quantity == "raw"


def test_one_sensor_of_several_can_be_chosen(tmp_path: Path) -> None:
    path = write(tmp_path, FORMATS["xsensor"])
    frames, _ = frames_of(path, sensor="rf")
    assert {f.label for f in frames} == {"RF"}
    assert len(frames) == 3
    with pytest.raises(DataError, match=r"no sensor 'LFF', there are: LF, RF; did you mean 'LF'"):
        frames_of(path, sensor="LFF")


@pytest.mark.parametrize(
    ("units", "factor"), [("KPa", 1.0), ("mmHg", 0.133322387), ("PSI", 6.89475729), ("N/cm2", 10.0)]
)
def test_pressures_become_kilopascals(units: str, factor: float, tmp_path: Path) -> None:
    values = blobs(1, 6, 5)
    (frame,), _ = frames_of(write(tmp_path, tekscan_text(values, units, "0.5 inch")))
    assert frame.image.quantity == "kilopascal"
    assert frame.image.pitch_cm == (1.27, 1.27)
    np.testing.assert_allclose(frame.image.values, values[0] * factor, rtol=1e-8)


def lines_of(name: str) -> list[str]:
    return FORMATS[name].decode("latin-1").splitlines()


def at(lines: list[str], start: str, n: int = 1) -> int:
    return [k for k, line in enumerate(lines) if line.startswith(start)][n - 1]


DAMAGE = {
    # name: (format, start of a line, which, lines after it, replacement or None, frames, message)
    "tekscan, a row gone": ("tekscan raw", "Frame 2", 1, 2, None, "frame 2 has 5 rows, not 6"),
    "tekscan, a long row": ("tekscan raw", "Frame 2", 1, 2, "1,2,3,4,5,6", "6 values, not 5"),
    "tekscan, two signs": ("tekscan raw", "Frame 2", 1, 2, "1,2,3,4,--2", "'--2' is no number"),
    "xsensor, a row gone": (
        "xsensor",
        "SENSELS",
        5,
        2,
        None,
        "frame 101 of sensor 'LF': 5 rows, not 6",
    ),
    "xsensor, garbage": ("xsensor", "SENSELS", 5, 2, "%&", "1 values, not 5"),
    "xsensor, a word": ("xsensor", "SENSELS", 5, 2, "oops", "1 values, not 5"),
    "xsensor, no columns": ("xsensor", "Columns", 3, 0, "Columns,x", "Rows and Columns are"),
    "pliance, too short": ("pliance", "     0.12", 1, 0, "0.12 1 2 3", "3 values, not 30"),
    "emed, a row gone": ("emed", "\tPict-No", 2, 4, "x", "expected a row number"),
    "emed, numbers jump": ("emed", "\tPict-No", 2, 4, None, "row numbers that are not consecutive"),
    "emed, force row gone": ("emed", "Force", 2, 0, "", "ends before its row of forces"),
}


@pytest.mark.parametrize("name", DAMAGE)
def test_a_damaged_record_costs_only_itself(name: str, tmp_path: Path) -> None:
    format_name, start, which, after, replacement, what = DAMAGE[name]
    lines = lines_of(format_name)
    k = at(lines, start, which) + after
    if replacement is None:
        del lines[k]
    else:
        lines[k] = replacement
    frames, report = frames_of(write(tmp_path, "\n".join(lines).encode("latin-1")))
    assert len(frames) == (5 if format_name == "xsensor" else 2)
    assert report.counts["damaged records skipped"] == 1
    (place, text), *others = report.troubles
    assert not others
    assert what in text
    assert int(place.rpartition(":")[2]) in range(k - 14, k + 3)
    labels = [f.label for f in frames if f.gap]
    assert labels == ([frames[-2].label] if format_name == "xsensor" else [""])


@pytest.mark.parametrize(
    ("name", "old", "new", "n"),
    [
        ("tekscan raw", b"Frame 3", b"Frame 2", 2),
        ("xsensor", b"FRAME,102", b"FRAME,101", 4),
        ("pliance", b"     0.16000", b"     0.12000", 2),
        ("emed", b"Pict-No.: 3", b"Pict-No.: 2", 2),
    ],
)
def test_a_repeated_frame_is_dropped_and_reported(
    name: str, old: bytes, new: bytes, n: int, tmp_path: Path
) -> None:
    path = write(tmp_path, FORMATS[name].replace(old, new, 1))
    frames, report = frames_of(path)
    assert len(frames) == n
    assert report.counts["repeated frames dropped"] == (2 if name == "xsensor" else 1)
    assert all("comes again; the first one is kept" in text for _, text in report.troubles)


def test_a_frame_that_does_not_add_up_is_kept_and_reported(tmp_path: Path) -> None:
    text = FORMATS["tekscan raw"].replace(b"Raw Sum=,,", b"Raw Sum=,,9", 1)
    frames, report = frames_of(write(tmp_path, text))
    assert len(frames) == 3
    assert "its Raw Sum says 9" in report.troubles[0][1]
    lines = lines_of("emed")
    k = at(lines, "Force")
    lines[k] = "\t".join([*lines[k].split("\t")[:-1], "999.00"])
    frames, report = frames_of(write(tmp_path, "\n".join(lines).encode("latin-1")))
    assert len(frames) == 3
    assert "the page says 999.00 N; the frame is kept" in report.troubles[0][1]


def test_emed_pages_of_one_picture_are_put_together(tmp_path: Path) -> None:
    values = blobs(1, 6, 8)
    left, right = (
        emed_text(values[:, :, :4], summary=False),
        emed_text(values[:, :, 4:], 3, 9, False),
    )
    frames, report = frames_of(write(tmp_path, (left + right).encode("latin-1")))
    assert not report.troubles
    np.testing.assert_array_equal(frames[0].image.values[2:8, 4:12], values[0])
    assert len(frames) == 1
    broken = right.replace("\n4\t", "\nx\t")
    with pytest.raises(DataError, match="no whole frame"):
        frames_of(write(tmp_path, (left + broken).encode("latin-1")))


def test_pliance_without_corners_takes_the_told_shape(tmp_path: Path) -> None:
    text = FORMATS["pliance"].decode().partition("corner[cm]")[0]
    path = write(tmp_path, text)
    with pytest.raises(DataError, match="no table of corners says how its 30 cells lie"):
        frames_of(path)
    frames, _ = frames_of(path, rows=6, columns=5)
    np.testing.assert_array_equal([f.image.values for f in frames], blobs(3, 6, 5, decimals=3))


def test_bed_mat_snapshots_of_the_wrong_length_are_skipped(tmp_path: Path) -> None:
    text = popu_bed_text(SMALL.astype(int))
    head, _, tail = text.partition('"1": {')
    path = write(tmp_path, head + '"x": {"tactilus_readings": [1, 2]}, "1": {' + tail)
    frames, report = frames_of(path)
    assert len(frames) == 3
    assert report.troubles == [(f"{path}:snapshot x", "2 readings, not 6 x 5")]


@pytest.mark.parametrize(
    ("arrays", "what"),
    [
        ({"a": SMALL, "b": SMALL}, "several arrays could be it"),
        ({"a": np.zeros(3)}, "no matrix or stack of matrices"),
        ({"values": np.zeros((2, 2, 2, 2))}, r"shape \(2, 2, 2, 2\)"),
        ({"values": SMALL.astype(complex)}, "not real numbers"),
        ({"values": SMALL, "time_s": np.zeros(9)}, r"'time_s' has shape \(9,\)"),
        ({"values": SMALL, "quantity": np.array("furlong")}, "unknown quantity 'furlong'"),
        ({"values": SMALL, "pitch_cm": np.array([0.0, 1.0])}, "which no pad has"),
        ({"cap": SMALL[0], "ftir": SMALL[0][:5]}, "is no finer grid"),
    ],
)
def test_archives_that_hold_no_recording(
    arrays: dict[str, np.ndarray], what: str, tmp_path: Path
) -> None:
    with pytest.raises(DataError, match=what):
        frames_of(write(tmp_path, npz_bytes(**arrays)))


def test_an_array_of_an_archive_is_chosen_by_name(tmp_path: Path) -> None:
    path = write(tmp_path, npz_bytes(left=SMALL, right=SMALL + 1.0))
    np.testing.assert_array_equal(frames_of(path, sensor="right")[0][1].image.values, SMALL[1] + 1)
    with pytest.raises(DataError, match=r"no array 'rigth', there are left, right; did you mean"):
        frames_of(path, sensor="rigth")


def test_nothing_is_ever_unpickled(tmp_path: Path) -> None:
    path = write(tmp_path, npy_bytes(np.array([[print, 1]], dtype=object)))
    with pytest.raises(DataError, match=r"its array cannot be read: .*Python objects"):
        frames_of(path)


@pytest.mark.parametrize("array", [SMALL.reshape(3, 30), np.moveaxis(SMALL, 0, -1), SMALL[0]])
def test_told_shape_settles_how_an_arrays_axes_are_meant(array: np.ndarray, tmp_path: Path) -> None:
    frames, _ = frames_of(write(tmp_path, npy_bytes(array)), rows=6, columns=5)
    np.testing.assert_array_equal(frames[0].image.values, SMALL[0])


def test_damaged_truth_is_left_out_and_the_frames_kept(tmp_path: Path) -> None:
    path = write(
        tmp_path, npz_bytes(values=SMALL, truth=np.array('[[{"kind": "blob"}], null, null]'))
    )
    frames, report = frames_of(path)
    assert [f.truth for f in frames] == [None] * 3
    assert "the truth is left out: frame 0, object 0: unknown kind" in report.troubles[0][1]


def test_a_recording_past_midnight_goes_on(tmp_path: Path) -> None:
    text = FORMATS["xsensor"].replace(b"23:59:59.500", b"00:00:00.250")
    frames, _ = frames_of(write(tmp_path, text))
    assert frames[2].time_s == pytest.approx(1.25)


def european(text: str) -> str:
    return text.replace(",", ";").replace(".", ",")


VARIANTS = {
    "tekscan, trailing commas": (
        "tekscan",
        lambda t: "\n".join(r + "," if r[:1].isdigit() else r for r in t.split("\n")),
    ),
    "tekscan, blank lines": ("tekscan", lambda t: t.replace("\n", "\n\n")),
    "tekscan, decimal commas": (
        "tekscan",
        lambda t: "\n".join(european(r) if r[:1].isdigit() else r for r in t.split("\n")),
    ),
    "tekscan, CRLF": ("tekscan raw", lambda t: t.replace("\n", "\r\n")),
    "tekscan, cut before its end mark": ("tekscan", lambda t: t.removesuffix("@@\n")),
    "xsensor, decimal commas": ("xsensor", european),
    "xsensor, no padding": ("xsensor", lambda t: t.replace(",,,,,,,,", "")),
    "xsensor, CRLF": ("xsensor", lambda t: t.replace("\n", "\r\n")),
    "pliance, decimal commas": ("pliance", lambda t: t.replace(".", ",")),
    "pliance, blank lines": ("pliance", lambda t: t.replace("\n", "\n\n")),
    "pliance, CRLF": ("pliance", lambda t: t.replace("\n", "\r\n")),
    "emed, decimal commas": ("emed", lambda t: t.replace(".", ",").replace("No,:", "No.:")),
    "emed, blank lines": ("emed", lambda t: t.replace("\n", "\n\n")),
    "emed, CRLF": ("emed", lambda t: t.replace("\n", "\r\n")),
    "bed mat, byte-order mark": ("bed mat", lambda t: "\ufeff" + t),
    "capfingerid, blank lines": ("capfingerid", lambda t: t.replace("\n", "\n\n")),
}


@pytest.mark.parametrize("name", VARIANTS)
def test_vendors_files_read_the_same_however_they_were_saved(name: str, tmp_path: Path) -> None:
    format_name, change = VARIANTS[name]
    plain, _ = frames_of(write(tmp_path, FORMATS[format_name]))
    encoding = "latin-1" if format_name == "emed" else "utf-8"
    text = change(FORMATS[format_name].decode(encoding))
    changed, report = frames_of(write(tmp_path, text.encode(encoding)))
    assert not report.troubles
    assert len(changed) == len(plain)
    for one, other in zip(plain, changed, strict=True):
        np.testing.assert_array_equal(one.image.values, other.image.values)
        assert one.image.pitch_cm == other.image.pitch_cm
        assert one.image.quantity == other.image.quantity
        assert one.time_s == other.time_s


def test_lines_before_the_first_tekscan_frame_are_reported(tmp_path: Path) -> None:
    text = FORMATS["tekscan"].replace(b"ASCII_DATA @@\n", b"ASCII_DATA @@\n0,0,0,0,0\n")
    frames, report = frames_of(write(tmp_path, text))
    assert len(frames) == 3
    assert report.troubles[0][1] == "expected a Frame line, got '0,0,0,0,0'"


# JSON needs its end, an archive its directory, pliance its table of corners: their errors say so.
@pytest.mark.parametrize(
    ("name", "mark"),
    [
        ("xsensor", b"FRAME,102"),
        ("tekscan", b"Frame 3"),
        ("emed", b"Page 3"),
        ("stacked", b"\n\n"),
        ("flat", b"\n"),
        ("capfingerid", b"15;left"),
    ],
)
def test_a_film_that_breaks_off_gives_the_whole_frames_before(
    name: str, mark: bytes, tmp_path: Path
) -> None:
    content = FORMATS[name]
    whole, _ = frames_of(write(tmp_path, content))
    cut = content.rstrip().rfind(mark) + 30
    kept, report = frames_of(write(tmp_path, content[:cut]))
    assert len(kept) == len(whole) - (2 if name == "xsensor" else 1)
    assert name in ("emed", "xsensor") or report.counts["damaged records skipped"] == 1
    for one, other in zip(kept, whole, strict=False):
        np.testing.assert_array_equal(one.image.values, other.image.values)


# -- steps that keep state -------------------------------------------------------------------------

TARED = """
pipeline: tared
about: readings above the empty pad's
nodes: {tared: {step: tare, in: frame, with: {n_frames: 2}}}
outputs: [tared]
"""


def test_each_recording_and_each_sensor_starts_state_anew(tmp_path: Path) -> None:
    for name, rest in (("a.npz", 100.0), ("b.npz", 300.0)):
        values = rest + np.array([0.0, 0.0, 7.0])[:, None, None] * np.ones((3, 4, 4))
        write(tmp_path, npz_bytes(values=values, pitch_cm=np.array([1.0, 1.0])), name)
    mats = {"LF": np.full((3, 6, 5), 10.0), "RF": np.full((3, 4, 5), 30.0)}
    write(tmp_path, xsensor_text(mats), "x.csv")
    pipeline = loads(TARED).with_source("recording", path=[tmp_path / "a.npz", tmp_path / "b.npz"])
    results = [r["tared"].peak for r in pipeline.stream(report=Report()) if "tared" in r]
    assert results == [0.0, 7.0, 0.0, 7.0]
    of_sensors = pipeline.with_source("recording", path=tmp_path / "x.csv")
    of_sensors = [*of_sensors.stream(report=Report())]
    assert [r["tared"].peak for r in of_sensors if "tared" in r] == [0.0] * 4
    assert not any(isinstance(r.outcome("tared"), Failed) for r in of_sensors)


def test_recordings_of_one_frame_are_told_of_where_steps_keep_state(tmp_path: Path) -> None:
    (tmp_path / "tared.yaml").write_text(TARED)
    names = [str(write(tmp_path, flat_text(blobs(1, 8, 8)), f"f{i}.csv")) for i in (1, 2)]
    got = CliRunner().invoke(cli, ["run", str(tmp_path / "tared.yaml"), *names])
    assert "began anew with each of 2 recordings of one frame" in " ".join(got.output.split())


@pytest.mark.parametrize("pitch", [np.array(1.016), np.array([1.016]), np.array([1.016, 1.016])])
def test_one_pitch_in_an_npz_of_ours_is_that_of_square_cells(
    tmp_path: Path, pitch: np.ndarray
) -> None:
    frames, _ = frames_of(write(tmp_path, npz_bytes(values=SMALL, pitch_cm=pitch), "a.npz"))
    assert frames[0].image.pitch_cm == (1.016, 1.016)


def test_of_three_pitches_it_is_said_what_two_would_be(tmp_path: Path) -> None:
    path = write(tmp_path, npz_bytes(values=SMALL, pitch_cm=np.ones(3)), "a.npz")
    with pytest.raises(DataError, match=r"expected shape \(2,\), along x and along y"):
        frames_of(path)
