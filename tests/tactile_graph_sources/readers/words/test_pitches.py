"""What lines before a table say of how far apart cells lie."""

from __future__ import annotations

import pytest

from tactile_graph_sources.readers.words.pitches import lengths_cm
from tactile_graph_sources.readers.words.preamble import described


@pytest.mark.parametrize(
    ("text", "unit", "x", "y"),
    [
        ("8 mm", "", 0.8, 0.8),
        ("1,3 cm", "", 1.3, 1.3),
        ("8,12", "mm", 0.812, 0.812),
        ("8 mm x 12 mm", "", 0.8, 1.2),
        ("8 x 12 mm", "", 0.8, 1.2),
        ("8x12", "mm", 0.8, 1.2),
        ("8mmx12mm", "", 0.8, 1.2),
        ("8 mm × 1.2 cm", "", 0.8, 1.2),
        ("8 mm * 12", "", 0.8, 1.2),
        ("0.8 cm, 1.2 cm", "", 0.8, 1.2),
        ("0.8,1.2", "cm", 0.8, 1.2),
        ("0,8, 1,2 cm", "", 0.8, 1.2),
        ("8 mm by 12 mm", "", 0.8, 1.2),
        ("(8 x 12) mm", "", 0.8, 1.2),
        ("8 mm (x), 12 mm (y)", "", 0.8, 1.2),
        ("8 mm (nominal)", "", 0.8, 0.8),
        ("5.08 mm (0.2 in)", "", 0.508, 0.508),
        ("2.54 mm / 0.1 in", "", 0.254, 0.254),
        ("8 mm ± 0.1 mm", "", 0.8, 0.8),
        ("8 mm, 64 cells", "", 0.8, 0.8),
        ("about 8 mm", "", 0.8, 0.8),
        ("1e-2 m", "", 1.0, 1.0),
        ("8 mm; gap: 1 mm", "", 0.8, 0.8),
        ("8 mm, thickness 2 mm", "", 0.8, 0.8),
        ("8 mm; 1 mm gap", "", 0.8, 0.8),
        ("8 x 12 mm, thickness 2 mm", "", 0.8, 1.2),
        ("8 mm, 8x8", "", 0.8, 0.8),
        ("8 mm; rows: 8", "", 0.8, 0.8),
        ("8 mm square", "", 0.8, 0.8),
        ("8 ± 0,1 mm", "", 0.8, 0.8),
        ("8 mm ± 0.1 mm x 12 mm ± 0.1 mm", "", 0.8, 1.2),
    ],
)
def test_one_length_is_that_of_both_sides_and_two_are_of_columns_and_of_rows(
    text: str, unit: str, x: float, y: float
) -> None:
    assert lengths_cm(text, unit) == pytest.approx((x, y))


@pytest.mark.parametrize(
    "text",
    ["8 mm x 12 mm x 1 mm", "8 x 12", "8", "5 furlongs", "1/4 inch", "0 x 8 mm", "8,12,3 mm",
     "x = 8 mm, y = 12 mm", "8 mm; rows: 12 mm", "8 mm, 12 mm, 3 mm", "8 mm, 12, 3",
     "8 mm - 12 mm",
     "12 x 8 mm (length x width)", "64 mm²"],
)  # fmt: skip
def test_what_is_neither_one_length_nor_two_is_left_out_and_told(text: str) -> None:
    said = described([f"Pitch: {text}"])
    assert said.pitch_cm is None
    assert said.notes == (
        f"'Pitch: {text}' left out, as it is no pitch in a known unit, nor two (of columns, of "
        "rows); pitch_cm says it",
    )


@pytest.mark.parametrize(
    "lines",
    [
        ("Column spacing: 8 mm", "Row spacing: 12 mm"),
        ("pitch_x_mm: 8", "pitch_y_mm: 12"),
        ("Pitch X (mm); 8", "Pitch Y (mm); 12"),
        ("Sensel pitch: 8 x 12 mm", "Element size: 7 x 11 mm"),
        ("Cell size: 7 mm", "Sensor spacing [mm]\t8\t12"),
        ("pitch_mm,8,12",),
        ("Column spacing: 8 mm", "Row spacing: 12 mm", "Cell width: 7 mm", "Cell height: 11 mm"),
        ("Pitch: 12 mm (rows), 8 mm (columns)",),
        ("Pitch: 12 mm (y), 8 mm (x)",),
        ("Pitch: 8 mm (x), 12 mm (y)",),
        ("Pitch: 12 x 8 mm (rows x columns)",),
        ("Pitch (rows x columns): 12 x 8 mm",),
        ("Pitch (rows x columns) [mm]: 12 x 8",),
        ("Pitch (columns x rows): 8 x 12 mm",),
        ("Pitch (x): 8 mm", "Pitch (y): 12 mm"),
    ],
)
def test_sides_are_told_one_by_one_or_together_and_a_pitch_goes_before_a_size(
    lines: tuple[str, ...],
) -> None:
    said = described(lines)
    assert said.pitch_cm == pytest.approx((0.8, 1.2))
    assert said.notes == ()


