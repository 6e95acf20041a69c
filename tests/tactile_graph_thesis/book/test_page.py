"""The page, its summary, and what is done with an item that fails."""

from __future__ import annotations

import re
from html.parser import HTMLParser

import pytest

from tactile_graph.errors import Degenerate
from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.book.files import compared_csv, csv_text, files_of
from tactile_graph_thesis.book.page import page
from tactile_graph_thesis.book.summary import (
    Nearness,
    all_told,
    conclusions,
    nearness,
    table_lines,
)
from tactile_graph_thesis.book.text import number
from tactile_graph_thesis.item import Compared, Finding, Item, Made, Table
from tactile_graph_thesis.making import Outcome, outcomes
from tactile_graph_thesis.work import Work

ROWS = (
    Compared("a <b>", "cm", 2.0, 1.0, 0.5, 2.5),
    Compared("b", "cm", 2.0, 4.0, 1.0, 3.0),
    Compared("c", "%", 3.0, 5.0, limit=True),
    Compared("d", "cm", 3.0),
    Compared("e max", "cm", 1.2, 1.0, largest=True),
)
FINDINGS = (
    Finding("up", "yes & more", "no <more>", True),
    Finding("down", "no", "yes", False),
    Finding("(not in the thesis) sideways", "so", "not so", True),
)


def fails(_: Work) -> Made:
    raise Degenerate("nothing to <see>")


def breaks(_: Work) -> Made:
    raise ValueError("oh")


GOOD = Item("table-9.1", "Good", "Shown.", lambda _: Made(ROWS, FINDINGS, notes=("Note.",)), "Why.")
BAD = Item("figure-9.2", "Bad", "Shown.", fails)
BROKEN = Item("study", "Broken", "Shown.", breaks, after="9.3")


class Seen(HTMLParser):
    """Collects tags that are not closed and addresses."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.addresses: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.addresses += [v or "" for k, v in attrs if k in ("href", "src")]
        if tag not in ("meta", "br", "img", "link"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def made() -> list[Outcome]:
    return list(outcomes([GOOD, BAD, BROKEN], Work(readings=20)))


def test_a_failing_item_stops_no_other_and_says_why() -> None:
    good, bad, broken = made()
    assert good.made is not None
    assert (bad.made, bad.error) == (None, "nothing to <see>")
    assert broken.error == "ValueError: oh"
    assert "breaks" in broken.trace


def test_ratio_and_range() -> None:
    one, two, limit, none, _ = ROWS
    assert (one.ratio, one.within) == (2.0, True)
    assert (two.ratio, two.within) == (0.5, False)
    assert limit.within is None
    assert none.ratio is None
    assert Compared("", "", float("nan"), 1.0).ratio is None
    assert Compared("", "", 1.0, 0.0).ratio is None


def test_the_summary_counts_numbers_and_conclusions() -> None:
    (line,) = table_lines(made())
    assert (line.name, line.within, line.with_range) == ("table 9.1", 1, 2)
    assert (line.averages, line.maxima) == (Nearness(2, (0, 0, 1)), Nearness(1, (0, 1, 1)))
    study = line._replace(id="one-pad")
    assert [str(n) for n in all_told([line, line, study])] == ["0, 0, 2 of 4", "0, 2, 2 of 2"]
    assert [f.thesis for _, f in conclusions(made())] == ["up", "down"]


def test_maxima_and_averages_that_miss_in_opposite_ways_do_not_make_up_for_each_other() -> None:
    rows = (Compared("a", "cm", 0.4, 1.0), Compared("a max", "cm", 2.5, 1.0, largest=True))
    item = Item("table-9.3", "Off", "Shown.", lambda _: Made(rows))
    (line,) = table_lines(list(outcomes([item], Work(readings=20))))
    assert line.averages.near == line.maxima.near == (0, 0, 0)
    assert nearness([]) == Nearness(0, (0, 0, 0))
    assert str(nearness([])) == "–"


def test_a_number_at_the_edge_is_within() -> None:
    rows = [Compared("", "", ours, 1.0) for ours in (1.1, 0.7, 1.31, 0.5)]
    assert nearness(rows).near == (1, 2, 4)


@pytest.mark.parametrize("nothing", ["", "  "])
def test_a_finding_that_nothing_refutes_is_none(nothing: str) -> None:
    with pytest.raises(ValueError, match="finding 'up': refuted_by must say what would refute it"):
        Finding("up", "yes", nothing, True)


@pytest.mark.slow
def test_the_page_holds_everything_and_asks_for_nothing() -> None:
    text = page(
        made(),
        {"table-9.1": b'<svg viewBox="0 0 400 100"></svg>'},
        {"command": "x & y"},
        {"circle-1": "a: <b>"},
    )
    seen = Seen()
    seen.feed(text)
    assert seen.open == []
    assert all(a.startswith(("#", "data:image/svg+xml;base64,")) for a in seen.addresses)
    assert not re.search(r"@import|url\(|https?:|<script", text)
    for part in (
        "a &lt;b&gt;",
        "yes &amp; more",
        "What would refute it: no &lt;more&gt;.",
        "0, 0, 1 of 2",
        "&lt; 5",
        "nothing to &lt;see&gt;",
        "x &amp; y",
        "1 of 2 conclusions",
        "class=broad",
        "Why.",
        "Note.",
    ):
        assert part in text
    for target in (a for a in seen.addresses if a.startswith("#")):
        assert re.search(f'id="?{re.escape(target[1:])}"?[ >]', text), target


def test_numbers_have_the_digits_that_matter() -> None:
    assert [number(v) for v in (0.0, 1.2345, 123.456, 0.012345, 1e-9, None, float("nan"))] == [
        "0",
        "1.23",
        "123",
        "0.0123",
        "0.0000",
        "–",
        "–",
    ]


@pytest.mark.slow
def test_files_of_an_item_and_the_same_bytes_again() -> None:
    def one() -> Made:
        figure = new_figure()
        figure.subplots().plot([1, 2])
        return Made(table=Table(("a", "b"), [(1, None)]), figure=figure)

    files = files_of("x", one())
    assert sorted(files) == ["x.csv", "x.png", "x.svg"]
    assert files["x.csv"] == b"a,b\n1,\n"
    assert files["x.png"].startswith(b"\x89PNG")
    assert files == files_of("x", one())


def test_every_number_goes_into_one_csv() -> None:
    lines = compared_csv(made()).splitlines()
    assert lines[0] == "item,what,unit,ours,low,high,thesis,ratio"
    assert lines[1] == "table-9.1,a <b>,cm,2.0,0.5,2.5,1.0,2.0"
    assert len(lines) == 1 + len(ROWS)
    assert csv_text(("a",), [(0.1 + 0.2,)]) == "a\n0.30000000000000004\n"
