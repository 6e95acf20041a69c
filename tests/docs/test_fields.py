"""The numbers of the pages about fields that a study of the thesis plugin gives."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from tactile_graph_thesis.measure.restorations import (
    ENCLOSED,
    EVERY_LINE,
    HEURISTIC,
    LEAST_ENERGY,
    LOGARITHMIC,
    MOVED_IN,
    RadiusRow,
    hulls,
    table_5_2,
)
from tactile_graph_thesis.measure.simulated_rectangle import (
    CHOSEN,
    HOT,
    VARIED,
    figure_5_8,
    rectangle,
    schedules,
)

DOCS = Path(__file__).parents[2] / "docs"
PAGES = (DOCS / "fields.md", DOCS / "evidence" / "fields.md")
ERRATA = DOCS / "errata.md"
ROWS = {
    EVERY_LINE: "every line (`thesis-circle`)",
    ENCLOSED: "what lines enclose (`circle-enclosed`)",
    LEAST_ENERGY: "every line at the least energy",
    LOGARITHMIC: "what lines enclose, on the logarithm (`circle-logarithmic`)",
    MOVED_IN: "the same, moved in (`bayes-circle`)",
    HEURISTIC: "`circle-3`",
}
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not DOCS.is_dir(), reason="the docs are not beside the tests"),
    pytest.mark.usefixtures("warm_kernels"),
]


def both() -> str:
    """Return the page that explains and the one with the evidence, as one text."""
    return "\n".join(page.read_text("utf-8") for page in PAGES)


def cells(first: str, columns: int) -> list[list[str]]:
    """Return the further cells of the page's rows of so many columns that begin with a cell."""
    rows = [[c.strip() for c in t.split("|")[1:-1]] for t in both().splitlines()]
    return [r[1:] for r in rows if len(r) == columns and r[0] == first]


@pytest.fixture(scope="module")
def radii() -> tuple[RadiusRow, ...]:
    return table_5_2(0, 100)


@pytest.mark.parametrize("way", ROWS)
def test_table_5_2_is_as_printed(way: str, radii: tuple[RadiusRow, ...]) -> None:
    (told,) = cells(ROWS[way], 3)
    for cell, row in zip(told, radii, strict=True):
        mean, sd, error = map(float, re.findall(r"[\d.]+", cell))
        assert row.mean_cm(way) == pytest.approx(mean, abs=0.006)
        assert row.sd_cm(way) == pytest.approx(sd, abs=0.006)
        assert np.nanmean(row.error_cm(way)) == pytest.approx(error, abs=0.006)


def test_the_areas_of_hulls_are_as_printed() -> None:
    made, page = hulls(0, 25), " ".join(both().split())
    for which, words in (
        ("enclosed", "the hulls have {:.2f} times the area of `circle-3`'s in the median"),
        ("every_line", "spoilt by lines astray ({:.2f} times the area)"),
        ("logarithmic", "the hulls are larger ({:.2f} times)"),
    ):
        ratio = np.median([getattr(h, which).area_cm2 / h.heuristic.area_cm2 for h in made])
        assert words.format(ratio) in page


@pytest.mark.parametrize(("scale", "column"), [(1.0, 0), (0.001, 1)])
def test_the_study_of_the_schedule_is_as_printed(scale: float, column: int) -> None:
    found = schedules(0, 16, scale)
    heads = (
        "T₀ 5, cooled by 0.9, 110 sweeps",
        "T₀ 2",
        "cooled by 0.95",
        "95 sweeps",
        "T₀ 5000, not in the thesis",
    )
    assert [one.schedule for one in found] == [CHOSEN, *VARIED.values(), HOT]
    for head, one in zip(heads, found, strict=True):
        (told,) = cells(head, 3)
        assert one.rms_levels.mean() == pytest.approx(float(told[column]), abs=0.006)
    if scale == 1.0:
        words = f"the error by {found[1].off_chosen_levels:.1f} of 200 levels, 5000 would by"
        assert f"{words} {-found[-1].off_chosen_levels:.1f}" in ERRATA.read_text("utf-8")


@pytest.mark.parametrize(
    ("way", "words"),
    [("thesis", "{} of its {} lines are astray"), ("annealed", "there are {} such lines")],
)
def test_the_lines_astray_are_as_many_as_told(way: str, words: str) -> None:
    made = figure_5_8(0, way)  # type: ignore[arg-type]
    on = rectangle(made.lined).values
    outline = on[:-1] ^ on[1:], on[:, :-1] ^ on[:, 1:]
    found = made.lines.horizontal, made.lines.vertical
    astray = sum(int((f & ~o).sum()) for f, o in zip(found, outline, strict=True))
    page = " ".join(both().split())
    assert words.format(astray, made.lines.count) in page