@pytest.mark.parametrize("lines", [("Cell width: 8 mm", "Cell height: 12 mm"),
                                   ("Element size: 8 x 12 mm",)])  # fmt: skip
def test_a_size_of_cells_alone_is_taken_for_their_pitch_and_told(lines: tuple[str, ...]) -> None:
    said = described(lines)
    assert said.pitch_cm == pytest.approx((0.8, 1.2))
    assert said.notes == ("cells taken to lie side by side, as only their size is told",)


def test_the_pitch_of_one_side_alone_is_taken_for_both_and_told() -> None:
    said = described(["Row spacing: 12 mm"])
    assert said.pitch_cm == pytest.approx((1.2, 1.2))
    assert said.notes == ("columns taken to lie as far apart as rows, as only these are told",)


def test_of_pitches_that_contradict_each_other_none_is_taken() -> None:
    said = described(["Pitch: 8 mm", "Spacing: 12 mm"])
    assert said.pitch_cm is None
    assert said.notes == (
        "several pitches (0.8 and 1.2 cm), none of which is taken; pitch_cm says which",
    )
    assert described(["Pitch: 8 mm", "Spacing: 0.8 cm"]).pitch_cm == pytest.approx((0.8, 0.8))


def test_the_unit_of_a_pitch_in_its_name_is_no_preposition() -> None:
    assert described(["Pitch (in mm): 8"]).pitch_cm == pytest.approx((0.8, 0.8))
    assert described(["Pitch (in): 0.2"]).pitch_cm == pytest.approx((0.508, 0.508))


@pytest.mark.parametrize(
    "line", ["Cell size: 25 mm²", "Cell size: 25 mm2", "Cell size: 25 sq mm", "Cell size (mm²): 25",
             "Cell size [mm^2]: 25", "Cell size [mm2]: 25", "Cell size: 8 mm; gap: 1 mm"]
)  # fmt: skip
def test_an_area_and_a_size_with_a_gap_are_no_pitch(line: str) -> None:
    said = described([line])
    assert said.pitch_cm is None
    assert said.notes == (
        f"{line!r} left out, as it is no pitch in a known unit, nor two (of columns, of rows); "
        "pitch_cm says it",
    )


def test_a_spacing_below_the_size_of_cells_may_be_a_gap_and_is_not_taken() -> None:
    said = described(["Cell spacing: 2 mm", "Cell size: 8 mm"])
    assert said.pitch_cm is None
    assert said.notes == (
        "no pitch taken, as a spacing of 0.2 cm may be the gap between cells of 0.8 cm; pitch_cm "
        "says it",
    )
    rounded = described(["Cell spacing: 8 mm", "Cell size: 8.1 mm"])
    assert rounded.pitch_cm == pytest.approx((0.8, 0.8))


@pytest.mark.parametrize("line", ["Pitch: 3.2 deg", "Pitch: 3.2°", "Pitch [deg]: 3.2"])
def test_an_angle_is_no_pitch_of_cells_and_gets_no_word(line: str) -> None:
    said = described(["Roll: 1.5 deg", line, "Yaw: 12 deg"])
    assert (said.pitch_cm, said.notes) == (None, ())


def test_a_factor_beside_the_values_is_told_as_not_applied() -> None:
    said = described(["Unit: kPa", "Scale factor: 0.1"])
    assert (said.quantity, said.factor) == ("kilopascal", 1.0)
    assert said.notes == (
        "'Scale factor: 0.1' not applied to the values; the step gain with elements: [[10]] does "
        "it",
    )
    assert described(["Scale factor: 1.0", "Scale: linear"]).notes == ()
    assert len(described(["Multiplier: 0.1"]).notes) == 1


@pytest.mark.parametrize(
    "line", ["Scale: 100 %", "Scale: 12 bit", "Scale: 10 kPa", "Scale: 2x", "Scale: 0.5",
             "Scale: 3.5 kg load cell", "Scale factor: 100 %"]
)  # fmt: skip
def test_a_scale_that_is_no_bare_factor_gets_no_word(line: str) -> None:
    assert described([line]).notes == ()
