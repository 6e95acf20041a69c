"""Tables in terminals of every width: what they show is whole, and what they do not is told."""

from __future__ import annotations

import io

import pytest
from rich.console import Console

from tactile_graph_compare.output.shown import print_table
from tactile_graph_compare.output.tables import Table, by_other

ERRORS = Table(
    "Absolute errors",
    ("quantity", "variant", "mean", "largest", "answers", "missing", "extra"),
    (("centre cm", "circle-1 *", "0.405", "0.674", "4", "0", "3"),
     ("centre cm", "circle-3 *", "0.178", "0.320", "4", "12", "")),
    "* on the front",
    ("extra",),
)  # fmt: skip


def printed(table: Table, width: int) -> tuple[str, list[str]]:
    """Return what a terminal shows, and which columns it is said to leave out."""
    out = io.StringIO()
    gone = print_table(table, Console(file=out, width=width))
    return out.getvalue(), gone


@pytest.mark.parametrize("width", [20, 30, 40, 50, 60, 80])
def test_every_cell_is_whole_or_its_column_is_told(width: int) -> None:
    shown, gone = printed(ERRORS, width)
    assert max(map(len, shown.splitlines())) <= width
    words = shown.replace(":", " ").replace(",", " ").split()
    for row in ERRORS.rows:
        for name, cell in zip(ERRORS.columns, row, strict=True):
            assert name in gone or all(word in words for word in cell.split()), (name, cell)


def test_where_no_table_has_room_each_row_is_a_line_of_all_its_cells() -> None:
    shown, gone = printed(ERRORS, 40)
    assert gone == []
    assert " ".join(shown.split()) == (
        "Absolute errors centre cm circle-1 *: mean 0.405, largest 0.674, answers 4, missing 0, "
        "extra 3 circle-3 *: mean 0.178, largest 0.320, answers 4, missing 12 * on the front"
    )


def test_rows_of_numbers_alone_are_lines_as_well() -> None:
    table = Table("Front", ("µs predicted", "missed", "guard"), (("11.1", "0 %", "c1 alone"),))
    assert "µs predicted 11.1, missed" in " ".join(printed(table, 15)[0].split())


@pytest.mark.parametrize(
    ("ratio", "told"),
    [(0.5, "× 0.50"), (9.99, "× 9.99"), (9.999, "× 10.0"), (123.456, "× 123"), (99.97, "× 100")],
)
def test_ratios_of_times_have_three_digits(ratio: float, told: str) -> None:
    assert by_other(ratio) == told
