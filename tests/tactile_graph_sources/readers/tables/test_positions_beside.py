"""Positions of rows and columns beside the cells of stacked matrices."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import frames_of, write

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


def test_small_positions_may_be_centimetres_and_give_no_pitch(tmp_path: Path) -> None:
    path = write(tmp_path, text([v / 10 for v in X], [v / 10 for v in Y]))
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
