"""Pictures are read as they say: channels, colours, pages, white, which side is up."""

from __future__ import annotations

import importlib.util
import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image as Picture

from helpers_recordings import frames_of, write
from tactile_graph.errors import DataError

tifffile = pytest.importorskip("tifffile")

GREY = (np.arange(48)[:, None] * 3 + np.arange(64)).astype(np.uint8)
SAID = "recordings with "


def tiff(folder: Path, *series: np.ndarray, **how: Any) -> Path:
    out = io.BytesIO()
    with tifffile.TiffWriter(out, imagej=how.pop("imagej", False)) as file:
        for values in series:
            file.write(values, contiguous=False, **how)
    return write(folder, out.getvalue(), "a.tif")


@pytest.mark.parametrize("n", [2, 3, 5])
@pytest.mark.parametrize(
    ("config", "taken"), [("contig", r"\.\.\., channel"), ("separate", "channel")]
)
def test_channels_of_a_tiff_are_refused_by_number(
    n: int, config: str, taken: str, tmp_path: Path
) -> None:
    values = np.stack([GREY // (k + 1) for k in range(n)], -1 if config == "contig" else 0)
    path = tiff(tmp_path, values, photometric="minisblack", planarconfig=config)
    words = rf"the TIFF has {n} channels .* on 48 x 64 pixels, .*array\[{taken}\]"
    with pytest.raises(DataError, match=words):
        frames_of(path)


@pytest.mark.parametrize("n_pages", [1, 2])
def test_colours_of_a_tiff_are_refused_however_they_lie(n_pages: int, tmp_path: Path) -> None:
    values = np.stack([GREY, GREY // 2, GREY // 3])
    values = values if n_pages == 1 else np.stack([values] * n_pages)
    with pytest.raises(DataError, match=r"the picture is in colours.*minisblack"):
        frames_of(tiff(tmp_path, values, photometric="rgb", planarconfig="separate"))


def test_equal_colours_and_what_shines_through_are_one_grey(tmp_path: Path) -> None:
    planes = tiff(tmp_path, np.stack([GREY] * 3), photometric="rgb", planarconfig="separate")
    np.testing.assert_array_equal([f.image.values for f in frames_of(planes)[0]], GREY[None])
    alpha = np.stack([GREY, 255 - GREY], -1)
    path = tiff(tmp_path, alpha, photometric="minisblack", extrasamples=["unassalpha"])
    np.testing.assert_array_equal([f.image.values for f in frames_of(path)[0]], GREY[None])


@pytest.mark.parametrize("columns", [3, 4, 5])
def test_pages_of_few_columns_are_frames_as_the_tiff_says(columns: int, tmp_path: Path) -> None:
    pages = np.repeat(GREY[None, :31, :1], columns, 2) + np.arange(10, dtype="u1")[:, None, None]
    frames, report = frames_of(tiff(tmp_path, pages, photometric="minisblack"))
    np.testing.assert_array_equal([f.image.values for f in frames], pages)
    told = f"{SAID}10 pages of 31 x {columns} taken for frames, as the TIFF says"
    assert report.counts[told] == 1
    frames, report = frames_of(tiff(tmp_path, *pages, photometric="minisblack"))
    np.testing.assert_array_equal([f.image.values for f in frames], pages)
    assert told not in report.counts


def test_channels_beside_times_are_refused_and_alone_are_pages(tmp_path: Path) -> None:
    both = np.stack([np.stack([GREY] * 4), np.stack([GREY // 2] * 4)], 1)
    path = tiff(tmp_path, both, imagej=True, metadata={"axes": "TCYX"})
    with pytest.raises(DataError, match=r"each frame has 2 channels .*take\(channel, axis=1\)"):
        frames_of(path)
    frames, report = frames_of(tiff(tmp_path, both[:, 0], imagej=True, metadata={"axes": "CYX"}))
    assert len(frames) == 4
    assert report.counts[f"{SAID}4 pages taken for frames that the TIFF calls channels"] == 1


def test_white_that_is_stored_as_nothing_is_the_largest_value(tmp_path: Path) -> None:
    frames, report = frames_of(tiff(tmp_path, GREY, photometric="miniswhite"))
    np.testing.assert_array_equal(frames[0].image.values, 255.0 - GREY)
    assert report.counts[f"{SAID}grey values turned round, as the TIFF says that 0 is white"] == 1
    with pytest.raises(DataError, match="0 is white, which values of type int16 cannot"):
        frames_of(tiff(tmp_path, GREY.astype("i2"), photometric="miniswhite"))


def test_masks_of_one_bit_are_on_where_they_were_written_so(tmp_path: Path) -> None:
    mask = GREY % 7 < 3
    for photometric in (None, "miniswhite", "minisblack"):  # by itself tifffile says the first
        frames, report = frames_of(tiff(tmp_path, np.stack([mask] * 3), photometric=photometric))
        np.testing.assert_array_equal([f.image.values for f in frames], [mask] * 3)
        told = f"{SAID}1 bit a pixel taken as it is, though the TIFF says that 0 is white"
        assert report.counts[told] == (photometric != "minisblack")


@pytest.mark.parametrize(("way", "orientation"), list(enumerate([2, 3, 4, 5, 6, 7, 8])))
@pytest.mark.parametrize("kind", ["png", "tiff"])
def test_pictures_are_turned_upright(kind: str, way: int, orientation: int, tmp_path: Path) -> None:
    if kind == "tiff":
        tag = [(274, 3, 1, orientation, True)]
        path = tiff(tmp_path, GREY, photometric="minisblack", extratags=tag)
    else:
        picture, path = Picture.fromarray(GREY), tmp_path / "a.png"
        exif = picture.getexif()
        exif[274] = orientation
        picture.save(path, exif=exif)
    transposed = Picture.fromarray(GREY).transpose(
        [
            Picture.Transpose.FLIP_LEFT_RIGHT,
            Picture.Transpose.ROTATE_180,
            Picture.Transpose.FLIP_TOP_BOTTOM,
            Picture.Transpose.TRANSPOSE,
            Picture.Transpose.ROTATE_270,
            Picture.Transpose.TRANSVERSE,
            Picture.Transpose.ROTATE_90,
        ][way]
    )
    frames, report = frames_of(path)
    np.testing.assert_array_equal(frames[0].image.values, np.asarray(transposed))
    assert report.counts[f"{SAID}pictures turned upright, as they say of themselves"] == 1


def test_dots_an_inch_are_told_and_not_taken(tmp_path: Path) -> None:
    told = (
        f"{SAID}254 x 254 dots an inch, as the picture says: give pitch_cm=0.01 if it was "
        "scanned so"
    )
    png = tmp_path / "a.png"
    Picture.fromarray(GREY).save(png, dpi=(254, 254))
    scan = tiff(tmp_path, GREY, resolution=(100.0, 100.0), resolutionunit="CENTIMETER")
    for path in (png, scan):
        frames, report = frames_of(path)
        assert frames[0].image.pitch_cm == (1.0, 1.0)
        assert report.counts[told] == 1
        assert told not in frames_of(path, pitch_cm=0.01)[1].counts
    Picture.fromarray(GREY).save(png, dpi=(72, 72))
    assert not any("dots" in what for what in frames_of(png)[1].counts)


def test_a_shape_that_is_told_is_that_of_the_picture(tmp_path: Path) -> None:
    path = tiff(tmp_path, GREY)
    assert frames_of(path, rows=48, columns=64)[0]
    with pytest.raises(DataError, match="48 rows and 64 columns, the settings say rows=5"):
        frames_of(path, rows=5, columns=5)


def test_why_a_picture_cannot_be_read_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    def fails(**how: Any) -> None:
        raise ValueError("<COMPRESSION.LZW: 5> is unknown to <BytesIO object at 0x7f00>\nand more")

    path = tiff(tmp_path, GREY)
    monkeypatch.setattr(tifffile.TiffPageSeries, "asarray", lambda series: fails())
    with pytest.raises(DataError, match=r"cannot be read: COMPRESSION.LZW: 5 is unknown to$"):
        frames_of(path)


def test_a_picture_packed_by_what_is_not_installed_is_told(tmp_path: Path):
    if importlib.util.find_spec("imagecodecs"):
        pytest.skip("it is installed")
    path = tmp_path / "a.tif"
    Picture.fromarray(GREY).save(path, compression="tiff_lzw")
    with pytest.raises(DataError, match="requires the 'imagecodecs' package"):
        frames_of(path)
