"""The vendors' own forces, areas, sums and centres of pressure, on real files and look-alikes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_panel import Tip, ftir_of, panel_frames, real_panel_frames
from helpers_recordings import (
    blobs,
    capfingerid_text,
    emed_says,
    emed_text,
    frames_of,
    npz_bytes,
    pliance_says,
    pliance_text,
    popu_bed_text,
    shared,
    tekscan_says,
    tekscan_text,
    write,
    xsensor_says,
    xsensor_text,
)
from tactile_graph.wires import Ellipse, Image

N_PER_KPA_CM2 = 0.1
REAL = pytest.mark.parametrize("real", [True, False], ids=["real", "look-alike"])


def force_n(image: Image) -> float:
    return image.total * image.cell_area_cm2 * N_PER_KPA_CM2


@REAL
def test_xsensor_load_area_and_peak_are_the_vendors(real: bool, tmp_path: Path) -> None:
    sensors = {"LF S0073": blobs(4, 31, 11), "RF S0073": blobs(4, 31, 11, seed=1)}
    path = (
        shared("vendor_exports/xsensor_data.csv")
        if real
        else write(tmp_path, xsensor_text(sensors))
    )
    frames, report = frames_of(path)
    said = xsensor_says(path)
    assert len(frames) == len(said) == (202 if real else 8)
    assert not report.troubles
    assert report.n_expected == len(frames)
    assert {f.label[-8:] for f in frames} == {"LF S0073", "RF S0073"}
    for frame, vendor in zip(frames, said, strict=True):
        image = frame.image
        assert image.quantity == "kilopascal"
        assert image.pitch_cm == (0.86, 0.86)
        assert force_n(image) == pytest.approx(vendor["load_n"], rel=0.005, abs=0.006)
        area = np.count_nonzero(image.values) * image.cell_area_cm2
        # The vendor prints a side of 0.86 cm and reckons with 0.861: 0.22 % in every area.
        assert area == pytest.approx(vendor["area"], rel=0.0025, abs=0.006)
        assert image.peak == pytest.approx(vendor["peak"] * 0.133322387415, rel=1e-9)
    times = [f.time_s for f in frames[::2]]
    assert times[0] == 0.0
    assert (np.diff(times) > 0.0).all()


def with_missing(values: np.ndarray[tuple[int, int, int], np.dtype[np.float64]]) -> None:
    values[:, :2], values[:, :, -3:] = np.nan, np.nan


@REAL
def test_tekscan_sums_are_the_vendors(real: bool, tmp_path: Path) -> None:
    values = blobs(5, 28, 28, decimals=0)
    with_missing(values)
    path = (
        shared("vendor_exports/iscan_test.csv") if real else write(tmp_path, tekscan_text(values))
    )
    frames, report = frames_of(path)
    assert [f.image.total for f in frames] == tekscan_says(path)
    assert len(frames) == report.n_expected == (309 if real else 5)
    assert not report.troubles
    image = frames[0].image
    assert (image.shape, image.quantity) == ((28, 28), "raw")
    assert image.pitch_cm == pytest.approx((0.127, 0.127))
    assert image.valid is not None
    assert not image.valid[0].any()
    assert not image.values[~image.valid].any()
    assert frames[2].time_s == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("separator", "comma"), [("\t", False), ("  ", False), (";", True), ("\t", True), (" ", True)]
)
def test_tekscan_cells_are_parted_by_commas_tabs_or_blanks(
    separator: str, comma: bool, tmp_path: Path
) -> None:
    values = blobs(5, 8, 6)
    with_missing(values)
    lines = []
    for k, line in enumerate(tekscan_text(values, "kPa").splitlines()):
        row = "B" in line or line[:1].isdecimal()
        stamp = f" {0.1 * int(line.split()[1]):.1f}" if line.startswith("Frame") else ""
        text = line.replace(",", separator) if row else line + stamp
        lines.append(text.replace(".", ",") if comma and k > 10 else text)
    frames, report = frames_of(write(tmp_path, "\n".join(lines)))
    assert not report.troubles
    shown = np.where(np.isnan(values), 0.0, np.round(values, 2))
    np.testing.assert_array_equal([f.image.values for f in frames], shown)
    assert [f.time_s for f in frames] == pytest.approx([0.1, 0.2, 0.3, 0.4, 0.5])


def test_a_whole_second_behind_a_tekscan_frame_is_no_decimal_of_its_number(tmp_path: Path) -> None:
    lines = tekscan_text(blobs(3, 8, 6), "kPa").splitlines()
    lines = [f"{t},{t.split()[1]}" if t.startswith("Frame") else t.replace(",", ";") for t in lines]
    frames, _ = frames_of(write(tmp_path, "\n".join(lines)))
    assert [(f.own_number, f.time_s) for f in frames] == [(1, 1.0), (2, 2.0), (3, 3.0)]


@REAL
def test_tekscan_film_in_kilopascal_masks_cells_outside_the_insole(
    real: bool, tmp_path: Path
) -> None:
    values = blobs(3, 60, 21)
    values[:, 0, :9] = np.nan
    text = tekscan_text(values, "KPa", "5.08 mm").replace("\n", "\r\n")
    path = shared("vendor_exports/FrasP01L.asf") if real else write(tmp_path, text)
    frames, report = frames_of(path)
    assert len(frames) == report.n_expected == (205 if real else 3)
    image = frames[1].image
    assert (image.shape, image.quantity) == ((60, 21), "kilopascal")
    assert image.pitch_cm == pytest.approx((0.508, 0.508))
    assert image.valid is not None
    assert not image.valid[0, :9].any()
    assert image.valid[0, 9:16].all()


@REAL
def test_pliance_force_and_centre_of_pressure_are_the_vendors(real: bool, tmp_path: Path) -> None:
    """The vendor counts x from the right edge; y is ours."""
    path = (
        shared("vendor_exports/pliance_test.asc")
        if real
        else write(tmp_path, pliance_text(blobs(6, 29, 28, decimals=3)))
    )
    frames, report = frames_of(path)
    said = pliance_says(path)
    assert len(frames) == (281 if real else 6)
    assert report.counts == {
        "recordings read as novel pliance .asc": 1,
        "summary rows left out": 2,
    }
    for frame in frames:
        image = frame.image
        assert (image.shape, image.quantity) == ((29, 28), "kilopascal")
        assert image.pitch_cm == pytest.approx((0.528, 1.028))
        assert frame.time_s is not None
        vendor_n, vendor_x, vendor_y = said[round(frame.time_s, 4)]
        assert force_n(image) == pytest.approx(vendor_n, rel=0.005, abs=0.0006)
        x_cm = image.values.sum(0) @ image.x_cm / image.total
        y_cm = image.values.sum(1) @ image.y_cm / image.total
        width_cm = image.columns * image.pitch_cm[0]
        assert width_cm == pytest.approx(14.784)
        assert (width_cm - x_cm, y_cm) == pytest.approx((vendor_x, vendor_y), abs=0.01)


@REAL
def test_emed_row_and_column_forces_are_the_vendors(real: bool, tmp_path: Path) -> None:
    text = emed_text(blobs(4, 12, 9)).encode("latin-1")
    path = shared("vendor_exports/emed_test.lst") if real else write(tmp_path, text)
    frames, report = frames_of(path)
    said = emed_says(path)
    assert len(frames) == len(said) == (106 if real else 4)
    assert not report.troubles
    assert report.counts["summary pages left out"] == (0 if real else 1)
    for frame, (rows, columns) in zip(frames, said, strict=True):
        image = frame.image
        assert image.shape == ((95, 64) if real else (24, 20))
        assert (image.quantity, image.pitch_cm) == ("kilopascal", (0.5, 0.5))
        cells_n = image.values * image.cell_area_cm2 * N_PER_KPA_CM2
        for number, vendor in rows.items():
            assert cells_n[number - 1].sum() == pytest.approx(vendor, abs=0.0051)
        for number, vendor in columns.items():
            assert cells_n[:, number - 1].sum() == pytest.approx(vendor, abs=0.0051)
        # Nothing lies outside the window that the vendor prints.
        assert cells_n.sum() == pytest.approx(sum(rows.values()), abs=0.0051 * len(rows))
    assert frames[3].time_s == pytest.approx(0.03)


@pytest.mark.slow
@REAL
def test_capfingerid_keeps_stamps_and_labels_and_skips_the_damaged_line(
    real: bool, tmp_path: Path
) -> None:
    values = np.random.default_rng(0).integers(-3, 90, (5, 27, 15))
    lines = capfingerid_text(values).splitlines(keepends=True)
    lines[2] = lines[2].replace(",", ",],", 9)
    path = shared("capfingerid/P15_thumb_left_600.txt") if real else write(tmp_path, "".join(lines))
    frames, report = frames_of(path)
    assert len(frames) == (599 if real else 4)
    damaged = 217 if real else 3
    assert [place for place, _ in report.troubles] == [f"{path}:{damaged}"]
    assert report.counts["damaged records skipped"] == 1
    assert [k for k, f in enumerate(frames, 1) if f.gap] == [damaged]
    assert frames[0].label == "15 left thumb TAP"
    assert (frames[0].image.shape, frames[0].time_s) == ((27, 15), 0.0)
    assert frames[0].device_time_s == pytest.approx(1510306588.570843498, abs=1e-6)
    if not real:
        np.testing.assert_array_equal(frames[-1].image.values, values[-1])


@REAL
def test_bed_mat_gives_every_snapshot(real: bool, tmp_path: Path) -> None:
    values = np.random.default_rng(0).integers(0, 90, (3, 64, 27))
    path = shared("popu_bed/left4_0.json") if real else write(tmp_path, popu_bed_text(values))
    frames, report = frames_of(path)
    assert len(frames) == report.n_expected == (10 if real else 3)
    assert frames[0].image.shape == (64, 27)
    if real:
        assert frames[0].image.values[0, :3].tolist() == [2.0, 0.0, 0.0]
    else:
        np.testing.assert_array_equal(frames[2].image.values, values[2])


def test_capcontact_truth_is_the_masks_contact(tmp_path: Path) -> None:
    """Centre, axes and direction of a drawn contact come back, in pad coordinates."""
    mask = ftir_of([Tip(9.3, 4.1, 0.9, 0.5, 0.6), Tip(20.0, 12.0, 0.6, 0.4, -1.0)])
    path = write(tmp_path, npz_bytes(cap=np.ones((41, 72), np.int16), ftir=mask))
    (frame,), _ = frames_of(path)
    assert frame.truth is not None
    first, second = (o.shape for o in frame.truth)
    assert isinstance(first, Ellipse)
    assert isinstance(second, Ellipse)
    assert (first.x_cm, first.y_cm) == pytest.approx((9.3, 4.1), abs=0.005)
    assert (first.semi_major_cm, first.semi_minor_cm) == pytest.approx((0.9, 0.5), abs=0.01)
    assert (first.angle_rad, second.angle_rad) == pytest.approx((0.6, -1.0), abs=0.02)
    n_cells = np.count_nonzero(mask == 0.0)
    assert first.area_cm2 + second.area_cm2 == pytest.approx(n_cells * 0.479 * 0.476 / 64)


@pytest.mark.slow
@REAL
def test_capcontact_image_peaks_where_the_truth_lies(real: bool, tmp_path: Path) -> None:
    """The mask's grid begins at the image's corner: half a cell off would show as 0.24 cm."""
    offsets = []
    for frame in real_panel_frames() if real else panel_frames(tmp_path):
        assert frame.image.shape == (41, 72)
        assert frame.truth
        for thing in frame.truth:
            near_x = np.abs(frame.image.x_cm - thing.shape.x_cm) < 1.0
            near_y = np.abs(frame.image.y_cm - thing.shape.y_cm) < 1.0
            cut = np.clip(frame.image.values[np.ix_(near_y, near_x)] - 100.0, 0.0, None)
            if cut.sum() > 0.0:
                x = cut.sum(0) @ frame.image.x_cm[near_x] / cut.sum()
                y = cut.sum(1) @ frame.image.y_cm[near_y] / cut.sum()
                offsets.append((x - thing.shape.x_cm, y - thing.shape.y_cm))
    assert len(offsets) > (80 if real else 20)
    assert np.abs(np.median(offsets, axis=0)).max() < 0.1


def test_the_pitch_of_research_sets_is_assumed_and_said(tmp_path: Path) -> None:
    cap = np.zeros((41, 72), dtype=np.int16)
    path = write(tmp_path, npz_bytes(cap=cap, ftir=np.full((328, 576), 255.0)))
    (frame,), report = frames_of(path)
    assert frame.image.pitch_cm == (0.479, 0.476)
    said = "recordings with the pitch assumed to be that of the CapContact panel, 0.479 x 0.476 cm"
    assert report.counts[said] == 1
    assert said not in frames_of(path, pitch_cm=0.5)[1].counts
    other = write(tmp_path, npz_bytes(cap=cap[:20], ftir=np.full((160, 576), 255.0)))
    (frame,), report = frames_of(other)
    assert frame.image.pitch_cm == (1.0, 1.0)
    assert report.counts["recordings whose pitch is assumed to be 1 cm"] == 1
    values = np.random.default_rng(0).integers(0, 90, (3, 27, 15))
    _, report = frames_of(write(tmp_path, capfingerid_text(values)))
    assert any("the CapFingerId phone, 0.41 x 0.41 cm" in what for what in report.counts)
