"""Plain tables: the three layouts, however they spell numbers, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import blobs, flat_text, frames_of, long_text, stacked_text, write
from tactile_graph.errors import DataError

VALUES = blobs(5, 8, 8)
WIDE = blobs(4, 6, 10, seed=2)


def check(path: Path, expected: np.ndarray, **settings: object) -> None:
    frames, report = frames_of(path, **settings)
    assert not report.troubles
    np.testing.assert_array_equal([f.image.values for f in frames], expected)


SPELLINGS = {
    "plain": lambda text: text,
    "byte-order mark": lambda text: "\ufeff" + text,
    "CRLF": lambda text: text.replace("\n", "\r\n"),
    "old Mac line ends": lambda text: text.replace("\n", "\r"),
    "UTF-16": lambda text: text.encode("utf-16"),
    "semicolons": lambda text: text.replace(",", ";"),
    "tabs": lambda text: text.replace(",", "\t"),
    "blanks": lambda text: text.replace(",", "  "),
    "blank after the comma": lambda text: text.replace(",", ", "),
    "decimal commas, semicolons": lambda text: text.replace(",", ";").replace(".", ","),
    "decimal commas, tabs": lambda text: text.replace(",", "\t").replace(".", ","),
    "decimal commas, blanks": lambda text: text.replace(",", " ").replace(".", ","),
    "trailing separator": lambda text: "\n".join(r + "," if r else r for r in text.split("\n")),
    "quoted": lambda text: text.replace("0.00", '"0.00"'),
    "comments": lambda text: "# made by hand\n" + text,
}


@pytest.mark.parametrize("spelling", SPELLINGS)
@pytest.mark.parametrize("layout", [flat_text, stacked_text])
def test_a_table_reads_the_same_however_it_is_spelled(
    layout: object, spelling: str, tmp_path: Path
) -> None:
    check(write(tmp_path, SPELLINGS[spelling](layout(VALUES))), VALUES)


@pytest.mark.parametrize("spelling", ["plain", "byte-order mark", "CRLF", "semicolons", "tabs"])
def test_a_long_table_reads_the_same_however_it_is_spelled(spelling: str, tmp_path: Path) -> None:
    check(write(tmp_path, SPELLINGS[spelling](long_text(WIDE))), WIDE)


def test_decimal_commas_in_a_long_table(tmp_path: Path) -> None:
    text = long_text(WIDE).replace(",", ";").replace(".", ",")
    check(write(tmp_path, text), WIDE)


@pytest.mark.parametrize("settings", [{"rows": 6, "columns": 10}, {"rows": 6}, {"columns": 10}])
def test_told_shape_reads_frames_that_are_no_squares(
    settings: dict[str, int], tmp_path: Path
) -> None:
    check(write(tmp_path, flat_text(WIDE)), WIDE, **settings)


def test_told_shape_cuts_matrices_without_blank_lines_between_them(tmp_path: Path) -> None:
    text = stacked_text(WIDE).replace("\n\n", "\n")
    check(write(tmp_path, text), WIDE, rows=6, columns=10)


def test_blank_lines_after_every_row_say_nothing(tmp_path: Path) -> None:
    text = stacked_text(WIDE).replace("\n\n", "\n").replace("\n", "\n\n")
    check(write(tmp_path, text), WIDE, rows=6, columns=10)


def test_two_blank_lines_end_a_matrix_where_one_stands_after_every_row(tmp_path: Path) -> None:
    text = stacked_text(WIDE).replace("\n\n", "\n\r").replace("\n", "\n\n").replace("\r", "\n\n")
    check(write(tmp_path, text), WIDE)


def test_one_matrix_alone_is_one_frame(tmp_path: Path) -> None:
    check(write(tmp_path, stacked_text(WIDE[:1])), WIDE[:1])
    check(write(tmp_path, stacked_text(blobs(1, 16, 16))), blobs(1, 16, 16))


def test_frame_lines_divide_matrices(tmp_path: Path) -> None:
    blocks = stacked_text(WIDE).split("\n\n")
    text = "".join(f"Frame {k}:\n{block}\n" for k, block in enumerate(blocks))
    check(write(tmp_path, text), WIDE)


@pytest.mark.parametrize(
    ("header", "first", "factor"),
    [("time_s", 0.5, 1.0), ("t_ms", 500.0, 1e-3), ("timestamp", 0.5, 1.0), (None, 0.5, 1.0)],
)
def test_a_leading_time_column_gives_the_times(
    header: str | None, first: float, factor: float, tmp_path: Path
) -> None:
    rows = flat_text(VALUES).splitlines()
    names = ",".join(f"v{k}" for k in range(64))
    text = f"{header},{names}\n" if header else ""
    text += "".join(f"{first * k},{row}\n" for k, row in enumerate(rows))
    frames, report = frames_of(write(tmp_path, text))
    assert not report.troubles
    assert [f.time_s for f in frames] == pytest.approx([first * factor * k for k in range(5)])
    np.testing.assert_array_equal(frames[3].image.values, VALUES[3])


def test_of_frames_with_the_same_number_the_first_is_kept(tmp_path: Path) -> None:
    rows = flat_text(VALUES).splitlines()
    names = ",".join(f"v{k}" for k in range(64))
    numbered = [f"{k},{row}" for k, row in zip([0, 1, 1, 2, 3], rows, strict=True)]
    path = write(tmp_path, "\n".join([f"frame,{names}", *numbered]))
    frames, report = frames_of(path)
    np.testing.assert_array_equal([f.image.values for f in frames], VALUES[[0, 1, 3, 4]])
    assert report.troubles == [(f"{path}:4", "frame 1 comes again; the first one is kept")]
    assert report.counts["repeated frames dropped"] == 1


def test_long_columns_come_in_any_order_and_cells_in_any(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    cells = [(v, k, j, i) for (k, i, j), v in np.ndenumerate(WIDE)]
    first, rest = cells[0], [cells[n] for n in rng.permutation(np.arange(1, len(cells)))]
    rest.sort(key=lambda cell: cell[1] if cell[1] < 2 else 2)
    lines = [f"{v},{k},{j + 1},{i + 1}" for v, k, j, i in [first, *rest]]
    frames, report = frames_of(write(tmp_path, "\n".join(["Value,Frame,Col,Row", *lines])))
    assert not report.troubles
    assert {f.image.values.tobytes() for f in frames} == {v.tobytes() for v in WIDE}
    assert all(f.image.valid is None for f in frames)


def test_long_cells_left_out_are_invalid_and_repeated_ones_dropped(tmp_path: Path) -> None:
    lines = long_text(WIDE).splitlines()
    del lines[5]
    lines.insert(20, "0,1,8,999")
    path = write(tmp_path, "\n".join(lines))
    frames, report = frames_of(path)
    valid = frames[0].image.valid
    assert valid is not None
    assert np.argwhere(~valid).tolist() == [[0, 4]]
    assert frames[0].image.values[1, 8] in (WIDE[0, 1, 8], 999.0)
    assert report.counts["repeated cells dropped"] == 1
    assert "1 cells come again; the first ones are kept" in report.troubles[0][1]


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ("0,1,x,5", "no cell: 'x' is no number"),
        ("0,1,2", "no cell: 3 values, not 4"),
        ("0,-1,2,5", "no cell: its row or column is below 0, those of others are not"),
        ("0,0.5,2,5", "names no place on a pad"),
        ("nan,0,2,5", "names no place on a pad"),
        ("0,1_0,2,5", "'_' is no part of a number"),
    ],
)
def test_a_damaged_line_of_a_long_table_is_named(line: str, what: str, tmp_path: Path) -> None:
    lines = long_text(WIDE).splitlines()
    lines.insert(7, line)
    path = write(tmp_path, "\n".join(lines))
    frames, report = frames_of(path)
    np.testing.assert_array_equal([f.image.values for f in frames], WIDE)
    assert report.troubles[0][0] == f"{path}:8"
    assert what in report.troubles[0][1]


@pytest.mark.parametrize("last", [0, 1, 400])
@pytest.mark.parametrize(("up", "left"), [(2, 5), (0, 5), (-1, 5), (2, 0)])
def test_cells_count_from_the_lowest_where_the_origin_lies_within_the_pad(
    up: int, left: int, last: int, tmp_path: Path
) -> None:
    """``last``: how many of the lines there are before the first one below 0."""
    cells = [f"{k},{c - left},{r - up},{v}" for (k, r, c), v in np.ndenumerate(moving(9, 6, 10))]
    first = [x for x in cells if "-" not in x][:last]
    rest = [x for x in cells if x not in first]
    path = write(tmp_path, "\n".join(["frame,x,y,value", *first, *rest]))
    frames, report = frames_of(path)
    assert not report.troubles
    by_number = sorted(frames, key=lambda f: f.image.values.tobytes())
    expected = sorted(moving(9, 6, 10), key=lambda v: v.tobytes())
    np.testing.assert_array_equal([f.image.values for f in by_number], expected)
    assert report.counts[f"recordings with rows counted from {-up} and columns from {-left}"] == 1


def test_positions_between_whole_numbers_are_read_wherever_their_origin_lies(
    tmp_path: Path,
) -> None:
    values = moving(4, 6, 10)
    cells = [f"{k},{c - 4.5},{r - 2.5},{v}" for (k, r, c), v in np.ndenumerate(values)]
    check(write(tmp_path, "\n".join(["frame,x,y,value", *cells])), values)
    cells = [f"{k},{c - 5},{r - 3},{v}" for (k, r, c), v in np.ndenumerate(values)]
    path = write(tmp_path, "\n".join(["frame,x_mm,y_mm,value", *cells]))
    check(path, values)
    assert frames_of(path)[0][0].image.pitch_cm == pytest.approx((0.1, 0.1))


def test_a_place_that_means_none_is_no_place(tmp_path: Path) -> None:
    lines = long_text(WIDE).splitlines()
    lines += [f"{k},-1,-1,0" for k in range(4)]
    frames, report = frames_of(write(tmp_path, "\n".join(lines)))
    np.testing.assert_array_equal([f.image.values for f in frames], WIDE)
    assert len(report.troubles) == 4


def test_long_cells_outside_the_told_shape_are_reported(tmp_path: Path) -> None:
    text = long_text(WIDE) + "3,6,0,5.0\n"
    frames, report = frames_of(write(tmp_path, text), rows=6, columns=10)
    assert len(frames) == 4
    assert report.troubles[0][1] == "frame 3: 1 cells outside the told shape"


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ("1,2,3", "3 values, not 64"),
        (",".join(["1"] * 63 + ["--2"]), "'--2' is no number"),
        (",".join(["1"] * 63 + ["1_0"]), "'_' is no part"),
        (",".join(["1"] * 65), "65 values, not 64"),
        (",".join(["1"] * 63 + ["2]"]), "'2]' is no number"),
        ("boot v1.2 ok", "1 values, not 64"),
    ],
)
def test_a_damaged_line_is_skipped_counted_and_named(line: str, what: str, tmp_path: Path) -> None:
    rows = flat_text(VALUES).splitlines()
    rows.insert(2, line)
    path = write(tmp_path, "\n".join(rows))
    frames, report = frames_of(path)
    np.testing.assert_array_equal([f.image.values for f in frames], VALUES)
    assert report.counts["damaged records skipped"] == 1
    assert [place for place, _ in report.troubles] == [f"{path}:3"]
    assert what in report.troubles[0][1]
    assert [f.gap for f in frames] == [False, False, True, False, False]


def test_half_a_line_before_the_frames_is_reported_and_words_are_not(tmp_path: Path) -> None:
    path = write(tmp_path, "17,23\nready 1.0\n" + flat_text(VALUES))
    frames, report = frames_of(path)
    np.testing.assert_array_equal([f.image.values for f in frames], VALUES)
    assert report.troubles == [(f"{path}:1", "2 values, not 64")]


def test_a_matrix_of_the_wrong_height_is_skipped(tmp_path: Path) -> None:
    rows = stacked_text(WIDE).splitlines()
    del rows[9]
    path = write(tmp_path, "\n".join(rows))
    frames, report = frames_of(path)
    np.testing.assert_array_equal([f.image.values for f in frames], WIDE[[0, 2, 3]])
    assert report.troubles == [(f"{path}:8", "a matrix of 5 rows, not 6")]
    assert frames[1].gap


def test_a_bad_row_costs_its_matrix_only(tmp_path: Path) -> None:
    rows = stacked_text(WIDE).replace("\n\n", "\n").splitlines()
    rows[8] = rows[8].replace(",", ",x", 1)
    path = write(tmp_path, "\n".join(rows))
    frames, report = frames_of(path, rows=6, columns=10)
    np.testing.assert_array_equal([f.image.values for f in frames], WIDE[[0, 2, 3]])
    assert "line 9: 'x" in report.troubles[0][1]


def test_empty_nan_and_infinite_cells_are_invalid(tmp_path: Path) -> None:
    rows = [row.split(",") for row in flat_text(VALUES).splitlines()]
    rows[1][3], rows[1][4], rows[1][5] = "", "nan", "1e999"
    frames, report = frames_of(write(tmp_path, "\n".join(map(",".join, rows))))
    assert not report.troubles
    valid = frames[1].image.valid
    assert valid is not None
    assert np.flatnonzero(~valid).tolist() == [3, 4, 5]
    assert frames[1].image.values.ravel()[3:6].tolist() == [0.0, 0.0, 0.0]
    assert frames[0].image.valid is None


@pytest.mark.parametrize(
    ("shape", "settings", "what"),
    [
        ((9, 6, 12), {}, "9 lines of 72 values could be one matrix or a frame a line"),
        ((4, 6, 10), {"rows": 7}, "a frame is 60 values in a row, and the settings say rows=7"),
        ((4, 6, 10), {"rows": 6, "columns": 9}, "rows=6, columns=9 of its shape"),
    ],
)
def test_what_cannot_be_told_is_asked_for(
    shape: tuple[int, int, int], settings: dict[str, int], what: str, tmp_path: Path
) -> None:
    path = write(tmp_path, flat_text(blobs(*shape)))
    with pytest.raises(DataError, match=what):
        frames_of(path, **settings)


def test_a_square_number_of_values_is_a_square_frame_unless_the_cells_lie_otherwise(
    tmp_path: Path,
) -> None:
    frames, _ = frames_of(write(tmp_path, flat_text(blobs(30, 10, 10))))
    assert frames[0].image.shape == (10, 10)
    with pytest.raises(DataError, match=r"of 5 x 20 cells, as they lie\); give the settings rows"):
        frames_of(write(tmp_path, flat_text(blobs(30, 5, 20))))


def test_a_lying_shape_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DataError, match="6 rows and 10 columns, the settings say rows=7"):
        frames_of(write(tmp_path, stacked_text(WIDE)), rows=7)


@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize(
    "stamp",
    [
        "2024-01-01T10:00:{:02d}",
        "2024-01-01 10:00:{:02d}",
        "10:00:{:02d}",
        "01.02.2024 10:00:{:02d}Z",
    ],
)
def test_long_tables_begin_with_a_date_or_time_of_day(
    stamp: str, separator: str, tmp_path: Path
) -> None:
    values = np.round(WIDE)
    lines = [(stamp.format(k), r, c, f"{v:.0f}") for (k, r, c), v in np.ndenumerate(values)]
    text = "\n".join(separator.join(map(str, x)) for x in [("time", "row", "col", "value"), *lines])
    frames, report = frames_of(write(tmp_path, text))
    assert not report.troubles
    np.testing.assert_array_equal([f.image.values for f in frames], values)
    assert [f.time_s for f in frames] == [0.0, 1.0, 2.0, 3.0]


def test_what_all_lines_begin_with_is_no_name_of_rows_and_columns(tmp_path: Path) -> None:
    lines = [f"left,{r},{c},{v:.0f}" for (r, c), v in np.ndenumerate(WIDE[0])]
    check(write(tmp_path, "\n".join(["foot,row,col,value", *lines])), np.round(WIDE[:1]))


# -- what stands beside the cells --------------------------------------------------------------


def beside(names: str, *texts: str) -> str:
    """Return a long table with columns beside its cells, whose texts are the same in all lines."""
    lines = [",".join([f"{k},{r},{c},{v:.0f}", *texts]) for (k, r, c), v in np.ndenumerate(WIDE)]
    return "\n".join([f"frame,row,col,pressure,{names}", *lines])


@pytest.mark.parametrize(
    ("unit", "quantity", "factor"),
    [("mmHg", "kilopascal", 0.133322387415), ("N/cm2", "kilopascal", 10.0), ("mV", "volt", 1e-3)],
)
def test_a_column_says_the_unit_of_long_and_of_wide_tables(
    unit: str, quantity: str, factor: float, tmp_path: Path
) -> None:
    long = write(tmp_path, beside("unit", unit), "long.csv")
    header = ",".join(["Einheit", *(f"r{r}c{c}" for r in range(6) for c in range(10))])
    rows = flat_text(np.round(WIDE)).splitlines()
    wide = write(tmp_path, "\n".join([header, *(f"{unit},{x}" for x in rows)]), "wide.csv")
    for path in (long, wide):
        frames, report = frames_of(path)
        assert {f.image.quantity for f in frames} == {quantity}
        np.testing.assert_allclose(
            [f.image.values for f in frames], np.round(WIDE) * factor, rtol=1e-12
        )
        assert not any("left out" in what for what in report.counts)


@pytest.mark.parametrize("after", [3, 900])
def test_values_in_several_units_are_refused_however_late_the_second_comes(
    after: int, tmp_path: Path
) -> None:
    lines = [f"{k // 60},{k % 60 // 10},{k % 10},{k % 7},mmHg" for k in range(960)]
    lines[after:] = [line.replace("mmHg", "kPa") for line in lines[after:]]
    path = write(tmp_path, "\n".join(["frame,row,col,pressure,unit", *lines]))
    with pytest.raises(DataError, match=r"its values are in several units \('mmHg', 'kPa'\)") as e:
        frames_of(path)
    assert e.value.where == (str(path) if after < 400 else f"{path}:902")


def test_a_unit_that_other_words_contradict_is_refused(tmp_path: Path) -> None:
    path = write(tmp_path, "unit: kPa\n" + beside("unit", "mmHg"))
    with pytest.raises(DataError, match="its column 'unit' says 'mmHg', other words of it another"):
        frames_of(path)


@pytest.mark.parametrize(
    ("names", "texts", "told"),
    [
        ("pressure_kPa", ["7"], "pressure_kPa"),
        ("unit,note", ["left", "calm"], "unit, note"),
        (",", ["", ""], ""),
    ],
)
def test_columns_of_a_long_table_that_are_not_read_are_told(
    names: str, texts: list[str], told: str, tmp_path: Path
) -> None:
    frames, report = frames_of(write(tmp_path, beside(names, *texts)))
    np.testing.assert_array_equal([f.image.values for f in frames], np.round(WIDE))
    found = [what for what in report.counts if "left out" in what]
    assert found == ([f"recordings with columns left out ({told})"] if told else [])


# -- blank lines between frames of a line each -------------------------------------------------


def parted(lines: list[str], size: int) -> str:
    """Return lines with a blank one after every ``size`` of them."""
    return "".join(f"{line}\n" + "\n" * (k % size == size - 1) for k, line in enumerate(lines))


@pytest.mark.parametrize(
    ("stamp", "last_s"),
    [
        (lambda k: f"2024-01-01T10:00:{k:02d}", 29.0),
        (lambda k: f"10:00:{k:02d}", 29.0),
        (lambda k: f"{20 * k}", 0.58),
        (lambda k: f"{20 * (k % 15)}", 0.28),
        (lambda k: f"{k},{20 * k + 3}", 0.583),
        (lambda k: f"{k}", None),
    ],
    ids=["dates", "times of day", "milliseconds", "begun anew", "numbers and times", "numbers"],
)
@pytest.mark.parametrize("side", [8, 12])
def test_lines_with_a_time_of_their_own_are_frames_whatever_blank_lines_part_them(
    stamp: Callable[[int], str], last_s: float | None, side: int, tmp_path: Path
) -> None:
    values = moving(30, side, side)
    lines = [f"{stamp(k)},{x}" for k, x in enumerate(flat_text(values).splitlines())]
    frames, _ = frames_of(write(tmp_path, parted(lines, 15)))
    np.testing.assert_array_equal([f.image.values for f in frames], values)
    assert frames[-1].time_s == pytest.approx(last_s)


def test_blank_lines_between_lines_that_may_be_frames_are_asked_about(tmp_path: Path) -> None:
    values = moving(30, 8, 8)
    path = write(tmp_path, parted(flat_text(values).splitlines(), 10))
    with pytest.raises(
        DataError,
        match=r"matrices \(then rows=10, columns=64\), or frames of 8 x 8, .* rows=8 --with colu",
    ):
        frames_of(path)
    check(path, values, rows=8, columns=8)
    check(path, values.reshape(3, 10, 64), rows=10, columns=64)


@pytest.mark.parametrize(
    "stamp",
    [lambda k: f"{10 * k},", lambda k: f"10:00:{0.01 * k:06.3f} -> "],
    ids=["milliseconds", "of a serial monitor"],
)
def test_rows_of_matrices_stay_rows_where_each_has_a_time(
    stamp: Callable[[int], str], tmp_path: Path
) -> None:
    values = moving(30, 16, 16)
    lines = flat_text(values.reshape(-1, 1, 16)).splitlines()
    path = write(tmp_path, parted([f"{stamp(k)}{x}" for k, x in enumerate(lines)], 16))
    check(path, values)


def test_a_column_that_climbs_in_each_matrix_is_one_of_cells(tmp_path: Path) -> None:
    values = moving(20, 12, 17) + 10.0 * np.arange(12)[:, None]
    values[:, :, 0] = 100.0 + 10.0 * np.arange(12)
    lines = flat_text(values.reshape(-1, 1, 17)).splitlines()
    check(write(tmp_path, parted(lines, 12)), values)


def test_a_time_that_the_rows_of_a_matrix_share_is_no_cell(tmp_path: Path) -> None:
    values = moving(6, 5, 7)
    lines = flat_text(values.reshape(-1, 1, 7)).splitlines()
    path = write(tmp_path, parted([f"{20 * (k // 5)},{x}" for k, x in enumerate(lines)], 5))
    check(path, values)
    assert [f.time_s for f in frames_of(path)[0]] == pytest.approx([0.02 * k for k in range(6)])


@pytest.mark.parametrize("separator", [",", ";", "\t", "   "])
@pytest.mark.parametrize(
    ("line", "first_s"),
    [
        ("Zeit [s]{0}{1}", 12.5),
        ("t = {1}", 12.5),
        ("Time{0}{1} s", 12.5),
        ("Frame {2}{0}Zeit{0}{1}", 12.5),
        ("Time:{0}10:00:{1}", 0.0),
        ("16/11/2026, 10:00:{1}", 0.0),
    ],
)
def test_times_between_matrices_have_the_decimals_of_the_rows(
    line: str, first_s: float, separator: str, tmp_path: Path
) -> None:
    values = moving(6, 4, 6) / 10
    lines = [line.format(separator, f"{12.5 + 0.25 * k:.2f}", k + 1) for k in range(6)]
    rows = stacked_text(np.round(values, 1), separator).split("\n\n")
    text = "\n".join(f"{x}\n{r}\n" for x, r in zip(lines, rows, strict=True))
    text = text if separator == "," else text.replace(".", ",")
    frames, report = frames_of(write(tmp_path, text.encode("utf-16")))
    assert [f.time_s for f in frames] == pytest.approx([first_s + 0.25 * k for k in range(6)])
    assert not report.troubles


def moving(n: int, rows: int, columns: int) -> np.ndarray:
    """Return whole readings of a load that moves slowly over noise, shape (n, rows, columns)."""
    y, x = np.mgrid[:rows, :columns]
    noise = np.random.default_rng(0).normal(20, 1, (n, rows, columns))
    apart = [(y - rows / 4 - 0.2 * k) ** 2 + (x - columns / 1.6 + 0.3 * k) ** 2 for k in range(n)]
    return np.round(noise + 800 * np.exp(-np.array(apart) / 9))


def test_frame_numbers_beyond_those_of_a_float_are_told_apart(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    numbers = [2**53 + k for k in (0, 1, 2, 2, 3)]
    lines = [",".join(map(str, [n, *range(k, k + 6)])) for k, n in enumerate(numbers)]
    path.write_text("\n".join(["frame" + ",v" * 6, *lines]) + "\n")
    frames, report = frames_of(path, rows=2, columns=3)
    assert [f.own_number for f in frames] == [2**53 + k for k in range(4)]
    assert report.troubles == [
        (f"{path}:5", f"frame {2**53 + 2} comes again; the first one is kept")
    ]


def test_a_number_too_large_for_any_frame_is_damage(tmp_path: Path) -> None:
    values = blobs(2100, 3, 3, decimals=0)
    lines = ["frame," + ",".join(f"r{i // 3}c{i % 3}" for i in range(9))]
    lines += [f"{k}," + ",".join(f"{v:.0f}" for v in f.ravel()) for k, f in enumerate(values)]
    lines[2051] = "9" * 400 + lines[2051].removeprefix("2050")
    frames, report = frames_of(write(tmp_path, "\n".join(lines)))
    assert len(frames) == 2099
    assert [where for where, _ in report.troubles] == [f"{tmp_path / 'recording.dat'}:2052"]


def test_a_damaged_stamp_of_a_counter_moves_no_later_time(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    stamps = [4_100_000_000 + 20_000 * k for k in range(12)]
    stamps[6] %= 1_000_000_000  # its first digit lost
    lines = [",".join(map(str, [t, *range(k, k + 6)])) for k, t in enumerate(stamps)]
    path.write_text("\n".join(["micros" + ",v" * 6, *lines]) + "\n")
    frames, _ = frames_of(path, rows=2, columns=3)
    times = [f.time_s for f in frames]
    assert [*times[:6], *times[7:]] == pytest.approx([4100 + 0.02 * k for k in range(12) if k != 6])


@pytest.mark.parametrize("text", [flat_text, stacked_text, long_text])
def test_words_before_a_table_say_two_pitches_and_a_rate_and_what_is_not_read_is_told(
    tmp_path: Path, text: Callable[[np.ndarray], str]
) -> None:
    head = "Pitch: 8 mm x 12 mm\nSampling rate: 0.5 kHz\nScale factor: 0.1\n\n"
    frames, report = frames_of(write(tmp_path, head + text(VALUES)), rows=8, columns=8)
    assert frames[0].image.pitch_cm == pytest.approx((0.8, 1.2))
    assert any("'Scale factor: 0.1' not applied" in what for what in report.counts)
    if text is stacked_text:
        assert [f.time_s for f in frames[:2]] == pytest.approx([0.0, 0.002])
