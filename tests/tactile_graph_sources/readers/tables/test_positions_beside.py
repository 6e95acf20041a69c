"""Positions of rows and columns beside the cells of stacked matrices."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import frames_of, write
from tactile_graph_sources.readers.tables.positions import like_positions

LOADED = np.random.default_rng(0).uniform(0, 100, (4, 6, 4)).round(1)
X, Y = [4.0, 12.0, 20.0, 28.0], [6.0, 18.0, 30.0, 42.0, 54.0, 66.0]
READ_AS_CELLS = "of evenly spaced numbers, the same in each matrix, read as cells"


def text(
    x: list[float] | None = None,
    y: list[float] | None = None,
    corner: str = ",",
    head: str = "Frame {}\n",
    frames: np.ndarray = LOADED,
) -> str:
    above = "" if x is None else corner + ",".join(f"{v:g}" for v in x) + "\n"
    before = [""] * 6 if y is None else [f"{v:g}," for v in y]
    return "\n".join(
        head.format(k)
        + above
        + "".join(
            b + ",".join(f"{v:.1f}" for v in row) + "\n" for b, row in zip(before, f, strict=True)
        )
        for k, f in enumerate(frames)
    )


@pytest.mark.parametrize("head", ["Frame {}\n", ""], ids=["named", "blank lines"])
@pytest.mark.parametrize("settings", [{}, {"rows": 6, "columns": 4}], ids=["untold", "told"])
@pytest.mark.parametrize("y", [Y, Y[::-1]], ids=["rising", "falling"])
def test_positions_are_no_cells_and_give_the_pitch(
    y: list[float], settings: dict, head: str, tmp_path: Path
) -> None:
    frames, report = frames_of(write(tmp_path, text(X, y, head=head)), **settings)
    assert np.array_equal([frame.image.values for frame in frames], LOADED)
    assert frames[0].image.pitch_cm == (0.8, 1.2)
    what = "positions beside the cells, 8 x 12 apart, taken for mm (else give pitch_cm)"
    assert f"recordings with {what}" in report.counts


def test_a_pitch_that_is_told_goes_before_positions(tmp_path: Path) -> None:
    path = write(tmp_path, text(X, Y))
    for frames, report in (
        frames_of(path, pitch_cm=0.5),
        frames_of(write(tmp_path, "Pitch: 5 mm\n" + text(X, Y), "said.csv")),
    ):
        assert frames[0].image.pitch_cm == (0.5, 0.5)
        assert "recordings with positions beside the cells, 8 x 12 apart" in report.counts


@pytest.mark.parametrize(
    ("corner", "words", "pitch"),
    [
        ("mm", "", (0.8, 1.2)),
        ("cm", "", (8.0, 12.0)),
        ("Y [cm]", "", (8.0, 12.0)),
        ("y/x", "", (0.8, 1.2)),
        ("y\\x", "", (0.8, 1.2)),
        ("", "Positions in cm\n", (8.0, 12.0)),
        ("", "x/y in inch\n", (20.32, 30.48)),
        ("mm", "Positions in cm\n", (0.8, 1.2)),
        ("", "Insole height in cm\n", (0.8, 1.2)),
    ],
)
def test_words_may_stand_in_the_corner_or_above_and_say_the_unit(
    corner: str, words: str, pitch: tuple[float, float], tmp_path: Path
) -> None:
    frames, report = frames_of(write(tmp_path, words + text(X, Y, f"{corner},")))
    assert np.array_equal([frame.image.values for frame in frames], LOADED)
    assert frames[0].image.pitch_cm == pytest.approx(pitch)
    taken = "taken for mm" if "y" in corner and "cm" not in corner else "cm (else give pitch_cm)"
    assert any("positions beside" in t and (words or taken in t) for t in report.counts)


def test_small_positions_in_a_unit_that_is_told_give_a_pitch(tmp_path: Path) -> None:
    path = write(tmp_path, text([v / 10 for v in X], [v / 10 for v in Y], "cm,"))
    frames, _ = frames_of(path)
    assert frames[0].image.pitch_cm == pytest.approx((0.8, 1.2))


@pytest.mark.parametrize("settings", [{"rows": 7}, {"columns": 5}, {"rows": 7, "columns": 5}])
def test_rows_and_columns_that_are_told_go_before_positions(settings: dict, tmp_path: Path) -> None:
    for settings_, above in ((settings, ""), ({}, "Rows: 7\nColumns: 5\n")):
        frames, _ = frames_of(write(tmp_path, above + text(X, Y)), **settings_)
        assert frames[0].image.shape == (7, 5)


def test_cells_that_are_told_go_before_positions(tmp_path: Path) -> None:
    frames, _ = frames_of(write(tmp_path, text(X, Y)), cells="1-5")
    assert frames[0].image.shape == (7, 5)


def test_an_even_load_that_does_not_change_has_no_positions(tmp_path: Path) -> None:
    ramp = 10 + np.add.outer(5.0 * np.arange(6), 10.0 * np.arange(4))
    matrix = "," + text(frames=ramp[None], head="").partition(",")[2] + "\n"
    frames, report = frames_of(write(tmp_path, matrix * 4))
    assert frames[0].image.shape == (6, 4)
    assert any("first row and a first column" in told for told in report.counts)


def test_positions_beside_cells_without_a_load_are_none_of_them(tmp_path: Path) -> None:
    frames, report = frames_of(write(tmp_path, text(X, Y, frames=np.zeros((3, 6, 4)))))
    assert frames[0].image.shape == (6, 4)
    assert any("positions beside" in told for told in report.counts)


@pytest.mark.parametrize(
    ("x", "corner", "n"), [(X, "0,", 4), (X, ",", 1), (X, "0,", 1), ([3.0, 8, 13, 19], "0,", 4)]
)
def test_what_may_be_positions_is_told(x: list, corner: str, n: int, tmp_path: Path) -> None:
    frames, report = frames_of(write(tmp_path, text(x, Y, corner, frames=LOADED[:n])))
    assert frames[0].image.shape == (7, 5)
    both = "a first row and a first column of evenly spaced numbers"
    assert any(both in told for told in report.counts)


@pytest.mark.parametrize(
    "matrix",
    [
        np.tile(np.arange(10.0, 90.0, 20.0), (6, 1)),
        np.array([[10.0, 11, 12], [9, 10, 9], [11, 10, 10]]),
        np.array([[3.0, 2, 1, 0], [2, 3, 1, 0], [1, 1, 5, 0], [0, 0, 0, 0]]),
    ],
    ids=["wedge", "idle", "idle in steps of one"],
)
def test_a_still_load_is_not_told_as_positions(matrix: np.ndarray, tmp_path: Path) -> None:
    frames = np.tile(matrix, (4, 1, 1))
    frames[:, 2, 2] += np.arange(4) * (len(matrix) == 4)
    rows = ("".join(",".join(map(str, row)) + "\n" for row in frame) for frame in frames)
    _, report = frames_of(write(tmp_path, "\n".join(rows)))
    assert not any("positions" in told for told in report.counts)


@pytest.mark.parametrize("scale", [0.1, 0.2])
def test_small_positions_may_be_centimetres_and_give_no_pitch(scale: float, tmp_path: Path) -> None:
    path = write(tmp_path, text([v * scale for v in X], [v * scale for v in Y]))
    frames, report = frames_of(path)
    assert np.array_equal([frame.image.values for frame in frames], LOADED)
    assert "recordings whose pitch is assumed to be 1 cm" in report.counts


@pytest.mark.parametrize(
    ("x", "y", "corner", "shape", "what"),
    [(X, None, "", (7, 4), "first row"), (None, Y, "", (6, 5), "first column")],
)
def test_one_of_the_two_alone_is_told(
    x: list[float], y: list[float], corner: str, shape: tuple, what: str, tmp_path: Path
) -> None:
    frames, report = frames_of(write(tmp_path, text(x, y, corner)))
    assert frames[0].image.shape == shape
    assert any(f"{what} {READ_AS_CELLS}" in told for told in report.counts)


@pytest.mark.parametrize(
    ("x", "y"),
    [
        ([4.0, 12.0, 20.0, 29.0], Y),
        (X, [6.0, 18.0, 30.0, 42.0, 54.0, 67.0]),
        ([0.0] * 4, Y),
        (X, [0.0] * 6),
    ],
)
def test_uneven_numbers_beside_a_missing_corner_are_readings(
    x: list[float], y: list[float], tmp_path: Path
) -> None:
    frames, report = frames_of(write(tmp_path, text(x, y)))
    assert frames[0].image.shape == (7, 5)
    assert not frames[0].image.valid[0, 0]
    assert not any("positions beside" in told for told in report.counts)


def test_a_first_line_that_comes_once_is_none_of_positions(tmp_path: Path) -> None:
    once = text(X, Y, frames=LOADED[:1]) + "\n" + text(None, Y, frames=LOADED[1:])
    _, report = frames_of(write(tmp_path, once.replace("\n\n\n", "\n\n")))
    assert not any("positions beside" in told for told in report.counts)


def test_a_matrix_that_changes_has_no_positions(tmp_path: Path) -> None:
    # A ramp under a growing load, whose first cell is missing.
    ramp = np.add.outer(np.arange(1.0, 7.0), np.arange(1.0, 5.0))
    path = write(
        tmp_path,
        "\n".join(
            "," + text(frames=k * ramp[None, :], head="").partition(",")[2] for k in range(1, 5)
        ),
    )
    frames, report = frames_of(path)
    assert frames[0].image.shape == (6, 4)
    assert not any("positions" in told for told in report.counts)


def test_numbers_without_end_are_no_positions() -> None:
    with np.errstate(all="raise"):
        assert like_positions(np.full((2, 5, 5), np.inf)) == ""
        assert like_positions(np.empty((0, 5, 5))) == ""
